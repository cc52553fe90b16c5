/* Runs this very program on bytes that nobody vouches for, such as a file that a peer sent: in a
 * process of its own, so that its memory and time are bounded, it ends when it is not wanted any
 * more, and what it does wrong harms nobody else. */
#ifndef RUGO_SERVER_HTTP_ROUTE_OWN_PROCESS_H
#define RUGO_SERVER_HTTP_ROUTE_OWN_PROCESS_H

#include "core/error.h"
#include <stdbool.h>
#include <stdint.h>

struct own_process {              /* borrows */
    const char *const *arguments; /* the first is the program's name; ended by NULL */
    const char *input;            /* its standard input */
    size_t input_size;
    uint64_t memory_bytes;      /* of its address space */
    unsigned cpu_seconds;       /* of its processor time */
    unsigned wait_seconds;      /* until it has to be done */
    size_t output_most;         /* bytes of its standard output */
    int (*stop)(void *context); /* asked several times a second: not 0 to end it */
    void *context;
};
enum own_process_end {
    OWN_PROCESS_DONE,    /* by itself: `status` is its exit status */
    OWN_PROCESS_STOPPED, /* as it was asked to */
    OWN_PROCESS_LATE,    /* it took too much time, of the processor or in all */
    OWN_PROCESS_LARGE,   /* it printed more than it may */
    OWN_PROCESS_BROKEN,  /* by a signal */
};
struct own_process_result {
    enum own_process_end end;
    int status;
    char *output; /* owned by the caller, NUL-terminated */
    size_t output_size;
    char said[512]; /* the begin of what it said on standard error, without the last newline */
};
/* Runs it to its end. ERROR_SYSTEM or ERROR_MEMORY where it could not be started or read. */
int own_process_run(const struct own_process *process, struct own_process_result *out,
                    struct error *err);

#endif
