/* Compliance of layered blocks 1.5 cells high, layers that grow by 1.1, nu = 0.3: time of one core
 * (CPU, median of 3), and compliance over that of the half-space, along x. The latter is at the
 * longest wave (with the effect of the block's depth) and at 32, 16 and 8 points a wave (with that
 * of the mesh). */
#include "core/contact/compliance.h"
#include "tests/support/timing.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

enum { REPEATS = 3 };

/* Over 2/|k| for k along x. */
static double over_halfspace(const struct compliance *compliance, size_t mx) {
    double k = 2 * acos(-1) * (double)mx / compliance->grid.lx;
    return compliance->length[mx * compliance->grid.ny] * k / 2;
}

static int bench(size_t nx, size_t ny, struct error *err) {
    struct grid grid = {nx, ny, 1, 1};
    struct block block = {.model = MODEL_LAYERED,
                          .poisson = 0.3,
                          .height = 1.5,
                          .layer_growth = 1.1,
                          .weighting = GAP_STANDARD};
    struct compliance *compliance = NULL;
    double ms[REPEATS];
    for (size_t r = 0; r < REPEATS; r++) {
        compliance_destroy(&compliance);
        double start = cpu_ms();
        int status = compliance_create(&compliance, &grid, &block, err);
        if (status)
            return status;
        ms[r] = cpu_ms() - start;
    }
    qsort(ms, REPEATS, sizeof *ms, by_value);
    printf("%5zu x %-5zu %6zu %10.2f ms %7.1f MB   %.5f %.5f %.5f %.5f\n", nx, ny,
           compliance->layers, ms[REPEATS / 2], 1e-6 * compliance_bytes(&grid, &block),
           over_halfspace(compliance, 1), over_halfspace(compliance, nx / 32),
           over_halfspace(compliance, nx / 16), over_halfspace(compliance, nx / 8));
    compliance_destroy(&compliance);
    return 0;
}

int main(void) {
    static const size_t SIZES[][2] = {{512, 1},   {4096, 1},  {65536, 1},   {128, 128},  {256, 256},
                                      {512, 512}, {500, 512}, {1024, 1024}, {2048, 2048}};
    struct error err = {0};
    printf("nodes        layers          time    memory   S k/2: longest wave, 32, 16, 8 points\n");
    for (size_t s = 0; s < sizeof SIZES / sizeof *SIZES; s++)
        if (bench(SIZES[s][0], SIZES[s][1], &err)) {
            fprintf(stderr, "%s\n", err.text);
            return EXIT_FAILURE;
        }
    return EXIT_SUCCESS;
}
