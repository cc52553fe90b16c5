/* Names of copies that are kept: by the time in UTC, and new. */
#ifndef RUGO_SERVER_COMMAND_SERVICE_KEPT_NAME_H
#define RUGO_SERVER_COMMAND_SERVICE_KEPT_NAME_H

#include "core/error.h"
#include <stdbool.h>

enum { KEPT_PATH_SIZE = 4200 };
/* Writes BEFORE20261126T190000ZAFTER or, where there is such a file, BEFORE20261126T190000Z-2AFTER
 * and so on. ERROR_INPUT where that is too long. */
int kept_name(char path[KEPT_PATH_SIZE], const char *before, const char *after, struct error *err);
/* Returns whether a name is one that kept_name writes with this before and after. */
bool kept_name_is(const char *name, const char *before, const char *after);

#endif
