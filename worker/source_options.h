/* Which source of jobs a worker uses, and as whom. */
#ifndef RUGO_WORKER_SOURCE_OPTIONS_H
#define RUGO_WORKER_SOURCE_OPTIONS_H

#include "worker/client_trust.h"
#include <stdint.h>

struct checker;
struct source_options {
    const char *database; /* exactly one of database and url is set */
    const char *url;
    const char *token;
    const char *study; /* claims jobs of this study only; NULL: of any (store only) */
    const char *worker, *host;
    int64_t lease_ms; /* of jobs claimed here (store only); 0: the store's default */
    /* Most time between two reports of how far a job is; 0: 5 s. A third of the lease is the most
     * in any case. */
    int64_t report_ms;
    struct client_trust trust; /* in the server; its texts are borrowed */
    struct checker *checker;   /* of results, before they are stored (store only); NULL: its own */
};

#endif
