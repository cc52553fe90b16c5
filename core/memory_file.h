/* A file in memory to print a text into. Unlike that of open_memstream, which neither ferror nor
 * fclose tells of, a want of memory is never lost: the text is whole, or there is none. */
#ifndef RUGO_CORE_MEMORY_FILE_H
#define RUGO_CORE_MEMORY_FILE_H

#include <stdbool.h>
#include <stdio.h>

struct memory_file {
    FILE *file; /* to print into */
    char *text; /* owned, as all below */
    size_t size, room;
    bool failed;
    char buffer[4096]; /* of the file: a large one of its own would be one more thing to fail */
};
/* False when out of memory: nothing to close then. The struct must stay where it is until closed.
 */
bool memory_file_open(struct memory_file *memory);
/* The text, NUL-terminated, which the caller frees, and its size (NULL: not wanted); NULL when it
 * was out of memory. */
char *memory_file_close(struct memory_file *memory, size_t *size);

#endif
