/* The store: studies, the queue of jobs with leases, partial results, published curves, in one
 * SQLite file. No other code contains SQL. schema/README.md draws the states and documents the
 * views.
 *
 * One handle belongs to one thread at a time. Every state change is one transaction (BEGIN
 * IMMEDIATE), or a savepoint within store_begin .. store_commit (group commit). A handle waits for
 * another process's lock for a limited time; then ERROR_SYSTEM "the database is busy".
 *
 * A handle whose database, log or shared memory was moved, deleted, replaced or cut commits
 * nothing: ERROR_SYSTEM, until the file is back. A database of several names is not opened, nor one
 * beside the log of another: ERROR_INPUT.
 *
 * Leases run on CLOCK_BOOTTIME, not on the wall clock, and are void after a reboot. */
#ifndef RUGO_SCHEMA_STORE_STORE_H
#define RUGO_SCHEMA_STORE_STORE_H

#include "schema/program.h"
#include "schema/result/block_result.h"
#include "schema/result/bytes/packed_bytes.h"
#include "schema/result/report.h"
#include "schema/result/work_time.h"
#include "schema/study/study.h"
#include <stdbool.h>

enum { STUDY_ID_SIZE = 17, TOKEN_SIZE = 33, ATTEMPTS_MOST = 3, LOSSES_MOST = 10, OWNER_SIZE = 41 };

struct store;
struct store_options {
    bool read_only;                   /* ERROR_ABSENT when the file does not exist */
    bool existing;                    /* do not create */
    bool as_it_is;                    /* with read_only: ERROR_STATE for a file of an older version,
                                       * which is else brought up to date */
    int64_t lease_ms;                 /* 0: 60 000 */
    int64_t (*now_ms)(void *context); /* lease clock; NULL: CLOCK_BOOTTIME */
    void *context;
};
int store_open(struct store **out, const char *path, const struct store_options *options,
               struct error *err);
void store_close(struct store **store);
/* Fails with ERROR_SYSTEM where the database, its log or its shared memory no longer has the name
 * under which it was opened. Safe from any thread. */
int store_check_names(const struct store *store, struct error *err);
/* Fails likewise where the database is shorter than it says. Reads through `store`, NULL where no
 * handle can be opened any more; `opened`, which another thread may use, is a handle of the same
 * file that may have seen its length before. */
int store_check_size(struct store *store, struct store *opened, struct error *err);
/* Makes whatever reads call stop repeatedly from now on; non-zero ends the reading with
 * ERROR_STOPPED. NULL: reads go on to their end. Not for a handle within a change. */
void store_set_stop(struct store *store, int (*stop)(void *context), void *context);

/* Group commit: all operations between the two are one transaction, in which each is done
 * completely or not at all. If store_commit fails, nothing since store_begin happened, unless a
 * file of the store lost its name just then: its error says so, and whether it happened is not
 * known. */
int store_begin(struct store *store, struct error *err);
int store_commit(struct store *store, struct error *err);
/* Undoes everything since store_begin. */
void store_abandon(struct store *store);
/* Writes to the file, to test whether that works: what the store says stays as it is. */
int store_probe(struct store *store, struct error *err);

/* --- studies --- */
/* Queues a study with its jobs. If another study is the same but for its name and has fewer
 * realisations, its blocks are copied, and only what they lack is queued. key (may be NULL): a
 * second submission of the same owner with the same key and source returns the id of the first and
 * *existing = true, also after the first was extended; with another source ERROR_STATE. */
int store_submit(struct store *store, const struct study *study, const char *key,
                 char id[STUDY_ID_SIZE], bool *existing, struct error *err);

/* Finds the id of the study that `given` stands for: its id, else its name, else the first digits
 * of its id. Of several studies with that name it is the newest, and *others the number of the
 * others; with others NULL they are refused. ERROR_ABSENT where there is none; ERROR_INPUT, with a
 * list of them, where several are refused, or begin with these digits. */
int store_find(struct store *store, const char *given, char id[STUDY_ID_SIZE], uint64_t *others,
               struct error *err);

struct study_status {
    char id[STUDY_ID_SIZE];
    char *name, *kind; /* owned */
    const char *state; /* static: queued running done failed cancelled */
    enum study_random random;
    uint64_t seed, cases, realisations; /* realisations of each case; 0: an error is asked for */
    double error_reached;               /* the largest of the cases, relative; NaN: not known */
    /* Jobs that wait, or were cancelled before they ran, are counted as what is left is likely to
     * be cut. */
    uint64_t jobs, jobs_done, jobs_failed, jobs_running, jobs_waiting, jobs_cancelled;
    uint64_t cases_failed; /* whose results cannot be published */
    uint64_t realisations_total, realisations_done,
        realisations_failed; /* done counts those that running jobs reported, too */
    double part;             /* that these reported of realisations that have not ended, added up */
    struct work_time time;   /* of completed jobs */
    double share;            /* share of its work that is done, by time, not by realisations */
    double seconds_left; /* by the clock, with the workers at work now, after older studies that no
                          * worker is at; NaN without workers */
    uint64_t workers;    /* distinct workers with a live lease */
    uint64_t revision;   /* rises with every change of results or state */
    char *owner;         /* owned; "" for a study of nobody */
    int64_t priority;    /* among the studies of its owner */
    /* Of a queued study: its position in the queue, from 1 on (else 0), and the seconds until its
     * first job starts, as estimated. NaN where no worker is at work. */
    uint64_t place;
    double starts_in;
    char created[32], finished[32]; /* UTC, ISO 8601; "" if not yet */
    char program[PROGRAM_SIZE];     /* which queued it; "": not known */
};
void study_status_clear(struct study_status *status);
int store_status(struct store *store, const char *id, struct study_status *out, struct error *err);
/* Reads the same but for what needs the study's jobs: share, seconds_left and starts_in are NaN,
 * and it has no position in the queue. It costs the same however many jobs and cases there are. */
int store_status_counted(struct store *store, const char *id, struct study_status *out,
                         struct error *err);
/* Reads who computed the study, when and on which hosts (schema/result/provenance.h); the caller
 * deletes it. */
int store_provenance(struct store *store, const char *id, cJSON **out, struct error *err);
/* Reads the document that was submitted, with the changes of --set; the caller deletes it. */
int store_document(struct store *store, const char *id, cJSON **out, struct error *err);
/* Lists up to `limit` studies created after study `after` ("": from the start), oldest first. The
 * caller frees each by study_status_clear, then the list. */
int store_list(struct store *store, const char *after, size_t limit, struct study_status **out,
               size_t *count, struct error *err);
/* Cancels a study that waits or runs, also where its cases wait for publication alone. ERROR_STATE
 * if it has ended. */
int store_cancel(struct store *store, const char *id, struct error *err);
/* Requeues failed and cancelled jobs with fresh attempts, *count of them. So are the jobs of cases
 * that could not be published, whose results are discarded. In a study of another version (study.h)
 * so are those of cases with failed or cancelled jobs, or due, if another program computed a part
 * of them. A cancelled study goes on, also where none of its jobs was cancelled. */
int store_retry(struct store *store, const char *id, uint64_t edition, uint64_t *count,
                struct error *err);

/* Queues the realisations that a study lacks to this number for each case, and requeues what failed
 * or was cancelled: *jobs in all. Nothing is done, and *jobs is 0, with the number that it has
 * (store_retry requeues). ERROR_STATE for fewer realisations than it has, or for results of another
 * version of the program (study.h). ERROR_INPUT for a study that asks for an error, or above
 * STUDY_REALISATIONS_MOST. */
int store_extend(struct store *store, const char *id, uint64_t realisations, uint64_t edition,
                 uint64_t *jobs, struct error *err);

/* Deletes a study that has ended, with all that is stored of it. It is found no more from here on;
 * store_purge frees its space. ERROR_STATE before it has ended. */
int store_delete(struct store *store, const char *id, struct error *err);
/* Removes the rows of deleted studies from the file, then the free pages, in short transactions
 * with pauses for other processes. Calls stop (may be NULL) before each: ERROR_STOPPED. What is
 * left waits for the next call, of any process. A file of a program that could not yet free single
 * pages is rewritten as a whole if it is not large; else its free pages are used again. */
int store_purge(struct store *store, bool (*stop)(void *context), void *context, struct error *err);

/* A job that failed, or a case that cannot be published. */
struct failure {
    int64_t job; /* 0: the case, with all its realisations */
    uint64_t case_number, first, count;
    uint64_t attempts;     /* that failed */
    uint64_t losses;       /* leases that ran out, as of workers that were killed */
    char *worker, *reason; /* owned */
};
int store_failures(struct store *store, const char *id, struct failure **out, size_t *count,
                   struct error *err);
void failures_free(struct failure *failures, size_t count);

/* Published cases of which no realisation has a value on any curve, as when no solve reached a
 * load. */
struct valueless {
    uint64_t cases, first; /* their count, and the number of the first one */
    char *note;            /* owned: its first note, "" without; NULL where there is no such case */
};
int store_valueless(struct store *store, const char *id, struct valueless *out, struct error *err);
void valueless_clear(struct valueless *valueless);

/* --- the queue --- */
struct claimed_job {
    int64_t id;
    char study[STUDY_ID_SIZE], token[TOKEN_SIZE]; /* token: proves that the lease is held */
    char *kind;                                   /* owned */
    cJSON *parameters;                            /* owned: of the case, as it was checked */
    uint64_t seed, sequence;                      /* of the random numbers (core/random.h) */
    uint64_t case_number, first, count, attempt;
    int64_t lease_ms;
};
void claimed_job_clear(struct claimed_job *job);

struct claim {
    const char *worker, *host; /* for the log */
    const char *program;       /* of the worker (schema/program.h); NULL: not known */
    const char *const *kinds;  /* NULL-terminated; NULL: any */
    const char *study;         /* only this study; NULL: any */
    size_t count;              /* at most */
    /* Claims go on until the jobs are estimated to take so long; 0: count alone decides. */
    double seconds;
    unsigned threads; /* of the worker, which divides its jobs among them; 0: one */
    /* The worker's program draws random numbers by the number of the case, whatever the sequence.
     * It can run only studies of independent cases, or of one case. */
    bool independent_only;
};
/* Claims jobs. Realisations wait in spans, from which jobs are cut here: at most 1000 realisations
 * or the most of the kind, of about 5 s as measured of the case or estimated. Jobs are smaller
 * where few realisations wait, so that each thread of the workers that asked within two minutes
 * gets some. Where few small jobs wait, a claim has no more than its share by threads, and at least
 * one for each of its threads.
 *
 * Leases that ran out end first. Each counts as a loss, after which the job waits for one second,
 * then two, four and so on up to about a minute; after LOSSES_MOST it fails. Jobs may so become
 * available by time alone: who waits for one asks again.
 *
 * Owners take turns, so that each gets its share of the workers' time. Of an owner the study of
 * highest priority is first, then the oldest. *count may be 0. */
int store_claim(struct store *store, const struct claim *claim, struct claimed_job *jobs,
                size_t *count, struct error *err);
/* Sets *wait to whether a claim of any kind would find a job now. */
int store_jobs_wait(struct store *store, bool *wait, struct error *err);
/* Returns a number that rises with each change by this handle. */
int64_t store_changes(const struct store *store);
/* Returns whether the last claim failed a job for good; its case may be due. */
bool store_claim_failed_jobs(const struct store *store);
/* Sets the weight of an owner, above 0 and 1 by default: its share of the workers' time relative to
 * that of other owners. */
int store_share(struct store *store, const char *owner, double weight, struct error *err);
/* Renews the lease; done: realisations so far, with what is done of the next one. ERROR_STATE when
 * the lease is lost or the study cancelled (the text says which). */
int store_heartbeat(struct store *store, int64_t job, const char *token, double done,
                    struct error *err);

/* A block as it is stored. A thread that queues results for the one writer makes it beforehand;
 * store_complete makes that of a result without. */
struct block_text {
    char *names, *scalars;    /* owned */
    struct packed_bytes data; /* borrows the result's where it is not packed */
    int64_t seal;             /* checksum of these (store_seal.h) */
};
/* Makes *out, to be cleared before the result is. */
int block_text_create(struct block_text *out, const struct block_result *result, struct error *err);
void block_text_clear(struct block_text *text);

/* Stores a result once. Completing again with the same token is harmless (0, *first_time false);
 * after a lost lease the result is dropped, and ERROR_STATE. *case_done: no job of the case is
 * left.
 *
 * A result may have fewer realisations than the job, from its first one on. Then the job is done
 * with these, and the others wait again as if they had not been claimed. */
int store_complete(struct store *store, int64_t job, const char *token,
                   const struct block_result *result, bool *first_time, bool *case_done,
                   struct error *err);
/* Fails an attempt: the job is requeued with the reason, or fails for good after ATTEMPTS_MOST.
 * permanent: it fails at once. */
int store_fail(struct store *store, int64_t job, const char *token, const char *reason,
               bool permanent, struct error *err);
/* Returns a job to the queue; the attempt does not count. */
int store_release(struct store *store, int64_t job, const char *token, struct error *err);
/* Reads the study, case and block of a job under a live lease, or done under this token, to check a
 * result before it is taken. */
int store_job(struct store *store, int64_t job, const char *token, struct claimed_job *out,
              struct error *err);

/* --- results --- */
struct case_info {
    cJSON *parameters; /* owned */
    uint64_t seed, realisations, realisations_done, revision;
};
void case_info_clear(struct case_info *info);
/* Reads a case that was asked for; ERROR_ABSENT for any other number, such as a component's. *out
 * is the caller's to clear. */
int store_case(struct store *store, const char *study, uint64_t case_number, struct case_info *out,
               struct error *err);
/* Reads a case or a component likewise. */
int store_any_case(struct store *store, const char *study, uint64_t case_number,
                   struct case_info *out, struct error *err);
/* Calls visit for every stored block of a case, in the order of realisations, within one read
 * transaction. A non-zero return of visit stops and is returned. */
typedef int result_visit(void *context, const struct block_result *result, struct error *err);
int store_results(struct store *store, const char *study, uint64_t case_number, result_visit *visit,
                  void *context, struct error *err);
/* Replaces what is published of a case, for the views and for store_published. revision: that of
 * case_info when the case was read; one older than published is ignored. */
int store_publish(struct store *store, const char *study, uint64_t case_number, uint64_t revision,
                  const struct case_result *result, struct error *err);
/* The values of single realisations at a point of a curve, for the view realisation_points. */
struct point_texts {
    const void *context;
    /* Makes a JSON array of numbers, from realisation 0 on, null where there is none; the caller
     * frees it. NULL, and 0, where the values of single realisations are not kept. */
    int (*make)(const void *context, const struct curve *curve, size_t at, char **out,
                struct error *err);
};
/* Publishes as store_publish does, with these texts. */
int store_publish_points(struct store *store, const char *study, uint64_t case_number,
                         uint64_t revision, const struct case_result *result,
                         const struct point_texts *points, struct error *err);
/* Reads what is published of a case at this revision, without its parameters. *found: something is
 * published and undamaged. *out is untouched where nothing is found, and on failure. */
struct published_part {
    const char *quantity; /* curves of this quantity alone; NULL: of all */
    bool scalars_only;    /* without any curves */
    bool curves_only;     /* scalars and notes may be left out */
};
int store_published(struct store *store, const char *study, uint64_t case_number, uint64_t revision,
                    const struct published_part *part, struct case_result *out, bool *found,
                    struct error *err);
/* Reads the report of a case, without parameters, costs and counts of realisations: seconds are
 * shares of the case's. Not found where an older program published the case. */
int store_published_report(struct store *store, const char *study, uint64_t case_number,
                           uint64_t revision, struct case_report *out, bool *found,
                           struct error *err);

/* --- what is due --- */
/* A case is due when its jobs have ended (done, failed or cancelled), it has results, and these are
 * neither published nor marked as impossible to publish. Whoever opens a store for writing
 * publishes what is due, as another process may have ended before it did. */
struct due_case {
    char study[STUDY_ID_SIZE];
    uint64_t case_number, revision;
};
/* Returns true, once, with the published case that this handle found damaged in the last reading,
 * and reported as not found. It is to be merged again. */
bool store_found_damage(struct store *store, struct due_case *out);
/* Makes such a case due again. */
int store_unpublish(struct store *store, const struct due_case *damaged, struct error *err);
/* Sets *due to whether any case is due. */
int store_is_due(struct store *store, bool *due, struct error *err);
struct publication {
    /* Reads and merges what publish then writes. Cases are prepared one after the other, outside of
     * any change, until that took some hundredths of a second or there are 64, and published in one
     * change. number is that of the case in this group. After an error, the case is not published.
     * NULL: cases are published one by one. */
    int (*prepare)(void *context, struct store *store, const struct due_case *due, size_t number,
                   struct error *err);
    /* Publishes one case by store_publish. ERROR_INPUT and ERROR_NUMERIC, of either call, mark the
     * case; after any other error, which may pass, it stays due. */
    int (*publish)(void *context, struct store *store, const struct due_case *due, size_t number,
                   struct error *err);
    void (*clear)(void *context); /* called after each group; may be NULL */
    bool (*stop)(void *context);  /* called before each case; may be NULL */
    void *context;
};
enum { PUBLICATION_GROUP = 64 };
/* Returns whether a case's stored results are at fault: another try would fail, too, but other
 * cases may be readable. */
static inline bool publish_is_final(int status) {
    return status == ERROR_INPUT || status == ERROR_NUMERIC;
}

struct publish_counts {
    uint64_t published, failed;
    uint64_t postponed;  /* cases that stay due */
    struct error reason; /* of the last one postponed */
};
/* Offers each case that is due once, in the order of studies. ERROR_STOPPED when stop
 * says so. */
int store_publish_due(struct store *store, const struct publication *publication,
                      struct publish_counts *counts, struct error *err);
/* The cost of a case, for its report. */
struct case_cost {
    uint64_t case_number, realisations_done, realisations, jobs, attempts;
    struct work_time time; /* of completed jobs */
};
int store_cost(struct store *store, const char *study, uint64_t case_number, struct case_cost *out,
               struct error *err);

/* --- cases that ask for an error --- */
/* A component: a case of its own, from which the answer of another one is computed. */
struct component {
    uint64_t number;
    char *role;             /* owned */
    uint64_t realisations;  /* asked for so far */
    struct study_cost cost; /* of a realisation, as estimated: seconds and result_bytes alone */
    uint64_t block;         /* most realisations of a job */
};
/* Reads the components of a case in the order of their numbers; *count is 0 for a case without. */
int store_components(struct store *store, const char *study, uint64_t case_number,
                     struct component **out, size_t *count, struct error *err);
void components_free(struct component *components, size_t count);
/* The plan that a round ends with. */
struct next_round {
    uint64_t revision;      /* of the case when it was planned */
    double error_reached;   /* NaN: not known */
    const uint64_t *wanted; /* realisations of each component in all; none decreases */
};
/* Queues, once, the realisations that are missing to these numbers; *grown: some are left to run.
 * Does nothing where the case has changed since it was planned, or its study was cancelled. */
int store_grow(struct store *store, const char *study, uint64_t case_number,
               const struct next_round *next, bool *grown, struct error *err);

/* --- upkeep --- */
/* Copies the store as it is at one moment into the empty file of a part, which the caller publishes
 * or removes; others may change the store meanwhile. stop (may be NULL) is called repeatedly; then
 * ERROR_STOPPED. */
struct part_file;
int store_copy(struct store *store, const struct part_file *part, bool (*stop)(void *context),
               void *context, struct error *err);
/* Returns ERROR_SYSTEM where an open file of so many bytes is, by its header, no whole database of
 * Rugo of any version: what a stranger sent. */
int store_file_check(int file, uint64_t size, struct error *err);
/* Copies the store to a new file, which appears when it is complete and on the disk. */
int store_snapshot(struct store *store, const char *path, bool (*stop)(void *context),
                   void *context, struct error *err);
/* A worker and a job that it holds; or a worker that holds none, and ended one within the last
 * hour. */
struct worker_activity {
    char *name, *host;        /* owned, as all texts here */
    char *study, *study_name; /* "" without a job */
    uint64_t case_number;     /* of a component: the case that it belongs to */
    int64_t job;              /* 0: none */
    uint64_t count, done;     /* realisations of the job, and those that it reported */
    double part;              /* that it reported of the next one, below 1 */
    char *claimed;            /* UTC, ISO 8601; "" without a job */
    uint64_t recent_jobs;     /* all that it ended in the last hour */
    char *last_ended;         /* UTC; "": none in the last hour */
};
/* Lists at most 1000 workers, by name. */
int store_workers(struct store *store, struct worker_activity **out, size_t *count,
                  struct error *err);
void workers_free(struct worker_activity *workers, size_t count);

struct store_metrics {
    uint64_t studies, jobs_waiting, jobs_running, jobs_done, jobs_failed, jobs_cancelled;
    uint64_t wal_bytes, database_bytes;
};
int store_metrics(struct store *store, struct store_metrics *out, struct error *err);

#endif
