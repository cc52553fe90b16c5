/* What a source of jobs must implement. There are two: source_store.c and source_server.c. Private
 * to worker/source*.c. */
#ifndef RUGO_WORKER_SOURCE_BACKEND_H
#define RUGO_WORKER_SOURCE_BACKEND_H

#include "schema/store/store.h"
#include "worker/source_options.h"

/* Each function does what the source_* function of its name does (source.h); self is what create
 * made. */
struct source_backend {
    int (*create)(void **self, const struct source_options *options, struct error *err);
    void (*destroy)(void *self); /* accepts NULL */
    int (*claim)(void *self, const struct claim *claim, struct claimed_job *job, int *found,
                 struct error *err);
    int (*heartbeat)(void *self, const struct claimed_job *job, uint64_t done, struct error *err);
    int (*complete)(void *self, const struct claimed_job *job, const struct block_result *result,
                    struct error *err);
    int (*fail)(void *self, const struct claimed_job *job, const char *reason, int permanent,
                struct error *err);
    int (*release)(void *self, const struct claimed_job *job, struct error *err);
    int (*left)(void *self, int *left, struct error *err);
};
extern const struct source_backend SOURCE_STORE, SOURCE_SERVER;

#endif
