#include "core/file/memory_file.h"
#include <errno.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <sys/types.h>

enum { ROOM_LEAST = 1024 };

/* Allocates this many bytes and a NUL; returns false when out of memory. */
static bool reserve(struct memory_file *memory, size_t size) {
    size_t room = memory->room < ROOM_LEAST ? ROOM_LEAST : memory->room;
    while (room <= size && room <= SIZE_MAX / 2)
        room *= 2;
    if (room == memory->room)
        return true;
    char *text = room > size ? realloc(memory->text, room) : NULL;
    if (text == NULL)
        return false;
    memory->text = text;
    memory->room = room;
    return true;
}

static ssize_t take(void *context, const char *bytes, size_t size) {
    struct memory_file *memory = context;
    memory->failed = memory->failed || size > SIZE_MAX / 2 - memory->size ||
                     !reserve(memory, memory->size + size);
    if (memory->failed) {
        errno = ENOMEM;
        return 0;
    }
    memcpy(memory->text + memory->size, bytes, size);
    memory->size += size;
    memory->text[memory->size] = 0;
    return (ssize_t)size;
}

bool memory_file_open(struct memory_file *memory) {
    *memory = (struct memory_file){0};
    if (!reserve(memory, 0))
        return false;
    *memory->text = 0;
    memory->file = fopencookie(memory, "w", (cookie_io_functions_t){.write = take});
    if (memory->file == NULL)
        free(memory->text);
    else
        setvbuf(memory->file, memory->buffer, _IOFBF, sizeof memory->buffer);
    return memory->file != NULL;
}

char *memory_file_close(struct memory_file *memory, size_t *size) {
    if (memory->file == NULL)
        return NULL;
    bool failed = ferror(memory->file) != 0;
    failed = fclose(memory->file) != 0 || failed || memory->failed;
    if (failed)
        free(memory->text);
    else if (size != NULL)
        *size = memory->size;
    return failed ? NULL : memory->text;
}
