/* Starting other programs, without a shell. */
#ifndef RUGO_SERVER_CHILD_H
#define RUGO_SERVER_CHILD_H

#include <sys/types.h>

/* Starts a program, found in PATH unless it has a slash; arguments end with NULL, and the first one
 * is its name. files are its standard input, output and errors, -1 for none; it has no others. No
 * signal is blocked or ignored in it, and no Ctrl-C reaches it. 0, or a number of errno. */
int child_start(const char *program, const char *const *arguments, const int files[3],
                pid_t *child);
/* Waits for its end; state as waitpid has it. 0, or a number of errno. */
int child_wait(pid_t child, int *state);

#endif
