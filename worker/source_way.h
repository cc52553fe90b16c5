/* The two ways to a job, behind source.h: source_store.c and source_server.c. Private to them. */
#ifndef RUGO_WORKER_SOURCE_WAY_H
#define RUGO_WORKER_SOURCE_WAY_H

#include "worker/source.h"

/* Each as its namesake of source.h; `way` is what create gave. */
struct source_way {
    int (*create)(void **way, const struct source_options *options, struct error *err);
    void (*destroy)(void *way); /* accepts NULL */
    int (*claim)(void *way, const struct claim *claim, struct claimed_job *job, int *found,
                 struct error *err);
    int (*heartbeat)(void *way, const struct claimed_job *job, uint64_t done, struct error *err);
    int (*complete)(void *way, const struct claimed_job *job, const struct job_kind *kind,
                    const struct job_result *result, struct error *err);
    int (*fail)(void *way, const struct claimed_job *job, const char *reason, int permanent,
                struct error *err);
    int (*release)(void *way, const struct claimed_job *job, struct error *err);
    int (*left)(void *way, int *left, struct error *err);
};
extern const struct source_way SOURCE_STORE, SOURCE_SERVER;

#endif
