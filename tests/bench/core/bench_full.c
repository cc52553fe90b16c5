/* Finite elements on the true geometry: the two rows that a general FE program with mortar contact
 * needs 61 s and 213 s for (2D: H = 0.8, ratio 8, RMS slope 0.1, 512 points, 10 loads to 0.3; 3D:
 * one double-sine period, 32 x 32 points, 5 loads to 0.7 p*), how time grows with the nodes, with
 * the slope and with Poisson's ratio, and what wider columns cost and save; beside each what Newton
 * and the linear equations took. CPU time of one core. */
#include "core/full/full.h"
#include "core/surface/surface.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

static const double PI = 3.14159265358979323846;

static double cpu_seconds(void) {
    struct timespec now;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

struct bench_run {
    struct grid grid;
    struct block block;
    struct full_options options;
    double *z;
    size_t loads;
    double greatest; /* last load, E* */
};

static int run_loads(const struct bench_run *run, struct error *err) {
    struct full *full = NULL;
    struct contact_state state = {0};
    struct full_report report = {0}, sum = {0};
    size_t points = grid_points(&run->grid);
    double start = cpu_seconds();
    int status = full_create(&full, &run->grid, &run->block, &run->options, err);
    if (!status)
        status = full_begin(full, run->z, err);
    for (size_t l = 1; !status && l <= run->loads; l++) {
        double load = run->greatest * (double)l / (double)run->loads;
        status = full_press(full, load, &state, &report, err);
        sum.newton += report.newton;
        sum.linear += report.linear;
        sum.factored += report.factored;
        sum.cuts += report.cuts;
    }
    double seconds = cpu_seconds() - start;
    if (!status)
        printf(
            "%5zu x %-4zu %8zu equations %8.2f s  %5.1f us an equation and step  %3zu steps of "
            "Newton's, %4zu linear, %2zu factored, %zu cuts  slope <= %.3f  fraction %.4f x "
            "%.4f  mean gap %.5g  stiffness %.5g  %5.0f MB\n",
            run->grid.nx, run->grid.ny, mesh_degrees_of_freedom(full_mesh(full)), seconds,
            1e6 * seconds / (double)mesh_degrees_of_freedom(full_mesh(full)) / (double)sum.newton,
            sum.newton, sum.linear, sum.factored, sum.cuts, report.slope,
            (double)state.nodes / (double)points, report.stretch, state.mean_gap, state.stiffness,
            1e-6 * full_bytes(&run->grid, &run->block, &run->options,
                              (double)sum.linear / (double)sum.newton, false));
    full_destroy(&full);
    return status;
}

static int profile(size_t n, double slope, struct full_options options, struct error *err) {
    double cell = (double)n / 8;
    struct grid grid = {n, 1, cell, cell};
    struct spectrum spectrum = {.type = SPECTRUM_SELF_AFFINE,
                                .hurst = 0.8,
                                .wavelength_long = cell / 8,
                                .wavelength_rolloff = cell / 8,
                                .wavelength_short = 1,
                                .scale = SCALE_RMS_SLOPE,
                                .scale_value = slope};
    struct bench_run run = {.grid = grid,
                            .block = {.poisson = 0.3,
                                      .height = 1.5 * cell,
                                      .layer_growth = 1.1,
                                      .weighting = GAP_STANDARD},
                            .options = options,
                            .z = array_create(n, sizeof(double)),
                            .loads = 10,
                            .greatest = 0.3 * slope};
    struct generator *generator = NULL;
    int status = run.z ? 0 : error_memory(err, n * sizeof(double), "heights");
    if (!status)
        status = generator_create(&generator, &spectrum, &grid, &SURFACE_DEFAULTS, err);
    if (!status)
        status = generator_run(generator, (struct random_key){1, 0, 0}, run.z, NULL, err);
    if (!status)
        status = run_loads(&run, err);
    generator_destroy(&generator);
    free(run.z);
    return status;
}

static int double_sine(size_t n, double height, double poisson, struct error *err) {
    struct bench_run run = {.grid = {n, n, 1, 1},
                            .block = {.poisson = poisson,
                                      .height = 1.5,
                                      .layer_growth = 1.2,
                                      .weighting = GAP_STANDARD},
                            .options = FULL_DEFAULTS,
                            .z = array_create(n * n, sizeof(double)),
                            .loads = 5,
                            .greatest = 0.7 * sqrt(2) * PI * height};
    if (run.z == NULL)
        return error_memory(err, n * n * sizeof(double), "heights");
    for (size_t i = 0; i < n * n; i++) {
        size_t column = i % n, row = i / n;
        run.z[i] = height * cos(2 * PI * (double)column / (double)n) *
                   cos(2 * PI * (double)row / (double)n);
    }
    int status = run_loads(&run, err);
    free(run.z);
    return status;
}

static int run_all(struct error *err) {
    static const double SLOPES[] = {0.01, 0.1, 0.2, 0.5};
    static const char *const KINEMATICS[] = {"Hencky", "St Venant", "small strain"};
    static const double TRANSITIONS[] = {INFINITY, 16, 8, 4}, POISSON[] = {0.49, 0.4999};
    struct full_options options = FULL_DEFAULTS;
    int status = 0;
    printf("profiles, RMS slope 0.1, 10 loads to 0.3 (the general program: 512 points in 61 s)\n");
    for (size_t n = 128; !status && n <= 2048; n *= 2)
        status = profile(n, 0.1, options, err);
    printf("profiles of 512 points, equal columns and columns widening from 16, 8, 4 widths\n");
    for (size_t t = 0; !status && t < 4; t++) {
        options.transition = TRANSITIONS[t];
        status = profile(512, 0.1, options, err);
    }
    options = FULL_DEFAULTS;
    for (int k = 0; !status && k < 3; k++) {
        printf("profiles of 512 points by slope, %s\n", KINEMATICS[k]);
        options.kinematics = (enum kinematics)k;
        size_t slopes = k == KINEMATICS_ST_VENANT ? 3 : 4; /* steeper ones fail in compression */
        for (size_t s = 0; !status && s < slopes; s++)
            status = profile(512, SLOPES[s], options, err);
    }
    printf("double sine, height 0.02, 5 loads to 0.7 p* (the general program: 32 x 32 in 213 s)\n");
    for (size_t n = 16; !status && n <= 64; n *= 2)
        status = double_sine(n, 0.02, 0.3, err);
    printf("double sine of 32 x 32 points, Poisson's ratio 0.49 and 0.4999\n");
    for (size_t c = 0; !status && c < 2; c++)
        status = double_sine(32, 0.02, POISSON[c], err);
    return status;
}

int main(void) {
    struct error err = {0};
    if (run_all(&err) != 0) {
        fprintf(stderr, "%s\n", err.text);
        return 1;
    }
    return 0;
}
