/* A library to preload, which lets writes to files and their synchronisation fail as a test says
 * while the program runs: RUGO_FAIL_WRITES names a file of one struct failing_writes, mapped by
 * both. */
#ifndef RUGO_TESTS_SUPPORT_FAILING_WRITES_H
#define RUGO_TESTS_SUPPORT_FAILING_WRITES_H

#include <stdatomic.h>

struct failing_writes {
    atomic_uint per_million;   /* of the calls fail */
    atomic_int error;          /* errno of those */
    atomic_uint calls, failed; /* so far */
};

#endif
