/* Protects: whichever allocation fails, in SQLite too, a study's results are published, read,
 * reported, compared and printed as a table, or the call says that memory is short; nothing leaks.
 */
#include "tests/support/check.h"

#include "core/file/memory_file.h"
#include "schema/result/csv.h"
#include "tests/support/failing/each_allocation.h"
#include "tests/unit/worker/small_study.h"
#include "worker/publish/aggregate.h"
#include "worker/publish/comparison.h"
#include "worker/publish/publish.h"
#include "worker/worker.h"

static struct fixture fixture;

static int publish(void *context, struct error *err) {
    (void)context;
    struct merged_case merged;
    int status = aggregate_prepare(fixture.store, fixture.study, 1, &merged, err);
    if (status == 0)
        status = aggregate_write(fixture.store, &merged, err);
    merged_case_clear(&merged);
    return status;
}

/* Both cases, in one change. */
static int publish_group(void *context, struct error *err) {
    struct publish_counts counts = {0};
    int status = 0;
    (void)context;
    for (uint64_t c = 0; c < 2 && status == 0; c++) {
        struct due_case one = {.case_number = c};
        struct case_info info = {0};
        snprintf(one.study, sizeof one.study, "%s", fixture.study);
        status = store_case(fixture.store, fixture.study, c, &info, err);
        one.revision = info.revision;
        if (status == 0)
            status = store_unpublish(fixture.store, &one, err);
        case_info_clear(&info);
    }
    if (status == 0)
        status = publish_due(fixture.store, NULL, NULL, &counts, err);
    if (status == 0 && counts.postponed > 0) {
        *err = counts.reason;
        status = counts.reason.code;
    }
    if (status == 0)
        assert_int_equal(counts.published, 2);
    return status;
}

static int print_table(const struct study_result *study, struct error *err) {
    struct memory_file memory;
    if (!memory_file_open(&memory))
        return error_memory(err, sizeof memory, "a table");
    bool done = csv_print(memory.file, study);
    char *text = memory_file_close(&memory, NULL);
    done = done && text != NULL;
    if (done)
        assert_non_null(strstr(text, "standard_error"));
    free(text);
    return done ? 0 : error_memory(err, sizeof memory, "a table");
}

static int curves(void *context, struct error *err) {
    const struct result_filter *filter = context;
    struct study_result study = {0};
    int status = aggregate_study(fixture.store, fixture.study, filter, &study, err);
    if (status == 0) {
        assert_int_equal(study.case_count, 2);
        assert_int_equal(study.cases[1].realisations, 24);
        assert_true(study.cases[1].curve_count > 0);
        status = print_table(&study, err);
    }
    study_result_clear(&study);
    return status;
}

static int report(void *context, struct error *err) {
    struct study_report made = {0};
    (void)context;
    int status = aggregate_report(fixture.store, fixture.study, &made, err);
    if (status == 0) {
        assert_int_equal(made.case_count, 2);
        assert_true(made.cases[1].curve_count > 0);
    }
    study_report_clear(&made);
    return status;
}

static int difference(void *context, struct error *err) {
    const struct comparison comparison = {.minuend = 1};
    struct study_result study = {0};
    (void)context;
    int status = comparison_make(fixture.store, fixture.study, &comparison, &study, err);
    if (status == 0) {
        const struct case_result *one = &study.cases[0];
        assert_true(result_scalar(one, "summit_height_mean")->paired);
        assert_true(one->curve_count > 0 && one->remark != NULL);
        status = print_table(&study, err);
    }
    study_result_clear(&study);
    return status;
}

static int open_study(void **state) {
    struct error err = {0};
    (void)state;
    fixture_open(&fixture);
    fixture_submit(&fixture, SMALL_STUDY, 24, NULL, 0);
    const struct worker_options options = {
        .source = {.database = fixture.database, .worker = "test"}, .threads = 1, .drain = 1};
    return workers_run(&options, &err);
}

static int close_study(void **state) {
    (void)state;
    fixture_close(&fixture);
    return 0;
}

static void published(void **state) {
    struct result_filter all = {.case_number = -1, .complete = true};
    struct result_filter one = {.case_number = -1, .part = {.quantity = "psd"}, .complete = true};
    (void)state;
    each_allocation(&(struct failing_call){.name = "publish", publish, .may_succeed = 1});
    each_allocation(
        &(struct failing_call){.name = "publish a group", publish_group, .may_succeed = 1});
    each_allocation(&(struct failing_call){.name = "curves", curves, &all, .may_succeed = 1});
    each_allocation(&(struct failing_call){.name = "a curve", curves, &one, .may_succeed = 1});
    each_allocation(&(struct failing_call){.name = "difference", difference, .may_succeed = 1});
    each_allocation(&(struct failing_call){.name = "report", report, .may_succeed = 1});
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(published)};
    return cmocka_run_group_tests(tests, open_study, close_study);
}
