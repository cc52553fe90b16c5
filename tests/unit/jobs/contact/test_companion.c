/* Protects: the table of companions is whole, so that whoever walks it needs no exceptions; each
 * source of error has one row that estimates it; plans of cases are consistent; and the subsets of
 * realisations that side solves take. */
#include "jobs/contact/case/contact_case_read.h"
#include "jobs/contact/companion/companion.h"
#include "tests/support/check.h"

static void rows_are_whole(void **state) {
    (void)state;
    for (enum companion_name c = 0; c < COMPANION_COUNT; c++) {
        const struct companion *row = COMPANIONS[c];
        assert_true(row->what != NULL && row->size > 0);
        assert_true(row->plan != NULL && row->create != NULL && row->clear != NULL);
        assert_true(row->bytes != NULL && row->seconds != NULL && row->solve != NULL);
        bool estimates = row->source != ERROR_SOURCES;
        assert_true((row->applies != NULL) == estimates && (row->errors != NULL) == estimates);
        if (estimates)
            assert_true(companion_of(row->source)->errors == row->errors);
    }
    assert_null(companion_of(ERROR_DISCRETISATION));
}

/* Low blocks of two models and Weibull heights on a profile: all companions but shorter
 * cells, as there are longer ones, and sub-maps. */
static const char STUDY[] =
    "{\"surface\": {\"dimension\": 1, \"hurst\": 0.8, \"wavelength_ratio\": 4, \"length_ratio\": 4,"
    " \"rms_slope\": 0.1, \"heights\": {\"distribution\": \"weibull_min\", \"shape\": 1}},"
    " \"contact\": {\"model\": [\"layered\", \"halfspace\"], \"block_height\": {\"lengths\": 0.25},"
    " \"pressures\": {\"values\": [0.1]}}}";

static void plans_are_consistent(void **state) {
    (void)state;
    static const size_t SERIES[COMPANION_COUNT] = {
        [COMPANION_LONGER] = 1, [COMPANION_EQUAL] = 1, [COMPANION_PROBE] = 3, [COMPANION_LAW] = 2};
    struct contact_case one_case;
    struct error err = {0};
    cJSON *parameters = cJSON_Parse(STUDY);
    assert_non_null(parameters);
    assert_int_equal(contact_case_read(&one_case, parameters, 0, NULL, &err), 0);
    for (enum companion_name c = 0; c < COMPANION_COUNT; c++) {
        const struct companion_plan *plan = &one_case.companions[c];
        assert_int_equal(plan->series, SERIES[c]);
        assert_int_equal(subset_has(&plan->due, 0), plan->series > 0);
        assert_int_equal(companion_draws(plan, 0),
                         plan->series > 0 ? companion_draws_most(plan) : 0);
        assert_true(companion_draws(plan, 1000) <= 1);
        assert_true(plan->pair_count <= COMPANION_PAIRS_MOST);
        for (size_t pair = 0; pair < plan->pair_count; pair++) {
            const struct companion_pair *of = &plan->pairs[pair];
            assert_true(of->less < plan->series);
            assert_true(of->of < plan->series);
        }
    }
    contact_case_clear(&one_case);
    cJSON_Delete(parameters);
}

static void subsets_begin_with_more(void **state) {
    (void)state;
    const struct subset none = {0}, each = subset_each(64), often = subset_each(2);
    for (uint64_t r = 0; r < 200; r++) {
        assert_false(subset_has(&none, r));
        assert_int_equal(subset_has(&each, r), r % (r < 32 ? 8 : 64) == 0);
        assert_int_equal(subset_has(&often, r), r % 2 == 0);
    }
    /* the least interval, the first power of two that is cheap enough, and a limit */
    assert_int_equal(subset_interval(1, 1, 1), 1);
    assert_int_equal(subset_interval(9, 1, 1), 16);
    assert_int_equal(subset_interval(0, 1, 4), 4);
    assert_int_equal(subset_interval(1, 0, 1), 1 << 20);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(rows_are_whole),
        cmocka_unit_test(plans_are_consistent),
        cmocka_unit_test(subsets_begin_with_more),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
