/* Protects: what is measured of a map: heights, summits, their errors, of spiked maps too, and
 * distribution, isotropy, stationarity, scales, spectra and histogram as typed values; that a map
 * too small for errors has none; that a window takes bands and law away; and what is refused. */
#include "jobs/maps/map_characterisation.h"
#include "tests/support/check.h"
#include "tests/support/noise.h"
#include <stdlib.h>
#include <string.h>

enum { SIDE = 64, POINTS = SIDE * SIDE };

/* Of an open map of these heights, 32 by 32, or of a profile of the first row. */
static int characterise(struct map_characterisation *out, double *z, bool profile,
                        double window_power, const struct spectrum_fit_request *trusted,
                        struct error *err) {
    const struct height_map map = {.grid = {SIDE, profile ? 1 : SIDE, 32, profile ? 1 : 32},
                                   .z = z};
    const struct preparation_record record = {.boundary = BOUNDARY_OPEN,
                                              .window_power = window_power};
    *out = (struct map_characterisation){0};
    return map_characterise(out, &map, &record, trusted, MAP_WHOLE, err);
}

static void noise_is_alike_everywhere(void **state) {
    (void)state;
    static struct map_characterisation found;
    static double z[POINTS];
    const struct spectrum_fit_request trusted = {0};
    uint64_t seed = seed_or(14);
    double heights = 0;
    noise_fill(&seed, POINTS, z);
    assert_int_equal(characterise(&found, z, false, 1, &trusted, NULL), 0);
    const struct map_summits *summits = &found.parameters.summits[SUMMITS_NINE_POINT];
    assert_true(found.certainty.has_errors && found.hills_have_errors);
    assert_string_equal(found.certainty.reason, "standard");
    check_relative(found.errors.sq, found.parameters.roughness.rms_height * sqrt(0.5 / POINTS),
                   0.7);
    check_close(found.areal.sq, found.parameters.roughness.rms_height, 1e-12);
    /* One of nine points of white noise is the highest of its nine: 62 x 62 are searched. */
    assert_true(summits->sought && summits->has_errors);
    check_relative(summits->count, 62.0 * 62 / 9, 0.15);
    assert_true(summits->errors.density > 0 && summits->errors.height_mean > 0);
    assert_int_equal(found.height_fits.best, HEIGHTS_GAUSSIAN);
    assert_true(found.directions.p_value > 1e-4 && found.stationarity_p_value > 1e-4);
    assert_true(found.scales.count > 2 && found.scales.scale[0].slope_error > 0);
    assert_true(found.scales.scale[1].found.length == 2 * found.scales.scale[0].found.length);
    for (size_t b = 0; b < found.histogram.count; b++)
        heights += found.histogram.counts[b];
    assert_true(heights == POINTS && found.histogram.total == POINTS);
    assert_true(found.spectra.has_fit && found.spectra.rings.low[5] < found.spectra.rings.high[5]);
    assert_true(found.spectra.line[0].count > 0 && found.spectra.line[1].count > 0);
    check_close(found.correlation.y[0], 1, 1e-12);
    assert_true(found.quantiles.count > 10);
    assert_false(map_height_law_find(&(struct map_height_law){.heights = {0}}, &found));
    map_characterisation_clear(&found);
    map_characterisation_clear(&found);
}

/* Heights that are drawn to steps have another volume of valleys than those that are not, by about
 * what is added to its error where steps were found and noise was taken out. */
static void steps_are_in_errors_of_volumes(void **state) {
    (void)state;
    enum { PLAIN, DRAWN, KNOWN, CASES };
    static const double STEP = 0.5, DRAW = 0.02;
    static struct map_characterisation found[CASES];
    static double z[POINTS];
    const struct spectrum_fit_request trusted = {0};
    const struct height_map map = {.grid = {SIDE, SIDE, 32, 32}, .z = z};
    uint64_t seed = seed_or(15);
    noise_fill(&seed, POINTS, z);
    for (int n = PLAIN; n < CASES; n++) {
        struct preparation_record record = {
            .boundary = BOUNDARY_OPEN, .window_power = 1, .denoised = true, .denoised_to = 2};
        record.artefacts.steps.step = n == KNOWN ? STEP : 0;
        for (size_t point = 0; point < POINTS && n == DRAWN; point++)
            z[point] += DRAW * sin(2 * M_PI * z[point] / STEP);
        assert_int_equal(map_characterise(&found[n], &map, &record, &trusted, MAP_WHOLE, NULL), 0);
    }
    const double change = found[DRAWN].functional.found.vvv - found[PLAIN].functional.found.vvv;
    const double known = found[KNOWN].functional.errors.found.vvv;
    const double unknown = found[DRAWN].functional.errors.found.vvv;
    check_relative(sqrt(known * known - unknown * unknown), fabs(change), 0.3);
    assert_true(found[KNOWN].functional.errors.found.xp > found[DRAWN].functional.errors.found.xp);
    check_close(found[KNOWN].functional.errors.found.line.k,
                found[DRAWN].functional.errors.found.line.k, 0);
    for (int n = PLAIN; n < CASES; n++)
        map_characterisation_clear(&found[n]);
}

/* Fills a map that repeats with skewed heights whose waves are a few points long: the exponential
 * of means of noise over squares. */
static void fill_skewed(uint64_t *seed, double *z) {
    enum { REACH = 4 };
    static double noise[POINTS];
    noise_fill(seed, POINTS, noise);
    for (size_t point = 0; point < POINTS; point++) {
        double sum = 0;
        for (size_t n = 0; n < REACH * REACH; n++)
            sum +=
                noise[(point / SIDE + n / REACH) % SIDE * SIDE + (point % SIDE + n % REACH) % SIDE];
        z[point] = exp(0.3 * sum / REACH);
    }
}

/* Spikes are in no law of the heights: one that fits all others must not make errors smaller than
 * they are without spikes. */
static void spikes_leave_errors_of_heights(void **state) {
    (void)state;
    enum { PLAIN, SPIKED, CASES };
    static struct map_characterisation found[CASES];
    static double z[POINTS];
    const struct spectrum_fit_request trusted = {0};
    const struct height_map map = {.grid = {SIDE, SIDE, 32, 32}, .z = z};
    struct preparation_record record = {.boundary = BOUNDARY_OPEN, .window_power = 1};
    uint64_t seed = seed_or(17);
    fill_skewed(&seed, z);
    for (int n = PLAIN; n < CASES; n++) {
        for (size_t point = 100; point < POINTS && n == SPIKED; point += 1500)
            z[point] += 8;
        assert_int_equal(map_artefacts_find_left(&map.grid, z, &record.artefacts, NULL), 0);
        assert_true(map_spikes_count(&record.artefacts) == (n == SPIKED));
        assert_int_equal(map_characterise(&found[n], &map, &record, &trusted, MAP_WHOLE, NULL), 0);
        const struct height_fits *fits = &found[n].height_fits;
        assert_true(fits->best != HEIGHTS_GAUSSIAN && fits->list[fits->best].p_value > 0.001);
    }
    assert_true(found[SPIKED].errors.sq > 0.9 * found[PLAIN].errors.sq);
    for (int n = PLAIN; n < CASES; n++)
        map_characterisation_clear(&found[n]);
}

/* One wave: nothing in it is independent. */
static void too_few_lengths_have_no_errors(void **state) {
    (void)state;
    static struct map_characterisation found;
    static double z[POINTS];
    const struct spectrum_fit_request trusted = {0};
    for (size_t point = 0; point < POINTS; point++)
        z[point] = cos(2 * M_PI * (double)(point % SIDE) / SIDE);
    assert_int_equal(characterise(&found, z, false, 1, &trusted, NULL), 0);
    assert_false(found.certainty.has_errors || found.hills_have_errors);
    assert_string_equal(
        found.certainty.reason,
        "none: along some direction heights stay correlated all over the map, as along grooves");
    assert_true(isnan(found.certainty.freedom) && isnan(found.stationarity_p_value));
    assert_false(found.parameters.summits[SUMMITS_NINE_POINT].has_errors);
    assert_true(isnan(found.height_fits.list[found.height_fits.best].p_value));
    assert_true(isnan(found.directions.p_value) && found.directions.fine.ratio > 10);
    assert_true(isnan(found.scales.scale[0].slope_error));
    map_characterisation_clear(&found);
}

/* Heights that are exponential have a law that is drawn beside the normal one: of Weibull's with
 * shape 1 the density falls by a factor e over a standard deviation. */
static void skewed_heights_have_a_law(void **state) {
    (void)state;
    static struct map_characterisation found;
    static double z[POINTS];
    const struct spectrum_fit_request trusted = {0};
    struct map_height_law law;
    uint64_t seed = seed_or(15);
    noise_fill(&seed, POINTS, z);
    for (size_t point = 0; point < POINTS; point++)
        z[point] = -log(0.5 * erfc(z[point] / sqrt(2)));
    assert_int_equal(characterise(&found, z, false, 1, &trusted, NULL), 0);
    assert_true(map_height_law_find(&law, &found));
    check_relative(map_height_law_density(&law, 1, 1, 1), exp(-1), 0.1);
    check_relative(map_height_law_density(&law, 2, 1, 1), exp(-2), 0.15);
    map_characterisation_clear(&found);
}

static void profiles_have_no_areal_parameters(void **state) {
    (void)state;
    static struct map_characterisation found;
    static double z[POINTS];
    const struct spectrum_fit_request trusted = {0};
    uint64_t seed = seed_or(16);
    noise_fill(&seed, SIDE, z);
    assert_int_equal(characterise(&found, z, true, 1, &trusted, NULL), 0);
    assert_false(found.parameters.summits[SUMMITS_FIVE_POINT].sought);
    assert_true(found.parameters.summits[SUMMITS_REFINED].sought);
    assert_int_equal(found.spectra.line[1].count, 0);
    assert_false(found.hills_have_errors);
    map_characterisation_clear(&found);
}

static void a_window_takes_bands_away(void **state) {
    (void)state;
    static struct map_characterisation found;
    static double z[POINTS];
    const struct spectrum_fit_request trusted = {0};
    uint64_t seed = seed_or(17);
    noise_fill(&seed, POINTS, z);
    assert_int_equal(characterise(&found, z, false, 0.5, &trusted, NULL), 0);
    assert_string_equal(found.certainty.reason, "none: the map is under a window");
    assert_false(found.spectra.has_fit);
    assert_null(found.spectra.rings.low);
    assert_null(found.spectra.rings.law);
    assert_true(found.spectra.rings.count > 0 && found.spectra.rings.density[3] > 0);
    map_characterisation_clear(&found);
}

static void waves_that_are_none_are_refused(void **state) {
    (void)state;
    static struct map_characterisation found;
    static double z[POINTS];
    const struct spectrum_fit_request trusted = {.longest = 1e-3, .shortest = 1e-4};
    struct error err = {0};
    uint64_t seed = seed_or(18);
    noise_fill(&seed, POINTS, z);
    assert_int_equal(characterise(&found, z, false, 1, &trusted, &err), ERROR_INPUT);
    assert_true(strlen(err.text) > 20);
    map_characterisation_clear(&found);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(noise_is_alike_everywhere),
        cmocka_unit_test(steps_are_in_errors_of_volumes),
        cmocka_unit_test(spikes_leave_errors_of_heights),
        cmocka_unit_test(too_few_lengths_have_no_errors),
        cmocka_unit_test(skewed_heights_have_a_law),
        cmocka_unit_test(profiles_have_no_areal_parameters),
        cmocka_unit_test(a_window_takes_bands_away),
        cmocka_unit_test(waves_that_are_none_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
