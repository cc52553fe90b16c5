/* Files that hold secrets: keys and tokens. */
#ifndef RUGO_SERVER_COMMAND_SERVICE_SECRET_FILE_H
#define RUGO_SERVER_COMMAND_SERVICE_SECRET_FILE_H

#include "core/file/whole_file.h"
#include <stdbool.h>
#include <sys/stat.h>

enum { SECRET_BYTES_MOST = WHOLE_FILE_ROOM };

/* Reads a file of at most SECRET_BYTES_MOST bytes and puts a NUL behind them; "-" is standard
 * input. ERROR_INPUT where others may read it, unless it may be `open`. The caller wipes and frees
 * the text. */
int secret_file_read(const char *path, bool open, char **text, size_t *size, struct error *err);
/* ERROR_INPUT where others may read or write a regular file, or the group may and the file is this
 * user's own: one that the system lends to a service is root's, and the service's group may read
 * it. */
int secret_file_check(const char *path, const struct stat *file, struct error *err);
/* Puts a text in the place of a file in one step, with the owner and the mode of the one that is
 * there; where there is none it is made for its owner alone. */
int secret_file_replace(const char *path, const char *text, size_t size, struct error *err);
/* Makes a file that only its owner reads; ERROR_INPUT where there is one. */
int secret_file_write(const char *path, const char *text, size_t size, struct error *err);

#endif
