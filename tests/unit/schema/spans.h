/* Studies of many realisations in a store, claimed and handed in, for the tests of spans. */
#ifndef RUGO_TESTS_UNIT_SCHEMA_SPANS_H
#define RUGO_TESTS_UNIT_SCHEMA_SPANS_H

#include "schema/store/store.h"
#include "tests/support/check.h"
#include "tests/support/fake_kind.h"
#include "tests/support/store_text.h"
#include <sqlite3.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { CASES = 3, LEASE_MS = 1000 };

static int64_t clock_ms;
static inline int64_t test_clock(void *context) {
    (void)context;
    return clock_ms;
}

static inline struct store *open_store(const char *path) {
    struct store *store = NULL;
    const struct store_options options = {.lease_ms = LEASE_MS, .now_ms = test_clock};
    clock_ms = 1000000;
    assert_int_equal(store_open(&store, path, &options, NULL), 0);
    return store;
}

/* A study of cases of so many realisations, which are thought to take `seconds` each. */
static inline void submit(struct store *store, size_t cases, uint64_t realisations, double seconds,
                          char id[STUDY_ID_SIZE]) {
    struct study_case all[CASES] = {{0}};
    struct study study = {.name = "spans",
                          .kind = FAKE_KINDS[0],
                          .seed = 1,
                          .realisations = realisations,
                          .case_count = cases,
                          .cases = all,
                          .source = "{}"};
    for (size_t c = 0; c < cases; c++)
        all[c] = (struct study_case){.parameters = cJSON_CreateObject(),
                                     .block = 1000,
                                     .cost.seconds = seconds,
                                     .realisations = realisations};
    assert_int_equal(store_submit(store, &study, NULL, id, NULL, NULL), 0);
    for (size_t c = 0; c < cases; c++)
        cJSON_Delete(all[c].parameters);
}

static inline size_t claim(struct store *store, const struct claim *claim,
                           struct claimed_job *jobs) {
    size_t count = 0;
    struct error err = {0};
    if (store_claim(store, claim, jobs, &count, &err) != 0)
        fail_msg("%s", err.text);
    return count;
}

/* Claims as this worker: realisations of the one job; 0 for none. */
static inline uint64_t claim_one(struct store *store, const char *worker, struct claimed_job *job) {
    const struct claim one = {.worker = worker, .count = 1};
    return claim(store, &one, job) > 0 ? job->count : 0;
}

/* Hands in the first `count` realisations of a job, which took `seconds` each. */
static inline int complete(struct store *store, const struct claimed_job *job, uint64_t count,
                           double seconds, bool *case_done) {
    static const char *const NAMES[] = {"a"};
    bool first;
    double *scalars = calloc((size_t)count + 1, sizeof *scalars);
    assert_non_null(scalars);
    for (uint64_t r = 0; r < count; r++)
        scalars[r] = (double)(job->first + r);
    const struct block_result result = {.first = job->first,
                                        .count = count,
                                        .scalar_count = 1,
                                        .names = NAMES,
                                        .scalars = scalars,
                                        .data = (const unsigned char *)"data",
                                        .size = 4,
                                        .seconds = seconds * (double)count,
                                        .cpu_seconds = seconds * (double)count};
    int status = store_complete(store, job->id, job->token, &result, &first, case_done, NULL);
    free(scalars);
    return status;
}

/* Every count is that of the rows, and each case has each realisation in one row. */
static inline void check_counts(const char *path, int64_t realisations) {
    char sql[700];
    check_text(path,
               "SELECT count(*) FROM study s WHERE (s.jobs, s.jobs_waiting, s.jobs_running, "
               "s.jobs_done, s.jobs_failed, s.jobs_cancelled, s.realisations_waiting, "
               "s.realisations_done, s.realisations_failed) IS NOT (SELECT total(blocks), "
               "total(blocks * (state = 'waiting')), total(state = 'running'), total(state = "
               "'done'), total(state = 'failed'), total(blocks * (state = 'cancelled')), "
               "total(count * (state = 'waiting')), total(count * (state = 'done')), total(count "
               "* (state = 'failed')) FROM job j WHERE j.study_id = s.id)",
               "0");
    check_text(path,
               "SELECT count(*) FROM study_case c WHERE (c.jobs, c.jobs_left, "
               "c.realisations_done, c.revision) IS NOT (SELECT total(blocks), total(blocks * "
               "(state IN ('waiting', 'running'))), total(count * (state = 'done')), total(state "
               "= 'done') FROM job j WHERE j.study_id = c.study_id AND j.case_number = c.number)",
               "0");
    snprintf(
        sql, sizeof sql,
        "SELECT count(*) FROM (SELECT first, lead(first, 1, %lld) OVER (PARTITION BY study_id, "
        "case_number ORDER BY first) AS next, row_number() OVER (PARTITION BY study_id, "
        "case_number ORDER BY first) AS place, count, blocks FROM job) WHERE first + count <> "
        "next OR count < 1 OR blocks < 1 OR (place = 1 AND first <> 0)",
        (long long)realisations);
    check_text(path, sql, "0");
}

#endif
