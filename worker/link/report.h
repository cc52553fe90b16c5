/* What a worker asks of a source of jobs when it claims, and its reports with their answers. */
#ifndef RUGO_WORKER_LINK_REPORT_H
#define RUGO_WORKER_LINK_REPORT_H

#include "schema/result/block_result.h"
#include "schema/store/store.h"
#include <stddef.h>

/* The jobs to be claimed (as in struct claim of store.h). */
struct wish {
    size_t count; /* at most */
    double seconds;
    unsigned threads;
    /* A server may let the claim wait for a job, at most so long; a store does not. */
    unsigned wait_s;
    int (*stop)(void *context); /* called meanwhile: non-zero ends it with ERROR_STOPPED */
    void *context;
};

enum report_verb { REPORT_HEARTBEAT, REPORT_COMPLETE, REPORT_FAIL, REPORT_RELEASE };
/* A worker's report on a job, and its answer. */
struct report {
    enum report_verb verb;
    bool permanent;                    /* of REPORT_FAIL: another try would fail, too */
    const struct claimed_job *job;     /* borrowed, as all below */
    double done;                       /* of a heartbeat: realisations so far, with a part of one */
    const struct block_result *result; /* of REPORT_COMPLETE */
    const char *reason;                /* of REPORT_FAIL */
    /* The answer, with the codes of source.h. */
    int status;
    struct error err;
};

/* How a job ended. */
struct job_end {
    enum report_verb verb;
    struct block_result result; /* of REPORT_COMPLETE; may have fewer realisations than the job */
    struct error reason;        /* of REPORT_FAIL; ERROR_INPUT: for good */
};

#endif
