/* Looking at a study again and again until it has ended. */
#ifndef RUGO_SERVER_COMMAND_STUDY_WATCH_H
#define RUGO_SERVER_COMMAND_STUDY_WATCH_H

#include "server/command/access/access.h"

enum { WATCH_MS = 500 }; /* between two looks */

/* Sleeps for WATCH_MS; false where a signal asked to stop (signals_catch). */
bool watch_pause(void);
/* Whether a study's progress says that it is done, failed or cancelled. */
bool watch_has_ended(const cJSON *progress);

/* Who looks. A server or store that does not answer after the first look is asked again. */
struct watch {
    const char *command; /* for messages, all borrowed */
    struct access *access;
    const char *id; /* of a study; NULL: the list of all */
    bool away;      /* the last look had no answer, which was reported; false at first */
};
/* Looks once: the progress, or the list, which the caller deletes; *out is NULL where nobody
 * answered and the next look may be answered. */
int watch_look(struct watch *watch, bool first, cJSON **out, struct error *err);

#endif
