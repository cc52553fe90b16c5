/* Protects: a case that asks for an error is due when all jobs of its components are over; a round
 * is queued once, however often it is planned; what is cancelled does not grow; components are no
 * cases of their own to those who do not ask for them. */
#include "schema/store/store.h"
#include "tests/support/check.h"
#include "tests/support/fake_kind.h"
#include <stdlib.h>
#include <string.h>

static struct store *store;
static char id[STUDY_ID_SIZE];

static struct study_case make_case(const char *role, uint64_t realisations) {
    return (struct study_case){.parameters = cJSON_CreateObject(),
                               .block = 4,
                               .realisations = realisations,
                               .role = role,
                               .cost.seconds = 1};
}

/* One case of two components, of 4 and 8 realisations in blocks of 4. */
static int submit(void **state) {
    (void)state;
    struct study_case components[] = {make_case("base", 8), make_case("model", 4)};
    struct study_case one = {.parameters = cJSON_CreateObject(),
                             .block = 1,
                             .component_count = 2,
                             .components = components};
    struct study study = {.name = "target",
                          .kind = FAKE_KINDS[0],
                          .seed = 1,
                          .case_count = 1,
                          .cases = &one,
                          .source = "{}"};
    assert_int_equal(store_open(&store, ":memory:", NULL, NULL), 0);
    assert_int_equal(store_submit(store, &study, NULL, id, NULL, NULL), 0);
    cJSON_Delete(one.parameters);
    for (size_t a = 0; a < 2; a++)
        cJSON_Delete(components[a].parameters);
    return 0;
}

static int end(void **state) {
    (void)state;
    store_close(&store);
    return 0;
}

static struct study_status status_now(void) {
    struct study_status status;
    assert_int_equal(store_status(store, id, &status, NULL), 0);
    return status;
}

static size_t claim(struct claimed_job *job) {
    const struct claim one = {.worker = "w", .host = "h", .count = 1};
    size_t count;
    assert_int_equal(store_claim(store, &one, job, &count, NULL), 0);
    return count;
}

/* Runs a job; false when none waits. */
static bool run_one(void) {
    struct claimed_job job;
    bool first, case_done;
    double scalars[64] = {0};
    static const char *const NAMES[] = {"a"};
    if (claim(&job) == 0)
        return false;
    const struct block_result result = {.first = job.first,
                                        .count = job.count,
                                        .scalar_count = 1,
                                        .names = NAMES,
                                        .scalars = scalars,
                                        .data = (const unsigned char *)"d",
                                        .size = 1,
                                        .cpu_seconds = 1};
    assert_true(job.count <= 64);
    assert_true(job.case_number >= 1); /* of a component */
    assert_int_equal(job.sequence, job.case_number - 1);
    assert_int_equal(store_complete(store, job.id, job.token, &result, &first, &case_done, NULL),
                     0);
    claimed_job_clear(&job);
    return true;
}

static bool is_due(void) {
    bool due;
    assert_int_equal(store_is_due(store, &due, NULL), 0);
    return due;
}

static uint64_t revision_now(void) {
    struct case_info info;
    assert_int_equal(store_case(store, id, 0, &info, NULL), 0);
    uint64_t revision = info.revision;
    case_info_clear(&info);
    return revision;
}

static bool grow(uint64_t revision, uint64_t base, uint64_t model) {
    const uint64_t wanted[] = {base, model};
    const struct next_round next = {.revision = revision, .error_reached = 0.25, .wanted = wanted};
    bool grown;
    assert_int_equal(store_grow(store, id, 0, &next, &grown, NULL), 0);
    return grown;
}

static void is_due_when_all_jobs_are_over(void **state) {
    (void)state;
    for (int n = 0; n < 3; n++) {
        assert_false(is_due());
        assert_true(run_one());
    }
    assert_false(run_one());
    assert_true(is_due());
    struct study_status status = status_now();
    assert_string_equal(status.state, "running");
    assert_int_equal(status.cases, 1);
    assert_int_equal(status.realisations_total, 12);
    assert_int_equal(status.realisations_done, 12);
    assert_true(isnan(status.error_reached));
    study_status_clear(&status);
}

/* Components have numbers behind those of the cases, which are those that were asked for. */
static void a_component_is_no_case(void **state) {
    (void)state;
    struct case_info info;
    struct error err = {0};
    for (uint64_t number = 0; number < 4; number++) {
        bool is_case = number < 1, is_either = number < 3;
        int status = store_case(store, id, number, &info, &err);
        assert_int_equal(status, is_case ? 0 : ERROR_ABSENT);
        if (status == 0)
            case_info_clear(&info);
        status = store_any_case(store, id, number, &info, NULL);
        assert_int_equal(status, is_either ? 0 : ERROR_ABSENT);
        if (status == 0)
            case_info_clear(&info);
    }
    assert_non_null(strstr(err.text, "has no case 3; it has 1, from 0 on"));
}

static void a_round_is_queued_once(void **state) {
    (void)state;
    while (run_one())
        ;
    uint64_t revision = revision_now();
    assert_true(grow(revision, 20, 4));
    assert_false(is_due());
    struct study_status status = status_now();
    uint64_t jobs = status.jobs;
    assert_int_equal(status.realisations_total, 24);
    check_close(status.error_reached, 0.25, 0);
    study_status_clear(&status);
    assert_true(grow(revision, 200, 40)); /* there is something to run already */
    status = status_now();
    assert_int_equal(status.jobs, jobs);
    study_status_clear(&status);
    while (run_one())
        ;
    assert_true(is_due());
    assert_true(grow(revision, 200, 40) == false); /* planned from what was before */
    struct component *components;
    size_t count;
    assert_int_equal(store_components(store, id, 0, &components, &count, NULL), 0);
    assert_int_equal(count, 2);
    assert_int_equal(components[0].realisations, 20);
    assert_string_equal(components[1].role, "model");
    components_free(components, count);
    assert_false(grow(revision_now(), 20, 4)); /* nothing is wanted */
    assert_true(is_due());
}

static void nothing_grows_after_a_cancellation(void **state) {
    (void)state;
    struct claimed_job job;
    assert_true(run_one());
    assert_int_equal(claim(&job), 1);
    assert_int_equal(store_cancel(store, id, NULL), 0);
    assert_true(is_due()); /* what it came to */
    assert_false(grow(revision_now(), 100, 100));
    uint64_t count;
    assert_int_equal(store_retry(store, id, 0, &count, NULL), 0);
    assert_int_equal(count, 2);
    assert_false(is_due());
    while (run_one())
        ;
    assert_true(is_due());
    assert_true(grow(revision_now(), 9, 4));
    claimed_job_clear(&job);
}

/* The jobs of a round are over, and the next one is not planned yet: the study runs. */
static void a_study_between_rounds_is_cancelled_and_goes_on(void **state) {
    (void)state;
    const struct case_result empty = {0};
    uint64_t jobs = 7;
    while (run_one())
        ;
    assert_int_equal(store_cancel(store, id, NULL), 0);
    assert_int_equal(store_cancel(store, id, NULL), ERROR_STATE);
    assert_false(grow(revision_now(), 100, 100));
    assert_int_equal(store_publish(store, id, 0, revision_now(), &empty, NULL), 0);
    assert_false(is_due());
    assert_int_equal(store_retry(store, id, 0, &jobs, NULL), 0);
    assert_int_equal(jobs, 0);
    struct study_status status = status_now();
    assert_string_equal(status.state, "running");
    assert_string_equal(status.finished, "");
    study_status_clear(&status);
    assert_true(is_due());
    assert_true(grow(revision_now(), 9, 4));
}

static void failed_jobs_end_a_round(void **state) {
    (void)state;
    struct claimed_job job;
    assert_int_equal(claim(&job), 1);
    assert_int_equal(store_fail(store, job.id, job.token, "no", true, NULL), 0);
    claimed_job_clear(&job);
    assert_false(is_due());
    while (run_one())
        ;
    assert_true(is_due());
}

static int refuse(void *context, struct store *of, const struct due_case *due, size_t number,
                  struct error *err) {
    (void)context;
    (void)of;
    (void)due;
    (void)number;
    return error_set(err, ERROR_INPUT, "damaged block");
}

static void check_done(uint64_t number, uint64_t done) {
    struct case_info info;
    assert_int_equal(store_any_case(store, id, number, &info, NULL), 0);
    assert_int_equal(info.realisations_done, done);
    case_info_clear(&info);
}

/* The mark is that of the case, the results are its components': they are discarded, and computed
 * again. */
static void what_cannot_be_published_is_computed_again(void **state) {
    (void)state;
    static const uint64_t DONE[] = {12, 8, 4};
    const struct publication refused = {.publish = refuse};
    struct publish_counts counts;
    uint64_t jobs = 0;
    while (run_one())
        ;
    assert_int_equal(store_publish_due(store, &refused, &counts, NULL), 0);
    assert_int_equal(counts.failed, 1);
    for (uint64_t number = 0; number < 3; number++)
        check_done(number, DONE[number]);
    assert_int_equal(store_retry(store, id, 0, &jobs, NULL), 0);
    assert_int_equal(jobs, 3);
    for (uint64_t number = 0; number < 3; number++)
        check_done(number, 0);
    assert_false(is_due());
    while (run_one())
        ;
    for (uint64_t number = 0; number < 3; number++)
        check_done(number, DONE[number]);
    assert_true(is_due());
    struct study_status status = status_now();
    assert_int_equal(status.realisations_done, 12);
    assert_int_equal(status.jobs_done, 3);
    study_status_clear(&status);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(is_due_when_all_jobs_are_over, submit, end),
        cmocka_unit_test_setup_teardown(a_component_is_no_case, submit, end),
        cmocka_unit_test_setup_teardown(a_round_is_queued_once, submit, end),
        cmocka_unit_test_setup_teardown(nothing_grows_after_a_cancellation, submit, end),
        cmocka_unit_test_setup_teardown(a_study_between_rounds_is_cancelled_and_goes_on, submit,
                                        end),
        cmocka_unit_test_setup_teardown(failed_jobs_end_a_round, submit, end),
        cmocka_unit_test_setup_teardown(what_cannot_be_published_is_computed_again, submit, end),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
