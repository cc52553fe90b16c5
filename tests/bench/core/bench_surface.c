/* Gaussian surfaces with their nine-point summits: CPU time of each step, one core, medians. Beside
 * generation and summits alone stands the one pass that a study makes: histogram, powers of
 * heights, summits and pits. Then the error of the RMS height and what the surface costs in memory.
 */
#include "core/statistics/heights/roughness.h"
#include "core/statistics/surface_pass.h"
#include "core/surface/surface.h"
#include "tests/support/timing.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

enum { REPEATS = 9, STEPS = 4, BINS = 240 };

static int bench(size_t n, struct error *err) {
    double ratio = (double)n / 64;
    struct grid grid = {n, n, 8 * ratio, 8 * ratio};
    struct spectrum spectrum = {.type = SPECTRUM_SELF_AFFINE,
                                .hurst = 0.8,
                                .wavelength_long = ratio,
                                .wavelength_rolloff = ratio,
                                .wavelength_short = 1};
    struct generator *generator = NULL;
    struct summit_finder *finder = NULL;
    struct summit_list list = {0}, pits = {0};
    struct roughness roughness = {0};
    double times[STEPS][REPEATS], worst = 0, *z = array_create(n * n, sizeof *z);
    int status = z ? 0 : error_memory(err, n * n * sizeof *z, "heights");
    if (!status)
        status = generator_create(&generator, &spectrum, &grid, &SURFACE_DEFAULTS, err);
    if (!status)
        status = summit_finder_create(&finder, &grid, SUMMITS_NINE_POINT,
                                      CURVATURE_FINITE_DIFFERENCE, n / 8, n / 8, err);
    for (int r = 0; !status && r < REPEATS; r++) {
        double start = cpu_ms();
        status = generator_run(generator, (struct random_key){1, 0, (uint64_t)r}, z, NULL, err);
        times[0][r] = cpu_ms() - start;
        if (!status)
            status = summits_find(finder, z, &list, err);
        times[1][r] = cpu_ms() - start - times[0][r];
        roughness_measure(&grid, z, &roughness);
        times[2][r] = cpu_ms() - start - times[0][r] - times[1][r];
        struct height_sums sums;
        uint64_t counts[BINS + 2] = {0};
        const struct bins bins = {-4, 8, BINS};
        const struct surface_pass pass = {.finder = finder,
                                          .bins = &bins,
                                          .scale = 1,
                                          .counts = counts,
                                          .sums = &sums,
                                          .summits = &list,
                                          .pits = &pits};
        start = cpu_ms();
        if (!status)
            status = surface_pass_run(&pass, &grid, z, err);
        times[3][r] = cpu_ms() - start;
        worst = fmax(worst, fabs(roughness.rms_height - 1));
    }
    if (!status) {
        printf("%6zu", n);
        for (int s = 0; s < STEPS; s++) {
            qsort(times[s], REPEATS, sizeof **times, by_value);
            printf("  %9.2f (%.2f-%.2f)", times[s][REPEATS / 2], times[s][0],
                   times[s][REPEATS - 1]);
        }
        printf("  %8.1e  %5.2f\n", worst,
               generator_bytes(&grid, n / 8, n / 8, &SURFACE_DEFAULTS) /
                   (8.0 * (double)n * (double)n));
    }
    free(z);
    generator_destroy(&generator);
    summit_finder_destroy(&finder);
    summit_list_clear(&list);
    summit_list_clear(&pits);
    return status;
}

int main(void) {
    struct error err = {0};
    printf("%6s  %s  %s  %s  %s  %s  %s\n", "N", "generation ms (spread)", "summits ms (spread)",
           "roughness ms (spread)", "one pass ms (spread)", "error of RMS height",
           "memory/surface");
    for (size_t n = 256; n <= 4096; n *= 2)
        if (bench(n, &err)) {
            fprintf(stderr, "bench_surface: %s\n", err.text);
            return 1;
        }
    return 0;
}
