/* Files that commands read whole. */
#ifndef RUGO_SERVER_COMMAND_INPUT_FILE_H
#define RUGO_SERVER_COMMAND_INPUT_FILE_H

#include "core/error.h"
#include <stddef.h>

/* Returns the path as messages name it: "-" is standard input. */
const char *input_file_name(const char *path);
/* Reads the file's bytes and puts a NUL behind them; "-" is standard input. The caller frees. */
int input_file_read(const char *path, size_t limit, char **text, size_t *size, struct error *err);

#endif
