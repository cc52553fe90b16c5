/* Protects: noise that governs the slopes of a map is found, of surfaces and profiles, open and
 * periodic, with the slope that the map has without it; maps without noise have none. */
#include "tests/support/check.h"

#include "core/random.h"
#include "core/surface/surface.h"
#include "jobs/maps/map_noise.h"
#include <stdlib.h>

static const double SLOPE = 0.2;

/* A surface or profile of eight points a shortest wave, and noise of so many RMS heights. */
static double *map_of(const struct grid *grid, double noise) {
    const struct spectrum law = {.type = SPECTRUM_SELF_AFFINE,
                                 .hurst = 0.7,
                                 .wavelength_long = grid->lx,
                                 .wavelength_rolloff = 64,
                                 .wavelength_short = 8,
                                 .scale = SCALE_RMS_SLOPE,
                                 .scale_value = SLOPE};
    struct surface_options options = SURFACE_DEFAULTS;
    struct generator *generator = NULL;
    const size_t points = grid_points(grid);
    double *z = malloc(points * sizeof *z), *white = malloc(points * sizeof *white), square = 0;
    assert_non_null(z);
    assert_non_null(white);
    options.amplitudes = AMPLITUDES_RANDOM;
    assert_int_equal(generator_create(&generator, &law, grid, &options, NULL), 0);
    assert_int_equal(generator_run(generator, (struct random_key){6, 0, 0}, z, NULL, NULL), 0);
    generator_destroy(&generator);
    random_uniform((struct random_key){7, 0, 0}, STREAM_HEIGHTS, 0, points, white);
    for (size_t n = 0; n < points; n++)
        square += z[n] * z[n] / (double)points;
    for (size_t n = 0; n < points; n++) /* of mean square 1/12 */
        z[n] += noise * sqrt(12 * square) * (white[n] - 0.5);
    free(white);
    return z;
}

static void noise_is_found(void **state) {
    (void)state;
    static const struct grid GRIDS[] = {{256, 256, 256, 256}, {4096, 1, 4096, 4096}};
    for (size_t g = 0; g < 2; g++)
        for (int boundary = BOUNDARY_PERIODIC; boundary <= BOUNDARY_OPEN; boundary++) {
            double *noisy = map_of(&GRIDS[g], 0.05), *clean = map_of(&GRIDS[g], 0);
            const struct measured_map with = {&GRIDS[g], noisy, (enum boundary)boundary};
            const struct measured_map without = {&GRIDS[g], clean, (enum boundary)boundary};
            struct map_noise noise;
            assert_int_equal(map_noise_measure(&noise, &with, NULL), 0);
            assert_true(noise.governs);
            assert_true(noise.slope > 1.02 * SLOPE);
            check_relative(noise.without, SLOPE, 0.1); /* of one map, without its finest points */
            assert_int_equal(map_noise_measure(&noise, &without, NULL), 0);
            assert_false(noise.governs);
            free(noisy);
            free(clean);
        }
}

/* Holes, 12 % and fewer, look like noise in a spectrum; without it the law has a larger slope. */
static void holes_are_no_noise(void **state) {
    (void)state;
    static const struct grid GRID = {256, 256, 256, 256};
    for (size_t every = 8; every < 60; every += 10) {
        double *z = map_of(&GRID, 0);
        const struct measured_map map = {&GRID, z, BOUNDARY_OPEN};
        struct map_noise noise;
        for (size_t n = 0; n < grid_points(&GRID); n++)
            z[n] = n * 7919 % 131 % every == 0 ? (double)NAN : z[n];
        assert_int_equal(map_noise_measure(&noise, &map, NULL), 0);
        assert_false(noise.governs);
        free(z);
    }
}

static void flat_maps_have_none(void **state) {
    (void)state;
    const struct grid grid = {32, 32, 32, 32};
    double *z = calloc(grid_points(&grid), sizeof *z);
    const struct measured_map map = {&grid, z, BOUNDARY_OPEN};
    struct map_noise noise;
    assert_non_null(z);
    assert_int_equal(map_noise_measure(&noise, &map, NULL), 0);
    assert_false(noise.governs);
    free(z);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(noise_is_found),
        cmocka_unit_test(holes_are_no_noise),
        cmocka_unit_test(flat_maps_have_none),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
