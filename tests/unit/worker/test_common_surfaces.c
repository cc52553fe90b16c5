/* Protects: cases of one study are comparable. What does not depend on a swept parameter comes out
 * alike to the bit, since every case is made of the same random numbers, and only a study that asks
 * for independent cases draws anew in each; with any number of workers, in blocks of any size. */
#include "schema/result/result.h"
#include "tests/unit/worker/small_study.h"
#include "worker/publish/aggregate.h"
#include "worker/worker.h"

/* Errors of cells are none of this file. The half-space knows no Poisson's ratio but that in E*,
 * which the pressures are in units of; the layer does. */
static const char POISSON_SWEEP[] =
    "{\"name\":\"poisson\",\"kind\":\"contact\",\"seed\":7,%s\"realisations\":6,\"surface\":{"
    "\"dimension\":1,\"hurst\":0.8,\"wavelength_ratio\":4,\"length_ratio\":2},\"contact\":{"
    "\"model\":[\"halfspace\",\"layered\"],\"poisson\":[0.1,0.3,0.49],\"levels\":[4,8],"
    "\"cell_error\":\"none\",\"pressures\":{\"to\":0.4,\"steps\":4}}}";

enum { CASES = 3 };

/* Runs the study and gives its results. */
static void run(const char *format, const char *random, unsigned threads, uint64_t block,
                struct study_result *out) {
    const struct result_filter filter = {.case_number = -1, .complete = true};
    struct fixture fixture;
    struct error err = {0};
    char text[1000];
    snprintf(text, sizeof text, format, random);
    fixture_open(&fixture);
    fixture_submit(&fixture, text, block, NULL, 0);
    struct worker_options options = {
        .source = {.database = fixture.database, .worker = "test"}, .threads = threads, .drain = 1};
    if (workers_run(&options, &err) != 0 ||
        aggregate_study(fixture.store, fixture.study, &filter, out, &err) != 0)
        fail_msg("%s", err.text);
    assert_int_equal(out->case_count, CASES);
    fixture_close(&fixture);
}

static bool same_numbers(size_t n, const double *a, const double *b) {
    return memcmp(a, b, n * sizeof *a) == 0;
}

enum likeness { ALL_DIFFER, SOME_DIFFER, ALL_SAME };

/* Of the contact areas of a model in two cases, with their standard errors. */
static enum likeness areas_of(const struct case_result *a, const struct case_result *b,
                              const char *model) {
    size_t same = 0, all = 0;
    if (a == NULL || b == NULL)
        return SOME_DIFFER; /* which no test expects */
    assert_int_equal(a->curve_count, b->curve_count);
    for (size_t n = 0; n < a->curve_count; n++) {
        const struct curve *one = &a->curves[n], *two = &b->curves[n];
        if (one->model == NULL || strcmp(one->model, model) != 0 || one->standard_error == NULL ||
            strcmp(one->quantity, "contact_area") != 0)
            continue;
        assert_int_equal(one->n, two->n);
        all++;
        same += same_numbers(one->n, one->x, two->x) && same_numbers(one->n, one->y, two->y) &&
                same_numbers(one->n, one->standard_error, two->standard_error);
    }
    assert_true(all >= 2); /* levels and estimators */
    return same == all ? ALL_SAME : same == 0 ? ALL_DIFFER : SOME_DIFFER;
}

static void cases_that_differ_in_contact_alone_see_the_same_surfaces(void **state) {
    (void)state;
    struct study_result study = {0};
    run(POISSON_SWEEP, "", 2, 4, &study);
    for (size_t c = 1; c < CASES; c++) {
        assert_int_equal(areas_of(&study.cases[0], &study.cases[c], "halfspace"), ALL_SAME);
        assert_int_equal(areas_of(&study.cases[0], &study.cases[c], "layered"), ALL_DIFFER);
    }
    study_result_clear(&study);
}

static void independent_cases_draw_anew(void **state) {
    (void)state;
    struct study_result common = {0}, independent = {0};
    run(POISSON_SWEEP, "\"random\":\"common\",", 1, 6, &common);
    run(POISSON_SWEEP, "\"random\":\"independent\",", 1, 6, &independent);
    assert_int_equal(areas_of(&independent.cases[0], &independent.cases[1], "halfspace"),
                     ALL_DIFFER);
    assert_int_equal(areas_of(&common.cases[0], &independent.cases[0], "layered"), ALL_SAME);
    assert_int_equal(areas_of(&common.cases[1], &independent.cases[1], "layered"), ALL_DIFFER);
    study_result_clear(&common);
    study_result_clear(&independent);
}

static void workers_and_blocks_leave_the_bits(void **state) {
    (void)state;
    static const struct {
        unsigned threads;
        uint64_t block;
    } TABLE[] = {{2, 4}, {4, 1}};
    static const char *const RANDOM[] = {"", "\"random\":\"independent\","};
    for (size_t r = 0; r < 2; r++) {
        struct study_result first = {0};
        run(POISSON_SWEEP, RANDOM[r], 1, 6, &first);
        for (size_t n = 0; n < 2; n++) {
            struct study_result again = {0};
            run(POISSON_SWEEP, RANDOM[r], TABLE[n].threads, TABLE[n].block, &again);
            for (size_t c = 0; c < CASES; c++) {
                assert_int_equal(areas_of(&first.cases[c], &again.cases[c], "layered"), ALL_SAME);
            }
            study_result_clear(&again);
        }
        study_result_clear(&first);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(cases_that_differ_in_contact_alone_see_the_same_surfaces),
        cmocka_unit_test(independent_cases_draw_anew),
        cmocka_unit_test(workers_and_blocks_leave_the_bits),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
