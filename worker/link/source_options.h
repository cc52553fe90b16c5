/* Which source of jobs a worker uses, and under which name. */
#ifndef RUGO_WORKER_LINK_SOURCE_OPTIONS_H
#define RUGO_WORKER_LINK_SOURCE_OPTIONS_H

#include "worker/link/client_trust.h"
#include <stdint.h>

struct checker;
struct source_options {
    const char *database; /* exactly one of database and url is set */
    const char *url;
    const char *token;
    const char *study; /* claims jobs of this study only; NULL: of any (store only) */
    const char *worker, *host;
    int64_t lease_ms; /* of jobs claimed here (store only); 0: the store's default */
    /* Most time between two reports of a job's progress; 0: 5 s. It is never more than a third of
     * the lease. */
    int64_t report_ms;
    struct client_trust trust; /* in the server; its texts are borrowed */
    struct checker *checker;   /* checks results before storing (store only); NULL: its own */
};

#endif
