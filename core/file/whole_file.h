/* Files that are read whole. */
#ifndef RUGO_CORE_WHOLE_FILE_H
#define RUGO_CORE_WHOLE_FILE_H

#include "core/error.h"

/* What fits into this is read into one buffer: wiping the text leaves no copy of it in memory. */
enum { WHOLE_FILE_ROOM = 1 << 20 };

/* Reads the bytes of a file and puts a NUL behind them; the caller frees. ERROR_INPUT where there
 * is no such file, or it has more than `most` bytes. */
int whole_file_read(const char *path, size_t most, char **text, size_t *size, struct error *err);
/* Likewise from where an open file is; messages call it `name`. */
int whole_file_take(int file, const char *name, size_t most, char **text, size_t *size,
                    struct error *err);

#endif
