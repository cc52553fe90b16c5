/* Protects: that realisations wait as spans, whatever their number, out of which claims cut jobs of
 * the right size for those who ask; that parts of jobs are kept; and that no copy of a store holds
 * the token of a lease. */
#include "tests/unit/schema/spans.h"

/* --- sizes --- */

static void a_span_is_a_row_however_long(void **state) {
    (void)state;
    struct store *store = open_store("long.db");
    char id[STUDY_ID_SIZE];
    struct claimed_job job;
    bool case_done;
    submit(store, CASES, STUDY_REALISATIONS_MOST, 1e-6, id);
    check_text("long.db", "SELECT count(*) || ' ' || sum(blocks) FROM job", "3 30000");
    for (uint64_t j = 0; j < 5; j++) {
        assert_int_equal(claim_one(store, "w", &job), 1000);
        assert_int_equal(job.first, 1000 * j);
        assert_int_equal(job.case_number, 0);
        assert_int_equal(complete(store, &job, 1000, 1e-6, &case_done), 0);
        assert_false(case_done);
        claimed_job_clear(&job);
    }
    check_counts("long.db", STUDY_REALISATIONS_MOST);
    uint64_t jobs = 0;
    assert_int_equal(store_cancel(store, id, NULL), 0);
    assert_int_equal(store_retry(store, id, 0, &jobs, NULL), 0);
    assert_int_equal(jobs, 29995);
    check_counts("long.db", STUDY_REALISATIONS_MOST);
    store_close(&store);
}

/* Blocks take five seconds as measured, once that is known, whatever was estimated. */
static void what_is_measured_counts(void **state) {
    (void)state;
    static const struct {
        double seconds;
        uint64_t next;
    } MEASURED[] = {{0.5, 10}, {0.005, 991}, {1e-4, 991}, {60, 1}};
    for (size_t m = 0; m < sizeof MEASURED / sizeof *MEASURED; m++) {
        struct store *store = open_store(":memory:");
        char id[STUDY_ID_SIZE];
        struct claimed_job job;
        bool case_done;
        submit(store, 1, 10010, 0.05, id); /* in 101 blocks */
        assert_int_equal(claim_one(store, "w", &job), 100);
        assert_int_equal(complete(store, &job, 100, MEASURED[m].seconds, &case_done), 0);
        claimed_job_clear(&job);
        assert_int_equal(claim_one(store, "w", &job), MEASURED[m].next);
        claimed_job_clear(&job);
        store_close(&store);
    }
}

/* One case of 40 s, and eight workers: each gets some at once, and none much more than others. */
static void few_realisations_are_divided(void **state) {
    (void)state;
    enum { WORKERS = 8 };
    struct store *store = open_store("divided.db");
    char id[STUDY_ID_SIZE];
    struct claimed_job job;
    double load[WORKERS] = {0};
    for (int w = 0; w < WORKERS; w++) { /* they wait for jobs */
        char name[] = {'w', (char)('0' + w), 0};
        assert_int_equal(claim_one(store, name, &job), 0);
    }
    submit(store, 1, 400, 0.1, id);
    for (uint64_t left = 400; left > 0;) {
        int w = 0; /* who is free first */
        for (int other = 1; other < WORKERS; other++)
            w = load[other] < load[w] ? other : w;
        char name[] = {'w', (char)('0' + w), 0};
        uint64_t count = claim_one(store, name, &job);
        assert_in_range(count, 1, 50);
        load[w] += 0.1 * (double)count;
        left -= count;
        claimed_job_clear(&job);
    }
    for (int w = 0; w < WORKERS; w++)
        assert_true(load[w] >= 4.5 && load[w] <= 5.5);
    check_counts("divided.db", 400);
    store_close(&store);
}

/* Two pilots of two threads, a study of four seconds; nobody else was seen for minutes. */
static void pilots_have_their_shares(void **state) {
    (void)state;
    struct store *store = open_store("pilots.db");
    char id[STUDY_ID_SIZE];
    struct claimed_job jobs[64];
    struct claim pilots[] = {{.worker = "one", .count = 64, .seconds = 10, .threads = 2},
                             {.worker = "two", .count = 64, .seconds = 10, .threads = 2}};
    assert_int_equal(claim_one(store, "gone", jobs), 0);
    clock_ms += 121000;
    assert_int_equal(claim(store, &pilots[0], jobs), 0);
    assert_int_equal(claim(store, &pilots[1], jobs), 0);
    submit(store, 1, 40, 0.1, id);
    for (int p = 0; p < 2; p++) {
        size_t count = claim(store, &pilots[p], jobs);
        assert_int_equal(count, 2); /* one a thread, though they asked for more */
        for (size_t j = 0; j < count; j++) {
            assert_in_range(jobs[j].count, 4, 10);
            claimed_job_clear(&jobs[j]);
        }
    }
    store_close(&store);
}

/* Where many jobs wait a claim goes on until they take as long as it asks for. */
static void a_claim_fills_its_seconds(void **state) {
    (void)state;
    struct store *store = open_store(":memory:");
    char id[STUDY_ID_SIZE];
    struct claimed_job jobs[64];
    submit(store, 1, STUDY_REALISATIONS_MOST, 1e-3, id); /* a second a job */
    static const struct {
        double seconds;
        size_t count, jobs;
    } CLAIMS[] = {{2.5, 64, 3}, {0.1, 64, 1}, {100, 5, 5}, {0, 7, 7}};
    for (size_t c = 0; c < sizeof CLAIMS / sizeof *CLAIMS; c++) {
        const struct claim asked = {
            .worker = "w", .count = CLAIMS[c].count, .seconds = CLAIMS[c].seconds};
        size_t count = claim(store, &asked, jobs);
        assert_int_equal(count, CLAIMS[c].jobs);
        for (size_t j = 0; j < count; j++)
            claimed_job_clear(&jobs[j]);
    }
    store_close(&store);
}

/* --- parts --- */

static void a_part_is_kept_and_the_rest_waits(void **state) {
    (void)state;
    struct store *store = open_store("part.db");
    char id[STUDY_ID_SIZE];
    struct claimed_job job, rest;
    bool case_done;
    submit(store, 1, 50, 0.1, id);
    assert_int_equal(claim_one(store, "w", &job), 50);
    assert_int_equal(complete(store, &job, 51, 0.1, &case_done), ERROR_INPUT);
    assert_int_equal(complete(store, &job, 0, 0.1, &case_done), ERROR_INPUT);
    assert_int_equal(complete(store, &job, 18, 0.1, &case_done), 0);
    assert_false(case_done);
    assert_int_equal(complete(store, &job, 18, 0.1, &case_done), 0); /* its answer was lost */
    assert_int_equal(complete(store, &job, 50, 0.1, &case_done), ERROR_INPUT);
    check_counts("part.db", 50);
    assert_int_equal(claim_one(store, "w", &rest), 32);
    assert_int_equal(rest.first, 18);
    assert_int_equal(rest.attempt, 1);
    assert_true(rest.id != job.id);
    assert_int_equal(complete(store, &rest, 32, 0.1, &case_done), 0);
    assert_true(case_done);
    claimed_job_clear(&job);
    claimed_job_clear(&rest);
    store_close(&store);
}

/* --- tokens --- */

/* A lease is kept as a digest: neither the store nor a copy of it holds what a worker needs. */
static void no_copy_holds_a_token(void **state) {
    (void)state;
    struct store *store = open_store("tokens.db");
    char id[STUDY_ID_SIZE];
    struct claimed_job job;
    submit(store, 1, 50, 0.1, id);
    assert_int_equal(claim_one(store, "w", &job), 50);
    assert_int_equal(store_snapshot(store, "tokens-copy.db", NULL, NULL, NULL), 0);
    static const char *const PATHS[] = {"tokens.db", "tokens.db-wal", "tokens-copy.db"};
    for (size_t p = 0; p < 3; p++) {
        FILE *file = fopen(PATHS[p], "rb");
        size_t size = 0;
        char *bytes = malloc(1 << 22);
        assert_true(file != NULL && bytes != NULL);
        size = fread(bytes, 1, 1 << 22, file);
        assert_true(size > 0 && size < 1 << 22);
        assert_null(memmem(bytes, size, job.token, strlen(job.token)));
        assert_true(p == 1 || memmem(bytes, size, "study_case", 10) != NULL);
        free(bytes);
        fclose(file);
    }
    check_text("tokens-copy.db",
               "SELECT count(*) FROM job WHERE state = 'running' AND length(token) = 32 AND "
               "typeof(token) = 'blob'",
               "1");
    assert_int_equal(store_heartbeat(store, job.id, job.token, 1, NULL), 0);
    claimed_job_clear(&job);
    store_close(&store);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_span_is_a_row_however_long),
        cmocka_unit_test(what_is_measured_counts),
        cmocka_unit_test(few_realisations_are_divided),
        cmocka_unit_test(pilots_have_their_shares),
        cmocka_unit_test(a_claim_fills_its_seconds),
        cmocka_unit_test(a_part_is_kept_and_the_rest_waits),
        cmocka_unit_test(no_copy_holds_a_token),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
