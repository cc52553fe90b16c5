/* Programs beside this one, such as those of Slurm, run to their end without a shell. */
#ifndef RUGO_SERVER_COMMAND_TOOL_H
#define RUGO_SERVER_COMMAND_TOOL_H

#include "core/error.h"
#include <stdio.h>

/* Returns an empty file in memory, which another program can be given, or NULL. It needs no folder
 * for temporary files. */
FILE *tool_file(struct error *err);
/* Runs a program found in PATH; arguments end with NULL, and the first one is its name. *out is
 * what it printed, which the caller frees (NULL: not wanted). ERROR_SYSTEM where there is no such
 * program or it fails: with the end of what it said. Ctrl-C does not reach it. */
int tool_run(const char *const *arguments, char **out, struct error *err);
/* Likewise of one that reads an open file (-1: none) and writes into another one. */
int tool_convert(const char *const *arguments, int from, int to, struct error *err);

#endif
