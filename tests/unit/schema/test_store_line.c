/* Protects: owners take turns at the workers by the time that their jobs take and by their weights,
 * whoever came first and however long a study is; of an owner the study of higher priority is
 * first; and a study that waits has its position and an estimate of when it starts, which is that
 * of the definition however the queue is read. */
#include "schema/store/store.h"
#include "schema/study/study_reader.h"
#include "tests/support/check.h"
#include "tests/support/fake_kind.h"
#include "tests/support/seed.h"
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

/* Claims the next job, which is then done, or left running: its study is `id`. False where nothing
 * waits. */
static bool claim_next(struct store *store, bool ends, char id[STUDY_ID_SIZE]) {
    static const char *const NAMES[] = {"a"};
    const struct claim claim = {.worker = "w", .host = "h", .count = 1};
    struct claimed_job job = {0};
    size_t claimed = 0;
    bool first, done;
    assert_int_equal(store_claim(store, &claim, &job, &claimed, NULL), 0);
    if (claimed == 0)
        return false;
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
    return true;
}

static void next(struct store *store, bool ends, char id[STUDY_ID_SIZE]) {
    assert_true(claim_next(store, ends, id));
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

/* What defines the position of a study and when it starts, as one query: ?1 is its id, ?2 now. Its
 * position; the seconds of jobs that begin before it; the number of jobs that run; and the seconds
 * until the first of them ends, and of all. */
static const char DEFINITION[] =
    "WITH turn AS (SELECT owner, weight, begun, max(served, (SELECT max(begun) FROM share)) AS "
    "start FROM share), waiting AS (SELECT id, public, owner, priority, state, CASE WHEN "
    "realisations_done > 0 THEN seconds / realisations_done * realisations_waiting ELSE work / "
    "jobs * jobs_waiting END AS left FROM study WHERE state IN ('queued', 'running') AND "
    "jobs_waiting > 0), line AS (SELECT w.id, w.public, w.owner, w.state, w.left, t.begun, "
    "t.start, t.weight, t.start + total(w.left) OVER (PARTITION BY w.owner ORDER BY w.priority "
    "DESC, w.id ROWS BETWEEN UNBOUNDED PRECEDING AND 1 PRECEDING) / t.weight AS begins FROM "
    "waiting w JOIN turn t ON t.owner = w.owner), mine AS (SELECT begins, begun, id, state FROM "
    "line WHERE public = ?1), running AS (SELECT count(*) AS n, min(rest) AS soonest, total(rest) "
    "AS rests FROM (SELECT max(0, j.count * CASE WHEN c.realisations_done > 0 THEN c.seconds / "
    "c.realisations_done ELSE c.estimate END - (?2 - coalesce(j.claimed_ms, ?2)) / 1000.0) AS "
    "rest FROM job j JOIN study_case c ON c.study_id = j.study_id AND c.number = j.case_number "
    "WHERE j.state = 'running')) SELECT iif(m.state = 'queued', 1 + (SELECT count(*) FROM line l "
    "WHERE (l.begins, l.begun, l.id) < (m.begins, m.begun, m.id) AND l.state = 'queued'), 0), "
    "(SELECT total(max(0, min(m.begins - o.start, o.lefts / o.weight)) * o.weight) FROM (SELECT "
    "start, weight, sum(left) AS lefts FROM line GROUP BY owner) o), r.n, r.soonest, r.rests FROM "
    "mine m, running r";

static void define(const char *path, const char *id, uint64_t *place, double *starts_in) {
    sqlite3 *db = sql_open(path);
    sqlite3_stmt *row = NULL;
    *place = 0;
    *starts_in = NAN;
    assert_int_equal(sqlite3_prepare_v2(db, DEFINITION, -1, &row, NULL), SQLITE_OK);
    sqlite3_bind_text(row, 1, id, -1, SQLITE_STATIC);
    sqlite3_bind_int64(row, 2, clock_ms);
    if (sqlite3_step(row) == SQLITE_ROW) {
        double before = sqlite3_column_double(row, 1), workers = sqlite3_column_double(row, 2);
        double soonest = sqlite3_column_double(row, 3), rests = sqlite3_column_double(row, 4);
        *place = (uint64_t)sqlite3_column_int64(row, 0);
        if (workers > 0)
            *starts_in = before > 0 ? fmax(soonest, (rests + before) / workers) : soonest;
    }
    sqlite3_finalize(row);
    sqlite3_close(db);
}

/* Compares a list with the definition, and each study that waits alone; returns how many are
 * queued. */
static int compare_with_definition(struct store *store, const char *path) {
    struct study_status *list = NULL;
    size_t count = 0;
    int queued = 0;
    assert_int_equal(store_list(store, "", 100, &list, &count, NULL), 0);
    for (size_t n = 0; n < count; n++) {
        uint64_t place = 0;
        double starts_in = NAN;
        bool waits = list[n].jobs_waiting > 0 && list[n].jobs_running == 0;
        if (waits) {
            define(path, list[n].id, &place, &starts_in);
            check_place(store, list[n].id, place, starts_in);
        }
        assert_int_equal(list[n].place, place);
        assert_true(isnan(starts_in) ? isnan(list[n].starts_in)
                                     : fabs(list[n].starts_in - starts_in) <= 1e-9);
        queued += place > 0;
        study_status_clear(&list[n]);
    }
    free(list);
    return queued;
}

static void submit_drawn(struct store *store, const char *owner, char id[STUDY_ID_SIZE]) {
    static const double SECONDS[] = {1, 5, 10};
    int priority = (int)(lrand48() % 3) - 1, jobs = 1 + (int)(lrand48() % 5);
    submit(store, owner, priority, jobs, SECONDS[lrand48() % 3], id);
}

/* Random studies of several owners, with weights and priorities, of which jobs are claimed, done
 * and cancelled meanwhile. The line is read by a handle that changes nothing, too. Weights are
 * powers of two and times whole, so that studies tie. */
static void places_are_those_of_the_definition(void **state) {
    (void)state;
    static const char *const OWNERS[] = {"", "anna", "bert", "carl", "dora"};
    static const char PATH[] = "random.db";
    static const char WAITING[] =
        "SELECT total(jobs_waiting) FROM study WHERE state IN ('queued', 'running')";
    char ids[100][STUDY_ID_SIZE], got[STUDY_ID_SIZE];
    int count = 0, compared = 0;
    struct store *store = open_store(PATH), *reader = open_store(PATH);
    srand48((long)seed_of_now());
    for (int o = 0; o < 5; o++)
        assert_int_equal(store_share(store, OWNERS[o], ldexp(1, o % 4 - 1), NULL), 0);
    for (int step = 0; step < 150; step++) {
        long what = lrand48() % 8;
        if ((what < 5 || count < 3) && count < 100)
            submit_drawn(store, OWNERS[lrand48() % 5], ids[count++]);
        else if (what < 7) {
            int64_t waiting = sql_integer(PATH, WAITING);
            assert_int_equal(claim_next(store, what == 5, got), waiting > 0);
        } else
            (void)store_cancel(store, ids[lrand48() % count], NULL);
        clock_ms += lrand48() % 300;
        if (step % 10 == 9) {
            compared += compare_with_definition(store, PATH);
            compared += compare_with_definition(reader, PATH);
        }
    }
    assert_true(compared > 100);
    store_close(&reader);
    store_close(&store);
}

/* A position within a change that is undone is not remembered. */
static void an_undone_change_leaves_places(void **state) {
    (void)state;
    struct store *store = open_store("undone.db");
    char first[STUDY_ID_SIZE], second[STUDY_ID_SIZE];
    submit(store, "anna", 0, 2, 0.5, first);
    submit(store, "anna", 0, 2, 0.5, second);
    assert_int_equal(store_begin(store, NULL), 0);
    assert_int_equal(store_cancel(store, first, NULL), 0);
    check_place(store, second, 1, NAN);
    store_abandon(store);
    check_place(store, second, 2, NAN);
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
        cmocka_unit_test(places_are_those_of_the_definition),
        cmocka_unit_test(an_undone_change_leaves_places),
        cmocka_unit_test(a_claim_may_name_kinds),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
