/* Protects: a study given more realisations queues what it lacks and nothing else, whatever state
 * its jobs are in; and a study takes the blocks of another only where both are the same, of the
 * same form of results, and it asks for more. */
#include "schema/store/store.h"
#include "schema/study/study_reader.h"
#include "tests/support/check.h"
#include "tests/support/fake_kind.h"
#include "tests/support/store_text.h"
#include <sqlite3.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static struct store *open_store(const char *path) {
    struct store *store = NULL;
    assert_int_equal(store_open(&store, path, NULL, NULL), 0);
    return store;
}

/* Submits a study of two cases in blocks of ten: width is the second case's. Returns the status. */
static int try_submit(struct store *store, int realisations, const char *width, uint64_t edition,
                      const char *key, char id[STUDY_ID_SIZE], bool *existing) {
    char text[240];
    struct study *study = NULL;
    struct fault_list faults = {0};
    snprintf(text, sizeof text,
             "{\"name\":\"boxes\",\"kind\":\"boxes\",\"realisations\":%d,\"seconds\":0.5,\"box\":{"
             "\"width\":[0.5,%s]}}",
             realisations, width);
    assert_int_equal(study_read(&study, text, strlen(text), NULL, FAKE_KINDS, 0, &faults, NULL), 0);
    study->edition = edition;
    int status = store_submit(store, study, key, id, existing, NULL);
    study_destroy(&study);
    return status;
}

static void submit(struct store *store, int realisations, const char *width, uint64_t edition,
                   const char *key, char id[STUDY_ID_SIZE], bool *existing) {
    assert_int_equal(try_submit(store, realisations, width, edition, key, id, existing), 0);
}

/* Does `count` jobs of a study, or fails them for good. */
static void work(struct store *store, const char *id, int count, bool fails) {
    static const char *const NAMES[] = {"a"};
    const struct claim claim = {.worker = "w", .host = "h", .study = id, .count = 1};
    for (int j = 0; j < count; j++) {
        struct claimed_job job = {0};
        size_t claimed = 0;
        bool first, done;
        double scalars[64] = {0};
        assert_int_equal(store_claim(store, &claim, &job, &claimed, NULL), 0);
        assert_int_equal(claimed, 1);
        const struct block_result result = {.first = job.first,
                                            .count = job.count,
                                            .scalar_count = 1,
                                            .names = NAMES,
                                            .scalars = scalars,
                                            .data = (const unsigned char *)"block",
                                            .size = 5,
                                            .seconds = 3,
                                            .cpu_seconds = 5};
        assert_int_equal(
            fails ? store_fail(store, job.id, job.token, "no luck", true, NULL)
                  : store_complete(store, job.id, job.token, &result, &first, &done, NULL),
            0);
        claimed_job_clear(&job);
    }
}

/* Every count of the study is that of its jobs, and each case has each realisation in one job. */
static void check_counts(const char *path, int realisations) {
    char sql[400];
    check_text(
        path,
        "SELECT count(*) FROM study s WHERE (s.jobs, s.jobs_done, s.jobs_waiting, "
        "s.jobs_failed, s.realisations_done, s.seconds, s.cpu_seconds) IS NOT (SELECT "
        "sum(blocks), total(state = 'done'), total(blocks * (state = 'waiting')), total(state "
        "= 'failed'), total(count * (state = 'done')), total(seconds), total(cpu_seconds) "
        "FROM job j WHERE j.study_id = s.id)",
        "0");
    check_text(path,
               "SELECT count(*) FROM study_case c WHERE (c.jobs, c.jobs_left, "
               "c.realisations_done, c.revision) IS NOT (SELECT sum(blocks), total(blocks * (state "
               "= 'waiting')), total(count * (state = 'done')), total(state = 'done') FROM job j "
               "WHERE j.study_id = c.study_id AND j.case_number = c.number)",
               "0");
    snprintf(sql, sizeof sql,
             "SELECT count(*) FROM (SELECT sum(count) AS n, max(first + count) AS last FROM job "
             "GROUP BY study_id, case_number HAVING study_id = (SELECT max(id) FROM study)) WHERE "
             "n <> %d OR last <> %d",
             realisations, realisations);
    check_text(path, sql, "0");
}

static void check_status(struct store *store, const char *id, const char *state, uint64_t waiting,
                         uint64_t done) {
    struct study_status now = {0};
    assert_int_equal(store_status(store, id, &now, NULL), 0);
    assert_string_equal(now.state, state);
    assert_int_equal(now.jobs_waiting, waiting);
    assert_int_equal(now.realisations_done, done);
    study_status_clear(&now);
}

static void what_is_missing_is_queued(void **state) {
    (void)state;
    struct store *store = open_store("missing.db");
    char id[STUDY_ID_SIZE];
    uint64_t jobs = 99;
    struct error err = {0};
    submit(store, 14, "1", 7, NULL, id, NULL); /* 7 and 7, in both cases */
    work(store, id, 2, false);
    work(store, id, 1, true);
    check_status(store, id, "running", 1, 14);
    assert_int_equal(store_extend(store, id, 14, 7, &jobs, NULL), 0);
    assert_int_equal(jobs, 0);
    assert_int_equal(store_extend(store, id, 13, 7, &jobs, &err), ERROR_STATE);
    assert_int_equal(store_extend(store, id, 60, 8, &jobs, &err), ERROR_STATE);
    assert_non_null(strstr(err.text, "is of another version of the program"));
    assert_int_equal(store_extend(store, id, STUDY_REALISATIONS_MOST + 1, 7, &jobs, &err),
                     ERROR_INPUT);
    /* seven took 5 s, so that 26 are four jobs; of the other case three, as estimated; and the
     * failed one waits again */
    assert_int_equal(store_extend(store, id, 40, 7, &jobs, NULL), 0);
    assert_int_equal(jobs, 8);
    check_counts("missing.db", 40);
    struct study_status now = {0};
    assert_int_equal(store_status(store, id, &now, NULL), 0);
    assert_string_equal(now.state, "queued"); /* nothing of it runs just now */
    assert_int_equal(now.realisations_total, 80);
    assert_string_equal(now.finished, "");
    for (int left = (int)now.jobs_waiting; left > 0; left = (int)now.jobs_waiting) {
        study_status_clear(&now);
        work(store, id, 1, false);
        assert_int_equal(store_status(store, id, &now, NULL), 0);
    }
    study_status_clear(&now);
    check_status(store, id, "running", 0, 80); /* until its cases are published */
    check_counts("missing.db", 40);
    /* results without a form may be of any program */
    sqlite3 *db = NULL;
    assert_int_equal(sqlite3_open("missing.db", &db), SQLITE_OK);
    assert_int_equal(
        sqlite3_exec(db, "UPDATE study SET edition = NULL, program = 'older'", NULL, NULL, NULL),
        SQLITE_OK);
    sqlite3_close(db);
    assert_int_equal(store_extend(store, id, 60, 7, &jobs, &err), ERROR_STATE);
    store_close(&store);
}

/* The same document under the same key is still that study, also in its longer form; one that asks
 * for another number is not, even for that which the study has by now. */
static void a_key_knows_an_extended_study(void **state) {
    (void)state;
    struct store *store = open_store("key.db");
    char id[STUDY_ID_SIZE], again[STUDY_ID_SIZE];
    bool existing = false;
    uint64_t jobs;
    submit(store, 10, "1", 7, "k", id, &existing);
    assert_false(existing);
    assert_int_equal(try_submit(store, 25, "1", 7, "k", again, &existing), ERROR_STATE);
    assert_int_equal(store_extend(store, id, 25, 7, &jobs, NULL), 0);
    submit(store, 10, "1", 7, "k", again, &existing);
    assert_true(existing);
    assert_string_equal(again, id);
    assert_int_equal(try_submit(store, 25, "1", 7, "k", again, &existing), ERROR_STATE);
    assert_int_equal(try_submit(store, 40, "1", 7, "k", again, &existing), ERROR_STATE);
    check_text("key.db", "SELECT json_extract(source, '$.realisations') FROM study_source", "25");
    store_close(&store);
}

static void blocks_are_taken_from_the_same_study_alone(void **state) {
    (void)state;
    struct store *store = open_store("taken.db");
    char id[STUDY_ID_SIZE];
    submit(store, 20, "1", 7, NULL, id, NULL);
    work(store, id, 3, false);
    static const struct {
        int realisations;
        const char *width;
        uint64_t edition, taken;
    } OTHERS[] = {{20, "1", 7, 0},   /* no more of them: a study to compare with */
                  {10, "1", 7, 0},   /* fewer */
                  {30, "0.9", 7, 0}, /* another case */
                  {30, "1", 8, 0},   /* another form of results */
                  {30, "1", 0, 0},   /* of none */
                  {30, "1.0", 7, 30}};
    for (size_t o = 0; o < sizeof OTHERS / sizeof *OTHERS; o++) {
        submit(store, OTHERS[o].realisations, OTHERS[o].width, OTHERS[o].edition, NULL, id, NULL);
        struct study_status now = {0};
        assert_int_equal(store_status(store, id, &now, NULL), 0);
        assert_string_equal(now.state, "queued");
        assert_int_equal(now.realisations_done, OTHERS[o].taken);
        study_status_clear(&now);
    }
    check_counts("taken.db", 30);
    check_text("taken.db",
               "SELECT count(*) || ' ' || count(DISTINCT r.data) FROM result r JOIN job j ON j.id "
               "= r.job_id WHERE j.study_id = (SELECT max(id) FROM study)",
               "3 1");
    /* its gaps: of the second case 10 to 30, of the first 20 to 30, a span each */
    check_text(
        "taken.db",
        "SELECT group_concat(case_number || ':' || first || '+' || count, ' ') FROM (SELECT "
        "* FROM job WHERE state = 'waiting' AND study_id = (SELECT max(id) FROM study) ORDER "
        "BY case_number, first)",
        "0:20+10 1:10+20");
    /* the worker did three jobs, of which two studies have the blocks */
    struct worker_activity *workers = NULL;
    size_t count = 0;
    assert_int_equal(store_workers(store, &workers, &count, NULL), 0);
    assert_int_equal(count, 1);
    assert_int_equal(workers[0].recent_jobs, 3);
    workers_free(workers, count);
    store_close(&store);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_is_missing_is_queued),
        cmocka_unit_test(a_key_knows_an_extended_study),
        cmocka_unit_test(blocks_are_taken_from_the_same_study_alone),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
