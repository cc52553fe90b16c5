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
    /* Whether a call may do without the memory: 0 although an allocation failed. */
    int may_succeed;
};

/* Fails each allocation of the call alone, and then each with all behind it. After each: an error
 * with a text, no leak, and the same call succeeds. Where there are many, a few hundred spread over
 * all of them, or with RUGO_FAULTS=all each. Fails the test. */
void each_allocation(const struct failing_call *call);

#endif
