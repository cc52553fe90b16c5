/* Runs another program to its end within limits of time, memory and files, in a process group of
 * its own, which is killed with it: whatever it started and left there does not outlive it, nor the
 * process that called. */
#ifndef RUGO_SERVER_BOUNDED_PROGRAM_H
#define RUGO_SERVER_BOUNDED_PROGRAM_H

#include "core/error.h"
#include <stdint.h>

struct bounded_program {                 /* borrows */
    const char *const *arguments;        /* the first is its name, found in PATH; ended by NULL */
    const char *const *environment;      /* all that it has, "NAME=value"; ended by NULL */
    const char *folder;                  /* where it works */
    const char *output;                  /* file in the folder that gets what it prints */
    uint64_t memory_bytes;               /* of the address space of each of its processes */
    uint64_t file_bytes;                 /* of each file that they write */
    unsigned seconds;                    /* until it has to be done, by the clock */
    void (*abandon)(const char *folder); /* called where this process dies first, in one that was
                                            forked from it, after the program was killed */
};
enum bounded_end {
    BOUNDED_EXITED, /* by itself: `code` is its exit status */
    BOUNDED_KILLED, /* by the signal `code`, which limits send too */
    BOUNDED_LATE,
    BOUNDED_ABSENT /* it could not be started: `code` is a number of errno */
};
/* Runs it. Limits are no higher than those of this process. ERROR_SYSTEM where no process can be
 * made. */
int bounded_program_run(const struct bounded_program *program, enum bounded_end *end, int *code,
                        struct error *err);

#endif
