/* The loop "fail allocation n for n = 0, 1, 2 ... until the call passes". */
#ifndef RUGO_TESTS_SUPPORT_FAILING_EACH_ALLOCATION_H
#define RUGO_TESTS_SUPPORT_FAILING_EACH_ALLOCATION_H

#include "core/error.h"

struct failing_call {
    const char *name;
    /* Does the thing once, checks its result, and gives back all that it got: 0, or its error. */
    int (*run)(void *context, struct error *err);
    void *context;
    /* A code beside ERROR_MEMORY that the call may give for want of memory: 0, there is none. */
    int also;
    /* Whether the call, or a library within (the caches of SQLite), can do without some of its
     * memory: then it may succeed, and its result is as good. */
    int may_succeed;
};

/* Fails each allocation of the call alone, and then each with all behind it. After each: an error
 * with a text, no leak, and the same call succeeds. Where this would
 * take more than a second, as many as fit, spread over all: RUGO_EFFORT=n times as many, and each
 * with RUGO_FAULTS=all. Fails the test. */
void each_allocation(const struct failing_call *call);

#endif
