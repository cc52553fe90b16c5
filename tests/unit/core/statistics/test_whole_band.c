/* Protects: the spectrum of a map, and that of every second point of it, are what a transform of
 * each finds, whatever the sides of the grid, and nothing is left of the map before. */
#include "core/statistics/heights/roughness.h"
#include "core/statistics/spectra/whole_band.h"
#include "tests/support/check.h"
#include "tests/support/seed.h"
#include <stdlib.h>

enum { POINTS_MOST = 64 * 64 };

static const struct grid GRIDS[] = {
    {64, 64, 16, 16}, {12, 20, 3, 5},  {30, 14, 15, 7}, {45, 33, 9, 9},
    {2, 2, 1, 1},     {256, 1, 32, 1}, {86, 1, 32, 1},  {33, 1, 8, 1},
};

static double next_height(uint64_t *seed) {
    *seed = *seed * 6364136223846793005u + 1442695040888963407u;
    return (double)(*seed >> 11) * 0x1p-53;
}

/* Heights are below 1. A transform loses some 1e-16 of them, and a sum one behind the other at most
 * as much with each. */
static const double ROUNDING = 1e-15, SUM_ROUNDING = POINTS_MOST * 1.2e-16;

static void check_modes(const struct modes *found, const struct grid *grid, const double *z) {
    struct modes expected;
    assert_int_equal(map_modes_measure(grid, z, &expected, NULL), 0);
    assert_int_equal(found->mode_x, expected.mode_x);
    assert_int_equal(found->mode_y, expected.mode_y);
    for (size_t a = 0; a < (expected.mode_x + 1) * (2 * expected.mode_y + 1); a++)
        check_close(found->power[a], expected.power[a], ROUNDING);
    free(expected.power);
}

static void check_map(struct whole_band *band, const struct grid *grid, const struct grid *coarser,
                      uint64_t *seed) {
    static double z[POINTS_MOST], samples[POINTS_MOST / 2];
    double sum = 0;
    for (size_t i = 0; i < grid_points(grid); i++)
        sum += z[i] = next_height(seed);
    check_close(whole_band_measure(band, z), sum / (double)grid_points(grid), SUM_ROUNDING);
    check_modes(whole_band_modes(band), grid, z);
    if (coarser == NULL) {
        assert_null(whole_band_coarser(band));
        return;
    }
    for (size_t j = 0; j < coarser->ny; j++)
        for (size_t i = 0; i < coarser->nx; i++)
            samples[j * coarser->nx + i] = z[2 * j * grid->nx + 2 * i];
    check_modes(whole_band_coarser(band), coarser, samples);
}

static void a_map_and_its_samples_have_their_spectra(void **state) {
    (void)state;
    uint64_t seed = seed_or(12);
    for (size_t g = 0; g < sizeof GRIDS / sizeof *GRIDS; g++) {
        const struct grid *grid = &GRIDS[g];
        bool profile = grid_is_profile(grid);
        bool halved = grid->nx % 2 == 0 && (profile || grid->ny % 2 == 0);
        const struct grid coarser = {grid->nx / 2, profile ? 1 : grid->ny / 2, grid->lx, grid->ly};
        for (int samples = 0; samples <= (halved && coarser.nx > 1); samples++) {
            struct whole_band *band = NULL;
            const struct grid *wanted = samples == 1 ? &coarser : NULL;
            assert_int_equal(whole_band_create(&band, grid, wanted, NULL), 0);
            assert_true(whole_band_bytes(grid, wanted) > 0);
            for (int again = 0; again < 3; again++)
                check_map(band, grid, wanted, &seed);
            whole_band_destroy(&band);
            assert_null(band);
        }
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_map_and_its_samples_have_their_spectra),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
