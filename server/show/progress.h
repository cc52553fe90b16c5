/* Progress of a study on standard error: a bar on a terminal, a line now and then elsewhere. */
#ifndef RUGO_SERVER_SHOW_PROGRESS_H
#define RUGO_SERVER_SHOW_PROGRESS_H

#include "schema/store/store.h"

struct study_progress {
    struct store *store; /* borrowed */
    const char *study;   /* borrowed */
    int64_t next_ms;     /* when the next line is due; 0 at first */
    int64_t start_ms;
    uint64_t start_done; /* realisations when it began: time left is measured from there */
    double estimate;     /* seconds left at estimate_ms; the store's changes as jobs end */
    int64_t estimate_ms;
    bool shown;
};
/* Draws the bar, as worker_options.tick; context is a struct study_progress. */
int progress_tick(void *context);
/* Finishes the bar's line. */
void progress_end(struct study_progress *progress);

#endif
