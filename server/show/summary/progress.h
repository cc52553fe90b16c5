/* Progress of a study on standard error: a bar on a terminal, a line now and then elsewhere. */
#ifndef RUGO_SERVER_SHOW_SUMMARY_PROGRESS_H
#define RUGO_SERVER_SHOW_SUMMARY_PROGRESS_H

#include "schema/store/store.h"
#include <cjson/cJSON.h>

/* A bar, or lines, of one study; initialise to {0}. */
struct progress_bar {
    const char *command; /* for lines, as all texts borrowed */
    int64_t next_ms;     /* when the next one is due; 0 at first */
    int64_t start_ms;
    double share, total; /* the most that was shown, of so many realisations */
    bool next_round;     /* there are more realisations than at first */
    bool shown;          /* a bar stands on the line */
};
/* Whether a line or the bar is due, so that it is worth asking how far the study is. */
bool progress_is_due(const struct progress_bar *bar);
/* Draws the bar, or prints a line. share: of the work, 0 to 1; seconds_left: NaN where it is not
 * known. The share that is shown never falls, but where there is more to do: a target's next round,
 * which is named. */
struct progress_state {
    const char *study;
    double share, seconds_left;
    double done, total; /* realisations; done has parts of those at work */
};
void progress_draw(struct progress_bar *bar, const struct progress_state *state);
/* Ends the bar's line. */
void progress_end(struct progress_bar *bar);

/* The progress of a study of a local store. */
struct study_progress {
    struct store *store; /* borrowed */
    const char *study;   /* borrowed */
    struct progress_bar bar;
};
/* Draws it when it is due, as worker_options.tick; context is a struct study_progress. */
int progress_tick(void *context);
/* Draws a document of progress, when it is due. */
void progress_of_document(struct progress_bar *bar, const cJSON *progress);

#endif
