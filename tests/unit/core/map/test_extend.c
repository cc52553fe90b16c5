/* Protects: an extended map holds the patch to its noise, fills its holes by the law, has the RMS
 * slope of the surface that the patch was cut from, without the noise, everywhere, with a lay too,
 * and its skewness; one number is one draw; a map without a law is refused and stays. */
#include "core/map/preparation/extend.h"
#include "core/statistics/heights/roughness.h"
#include "core/surface/surface.h"
#include "tests/support/check.h"
#include "tests/support/noise.h"
#include <stdlib.h>
#include <string.h>

enum { CELL = 256, NX = 128, NY = 96 };

/* Heights of RMS 1 and four points a shortest wave, with a lay of this ratio at 30 degrees. */
static double *surface_of(double ratio, uint64_t seed) {
    static const struct grid GRID = {CELL, CELL, CELL, CELL};
    const struct spectrum law = {.type = SPECTRUM_SELF_AFFINE,
                                 .hurst = 0.7,
                                 .wavelength_long = CELL,
                                 .wavelength_rolloff = 32,
                                 .wavelength_short = 4,
                                 .anisotropy = ratio,
                                 .lay_angle = M_PI / 6,
                                 .scale = SCALE_RMS_HEIGHT,
                                 .scale_value = 1};
    struct surface_options options = SURFACE_DEFAULTS;
    struct generator *generator = NULL;
    double *z = malloc(grid_points(&GRID) * sizeof *z);
    assert_non_null(z);
    options.amplitudes = AMPLITUDES_RANDOM;
    assert_int_equal(generator_create(&generator, &law, &GRID, &options, NULL), 0);
    assert_int_equal(generator_run(generator, (struct random_key){seed, 0, 0}, z, NULL, NULL), 0);
    generator_destroy(&generator);
    return z;
}

/* Cuts a patch out, 5 higher and with noise of this RMS height. */
static void cut(struct height_map *map, const double *z, double noise, uint64_t seed) {
    *map = (struct height_map){.grid = {NX, NY, NX, NY}};
    double *white = malloc(sizeof *white * NX * NY);
    map->z = malloc(sizeof *map->z * NX * NY);
    assert_non_null(map->z);
    assert_non_null(white);
    noise_fill(&seed, (size_t)NX * NY, white);
    for (size_t p = 0; p < (size_t)NX * NY; p++)
        map->z[p] = 5 + z[p / NX * CELL + p % NX] + noise * white[p];
    free(white);
}

static double rms_difference(const struct height_map *map, const double *other, size_t stride,
                             double base) {
    double total = 0;
    for (size_t j = 0; j < NY; j++)
        for (size_t i = 0; i < NX; i++) {
            const double less = map->z[j * map->grid.nx + i] - base - other[j * stride + i];
            total += less * less;
        }
    return sqrt(total / (NX * NY));
}

static void a_patch_is_held(void **state) {
    (void)state;
    static const struct { double ratio, noise; } CASES[] = {{1, 0}, {1, 0.05}, {2.5, 0.05}};
    for (size_t c = 0; c < sizeof CASES / sizeof *CASES; c++) {
        const struct grid whole = {CELL, CELL, CELL, CELL};
        const double noise = CASES[c].noise;
        double *z = surface_of(CASES[c].ratio, 3 + c);
        struct roughness truth, found;
        struct height_map map;
        struct extend_result done;
        cut(&map, z, noise, 7 + c);
        for (size_t p = 30; p < 40; p++) /* holes */
            map.z[40 * NX + p] = map.z[41 * NX + p] = (double)NAN;
        roughness_measure(&whole, z, &truth);
        assert_int_equal(map_extend(&map, DETREND_NONE, 1, &done, NULL), 0);
        assert_int_equal(map.grid.nx, 2 * NX);
        assert_int_equal(map.grid.ny, 2 * NY);
        check_close(map.grid.lx, 2 * NX, 1e-12);
        roughness_measure(&map.grid, map.z, &found);
        print_message("ratio %g, noise %g: found %.4f, held %.3f, power %.3f, %zu steps; RMS "
                      "slope %.4f of %.4f, height %.3f of %.3f\n",
                      CASES[c].ratio, noise, done.noise, done.draw.held, done.draw.power,
                      done.draw.steps, found.rms_slope, truth.rms_slope, found.rms_height,
                      truth.rms_height);
        assert_int_equal(done.draw.points, NX * NY - 20);
        assert_true(done.noise_seen == (noise > 0));
        check_relative(done.noise, noise > 0 ? noise : 1e-3, noise > 0 ? 0.1 : 0.2);
        check_close(done.draw.held, 1, noise > 0 ? 0.1 : 3);
        assert_true(done.draw.power > 0.1 && done.draw.power < 1.2);
        check_relative(found.rms_slope, truth.rms_slope, 0.08);
        check_relative(found.rms_height, truth.rms_height, 0.3);
        /* noise is not the surface's: where waves are, the surface itself is nearer */
        assert_true(rms_difference(&map, z, CELL, 5) < (noise > 0 ? noise : 0.02));
        height_map_clear(&map);
        free(z);
    }
}

static void one_number_is_one_draw(void **state) {
    (void)state;
    double *z = surface_of(1, 21);
    struct height_map first, again, other;
    struct extend_result done;
    cut(&first, z, 0.02, 3);
    cut(&again, z, 0.02, 3);
    cut(&other, z, 0.02, 3);
    assert_int_equal(map_extend(&first, DETREND_NONE, 5, &done, NULL), 0);
    assert_int_equal(map_extend(&again, DETREND_NONE, 5, &done, NULL), 0);
    assert_int_equal(map_extend(&other, DETREND_NONE, 6, &done, NULL), 0);
    const size_t points = grid_points(&first.grid), far = (2 * NY - NY / 2) * 2 * NX + NX * 3 / 2;
    assert_memory_equal(first.z, again.z, points * sizeof *first.z);
    assert_true(fabs(first.z[far] - other.z[far]) > 1e-3);
    assert_true(rms_difference(&first, other.z, 2 * NX, 0) < 0.04);
    height_map_clear(&first);
    height_map_clear(&again);
    height_map_clear(&other);
    free(z);
}

/* Heights exp(z/2) - 1 have a skewness of 1.75; those that are added have it, too. */
static void skewed_heights_stay_skewed(void **state) {
    (void)state;
    double *z = surface_of(1, 31);
    const struct grid whole = {CELL, CELL, CELL, CELL};
    struct roughness truth, found;
    struct height_map map;
    struct extend_result done;
    for (size_t p = 0; p < (size_t)CELL * CELL; p++)
        z[p] = exp(z[p] / 2) - 1;
    roughness_measure(&whole, z, &truth);
    cut(&map, z, 0, 3);
    map.z[500] = (double)NAN;
    assert_int_equal(map_extend(&map, DETREND_NONE, 2, &done, NULL), 0);
    roughness_measure(&map.grid, map.z, &found);
    print_message("skewness %.3f of %.3f, RMS slope %.4f of %.4f, height %.3f of %.3f; off by "
                  "%.2g, %.3f of the noise in scores\n",
                  found.skewness, truth.skewness, found.rms_slope, truth.rms_slope,
                  found.rms_height, truth.rms_height, done.draw.difference, done.draw.held);
    assert_true(done.translated && truth.skewness > 1);
    check_relative(found.skewness, truth.skewness, 0.35);
    check_relative(found.rms_slope, truth.rms_slope, 0.12);
    assert_true(done.draw.difference > 0 && done.draw.difference < 0.01 * truth.rms_height);
    check_relative(rms_difference(&map, z, CELL, 5), done.draw.difference, 0.01);
    height_map_clear(&map);
    free(z);
}

static void a_map_without_law_stays(void **state) {
    (void)state;
    double heights[] = {1, 2, 4, 3, 2, 2, 1, 5, 4, 4, 3, 1, 2, 3, 4, 5};
    struct height_map map = {.grid = {4, 4, 4, 4}, .z = heights};
    struct extend_result done;
    struct error err;
    assert_int_equal(map_extend(&map, DETREND_NONE, 1, &done, &err), ERROR_INPUT);
    assert_non_null(strstr(err.text, "no law fits"));
    assert_true(map.z == heights && map.grid.nx == 4);
    for (size_t p = 0; p < 16; p++)
        heights[p] = 1;
    assert_int_equal(map_extend(&map, DETREND_NONE, 1, &done, &err), ERROR_INPUT);
    assert_non_null(strstr(err.text, "no heights that differ"));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_patch_is_held),
        cmocka_unit_test(one_number_is_one_draw),
        cmocka_unit_test(skewed_heights_stay_skewed),
        cmocka_unit_test(a_map_without_law_stays),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
