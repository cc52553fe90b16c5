/* Folders that are made, and names of files. */
#ifndef RUGO_CORE_FILE_H
#define RUGO_CORE_FILE_H

#include "core/error.h"
#include <stdbool.h>

/* Makes a folder if it is missing. ERROR_SYSTEM with the path and the reason. */
int folder_make(const char *path, struct error *err);
/* Brings the name of a file to the disk, by its folder. What cannot be is left: some file systems
 * cannot do it, and the file is there. */
void file_sync_name(const char *path);
/* Returns the glob(7) pattern of paths that begin with this one, whose wildcards are escaped, and
 * go on as the ending says, itself a pattern; NULL when out of memory. The caller frees it. */
char *file_pattern(const char *path, const char *ending);
/* Returns whether there is a name before this ending, in letters of either case. */
bool file_ends_in(const char *path, const char *ending);

#endif
