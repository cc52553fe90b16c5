/* A file that replaces what stands at its path when it is whole.
 *
 * It is written beside it, as PATH.rugo-part, and takes the path when it is closed. So a full disk,
 * an error or a kill leaves what stood there; a part that a kill left is written over by the next
 * file of that path. A replaced file keeps its mode.
 *
 * It is written in place where nothing can be replaced: what is no regular file (a pipe, a device,
 * a link), has several names or another owner, or lies in a folder that takes no such part. */
#ifndef RUGO_CORE_WRITTEN_FILE_H
#define RUGO_CORE_WRITTEN_FILE_H

#include "core/error.h"
#include <stdio.h>

struct written_file {
    FILE *stream; /* to write to, and not to close; it remembers a failure */
    char *path;   /* owned */
    char *part;   /* owned; NULL: the stream writes in place */
};
/* Opens a file for writing; ERROR_SYSTEM with its path and the reason. written_file_close() is for
 * files that were opened. */
int written_file_open(struct written_file *file, const char *path, struct error *err);
/* Closes the file, and puts it at its path where status is 0 and all was written. Returns the
 * status of what was written, or ERROR_SYSTEM of the file, which may be full; *file is empty
 * then. */
int written_file_close(struct written_file *file, int status, struct error *err);

#endif
