/* Repair of the faults that store_verify finds, as far as the store has what it takes. */
#include "schema/store/store_seal.h"
#include "schema/store/upkeep/store_verify.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* --- the file --- */

/* With a write-ahead log every connection holds a lock on the file, also an idle one: only the last
 * connection can leave this mode. */
int store_take_alone(struct store *store, struct error *err) {
    sqlite3_busy_timeout(store->db, 0);
    int code = sqlite3_exec(store->db,
                            "PRAGMA journal_mode = DELETE; PRAGMA locking_mode = EXCLUSIVE;"
                            "BEGIN EXCLUSIVE; COMMIT",
                            NULL, NULL, NULL);
    if ((code & 0xff) == SQLITE_BUSY)
        return error_set(
            err, ERROR_STATE,
            "database %s is open in another process, such as a server or a worker: end "
            "that first",
            store->path);
    files_note(store); /* it has no log now */
    return code == SQLITE_OK ? 0 : store_error(store, err);
}

int store_repair_structure(struct store *store, struct error *err) {
    return store_execute(
        store,
        "REINDEX;"
        "DELETE FROM job WHERE study_id NOT IN (SELECT id FROM study);"
        "DELETE FROM result WHERE job_id NOT IN (SELECT id FROM job);"
        "DELETE FROM study_case WHERE study_id NOT IN (SELECT id FROM study);"
        "DELETE FROM study_source WHERE study_id NOT IN (SELECT id FROM study);"
        "DELETE FROM published WHERE study_id NOT IN (SELECT id FROM study);"
        "DELETE FROM scalar WHERE study_id NOT IN (SELECT id FROM study);"
        "DELETE FROM scalar_error WHERE study_id NOT IN (SELECT id FROM study);"
        "DELETE FROM curve WHERE study_id NOT IN (SELECT id FROM study);"
        "DELETE FROM point WHERE curve_id NOT IN (SELECT id FROM curve);"
        "DELETE FROM point_error WHERE curve_id NOT IN (SELECT id FROM curve);"
        "DELETE FROM point_realisations WHERE curve_id NOT IN (SELECT id FROM curve)",
        err);
}

/* --- a case --- */

/* Sets *fits to whether the checksum of a case fits its row. */
static int check_case(struct store *store, int64_t study, int64_t case_number, int64_t *fits,
                      struct error *err) {
    return store_integer(store, fits, err,
                         "SELECT seal = " CASE_SEAL
                         " FROM study_case JOIN study s ON s.id = study_id WHERE s.id = ? AND "
                         "number = ?",
                         "ii", study, case_number);
}

static int put_case_back(struct store *store, int64_t study, int64_t case_number,
                         const struct case_origin *origin, int64_t *fits, struct error *err) {
    char seed[24];
    int64_t same = 0;
    const char *random = choice_name(STUDY_RANDOM, (int)origin->random);
    snprintf(seed, sizeof seed, "%llu", (unsigned long long)origin->seed);
    int status =
        store_integer(store, &same, err,
                      "SELECT parameters = ? AND s.kind = ? AND s.seed = ? AND s.random = "
                      "? FROM study_case JOIN study s ON s.id = study_id WHERE s.id = ? "
                      "AND number = ?",
                      "ttttii", origin->parameters, origin->kind, seed, random, study, case_number);
    if (status == 0 && same != 0)
        status = store_run(store, err,
                           "UPDATE study_case SET seal = NULL WHERE study_id = ? AND number = ?",
                           "ii", study, case_number);
    if (status == 0 && same != 0)
        status = cases_seal(store, study, err);
    if (status == 0)
        status = store_run(store, err,
                           "UPDATE study_case SET parameters = ? WHERE study_id = ? AND number = ?",
                           "tii", origin->parameters, study, case_number);
    if (status == 0)
        status =
            store_run(store, err, "UPDATE study SET kind = ?, seed = ?, random = ? WHERE id = ?",
                      "ttti", origin->kind, seed, random, study);
    return status != 0 ? status : check_case(store, study, case_number, fits, err);
}

int store_repair_case(struct store *store, const char *study, uint64_t case_number,
                      const struct case_origin *origin, bool *repaired, struct error *err) {
    struct error ignored = {0};
    int64_t row = 0, fits = 0;
    int status = change_begin(store, err);
    if (status != 0)
        return status;
    status = study_row(store, study, &row, err);
    if (status == 0)
        status = put_case_back(store, row, (int64_t)case_number, origin, &fits, err);
    *repaired = status == 0 && fits != 0;
    if (status != 0 || fits != 0)
        return change_end(store, status, err);
    (void)change_end(store, ERROR_STATE, &ignored); /* rolls back */
    return 0;
}

/* --- blocks --- */

/* The jobs that are dropped: ?1, and all of case ?3 of study ?2; -1 is no case. */
#define DROPPED "FROM job WHERE id = ?1 OR (study_id = ?2 AND case_number = ?3)"

int store_drop_blocks(struct store *store, const char *study, uint64_t case_number, int64_t job,
                      uint64_t edition, uint64_t *dropped, struct error *err) {
    int64_t row = 0, count = 0;
    bool own = false;
    int status = change_begin(store, err);
    if (status != 0)
        return status;
    status = study_row(store, study, &row, err);
    if (status == 0)
        status = study_is_own(store, row, edition, &own, err);
    const int64_t of_case = job != 0 && own ? -1 : (int64_t)case_number;
    if (status == 0)
        status = store_integer(store, &count, err,
                               "SELECT coalesce(sum(state = 'done' OR id = ?1), 0) " DROPPED, "iii",
                               job, row, of_case);
    if (status == 0)
        status = store_run(store, err, "DELETE " DROPPED, "iii", job, row, of_case);
    status = change_end(store, status, err);
    if (status == 0)
        *dropped += (uint64_t)count;
    return status;
}

int store_drop_published(struct store *store, const char *study, uint64_t case_number,
                         struct error *err) {
    int64_t row = 0;
    int status = change_begin(store, err);
    if (status != 0)
        return status;
    status = study_row(store, study, &row, err);
    if (status == 0)
        status = store_run(store, err,
                           "UPDATE published SET revision = -1 WHERE study_id = ? AND case_number "
                           "= ?",
                           "ii", row, (int64_t)case_number);
    if (status == 0)
        status = store_run(store, err,
                           "UPDATE study_case SET settled = 0 WHERE study_id = ? AND number = ? "
                           "AND publish_error IS NULL",
                           "ii", row, (int64_t)case_number);
    return change_end(store, status, err);
}

/* --- counters --- */

#define ALIVE "NOT IN " DELETED_STUDIES
/* Jobs outside their case, and one of two jobs that overlap: the one that is not done, or the later
 * one. */
#define MISPLACED                                                                                  \
    "SELECT j.id FROM job j LEFT JOIN study_case c ON c.study_id = j.study_id AND c.number = "     \
    "j.case_number JOIN study s ON s.id = j.study_id WHERE s.id " ALIVE                            \
    " AND (c.number IS NULL OR j.first < 0 OR j.count < 1 OR j.first + j.count > "                 \
    "coalesce(c.realisations, s.realisations) OR EXISTS (SELECT 1 FROM job k WHERE k.study_id = "  \
    "j.study_id AND k.case_number = j.case_number AND k.id <> j.id AND k.first < j.first + "       \
    "j.count AND j.first < k.first + k.count AND (k.state = 'done', -k.id) > (j.state = 'done', "  \
    "-j.id)))"

static int drop_misplaced(struct store *store, struct error *err) {
    return store_execute(store, "DELETE FROM job WHERE id IN (" MISPLACED ")", err);
}

/* Realisations of cases that no job has, as study, case, first, count. */
#define GAPS                                                                                       \
    "SELECT study_id, case_number, before, first - before AS lacks FROM (SELECT study_id, "        \
    "case_number, first, lag(first + count, 1, 0) OVER (PARTITION BY study_id, case_number ORDER " \
    "BY first) AS before FROM (SELECT study_id, case_number, first, count FROM job UNION ALL "     \
    "SELECT study_id, number, coalesce(c.realisations, iif(EXISTS (SELECT 1 FROM study_case k "    \
    "WHERE k.study_id = c.study_id AND k.parent = c.number), 0, s.realisations)), 0 FROM "         \
    "study_case c JOIN study s ON s.id = study_id)) WHERE first > before AND study_id " ALIVE

/* Queues one gap; returns 1, or 0 where there is none. */
static int fill_gap(struct store *store, struct error *err) {
    sqlite3_stmt *row = NULL;
    struct queued queued = {0};
    int status = store_query(store, &row, err,
                             "SELECT g.*, " CUT_SECONDS ", block FROM (" GAPS " LIMIT 1) g JOIN "
                             "study_case c ON c.study_id = g.study_id AND number = g.case_number",
                             "");
    if (status == 0)
        status = store_step(store, row, err);
    if (status != 1)
        return status;
    const struct job_row gap = {.study = sqlite3_column_int64(row, 0),
                                .case_number = sqlite3_column_int64(row, 1),
                                .first = sqlite3_column_int64(row, 2),
                                .count = sqlite3_column_int64(row, 3)};
    const struct cut cut = column_cut(row, 4, 5);
    sqlite3_reset(row);
    status = span_insert(store, &gap, &cut, &queued, err);
    return status != 0 ? status : 1;
}

static int fill_gaps(struct store *store, struct error *err) {
    int status = 1;
    while (status == 1)
        status = fill_gap(store, err);
    return status != 0
               ? status
               : store_execute(store,
                               "UPDATE job SET state = 'cancelled' WHERE state = 'waiting' AND "
                               "study_id IN (SELECT id FROM study WHERE state = 'cancelled')",
                               err);
}

/* The counters of studies and cases, in the order in which they are counted: times before the
 * realisations, as they are counted again only where these differ. */
struct counter {
    const char *name, *sum, *states;
    bool of_case, of_study, time;
};
#define DONE "'done'"
#define ANY "'waiting', 'running', 'done', 'failed', 'cancelled'"
static const struct counter COUNTERS[] = {
    {"seconds", "j.seconds", DONE, true, true, true},
    {"cpu_seconds", "coalesce(j.cpu_seconds, j.seconds)", DONE, true, true, true},
    {"jobs_without_cpu", "j.cpu_seconds IS NULL", DONE, true, true, true},
    {"realisations_done", "j.count", DONE, true, true, false},
    {"jobs", "j.blocks", ANY, true, true, false},
    {"jobs_left", "j.blocks", "'waiting', 'running'", true, false, false},
    {"jobs_waiting", "j.blocks", "'waiting'", false, true, false},
    {"jobs_running", "j.blocks", "'running'", false, true, false},
    {"jobs_done", "j.blocks", DONE, false, true, false},
    {"jobs_failed", "j.blocks", "'failed'", false, true, false},
    {"jobs_cancelled", "j.blocks", "'cancelled'", false, true, false},
    {"realisations_waiting", "j.count", "'waiting'", false, true, false},
    {"realisations_failed", "j.count", "'failed'", false, true, false},
};

/* Jobs of a case include those of its components. */
#define CASE_JOBS                                                                                  \
    "study_case k JOIN job j ON j.study_id = k.study_id AND j.case_number = k.number WHERE "       \
    "k.study_id = study_case.study_id AND (k.number = study_case.number OR k.parent = "            \
    "study_case.number)"
#define STUDY_JOBS "job j WHERE j.study_id = study.id"

static int count_one(struct store *store, const struct counter *counter, bool of_case,
                     struct error *err) {
    const char *table = of_case ? "study_case" : "study", *id = of_case ? "study_id" : "id";
    const char *jobs = of_case ? CASE_JOBS : STUDY_JOBS;
    char sql[1600];
    int used = snprintf(sql, sizeof sql,
                        "UPDATE %s SET %s = (SELECT coalesce(sum(%s), 0) FROM %s AND j.state IN "
                        "(%s)) WHERE %s " ALIVE,
                        table, counter->name, counter->sum, jobs, counter->states, id);
    if (counter->time)
        snprintf(sql + used, sizeof sql - (size_t)used,
                 " AND realisations_done <> (SELECT coalesce(sum(j.count), 0) FROM %s AND j.state "
                 "= 'done')",
                 jobs);
    return store_execute(store, sql, err);
}

static int count_anew(struct store *store, struct error *err) {
    int status = 0;
    for (size_t c = 0; c < sizeof COUNTERS / sizeof *COUNTERS && status == 0; c++) {
        if (COUNTERS[c].of_case)
            status = count_one(store, &COUNTERS[c], true, err);
        if (status == 0 && COUNTERS[c].of_study)
            status = count_one(store, &COUNTERS[c], false, err);
    }
    return status != 0
               ? status
               : store_execute(
                     store,
                     "UPDATE study SET cases_failed = (SELECT count(*) FROM study_case WHERE "
                     "study_id = study.id AND publish_error IS NOT NULL) WHERE id " ALIVE ";"
                     "UPDATE study SET state = 'running' WHERE id " ALIVE
                     " AND state = 'queued' AND jobs_waiting + jobs_running = 0;"
                     "UPDATE study SET state = iif(jobs_done + jobs_running > 0, 'running', "
                     "'queued'), finished = NULL WHERE id " ALIVE
                     " AND state <> 'cancelled' AND jobs_waiting + jobs_running > 0",
                     err);
}

/* Ends studies without jobs that wait or run, but not those with a case due. */
static int settle_all(struct store *store, struct error *err) {
    int64_t study = 0;
    int status = 0;
    while ((status = store_integer(
                store, &study, err,
                "SELECT id FROM study WHERE id > ? AND id " ALIVE
                " AND state IN ('queued', 'running') AND jobs_waiting + jobs_running = 0 "
                "ORDER BY id LIMIT 1",
                "i", study)) == 0)
        if ((status = study_settle(store, study, err)) != 0)
            return status;
    return status == ERROR_ABSENT ? 0 : status;
}

/* --- checksums --- */

static int seal_published(struct store *store, struct error *err) {
    static const char SQL[] =
        "UPDATE published SET curves_seal = " CURVES_SEAL ", rows_seal = " ROWS_SEAL
        ", seal = seal_of(study_id, case_number, revision, document, report, "
        "" CURVES_SEAL ") WHERE study_id = ?1 AND case_number = ?2";
    sqlite3_stmt *row = NULL;
    int64_t at = 0;
    int status = 0;
    while (status == 0) {
        status = store_query(store, &row, err,
                             "SELECT rowid, study_id, case_number FROM published WHERE seal IS "
                             "NULL AND rowid > ? ORDER BY rowid LIMIT 1",
                             "i", at);
        if (status == 0)
            status = store_step(store, row, err);
        if (status != 1)
            break;
        at = sqlite3_column_int64(row, 0);
        int64_t study = sqlite3_column_int64(row, 1), number = sqlite3_column_int64(row, 2);
        sqlite3_reset(row);
        status = store_run(store, err, SQL, "ii", study, number);
    }
    return status;
}

static int seal_all(struct store *store, struct error *err) {
    int status = store_execute(
        store,
        "UPDATE study_case SET seal = " CASE_SEAL " FROM study s WHERE s.id = study_id AND seal IS "
        "NULL;"
        "UPDATE result SET seal = (SELECT " RESULT_SEAL " FROM job JOIN scalar_names ON "
        "scalar_names.id = result.names_id WHERE job.id = result.job_id) WHERE seal IS NULL",
        err);
    return status != 0 ? status : seal_published(store, err);
}

int store_repair_counts(struct store *store, struct error *err) {
    int status = change_begin(store, err);
    if (status != 0)
        return status;
    status = drop_misplaced(store, err);
    if (status == 0)
        status = fill_gaps(store, err);
    if (status == 0)
        status = count_anew(store, err);
    if (status == 0)
        status = settle_all(store, err);
    if (status == 0)
        status = seal_all(store, err);
    return change_end(store, status, err);
}
