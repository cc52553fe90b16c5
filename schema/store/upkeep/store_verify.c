#include "schema/store/upkeep/store_verify.h"
#include "schema/store/store_seal.h"
#include <stdio.h>

/* A check of the store: a query for rows of study, case, first, count, job, and a text of the fault
 * or NULL. The last column is whether the row has a checksum, NULL where it needs none. */
struct look {
    enum flaw_kind kind;
    const char *what, *sql;
};

/* The column with the jobs that a row of job counts as. */
#define JOBS "blocks"
#define ALIVE "s.id NOT IN " DELETED_STUDIES
/* The realisations that are asked for of a case; none of one with components. */
#define WANTED                                                                                     \
    "coalesce(study_case.realisations, CASE WHEN EXISTS (SELECT 1 FROM study_case k WHERE "        \
    "k.study_id = s.id AND k.parent = study_case.number) THEN 0 ELSE s.realisations END)"
/* A counter of a study, and the sum that it should be. */
#define STUDY_COUNTER(name, sum, states)                                                           \
    "SELECT s.public, NULL, 0, 0, 0, iif(s." name " = n, NULL, 'it counts ' || s." name            \
    " || ' of " name ", and has ' || n), NULL FROM study s JOIN (SELECT s.id AS of, (SELECT "      \
    "coalesce(sum(" sum "), 0) FROM job WHERE study_id = s.id AND state IN (" states               \
    ")) AS n FROM study s) ON of = s.id WHERE " ALIVE
/* A counter of a case: of its own jobs, and those of its components. */
#define CASE_COUNTER(name, sum, states)                                                            \
    "SELECT s.public, c.number, 0, 0, 0, iif(c." name " = n, NULL, 'it counts ' || c." name        \
    " || ' of " name ", and has ' || n), NULL FROM study s JOIN (SELECT *, (SELECT coalesce(sum("  \
    "own), 0) FROM (SELECT k.parent, k.number, (SELECT coalesce(sum(" sum "), 0) FROM job WHERE "  \
    "study_id = k.study_id AND case_number = k.number AND state IN (" states                       \
    ")) AS own FROM study_case k WHERE k.study_id = study_case.study_id AND (k.number = "          \
    "study_case.number OR k.parent = study_case.number))) AS n FROM study_case) c ON c.study_id "  \
    "= s.id WHERE " ALIVE
#define ANY "'waiting', 'running', 'done', 'failed', 'cancelled'"

static const struct look LOOKS[] = {
    {FLAW_FILE, "the file",
     "SELECT '', NULL, 0, 0, 0, nullif(integrity_check, 'ok'), NULL FROM "
     "pragma_integrity_check(100)"},
    {FLAW_REFERENCE, "references",
     "SELECT '', NULL, 0, 0, 0, count(*) || ' rows of ' || \"table\" || ' belong to rows of ' || "
     "parent || ' that are not there', NULL FROM pragma_foreign_key_check GROUP BY \"table\", "
     "parent"},
    {FLAW_CASE, "cases",
     "SELECT s.public, number, 0, 0, 0, iif(seal <> " CASE_SEAL
     ", 'its parameters do not match their checksum', NULL), seal IS NOT NULL FROM study_case JOIN "
     "study s ON s.id = study_id WHERE " ALIVE},
    {FLAW_CASE, "documents of studies",
     "SELECT s.public, NULL, 0, 0, 0, iif(o.seal <> seal_of(source) OR NOT json_valid(source), "
     "'its document does not match its checksum', NULL), NULL FROM study_source o JOIN study s ON "
     "s.id = study_id WHERE " ALIVE},
    {FLAW_BLOCK, "results",
     "SELECT s.public, case_number, first, count, job.id, CASE WHEN result.job_id IS NULL THEN "
     "iif(job.state = 'done', 'they are done and have no result', NULL) WHEN job.state <> 'done' "
     "THEN 'they have a result, and are ' || job.state WHEN result.seal <> " RESULT_SEAL
     " OR (result.seal IS NULL AND scalar_names.id IS NULL) THEN 'their result does not match its "
     "checksum' END, iif(result.job_id IS NULL, NULL, result.seal IS NOT NULL) FROM job JOIN study "
     "s ON s.id = study_id LEFT JOIN result ON result.job_id = job.id LEFT JOIN scalar_names ON "
     "scalar_names.id = result.names_id WHERE (result.job_id IS NOT NULL OR job.state = 'done') "
     "AND " ALIVE},
    {FLAW_COVER, "realisations of cases",
     "SELECT s.public, case_number, before, abs(first - before), 0, iif(first > before, 'no job "
     "has them', iif(first < before, 'two jobs have them', NULL)), NULL FROM (SELECT study_id, "
     "case_number, first, lag(first + count, 1, 0) OVER (PARTITION BY study_id, case_number ORDER "
     "BY first) AS before FROM job) JOIN study s ON s.id = study_id WHERE first <> before "
     "AND " ALIVE},
    {FLAW_COVER, "ends of cases",
     "SELECT public, number, min(has, wanted), abs(wanted - has), 0, iif(has < wanted, 'no job has "
     "them', 'a job has them that nobody asked for'), NULL FROM (SELECT s.public, number, " WANTED
     " AS wanted, coalesce((SELECT max(first + count) FROM job WHERE job.study_id = s.id AND "
     "case_number = number), 0) AS has FROM study_case JOIN study s ON s.id = study_id WHERE " ALIVE
     ") WHERE has <> wanted"},
    {FLAW_COVER, "cases of jobs",
     "SELECT s.public, case_number, first, count, job.id, 'their job is of no case', NULL FROM job "
     "JOIN study s ON s.id = study_id WHERE NOT EXISTS (SELECT 1 FROM study_case c WHERE "
     "c.study_id = job.study_id AND c.number = case_number) AND " ALIVE},
    {FLAW_PUBLISHED, "what is published",
     "SELECT s.public, case_number, 0, 0, 0, CASE WHEN seal <> " PUBLISHED_SEAL
     " THEN 'what is published of it does not match its checksum' WHEN curves_seal <> (SELECT "
     "seals_of(c.quantity, c.id) FROM curve c WHERE c.study_id = published.study_id AND "
     "c.case_number = published.case_number) THEN 'curves of it are missing, or have other names' "
     "END, seal IS NOT NULL FROM published JOIN study s ON s.id = study_id WHERE "
     "published.revision "
     ">= 0 AND " ALIVE},
    {FLAW_PUBLISHED, "cases that are published",
     "SELECT s.public, number, 0, 0, 0, 'it counts as published, and is not', NULL FROM study_case "
     "JOIN study s ON s.id = study_id WHERE parent IS NULL AND jobs_left = 0 AND "
     "study_case.revision > 0 AND "
     "settled >= study_case.revision AND publish_error IS NULL AND NOT EXISTS (SELECT 1 FROM "
     "published p "
     "WHERE "
     "p.study_id = s.id AND p.case_number = number AND p.revision = study_case.revision) "
     "AND " ALIVE},
    {FLAW_COUNTER, "states",
     "SELECT s.public, NULL, 0, 0, 0, 'it is ' || state || ', and jobs of it wait or run', NULL "
     "FROM study s WHERE state IN ('done', 'failed') AND jobs_waiting + jobs_running > 0 "
     "AND " ALIVE},
    {FLAW_COUNTER, "counters", STUDY_COUNTER("jobs", JOBS, ANY)},
    {FLAW_COUNTER, "counters", STUDY_COUNTER("jobs_waiting", JOBS, "'waiting'")},
    {FLAW_COUNTER, "counters", STUDY_COUNTER("jobs_running", JOBS, "'running'")},
    {FLAW_COUNTER, "counters", STUDY_COUNTER("jobs_done", JOBS, "'done'")},
    {FLAW_COUNTER, "counters", STUDY_COUNTER("jobs_failed", JOBS, "'failed'")},
    {FLAW_COUNTER, "counters", STUDY_COUNTER("jobs_cancelled", JOBS, "'cancelled'")},
    {FLAW_COUNTER, "counters", STUDY_COUNTER("realisations_waiting", "count", "'waiting'")},
    {FLAW_COUNTER, "counters", STUDY_COUNTER("realisations_done", "count", "'done'")},
    {FLAW_COUNTER, "counters", STUDY_COUNTER("realisations_failed", "count", "'failed'")},
    {FLAW_COUNTER, "counters", CASE_COUNTER("jobs", JOBS, ANY)},
    {FLAW_COUNTER, "counters", CASE_COUNTER("jobs_left", JOBS, "'waiting', 'running'")},
    {FLAW_COUNTER, "counters", CASE_COUNTER("realisations_done", "count", "'done'")},
};
enum { LOOK_COUNT = sizeof LOOKS / sizeof *LOOKS };

struct looking {
    struct store *store;
    const struct verification *verification;
    struct verify_counts *counts;
    uint64_t done;
};

static int report_flaw(const struct looking *looking, const struct flaw *flaw, struct error *err) {
    looking->counts->flaws++;
    return looking->verification->found(looking->verification->context, flaw, err);
}

static int look_at_row(struct looking *looking, const struct look *look, sqlite3_stmt *row,
                       struct error *err) {
    const char *study = (const char *)sqlite3_column_text(row, 0);
    struct flaw flaw = {.kind = look->kind,
                        .case_number = sqlite3_column_type(row, 1) != SQLITE_NULL
                                           ? sqlite3_column_int64(row, 1)
                                           : -1,
                        .first = (uint64_t)sqlite3_column_int64(row, 2),
                        .count = (uint64_t)sqlite3_column_int64(row, 3),
                        .job = sqlite3_column_int64(row, 4),
                        .text = (const char *)sqlite3_column_text(row, 5)};
    struct verify_counts *counts = looking->counts;
    bool sealed = sqlite3_column_type(row, 6) != SQLITE_NULL;
    snprintf(flaw.study, sizeof flaw.study, "%s", study != NULL ? study : "");
    counts->cases += sealed && look->kind == FLAW_CASE;
    counts->blocks += sealed && look->kind == FLAW_BLOCK;
    counts->published += sealed && look->kind == FLAW_PUBLISHED;
    counts->unsealed += sealed && sqlite3_column_int(row, 6) == 0;
    return flaw.text != NULL ? report_flaw(looking, &flaw, err) : 0;
}

static int report_progress(struct looking *looking, const char *what, struct error *err) {
    const struct verification *verification = looking->verification;
    if (verification->progress == NULL ||
        verification->progress(verification->context, what, looking->done) == 0)
        return 0;
    return error_set(err, ERROR_STOPPED, "stopped");
}

/* Reports what SQLite refused to read: a damaged file is a fault of the file, and the check ends.
 */
static int report_refusal(struct looking *looking, struct error *err) {
    struct error reason = {0};
    const struct flaw flaw = {.kind = FLAW_FILE, .case_number = -1, .text = reason.text};
    int code = sqlite3_errcode(looking->store->db) & 0xff;
    int status = store_error(looking->store, &reason);
    return code == SQLITE_CORRUPT || code == SQLITE_NOTADB
               ? report_flaw(looking, &flaw, err)
               : error_set(err, status, "%s", reason.text);
}

static int prepare(struct looking *looking, const char *sql, sqlite3_stmt **out,
                   struct error *err) {
    int code = sqlite3_prepare_v2(looking->store->db, sql, -1, out, NULL);
    return code == SQLITE_OK ? 0 : report_refusal(looking, err);
}

/* Returns 1 for a row, 0 at the end of a check, or an error. */
static int next_row(struct looking *looking, sqlite3_stmt *row, struct error *err) {
    int code = row != NULL ? row_step(row) : SQLITE_DONE;
    if (code == SQLITE_ROW || code == SQLITE_DONE)
        return code == SQLITE_ROW;
    return report_refusal(looking, err);
}

static int look_at(struct looking *looking, const struct look *look, struct error *err) {
    sqlite3_stmt *row = NULL;
    int status = prepare(looking, look->sql, &row, err);
    looking->done = 0;
    while (status == 0 && (status = next_row(looking, row, err)) > 0) {
        status = look_at_row(looking, look, row, err);
        if (status == 0 && looking->done++ % 64 == 0)
            status = report_progress(looking, look->what, err);
    }
    sqlite3_finalize(row);
    return status;
}

/* Checks the rows that the views show of each published case: one statement a case, as they are
 * many. */
static int look_at_rows(struct looking *looking, struct error *err) {
    static const char SQL[] =
        "SELECT s.public, p.case_number, 0, 0, 0, iif(p.rows_seal <> (SELECT " ROWS_SEAL
        "), 'rows of it that the views show are not what was published', NULL), NULL FROM "
        "published "
        "p JOIN study s ON s.id = p.study_id WHERE p.study_id = ?1 AND p.case_number = ?2";
    static const char CASES[] =
        "SELECT study_id, case_number FROM published WHERE revision >= 0 AND study_id NOT IN "
        "" DELETED_STUDIES;
    const struct look look = {FLAW_PUBLISHED, "rows of the views", SQL};
    sqlite3_stmt *cases = NULL, *row = NULL;
    int status = prepare(looking, CASES, &cases, err);
    if (status == 0)
        status = prepare(looking, SQL, &row, err);
    looking->done = 0;
    while (status == 0 && (status = next_row(looking, cases, err)) > 0) {
        sqlite3_bind_int64(row, 1, sqlite3_column_int64(cases, 0));
        sqlite3_bind_int64(row, 2, sqlite3_column_int64(cases, 1));
        status = next_row(looking, row, err);
        if (status > 0)
            status = look_at_row(looking, &look, row, err);
        sqlite3_reset(row);
        if (status == 0 && looking->done++ % 16 == 0)
            status = report_progress(looking, look.what, err);
    }
    sqlite3_finalize(cases);
    sqlite3_finalize(row);
    return status;
}

static int look_at_layout(struct looking *looking, struct error *err) {
    char text[200];
    const struct flaw flaw = {.kind = FLAW_FILE, .case_number = -1, .text = text};
    int status = version_check_layout(looking->store, text, sizeof text, err);
    return status == 0 && text[0] != '\0' ? report_flaw(looking, &flaw, err) : status;
}

int store_verify(struct store *store, const struct verification *verification,
                 struct verify_counts *counts, struct error *err) {
    struct looking looking = {.store = store, .verification = verification, .counts = counts};
    bool inside = sqlite3_get_autocommit(store->db) == 0;
    int status = inside ? 0 : store_execute(store, "BEGIN", err);
    if (status == 0)
        status = look_at_layout(&looking, err);
    for (size_t l = 0; status == 0 && l < LOOK_COUNT; l++)
        status = look_at(&looking, &LOOKS[l], err);
    if (status == 0)
        status = look_at_rows(&looking, err);
    if (!inside)
        (void)sqlite3_exec(store->db, "COMMIT", NULL, NULL, NULL);
    return status;
}
