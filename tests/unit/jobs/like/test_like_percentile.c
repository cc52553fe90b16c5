/* Protects: sub-maps of surfaces are measured as a map is, to the bit; the percentile of a surface
 * that is drawn from the same ensemble is uniform; it does not depend on how realisations are cut
 * into blocks; counts below, equal and above, and their ends. */
#include "core/map/preparation/detrend.h"
#include "jobs/like/like_percentile.h"
#include "jobs/statistics/statistics_scalars.h"
#include "jobs/surface/realisation_map.h"
#include "tests/support/statistics_study.h"
#include <stdlib.h>

/* Profiles of 400 points, of which 200 are seen; measured stands for a map's kurtosis. */
static void study_text(char *text, size_t size, bool profile, double measured) {
    snprintf(text, size,
             "{\"surface\": {\"dimension\": %d, \"hurst\": 0.7, \"wavelength_ratio\": 10,"
             " \"length_ratio\": %d, \"points_per_wavelength\": 4, \"rms_slope\": 0.1,"
             " \"amplitudes\": \"random\", \"like\": {\"file\": \"x\", \"sha256\": \"%064d\","
             " \"spacing\": 0.25, \"points\": [%s], \"detrend\": \"plane\","
             " \"quantities\": [\"kurtosis\"], \"measured\": [%.17g]}}}",
             profile ? 1 : 2, profile ? 10 : 2, 0, profile ? "200" : "40, 36", measured);
}

static double patch_scalar(const struct block_result *block, uint64_t r,
                           enum patch_quantity quantity) {
    return block->scalars[r * block->scalar_count + SCALAR_PATCH + (size_t)quantity];
}

static void pieces_are_measured_as_maps(void **state) {
    (void)state;
    for (int profile = 0; profile < 2; profile++) {
        char text[1000];
        study_text(text, sizeof text, profile, 3);
        struct job_runner *runner = runner_of(text);
        struct block_result block = run(runner, 6, 1);
        struct surface_case surface;
        cJSON *parameters = parse(text);
        double *z = NULL, found[PATCH_QUANTITY_COUNT];
        struct surface_report report;
        struct trend trend;
        assert_int_equal(surface_case_read(&surface, parameters, NULL, NULL), 0);
        assert_int_equal(realisation_surface(&surface,
                                             (struct random_key){STUDY_SEED, STUDY_CASE, 6}, &z,
                                             &report, NULL),
                         0);
        size_t nx = profile ? 200 : 40, ny = profile ? 1 : 36;
        const struct grid grid = {nx, ny, 0.25 * (double)nx, 0.25 * (double)ny};
        double *map = calloc(nx * ny, sizeof *map);
        assert_non_null(map);
        for (size_t j = 0; j < ny; j++)
            for (size_t i = 0; i < nx; i++)
                map[j * nx + i] = z[j * surface.grid.nx + i];
        assert_int_equal(detrend(&grid, map, DETREND_PLANE, &trend, NULL), 0);
        const struct measured_map measured = {&grid, map, BOUNDARY_OPEN};
        assert_int_equal(patch_measure(&measured, found, NULL), 0);
        size_t told = 0;
        for (size_t a = 0; a < PATCH_QUANTITY_COUNT; a++) {
            double own = patch_scalar(&block, 0, (enum patch_quantity)a);
            told += isnan(own) ? 0 : 1;
            if (!(own == found[a] || (isnan(own) && isnan(found[a]))))
                fail_msg("%s: %.17g and %.17g", PATCH_NAMES[a], own, found[a]);
        }
        assert_true(told >= PATCH_QUANTITY_COUNT - 2); /* small sub-maps have no texture */
        free(z);
        free(map);
        cJSON_Delete(parameters);
        surface_case_clear(&surface);
        block_result_clear(&block);
        runner_destroy(&runner);
    }
}

/* Each of the draws stands for a measured surface, among others of its own: the percentiles are
 * uniform on their steps by Kolmogorov and Smirnov's test, at a level below one in a hundred, of
 * each quantity. */
static void percentiles_are_uniform(void **state) {
    (void)state;
    enum { DRAWS = 120, OTHERS = 19, STEPS = OTHERS + 1, ALL = DRAWS * STEPS };
    static const double CRITICAL = 1.63; /* of D sqrt(n) */
    char text[1000];
    study_text(text, sizeof text, true, 3);
    struct job_runner *runner = runner_of(text);
    struct block_result block = run(runner, 0, ALL);
    size_t tested = 0;
    for (size_t a = 0; a < PATCH_QUANTITY_COUNT; a++) {
        double values[OTHERS], error, worst = 0;
        size_t found[STEPS] = {0}, below = 0;
        if (a == PATCH_TEXTURE || a == PATCH_CORRELATION_LENGTH)
            continue; /* of surfaces; not each sub-map has one */
        for (size_t d = 0; d < DRAWS; d++) {
            uint64_t first = d * STEPS;
            for (uint64_t r = 0; r < OTHERS; r++)
                values[r] = patch_scalar(&block, first + 1 + r, (enum patch_quantity)a);
            const struct like_place place =
                like_place_of(OTHERS, values, patch_scalar(&block, first, (enum patch_quantity)a));
            assert_int_equal(place.below + place.equal + place.above, OTHERS);
            found[(size_t)(like_percentile(&place, &error) / 100 * STEPS)]++;
        }
        for (size_t step = 0; step < STEPS; step++) {
            below += found[step];
            worst = fmax(worst, fabs((double)below / DRAWS - (double)(step + 1) / STEPS));
        }
        print_message("%s: D sqrt(n) = %.2f\n", PATCH_NAMES[a], worst * sqrt(DRAWS));
        assert_true(worst * sqrt(DRAWS) < CRITICAL);
        tested++;
    }
    assert_true(tested >= 14);
    block_result_clear(&block);
    runner_destroy(&runner);
}

/* However the realisations are cut, the same percentile, and that of the counts. */
static void cuts_do_not_matter(void **state) {
    (void)state;
    char text[1000];
    study_text(text, sizeof text, false, 2.6);
    struct job_runner *runner = runner_of(text);
    double first = NAN;
    for (uint64_t size = 1; size <= REALISATIONS; size += 7) {
        struct job_merger *merger = merger_of(text);
        size_t below = 0;
        for (uint64_t at = 0; at < REALISATIONS; at += size) {
            struct block_result part =
                run(runner, at, at + size <= REALISATIONS ? size : REALISATIONS - at);
            for (uint64_t r = 0; r < part.count; r++)
                below += patch_scalar(&part, r, PATCH_KURTOSIS) < 2.6;
            merge(merger, &part);
            block_result_clear(&part);
        }
        cJSON *document = curves_of(merger);
        double percentile = scalar(document, "percentile_kurtosis", "value");
        assert_true(percentile == 100 * ((double)below + 0.5) / (REALISATIONS + 1));
        assert_true(scalar(document, "measured_kurtosis", "value") == 2.6);
        assert_true(scalar(document, "piece_kurtosis", "standard_error") > 0);
        assert_true(isnan(scalar(document, "percentile_skewness", "value"))); /* not measured */
        assert_true(isnan(first) || percentile == first);
        first = percentile;
        cJSON_Delete(document);
        merger_destroy(&merger);
    }
    runner_destroy(&runner);
}

static void counts(void **state) {
    (void)state;
    const double values[] = {1, 2, 2, 3, NAN};
    double error;
    struct like_place place = like_place_of(5, values, 2);
    assert_true(place.below == 1 && place.equal == 2 && place.above == 1);
    assert_true(like_percentile(&place, &error) == 100 * (1 + 1.5) / 5);
    assert_true(fabs(error - 100 * sqrt(0.5 * 0.5 / 4)) < 1e-12);
    place = like_place_of(5, values, 7);
    assert_true(like_percentile(&place, &error) == 100 * 4.5 / 5);
    place = like_place_of(0, values, 7);
    assert_true(isnan(like_percentile(&place, &error)) && isnan(error));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(pieces_are_measured_as_maps),
        cmocka_unit_test(percentiles_are_uniform),
        cmocka_unit_test(cuts_do_not_matter),
        cmocka_unit_test(counts),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
