/* One worker thread, which takes jobs, runs them and hands in how they ended, until its pool ends.
 * Private to worker/.
 *
 *     take -> runner of the case -> run -> complete  (with what is done, where the pool ends)
 *                                       -> fail      (with the reason)
 *                                       -> release   (the pool ends, and nothing is done)
 *                                       -> nothing   (the lease is lost or the study cancelled) */
#ifndef RUGO_WORKER_WORKER_THREAD_H
#define RUGO_WORKER_WORKER_THREAD_H

#include "worker/worker_pool.h"

struct worker_thread {
    struct worker_pool *pool; /* borrowed */
    unsigned number;
    pthread_t handle;
    char name[NAME_MOST + 16];
    struct lease *lease; /* the job that it runs; NULL: none */
    /* The runner of the last job, or NULL. It is kept because all jobs of a case use the same
     * Fourier transform plans and matrix factorisations. */
    struct job_runner *runner;
    struct shared_part *part; /* what the runner borrows; NULL: nothing */
    /* The kind, study and case of the runner. */
    const struct job_kind *kind;
    char study[STUDY_ID_SIZE];
    uint64_t case_number;
};

/* The thread's body; context is a struct worker_thread with pool, number and name set. */
void *worker_thread_main(void *context);

#endif
