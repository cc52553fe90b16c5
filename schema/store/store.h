/* The store: studies, the queue of jobs with leases, partial results, published curves, in one
 * SQLite file. The only code that speaks SQL. schema/README.md draws the states and documents the
 * views.
 *
 * One handle belongs to one thread at a time. Every state change is one transaction
 * (BEGIN IMMEDIATE), or a savepoint within store_begin .. store_commit (group commit). Waiting for
 * another process's lock is polite and bounded; then ERROR_SYSTEM "the database is busy".
 *
 * A handle whose file was moved, deleted or replaced commits nothing: ERROR_SYSTEM, until the file
 * is back.
 *
 * Leases run on CLOCK_BOOTTIME, not on the wall clock, and are void after a reboot. */
#ifndef RUGO_SCHEMA_STORE_STORE_H
#define RUGO_SCHEMA_STORE_STORE_H

#include "schema/program.h"
#include "schema/result/block_result.h"
#include "schema/result/report.h"
#include "schema/result/work_time.h"
#include "schema/study/study.h"
#include <stdbool.h>

enum { STUDY_ID_SIZE = 17, TOKEN_SIZE = 33, ATTEMPTS_MOST = 3, LOSSES_MOST = 10, OWNER_SIZE = 41 };

struct store;
struct store_options {
    bool read_only;                   /* ERROR_ABSENT when the file does not exist */
    bool existing;                    /* do not create */
    int64_t lease_ms;                 /* 0: 60 000 */
    int64_t (*now_ms)(void *context); /* lease clock; NULL: CLOCK_BOOTTIME */
    void *context;
};
int store_open(struct store **out, const char *path, const struct store_options *options,
               struct error *err);
void store_close(struct store **store);
/* From now on whatever reads asks stop, again and again; non-zero ends it with ERROR_STOPPED. NULL:
 * nothing is asked. Not for a handle within a change. */
void store_set_stop(struct store *store, int (*stop)(void *context), void *context);

/* Group commit: everything between is one transaction, each operation still all or nothing.
 * store_commit fails as a whole: then nothing since store_begin happened. */
int store_begin(struct store *store, struct error *err);
int store_commit(struct store *store, struct error *err);
/* Undoes everything since store_begin. */
void store_abandon(struct store *store);
/* Writes what is there once more, to see whether writing works. */
int store_probe(struct store *store, struct error *err);

/* --- studies --- */
/* Queues a study with its jobs. Where another has fewer realisations and is the same but for its
 * name, its blocks are taken over, and only what they lack is queued. key (may be NULL): a second
 * submission with the same key and the same source gives the first one's id and *existing = true;
 * another source under it: ERROR_STATE.
 */
int store_submit(struct store *store, const struct study *study, const char *key,
                 char id[STUDY_ID_SIZE], bool *existing, struct error *err);

/* The id of the one study that `given` stands for: its id, the first digits of it, or its name.
 * ERROR_ABSENT where there is none; ERROR_INPUT, with a list of them, where there are several. */
int store_find(struct store *store, const char *given, char id[STUDY_ID_SIZE], struct error *err);

struct study_status {
    char id[STUDY_ID_SIZE];
    char *name, *kind; /* owned */
    const char *state; /* static: queued running done failed cancelled */
    enum study_random random;
    uint64_t seed, cases, realisations; /* realisations of each case; 0: an error is asked for */
    double error_reached;               /* the largest of the cases, relative; NaN: none is told */
    /* Those that wait, or were cancelled before they ran, as what is left is likely to be cut. */
    uint64_t jobs, jobs_done, jobs_failed, jobs_running, jobs_waiting, jobs_cancelled;
    uint64_t cases_failed; /* whose results cannot be published */
    uint64_t realisations_total, realisations_done,
        realisations_failed; /* done includes running jobs' reports */
    struct work_time time;   /* of completed jobs */
    double share;        /* of the work of its jobs, that is done: by time, not by realisations */
    double seconds_left; /* by the clock, with those who work now, and behind what is older where
                            none works on it yet; NaN where nobody works */
    uint64_t workers;    /* distinct workers with a live lease */
    uint64_t revision;   /* rises with every change of results or state */
    char *owner;         /* owned; "" for a study of nobody */
    int64_t priority;    /* among the studies of its owner */
    /* Of a queued study: its place among the queued, from 1 on (else 0), and when its first job
     * starts, as estimated, in seconds; NaN where that is not known: no worker is at work. */
    uint64_t place;
    double starts_in;
    char created[32], finished[32]; /* UTC, ISO 8601; "" if not yet */
    char program[PROGRAM_SIZE];     /* which queued it; "" where an older one did */
};
void study_status_clear(struct study_status *status);
int store_status(struct store *store, const char *id, struct study_status *out, struct error *err);
/* Who computed the study, when and where, as schema/result/provenance.h has it; the caller deletes
 * it. */
int store_provenance(struct store *store, const char *id, cJSON **out, struct error *err);
/* The document that was submitted, with the changes of --set; the caller deletes it. */
int store_document(struct store *store, const char *id, cJSON **out, struct error *err);
/* Up to limit studies created after study `after` ("" from the start), oldest first; frees by
 * study_status_clear each, then free. */
int store_list(struct store *store, const char *after, size_t limit, struct study_status **out,
               size_t *count, struct error *err);
int store_cancel(struct store *store, const char *id, struct error *err); /* ERROR_STATE if ended */
/* Failed and cancelled jobs wait again with fresh attempts, and so do the jobs of cases that could
 * not be published, whose results are given up: *count of them. */
int store_retry(struct store *store, const char *id, uint64_t *count, struct error *err);

/* Queues what a study lacks to this many realisations of each case, with what failed or was
 * cancelled: *jobs of them; none where it has as many. ERROR_STATE for fewer than it has, or
 * for results of another edition than this (study.h); ERROR_INPUT for one that asks for an error,
 * or above STUDY_REALISATIONS_MOST. */
int store_extend(struct store *store, const char *id, uint64_t realisations, uint64_t edition,
                 uint64_t *jobs, struct error *err);

/* Deletes a study that has ended, with all that is stored of it: nobody finds it from here on, and
 * store_purge gives its space back. ERROR_STATE before it has ended. */
int store_delete(struct store *store, const char *id, struct error *err);
/* Takes the rows of deleted studies out of the file, and then what pages are free, in short
 * transactions with pauses between them, so that others get on. Asks stop before each (may be
 * NULL): ERROR_STOPPED. What is left waits for the next call, of any process. A file that was made
 * before single pages could be given back is written anew as a whole where it is not large; else
 * its free pages are used again. */
int store_purge(struct store *store, bool (*stop)(void *context), void *context, struct error *err);

/* A job that failed, or a case that cannot be published. */
struct failure {
    int64_t job; /* 0: the case, with all realisations that it has */
    uint64_t case_number, first, count;
    uint64_t attempts;     /* that failed */
    uint64_t losses;       /* leases that ran out, as of workers that were killed */
    char *worker, *reason; /* owned */
};
int store_failures(struct store *store, const char *id, struct failure **out, size_t *count,
                   struct error *err);
void failures_free(struct failure *failures, size_t count);

/* Published cases none of whose realisations has a value on any curve, such as loads that none
 * reached. */
struct valueless {
    uint64_t cases, first; /* their count, and the number of the first one */
    char *note;            /* owned: its first note, "" without; NULL where there is no such case */
};
int store_valueless(struct store *store, const char *id, struct valueless *out, struct error *err);
void valueless_clear(struct valueless *valueless);

/* --- the queue --- */
struct claimed_job {
    int64_t id;
    char study[STUDY_ID_SIZE], token[TOKEN_SIZE]; /* token: the fence of this lease */
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
    /* Claims on until the jobs are thought to take so long; 0: count alone decides. */
    double seconds;
    unsigned threads; /* of the worker, among which it divides its jobs; 0: one */
    /* The worker is of a program that draws by the number of the case, whatever the sequence: it
     * may have studies of independent cases, or of one case, alone. */
    bool independent_only;
};
/* Hands out jobs. What waits is realisations; here they are cut into jobs: of 1000 or the kind's
 * most, of about 5 s as measured of the case or estimated, and smaller where few wait, so that each
 * thread seen (of workers that asked within two minutes) gets some of them. Of few small jobs a
 * claim has no more than its share of the threads, and one for each of its own.
 * Leases that ran out end first: each counts a loss, after which the job waits for a second, for
 * two, four and so on up to about a minute; at LOSSES_MOST it fails. So jobs may come by time
 * alone: who waits for one asks again. Owners take turns, so that each gets its share of the
 * workers' time; of an owner the study of highest priority is first, then the oldest. *count may be
 * 0. */
int store_claim(struct store *store, const struct claim *claim, struct claimed_job *jobs,
                size_t *count, struct error *err);
/* Sets *wait to whether a claim of any kind would find a job now. */
int store_jobs_wait(struct store *store, bool *wait, struct error *err);
/* Returns a number that rises with each change by this handle. */
int64_t store_changes(const struct store *store);
/* Returns whether the last claim failed a job for good, which may have left its case due. */
bool store_claim_failed_jobs(const struct store *store);
/* Sets the weight of an owner, above 0: its share of the workers' time beside those of others. It
 * is 1 unless set. */
int store_share(struct store *store, const char *owner, double weight, struct error *err);
/* Renews the lease; done: realisations so far. ERROR_STATE when the lease is lost or the study
 * cancelled (the text says which). */
int store_heartbeat(struct store *store, int64_t job, const char *token, uint64_t done,
                    struct error *err);

/* Names and scalars as they are stored. Whoever queues for the one writer makes them beforehand;
 * store_complete makes those of a result without. */
struct block_text {
    char *names, *scalars; /* owned */
    int64_t seal;          /* of the block with these (store_seal.h) */
};
int block_text_create(struct block_text *out, const struct block_result *result, struct error *err);
void block_text_clear(struct block_text *text);

/* Stores the result once. Completing again with the same token is harmless (0, *first_time false);
 * a lost lease is ERROR_STATE and its result dropped. *case_done: no job of the case is left.
 * A result of fewer realisations than the job, from its first one on, is stored for these; the
 * others wait again as if they had not been claimed, and the job is done. */
int store_complete(struct store *store, int64_t job, const char *token,
                   const struct block_result *result, bool *first_time, bool *case_done,
                   struct error *err);
/* The attempt failed: waits again, or fails for good after ATTEMPTS_MOST; reason kept. permanent:
 * fail at once. */
int store_fail(struct store *store, int64_t job, const char *token, const char *reason,
               bool permanent, struct error *err);
/* Hands a job back unharmed: the attempt does not count. */
int store_release(struct store *store, int64_t job, const char *token, struct error *err);
/* Study, case and expected block of a job under a live lease or done under this token (to check a
 * result before it is taken). */
int store_job(struct store *store, int64_t job, const char *token, struct claimed_job *out,
              struct error *err);

/* --- results --- */
struct case_info {
    cJSON *parameters; /* owned */
    uint64_t seed, realisations, realisations_done, revision;
};
void case_info_clear(struct case_info *info);
int store_case(struct store *store, const char *study, uint64_t case_number, struct case_info *out,
               struct error *err);
/* Calls visit for every stored block of a case, in realisation order, within one read transaction.
 * A non-zero return of visit stops and is returned. */
typedef int result_visit(void *context, const struct block_result *result, struct error *err);
int store_results(struct store *store, const char *study, uint64_t case_number, result_visit *visit,
                  void *context, struct error *err);
/* Replaces what is published of a case, for the views and for store_published. revision: of
 * case_info when it was read; an older one than published is ignored. */
int store_publish(struct store *store, const char *study, uint64_t case_number, uint64_t revision,
                  const struct case_result *result, struct error *err);
/* What single realisations have at a point of a curve, for the view realisation_points. */
struct point_texts {
    const void *context;
    /* Makes a JSON array of numbers, from realisation 0 on, null where there is none; the caller
     * frees it. NULL, and 0, where the values of single realisations are not kept. */
    int (*make)(const void *context, const struct curve *curve, size_t at, char **out,
                struct error *err);
};
/* store_publish, with these texts. */
int store_publish_points(struct store *store, const char *study, uint64_t case_number,
                         uint64_t revision, const struct case_result *result,
                         const struct point_texts *points, struct error *err);
/* What is published of a case at this revision, without its parameters. *found: whether anything
 * is, and not damaged; *out is untouched where nothing is, and on failure. */
struct published_part {
    const char *quantity; /* curves of this quantity alone; NULL: of all */
    bool scalars_only;    /* no curves at all */
};
int store_published(struct store *store, const char *study, uint64_t case_number, uint64_t revision,
                    const struct published_part *part, struct case_result *out, bool *found,
                    struct error *err);
/* Its report, without parameters, costs and counts of realisations: seconds are shares of the
 * case's. Not found where an older program published the case. */
int store_published_report(struct store *store, const char *study, uint64_t case_number,
                           uint64_t revision, struct case_report *out, bool *found,
                           struct error *err);

/* --- what is due --- */
/* A case is due when nothing of it is left to run (its jobs are done, failed or cancelled), it has
 * results, and these are neither published nor marked as impossible to publish. Whoever opens a
 * store for writing publishes what is due, as another process may have ended before it did. */
struct due_case {
    char study[STUDY_ID_SIZE];
    uint64_t case_number, revision;
};
/* Tells, once, of a published case that a reading with this handle found damaged and told as not
 * found, so that its results are merged anew. */
bool store_found_damage(struct store *store, struct due_case *out);
/* Has such a case published anew: it is due again. */
int store_unpublish(struct store *store, const struct due_case *damaged, struct error *err);
/* Sets *due to whether any case is due. */
int store_is_due(struct store *store, bool *due, struct error *err);
struct publication {
    /* Publishes one case by store_publish. ERROR_INPUT and ERROR_NUMERIC mark the case; any other
     * error may pass, and leaves it due. */
    int (*publish)(void *context, struct store *store, const struct due_case *due,
                   struct error *err);
    bool (*stop)(void *context); /* asked before each case; may be NULL */
    void *context;
};
struct publish_counts {
    uint64_t published, failed;
    uint64_t postponed;  /* cases that stay due */
    struct error reason; /* of the last one postponed */
};
/* Offers each case that is due to publish, once, in the order of studies. ERROR_STOPPED when told
 * to stop. */
int store_publish_due(struct store *store, const struct publication *publication,
                      struct publish_counts *counts, struct error *err);
/* The report tells this cost of a case. */
struct case_cost {
    uint64_t case_number, realisations_done, realisations, jobs, attempts;
    struct work_time time; /* of completed jobs */
};
int store_cost(struct store *store, const char *study, uint64_t case_number, struct case_cost *out,
               struct error *err);

/* --- cases that ask for an error --- */
/* A component: a case of its own, which takes part in the answer of another. */
struct component {
    uint64_t number;
    char *role;             /* owned */
    uint64_t realisations;  /* asked for so far */
    struct study_cost cost; /* of one, as estimated: seconds and result_bytes alone */
    uint64_t block;         /* realisations of a job at most */
};
/* In the order of their numbers; *count is 0 for a case without. */
int store_components(struct store *store, const char *study, uint64_t case_number,
                     struct component **out, size_t *count, struct error *err);
void components_free(struct component *components, size_t count);
/* What a round ends with. */
struct next_round {
    uint64_t revision;      /* of the case when it was planned */
    double error_reached;   /* NaN: none is told */
    const uint64_t *wanted; /* realisations of each component in all; none falls */
};
/* Queues what is missing to these, once: *grown tells whether anything is left to run. Where the
 * case has gone on since it was planned, or its study was cancelled, nothing changes. */
int store_grow(struct store *store, const char *study, uint64_t case_number,
               const struct next_round *next, bool *grown, struct error *err);

/* --- upkeep --- */
/* Copies the store as it is at one moment into the empty file of a part, which the caller publishes
 * or takes away; others may change the store meanwhile. stop (may be NULL) is asked all along; then
 * ERROR_STOPPED. */
struct part_file;
int store_copy(struct store *store, const struct part_file *part, bool (*stop)(void *context),
               void *context, struct error *err);
/* Copies it to a new file, which is there when it is whole and on the disk. */
int store_snapshot(struct store *store, const char *path, bool (*stop)(void *context),
                   void *context, struct error *err);
/* A worker and a job that it holds; or one that holds none, and ended one within the last hour. */
struct worker_activity {
    char *name, *host;        /* owned, as all texts here */
    char *study, *study_name; /* "" without a job */
    uint64_t case_number;     /* the one that was asked for */
    int64_t job;              /* 0: none */
    uint64_t count, done;     /* realisations of the job, and those that it reported */
    char *claimed;            /* UTC, ISO 8601; "" without a job */
    uint64_t recent_jobs;     /* ended by it in the last hour, all its jobs together */
    char *last_ended;         /* UTC; "": none in the last hour */
};
/* At most 1000 of them, by name. */
int store_workers(struct store *store, struct worker_activity **out, size_t *count,
                  struct error *err);
void workers_free(struct worker_activity *workers, size_t count);

struct store_metrics {
    uint64_t studies, jobs_waiting, jobs_running, jobs_done, jobs_failed, jobs_cancelled;
    uint64_t wal_bytes, database_bytes;
};
int store_metrics(struct store *store, struct store_metrics *out, struct error *err);

#endif
