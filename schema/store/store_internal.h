/* What the files of the store share; nobody else includes this. */
#ifndef RUGO_SCHEMA_STORE_STORE_INTERNAL_H
#define RUGO_SCHEMA_STORE_STORE_INTERNAL_H

#include "schema/store/store.h"
#include <sqlite3.h>
#include <time.h>

enum { STATEMENTS = 128, BOOT_SIZE = 40, BUSY_MS = 30000 /* waited for a lock */ };

struct store {
    sqlite3 *db;
    char *path;
    struct store_options options;
    char boot[BOOT_SIZE]; /* of this boot of the machine; leases of another are void */
    time_t time;          /* of time_text */
    char time_text[24];   /* "" at first */
    bool claim_failed_jobs;
    bool shrinks; /* a study was purged, and its pages are not given back yet */
    int batch;    /* inside store_begin .. store_commit */
    /* Statements are prepared once, and found by the address of their text. */
    struct {
        const char *sql;
        sqlite3_stmt *statement;
    } statements[STATEMENTS];
    size_t statement_count;
};

/* The prepared statement of a literal, reset, its parameters bound by format: i int64_t, d double,
 * t text or NULL (copied), b blob (const void *, size_t; copied). */
int store_query(struct store *store, sqlite3_stmt **out, struct error *err, const char *sql,
                const char *format, ...);
/* Returns 1 for a row, 0 at the end (the statement is reset), or an error. */
int store_step(struct store *store, sqlite3_stmt *statement, struct error *err);
/* Runs a statement that gives no rows. Neither this nor store_integer copies what is bound. */
int store_run(struct store *store, struct error *err, const char *sql, const char *format, ...);
/* Runs and gives the first column of the first row; ERROR_ABSENT when there is none (err
 * untouched). */
int store_integer(struct store *store, int64_t *out, struct error *err, const char *sql,
                  const char *format, ...);
/* Runs statements that are not kept, several if the text has several. */
int store_execute(struct store *store, const char *sql, struct error *err);
/* A change: all of it or nothing. End it with its status, which is returned, or the commit's. */
int change_begin(struct store *store, struct error *err);
int change_end(struct store *store, int status, struct error *err);

/* Refuses what is no store, or one of a newer program; brings an older one up to date. */
int version_bring_up(struct store *store, struct error *err);

int store_error(struct store *store, struct error *err); /* from SQLite's last error */
int64_t store_now(const struct store *store);
/* Returns the time for people: UTC, ISO 8601; it is good until the next call. */
const char *store_time(struct store *store);
int random_text(char *text, size_t digits,
                struct error *err); /* hex digits from the kernel, NUL-terminated */
char *column_copy(sqlite3_stmt *statement, int column); /* "" for NULL; NULL out of memory */
/* Reads how the study of this row draws its random numbers. */
enum study_random column_random(sqlite3_stmt *row, int column);
/* Reads a JSON text that this program stored, whatever its size; caller deletes *out. */
int column_json(sqlite3_stmt *row, int column, cJSON **out, struct error *err);

/* What the queries of studies leave out. */
#define DELETED_STUDIES "(SELECT id FROM deleted_study WHERE purged = 0)"
/* Finds the row of a study; ERROR_ABSENT with a sentence when there is none. */
int study_row(struct store *store, const char *id, int64_t *row, struct error *err);
/* Counts the work of a study anew, when it has got jobs. */
int study_count_work(struct store *store, int64_t study, struct error *err);
/* Tells the place of a study with jobs that wait among those that are queued, from 1 on, and in how
 * many seconds the next of its jobs starts: NaN where nobody works. */
int study_line(struct store *store, int64_t study, uint64_t *place, double *starts_in,
               struct error *err);
/* Queues what failed or was cancelled again: *jobs of them. Within a change. */
int study_retry(struct store *store, int64_t study, int64_t *jobs, struct error *err);
/* Ends the study when nothing of it waits or runs; raises its revision. */
int study_settle(struct store *store, int64_t study, struct error *err);

/* What is left of a study of which something waits or runs. */
struct work_left {
    double work;    /* seconds of one worker */
    double share;   /* of all work, done or not, that is done: 0 to 1 */
    double seconds; /* by the clock, until the workers are through; NaN without a worker */
};
/* workers: those that work on it, where these are more than those that do now. realisations: of
 * each case; 0 where each has its own. */
int study_left(struct store *store, int64_t study, uint64_t realisations, size_t workers,
               struct work_left *out, struct error *err);

/* The results of this revision are published: takes the mark off that they cannot be. */
int case_settle(struct store *store, int64_t study, int64_t case_number, int64_t revision,
                struct error *err);
/* Takes the marks off all cases of a study that cannot be published: they are due again. */
int marks_clear(struct store *store, int64_t study, struct error *err);

/* The case that component ?2 of study ?1 belongs to; NULL for a case that is none. */
#define CASE_PARENT "(SELECT parent FROM study_case WHERE study_id = ?1 AND number = ?2)"

/* A change of a job needs to know this of it. */
struct job_row {
    int64_t id, study, case_number, first, count, attempts;
    bool running, done, cancelled;
    bool owned; /* the token given is that of its last lease */
};
/* Queues the realisations 0 .. count - 1 of a case that no job has, as jobs of at most `block`
 * each, and adds these to *jobs. */
int jobs_insert_missing(struct store *store, const struct job_row *all, int64_t block,
                        int64_t *jobs, struct error *err);
/* Gives a study whose cases have no jobs yet the blocks of another that is the same but for its
 * name and has fewer realisations, the one that has most of them done; their number is *taken. */
int study_take_blocks(struct store *store, int64_t study, int64_t *taken, struct error *err);
/* Queues realisations of a case as jobs of `block` each; of all: study, case_number, first, count.
 * Counts nothing. */
int jobs_insert(struct store *store, const struct job_row *all, int64_t block, struct error *err);
int job_read(struct store *store, int64_t id, const char *token, struct job_row *job,
             struct error *err);
/* Fails with ERROR_STATE unless the job runs under this token. */
int job_check_lease(const struct job_row *job, struct error *err);
/* Ends an attempt that failed: the job waits again or has failed. */
int job_give_up(struct store *store, const struct job_row *job, const char *reason, bool permanent,
                struct error *err);

#endif
