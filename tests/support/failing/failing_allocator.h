/* A hook behind every allocation of a program, those of its libraries too: malloc, calloc and
 * realloc are replaced at link time by ones that fail on request.
 *
 * FFTW ends the process where its planner gets no memory, so what it asks for itself is let through
 * (it asks by memalign, which is not replaced); fftw_malloc, which the program calls, is counted.
 * One count for all threads. */
#ifndef RUGO_TESTS_SUPPORT_FAILING_FAILING_ALLOCATOR_H
#define RUGO_TESTS_SUPPORT_FAILING_FAILING_ALLOCATOR_H

#include <stdint.h>

/* From now on allocation `first`, counted from 0, and those behind it fail, `most` of them. */
void failing_arm(uint64_t first, uint64_t most);

struct failing_count {
    uint64_t asked, failed; /* allocations since failing_arm */
};
struct failing_count failing_disarm(void);
/* Writes the stack of the first allocation that failed since failing_arm to stderr. */
void failing_where(void);

#endif
