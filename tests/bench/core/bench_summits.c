/* Summit stencils: CPU time beside error, on 256 to 2048 points a side. 200 Gaussian surfaces (H
 * 0.8, ratio 8, L/lambda_l 8) at each sampling, 50 at the finest. */
#include "core/statistics/summits/summits.h"
#include "core/surface/surface.h"
#include "core/theory/nayak.h"
#include "tests/support/timing.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

static int bench(size_t points, enum summit_stencil stencil, const char *name, struct error *err) {
    size_t n = 64 * points, surfaces = points > 16 ? 50 : 200;
    struct grid grid = {n, n, 64, 64};
    struct spectrum spectrum = {.type = SPECTRUM_SELF_AFFINE,
                                .hurst = 0.8,
                                .wavelength_long = 8,
                                .wavelength_rolloff = 8,
                                .wavelength_short = 1};
    struct generator *generator = NULL;
    struct summit_finder *finder = NULL;
    struct summit_list list = {0};
    struct moments moments;
    double ms = 0, sum = 0, square = 0, *z = array_create(n * n, sizeof *z);
    int status = z ? 0 : error_memory(err, n * n * sizeof *z, "heights");
    if (!status)
        status = generator_create(&generator, &spectrum, &grid, &SURFACE_DEFAULTS, err);
    if (!status)
        status =
            summit_finder_create(&finder, &grid, stencil, CURVATURE_FINITE_DIFFERENCE, 64, 64, err);
    for (uint64_t r = 0; !status && r < surfaces; r++) {
        status = generator_run(generator, (struct random_key){1, 0, r}, z, NULL, err);
        double start = cpu_ms();
        if (!status)
            status = summits_find(finder, z, &list, err);
        ms += cpu_ms() - start;
        sum += (double)list.count / (double)surfaces;
        square += (double)list.count * (double)list.count / (double)surfaces;
    }
    if (!status) {
        modes_moments(generator_modes(generator), &moments);
        double nayak = nayak_summit_density(moments.m2, moments.m4) * 64 * 64;
        printf("%4zu x %4zu, %2zu points a wave  %-10s  %7.2f ms  density/Nayak %.4f +- %.4f\n", n,
               n, points, name, ms / (double)surfaces, sum / nayak,
               sqrt((square - sum * sum) / (double)(surfaces - 1)) / nayak);
    }
    free(z);
    generator_destroy(&generator);
    summit_finder_destroy(&finder);
    summit_list_clear(&list);
    return status;
}

int main(void) {
    static const struct {
        enum summit_stencil stencil;
        const char *name;
    } STENCILS[] = {{SUMMITS_NINE_POINT, "nine-point"},
                    {SUMMITS_FIVE_POINT, "five-point"},
                    {SUMMITS_REFINED, "refined"}};
    struct error err = {0};
    for (size_t points = 4; points <= 32; points *= 2)
        for (size_t s = 0; s < 3; s++)
            if (bench(points, STENCILS[s].stencil, STENCILS[s].name, &err)) {
                fprintf(stderr, "bench_summits: %s\n", err.text);
                return 1;
            }
    return 0;
}
