/* Names of workers and their hosts, which lists and logs show. */
#ifndef RUGO_WORKER_WORKER_NAME_H
#define RUGO_WORKER_WORKER_NAME_H

#include <stdbool.h>

/* Returns whether a UTF-8 text has no control characters: terminals that show it would obey them.
 */
bool worker_name_is_plain(const char *name);

#endif
