/* Surfaces of other lengths: what stands in their cells of the tally is what a case of that
 * length gives for the same random numbers, solved by itself; and which cases have them, on which
 * realisations, for how much time and memory. */
#include "jobs/contact/case/contact_case_read.h"
#include "jobs/contact/contact_scene.h"
#include "tests/support/check.h"
#include "tests/support/effort.h"
#include "tests/support/unstopped.h"
#include <stdlib.h>

enum { LOADS = 3 };
#define STUDY(surface, contact)                                                                    \
    "{\"surface\": {\"hurst\": 0.8, " surface "}, \"contact\": {\"pressures\": {\"values\":"       \
    " [0.01, 0.1, 0.3]}" contact "}}"
#define PROFILE "\"dimension\": 1, \"wavelength_ratio\": 4, \"rms_slope\": 0.1, "
#define SURFACE "\"dimension\": 2, \"wavelength_ratio\": 2, \"rms_slope\": 0.1, "
#define WEIBULL "\"heights\": {\"distribution\": \"weibull_min\", \"shape\": 1}, "

static void read_case(struct contact_case *one_case, const char *text) {
    struct error err = {0};
    cJSON *parameters = cJSON_Parse(text);
    assert_non_null(parameters);
    must(contact_case_read(one_case, parameters, 0, NULL, &err), &err);
    cJSON_Delete(parameters);
}

/* Solves the surface of a key into an empty tally. */
static void solve_case(const struct contact_case *one_case, struct random_key key,
                       struct contact_tally *tally) {
    const struct surface_case *surface = &one_case->surface;
    struct contact_compliances compliances;
    struct contact_scene *scene;
    struct generator *generator;
    struct moments moments;
    struct error err = {0};
    double *z = array_create(grid_points(&surface->grid), sizeof *z);
    assert_non_null(z);
    must(generator_create(&generator, &surface->spectrum, &surface->grid, &surface->options, &err),
         &err);
    modes_moments(generator_modes(generator), &moments);
    must(generator_run(generator, key, z, NULL, &err), &err);
    generator_destroy(&generator);
    must(contact_compliances_create(&compliances, one_case, &err), &err);
    must(contact_scene_create(&scene, one_case, &moments, &compliances, &err), &err);
    must(contact_tally_create(tally, one_case, &err), &err);
    const struct contact_surface whole = {key, z};
    must(contact_scene_solve(scene, &whole, tally, go_on, NULL, &err), &err);
    contact_scene_destroy(&scene);
    contact_compliances_clear(&compliances);
    free(z);
}

/* `alone` is the study of a cell of another length, `factor` times that of `text`, on the mesh of
 * the probe. */
static void check_length(const char *text, enum companion_name length, double factor,
                         const char *alone) {
    static const struct random_key KEYS[] = {{7, 0, 0}, {7, 3, 4}};
    struct contact_case one_case, other;
    read_case(&one_case, text);
    read_case(&other, alone);
    double cells = pow(factor, one_case.surface.dimension);
    check_relative(one_case.companions[length].length, factor, 0);
    assert_true(contact_case_has(&one_case, length));
    for (size_t r = 0; r < 2; r += case_step()) {
        struct random_key key = KEYS[r];
        struct contact_tally tally, expected_tally;
        solve_case(&one_case, key, &tally);
        key.sequence += length == COMPANION_LONGER ? UINT64_C(1) << 63 : UINT64_C(1) << 61;
        solve_case(&other, key, &expected_tally);
        for (size_t a = 0; a < MEASURE_KAPPA; a++) {
            const double *values = contact_tally_series(&tally, length, 0, (enum contact_measure)a);
            const double *expected = contact_tally_values(&expected_tally, (enum contact_measure)a);
            double scale = a == MEASURE_PATCHES ? 1 / cells : a == MEASURE_PATCH_MEAN ? cells : 1;
            for (size_t k = 0; k < LOADS; k++) {
                double value = values[k];
                double wanted = scale * expected[contact_case_cell(&other, 0, 0, k)];
                if (a == MEASURE_PATCH_LARGEST)
                    assert_true(isnan(value));
                else if (a != MEASURE_EDGES_STRETCHED && !isnan(wanted))
                    check_relative(value, wanted, 1e-12);
            }
        }
        contact_tally_clear(&tally);
        contact_tally_clear(&expected_tally);
    }
    contact_case_clear(&one_case);
    contact_case_clear(&other);
}

static void surfaces_are_those_of_other_cells(void **state) {
    (void)state;
    check_length(STUDY(PROFILE "\"length_ratio\": 4, \"points_per_wavelength\": 8", ""),
                 COMPANION_LONGER, 16,
                 STUDY(PROFILE "\"length_ratio\": 64, \"points_per_wavelength\": 4", ""));
    check_length(STUDY(PROFILE "\"length_ratio\": 4, \"points_per_wavelength\": 8", ""),
                 COMPANION_EQUAL, 1,
                 STUDY(PROFILE "\"length_ratio\": 4, \"points_per_wavelength\": 4", ""));
    check_length(STUDY(SURFACE "\"length_ratio\": 2, \"points_per_wavelength\": 8",
                       ", \"model\": [\"layered\", \"halfspace\"]"),
                 COMPANION_LONGER, 4,
                 STUDY(SURFACE "\"length_ratio\": 8, \"points_per_wavelength\": 4", ""));
    check_length(STUDY(SURFACE "\"length_ratio\": 2, \"points_per_wavelength\": 8", ""),
                 COMPANION_EQUAL, 1,
                 STUDY(SURFACE "\"length_ratio\": 2, \"points_per_wavelength\": 4", ""));
    /* a rectangle keeps its shape */
    check_length(STUDY(SURFACE "\"length_ratio\": 4, \"length_ratio_y\": 2", ""), COMPANION_LONGER,
                 2,
                 STUDY(SURFACE "\"length_ratio\": 8, \"length_ratio_y\": 4,"
                               " \"points_per_wavelength\": 4",
                       ""));
    /* other heights depend on the grid that they are made on */
    check_length(STUDY(WEIBULL PROFILE "\"length_ratio\": 2, \"points_per_wavelength\": 8", ""),
                 COMPANION_LONGER, 32,
                 STUDY(WEIBULL PROFILE "\"length_ratio\": 64, \"points_per_wavelength\": 8",
                       ", \"levels\": [4]"));
    check_length(STUDY(WEIBULL PROFILE "\"length_ratio\": 4, \"points_per_wavelength\": 8", ""),
                 COMPANION_EQUAL, 1,
                 STUDY(WEIBULL PROFILE "\"length_ratio\": 4, \"points_per_wavelength\": 8",
                       ", \"levels\": [4]"));
}

static void alpha_is_not_solved_anew(void **state) {
    (void)state;
    struct contact_case one_case;
    read_case(&one_case, STUDY("\"nayak_alpha\": 3, \"length_ratio\": 2", ""));
    static const enum companion_name LENGTHS[] = {COMPANION_LONGER, COMPANION_EQUAL};
    for (size_t l = 0; l < 2; l++) {
        const struct companion_plan *other = &one_case.companions[LENGTHS[l]];
        assert_true(other->surface.spectrum.wavelength_long ==
                    one_case.surface.spectrum.wavelength_long);
        check_relative(other->surface.grid.lx, other->length * one_case.surface.grid.lx, 1e-15);
    }
    contact_case_clear(&one_case);
}

/* Returns the seconds of all companions but one. */
static double companions_seconds_but(const struct contact_case *one_case,
                                     enum companion_name companion) {
    struct contact_case without = *one_case;
    without.companions[companion] = (struct companion_plan){0};
    return companions_seconds(&without);
}

static double companions_first_seconds_but(const struct contact_case *one_case,
                                           enum companion_name companion) {
    struct contact_case without = *one_case;
    without.companions[companion] = (struct companion_plan){0};
    double seconds = 0;
    for (uint64_t r = 0; r < STUDY_EARLY; r++)
        seconds += companions_beyond_seconds(&without, r);
    return seconds;
}

/* The first eight realisations have the work of a second by the cost that plans them, and at most a
 * quarter more by that of what is run; or half the time of twenty realisations
 * beside dear models; the others a tenth of the time of the case. What is drawn does not depend on
 * the loads that are listed. */
static void they_cost_little(void **state) {
    (void)state;
    static const char *const STUDIES[] = {
        STUDY(PROFILE "\"length_ratio\": 8", ""),
        STUDY(PROFILE "\"length_ratio\": 8", ", \"levels\": [4, 8, 16]"),
        STUDY(SURFACE "\"length_ratio\": 4", ""),
        STUDY(SURFACE WEIBULL "\"length_ratio\": 4", ""),
        STUDY(SURFACE "\"length_ratio\": 2", ", \"model\": \"full\""),
    };
    for (size_t s = 0; s < sizeof STUDIES / sizeof *STUDIES; s++) {
        struct contact_case one_case;
        struct study_cost cost;
        read_case(&one_case, STUDIES[s]);
        assert_true(contact_case_has(&one_case, COMPANION_LONGER) &&
                    contact_case_has(&one_case, COMPANION_EQUAL) &&
                    !contact_case_has(&one_case, COMPANION_SHORTER));
        contact_case_estimate(&one_case, &cost);
        double beside = companions_seconds_but(&one_case, COMPANION_LAW);
        assert_true(beside > 0 && beside <= 0.14 * (cost.seconds - beside));
        double first = companions_first_seconds_but(&one_case, COMPANION_LAW);
        assert_true(first > 0 && first <= fmax(1.25, 0.5 * 20 * cost.seconds));
        const struct companion_plan *plan = &one_case.companions[COMPANION_LONGER];
        assert_true(companion_draws(plan, 0) > 0 && companion_draws(plan, 6) > 0);
        assert_true(companion_draws(plan, 0) * 8 >= 4);
        contact_case_clear(&one_case);
    }
}

/* Returns the seconds of one draw of a longer cell. */
static double draw_seconds(const char *text) {
    struct contact_case one_case;
    read_case(&one_case, text);
    const double seconds =
        COMPANIONS[COMPANION_LONGER]->seconds(&one_case, &one_case.companions[COMPANION_LONGER]);
    contact_case_clear(&one_case);
    return seconds;
}

/* The estimate has all draws in the realisations that make them, the first eight, so that it holds
 * for studies of fewer; later ones have one draw at most. A draw yields, unloads and slips as the
 * case does. Beside elastic ones, measured profiles took 1.25 to 1.8 times as long with a hardness,
 * 0.2 to 0.5 more with loads that fall again, and 13 times as long with coupled slip. */
static void the_estimate_has_all_draws(void **state) {
    (void)state;
    struct contact_case one_case;
    struct study_cost cost;
    read_case(&one_case, STUDY(PROFILE "\"length_ratio\": 8", ""));
    contact_case_estimate(&one_case, &cost);
    const double draws = (double)one_case.companions[COMPANION_LONGER].draws *
                         draw_seconds(STUDY(PROFILE "\"length_ratio\": 8", ""));
    for (size_t r = 0; r < STUDY_EARLY; r++)
        assert_true(r < 8 ? cost.early_seconds[r] > 0.95 * draws
                          : cost.early_seconds[r] < 0.05 * draws);
    contact_case_clear(&one_case);
    const double elastic = draw_seconds(STUDY(PROFILE "\"length_ratio\": 8", ""));
    const double yields = draw_seconds(STUDY(PROFILE "\"length_ratio\": 8", ", \"hardness\": 0.4"));
    const double falls =
        draw_seconds(STUDY(PROFILE "\"length_ratio\": 8", ", \"hardness\": 0.4, \"unload\": true"));
    const double slips = draw_seconds(STUDY(PROFILE "\"length_ratio\": 8",
                                            ", \"friction\": 0.3, \"slip\": {\"coupling\": true}"));
    assert_in_range(1000 * yields / elastic, 1200, 1800);
    assert_in_range(1000 * (falls - yields) / elastic, 300, 600);
    assert_in_range(1000 * slips / elastic, 10000, 20000);
}

static void draws_do_not_depend_on_loads(void **state) {
    (void)state;
    struct contact_case one_case, more;
    read_case(&one_case, "{\"surface\": {" PROFILE "\"hurst\": 0.8, \"length_ratio\": 8},"
                         " \"contact\": {\"pressures\": {\"values\": [0.1]}}}");
    read_case(&more,
              "{\"surface\": {" PROFILE "\"hurst\": 0.8, \"length_ratio\": 8},"
              " \"contact\": {\"pressures\": {\"values\": [0.001, 0.003, 0.01, 0.1, 0.2]}}}");
    for (enum companion_name c = 0; c < COMPANION_COUNT; c++) {
        assert_int_equal(one_case.companions[c].draws, more.companions[c].draws);
        assert_int_equal(one_case.companions[c].due.interval, more.companions[c].due.interval);
    }
    assert_true(one_case.companions[COMPANION_EQUAL].draws > 100);
    contact_case_clear(&one_case);
    contact_case_clear(&more);
}

/* Draws of a realisation are surfaces of their own, and count as many values. */
static void draws_differ(void **state) {
    (void)state;
    struct contact_case one_case;
    struct contact_tally tally;
    struct error err = {0};
    read_case(&one_case, STUDY(PROFILE "\"length_ratio\": 8", ""));
    solve_case(&one_case, (struct random_key){7, 0, 0}, &tally);
    const struct companion_tally *equal = &tally.companions[COMPANION_EQUAL];
    uint64_t draws = companion_draws(&one_case.companions[COMPANION_EQUAL], 0);
    const double *first = contact_tally_series(&tally, COMPANION_EQUAL, 0, MEASURE_GAP);
    assert_int_equal(equal->draws, draws);
    assert_true(first[0] != first[equal->sums.counts.size]);
    must(contact_tally_add(&tally, &err), &err);
    assert_int_equal(contact_tally_draws(&tally, COMPANION_EQUAL, 0, MEASURE_GAP, 0), draws);
    contact_tally_clear(&tally);
    contact_case_clear(&one_case);
}

/* Where a study wants none, the case is as it was without; where longer ones would not fit, shorter
 * ones do. */
static void some_cases_have_none(void **state) {
    (void)state;
    static const char *const STUDIES[] = {
        STUDY(PROFILE "\"length_ratio\": 2", ", \"cell_error\": \"none\""),
        /* more points than a grid may have */
        STUDY("\"dimension\": 1, \"wavelength_ratio\": 2000, \"heights\": {\"distribution\":"
              " \"weibull_min\", \"shape\": 1}, \"length_ratio\": 100000",
              ""),
        /* four times the points of a surface that takes hundreds of megabytes */
        STUDY("\"wavelength_ratio\": 64, \"heights\": {\"distribution\": \"weibull_min\","
              " \"shape\": 1}, \"length_ratio\": 8",
              ""),
    };
    for (size_t s = 0; s < sizeof STUDIES / sizeof *STUDIES; s++) {
        struct contact_case one_case;
        read_case(&one_case, STUDIES[s]);
        assert_false(contact_case_has(&one_case, COMPANION_LONGER) ||
                     subset_has(&one_case.companions[COMPANION_LONGER].due, 0));
        if (s == 0) {
            for (enum companion_name c = 0; c < COMPANION_COUNT; c++)
                assert_false(contact_case_has(&one_case, c));
        } else {
            assert_true(contact_case_has(&one_case, COMPANION_SHORTER));
        }
        contact_case_clear(&one_case);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(surfaces_are_those_of_other_cells),
        cmocka_unit_test(alpha_is_not_solved_anew),
        cmocka_unit_test(they_cost_little),
        cmocka_unit_test(the_estimate_has_all_draws),
        cmocka_unit_test(draws_do_not_depend_on_loads),
        cmocka_unit_test(draws_differ),
        cmocka_unit_test(some_cases_have_none),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
