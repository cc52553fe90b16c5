/* Protects: the scatter of a spectrum beyond that of a Gaussian surface is seen in surfaces whose
 * waves rise and fall together, and widens the intervals of what is fitted; that of Gaussian ones
 * hardly does. */
#include "core/map/preparation/detrend.h"
#include "core/statistics/spectra/spectrum_fit.h"
#include "core/statistics/uncertainty/map_chance.h"
#include "core/surface/surface.h"
#include "tests/support/check.h"
#include "tests/support/seed.h"
#include <stdlib.h>
#include <string.h>

enum { WHOLE = 256, SIDE = 96, TRIALS = 4 };
static const struct grid CELL = {WHOLE, WHOLE, WHOLE, WHOLE}, PIECE = {SIDE, SIDE, SIDE, SIDE};

/* Returns how much wider, in logarithms, the interval of the amplitude is by the map's own scatter;
 * so does that of H. */
static double widening_of(const double *z) {
    static double piece[SIDE * SIDE];
    const struct measured_map map = {&PIECE, piece, BOUNDARY_OPEN};
    struct map_chance *chance = NULL;
    struct map_spectrum *spectrum = NULL;
    struct spectrum_fit without, with;
    struct trend trend;
    for (size_t j = 0; j < SIDE; j++)
        memcpy(piece + j * SIDE, z + j * WHOLE, SIDE * sizeof *piece);
    assert_int_equal(detrend(&PIECE, piece, DETREND_PLANE, &trend, NULL), 0);
    assert_int_equal(map_chance_create(&chance, &map, NULL), 0);
    assert_int_equal(map_spectrum_create(&spectrum, &map, NULL), 0);
    const struct spectrum_fit_request by_the_map = {.map = &map, .modes = &chance->modes};
    assert_int_equal(
        spectrum_fit_measure(spectrum, &(struct spectrum_fit_request){0}, &without, NULL), 0);
    assert_int_equal(spectrum_fit_measure(spectrum, &by_the_map, &with, NULL), 0);
    map_spectrum_destroy(&spectrum);
    map_chance_destroy(&chance);
    check_relative(with.amplitude.value, without.amplitude.value, 1e-12);
    assert_true(with.hurst.high - with.hurst.low >= without.hurst.high - without.hurst.low - 1e-9);
    return log(with.amplitude.high / with.amplitude.low) /
           log(without.amplitude.high / without.amplitude.low);
}

static double mean_widening(struct heights heights, uint64_t seed) {
    static double z[WHOLE * WHOLE] __attribute__((aligned(64)));
    const struct spectrum spectrum = {.type = SPECTRUM_SELF_AFFINE,
                                      .hurst = 0.6,
                                      .wavelength_long = WHOLE,
                                      .wavelength_rolloff = 12,
                                      .wavelength_short = 4,
                                      .scale = SCALE_RMS_HEIGHT,
                                      .scale_value = 1};
    struct surface_options options = SURFACE_DEFAULTS;
    struct generator *generator = NULL;
    double mean = 0;
    options.amplitudes = AMPLITUDES_RANDOM;
    options.heights = heights;
    options.tolerance = 0.01;
    assert_int_equal(generator_create(&generator, &spectrum, &CELL, &options, NULL), 0);
    for (uint64_t r = 0; r < TRIALS; r++) {
        assert_int_equal(generator_run(generator, (struct random_key){seed, 0, r}, z, NULL, NULL),
                         0);
        mean += widening_of(z) / TRIALS;
    }
    generator_destroy(&generator);
    return mean;
}

static void skewed_heights_scatter(void **state) {
    (void)state;
    const uint64_t seed = seed_or(8);
    const double gaussian = mean_widening((struct heights){.type = HEIGHTS_GAUSSIAN}, seed);
    const double skewed =
        mean_widening((struct heights){.type = HEIGHTS_LOGNORMAL, .shape = 0.4}, seed);
    printf("intervals of the amplitude: %.2f times as wide, of skewed heights %.2f times\n",
           gaussian, skewed);
    /* 19 slow waves know the variance to a third */
    assert_true(gaussian >= 1 && gaussian < 1.25);
    assert_true(skewed > 1.4 && skewed < 4);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(skewed_heights_scatter)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
