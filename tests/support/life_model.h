/* The life of studies, cases and jobs as schema/README.md draws it, in plain C without SQL: what a
 * test compares the store with. A struct life may be copied: that is how a test undoes what was
 * never committed. Times are milliseconds of a clock that the test keeps. */
#ifndef RUGO_TESTS_SUPPORT_LIFE_MODEL_H
#define RUGO_TESTS_SUPPORT_LIFE_MODEL_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum { LIFE_STUDIES = 3, LIFE_CASES = 2, LIFE_BLOCK = 2, LIFE_LEASE_MS = 1000 };
/* A case has at most so many realisations, and no more rows of jobs. */
enum { LIFE_MOST = 5, LIFE_JOBS = LIFE_STUDIES * LIFE_CASES * LIFE_MOST };

enum life_state { LIFE_WAITING, LIFE_RUNNING, LIFE_DONE, LIFE_FAILED, LIFE_CANCELLED, LIFE_STATES };

/* A job; or a span of realisations that wait, or waited when they were cancelled. */
struct life_job {
    int study, case_number;
    int64_t first, count; /* realisations */
    int blocks;           /* jobs that it counts as */
    enum life_state state;
    int attempts, losses, worker; /* worker: of the last claim; 0: never claimed */
    int token;                    /* number of the last lease; 0: none */
    int64_t lease_until, not_before;
    char error[160]; /* of the last attempt that failed or was lost; "" none */
};

struct life_case {
    int64_t revision;        /* blocks that came in */
    int64_t settled;         /* revision that is published or marked */
    int64_t published;       /* revision that is published; 0: none */
    uint32_t published_jobs; /* those whose results it holds: bit j is job j of the life */
    bool marked;             /* cannot be published */
    bool poisoned;           /* its results cannot be merged by the program there is */
};

struct life_study {
    int cases;
    bool begun;     /* a job was claimed since it was queued */
    bool cancelled; /* and not retried since */
    struct life_case of[LIFE_CASES];
};

struct life {
    struct life_study studies[LIFE_STUDIES];
    struct life_job jobs[LIFE_JOBS]; /* job j has the number j + 1 in the store */
    int study_count, job_count;
};

/* Adds a study of so many cases, of so many realisations each. */
void life_submit(struct life *life, int cases, int realisations);
/* Expires leases. */
void life_expire(struct life *life, int64_t now_ms);
/* The row of which the next job is claimed: the first that may be in the oldest study; or -1. */
int life_next(const struct life *life, int64_t now_ms);
/* The most realisations that a claim may take off a row. */
int64_t life_block(const struct life_job *job);
/* Leases so many realisations off the front of a row: the index of the job. */
int life_lease(struct life *life, int job, int64_t count, int worker, int token, int64_t now_ms);
/* These return whether the store has to accept the change. token: of the lease that asks. count: of
 * the realisations that are done, from the first one on. */
bool life_complete(struct life *life, int job, int token, int64_t count, bool *again);
bool life_fail(struct life *life, int job, int token, const char *reason, bool permanent);
bool life_release(struct life *life, int job, int token);
bool life_heartbeat(struct life *life, int job, int token, int64_t now_ms);
bool life_cancel(struct life *life, int study);
/* Returns how many jobs wait again. */
int life_retry(struct life *life, int study);

bool life_is_due(const struct life *life, int study, int case_number);
/* The number of cases due. */
int life_due_count(const struct life *life);
/* Jobs of a case that are done, a bit each. */
uint32_t life_done_jobs(const struct life *life, int study, int case_number);
/* The results `jobs` that a case had at this revision are published. */
void life_publish(struct life *life, int study, int case_number, int64_t revision, uint32_t jobs);
/* The results of this revision cannot be published. */
void life_mark(struct life *life, int study, int case_number, int64_t revision);

/* Jobs of a study in this state, as they are counted. */
int life_count(const struct life *life, int study, enum life_state state);
/* Jobs of a case that have not ended. */
int life_left(const struct life *life, int study, int case_number);
int life_marks(const struct life *life, int study);
const char *life_study_state(const struct life *life, int study);
const char *life_case_state(const struct life *life, int study, int case_number);
extern const char *const LIFE_STATE_NAMES[LIFE_STATES];

#endif
