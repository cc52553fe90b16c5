/* Surfaces to cut sub-maps out of, which then no longer repeat. Include after check.h. */
#ifndef RUGO_TESTS_SUPPORT_CUT_H
#define RUGO_TESTS_SUPPORT_CUT_H

#include "core/surface/surface.h"
#include <stdlib.h>

/* A self-affine surface (ny == 1: profile) of RMS height 1, with waves from a quarter of lx to an
 * eighth of that; the caller frees it. */
static inline double *whole_surface(const struct grid *grid, double hurst, uint64_t realisation) {
    const struct spectrum spectrum = {.type = SPECTRUM_SELF_AFFINE,
                                      .hurst = hurst,
                                      .wavelength_long = grid->lx / 4,
                                      .wavelength_rolloff = grid->lx / 4,
                                      .wavelength_short = grid->lx / 32};
    struct generator *generator = NULL;
    double *z = malloc(grid_points(grid) * sizeof *z);
    assert_non_null(z);
    assert_int_equal(generator_create(&generator, &spectrum, grid, &SURFACE_DEFAULTS, NULL), 0);
    assert_int_equal(
        generator_run(generator, (struct random_key){11, 0, realisation}, z, NULL, NULL), 0);
    generator_destroy(&generator);
    return z;
}

/* The nx by ny points of a map from point i, j on, with their grid; the caller frees them. */
static inline double *cut(const struct grid *grid, const double *z, size_t i, size_t j, size_t nx,
                          size_t ny, struct grid *piece) {
    double *out = malloc(nx * ny * sizeof *out);
    assert_non_null(out);
    *piece = (struct grid){nx, ny, grid_dx(grid) * (double)nx, grid_dy(grid) * (double)ny};
    for (size_t row = 0; row < ny; row++)
        for (size_t column = 0; column < nx; column++)
            out[row * nx + column] = z[(j + row) * grid->nx + i + column];
    return out;
}

#endif
