/* One case of a stored study less another: while it runs, when it is done, where cases are
 * independent, and what is refused. */
#include "tests/unit/worker/small_study.h"
#include "worker/publish/comparison.h"
#include "worker/worker.h"
#include <math.h>

static void run_all(struct fixture *fixture) {
    struct worker_options options = {
        .source = {.database = fixture->database, .worker = "test"}, .threads = 1, .drain = 1};
    struct error err = {0};
    if (workers_run(&options, &err) != 0)
        fail_msg("%s", err.text);
}

static int compare(struct fixture *fixture, uint64_t a, uint64_t b, const char *quantity,
                   struct study_result *out, struct error *err) {
    const struct comparison comparison = {.minuend = a, .subtrahend = b, .quantity = quantity};
    return comparison_make(fixture->store, fixture->study, &comparison, out, err);
}

static void a_difference_is_by_pairs(void **state) {
    (void)state;
    struct fixture fixture;
    struct study_result study = {0};
    struct error err = {0};
    fixture_open(&fixture);
    fixture_submit(&fixture, SMALL_STUDY, 6, NULL, 0);
    run_all(&fixture);
    assert_int_equal(compare(&fixture, 1, 0, NULL, &study, &err), 0);
    assert_string_equal(study.id, fixture.study);
    assert_int_equal(study.case_count, 1);
    const struct case_result *one = &study.cases[0];
    assert_true(one->difference && one->case_number == 1 && one->less == 0);
    assert_int_equal(one->realisations, 24);
    assert_string_equal(result_parameter(one, "/surface/hurst")->text, "0.8 less 0.2");
    const struct scalar *summits = result_scalar(one, "summit_height_mean");
    assert_true(summits->paired && summits->standard_error > 0);
    assert_true(result_curve(one, "summit_height_pdf")->paired);
    assert_false(result_curve(one, "psd")->paired); /* known, not measured */
    study_result_clear(&study);
    assert_int_equal(compare(&fixture, 0, 1, "summit_height_pdf", &study, &err), 0);
    assert_int_equal(study.cases[0].curve_count, 1);
    study_result_clear(&study);
    fixture_close(&fixture);
}

/* The cases have surfaces of their own: errors are the root of the sum of squares, and a note says
 * so. */
static void independent_cases_are_no_pairs(void **state) {
    (void)state;
    struct fixture fixture;
    struct study_result study = {0};
    struct error err = {0};
    char *text = NULL;
    assert_true(asprintf(&text, "{\"random\":\"independent\",%s", SMALL_STUDY + 1) > 0);
    fixture_open(&fixture);
    fixture_submit(&fixture, text, 6, NULL, 0);
    run_all(&fixture);
    assert_int_equal(compare(&fixture, 1, 0, NULL, &study, &err), 0);
    assert_non_null(strstr(study.cases[0].remark, "the cases are independent"));
    assert_false(result_scalar(&study.cases[0], "summit_height_mean")->paired);
    study_result_clear(&study);
    fixture_close(&fixture);
    free(text);
}

static void what_cannot_be_is_refused(void **state) {
    (void)state;
    static const struct {
        uint64_t a, b;
        const char *quantity;
        int status;
        const char *text;
    } WRONG[] = {{1, 1, NULL, ERROR_INPUT, "case 1 less itself is nothing"},
                 {1, 2, NULL, ERROR_ABSENT, "has no case 2"},
                 {0, 1, "colour", ERROR_INPUT,
                  "no quantity 'colour' in this study; it has summit_height_pdf"},
                 {0, 1, "rms_slope", ERROR_INPUT, "rms_slope is a scalar, which has no curve"},
                 {0, 1, "summit_joint_pdf", ERROR_INPUT, "summit_joint_pdf is a matrix"}};
    struct fixture fixture;
    struct study_result study = {0};
    fixture_open(&fixture);
    fixture_submit(&fixture, SMALL_STUDY, 6, NULL, 0);
    struct error early = {0};
    assert_int_equal(compare(&fixture, 1, 0, NULL, &study, &early), ERROR_STATE);
    assert_non_null(strstr(early.text, "case 1 has no realisations yet"));
    run_all(&fixture);
    for (size_t w = 0; w < sizeof WRONG / sizeof *WRONG; w++) {
        struct error err = {0};
        int status = compare(&fixture, WRONG[w].a, WRONG[w].b, WRONG[w].quantity, &study, &err);
        if (status != WRONG[w].status || strstr(err.text, WRONG[w].text) == NULL)
            fail_msg("'%s' expected, but status %d, '%s'", WRONG[w].text, status, err.text);
        assert_null(study.cases);
    }
    fixture_close(&fixture);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_difference_is_by_pairs),
        cmocka_unit_test(independent_cases_are_no_pairs),
        cmocka_unit_test(what_cannot_be_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
