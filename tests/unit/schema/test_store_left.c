/* Protects: the time left that a store estimates is near the truth from the first tenth on, however
 * far off the estimates were, however jobs fall to workers, and behind whatever else waits. */
#include "schema/store/schedule.h"
#include "schema/store/store.h"
#include "schema/study/fault.h"
#include "schema/study/study_reader.h"
#include "tests/support/check.h"
#include "tests/support/fake_kind.h"
#include <math.h>
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
    struct store_options options = {.lease_ms = 20000, .now_ms = test_clock};
    assert_int_equal(store_open(&store, path, &options, NULL), 0);
    return store;
}

/* So many cases of boxes, whose realisations are thought to take `seconds` each. */
static void submit(struct store *store, int cases, int realisations, double seconds,
                   char id[STUDY_ID_SIZE]) {
    char text[400];
    struct study *study = NULL;
    struct fault_list faults = {0};
    int used = snprintf(text, sizeof text,
                        "{\"name\":\"n\",\"kind\":\"boxes\",\"realisations\":%d,\"seconds\":%g,"
                        "\"box\":{\"width\":[1",
                        realisations, seconds);
    for (int c = 1; c < cases; c++)
        used += snprintf(text + used, sizeof text - (size_t)used, ",0.%d", 100 + c);
    snprintf(text + used, sizeof text - (size_t)used, "]}}");
    assert_int_equal(study_read(&study, text, strlen(text), NULL, FAKE_KINDS, 0, &faults, NULL), 0);
    assert_int_equal(store_submit(store, study, NULL, id, NULL, NULL), 0);
    study_destroy(&study);
}

static void the_last_jobs_fall_to_whom_they_do(void **state) {
    (void)state;
    double loads[3] = {1, 2, 6};
    check_close(schedule_end(loads, 3, 0, NULL, 0), 6, 1e-15);
    check_close(schedule_end((double[]){1, 2, 6}, 3, 3, NULL, 0), 6, 1e-15);
    check_close(schedule_end((double[]){6, 2, 1}, 3, 12, NULL, 0), 7, 1e-15);
    check_close(schedule_end((double[]){0, 0}, 2, 10, (double[]){4, 4, 4}, 3), 13, 1e-15);
    check_close(schedule_end((double[]){0}, 1, 10, (double[]){4, 4, 4}, 3), 22, 1e-15);
    check_close(schedule_end((double[]){0, 0}, 2, 0, (double[]){1, 1, 8}, 3), 9, 1e-15);
}

/* --- a study as it runs --- */

enum { WORKERS_MOST = 4 };
struct worker {
    struct claimed_job job;
    bool busy;
    double started, rate; /* seconds, of a realisation */
};

static void finish(struct store *store, struct worker *worker, double seconds) {
    static const char *const NAMES[] = {"a"};
    double *scalars = calloc((size_t)worker->job.count, sizeof *scalars);
    struct block_result result = {.first = worker->job.first,
                                  .count = worker->job.count,
                                  .scalar_count = 1,
                                  .names = NAMES,
                                  .scalars = scalars,
                                  .data = (const unsigned char *)"data",
                                  .size = 4,
                                  .seconds = seconds,
                                  .cpu_seconds = seconds};
    bool first, done;
    assert_non_null(scalars);
    assert_int_equal(
        store_complete(store, worker->job.id, worker->job.token, &result, &first, &done, NULL), 0);
    free(scalars);
    claimed_job_clear(&worker->job);
    worker->busy = false;
}

static bool claim(struct store *store, unsigned number, struct worker *worker, double now,
                  const double *rates) {
    char name[8];
    size_t count = 0;
    snprintf(name, sizeof name, "w%u", number);
    struct claim claim = {.worker = name, .host = "here", .program = "0.0.1+c0ffee", .count = 1};
    assert_int_equal(store_claim(store, &claim, &worker->job, &count, NULL), 0);
    worker->busy = count > 0;
    worker->started = now;
    if (worker->busy)
        worker->rate = rates[worker->job.case_number];
    return worker->busy;
}

enum { SECONDS_MOST = 20000 };

/* Works a study off second by second, with reports: what is reported each second of the time left
 * and the share. Returns the seconds that it took. */
static int work_off(struct store *store, const char *id, unsigned workers, const double *rates,
                    double *told, double *share) {
    struct worker at[WORKERS_MOST] = {0};
    int start = (int)(clock_ms / 1000);
    for (int now = 0; now < SECONDS_MOST; now++) {
        bool busy = false;
        clock_ms = 1000 * (int64_t)(start + now);
        for (unsigned w = 0; w < workers; w++) {
            double passed = now - at[w].started;
            if (at[w].busy && passed >= (double)at[w].job.count * at[w].rate)
                finish(store, &at[w], passed);
            else if (at[w].busy)
                assert_int_equal(store_heartbeat(store, at[w].job.id, at[w].job.token,
                                                 floor(passed / at[w].rate), NULL),
                                 0);
            if (!at[w].busy)
                claim(store, w, &at[w], now, rates);
            busy = busy || at[w].busy;
        }
        struct study_status status;
        assert_int_equal(store_status(store, id, &status, NULL), 0);
        told[now] = status.seconds_left;
        share[now] = status.share;
        study_status_clear(&status);
        if (!busy)
            return now;
    }
    fail_msg("it never ends");
    return 0;
}

/* Within a fifth of the truth, beside one realisation, of which nobody knows how far it is. */
static void near_the_truth(void **state) {
    (void)state;
    static const struct {
        int cases, realisations;
        unsigned workers;
        double estimate, rates[8];
    } STUDIES[] = {
        {1, 200, 1, 1, {2.9}},                       /* jobs beyond count, a wrong estimate */
        {1, 20, 2, 1, {5}},                          /* one job, and a worker without any */
        {6, 20, 2, 0.5, {2, 2.2, 2.1, 1.9, 2, 2.2}}, /* a job a case */
        {5, 30, 4, 9, {3, 3.3, 2.7, 3, 3.3}},        /* more workers at the end than jobs */
        {3, 300, 2, 2, {2, 2, 2}},
        {2, 40, 2, 6, {60, 60}}, /* few realisations, and long ones */
    };
    static double told[SECONDS_MOST], share[SECONDS_MOST];
    for (size_t s = 0; s < sizeof STUDIES / sizeof *STUDIES; s++) {
        char path[24], id[STUDY_ID_SIZE];
        snprintf(path, sizeof path, "left%zu.db", s);
        struct store *store = open_store(path);
        submit(store, STUDIES[s].cases, STUDIES[s].realisations, STUDIES[s].estimate, id);
        int end = work_off(store, id, STUDIES[s].workers, STUDIES[s].rates, told, share);
        assert_true(end > 20);
        for (int now = end / 10; now < end; now++) {
            double left = end - now, slack = 0.2 * left + STUDIES[s].rates[0];
            if (!(fabs(told[now] - left) <= slack))
                fail_msg("study %zu, second %d of %d: %g s left", s, now, end, told[now]);
            if (now > end / 10 && !(share[now] >= share[now - 1] - 0.05 && share[now] <= 1))
                fail_msg("study %zu, second %d: share %g after %g", s, now, share[now],
                         share[now - 1]);
        }
        assert_true(told[end] == 0 && share[end] == 1);
        store_close(&store);
    }
}

/* A realisation that takes many times its estimate is not about to end: it is said to need as long
 * again as it is late. The share that is done does not fall. */
static void late_realisations_are_not_about_to_end(void **state) {
    (void)state;
    static double told[SECONDS_MOST], share[SECONDS_MOST];
    const double rates[] = {400};
    char id[STUDY_ID_SIZE];
    struct store *store = open_store("late.db");
    submit(store, 1, 1, 2, id);
    int end = work_off(store, id, 1, rates, told, share);
    assert_int_equal(end, 400);
    for (int now = 3; now < end; now++) {
        check_close(told[now], now - 1.8, 1e-9); /* of 2 s a twentieth is always left */
        assert_true(share[now] >= share[now - 1] - 1e-9 && share[now] < 1);
    }
    store_close(&store);
}

/* Realisations that failed for good are not left. Nor does anybody work at a study whose only lease
 * ran out. */
static void what_is_given_up_is_not_left(void **state) {
    (void)state;
    char id[STUDY_ID_SIZE];
    struct study_status status;
    struct worker worker = {0};
    const double rates[] = {100};
    struct store *store = open_store("given-up.db");
    clock_ms = 1000;
    submit(store, 1, 200, 100, id);
    assert_true(claim(store, 0, &worker, 0, rates));
    for (;;) {
        assert_int_equal(store_status(store, id, &status, NULL), 0);
        const double left = 200 - (double)status.realisations_failed;
        check_close(status.seconds_left, 100 * left, 1e-9 * left);
        check_close(status.share, 0, 1e-12);
        assert_int_equal(status.workers, 1);
        bool last = status.jobs_waiting == 0;
        study_status_clear(&status);
        if (last)
            break;
        assert_int_equal(store_fail(store, worker.job.id, worker.job.token, "no", true, NULL), 0);
        claimed_job_clear(&worker.job);
        assert_true(claim(store, 0, &worker, 0, rates));
    }
    clock_ms += 20001; /* more than the lease */
    assert_int_equal(store_status(store, id, &status, NULL), 0);
    assert_int_equal(status.workers, 0);
    assert_true(isnan(status.seconds_left));
    study_status_clear(&status);
    claimed_job_clear(&worker.job);
    store_close(&store);
}

/* --- a study that waits --- */

static double left_of(struct store *store, const char *id) {
    struct study_status status;
    assert_int_equal(store_status(store, id, &status, NULL), 0);
    double left = status.seconds_left;
    study_status_clear(&status);
    return left;
}

static void behind_others(void **state) {
    (void)state;
    struct store *store = open_store("queue.db");
    char first[STUDY_ID_SIZE], second[STUDY_ID_SIZE], third[STUDY_ID_SIZE];
    struct worker workers[2] = {0};
    const double rates[] = {2};
    clock_ms = 0;
    submit(store, 1, 1000, 2, first);
    submit(store, 1, 100, 2, second);
    submit(store, 1, 10, 2, third);
    assert_true(isnan(left_of(store, first))); /* nobody works */
    assert_true(isnan(left_of(store, third)));
    assert_true(claim(store, 0, &workers[0], 0, rates) && claim(store, 1, &workers[1], 0, rates));
    /* shared by two, but for the last job of each */
    check_close(left_of(store, first), 1000, 30);
    check_close(left_of(store, second), 1000 + 100, 30);
    check_close(left_of(store, third), 1000 + 100 + 20, 30);
    struct study_status *list = NULL;
    size_t count = 0;
    assert_int_equal(store_list(store, "", 10, &list, &count, NULL), 0);
    assert_int_equal(count, 3);
    check_close(list[2].seconds_left, left_of(store, third), 1e-12);
    struct study_status counted = {0};
    assert_int_equal(store_status_counted(store, third, &counted, NULL), 0);
    assert_int_equal(counted.realisations_total, list[2].realisations_total);
    assert_int_equal(counted.jobs_waiting, list[2].jobs_waiting);
    assert_true(isnan(counted.seconds_left) && isnan(counted.share) && isnan(counted.starts_in));
    study_status_clear(&counted);
    assert_int_equal(store_status_counted(store, "0123", &counted, NULL), ERROR_ABSENT);
    for (size_t i = 0; i < count; i++)
        study_status_clear(&list[i]);
    free(list);
    claimed_job_clear(&workers[0].job);
    claimed_job_clear(&workers[1].job);
    store_close(&store);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_last_jobs_fall_to_whom_they_do),
        cmocka_unit_test(near_the_truth),
        cmocka_unit_test(late_realisations_are_not_about_to_end),
        cmocka_unit_test(what_is_given_up_is_not_left),
        cmocka_unit_test(behind_others),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
