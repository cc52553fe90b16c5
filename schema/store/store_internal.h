/* What the files of the store share; no other file includes it. */
#ifndef RUGO_SCHEMA_STORE_STORE_INTERNAL_H
#define RUGO_SCHEMA_STORE_STORE_INTERNAL_H

#include "schema/digest.h"
#include "schema/store/store.h"
#include <sqlite3.h>
#include <stdatomic.h>
#include <sys/types.h>
#include <time.h>

enum { APPLICATION_ID = 0x5255474f /* "RUGO" */ }; /* in the header of a database */
enum { STATEMENTS = 128, NOTED = 1024, BOOT_SIZE = 40, BUSY_MS = 30000 /* waited for a lock */ };
enum { STORE_FILES = 3 /* database, log, shared memory */, STORE_PATH_SIZE = 4224 };

struct store_file {
    bool known; /* it was there when the store had been opened */
    dev_t device;
    ino_t inode;
};

struct store {
    sqlite3 *db;
    char *path;
    struct store_file files[STORE_FILES]; /* store_files.c; constant once the store is open */
    _Atomic int64_t size;                 /* bytes of the database when it was last looked at */
    struct store_options options;
    char boot[BOOT_SIZE];       /* of this boot of the machine; leases of another are void */
    time_t time;                /* of time_text */
    char time_text[24];         /* "" at first */
    int (*stop)(void *context); /* store_set_stop; NULL: none */
    void *stop_context;
    bool claim_failed_jobs;
    bool shrinks;            /* a study was purged, and its pages are not given back yet */
    int batch;               /* inside store_begin .. store_commit */
    bool spoiled;            /* the batch holds a part of a change, and is rolled back at its end */
    struct queue_line *line; /* as it was read last; NULL: not yet */
    struct due_case damaged; /* store_found_damage; study "": none */
    /* Workers that asked for jobs lately and their threads, as counted at seen_ms; 0: not yet. */
    int64_t workers_seen, threads_seen, seen_ms;
    /* Workers that this handle noted, by a hash of their names, and when they need not be noted
     * again. */
    struct {
        uint64_t worker;
        int64_t from_ms, until_ms;
    } noted[NOTED];
    /* Statements are prepared once, and found by the address of their text. */
    struct {
        const char *sql;
        sqlite3_stmt *statement;
    } statements[STATEMENTS];
    size_t statement_count;
};

/* Returns the prepared statement of a literal, reset, with its parameters bound by format: i
 * int64_t, d double, t text or NULL (copied), b blob (const void *, size_t; copied). */
int store_query(struct store *store, sqlite3_stmt **out, struct error *err, const char *sql,
                const char *format, ...);
/* Steps a statement of any database: SQLITE_ROW with each text of the row in memory, so that none
 * is read as NULL for want of it, SQLITE_DONE, or the code of an error. */
int row_step(sqlite3_stmt *row);
/* Returns 1 for a row, 0 at the end (the statement is reset), or an error. */
int store_step(struct store *store, sqlite3_stmt *statement, struct error *err);
/* Runs a statement that returns no rows. Neither this nor store_integer copies what is bound. */
int store_run(struct store *store, struct error *err, const char *sql, const char *format, ...);
/* Runs a statement and returns the first column of the first row; ERROR_ABSENT when there is none
 * (err untouched). */
int store_integer(struct store *store, int64_t *out, struct error *err, const char *sql,
                  const char *format, ...);
/* Runs one or more statements that are not kept prepared. */
int store_execute(struct store *store, const char *sql, struct error *err);
/* Begin and end a change, which happens completely or not at all. change_end takes its status, and
 * returns it, or that of the commit. */
int change_begin(struct store *store, struct error *err);
int change_end(struct store *store, int status, struct error *err);
/* Between the two the handle reads the store of one moment. */
int read_begin(struct store *store, struct error *err);
void read_end(struct store *store);

/* Refuses, before anything is opened, a database of several names, and a log without a database. */
int files_check_before(const char *path, struct error *err);
/* Refuses, before anything is read, a log that cannot be that of the opened database. Afterwards
 * the handle has the lock of a reader, which SQLite takes over. *moved: another file has the name
 * of the one that was opened, and has to be opened instead. */
int files_check_opened(struct store *store, bool *moved, struct error *err);
/* Notes which files the store has; files_check sees whether they have their names and length. */
void files_note(struct store *store);
int files_check(struct store *store, struct error *err);
/* Where a header has its versions, for writers and for readers: 1 is without a log, 2 with one. */
enum { VERSIONS_AT = 18 };
/* Lets a database be read where no log can be made beside it, such as in a folder without
 * permission to write, until somebody opens it to write. */
int file_ask_for_no_log(int file, const char *path, struct error *err);
/* A busy handler of SQLite: pauses, and returns 0 where it has waited for BUSY_MS. */
int store_wait(void *context, int tries);

/* Compares tables, indices and views with those of a new store: *fault is a sentence about the
 * first that differs, or "". SQLite keeps them as text without a checksum, of which a bit may
 * change. */
int version_check_layout(struct store *store, char *fault, size_t size, struct error *err);

int store_error(struct store *store, struct error *err); /* from SQLite's last error */
/* Sets an error that says which folder or file of the store this user may not use, as SQLite could
 * not open or write it. reason: an errno, or 0; what: SQLite's words. Returns ERROR_SYSTEM. */
int store_refused(const struct store *store, int reason, const char *what, struct error *err);
/* Sets an error for SQLITE_IOERR of a database of that name. reason: errno as the call of SQLite
 * left it, as sqlite3_system_errno is 0 when a commit fails. Returns ERROR_LIMIT where a file met
 * the limit of this process, else ERROR_SYSTEM. */
int disk_error(int reason, const char *database, const char *what, struct error *err);
int64_t store_now(const struct store *store);
/* Returns the time in UTC, ISO 8601; valid until the next call. */
const char *store_time(struct store *store);
char *column_copy(sqlite3_stmt *statement, int column); /* "" for NULL; NULL out of memory */
/* Reads whether the cases of the study share their random numbers. */
enum study_random column_random(sqlite3_stmt *row, int column);
/* Reads a JSON text that this program stored, whatever its size, or packed (a BLOB); the caller
 * deletes *out. */
int column_json(sqlite3_stmt *row, int column, cJSON **out, struct error *err);

/* The studies that queries leave out. */
#define DELETED_STUDIES "(SELECT id FROM deleted_study WHERE purged = 0)"
/* Finds the row of a study; ERROR_ABSENT with a sentence when there is none. */
int study_row(struct store *store, const char *id, int64_t *row, struct error *err);
/* Counts the work of a study again, after jobs were added. */
int study_count_work(struct store *store, int64_t study, struct error *err);
/* The jobs of all studies that run, as of one moment. */
struct at_work {
    bool known;
    size_t workers;              /* that have them */
    double jobs, soonest, rests; /* seconds until the first of them ends, and of all */
};
/* Reads it unless it is known. */
int at_work_read(struct store *store, struct at_work *out, struct error *err);
/* Sets the position in the queue of a study with jobs that wait, and the seconds until the next of
 * them starts, in `of`, which has its owner and priority. The handle keeps the queue until the
 * store changes, so that many studies cost little more than one. */
int study_line(struct store *store, int64_t study, const struct at_work *at_work,
               struct study_status *of, struct error *err);
struct queue_line;
void queue_line_destroy(struct queue_line **line);
/* Sets *own to whether results of this program may be merged with those of the study: it has none,
 * or both are of one form (study.h). A study of which it was not recorded has to be of this very
 * build. */
int study_is_own(struct store *store, int64_t study, uint64_t edition, bool *own,
                 struct error *err);
/* Requeues what failed or was cancelled: *jobs of them. Within a change. */
int study_retry(struct store *store, int64_t study, int64_t *jobs, struct error *err);
/* Ends the study when none of its jobs waits or runs; raises its revision. */
int study_settle(struct store *store, int64_t study, struct error *err);

/* The work left of a study with jobs that wait or run. */
struct work_left {
    double work;    /* seconds of one worker */
    double share;   /* of all its work, that is done: 0 to 1 */
    double seconds; /* by the clock, until it is done; NaN without a worker */
};
/* workers: those that will work on it, if more than those at work on it now. realisations: of each
 * case; 0 where each has its own. */
int study_left(struct store *store, int64_t study, uint64_t realisations, size_t workers,
               struct work_left *out, struct error *err);

/* Sets the error that the parameters of a case are damaged; returns ERROR_INPUT. */
int case_damaged(const char *study, uint64_t case_number, struct error *err);
/* Clears the mark that a case cannot be published, when its results of this revision are. */
int case_settle(struct store *store, int64_t study, int64_t case_number, int64_t revision,
                struct error *err);

/* The case that component ?2 of study ?1 belongs to; NULL for a case that is no component. */
#define CASE_PARENT "(SELECT parent FROM study_case WHERE study_id = ?1 AND number = ?2)"

/* The columns of a job that changes of it need. */
struct job_row {
    int64_t id, study, case_number, first, count;
    int64_t attempts; /* with the one that runs */
    int64_t losses;
    bool running, done, cancelled;
    bool owned; /* the token given is that of its last lease */
};
/* How the realisations of a case are cut into jobs. */
struct cut {
    double seconds; /* of a realisation: processor time as measured, or estimated before */
    uint64_t most;  /* most realisations of a job */
};
struct cut column_cut(sqlite3_stmt *row, int seconds, int most);
/* The seconds of a cut, as a column of the case c. */
#define CUT_SECONDS                                                                                \
    "CASE WHEN c.cpu_seconds > 0 AND c.realisations_done > 0 THEN c.cpu_seconds / "                \
    "c.realisations_done ELSE c.estimate END"
/* The jobs that were queued, and their realisations. */
struct queued {
    int64_t jobs, realisations;
};
/* Queues realisations of a case as one span; of `all`: study, case_number, first, count. Adds to
 * *queued, but changes no counter of the store. */
int span_insert(struct store *store, const struct job_row *all, const struct cut *cut,
                struct queued *queued, struct error *err);
/* Queues likewise those of these realisations that no job has. */
int spans_insert_missing(struct store *store, const struct job_row *all, const struct cut *cut,
                         struct queued *queued, struct error *err);
/* Adds what was queued to the counters of a study, not to those of its cases. */
int study_count_queued(struct store *store, int64_t study, const struct queued *queued,
                       struct error *err);
/* Copies blocks to a study whose cases have no jobs yet; *taken is their number. They are from a
 * study that is the same but for its name and has fewer realisations, the one with most of them
 * done. */
int study_take_blocks(struct store *store, int64_t study, int64_t *taken, struct error *err);
/* Adds jobs to the counters of a case, and of the case that it is a component of. */
int case_add_jobs(struct store *store, int64_t study, int64_t case_number, int64_t jobs,
                  struct error *err);
/* Fails a job that runs for good. */
int job_fail(struct store *store, const struct job_row *job, const char *reason, struct error *err);
int job_read(struct store *store, int64_t id, const char *token, struct job_row *job,
             struct error *err);
/* Fails with ERROR_STATE unless the job runs under this token. */
int job_check_lease(const struct job_row *job, struct error *err);
/* Counts a loss of a job whose lease ran out on this worker: the job is requeued after a longer
 * pause each time, or has failed (*failed). */
int job_lose(struct store *store, const struct job_row *job, const char *worker, bool *failed,
             struct error *err);

/* Notes that a worker asks for jobs; *threads: of workers that asked lately, at least 1. */
int seen_note(struct store *store, const struct claim *claim, int64_t *threads, struct error *err);

/* A study that jobs are claimed from. */
struct found_study {
    int64_t id, jobs_waiting, realisations_waiting;
    bool queued;
    enum study_random random;
    char owner[OWNER_SIZE];
};
/* The state of a claim. */
struct claiming {
    const struct claim *claim;
    int64_t only;      /* of this study; 0: of any */
    char *kinds;       /* as " one two ", owned; NULL: of any */
    int64_t threads;   /* of workers that asked lately */
    int64_t elsewhere; /* jobs that wait in other studies than the first; -1: not counted */
    double seconds;    /* of the jobs taken so far */
};
/* Leases a block off the front of the study's first span that may be taken, and counts it. Fills
 * the job but for study, kind and seed. Returns 1 where the case is damaged, and its span has
 * failed. */
int block_lease(struct store *store, struct claiming *claiming, const struct found_study *study,
                struct claimed_job *job, struct error *err);
/* Counts the jobs that wait in other open studies, up to about `enough`. */
int count_elsewhere(struct store *store, int64_t study, int64_t enough, int64_t *jobs,
                    struct error *err);

#endif
