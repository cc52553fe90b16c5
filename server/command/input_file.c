#include "server/command/input_file.h"
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

const char *input_file_name(const char *path) {
    return strcmp(path, "-") == 0 ? "standard input" : path;
}

/* Reads to the end of a stream; the buffer doubles. */
static int read_stream(FILE *file, const char *path, size_t limit, char **text, size_t *size,
                       struct error *err) {
    size_t room = 65536, used = 0;
    char *buffer = malloc(room + 1);
    while (buffer != NULL && used <= limit) {
        used += fread(buffer + used, 1, room - used, file);
        if (used < room)
            break;
        room *= 2;
        char *larger = realloc(buffer, room + 1);
        if (larger == NULL)
            free(buffer);
        buffer = larger;
    }
    if (buffer == NULL)
        return error_memory(err, room, path);
    if (ferror(file) != 0 || used > limit) {
        free(buffer);
        return used > limit ? error_set(err, ERROR_INPUT, "%s: larger than %zu bytes", path, limit)
                            : error_set(err, ERROR_SYSTEM, "%s: %s", path, strerror(errno));
    }
    buffer[used] = 0;
    *text = buffer;
    *size = used;
    return 0;
}

int input_file_read(const char *path, size_t limit, char **text, size_t *size, struct error *err) {
    if (strcmp(path, "-") == 0)
        return read_stream(stdin, input_file_name(path), limit, text, size, err);
    FILE *file = fopen(path, "rb");
    if (file == NULL)
        return error_set(err, errno == ENOENT ? ERROR_INPUT : ERROR_SYSTEM, "%s: %s", path,
                         strerror(errno));
    int status = read_stream(file, path, limit, text, size, err);
    fclose(file);
    return status;
}
