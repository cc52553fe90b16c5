/* One worker thread: claims a job, runs it, tells how it ended, until told to end. Private to
 * worker/.
 *
 *     claim -> hold its lease -> runner of its case -> run -> complete
 *                                                         -> fail      (with its reason)
 *                                                         -> release   (told to end)
 *                                                         -> nothing   (lease lost, study
 * cancelled) */
#ifndef RUGO_WORKER_HAND_H
#define RUGO_WORKER_HAND_H

#include "worker/crew.h"

/* One worker thread. */
struct hand {
    struct crew *crew;
    unsigned slot; /* its number, and its slot of the keeper */
    pthread_t thread;
    char name[NAME_MOST + 16];
    struct source *source;
    /* The runner of the last job, good for all jobs of the same case: transforms are planned and
     * matrices factored once a case. NULL: none. */
    struct job_runner *runner;
    struct shared_part *part; /* what it borrows; NULL: nothing */
    const struct job_kind *kind;
    char study[STUDY_ID_SIZE];
    uint64_t case_number;
};

/* The thread's body; context is its struct hand, with crew, slot, name and source filled in. */
void *hand_main(void *context);

#endif
