/* The functions of a source of jobs. There are two sources: source_store.c and source_server.c.
 * Private to source*.c of this folder. */
#ifndef RUGO_WORKER_LINK_SOURCE_BACKEND_H
#define RUGO_WORKER_LINK_SOURCE_BACKEND_H

#include "schema/store/store.h"
#include "worker/link/report.h"
#include "worker/link/source_options.h"
#include <stdbool.h>

/* Each function does what the source_* function of its name does (source.h); self is what create
 * made. */
struct source_backend {
    int (*create)(void **self, const struct source_options *options, struct error *err);
    void (*destroy)(void *self); /* accepts NULL */
    int (*claim)(void *self, const struct claim *claim, const struct wish *wish,
                 struct claimed_job *jobs, size_t *count, bool *due, struct error *err);
    int (*report)(void *self, struct report *reports, size_t count, bool *due, struct error *err);
    const char *(*other_forms)(const void *self); /* NULL: always "" */
    int (*left)(void *self, int *left, bool *due, struct error *err);
};
extern const struct source_backend SOURCE_STORE, SOURCE_SERVER;

#endif
