/* Files and folders that are written, with errors that name them. */
#ifndef RUGO_CORE_FILE_H
#define RUGO_CORE_FILE_H

#include "core/error.h"
#include <stdbool.h>
#include <stdio.h>

/* Opens a file for writing. ERROR_SYSTEM with the path and the reason, as of all below. */
int file_open(FILE **file, const char *path, struct error *err);
/* Closes the file, and returns the status of what was written, or that of the file, which may be
 * full. */
int file_close(FILE *file, const char *path, int status, struct error *err);
/* Makes a folder if it is missing. */
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
