/* Protects: the states of studies and jobs, through every transition, on a clock that the test
 * sets: what a lease allows, that nothing is done twice or lost, and what people read of it. */
#include "core/rugo.h"
#include "schema/store/store.h"
#include "schema/study/fault.h"
#include "schema/study/study_reader.h"
#include "tests/support/check.h"
#include "tests/support/fake_kind.h"
#include "tests/support/sample_result.h"
#include "tests/support/sql.h"
#include "tests/support/store_text.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

static int64_t clock_ms;
static int64_t test_clock(void *context) {
    (void)context;
    return clock_ms;
}

static struct store *open_store(const char *path) {
    struct store *store = NULL;
    struct store_options options = {.lease_ms = 1000, .now_ms = test_clock};
    struct error err = {0};
    if (store_open(&store, path, &options, &err))
        print_error("%s\n", err.text);
    assert_non_null(store);
    return store;
}

/* Two cases of `realisations` in blocks of ten. */
static void submit(struct store *store, int realisations, const char *key, char id[STUDY_ID_SIZE]) {
    char text[200];
    struct study *study = NULL;
    struct fault_list faults = {0};
    snprintf(text, sizeof text,
             "{\"name\":\"n\",\"kind\":\"boxes\",\"realisations\":%d,\"seconds\":0.5,\"box\":{"
             "\"width\":[0.5,1]}}",
             realisations);
    assert_int_equal(study_read(&study, text, strlen(text), NULL, FAKE_KINDS, 0, &faults, NULL), 0);
    assert_int_equal(store_submit(store, study, key, id, NULL, NULL), 0);
    study_destroy(&study);
}

static struct study *read_study(const char *text) {
    struct study *study = NULL;
    struct fault_list faults = {0};
    assert_int_equal(study_read(&study, text, strlen(text), NULL, FAKE_KINDS, 0, &faults, NULL), 0);
    return study;
}

static size_t claim(struct store *store, const char *worker, struct claimed_job *job) {
    struct claim claim = {.worker = worker, .host = "here", .program = "0.0.1+c0ffee", .count = 1};
    size_t count = 0;
    assert_int_equal(store_claim(store, &claim, job, &count, NULL), 0);
    return count;
}

static const char *const NAMES[] = {"a", "b"};

static int complete(struct store *store, const struct claimed_job *job, bool *first,
                    bool *case_done, struct error *err) {
    double scalars[20];
    for (size_t i = 0; i < 20; i++)
        scalars[i] = i == 3 ? NAN : (double)(job->first + i) / 3;
    struct block_result result = {.first = job->first,
                                  .count = job->count,
                                  .scalar_count = 2,
                                  .names = NAMES,
                                  .scalars = scalars,
                                  .data = (const unsigned char *)"\0\1data",
                                  .size = 6,
                                  .seconds = 2,
                                  .cpu_seconds = 0.5 * (double)job->count};
    assert_true(job->count <= 10);
    return store_complete(store, job->id, job->token, &result, first, case_done, err);
}

/* Publishes an empty result of each case that is due. */
static int publish_empty(void *context, struct store *store, const struct due_case *due,
                         size_t number, struct error *err) {
    (void)number;
    const struct case_result empty = {.case_number = due->case_number};
    (void)context;
    return store_publish(store, due->study, due->case_number, due->revision, &empty, err);
}

static void publish_all(struct store *store) {
    const struct publication publication = {.publish = publish_empty};
    struct publish_counts counts;
    assert_int_equal(store_publish_due(store, &publication, &counts, NULL), 0);
}

static const char *state_of(struct store *store, const char *id) {
    struct study_status status;
    assert_int_equal(store_status(store, id, &status, NULL), 0);
    assert_int_equal(status.jobs, status.jobs_waiting + status.jobs_running + status.jobs_done +
                                      status.jobs_failed + status.jobs_cancelled);
    const char *state = status.state;
    study_status_clear(&status);
    return state;
}

static void a_study_runs_to_its_end(void **state) {
    (void)state;
    struct store *store = open_store("end.db");
    char id[STUDY_ID_SIZE];
    bool first, done;
    submit(store, 20, NULL, id);
    assert_string_equal(state_of(store, id), "queued");
    for (int j = 0; j < 4; j++) {
        struct claimed_job job;
        assert_int_equal(claim(store, "w", &job), 1);
        assert_string_equal(state_of(store, id), "running");
        assert_int_equal(job.case_number, j / 2);
        assert_int_equal(job.first, 10 * (j % 2));
        assert_int_equal(job.attempt, 1);
        assert_int_equal(complete(store, &job, &first, &done, NULL), 0);
        assert_true(first && done == (j % 2 == 1));
        assert_int_equal(complete(store, &job, &first, &done, NULL),
                         0); /* an answer lost, sent again */
        assert_false(first);
        claimed_job_clear(&job);
    }
    struct claimed_job none;
    assert_int_equal(claim(store, "w", &none), 0);
    assert_string_equal(state_of(store, id), "running"); /* its cases are yet to be published */
    publish_all(store);
    assert_string_equal(state_of(store, id), "done");
    struct study_status status;
    assert_int_equal(store_status(store, id, &status, NULL), 0);
    assert_int_equal(status.realisations_done, 40);
    check_close(status.time.seconds, 8, 1e-12);
    check_close(status.time.cpu_seconds, 20, 1e-12);
    assert_int_equal(status.time.jobs_without_cpu, 0);
    assert_true(status.seconds_left == 0 && *status.finished);
    study_status_clear(&status);
    struct error err = {0};
    assert_int_equal(store_cancel(store, id, &err), ERROR_STATE);
    store_close(&store);
}

/* Jobs report parts of a realisation, too: they count in the share and the time left, and are seen,
 * but no realisation is done by them. */
static void parts_of_realisations_count(void **state) {
    (void)state;
    struct store *store = open_store("part.db");
    char id[STUDY_ID_SIZE];
    struct claimed_job job;
    struct study_status begun, half, done;
    struct worker_activity *workers;
    size_t count;
    submit(store, 5, NULL, id);
    clock_ms = 5000;
    assert_int_equal(claim(store, "one", &job), 1);
    clock_ms = 5400;
    assert_int_equal(store_heartbeat(store, job.id, job.token, 0.1, NULL), 0);
    assert_int_equal(store_status(store, id, &begun, NULL), 0);
    assert_int_equal(store_heartbeat(store, job.id, job.token, 0.5, NULL), 0);
    assert_int_equal(store_status(store, id, &half, NULL), 0);
    assert_int_equal(store_heartbeat(store, job.id, job.token, 1.5, NULL), 0);
    assert_int_equal(store_status(store, id, &done, NULL), 0);
    assert_true(begun.part == 0.1 && half.part == 0.5 && done.part == 0.5);
    assert_true(begun.realisations_done == 0 && half.realisations_done == 0);
    assert_int_equal(done.realisations_done, 1);
    /* in the same time */
    assert_true(begun.seconds_left > 2 * half.seconds_left);
    assert_true(half.seconds_left > 2 * done.seconds_left);
    assert_true(begun.share < half.share && half.share < done.share);
    assert_int_equal(store_workers(store, &workers, &count, NULL), 0);
    assert_int_equal(count, 1);
    assert_true(workers[0].done == 1 && workers[0].part == 0.5);
    workers_free(workers, count);
    claimed_job_clear(&job);
    study_status_clear(&begun);
    study_status_clear(&half);
    study_status_clear(&done);
    store_close(&store);
}

static void leases_run_out_and_fence(void **state) {
    (void)state;
    struct store *store = open_store("lease.db");
    char id[STUDY_ID_SIZE];
    struct claimed_job slow, quick;
    struct error err = {0};
    bool first, done;
    submit(store, 5, NULL, id);
    clock_ms = 5000;
    assert_int_equal(claim(store, "slow", &slow), 1);
    clock_ms = 5900;
    assert_int_equal(store_heartbeat(store, slow.id, slow.token, 3, NULL), 0);
    clock_ms = 6500; /* beyond the first lease, within the renewed one */
    assert_int_equal(claim(store, "slow", &quick), 1);
    assert_true(quick.id != slow.id);
    claimed_job_clear(&quick);
    clock_ms = 6900; /* it waits for a second from here on */
    assert_int_equal(claim(store, "slow", &quick), 0);
    clock_ms = 7899;
    assert_int_equal(claim(store, "slow", &quick), 0);
    clock_ms = 7900;
    assert_int_equal(claim(store, "slow", &quick), 1);
    assert_int_equal(quick.id, slow.id);
    assert_int_equal(quick.attempt, 1);
    assert_int_equal(store_heartbeat(store, slow.id, slow.token, 4, &err), ERROR_STATE);
    assert_non_null(strstr(err.text, "lost"));
    assert_int_equal(complete(store, &slow, &first, &done, &err), ERROR_STATE);
    assert_int_equal(store_fail(store, slow.id, slow.token, "late", false, &err), ERROR_STATE);
    assert_int_equal(store_release(store, slow.id, slow.token, &err), ERROR_STATE);
    clock_ms = 99000; /* ran out, but nobody took it: its result is as good as ever */
    assert_int_equal(complete(store, &quick, &first, &done, NULL), 0);
    assert_true(first);
    clock_ms = 1; /* the clock of a test may go back; a running lease only lives longer */
    claimed_job_clear(&slow);
    claimed_job_clear(&quick);
    store_close(&store);
}

static void three_attempts_then_failed_with_its_reason(void **state) {
    (void)state;
    struct store *store = open_store("fail.db");
    char id[STUDY_ID_SIZE];
    struct claimed_job job;
    clock_ms = 0;
    submit(store, 10, NULL, id);
    for (uint64_t attempt = 1; attempt <= 3; attempt++) {
        assert_int_equal(claim(store, "w", &job), 1);
        assert_int_equal(job.case_number, 0);
        assert_int_equal(job.attempt, attempt);
        assert_int_equal(store_release(store, job.id, job.token, NULL),
                         0); /* handed back: does not count */
        claimed_job_clear(&job);
        assert_int_equal(claim(store, "w", &job), 1);
        assert_int_equal(job.attempt, attempt);
        assert_int_equal(store_fail(store, job.id, job.token, "out of luck", false, NULL), 0);
        claimed_job_clear(&job);
    }
    assert_int_equal(claim(store, "w", &job), 1);
    assert_int_equal(job.case_number, 1);
    assert_int_equal(store_fail(store, job.id, job.token, "hopeless", true, NULL), 0); /* at once */
    claimed_job_clear(&job);
    assert_string_equal(state_of(store, id), "failed");
    struct failure *failures;
    size_t count;
    assert_int_equal(store_failures(store, id, &failures, &count, NULL), 0);
    assert_int_equal(count, 2);
    assert_string_equal(failures[0].reason, "out of luck");
    assert_int_equal(failures[0].attempts, 3);
    assert_string_equal(failures[1].reason, "hopeless");
    failures_free(failures, count);
    uint64_t retried;
    assert_int_equal(store_retry(store, id, 0, &retried, NULL), 0);
    assert_int_equal(retried, 2);
    assert_string_equal(state_of(store, id), "queued");
    assert_int_equal(claim(store, "w", &job), 1);
    assert_int_equal(job.attempt, 1);
    claimed_job_clear(&job);
    store_close(&store);
}

/* A job that kills its workers, or whose workers are killed: it waits for longer each time, while
 * other jobs go on, and fails with the tenth. The attempts that it fails are counted apart. */
static void a_deadly_job_fails(void **state) {
    (void)state;
    static const int PAUSES[] = {1, 2, 4, 8, 16, 32, 64, 64, 64};
    struct store *store = open_store("deadly.db");
    char id[STUDY_ID_SIZE];
    struct claimed_job job;
    clock_ms = 0;
    submit(store, 10, NULL, id);
    for (int death = 0; death < 10; death++) {
        assert_int_equal(claim(store, "victim", &job), 1);
        assert_int_equal(job.case_number, 0);
        assert_int_equal(job.attempt, death < 5 ? 1 : 2);
        if (death == 4) { /* a failure between the losses */
            assert_int_equal(store_fail(store, job.id, job.token, "no luck", false, NULL), 0);
            claimed_job_clear(&job);
            assert_int_equal(claim(store, "victim", &job), 1);
        }
        assert_false(store_claim_failed_jobs(store));
        claimed_job_clear(&job);
        clock_ms += 1000; /* the lease */
        size_t found = claim(store, "other", &job);
        assert_int_equal(found, 1); /* of the other case */
        assert_int_equal(job.case_number, 1);
        assert_int_equal(store_claim_failed_jobs(store), death == 9);
        assert_int_equal(store_release(store, job.id, job.token, NULL), 0);
        claimed_job_clear(&job);
        clock_ms += death < 9 ? 1000 * PAUSES[death] - 1 : 0;
        assert_int_equal(claim(store, "other", &job), 1);
        assert_int_equal(job.case_number, 1); /* not yet */
        assert_int_equal(store_release(store, job.id, job.token, NULL), 0);
        claimed_job_clear(&job);
        clock_ms += 1;
    }
    struct failure *failures;
    size_t count;
    assert_int_equal(store_failures(store, id, &failures, &count, NULL), 0);
    assert_int_equal(count, 1);
    assert_string_equal(failures[0].reason,
                        "lost with its worker 10 times: killed, cut off or out of memory; the last "
                        "lease ran out on worker victim");
    assert_int_equal(failures[0].losses, 10);
    assert_int_equal(failures[0].attempts, 1);
    failures_free(failures, count);
    uint64_t retried;
    assert_int_equal(store_retry(store, id, 0, &retried, NULL), 0);
    assert_int_equal(claim(store, "victim", &job), 1);
    assert_int_equal(job.case_number, 0);
    claimed_job_clear(&job);
    clock_ms += 1000;
    assert_int_equal(claim(store, "other", &job), 1);
    assert_int_equal(job.case_number, 1);
    claimed_job_clear(&job);
    check_text("deadly.db", "SELECT sum(losses) FROM job_log WHERE \"case\" = 0", "1");
    store_close(&store);
}

static void cancelled_studies_stop_their_jobs(void **state) {
    (void)state;
    struct store *store = open_store("cancel.db");
    char id[STUDY_ID_SIZE];
    struct claimed_job job;
    struct error err = {0};
    bool first, done;
    submit(store, 20, NULL, id);
    assert_int_equal(claim(store, "w", &job), 1);
    assert_int_equal(store_cancel(store, id, NULL), 0);
    assert_string_equal(state_of(store, id), "cancelled");
    assert_int_equal(store_heartbeat(store, job.id, job.token, 1, &err), ERROR_STATE);
    assert_non_null(strstr(err.text, "cancelled"));
    assert_int_equal(complete(store, &job, &first, &done, &err), ERROR_STATE);
    assert_int_equal(store_cancel(store, id, &err), ERROR_STATE);
    uint64_t retried;
    assert_int_equal(store_retry(store, id, 0, &retried, NULL), 0);
    assert_int_equal(retried, 4);
    assert_int_equal(store_cancel(store, "0123456789abcdef", &err), ERROR_ABSENT);
    claimed_job_clear(&job);
    store_close(&store);
}

static void a_key_gives_the_same_study(void **state) {
    (void)state;
    struct store *store = open_store("key.db");
    char one[STUDY_ID_SIZE], two[STUDY_ID_SIZE], three[STUDY_ID_SIZE];
    submit(store, 10, "k", one);
    submit(store, 10, "k", two);
    submit(store, 10, NULL, three);
    assert_string_equal(one, two);
    assert_string_not_equal(one, three);
    store_close(&store);
}

/* In a group commit a member that fails leaves the others. */
static void group_commit_keeps_its_members_apart(void **state) {
    (void)state;
    struct store *store = open_store("group.db");
    char id[STUDY_ID_SIZE];
    struct claimed_job job;
    struct error err = {0};
    bool first, done;
    submit(store, 10, NULL, id);
    assert_int_equal(claim(store, "w", &job), 1);
    assert_int_equal(store_begin(store, NULL), 0);
    assert_int_equal(store_heartbeat(store, job.id, "wrong", 1, &err), ERROR_STATE);
    assert_int_equal(complete(store, &job, &first, &done, NULL), 0);
    assert_int_equal(store_cancel(store, "0123456789abcdef", &err), ERROR_ABSENT);
    assert_int_equal(store_commit(store, NULL), 0);
    struct study_status status;
    assert_int_equal(store_status(store, id, &status, NULL), 0);
    assert_int_equal(status.jobs_done, 1);
    study_status_clear(&status);
    claimed_job_clear(&job);
    store_close(&store);
}

/* --- what people read --- */

static int count_blocks(void *context, const struct block_result *result, struct error *err) {
    uint64_t *next = context;
    (void)err;
    assert_int_equal(result->first, *next);
    assert_int_equal(result->size, 6);
    assert_memory_equal(result->data, "\0\1data", 6);
    assert_true(result->scalars[2] == (double)(result->first + 2) / 3 && isnan(result->scalars[3]));
    *next = result->first + result->count;
    return 0;
}

/* Sees what is due, and publishes nothing. */
static int see_due(void *context, struct store *store, const struct due_case *due, size_t number,
                   struct error *err) {
    (void)number;
    uint64_t *seen = context;
    (void)store;
    (void)err;
    *seen |= (uint64_t)1 << due->case_number;
    return 0;
}

/* The cases due, a bit each. */
static uint64_t due_cases(struct store *store) {
    uint64_t seen = 0;
    bool any = false;
    struct publication publication = {.publish = see_due, .context = &seen};
    struct publish_counts counts;
    assert_int_equal(store_publish_due(store, &publication, &counts, NULL), 0);
    assert_int_equal(store_is_due(store, &any, NULL), 0);
    assert_int_equal(any, seen != 0);
    return seen;
}

/* What the views have of the store that results_and_views made. */
static void check_views(const char *path) {
    static const struct {
        const char *sql, *expected;
    } VIEWS[] = {
        {"SELECT state || percent FROM study_progress", "running100.0"},
        {"SELECT count(*) || max(realisation) FROM realisation_scalars WHERE \"case\" = 1", "4019"},
        {"SELECT group_concat(scalar || coalesce(value, 'none')) FROM realisation_scalars "
         "WHERE \"case\" = 0 AND realisation = 1",
         "a0.666666666666667,bnone"},
        {"SELECT group_concat(x || ':' || y) FROM curve_points WHERE quantity = 'q'", "0.1:3.0"},
        {"SELECT min(x) || ':' || min(x2) || ':' || min(y) || ':' || min(standard_error) FROM "
         "curve_points WHERE quantity = 'joint'",
         "0.1:8.0:2.0:0.25"},
        {"SELECT group_concat(model || kinematics || level || '@' || pressure "
         "|| ':' || "
         "coalesce(discretisation_error, 'none') || ':' || coalesce(model_error, 'none') || ':' || "
         "valueless) "
         "FROM curve_points WHERE quantity = 'area'",
         "fullhencky8.0@0.5:0.25:none:0,fullhencky8.0@0.5:0.5:-2.0:3"},
        {"SELECT group_concat(x || source || value || ':' || coalesce(bound, 'none')) FROM "
         "curve_errors WHERE value IS NOT NULL ORDER BY x, source",
         "0.1discretisation-0.5:0.75,2.0discretisation1.0:0.0,0.1discretisation0.25:0.125,2."
         "0discretisation0.5:0.0,2.0model-2.0:none"},
        {"SELECT scalar || source || value || bound || standard_error FROM scalar_errors",
         "m0model-0.50.250.125"},
        {"SELECT \"case\" || realisation || note FROM case_notes", "07why"},
        {"SELECT group_concat(scalar || value || coalesce(standard_error, 'none')) FROM "
         "case_scalars",
         "alpha5.0none,m01.00.5"},
        /* Student's interval of 5.25 effective realisations, and all that the model's error of -0.5
           +- 0.25 comes to */
        {"SELECT group_concat(coalesce(round(total_low, 9), 'none') || ' ' || "
         "coalesce(round(total_high, 9), 'none') || coalesce(unknown_errors, '')) FROM "
         "case_scalars",
         "none none,-0.356602924 3.106602924cell"},
        {"SELECT count(*) > 2 AND max(abs(total_low - (y - 2.0686576104190414 * "
         "coalesce(standard_error, "
         "0) - max(0, known)))) < 1e-12 FROM (SELECT *, (SELECT total(value + "
         "coalesce(bound, 0)) FROM curve_errors e WHERE e.\"case\" = p.\"case\" AND "
         "e.quantity = p.quantity AND e.series IS p.series AND e.x = p.x AND e.model IS "
         "p.model AND e.level IS p.level) AS known FROM curve_points p) WHERE total_low "
         "IS NOT NULL",
         "1"},
        {"SELECT name || \"case\" || state || (parameters ->> '$.box.width') || ' ' || "
         "(scalars ->> 'm0') FROM case_table WHERE \"case\" = 0",
         "n0published0.5 1.0"},
        {"SELECT count(*) || group_concat(DISTINCT worker || host || attempts) FROM job_log",
         "4where1"},
        {"SELECT group_concat(\"case\" || parameter || '=' || value) FROM case_parameters WHERE "
         "parameter = '/box/width'",
         "0/box/width=0.5,1/box/width=1"},
        {"SELECT host || program || jobs || (first <= last) FROM study_runs", "here0.0.1+c0ffee41"},
        {"SELECT seed || program FROM study_progress", "1" RUGO_VERSION "+unknown"}};
    for (size_t v = 0; v < sizeof VIEWS / sizeof *VIEWS; v++)
        check_text(path, VIEWS[v].sql, VIEWS[v].expected);
}

static void results_and_views(void **state) {
    (void)state;
    struct store *store = open_store("views.db");
    char id[STUDY_ID_SIZE];
    bool first, done;
    uint64_t next = 0;
    struct claimed_job jobs[4];
    submit(store, 20, NULL, id);
    for (int j = 0; j < 4; j++)
        assert_int_equal(claim(store, "w", &jobs[j]), 1);
    for (int j = 3; j >= 0; j--) { /* completed backwards, read in order */
        assert_int_equal(complete(store, &jobs[j], &first, &done, NULL), 0);
        claimed_job_clear(&jobs[j]);
    }
    assert_int_equal(store_results(store, id, 0, count_blocks, &next, NULL), 0);
    assert_int_equal(next, 20);
    assert_int_equal(due_cases(store), 3);
    struct case_info info;
    assert_int_equal(store_case(store, id, 0, &info, NULL), 0);
    struct case_result sample, again = {0};
    const struct published_part all = {0}, areas = {.quantity = "area"},
                                curves = {.curves_only = true};
    bool found = false;
    sample_result(&sample);
    assert_int_equal(store_publish(store, id, 0, info.revision, &sample, NULL), 0);
    assert_int_equal(store_publish(store, id, 0, info.revision - 1, &sample, NULL),
                     0); /* an older one: ignored */
    assert_int_equal(store_published(store, id, 0, info.revision, &all, &again, &found, NULL), 0);
    assert_true(found && again.curve_count == 3 && again.scalar_count == 2);
    result_clear(&again);
    assert_int_equal(store_published(store, id, 0, info.revision, &areas, &again, &found, NULL), 0);
    assert_true(found && again.curve_count == 1 && again.curves[0].level == 8);
    result_clear(&again);
    assert_int_equal(store_published(store, id, 0, info.revision, &curves, &again, &found, NULL),
                     0);
    assert_true(found && again.curve_count == 3);
    result_clear(&again);
    assert_int_equal(store_published(store, id, 0, info.revision + 1, &all, &again, &found, NULL),
                     0);
    assert_false(found);
    assert_int_equal(due_cases(store), 2);
    result_clear(&sample);
    case_info_clear(&info);
    assert_int_equal(store_snapshot(store, "copy.db", NULL, NULL, NULL), 0);
    struct error err = {0};
    assert_int_equal(store_snapshot(store, "copy.db", NULL, NULL, &err), ERROR_INPUT);
    check_views("copy.db");
    cJSON *document = NULL;
    assert_int_equal(store_document(store, id, &document, NULL), 0);
    assert_true(json_number_at(document, "/realisations", 0) == 20);
    cJSON_Delete(document);
    assert_int_equal(store_document(store, "0123456789abcdef", &document, NULL), ERROR_ABSENT);
    store_close(&store);
}

/* --- cases that are published together --- */

struct group {
    const char *path;
    size_t prepared, published, cleared;
    bool moves; /* the file, before the change is committed */
};

static int prepare_some(void *context, struct store *store, const struct due_case *due,
                        size_t number, struct error *err) {
    struct group *group = context;
    (void)store;
    assert_int_equal(number, group->prepared++);
    if (due->case_number == 1)
        return error_set(err, ERROR_INPUT, "for good");
    return due->case_number == 2 ? error_set(err, ERROR_SYSTEM, "for now") : 0;
}

/* Nobody sees a part of a group. */
static int publish_group(void *context, struct store *store, const struct due_case *due,
                         size_t number, struct error *err) {
    struct group *group = context;
    assert_int_equal(sql_integer(group->path, "SELECT count(*) FROM published"), 0);
    assert_int_equal(number, due->case_number);
    group->published++;
    if (group->moves && due->case_number == 4)
        assert_int_equal(rename(group->path, "elsewhere.db"), 0);
    return publish_empty(NULL, store, due, number, err);
}

static void clear_group(void *context) {
    struct group *group = context;
    group->cleared++;
}

/* What was prepared is published in one change, or none of it is. A case that cannot be published
 * is marked, and holds up no other. */
static void a_group_is_published_as_one(void **state) {
    (void)state;
    static const char PATH[] = "together.db";
    struct store *store = open_store(PATH);
    struct study *study = read_study("{\"name\":\"n\",\"kind\":\"boxes\",\"realisations\":1,"
                                     "\"box\":{\"width\":[0.1,0.2,0.3,0.4,0.5]}}");
    char id[STUDY_ID_SIZE];
    bool first, done;
    struct claimed_job job;
    assert_int_equal(store_submit(store, study, NULL, id, NULL, NULL), 0);
    study_destroy(&study);
    while (claim(store, "w", &job) == 1) {
        assert_int_equal(complete(store, &job, &first, &done, NULL), 0);
        claimed_job_clear(&job);
    }
    struct group group = {.path = PATH, .moves = true};
    const struct publication publication = {
        .prepare = prepare_some, .publish = publish_group, .clear = clear_group, .context = &group};
    struct publish_counts counts;
    assert_int_equal(store_publish_due(store, &publication, &counts, NULL), 0);
    assert_int_equal(counts.published + counts.failed, 0);
    assert_int_equal(counts.postponed, 5);
    assert_string_equal(counts.reason.text, "for now"); /* the first reason */
    assert_int_equal(rename("elsewhere.db", PATH), 0);
    assert_int_equal(due_cases(store), 31);

    group = (struct group){.path = PATH};
    assert_int_equal(store_publish_due(store, &publication, &counts, NULL), 0);
    assert_int_equal(group.prepared, 5);
    assert_int_equal(group.published, 3);
    assert_true(group.cleared > 0);
    assert_int_equal(counts.published, 3);
    assert_int_equal(counts.failed, 1);
    assert_int_equal(counts.postponed, 1);
    assert_string_equal(counts.reason.text, "for now");
    assert_int_equal(due_cases(store), 4);
    store_close(&store);
}

/* --- files that are not ours --- */

static void other_files_are_refused_with_a_word(void **state) {
    (void)state;
    struct store *store = open_store("newer.db");
    store_close(&store);
    sql_change("newer.db", "PRAGMA user_version = 99");
    sql_change("other.db", "CREATE TABLE t (x)");
    FILE *file = fopen("junk.db", "w");
    assert_non_null(file);
    for (int i = 0; i < 5000; i++)
        fputs("junk", file);
    fclose(file);
    static const struct {
        const char *path, *text;
        bool existing;
    } BAD[] = {{"newer.db", "has schema version 99; this program knows up to", false},
               {"other.db", "is a database of another program", false},
               {"junk.db", "is damaged or no database", false},
               {".", "is not a file", false},
               {"missing/x.db", "missing/x.db", false},
               {"absent.db", "there is no database absent.db", true}};
    for (size_t b = 0; b < sizeof BAD / sizeof *BAD; b++) {
        struct error err = {0};
        struct store_options options = {.existing = BAD[b].existing};
        assert_true(store_open(&store, BAD[b].path, &options, &err) < 0);
        if (!strstr(err.text, BAD[b].text))
            print_error("%s\n", err.text);
        assert_non_null(strstr(err.text, BAD[b].text));
        assert_null(store);
    }
}

static void leases_of_another_boot_are_void(void **state) {
    (void)state;
    struct store *store = open_store("boot.db");
    char id[STUDY_ID_SIZE];
    struct claimed_job job;
    submit(store, 5, NULL, id);
    clock_ms = 1000000;
    assert_int_equal(claim(store, "before", &job), 1);
    int64_t first = job.id;
    claimed_job_clear(&job);
    store_close(&store);
    sql_change("boot.db", "UPDATE boot SET id = 'another'");
    store = open_store("boot.db");
    clock_ms = 10; /* the boot clock began anew */
    assert_int_equal(claim(store, "after", &job), 1);
    assert_true(job.id != first);
    claimed_job_clear(&job);
    clock_ms = 1010; /* the lost one waits a second */
    assert_int_equal(claim(store, "after", &job), 1);
    assert_int_equal(job.id, first);
    assert_int_equal(job.attempt, 1);
    claimed_job_clear(&job);
    store_close(&store);
}

static int64_t file_size(const char *path) {
    struct stat file;
    return stat(path, &file) == 0 ? (int64_t)file.st_size : 0;
}

/* A probe reaches the disk, each time, and the boot stays known. */
static void a_probe_writes(void **state) {
    (void)state;
    struct store *store = open_store("probe.db");
    for (int probe = 0; probe < 3; probe++) {
        int64_t before = file_size("probe.db-wal");
        assert_int_equal(store_probe(store, NULL), 0);
        assert_true(file_size("probe.db-wal") > before);
    }
    assert_int_equal(sql_integer("probe.db", "SELECT count(*) FROM boot WHERE id <> ''"), 1);
    store_close(&store);
}

/* Two processes take all jobs of one file between them, none twice, with no busy error. */
static void processes_share_a_file(void **state) {
    (void)state;
    struct store *store = open_store("shared.db");
    char id[STUDY_ID_SIZE];
    clock_ms = 0;
    submit(store, 1000, NULL, id);
    store_close(&store);
    pid_t children[2];
    for (int c = 0; c < 2; c++) {
        children[c] = fork();
        assert_true(children[c] >= 0);
        if (children[c])
            continue;
        struct store *own = NULL;
        struct store_options options = {.lease_ms = 1000, .now_ms = test_clock};
        int status = store_open(&own, "shared.db", &options, NULL);
        struct claim what = {.worker = c ? "one" : "two", .host = "here", .count = 1};
        struct claimed_job job;
        size_t count = 1;
        bool first, done;
        while (!status && !(status = store_claim(own, &what, &job, &count, NULL)) && count) {
            status = complete(own, &job, &first, &done, NULL);
            status = status ? status : !first;
            claimed_job_clear(&job);
        }
        store_close(&own);
        _exit(status ? 1 : 0);
    }
    for (int c = 0; c < 2; c++) {
        int status;
        assert_int_equal(waitpid(children[c], &status, 0), children[c]);
        assert_int_equal(status, 0);
    }
    check_text("shared.db",
               "SELECT sum(count) || '/' || sum(attempts - 1) || '/' || (SELECT state FROM "
               "study_progress) FROM job_log WHERE state = 'done'",
               "2000/0/running");
}

/* Cases of a study that shares random numbers are of sequence 0, others of their own number,
 * whoever asks: a claim, or the check of a result. A worker of a program that draws by the case
 * alone gets no job of the former. */
static void jobs_tell_their_sequence(void **state) {
    (void)state;
    static const char *const RANDOM[] = {"common", "independent"};
    struct store *store = open_store("sequence.db");
    for (uint64_t n = 0; n < 2; n++) {
        char text[200], id[STUDY_ID_SIZE];
        snprintf(text, sizeof text,
                 "{\"name\":\"n\",\"kind\":\"boxes\",\"realisations\":10,\"seconds\":0.5,"
                 "\"random\":\"%s\",\"box\":{\"width\":[0.5,1]}}",
                 RANDOM[n]);
        struct study *study = read_study(text);
        struct study_status now = {0};
        assert_int_equal(store_submit(store, study, NULL, id, NULL, NULL), 0);
        assert_int_equal(store_status(store, id, &now, NULL), 0);
        assert_int_equal(now.random, study->random);
        study_status_clear(&now);
        study_destroy(&study);
    }
    for (uint64_t n = 0; n < 4; n++) {
        /* the last two jobs of the store first */
        const struct claim asked = {
            .worker = "w", .host = "here", .count = 1, .independent_only = n < 2};
        struct claimed_job job = {0}, same = {0};
        size_t count = 0;
        assert_int_equal(store_claim(store, &asked, &job, &count, NULL), 0);
        assert_int_equal(count, 1);
        assert_int_equal(job.case_number, n % 2);
        assert_int_equal(job.sequence, n < 2 ? n : 0);
        assert_int_equal(store_job(store, job.id, job.token, &same, NULL), 0);
        assert_int_equal(same.sequence, job.sequence);
        claimed_job_clear(&job);
        claimed_job_clear(&same);
        if (n == 1) {
            assert_int_equal(store_claim(store, &asked, &job, &count, NULL), 0);
            assert_int_equal(count, 0); /* what waits is not for this worker */
        }
    }
    check_text("sequence.db", "SELECT group_concat(random) FROM study_progress",
               "common,independent");
    store_close(&store);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(jobs_tell_their_sequence),
        cmocka_unit_test(a_study_runs_to_its_end),
        cmocka_unit_test(parts_of_realisations_count),
        cmocka_unit_test(leases_run_out_and_fence),
        cmocka_unit_test(three_attempts_then_failed_with_its_reason),
        cmocka_unit_test(a_deadly_job_fails),
        cmocka_unit_test(cancelled_studies_stop_their_jobs),
        cmocka_unit_test(a_key_gives_the_same_study),
        cmocka_unit_test(group_commit_keeps_its_members_apart),
        cmocka_unit_test(results_and_views),
        cmocka_unit_test(a_group_is_published_as_one),
        cmocka_unit_test(other_files_are_refused_with_a_word),
        cmocka_unit_test(leases_of_another_boot_are_void),
        cmocka_unit_test(a_probe_writes),
        cmocka_unit_test(processes_share_a_file),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
