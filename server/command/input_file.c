#include "server/command/input_file.h"
#include "core/file/whole_file.h"
#include <string.h>
#include <unistd.h>

const char *input_file_name(const char *path) {
    return strcmp(path, "-") == 0 ? "standard input" : path;
}

int input_file_read(const char *path, size_t limit, char **text, size_t *size, struct error *err) {
    return strcmp(path, "-") == 0
               ? whole_file_take(STDIN_FILENO, input_file_name(path), limit, text, size, err)
               : whole_file_read(path, limit, text, size, err);
}
