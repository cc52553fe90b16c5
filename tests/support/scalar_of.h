/* The scalar of a result that a test must find. */
#ifndef RUGO_TESTS_SUPPORT_SCALAR_OF_H
#define RUGO_TESTS_SUPPORT_SCALAR_OF_H

#include "schema/result/result.h"
#include "tests/support/check.h"

static inline const struct scalar *scalar_of(const struct case_result *result, const char *name) {
    const struct scalar *found = result_scalar(result, name);
    if (found == NULL)
        fail_msg("no scalar %s", name);
    return found;
}

#endif
