/* Protects: the law difference of contact: that surfaces of the other law are those which a study
 * of that law has, pressed in their own units; that differences follow from the pairs, with their
 * sign; that curves over loads, scalars at a load and densities of pressure have it, but not with
 * Gaussian heights; and that values do not depend on whether it is probed. */
#include "jobs/contact/case/contact_case_read.h"
#include "jobs/contact/companion/companion.h"
#include "jobs/contact/companion/companion_law.h"
#include "jobs/merger.h"
#include "jobs/runner.h"
#include "jobs/surface/other_law.h"
#include "tests/support/check.h"
#include "tests/support/unstopped.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { LOADS = 3 };
#define STUDY(heights, contact)                                                                    \
    "{\"surface\": {\"dimension\": 1, \"hurst\": 0.8, \"wavelength_ratio\": 4,"                    \
    " \"length_ratio\": 4, \"points_per_wavelength\": 8, \"rms_slope\": 0.1" heights               \
    "}, \"contact\": {\"pressures\": {\"values\": [0.01, 0.1, 0.15]}" contact "}}"
#define WEIBULL ", \"heights\": {\"distribution\": \"weibull_min\", \"shape\": 1}"
#define TRANSLATED                                                                                 \
    ", \"amplitudes\": \"random\", \"heights\": {\"distribution\": \"weibull_min\", \"shape\": "   \
    "2, \"law\": "                                                                                 \
    "\"translation\"}"
#define ITERATED                                                                                   \
    ", \"amplitudes\": \"random\", \"heights\": {\"distribution\": \"weibull_min\", \"shape\": 2}"

static void read_case(struct contact_case *one_case, const char *text) {
    struct error err = {0};
    cJSON *parameters = cJSON_Parse(text);
    assert_non_null(parameters);
    must(contact_case_read(one_case, parameters, 0, NULL, &err), &err);
    cJSON_Delete(parameters);
}

/* --- one realisation --- */

/* Series: the surface of the case, and that of the other law (companion_plan.h). */
enum { OWN, OTHER };

/* Areas by edges of heights on the own grid, pressed on the coarse mesh. */
static void press(const struct contact_case *one_case, const struct moments *moments,
                  const double *z, double areas[LOADS]) {
    const struct contact_stopper stopper = {go_on, NULL};
    const struct contact_level level = coarse_level(one_case);
    struct coarse_solver *halfspace;
    struct error err = {0};
    double *coarse = array_create(grid_points(&level.grid), sizeof *coarse);
    double series[MEASURE_PAIRED * LOADS];
    assert_non_null(coarse);
    must(coarse_solver_create(&halfspace, one_case, &level.grid, INFINITY, moments, &err), &err);
    must(contact_level_sample(&level, &one_case->surface,
                              &(struct level_source){.rms_height = moments->rms_height}, z, coarse,
                              &err),
         &err);
    must(coarse_solver_press(halfspace, coarse, series, &stopper, &err), &err);
    memcpy(areas, series + MEASURE_EDGES * LOADS, LOADS * sizeof *areas);
    coarse_solver_destroy(&halfspace);
    free(coarse);
}

static void check_series(struct contact_tally *tally, size_t series, const double areas[LOADS]) {
    const double *values = contact_tally_series(tally, COMPANION_LAW, series, MEASURE_EDGES);
    for (size_t k = 0; k < LOADS; k++)
        check_relative(values[k], areas[k], 1e-9);
}

/* The surface of a case, with its moments and areas. */
struct pressed {
    struct moments moments;
    double *z, areas[LOADS];
};

static struct pressed make(const struct contact_case *one_case, struct random_key key) {
    const struct surface_case *surface = &one_case->surface;
    struct pressed out = {.z = array_create(grid_points(&surface->grid), sizeof *out.z)};
    struct generator *generator;
    struct error err = {0};
    assert_non_null(out.z);
    must(generator_create(&generator, &surface->spectrum, &surface->grid, &surface->options, &err),
         &err);
    modes_moments(generator_modes(generator), &out.moments);
    must(generator_run(generator, key, out.z, NULL, &err), &err);
    press(one_case, &out.moments, out.z, out.areas);
    generator_destroy(&generator);
    return out;
}

/* Series of a case of the one law are areas of the cases of both. */
static void surfaces_are_of_the_other_law(const char *text, const char *other_text) {
    const struct random_key key = {5, 2, 8};
    const struct contact_stopper stopper = {go_on, NULL};
    struct contact_case one_case, other_case;
    struct companion_bench *companions;
    struct contact_tally tally;
    struct error err = {0};
    read_case(&one_case, text);
    read_case(&other_case, other_text);
    struct pressed own = make(&one_case, key), other = make(&other_case, key);
    must(contact_tally_create(&tally, &one_case, &err), &err);
    must(companion_bench_create(&companions, &one_case, &own.moments, &err), &err);
    const struct contact_surface whole = {key, own.z};
    must(companion_bench_solve(companions, &whole, &tally, &stopper, &err), &err);
    check_series(&tally, OWN, own.areas);
    check_series(&tally, OTHER, other.areas);
    assert_true(own.areas[0] != other.areas[0]);
    companion_bench_destroy(&companions);
    contact_tally_clear(&tally);
    contact_case_clear(&one_case);
    contact_case_clear(&other_case);
    free(own.z);
    free(other.z);
}

static void laws_change_places(void **state) {
    (void)state;
    surfaces_are_of_the_other_law(STUDY(ITERATED, ", \"cell_error\": \"none\""),
                                  STUDY(TRANSLATED, ""));
    surfaces_are_of_the_other_law(STUDY(TRANSLATED, ", \"cell_error\": \"none\""),
                                  STUDY(ITERATED, ""));
}

/* Where no translation comes near the spectrum there is no other law: a case without values, and
 * not a failure. */
static void no_other_law_no_values(void **state) {
    (void)state;
    const struct random_key key = {5, 2, 8};
    const struct contact_stopper stopper = {go_on, NULL};
    struct contact_case one_case;
    struct companion_bench *companions;
    struct contact_tally tally;
    struct error err = {0};
    read_case(&one_case,
              STUDY(", \"heights\": {\"distribution\": \"weibull_min\", \"shape\": 0.5}", ""));
    struct pressed own = make(&one_case, key);
    must(contact_tally_create(&tally, &one_case, &err), &err);
    must(companion_bench_create(&companions, &one_case, &own.moments, &err), &err);
    const struct contact_surface whole = {key, own.z};
    must(companion_bench_solve(companions, &whole, &tally, &stopper, &err), &err);
    const double *values = contact_tally_series(&tally, COMPANION_LAW, OTHER, MEASURE_EDGES);
    for (size_t k = 0; k < LOADS; k++)
        assert_true(isnan(values[k]));
    companion_bench_destroy(&companions);
    contact_tally_clear(&tally);
    contact_case_clear(&one_case);
    free(own.z);
}

/* Of dear models more realisations have the other law. */
static void choices_follow_the_case(void **state) {
    (void)state;
    struct contact_case one_case;
    read_case(&one_case, STUDY(WEIBULL, ""));
    const struct companion *law = COMPANIONS[COMPANION_LAW];
    const struct companion_plan *plan = &one_case.companions[COMPANION_LAW];
    assert_true(contact_case_has(&one_case, COMPANION_LAW));
    uint64_t cheap = plan->due.interval;
    double seconds = law->seconds(&one_case, plan) / (double)cheap;
    assert_true(seconds > 0 && seconds <= fmax(1e-3, 0.1 * contact_case_least_seconds(&one_case)));
    assert_true(law->bytes(&one_case, plan) > 0);
    contact_case_clear(&one_case);
    read_case(&one_case, STUDY(WEIBULL, ", \"model\": \"full\""));
    assert_true(plan->due.interval <= cheap);
    contact_case_clear(&one_case);
    static const char *const NONE[] = {STUDY("", ""),
                                       STUDY(WEIBULL, ", \"law_difference\": \"none\"")};
    for (size_t a = 0; a < 2; a++) {
        read_case(&one_case, NONE[a]);
        assert_false(contact_case_has(&one_case, COMPANION_LAW));
        contact_case_clear(&one_case);
    }
}

/* --- differences --- */

/* Two of three realisations are pairs: the other law adds 0.03 and 0.05 to areas of 0.4 in the
 * mean, at the second load it takes off twice that: 0.04 +- 0.01 of areas of 0.3. */
static void differences_follow_from_the_pairs(void **state) {
    (void)state;
    static const double OTHERS[] = {0.03, 0.05}, TIMES[LOADS] = {1, -2, 1};
    static const double STUDENT_OF_TWO = 12.7062 / 1.959964; /* over the normal quantile */
    struct contact_case one_case;
    struct contact_tally tally;
    struct estimate differences[LOADS];
    struct error err = {0};
    read_case(&one_case, STUDY(WEIBULL, ""));
    must(contact_tally_create(&tally, &one_case, &err), &err);
    for (size_t r = 0; r < 3; r++) {
        double *values = contact_tally_values(&tally, MEASURE_EDGES);
        for (size_t k = 0; k < LOADS; k++) {
            values[contact_case_cell(&one_case, 0, 0, k)] = 0.3;
            if (r == 2)
                continue;
            double own = 0.4 + 0.1 * (double)r - 0.05;
            contact_tally_series(&tally, COMPANION_LAW, OWN, MEASURE_EDGES)[k] = own;
            contact_tally_series(&tally, COMPANION_LAW, OTHER, MEASURE_EDGES)[k] =
                own + TIMES[k] * OTHERS[r];
        }
        must(contact_tally_add(&tally, &err), &err);
        /* one pair shows no scatter */
        assert_true(companion_law_difference(&tally, MEASURE_EDGES, 0, differences) == (r > 0));
    }
    for (size_t k = 0; k < LOADS; k++) {
        check_relative(differences[k].value, 0.3 / 0.4 * TIMES[k] * 0.04, 1e-9);
        check_relative(differences[k].standard_error,
                       STUDENT_OF_TWO * 0.3 / 0.4 * fabs(TIMES[k]) * 0.01, 1e-5);
    }
    assert_false(companion_law_difference(&tally, MEASURE_PAIRED, 0, differences));
    contact_tally_clear(&tally);
    contact_case_clear(&one_case);
}

/* --- results --- */

static struct case_result run(const char *text, uint64_t count) {
    struct case_result result = {0};
    struct block_result block = {0};
    struct job_runner *runner = NULL;
    struct job_merger *merger = NULL;
    struct error err = {0};
    cJSON *parameters = cJSON_Parse(text);
    const struct job_kind *kind = kind_find("contact");
    assert_non_null(parameters);
    must(runner_create(&runner, kind, parameters, NULL, 3, 0, &err), &err);
    must(merger_create(&merger, kind, parameters, &err), &err);
    must(runner_run(runner, 0, count, NULL, &block, &err), &err);
    must(merger_add(merger, &block, &err), &err);
    must(merger_result(merger, &result, &err), &err);
    runner_destroy(&runner);
    merger_destroy(&merger);
    block_result_clear(&block);
    cJSON_Delete(parameters);
    return result;
}

static bool is_paired(const struct curve *curve) {
    return strcmp(curve->quantity, "iterations") != 0 && strcmp(curve->quantity, "work") != 0;
}

/* A change of the area by a share stretches pressures: the integral of their density changes by
 * that share, and its first moment stays. */
static void check_density(const struct curve *density, double share) {
    double all = 0, change = 0, moment = 0, first = 0;
    assert_non_null(density->law_difference);
    for (size_t b = 0; b < density->n && density->law_difference != NULL; b++) {
        all += density->y[b];
        first += density->x[b] * density->y[b];
        change += density->law_difference[b];
        moment += density->x[b] * density->law_difference[b];
        assert_true(density->law_standard_error[b] >= 0);
    }
    /* the derivative is by bins, and there are few nodes in these */
    check_close(change / all, share, 0.2 * fabs(share));
    check_close(moment / first, 0, 0.2 * fabs(share));
}

static void curves_and_scalars_have_it(void **state) {
    (void)state;
    static const char *const SCALARS[] = {"kappa", "power_law_a", "power_law_b",
                                          "contact_area_last", "mean_gap_last"};
    struct case_result with = run(STUDY(WEIBULL, ""), 17);
    struct case_result without = run(STUDY(WEIBULL, ", \"law_difference\": \"none\""), 17);
    const struct curve *density = NULL, *area = result_curve(&with, "contact_area");
    assert_int_equal(with.curve_count, without.curve_count);
    for (size_t a = 0; a < with.curve_count; a++) {
        const struct curve *curve = &with.curves[a], *same = &without.curves[a];
        assert_memory_equal(curve->y, same->y, curve->n * sizeof *curve->y);
        assert_true((curve->law_difference != NULL) == is_paired(curve));
        assert_null(same->law_difference);
        if (strcmp(curve->quantity, "contact_pressure_pdf") == 0)
            density = curve;
    }
    for (size_t a = 0; a < sizeof SCALARS / sizeof *SCALARS; a++) {
        const struct scalar *scalar = result_scalar(&with, SCALARS[a]);
        assert_true(!isnan(scalar->law_difference) || isnan(scalar->value));
        assert_true(isnan(result_scalar(&without, SCALARS[a])->law_difference));
    }
    assert_non_null(density);
    assert_string_equal(area->series, "edges");
    check_density(density, area->law_difference[LOADS - 1] / area->y[LOADS - 1]);
    result_clear(&with);
    result_clear(&without);
}

static void gaussian_heights_have_none(void **state) {
    (void)state;
    struct case_result gaussian = run(STUDY("", ""), 17);
    for (size_t a = 0; a < gaussian.curve_count; a++)
        assert_null(gaussian.curves[a].law_difference);
    for (size_t a = 0; a < gaussian.scalar_count; a++)
        assert_true(isnan(gaussian.scalars[a].law_difference));
    result_clear(&gaussian);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(laws_change_places),
        cmocka_unit_test(no_other_law_no_values),
        cmocka_unit_test(choices_follow_the_case),
        cmocka_unit_test(differences_follow_from_the_pairs),
        cmocka_unit_test(curves_and_scalars_have_it),
        cmocka_unit_test(gaussian_heights_have_none),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
