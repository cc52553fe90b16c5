/* Which source of jobs a worker uses, and as whom. */
#ifndef RUGO_WORKER_SOURCE_OPTIONS_H
#define RUGO_WORKER_SOURCE_OPTIONS_H

#include <stdint.h>

struct source_options {
    const char *database; /* exactly one of database and url is set */
    const char *url;
    const char *token;
    const char *study; /* claims jobs of this study only; NULL: of any (store only) */
    const char *worker, *host;
    int64_t lease_ms; /* of jobs claimed here (store only); 0: the store's default */
};

#endif
