/* Protects: owners take turns at the workers by the time that their jobs take and by their weights,
 * whoever came first and however long a study is; of an owner the study of higher priority is
 * first; and a study that waits has its position and an estimate of when it starts. */
#include "schema/store/store.h"
#include "schema/study/study_reader.h"
#include "tests/support/check.h"
#include "tests/support/fake_kind.h"
#include "tests/support/store_text.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static int64_t clock_ms;
static int64_t test_clock(void *context) {
    (void)context;
    return clock_ms;
}

static struct store *open_store(const char *path) {
    struct store *store = NULL;
    const struct store_options options = {.now_ms = test_clock};
    assert_int_equal(store_open(&store, path, &options, NULL), 0);
    return store;
}

/* A study of one case and `jobs` jobs; a realisation takes `seconds`, and a job five at least. */
static void submit(struct store *store, const char *owner, int priority, int jobs, double seconds,
                   char id[STUDY_ID_SIZE]) {
    char text[240];
    struct study *study = NULL;
    struct fault_list faults = {0};
    snprintf(
        text, sizeof text,
        "{\"name\":\"n\",\"kind\":\"boxes\",\"realisations\":%d,\"seconds\":%g,\"priority\":%d,"
        "\"box\":{\"width\":1}}",
        jobs * (seconds < 5 ? (int)(5 / seconds) : 1), seconds, priority);
    assert_int_equal(study_read(&study, text, strlen(text), NULL, FAKE_KINDS, 0, &faults, NULL), 0);
    study->owner = strdup(owner);
    assert_int_equal(store_submit(store, study, NULL, id, NULL, NULL), 0);
    study_destroy(&study);
}

/* The study of the next job, which is then done, or left running. */
static void next(struct store *store, bool ends, char id[STUDY_ID_SIZE]) {
    static const char *const NAMES[] = {"a"};
    const struct claim claim = {.worker = "w", .host = "h", .count = 1};
    struct claimed_job job = {0};
    size_t claimed = 0;
    bool first, done;
    assert_int_equal(store_claim(store, &claim, &job, &claimed, NULL), 0);
    assert_int_equal(claimed, 1);
    snprintf(id, STUDY_ID_SIZE, "%s", job.study);
    double scalars[64] = {0};
    const struct block_result result = {.first = job.first,
                                        .count = job.count,
                                        .scalar_count = 1,
                                        .names = NAMES,
                                        .scalars = scalars,
                                        .data = (const unsigned char *)"block",
                                        .size = 5,
                                        .seconds = 5,
                                        .cpu_seconds = 5};
    if (ends)
        assert_int_equal(store_complete(store, job.id, job.token, &result, &first, &done, NULL), 0);
    claimed_job_clear(&job);
}

/* Of the next jobs, how many are of this study. */
static int share_of(struct store *store, const char *id, int jobs) {
    char got[STUDY_ID_SIZE];
    int share = 0;
    for (int j = 0; j < jobs; j++) {
        next(store, true, got);
        share += strcmp(got, id) == 0;
    }
    return share;
}

static void a_short_study_does_not_wait_for_a_long_one(void **state) {
    (void)state;
    struct store *store = open_store("short.db");
    char week[STUDY_ID_SIZE], small[STUDY_ID_SIZE], got[STUDY_ID_SIZE];
    submit(store, "anna", 0, 200, 0.5, week);
    assert_int_equal(share_of(store, week, 50), 50);
    submit(store, "bert", 0, 4, 0.5, small);
    next(store, true, got);
    assert_string_equal(got, small);
    /* it has no claim to what it did not use before: they take turns */
    assert_int_equal(share_of(store, small, 6), 3);
    assert_int_equal(share_of(store, week, 9), 9);
    store_close(&store);
}

static void shares_are_of_time_and_weight(void **state) {
    (void)state;
    struct store *store = open_store("weight.db");
    char anna[STUDY_ID_SIZE], bert[STUDY_ID_SIZE];
    submit(store, "anna", 0, 60, 0.5, anna);
    submit(store, "bert", 0, 60, 0.5, bert);
    assert_int_equal(store_share(store, "bert", 3, NULL), 0);
    assert_in_range(share_of(store, bert, 40), 29, 31);
    assert_int_equal(store_share(store, "bert", 0, NULL), ERROR_INPUT);
    assert_int_equal(store_share(store, "bert", NAN, NULL), ERROR_INPUT);
    store_close(&store);

    /* Before any job is done, estimates count: jobs of 100 s have 6 turns where those of 60 s have
     * 10. */
    store = open_store("time.db");
    struct study_status now = {0};
    submit(store, "anna", 0, 100, 100, anna);
    submit(store, "bert", 0, 100, 60, bert);
    for (int j = 0; j < 32; j++) {
        char got[STUDY_ID_SIZE];
        next(store, false, got);
    }
    assert_int_equal(store_status(store, anna, &now, NULL), 0);
    assert_in_range(now.jobs_running, 11, 13);
    study_status_clear(&now);
    store_close(&store);
}

static void of_one_owner_priority_comes_first(void **state) {
    (void)state;
    struct store *store = open_store("priority.db");
    char low[STUDY_ID_SIZE], first[STUDY_ID_SIZE], second[STUDY_ID_SIZE], high[STUDY_ID_SIZE];
    submit(store, "", -1, 2, 0.5, low);
    submit(store, "", 0, 2, 0.5, first);
    submit(store, "", 0, 2, 0.5, second);
    submit(store, "", 7, 2, 0.5, high);
    assert_int_equal(share_of(store, high, 2), 2);
    assert_int_equal(share_of(store, first, 2), 2);
    assert_int_equal(share_of(store, second, 2), 2);
    assert_int_equal(share_of(store, low, 2), 2);
    store_close(&store);
}

static void check_place(struct store *store, const char *id, uint64_t place, double starts_in) {
    struct study_status now = {0};
    assert_int_equal(store_status(store, id, &now, NULL), 0);
    assert_int_equal(now.place, place);
    if (isnan(starts_in) ? !isnan(now.starts_in) : !(fabs(now.starts_in - starts_in) <= 1e-9))
        fail_msg("%s starts in %g, not %g", id, now.starts_in, starts_in);
    study_status_clear(&now);
}

static void a_place_in_line_is_told(void **state) {
    (void)state;
    struct store *store = open_store("place.db");
    char week[STUDY_ID_SIZE], mine[STUDY_ID_SIZE], later[STUDY_ID_SIZE], small[STUDY_ID_SIZE],
        got[STUDY_ID_SIZE];
    submit(store, "anna", 0, 21, 0.5, week);
    check_place(store, week, 1, NAN); /* nobody is at work */
    next(store, false, got);
    submit(store, "anna", 0, 3, 0.5, mine);
    submit(store, "bert", 0, 2, 0.5, small);
    submit(store, "bert", 0, 2, 0.5, later);
    /* bert's clock is five seconds behind that of anna, of whom a job runs so long */
    check_place(store, week, 0, NAN); /* it runs */
    check_place(store, small, 1, 5);
    clock_ms += 2000;
    check_place(store, small, 1, 3);
    /* the two jobs before it, and anna's in that time: from her first job to his second one */
    check_place(store, later, 2, 3 + 15);
    /* 20 jobs of the week, and the four of bert */
    check_place(store, mine, 3, 3 + 24 * 5);
    next(store, false, got); /* two at work */
    assert_string_equal(got, small);
    check_place(store, mine, 2, (3 + 5 + 23 * 5) / 2.0);
    store_close(&store);
}

/* A worker of other kinds is given nothing, and takes nobody's turn. */
static void a_claim_may_name_kinds(void **state) {
    (void)state;
    struct store *store = open_store("kinds.db");
    static const char *const OTHERS[] = {"box", "oxes", "contact", NULL};
    static const char *const BOXES[] = {"contact", "boxes", NULL};
    struct claim claim = {.worker = "w", .host = "h", .count = 1, .kinds = OTHERS};
    struct claimed_job job = {0};
    size_t count = 9;
    char id[STUDY_ID_SIZE];
    submit(store, "anna", 0, 2, 0.5, id);
    assert_int_equal(store_claim(store, &claim, &job, &count, NULL), 0);
    assert_int_equal(count, 0);
    claim.kinds = BOXES;
    assert_int_equal(store_claim(store, &claim, &job, &count, NULL), 0);
    assert_int_equal(count, 1);
    assert_string_equal(job.study, id);
    claimed_job_clear(&job);
    store_close(&store);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_short_study_does_not_wait_for_a_long_one),
        cmocka_unit_test(shares_are_of_time_and_weight),
        cmocka_unit_test(of_one_owner_priority_comes_first),
        cmocka_unit_test(a_place_in_line_is_told),
        cmocka_unit_test(a_claim_may_name_kinds),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
