/* What a worker asks of a source of jobs when it claims. */
#ifndef RUGO_WORKER_WISH_H
#define RUGO_WORKER_WISH_H

#include <stddef.h>

/* The jobs to be claimed (store.h: struct claim). */
struct wish {
    size_t count; /* at most */
    double seconds;
    unsigned threads;
    /* A server may keep the claim waiting for a job, at most so long; a store does not. */
    unsigned wait_s;
    int (*stop)(void *context); /* asked meanwhile: non-zero ends it with ERROR_STOPPED */
    void *context;
};

#endif
