/* Protects: spikes are found and true peaks stay. Of a quarter of a million points each
 * (RUGO_EFFORT=4: a million) of Gaussian and Weibull surfaces with 4 points a shortest wave, and of
 * white noise, none is taken for a spike; 60 spikes of 8 RMS heights in 400 x 400 points are all
 * found, and nothing else. Pairs, sides, holes,
 * profiles and heights in steps likewise. */
#include "core/map/preparation/despike.h"
#include "core/map/preparation/preparation_words.h"
#include "core/surface/surface.h"
#include "tests/support/check.h"
#include "tests/support/effort.h"
#include "tests/support/noise.h"
#include <stdlib.h>

enum { SIDE = 512, CUT = 400, SPIKES = 60 };
static const struct grid GRID = {SIDE, SIDE, SIDE, SIDE}, LINE = {1 << 18, 1, 1 << 18, 1};

static double standard(void) {
    return strtod(MAP_DESPIKE, NULL);
}

/* What surfaces are tried: a spectrum from `longest` waves a side to 4 points a wave. */
struct recipe {
    const char *name;
    double hurst, longest;
    struct heights heights;
};
static const struct recipe RECIPES[] = {
    {"Gaussian, H = 0.8", 0.8, 4, {.type = HEIGHTS_GAUSSIAN}},
    {"Gaussian, H = 0.2", 0.2, 4, {.type = HEIGHTS_GAUSSIAN}},
    {"Gaussian, ratio 2", 0.8, 64, {.type = HEIGHTS_GAUSSIAN}},
    {"Weibull minimum, C = 1, H = 0.8", 0.8, 8, {.type = HEIGHTS_WEIBULL_MIN, .shape = 1}},
    {"Weibull minimum, C = 1, H = 0.2", 0.2, 8, {.type = HEIGHTS_WEIBULL_MIN, .shape = 1}},
    {"Weibull maximum, C = 1.6, H = 0.5", 0.5, 8, {.type = HEIGHTS_WEIBULL_MAX, .shape = 1.6}},
};
enum { RECIPE_COUNT = sizeof RECIPES / sizeof *RECIPES };

static void make(const struct recipe *recipe, const struct grid *grid, uint64_t seed, double *z) {
    const struct spectrum spectrum = {.type = SPECTRUM_SELF_AFFINE,
                                      .hurst = recipe->hurst,
                                      .wavelength_long = grid->lx / recipe->longest,
                                      .wavelength_rolloff = grid->lx / recipe->longest,
                                      .wavelength_short = 4};
    struct surface_options options = SURFACE_DEFAULTS;
    struct generator *generator = NULL;
    options.heights = recipe->heights;
    options.tolerance = 0.02;
    assert_int_equal(generator_create(&generator, &spectrum, grid, &options, NULL), 0);
    assert_int_equal(generator_run(generator, (struct random_key){seed, 0, 0}, z, NULL, NULL), 0);
    generator_destroy(&generator);
}

static double rms_of(const double *z, size_t points) {
    double mean = 0, square = 0;
    for (size_t point = 0; point < points; point++)
        mean += z[point] / (double)points;
    for (size_t point = 0; point < points; point++)
        square += (z[point] - mean) * (z[point] - mean) / (double)points;
    return sqrt(square);
}

static size_t count_spikes(const struct grid *grid, const double *z, double most) {
    struct despike_result done;
    double *copy = malloc(grid_points(grid) * sizeof *copy);
    assert_non_null(copy);
    for (size_t point = 0; point < grid_points(grid); point++)
        copy[point] = z[point];
    assert_int_equal(despike(grid, copy, most, &done, NULL), 0);
    free(copy);
    return done.spikes;
}

static void true_peaks_stay(void **state) {
    (void)state;
    double *z = malloc(grid_points(&GRID) * sizeof *z);
    assert_non_null(z);
    for (size_t r = 0; r < RECIPE_COUNT; r++) {
        size_t found[3] = {0};
        for (uint64_t part = 0; part < effort(); part++) {
            make(&RECIPES[r], &GRID, 40 + part, z);
            for (int less = 0; less < 3; less++)
                found[less] += count_spikes(&GRID, z, standard() - less);
        }
        print_message("%s: %zu points beyond %g deviations, %zu and %zu beyond one and two less\n",
                      RECIPES[r].name, found[0], standard(), found[1], found[2]);
        assert_int_equal(found[0], 0);
    }
    free(z);
}

static void true_peaks_of_profiles_stay(void **state) {
    (void)state;
    double *z = malloc(grid_points(&LINE) * sizeof *z);
    assert_non_null(z);
    for (size_t r = 0; r < RECIPE_COUNT; r++) {
        struct recipe recipe = RECIPES[r];
        recipe.longest *= 128;
        make(&recipe, &LINE, 77, z);
        const size_t found = count_spikes(&LINE, z, standard());
        print_message("profile, %s: %zu, %zu beyond one less\n", recipe.name, found,
                      count_spikes(&LINE, z, standard() - 1));
        assert_int_equal(found, 0);
    }
    free(z);
}

static void noise_has_no_spikes(void **state) {
    (void)state;
    uint64_t seed = 314;
    double *z = malloc(grid_points(&LINE) * sizeof *z);
    assert_non_null(z);
    noise_fill(&seed, grid_points(&LINE), z);
    assert_int_equal(count_spikes(&(struct grid){512, 512, 1, 1}, z, standard()), 0);
    assert_int_equal(count_spikes(&LINE, z, standard()), 0);
    free(z);
}

/* Adds to 60 points apart from each other 8 RMS heights, up and down. */
static void add_spikes(double *z, double rms, unsigned char *spiked) {
    for (size_t point = 0; point < CUT * CUT; point++)
        spiked[point] = 0;
    for (size_t s = 0; s < SPIKES; s++) {
        /* the last six on the sides, and one and two points from them */
        const size_t along = 50 + 61 * (s % 6), deep = s % 3;
        const size_t inside = (20 + 35 * (s / 6)) * CUT + 25 + 61 * (s % 6) + s % 5;
        const size_t at = s < 54 ? inside : s < 57 ? deep * CUT + along : along * CUT + deep;
        z[at] += s % 2 == 0 ? 8 * rms : -8 * rms;
        spiked[at] = 1;
    }
}

static void spikes_are_found(void **state) {
    (void)state;
    static double z[CUT * CUT];
    static unsigned char spiked[CUT * CUT];
    double *whole = malloc(grid_points(&GRID) * sizeof *whole);
    assert_non_null(whole);
    for (size_t r = 0; r < RECIPE_COUNT; r++) {
        const struct grid grid = {CUT, CUT, CUT, CUT};
        struct despike_result done;
        size_t missed = 0, wrong = 0;
        make(&RECIPES[r], &GRID, 9, whole);
        for (size_t point = 0; point < CUT * CUT; point++)
            z[point] = whole[point / CUT * SIDE + point % CUT];
        add_spikes(z, rms_of(z, CUT * CUT), spiked);
        assert_int_equal(despike(&grid, z, standard(), &done, NULL), 0);
        for (size_t point = 0; point < CUT * CUT; point++) {
            missed += spiked[point] != 0 && !isnan(z[point]) ? 1 : 0;
            wrong += spiked[point] == 0 && isnan(z[point]) ? 1 : 0;
        }
        print_message("%s: %zu spikes missed, %zu points wrongly taken\n", RECIPES[r].name, missed,
                      wrong);
        assert_int_equal(wrong, 0);
        assert_int_equal(missed, 0);
        assert_int_equal(done.spikes, SPIKES);
    }
    free(whole);
}

enum { SMALL = 100 };
/* A wavy map with two spikes beside each other, one in a corner, one beside a hole; and the same
 * with heights in steps so coarse that most points are level with their neighbours. */
static void hard_spikes_are_found(void **state) {
    (void)state;
    const struct grid grid = {SMALL, SMALL, SMALL, SMALL};
    const size_t spikes[] = {10 * SMALL + 10, 10 * SMALL + 11, 0, 25 * SMALL + 31};
    for (int coarse = 0; coarse < 2; coarse++) {
        static double z[SMALL * SMALL];
        struct despike_result done;
        for (size_t point = 0; point < SMALL * SMALL; point++) {
            const size_t i = point % SMALL, j = point / SMALL;
            z[point] = sin(0.3 * (double)i) + cos(0.2 * (double)j);
            z[point] = coarse == 1 ? 2 * round(z[point] / 2) : z[point];
        }
        for (size_t s = 0; s < 4; s++)
            z[spikes[s]] += 40;
        z[25 * SMALL + 30] = (double)NAN;
        assert_int_equal(despike(&grid, z, standard(), &done, NULL), 0);
        assert_int_equal(done.spikes, 4);
        assert_true(done.deviation > 0);
        for (size_t s = 0; s < 4; s++)
            assert_true(isnan(z[spikes[s]]));
    }
}

/* What is looked at for the deviation is a part of many rows; a profile has one. */
static void spikes_of_long_profiles_are_found(void **state) {
    (void)state;
    const size_t points = 600000, every = 50000;
    const struct grid grid = {points, 1, (double)points, 1};
    double *z = array_create(points, sizeof *z);
    struct despike_result result;
    assert_non_null(z);
    for (size_t point = 0; point < points; point++)
        z[point] = sin(0.05 * (double)point) + (point % every == every / 2 ? 200 : 0);
    assert_int_equal(despike(&grid, z, standard(), &result, NULL), 0);
    assert_int_equal(result.spikes, points / every);
    assert_true(result.deviation > 0);
    free(z);
}

static void little_is_left_alone(void **state) {
    (void)state;
    double two[] = {0, 100}, level[] = {1, 1, 1, 1, 1, 1}, empty[] = {NAN, NAN, NAN, NAN};
    struct despike_result done;
    assert_int_equal(despike(&(struct grid){2, 1, 2, 1}, two, 1, &done, NULL), 0);
    assert_int_equal(done.spikes, 0);
    assert_int_equal(despike(&(struct grid){3, 2, 3, 2}, level, 1, &done, NULL), 0);
    assert_true(done.spikes == 0 && done.deviation == 0);
    assert_int_equal(despike(&(struct grid){2, 2, 2, 2}, empty, 1, &done, NULL), 0);
    assert_int_equal(done.spikes, 0);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(true_peaks_stay),
        cmocka_unit_test(true_peaks_of_profiles_stay),
        cmocka_unit_test(noise_has_no_spikes),
        cmocka_unit_test(spikes_are_found),
        cmocka_unit_test(hard_spikes_are_found),
        cmocka_unit_test(little_is_left_alone),
        cmocka_unit_test(spikes_of_long_profiles_are_found),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
