/* Studies: progress, cancellation, retry. */
#include "schema/near_name.h"
#include "schema/store/store_internal.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

int study_row(struct store *store, const char *id, int64_t *row, struct error *err) {
    int status = store_integer(store, row, err, "SELECT id FROM study WHERE public = ?", "t", id);
    if (status == ERROR_ABSENT)
        return error_set(err, ERROR_ABSENT, "there is no study \"%.40s\"", id);
    return status;
}

int study_is_own(struct store *store, int64_t study, uint64_t edition, bool *own,
                 struct error *err) {
    char program[PROGRAM_SIZE];
    int64_t found = 0;
    program_write(program);
    int status = store_integer(
        store, &found, err,
        "SELECT coalesce(edition = ?, program = ? OR realisations_done = 0, 0) FROM study WHERE id "
        "= ?",
        "iti", (int64_t)edition, program, study);
    *own = found != 0;
    return status;
}

/* Whether a case of the study is neither published nor marked as impossible to publish. */
#define STUDY_DUE                                                                                  \
    "EXISTS (SELECT 1 FROM study_case c INDEXED BY case_due WHERE c.study_id = study.id AND "      \
    "c.jobs_left = 0 AND c.revision > c.settled)"

int study_settle(struct store *store, int64_t study, struct error *err) {
    return store_run(store, err,
                     "UPDATE study SET revision = revision + 1,"
                     " state = CASE WHEN state IN ('cancelled', 'queued') OR jobs_waiting + "
                     "jobs_running > 0 THEN state WHEN " STUDY_DUE " THEN 'running'"
                     " WHEN jobs_failed + cases_failed > 0 THEN 'failed' ELSE 'done' END,"
                     " finished = CASE WHEN jobs_waiting + jobs_running > 0 OR (state <> "
                     "'cancelled' AND " STUDY_DUE
                     ") THEN NULL ELSE coalesce(finished, ?) END WHERE id = ?",
                     "ti", store_time(store), study);
}

/* --- progress --- */

static const char *state_name(const unsigned char *text) {
    static const char *const NAMES[] = {"queued", "running", "done", "failed", "cancelled"};
    for (size_t n = 0; n < sizeof NAMES / sizeof *NAMES; n++)
        if (text != NULL && strcmp(NAMES[n], (const char *)text) == 0)
            return NAMES[n];
    return "failed";
}

/* ?1: now */
#define STATUS_COLUMNS                                                                             \
    "public, name, kind, state, seed, cases, realisations, jobs, jobs_done, jobs_failed, "         \
    "jobs_running, jobs_waiting, jobs_cancelled, realisations_done, realisations_failed, "         \
    "seconds, "                                                                                    \
    "revision, created, finished, id, "                                                            \
    "(SELECT coalesce(sum(CAST(reported AS INTEGER)), 0) FROM job INDEXED BY job_running WHERE "   \
    "state = 'running' "                                                                           \
    "AND study_id = study.id), "                                                                   \
    "(SELECT count(DISTINCT worker) FROM job INDEXED BY job_running WHERE state = 'running' AND "  \
    "study_id = study.id AND lease_until > ?1), "                                                  \
    "cases_failed, random, cpu_seconds, jobs_without_cpu, "                                        \
    "CASE WHEN realisations > 0 THEN cases * realisations ELSE (SELECT sum(c.realisations) FROM "  \
    "study_case c WHERE c.study_id = study.id) END, "                                              \
    "CASE WHEN realisations = 0 THEN (SELECT max(c.error_reached) FROM study_case c WHERE "        \
    "c.study_id = study.id) END, owner, priority, program, "                                       \
    "(SELECT total(reported - CAST(reported AS INTEGER)) FROM job INDEXED BY job_running WHERE "   \
    "state = 'running' AND study_id = study.id)"

static uint64_t column_count(sqlite3_stmt *row, int column) {
    return (uint64_t)sqlite3_column_int64(row, column);
}

/* Copies a short text; "" for NULL. */
static void column_text(sqlite3_stmt *row, int column, char *text, size_t size) {
    const unsigned char *value = sqlite3_column_text(row, column);
    snprintf(text, size, "%s", value != NULL ? (const char *)value : "");
}

static int read_status(sqlite3_stmt *row, struct study_status *out, struct error *err) {
    snprintf(out->id, sizeof out->id, "%s", (const char *)sqlite3_column_text(row, 0));
    out->name = column_copy(row, 1);
    out->kind = column_copy(row, 2);
    out->state = state_name(sqlite3_column_text(row, 3));
    out->seed = strtoull((const char *)sqlite3_column_text(row, 4), NULL, 10);
    out->cases = column_count(row, 5);
    out->realisations = column_count(row, 6);
    out->jobs = column_count(row, 7);
    out->jobs_done = column_count(row, 8);
    out->jobs_failed = column_count(row, 9);
    out->jobs_running = column_count(row, 10);
    out->jobs_waiting = column_count(row, 11);
    out->jobs_cancelled = column_count(row, 12);
    out->realisations_total = column_count(row, 26);
    out->realisations_done = column_count(row, 13) + column_count(row, 20);
    out->realisations_failed = column_count(row, 14);
    out->part = sqlite3_column_double(row, 31);
    out->time.seconds = sqlite3_column_double(row, 15);
    out->revision = column_count(row, 16);
    column_text(row, 17, out->created, sizeof out->created);
    column_text(row, 18, out->finished, sizeof out->finished);
    column_text(row, 30, out->program, sizeof out->program);
    out->workers = column_count(row, 21);
    out->cases_failed = column_count(row, 22);
    out->random = column_random(row, 23);
    out->time.cpu_seconds = sqlite3_column_double(row, 24);
    out->time.jobs_without_cpu = column_count(row, 25);
    out->error_reached =
        sqlite3_column_type(row, 27) == SQLITE_NULL ? (double)NAN : sqlite3_column_double(row, 27);
    out->owner = column_copy(row, 28);
    out->priority = sqlite3_column_int64(row, 29);
    if (out->name == NULL || out->kind == NULL || out->owner == NULL)
        return error_memory(err, 0, "a study's name");
    return 0;
}

/* Estimates the time of a study that waits, by the workers that run jobs of any study. */
static int queue_left(struct store *store, int64_t row, struct at_work *at_work,
                      struct study_status *out, struct work_left *left, struct error *err) {
    int status = at_work_read(store, at_work, err);
    if (status == 0)
        status = study_left(store, row, out->realisations, at_work->workers, left, err);
    if (status == 0)
        status = study_line(store, row, at_work, out, err);
    left->seconds += out->starts_in;
    if (strcmp(out->state, "queued") != 0)
        out->place = 0;
    return status;
}

/* Reads what depends on other rows: the time left, and the position in the queue. */
static int read_outlook(struct store *store, int64_t row, struct at_work *at_work,
                        struct study_status *out, struct error *err) {
    struct work_left left = {0};
    int status = 0;
    out->starts_in = NAN;
    if (out->jobs_running > 0)
        status = study_left(store, row, out->realisations, 0, &left, err);
    else if (out->jobs_waiting > 0)
        status = queue_left(store, row, at_work, out, &left, err);
    else if (out->realisations_total > 0)
        left.share = (double)out->realisations_done / (double)out->realisations_total;
    const bool left_alone = out->jobs_running > 0 && out->workers == 0;
    out->seconds_left = left_alone ? (double)NAN : left.seconds;
    out->share = left.share;
    return status;
}

void study_status_clear(struct study_status *status) {
    free(status->name);
    free(status->kind);
    free(status->owner);
    *status = (struct study_status){0};
}

/* Reads the row of a study and its number. */
static int read_row(struct store *store, const char *id, int64_t *row, struct study_status *out,
                    struct error *err) {
    sqlite3_stmt *statement = NULL;
    int status = store_query(store, &statement, err,
                             "SELECT " STATUS_COLUMNS " FROM study WHERE public = ?2", "it",
                             store_now(store), id);
    if (status == 0)
        status = store_step(store, statement, err);
    if (status == 0)
        return error_set(err, ERROR_ABSENT, "there is no study \"%.40s\"", id);
    if (status < 0)
        return status;
    *row = sqlite3_column_int64(statement, 19);
    status = read_status(statement, out, err);
    sqlite3_reset(statement);
    return status;
}

static int read_study(struct store *store, const char *id, bool outlook, struct study_status *out,
                      struct error *err) {
    struct study_status read = {.share = NAN, .seconds_left = NAN, .starts_in = NAN};
    struct at_work at_work = {0};
    int64_t row = 0;
    int status = read_row(store, id, &row, &read, err);
    if (status == 0 && outlook)
        status = read_outlook(store, row, &at_work, &read, err);
    if (status != 0)
        study_status_clear(&read);
    else
        *out = read;
    return status;
}

int store_status(struct store *store, const char *id, struct study_status *out, struct error *err) {
    return read_study(store, id, true, out, err);
}

int store_status_counted(struct store *store, const char *id, struct study_status *out,
                         struct error *err) {
    return read_study(store, id, false, out, err);
}

/* Reads the one JSON text that a query of a study returns. */
static int read_json(struct store *store, const char *id, const char *sql, cJSON **out,
                     struct error *err) {
    sqlite3_stmt *row = NULL;
    int64_t study = 0;
    int status = study_row(store, id, &study, err);
    if (status == 0)
        status = store_query(store, &row, err, sql, "i", study);
    if (status == 0)
        status = store_step(store, row, err);
    if (status <= 0)
        return status != 0 ? status : error_set(err, ERROR_SYSTEM, "study %s has no document", id);
    status = column_json(row, 0, out, err);
    sqlite3_reset(row);
    return status;
}

int store_provenance(struct store *store, const char *id, cJSON **out, struct error *err) {
    return read_json(
        store, id,
        "SELECT json_object('seed', seed, 'program', program, 'created', created, 'finished', "
        "finished, 'runs', json((SELECT json_group_array(json_object('host', host, 'program', "
        "program, 'jobs', jobs, 'first', first, 'last', last)) FROM (SELECT host, program, "
        "count(*) AS jobs, min(claimed) AS first, max(ended) AS last FROM job WHERE study_id = ?1 "
        "AND state = 'done' GROUP BY host, program)))) FROM study WHERE id = ?1",
        out, err);
}

int store_document(struct store *store, const char *id, cJSON **out, struct error *err) {
    return read_json(store, id, "SELECT source FROM study_source WHERE study_id = ?1", out, err);
}

static void free_list(struct study_status *list, size_t count) {
    for (size_t i = 0; i < count; i++)
        study_status_clear(&list[i]);
    free(list);
}

/* Finds where a list goes on, also behind a study that was deleted meanwhile. */
static int listed_row(struct store *store, const char *id, int64_t *row, struct error *err) {
    int status =
        store_integer(store, row, err, "SELECT id FROM deleted_study WHERE public = ?", "t", id);
    return status == ERROR_ABSENT ? study_row(store, id, row, err) : status;
}

/* Reads the rows of studies behind one, and their numbers. */
static int list_rows(struct store *store, int64_t after, size_t limit, struct study_status *list,
                     int64_t *rows, size_t *count, struct error *err) {
    sqlite3_stmt *statement = NULL;
    size_t n = 0;
    int status = store_query(store, &statement, err,
                             "SELECT " STATUS_COLUMNS
                             " FROM study WHERE id > ?2 AND id NOT IN " DELETED_STUDIES
                             " ORDER BY id LIMIT ?3",
                             "iii", store_now(store), after, (int64_t)limit);
    while (status == 0 && n < limit && (status = store_step(store, statement, err)) == 1) {
        rows[n] = sqlite3_column_int64(statement, 19);
        status = read_status(statement, &list[n++], err);
    }
    if (status >= 0 && n != 0)
        sqlite3_reset(statement);
    *count = n;
    return status < 0 ? status : 0;
}

/* Lists as of one moment, so that the queue is read once. */
static int list_studies(struct store *store, const char *after, size_t limit,
                        struct study_status *list, int64_t *rows, size_t *count,
                        struct error *err) {
    struct at_work at_work = {0};
    int64_t row = 0;
    bool inside = sqlite3_get_autocommit(store->db) == 0;
    int status = inside ? 0 : read_begin(store, err);
    if (status != 0)
        return status;
    if (after != NULL && *after != '\0')
        status = listed_row(store, after, &row, err);
    if (status == 0)
        status = list_rows(store, row, limit, list, rows, count, err);
    for (size_t i = 0; status == 0 && i < *count; i++)
        status = read_outlook(store, rows[i], &at_work, &list[i], err);
    if (!inside)
        read_end(store);
    return status;
}

int store_list(struct store *store, const char *after, size_t limit, struct study_status **out,
               size_t *count, struct error *err) {
    struct study_status *list = array_create(limit, sizeof *list);
    int64_t *rows = array_create(limit, sizeof *rows);
    size_t n = 0;
    int status = list != NULL && rows != NULL
                     ? list_studies(store, after, limit, list, rows, &n, err)
                     : error_memory(err, limit * sizeof *list, "a list of studies");
    free(rows);
    if (status != 0) {
        free_list(list, n);
        return status;
    }
    *out = list;
    *count = n;
    return 0;
}

/* --- cancel and retry --- */

static int cancel_jobs(struct store *store, int64_t row, struct error *err) {
    int status = store_run(store, err,
                           "UPDATE job SET state = 'cancelled', ended = ? WHERE study_id = ? AND "
                           "state IN ('waiting', 'running')",
                           "ti", store_time(store), row);
    if (status == 0)
        status =
            store_run(store, err,
                      "UPDATE study SET state = 'cancelled', jobs_cancelled = jobs_cancelled + "
                      "jobs_waiting + jobs_running, jobs_waiting = 0, realisations_waiting = 0, "
                      "jobs_running = 0 WHERE id = ?",
                      "i", row);
    if (status == 0)
        status = store_run(store, err, "UPDATE study_case SET jobs_left = 0 WHERE study_id = ?",
                           "i", row);
    return status != 0 ? status : study_settle(store, row, err);
}

int store_cancel(struct store *store, const char *id, struct error *err) {
    int64_t row = 0, ended = 0;
    int status = change_begin(store, err);
    if (status != 0)
        return status;
    status = study_row(store, id, &row, err);
    if (status == 0)
        status = store_integer(
            store, &ended, err,
            "SELECT state IN ('done', 'failed', 'cancelled') FROM study WHERE id = ?", "i", row);
    if (status == 0 && ended != 0)
        status = error_set(err, ERROR_STATE, "study %s has already ended", id);
    if (status == 0)
        status = cancel_jobs(store, row, err);
    return change_end(store, status, err);
}

/* Cases that cannot be published, and the components of those. */
#define IN_VAIN                                                                                    \
    "study_id = ?1 AND (publish_error IS NOT NULL OR parent IN (SELECT number FROM study_case "    \
    "WHERE study_id = ?1 AND publish_error IS NOT NULL))"
#define DONE_IN_VAIN                                                                               \
    "state = 'done' AND study_id = ?1 AND case_number IN (SELECT number FROM study_case "          \
    "WHERE " IN_VAIN ")"

/* Discards the results of cases that could not be published, such as those of an older program, for
 * which merging again would not help: their jobs count as failed. */
static int discard_results(struct store *store, int64_t row, struct error *err) {
    int status = store_run(store, err,
                           "DELETE FROM result WHERE job_id IN (SELECT id FROM job WHERE "
                           "" DONE_IN_VAIN ")",
                           "i", row);
    if (status == 0)
        status = store_run(
            store, err,
            "UPDATE study SET jobs_done = jobs_done - n, jobs_failed = jobs_failed + n, "
            "realisations_done = realisations_done - r, realisations_failed = realisations_failed "
            "+ r, seconds = seconds - s, cpu_seconds = cpu_seconds - c, jobs_without_cpu = "
            "jobs_without_cpu - w FROM (SELECT count(*) AS n, total(count) AS r, total(seconds) AS "
            "s, total(coalesce(cpu_seconds, seconds)) AS c, total(cpu_seconds IS NULL) AS w FROM "
            "job WHERE " DONE_IN_VAIN ") WHERE id = ?1",
            "i", row);
    if (status == 0)
        status =
            store_run(store, err, "UPDATE job SET state = 'failed' WHERE " DONE_IN_VAIN, "i", row);
    if (status == 0)
        status =
            store_run(store, err,
                      "UPDATE study_case SET realisations_done = 0, seconds = 0, cpu_seconds = "
                      "0, jobs_without_cpu = 0 WHERE " IN_VAIN,
                      "i", row);
    return status;
}

/* Clears the marks of all cases of a study that cannot be published: they are due again. So are
 * those of a cancelled study that ask for an error, which may need another round. */
static int marks_clear(struct store *store, int64_t study, struct error *err) {
    int status =
        store_run(store, err,
                  "UPDATE study_case SET settled = 0, publish_error = NULL WHERE study_id = ?1 AND "
                  "(publish_error IS NOT NULL OR ((SELECT state FROM study WHERE id = ?1) = "
                  "'cancelled' AND number IN (SELECT parent FROM study_case WHERE study_id = ?1 "
                  "AND parent IS NOT NULL)))",
                  "i", study);
    if (status == 0)
        status =
            store_run(store, err, "UPDATE study SET cases_failed = 0 WHERE id = ?", "i", study);
    return status;
}

static int retry_jobs(struct store *store, int64_t row, struct error *err) {
    int status = marks_clear(store, row, err);
    if (status == 0)
        status = store_run(
            store, err,
            "WITH again AS (SELECT j.case_number AS number, c.parent, sum(j.blocks) AS n FROM job "
            "j JOIN study_case c ON c.study_id = j.study_id AND c.number = j.case_number WHERE "
            "j.study_id = ?1 AND j.state IN ('failed', 'cancelled') GROUP BY j.case_number) "
            "UPDATE study_case SET jobs_left = jobs_left + of.n FROM (SELECT number, sum(n) AS n "
            "FROM (SELECT number, n FROM again UNION ALL SELECT parent, n FROM again WHERE parent "
            "IS NOT NULL) GROUP BY number) of WHERE study_id = ?1 AND study_case.number = "
            "of.number",
            "i", row);
    if (status == 0)
        status =
            store_run(store, err,
                      "UPDATE job SET state = 'waiting', attempts = 0, losses = 0, not_before = 0, "
                      "token = NULL, ended = NULL "
                      "WHERE study_id = ? AND state IN ('failed', 'cancelled')",
                      "i", row);
    if (status == 0)
        status = store_run(
            store, err,
            "UPDATE study SET jobs_waiting = jobs_waiting + jobs_failed + jobs_cancelled, "
            "jobs_failed = 0, jobs_cancelled = 0, realisations_failed = 0, realisations_waiting = "
            "(SELECT coalesce(sum(count), 0) FROM job WHERE study_id = study.id AND job.state = "
            "'waiting'), state = "
            "CASE WHEN jobs_done + jobs_running > 0 THEN 'running' ELSE 'queued' END WHERE id = ?",
            "i", row);
    return status != 0 ? status : study_settle(store, row, err);
}

int study_retry(struct store *store, int64_t study, int64_t *jobs, struct error *err) {
    int64_t others = 0; /* reasons to go on, but for jobs */
    int status = discard_results(store, study, err);
    if (status == 0)
        status = store_integer(store, jobs, err,
                               "SELECT jobs_failed + jobs_cancelled FROM study WHERE id = ?", "i",
                               study);
    if (status == 0)
        status = store_integer(store, &others, err,
                               "SELECT cases_failed + (state = 'cancelled') FROM study WHERE id = "
                               "?",
                               "i", study);
    return status == 0 && *jobs + others > 0 ? retry_jobs(store, study, err) : status;
}

/* Cases of study ?1 of which a job is such; of components, the case that they belong to. */
#define CASES_WITH                                                                                 \
    "(SELECT coalesce(c.parent, c.number) FROM job j JOIN study_case c ON c.study_id = "           \
    "j.study_id AND c.number = j.case_number WHERE j.study_id = ?1 AND "

/* Marks the cases of which another program has computed a part and this one is to compute the rest,
 * or to publish it, as impossible to publish. */
static int mark_foreign(struct store *store, int64_t study, struct error *err) {
    char program[PROGRAM_SIZE];
    program_write(program);
    return store_run(
        store, err,
        "UPDATE study_case SET publish_error = 'of another version of the program' WHERE study_id "
        "= ?1 AND parent IS NULL AND number IN " CASES_WITH
        "j.state = 'done' AND j.program IS NOT ?2) AND ((jobs_left = 0 AND revision > settled) OR "
        "number IN " CASES_WITH "j.state IN ('failed', 'cancelled')))",
        "it", study, program);
}

int store_retry(struct store *store, const char *id, uint64_t edition, uint64_t *count,
                struct error *err) {
    int64_t row = 0, jobs = 0;
    bool own = false;
    int status = change_begin(store, err);
    if (status != 0)
        return status;
    status = study_row(store, id, &row, err);
    if (status == 0)
        status = study_is_own(store, row, edition, &own, err);
    if (status == 0 && !own)
        status = mark_foreign(store, row, err);
    if (status == 0)
        status = study_retry(store, row, &jobs, err);
    status = change_end(store, status, err);
    if (status == 0)
        *count = (uint64_t)jobs;
    return status;
}

/* Finds studies by an id, its first digits, or a name. */

enum { CANDIDATES_SHOWN = 5 };

/* What a text may be of a study. */
enum known_by { KNOWN_BY_NAME, KNOWN_BY_DIGITS };

/* Queries the studies with this name, or with these first digits of the id, newest first. */
static int query_candidates(struct store *store, const char *given, enum known_by by,
                            sqlite3_stmt **row, struct error *err) {
#define CANDIDATES(condition)                                                                      \
    "SELECT public, name, state, created FROM study WHERE " condition                              \
    " AND id NOT IN " DELETED_STUDIES " ORDER BY id DESC"
    static const char *const QUERIES[] = {CANDIDATES("name = ?1"),
                                          CANDIDATES("substr(public, 1, length(?1)) = ?1")};
#undef CANDIDATES
    return store_query(store, row, err, QUERIES[by], "t", given);
}

/* Appends "ID (name, state, since)". */
static size_t append_candidate(char *text, size_t size, size_t used, sqlite3_stmt *row) {
    int length = snprintf(
        text + used, size - used, "%s%s (%.24s, %s, %s)", used > 0 ? ", " : "",
        (const char *)sqlite3_column_text(row, 0), (const char *)sqlite3_column_text(row, 1),
        (const char *)sqlite3_column_text(row, 2), (const char *)sqlite3_column_text(row, 3));
    return used + (length > 0 ? (size_t)length : 0);
}

/* Studies that a text may stand for. */
struct candidates {
    size_t count;
    char newest[STUDY_ID_SIZE];
    char list[110 * CANDIDATES_SHOWN]; /* the newest few */
};

static int read_candidates(struct store *store, const char *given, enum known_by by,
                           struct candidates *out, struct error *err) {
    sqlite3_stmt *row = NULL;
    size_t used = 0;
    *out = (struct candidates){0};
    int status = query_candidates(store, given, by, &row, err);
    if (status != 0)
        return status;
    for (; (status = store_step(store, row, err)) == 1; out->count++) {
        if (out->count == 0)
            snprintf(out->newest, STUDY_ID_SIZE, "%s", (const char *)sqlite3_column_text(row, 0));
        if (out->count < CANDIDATES_SHOWN)
            used = append_candidate(out->list, sizeof out->list, used, row);
    }
    return status;
}

static int refuse_candidates(const char *given, const struct candidates *found, struct error *err) {
    char more[32] = "";
    if (found->count > CANDIDATES_SHOWN)
        snprintf(more, sizeof more, " and %zu more", found->count - CANDIDATES_SHOWN);
    return error_set(err, ERROR_INPUT, "\"%.40s\" may be each of %zu studies; name its id: %s%s",
                     given, found->count, found->list, more);
}

/* A study's name that is near to what was given, of the newest ones. */
static int refuse_absent(struct store *store, const char *given, struct error *err) {
    sqlite3_stmt *row = NULL;
    struct near_name near = {.typed = given};
    char hint[NEAR_HINT_SIZE] = "", name[sizeof hint];
    int status = store_query(store, &row, err,
                             "SELECT name FROM study WHERE id NOT IN " DELETED_STUDIES
                             " ORDER BY id DESC LIMIT 1000",
                             "");
    if (status != 0)
        return status;
    while ((status = store_step(store, row, err)) == 1) {
        const size_t before = near.name != NULL ? near.distance : SIZE_MAX;
        snprintf(name, sizeof name, "%s", (const char *)sqlite3_column_text(row, 0));
        near_name_see(&near, name);
        if (near.name != NULL && near.distance < before)
            near_name_hint(&near, hint);
    }
    return status != 0
               ? status
               : error_set(err, ERROR_ABSENT,
                           "there is no study \"%.40s\"%s; rugo status lists those there are",
                           given, hint);
}

/* A name goes before the first digits of an id, which may be anything's. */
static int find_candidate(struct store *store, const char *given, char id[STUDY_ID_SIZE],
                          uint64_t *others, struct error *err) {
    struct candidates found;
    int status = read_candidates(store, given, KNOWN_BY_NAME, &found, err);
    bool named = status == 0 && found.count > 0;
    if (status == 0 && !named)
        status = read_candidates(store, given, KNOWN_BY_DIGITS, &found, err);
    if (status != 0)
        return status;
    if (found.count == 0)
        return refuse_absent(store, given, err);
    if (found.count > 1 && !(named && others != NULL))
        return refuse_candidates(given, &found, err);
    if (others != NULL)
        *others = found.count - 1;
    snprintf(id, STUDY_ID_SIZE, "%s", found.newest);
    return 0;
}

int store_find(struct store *store, const char *given, char id[STUDY_ID_SIZE], uint64_t *others,
               struct error *err) {
    int64_t row;
    struct error absent = {0};
    if (*given == '\0')
        return error_set(err, ERROR_INPUT, "a study has an id and a name, and neither is empty");
    int status =
        strlen(given) < STUDY_ID_SIZE ? study_row(store, given, &row, &absent) : ERROR_ABSENT;
    if (status == 0) {
        snprintf(id, STUDY_ID_SIZE, "%s", given);
        if (others != NULL)
            *others = 0;
    }
    if (status != 0 && status != ERROR_ABSENT)
        *err = absent;
    return status == ERROR_ABSENT ? find_candidate(store, given, id, others, err) : status;
}

/* The failures of a study: jobs, and cases that cannot be published. */

void failures_free(struct failure *failures, size_t count) {
    for (size_t i = 0; failures != NULL && i < count; i++) {
        free(failures[i].worker);
        free(failures[i].reason);
    }
    free(failures);
}

/* Appends a failure. It is counted before it is complete, so that the list is freed with it. */
static int append_failure(sqlite3_stmt *row, struct failure **list, size_t *number,
                          struct error *err) {
    size_t count = *number;
    struct failure *larger = realloc(*list, (count + 1) * sizeof *larger);
    if (larger == NULL)
        return error_memory(err, (count + 1) * sizeof *larger, "failures");
    *list = larger;
    *number = count + 1;
    larger[count] = (struct failure){sqlite3_column_int64(row, 0),
                                     (uint64_t)sqlite3_column_int64(row, 1),
                                     (uint64_t)sqlite3_column_int64(row, 2),
                                     (uint64_t)sqlite3_column_int64(row, 3),
                                     (uint64_t)sqlite3_column_int64(row, 4),
                                     (uint64_t)sqlite3_column_int64(row, 7),
                                     column_copy(row, 5),
                                     column_copy(row, 6)};
    if (larger[count].worker == NULL || larger[count].reason == NULL)
        return error_memory(err, 0, "a failure's reason");
    return 0;
}

int store_failures(struct store *store, const char *id, struct failure **out, size_t *count,
                   struct error *err) {
    int64_t row = 0;
    sqlite3_stmt *statement = NULL;
    struct failure *list = NULL;
    size_t n = 0;
    int status = study_row(store, id, &row, err);
    if (status == 0)
        status = store_query(
            store, &statement, err,
            "SELECT id, case_number, first, count, attempts, worker, error, losses FROM "
            "job "
            "WHERE study_id = ?1 AND state = 'failed' UNION ALL SELECT 0, number, 0, "
            "realisations_done, 0, NULL, publish_error, 0 FROM study_case WHERE study_id "
            "= ?1 AND publish_error IS NOT NULL ORDER BY 1, 2 LIMIT 1000",
            "i", row);
    while (status == 0 && (status = store_step(store, statement, err)) == 1)
        status = append_failure(statement, &list, &n, err);
    if (status < 0) {
        failures_free(list, n);
        return status;
    }
    *out = list;
    *count = n;
    return 0;
}
