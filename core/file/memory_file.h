/* A file in memory to print a text into. With open_memstream neither ferror nor fclose reports a
 * lack of memory. Here it is never lost: the text is whole, or there is none. */
#ifndef RUGO_CORE_MEMORY_FILE_H
#define RUGO_CORE_MEMORY_FILE_H

#include <stdbool.h>
#include <stdio.h>

struct memory_file {
    FILE *file; /* to print into */
    char *text; /* owned, as all below */
    size_t size, room;
    bool failed;
    char buffer[4096]; /* of the file: allocating a larger one could fail, too */
};
/* Returns false when out of memory; then there is nothing to close. The struct must not move until
 * it is closed. */
bool memory_file_open(struct memory_file *memory);
/* The text, NUL-terminated, which the caller frees, and its size (NULL: not wanted); NULL when
 * memory was lacking, for the opening too. */
char *memory_file_close(struct memory_file *memory, size_t *size);

#endif
