/* The random part of maps with grooves: H = 0.8, waves of 4 to 32 points and RMS height 1. A map is
 * cut from a cell of twice its sides. */
#ifndef RUGO_TESTS_SUPPORT_RANDOM_PART_H
#define RUGO_TESTS_SUPPORT_RANDOM_PART_H

#include "core/surface/surface.h"
#include "tests/support/check.h"
#include <stdlib.h>

enum { SIDE = 128, WHOLE = 2 * SIDE };

struct maker {
    struct generator *generator;
    double *whole, *z;
};

static struct maker maker_create(double lay) {
    const struct grid grid = {WHOLE, WHOLE, WHOLE, WHOLE};
    const struct spectrum spectrum = {.type = SPECTRUM_SELF_AFFINE,
                                      .hurst = 0.8,
                                      .wavelength_long = 32,
                                      .wavelength_rolloff = 32,
                                      .wavelength_short = 4,
                                      .anisotropy = lay,
                                      .lay_angle = 0.4};
    struct surface_options options = SURFACE_DEFAULTS;
    struct maker out = {.whole = malloc(WHOLE * WHOLE * sizeof(double)),
                        .z = malloc(SIDE * SIDE * sizeof(double))};
    options.amplitudes = AMPLITUDES_RANDOM;
    assert_true(out.whole != NULL && out.z != NULL);
    assert_int_equal(generator_create(&out.generator, &spectrum, &grid, &options, NULL), 0);
    return out;
}

static void maker_destroy(struct maker *maker) {
    generator_destroy(&maker->generator);
    free(maker->whole);
    free(maker->z);
}

#endif
