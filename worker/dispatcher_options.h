/* How a process takes jobs. */
#ifndef RUGO_WORKER_DISPATCHER_OPTIONS_H
#define RUGO_WORKER_DISPATCHER_OPTIONS_H

#include "worker/source_options.h"
#include <stdbool.h>

struct dispatcher_options {
    const struct source_options *source; /* borrowed, as its texts, until the end */
    unsigned threads;                    /* that take jobs */
    bool drain;                          /* nothing is offered once no job waits or runs anywhere */
};

#endif
