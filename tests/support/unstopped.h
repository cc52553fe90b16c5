/* Work that is never asked to stop, and must succeed. */
#ifndef RUGO_TESTS_SUPPORT_UNSTOPPED_H
#define RUGO_TESTS_SUPPORT_UNSTOPPED_H

#include "core/error.h"
#include "tests/support/check.h"

static inline int go_on(void *context) {
    (void)context;
    return 0;
}

static inline void must(int status, const struct error *err) {
    if (status != 0)
        fail_msg("%s", err->text);
}

#endif
