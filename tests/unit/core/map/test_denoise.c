/* Protects: noise is taken out of a map so that it has the RMS height, slope and curvature that it
 * had before the noise came, open and periodic, of surfaces with a lay or none, and of profiles; a
 * map without noise stays bit for bit. */
#include "core/map/preparation/denoise.h"
#include "core/statistics/heights/roughness.h"
#include "core/surface/surface.h"
#include "tests/support/check.h"
#include "tests/support/noise.h"
#include <stdlib.h>
#include <string.h>

/* A surface or profile of four points a shortest wave, of RMS height 1, with a lay of this ratio
 * along x. */
static double *map_of(const struct grid *grid, double ratio, uint64_t seed) {
    const struct spectrum law = {.type = SPECTRUM_SELF_AFFINE,
                                 .hurst = 0.7,
                                 .wavelength_long = grid->lx,
                                 .wavelength_rolloff = 40,
                                 .wavelength_short = 4,
                                 .anisotropy = ratio,
                                 .scale = SCALE_RMS_HEIGHT,
                                 .scale_value = 1};
    struct surface_options options = SURFACE_DEFAULTS;
    struct generator *generator = NULL;
    double *z = malloc(grid_points(grid) * sizeof *z);
    assert_non_null(z);
    options.amplitudes = AMPLITUDES_RANDOM;
    assert_int_equal(generator_create(&generator, &law, grid, &options, NULL), 0);
    assert_int_equal(generator_run(generator, (struct random_key){seed, 0, 0}, z, NULL, NULL), 0);
    generator_destroy(&generator);
    return z;
}

static void measure(const struct grid *grid, const double *z, struct roughness *out) {
    const struct measured_map map = {grid, z, BOUNDARY_OPEN};
    open_roughness_measure(&map, out);
}

static void noise_is_taken_out(void **state) {
    (void)state;
    static const struct grid GRIDS[] = {
        {192, 160, 192, 160}, {8000, 1, 8000, 8000}, {192, 192, 192, 192}};
    static const double RATIO[] = {1, 1, 3};
    /* of one map, whose law has an error of its own; profiles have fewer waves */
    static const double TOLERANCE[] = {0.02, 0.06, 0.04}, NOISE_TOLERANCE[] = {0.1, 0.3, 0.2};
    for (size_t g = 0; g < 3; g++)
        for (int boundary = BOUNDARY_PERIODIC; boundary <= BOUNDARY_OPEN; boundary++) {
            const size_t points = grid_points(&GRIDS[g]);
            double *z = map_of(&GRIDS[g], RATIO[g], 3 + g), *white = malloc(points * sizeof *white);
            struct roughness clean, left;
            struct denoise_result done;
            uint64_t seed = 5;
            assert_non_null(white);
            measure(&GRIDS[g], z, &clean);
            noise_fill(&seed, points, white);
            for (size_t p = 0; p < points; p++)
                z[p] += 0.05 * white[p];
            assert_int_equal(map_denoise(&GRIDS[g], z, (enum boundary)boundary, &done, NULL), 0);
            measure(&GRIDS[g], z, &left);
            assert_true(done.found && done.slope_before > 1.02 * clean.rms_slope);
            check_relative(done.noise, 0.05, NOISE_TOLERANCE[g]);
            check_relative(left.rms_height, clean.rms_height, TOLERANCE[g]);
            check_relative(left.rms_slope, clean.rms_slope, TOLERANCE[g]);
            check_relative(left.rms_curvature, clean.rms_curvature, 2 * TOLERANCE[g]);
            check_relative(done.slope_after, left.rms_slope, 0.01);
            free(white);
            free(z);
        }
}

static void a_clean_map_stays(void **state) {
    (void)state;
    static const struct grid GRID = {160, 160, 160, 160};
    double *z = map_of(&GRID, 1, 8), *before = malloc(grid_points(&GRID) * sizeof *before);
    struct denoise_result done;
    assert_non_null(before);
    memcpy(before, z, grid_points(&GRID) * sizeof *z);
    assert_int_equal(map_denoise(&GRID, z, BOUNDARY_OPEN, &done, NULL), 0);
    assert_false(done.found);
    assert_memory_equal(before, z, grid_points(&GRID) * sizeof *z);
    free(before);
    free(z);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(noise_is_taken_out),
        cmocka_unit_test(a_clean_map_stays),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
