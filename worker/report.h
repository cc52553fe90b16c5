/* What a worker tells of its jobs, and what became of that. */
#ifndef RUGO_WORKER_REPORT_H
#define RUGO_WORKER_REPORT_H

#include "schema/result/block_result.h"
#include "schema/store/store.h"

enum report_verb { REPORT_HEARTBEAT, REPORT_COMPLETE, REPORT_FAIL, REPORT_RELEASE };
struct report {
    enum report_verb verb;
    bool permanent;                    /* of REPORT_FAIL: trying again will not help */
    const struct claimed_job *job;     /* borrowed, as all below */
    uint64_t done;                     /* of a heartbeat: realisations so far */
    const struct block_result *result; /* of REPORT_COMPLETE */
    const char *reason;                /* of REPORT_FAIL */
    /* The answer, with the codes of source.h. */
    int status;
    struct error err;
};

/* How a job ended. */
struct job_end {
    enum report_verb verb;
    struct block_result result; /* of REPORT_COMPLETE; fewer realisations than the job's are kept */
    struct error reason;        /* of REPORT_FAIL; ERROR_INPUT: for good */
};

#endif
