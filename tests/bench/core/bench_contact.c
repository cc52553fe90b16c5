/* Contact of rough profiles and surfaces, H = 0.8, ratio 8 and up, 8 points a shortest wave: CPU
 * time of one core for a path of loads, the stiffness and all area estimators with it; beside it
 * the largest violation left, and for profiles the error of the area against 8 times as many
 * points. */
#include "core/contact/area.h"
#include "core/contact/contact.h"
#include "core/contact/free_space.h"
#include "core/surface/surface.h"
#include "tests/support/timing.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

/* 10 evenly spaced loads to 0.3, and the 8 of the textbook comparison. */
static const double EVEN[] = {.03, .06, .09, .12, .15, .18, .21, .24, .27, .3};
static const double WIDE[] = {.01, .02, .05, .1, .2, .3, .4, .5};
enum { EVEN_COUNT = 10, WIDE_COUNT = 8, SURFACES = 3 };

struct contact_bench {
    struct generator *generator;
    struct compliance *compliance;
    struct contact *contact;
    struct area_workspace *areas;
    double *z, slope, preparation; /* ms: compliance and edge law */
};

static void bench_clear(struct contact_bench *bench) {
    area_workspace_destroy(&bench->areas);
    contact_destroy(&bench->contact);
    compliance_destroy(&bench->compliance);
    generator_destroy(&bench->generator);
    free(bench->z);
}

/* A cell 8 longest waves wide; `points` a shortest wave. */
static int bench_create(struct contact_bench *bench, size_t n, int dimension, double points,
                        enum block_model model, bool open, struct error *err) {
    double cell = (double)n / points;
    struct grid grid = {n, dimension == 2 ? n : 1, cell, cell};
    struct spectrum spectrum = {.type = SPECTRUM_SELF_AFFINE,
                                .hurst = 0.8,
                                .wavelength_long = cell / 8,
                                .wavelength_rolloff = cell / 8,
                                .wavelength_short = 1};
    struct block block = {.model = model,
                          .poisson = 0.3,
                          .height = model == MODEL_LAYERED ? 1.5 * cell : INFINITY,
                          .layer_growth = 1.1,
                          .weighting = GAP_STANDARD};
    *bench = (struct contact_bench){.z = array_create(grid_points(&grid), sizeof(double))};
    int status = bench->z ? 0 : error_memory(err, grid_points(&grid) * sizeof(double), "heights");
    if (!status)
        status = generator_create(&bench->generator, &spectrum, &grid, &SURFACE_DEFAULTS, err);
    double start = cpu_ms();
    if (!status)
        status = open ? compliance_create_open(&bench->compliance, &grid, &block, err)
                      : compliance_create(&bench->compliance, &grid, &block, err);
    if (!status)
        status = area_workspace_create(&bench->areas, bench->compliance, err);
    bench->preparation = cpu_ms() - start;
    if (!status)
        status = contact_create(&bench->contact, bench->compliance, &CONTACT_DEFAULTS, err);
    if (!status) {
        struct moments moments;
        modes_moments(generator_modes(bench->generator), &moments);
        bench->slope = moments.rms_slope;
    }
    return status;
}

struct result {
    double ms, iterations, violation, *area; /* a load */
};

static int bench_run(struct contact_bench *bench, uint64_t realisation, size_t loads,
                     const double *load, struct result *result, struct error *err) {
    struct contact_state state;
    struct contact_area area;
    int status = generator_run(bench->generator, (struct random_key){1, 0, realisation}, bench->z,
                               NULL, err);
    double start = cpu_ms();
    if (!status)
        status = contact_begin(bench->contact, bench->z, err);
    for (size_t l = 0; !status && l < loads; l++) {
        status = contact_press(bench->contact, load[l] * bench->slope, &state, err);
        if (status)
            break;
        contact_area(bench->areas, &state, &area);
        result->iterations += (double)state.iterations / (double)loads;
        result->violation = fmax(result->violation, state.violation);
        result->area[l] += area.edges;
    }
    result->ms += (cpu_ms() - start) / (double)loads;
    return status;
}

/* Some surfaces at the loads into the means of result. */
static int measure(size_t n, int dimension, double points, enum block_model model, bool open,
                   size_t loads, const double *load, struct result *result, double *preparation,
                   struct error *err) {
    struct contact_bench bench;
    int surfaces = n >= 512 && dimension == 2 ? 1 : SURFACES;
    int status = bench_create(&bench, n, dimension, points, model, open, err);
    for (int r = 0; !status && r < surfaces; r++)
        status = bench_run(&bench, (uint64_t)r, loads, load, result, err);
    result->ms /= surfaces;
    result->iterations /= surfaces;
    for (size_t l = 0; l < loads; l++)
        result->area[l] /= surfaces;
    *preparation = bench.preparation;
    bench_clear(&bench);
    return status;
}

static int profiles(enum block_model model, struct error *err) {
    printf("profiles, %s, 10 loads to 0.3: time a load, and the area's error at the loads\n",
           model == MODEL_LAYERED ? "layered" : "halfspace");
    for (size_t n = 512; n <= 8192; n *= 4) {
        double coarse[EVEN_COUNT] = {0}, fine[EVEN_COUNT] = {0}, preparation, ignored, worst = 0;
        struct result result = {.area = coarse}, reference = {.area = fine};
        int status = measure(n, 1, 8, model, false, EVEN_COUNT, EVEN, &result, &preparation, err);
        if (!status)
            status =
                measure(8 * n, 1, 64, model, false, EVEN_COUNT, EVEN, &reference, &ignored, err);
        if (status)
            return status;
        for (size_t l = 0; l < EVEN_COUNT; l++)
            worst = fmax(worst, fabs(coarse[l] / fine[l] - 1));
        printf("%9zu %9.3f ms  %5.1f iterations  violation %.1e  area error <= %.2f %%  "
               "(prepared in %.1f ms)\n",
               n, result.ms, result.iterations, result.violation, 100 * worst, preparation);
    }
    return 0;
}

static int surfaces(enum block_model model, bool open, struct error *err) {
    const struct block block = {.model = model};
    printf("surfaces, %s%s, 8 loads 0.01 to 0.5: time a load and in all\n",
           model == MODEL_LAYERED ? "layered" : "halfspace", open ? " in free space" : "");
    for (size_t n = 256; n <= (open ? 1024 : 2048); n *= 2) {
        double area[WIDE_COUNT] = {0}, preparation;
        struct result result = {.area = area};
        struct grid grid = {n, n, 1, 1};
        int status = measure(n, 2, 8, model, open, WIDE_COUNT, WIDE, &result, &preparation, err);
        if (status)
            return status;
        printf("%4zu^2 %9.1f ms %7.2f s  %5.1f iterations  violation %.1e  fractions %.4f %.4f "
               "%.4f  %6.0f MB  (prepared in %.0f ms)\n",
               n, result.ms, 1e-3 * WIDE_COUNT * result.ms, result.iterations, result.violation,
               area[1], area[3], area[6],
               1e-6 * (contact_bytes(&grid, &block, &CONTACT_DEFAULTS) +
                       (open ? free_space_bytes(&grid) : 0)),
               preparation);
    }
    return 0;
}

int main(void) {
    struct error err = {0};
    setvbuf(stdout, NULL, _IOLBF, 0);
    if (profiles(MODEL_HALFSPACE, &err) || profiles(MODEL_LAYERED, &err) ||
        surfaces(MODEL_HALFSPACE, false, &err) || surfaces(MODEL_HALFSPACE, true, &err) ||
        surfaces(MODEL_LAYERED, false, &err)) {
        fprintf(stderr, "%s\n", err.text);
        return 1;
    }
    return 0;
}
