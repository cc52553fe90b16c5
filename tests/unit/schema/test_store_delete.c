/* Protects: a study that is deleted is gone at once for whoever asks, its space is given back bit
 * by bit, also by another process than began, and studies beside it keep all they have. */
#include "schema/store/store.h"
#include "schema/study/study_reader.h"
#include "tests/support/check.h"
#include "tests/support/fake_kind.h"
#include "tests/support/sample_result.h"
#include "tests/support/seed.h"
#include "tests/support/store_text.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

enum { BLOCK_BYTES = 400000 };

static struct store *open_store(const char *path) {
    struct store *store = NULL;
    assert_int_equal(store_open(&store, path, NULL, NULL), 0);
    return store;
}

static void submit(struct store *store, const char *key, char id[STUDY_ID_SIZE]) {
    static const char TEXT[] =
        "{\"name\":\"n\",\"kind\":\"boxes\",\"realisations\":20,\"seconds\":0.5,\"box\":{\"width\":"
        "[0.5,1]}}";
    struct study *study = NULL;
    struct fault_list faults = {0};
    assert_int_equal(study_read(&study, TEXT, strlen(TEXT), NULL, FAKE_KINDS, 0, &faults, NULL), 0);
    assert_int_equal(store_submit(store, study, key, id, NULL, NULL), 0);
    study_destroy(&study);
}

static void claim(struct store *store, const char *id, struct claimed_job *job) {
    const struct claim asked = {.worker = "w", .host = "h", .study = id, .count = 1};
    size_t claimed = 0;
    assert_int_equal(store_claim(store, &asked, job, &claimed, NULL), 0);
    assert_int_equal(claimed, 1);
}

static int publish_sample(void *context, struct store *store, const struct due_case *due,
                          size_t number, struct error *err) {
    (void)number;
    struct case_result result = {0};
    (void)context;
    sample_result(&result);
    int status = store_publish(store, due->study, due->case_number, due->revision, &result, err);
    result_clear(&result);
    return status;
}

/* A study that is done, of four blocks. */
static void run(struct store *store, const char *key, char id[STUDY_ID_SIZE]) {
    static const char *const NAMES[] = {"a"};
    const struct publication publication = {.publish = publish_sample};
    struct publish_counts counts;
    unsigned char *data = malloc(BLOCK_BYTES);
    uint64_t random = 1;
    assert_non_null(data);
    for (size_t a = 0; a < BLOCK_BYTES; a++) /* which is not packed */
        data[a] = (unsigned char)next_word(&random);
    submit(store, key, id);
    for (int j = 0; j < 4; j++) {
        struct claimed_job job = {0};
        bool first, done;
        double scalars[10] = {0};
        claim(store, id, &job);
        const struct block_result block = {.first = job.first,
                                           .count = job.count,
                                           .scalar_count = 1,
                                           .names = NAMES,
                                           .scalars = scalars,
                                           .data = data,
                                           .size = BLOCK_BYTES};
        assert_int_equal(store_complete(store, job.id, job.token, &block, &first, &done, NULL), 0);
        claimed_job_clear(&job);
    }
    free(data);
    assert_int_equal(store_publish_due(store, &publication, &counts, NULL), 0);
    assert_int_equal(counts.published, 2);
}

static long size_of(const char *path) {
    struct stat info;
    assert_int_equal(stat(path, &info), 0);
    return (long)info.st_size;
}

/* No row of any table is of a study that is not there. */
static void check_nothing_left(const char *path) {
    check_text(path,
               "SELECT (SELECT count(*) FROM job WHERE study_id NOT IN (SELECT id FROM study)) + "
               "(SELECT count(*) FROM study_case WHERE study_id NOT IN (SELECT id FROM study)) + "
               "(SELECT count(*) FROM curve WHERE study_id NOT IN (SELECT id FROM study)) + "
               "(SELECT count(*) FROM published WHERE study_id NOT IN (SELECT id FROM study)) + "
               "(SELECT count(*) FROM result WHERE job_id NOT IN (SELECT id FROM job)) + "
               "(SELECT count(*) FROM point WHERE curve_id NOT IN (SELECT id FROM curve))",
               "0");
}

static void a_study_goes_with_its_space(void **state) {
    (void)state;
    struct store *store = open_store("space.db");
    char kept[STUDY_ID_SIZE], gone[STUDY_ID_SIZE], again[STUDY_ID_SIZE];
    struct study_status now = {0};
    struct error err = {0};
    submit(store, "key", kept);
    assert_int_equal(store_delete(store, kept, &err), ERROR_STATE);
    assert_non_null(strstr(err.text, "has not ended: cancel it first"));
    assert_int_equal(store_cancel(store, kept, NULL), 0);
    assert_int_equal(store_delete(store, kept, NULL), 0);
    assert_int_equal(store_purge(store, NULL, NULL, NULL), 0);
    run(store, "key", kept); /* the key is free again */
    store_close(&store);
    long small = size_of("space.db");
    char *before = read_text("space.db", "SELECT count(*) || ' ' || sum(y) FROM curve_points");

    store = open_store("space.db");
    run(store, NULL, gone);
    assert_int_equal(store_delete(store, gone, NULL), 0);
    assert_int_equal(store_status(store, gone, &now, NULL), ERROR_ABSENT);
    assert_int_equal(store_find(store, gone, again, NULL, NULL), ERROR_ABSENT);
    assert_int_equal(store_delete(store, gone, NULL), ERROR_ABSENT);
    struct study_status *list = NULL;
    size_t count = 0;
    assert_int_equal(store_list(store, "", 9, &list, &count, NULL), 0);
    assert_int_equal(count, 1);
    assert_string_equal(list[0].id, kept);
    study_status_clear(&list[0]);
    free(list);
    /* a list of which this study was the last goes on behind it */
    assert_int_equal(store_list(store, gone, 9, &list, &count, NULL), 0);
    assert_int_equal(count, 0);
    free(list);
    struct store_metrics metrics = {0};
    assert_int_equal(store_metrics(store, &metrics, NULL), 0);
    assert_int_equal(metrics.studies, 1);
    assert_int_equal(metrics.jobs_done, 4);
    store_close(&store); /* nothing was purged yet: another process does it */

    assert_true(size_of("space.db") > small + 3 * BLOCK_BYTES);
    store = open_store("space.db");
    assert_int_equal(store_purge(store, NULL, NULL, NULL), 0);
    assert_int_equal(store_status(store, kept, &now, NULL), 0);
    assert_string_equal(now.state, "done");
    study_status_clear(&now);
    store_close(&store);
    assert_in_range(size_of("space.db"), 1, small + 8 * 4096); /* pages of what was deleted when */
    check_nothing_left("space.db");
    check_text("space.db", "SELECT count(*) FROM study_progress", "1");
    char *after = read_text("space.db", "SELECT count(*) || ' ' || sum(y) FROM curve_points");
    assert_string_equal(after, before);
    free(before);
    free(after);
}

static bool stop_after(void *context) {
    int *calls = context;
    return (*calls)-- == 0;
}

/* Stopped anywhere, it goes on where it was. */
static void a_purge_may_be_stopped(void **state) {
    (void)state;
    struct store *store = open_store("stopped.db");
    char id[STUDY_ID_SIZE];
    int steps = 0, status = ERROR_STOPPED;
    run(store, NULL, id);
    assert_int_equal(store_delete(store, id, NULL), 0);
    for (; status == ERROR_STOPPED; steps++) {
        int calls = 1;
        status = store_purge(store, stop_after, &calls, NULL);
        store_close(&store);
        store = open_store("stopped.db");
    }
    assert_int_equal(status, 0);
    assert_true(steps > 4);
    check_nothing_left("stopped.db");
    check_text("stopped.db", "SELECT count(*) FROM study", "0");
    store_close(&store);
}

/* A store whose file gives no single pages back is written anew once, and does from there on. */
static void an_older_file_learns_to_shrink(void **state) {
    (void)state;
    struct store *store = open_store("older.db");
    char id[STUDY_ID_SIZE];
    run(store, NULL, id);
    store_close(&store);
    sqlite3 *db = NULL;
    assert_int_equal(sqlite3_open("older.db", &db), SQLITE_OK);
    assert_int_equal(sqlite3_exec(db,
                                  "PRAGMA journal_mode = DELETE; PRAGMA auto_vacuum = NONE; "
                                  "VACUUM",
                                  NULL, NULL, NULL),
                     SQLITE_OK);
    sqlite3_close(db);
    check_text("older.db", "PRAGMA auto_vacuum", "0");
    store = open_store("older.db");
    assert_int_equal(store_delete(store, id, NULL), 0);
    assert_int_equal(store_purge(store, NULL, NULL, NULL), 0);
    store_close(&store);
    check_text("older.db", "PRAGMA auto_vacuum", "2");
    assert_true(size_of("older.db") < BLOCK_BYTES);
}

/* The job of a study that was cancelled and deleted under a worker: its lease is lost. */
static void a_worker_of_a_deleted_study_is_told(void **state) {
    (void)state;
    struct store *store = open_store("worker.db");
    char id[STUDY_ID_SIZE];
    struct claimed_job job = {0};
    submit(store, NULL, id);
    claim(store, id, &job);
    assert_int_equal(store_cancel(store, id, NULL), 0);
    assert_int_equal(store_delete(store, id, NULL), 0);
    assert_int_equal(store_heartbeat(store, job.id, job.token, 1, NULL), ERROR_STATE);
    assert_int_equal(store_purge(store, NULL, NULL, NULL), 0);
    assert_int_equal(store_heartbeat(store, job.id, job.token, 1, NULL), ERROR_ABSENT);
    claimed_job_clear(&job);
    store_close(&store);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_study_goes_with_its_space),
        cmocka_unit_test(a_purge_may_be_stopped),
        cmocka_unit_test(an_older_file_learns_to_shrink),
        cmocka_unit_test(a_worker_of_a_deleted_study_is_told),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
