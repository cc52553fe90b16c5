/* A store's files, copied and removed while nothing has them open. */
#ifndef RUGO_TESTS_SUPPORT_STORE_FILES_H
#define RUGO_TESTS_SUPPORT_STORE_FILES_H

#include "tests/support/check.h"
#include <stdio.h>

static inline void copy_file(const char *from, const char *to) {
    FILE *in = fopen(from, "rb"), *out = fopen(to, "wb");
    char buffer[65536];
    assert_non_null(in);
    assert_non_null(out);
    for (size_t got; (got = fread(buffer, 1, sizeof buffer, in)) > 0;)
        assert_int_equal(fwrite(buffer, 1, got, out), got);
    fclose(in);
    assert_int_equal(fclose(out), 0);
}

static inline void remove_store(const char *path) {
    static const char *const SUFFIXES[] = {"", "-wal", "-shm", "-journal"};
    for (size_t s = 0; s < sizeof SUFFIXES / sizeof *SUFFIXES; s++) {
        char name[256];
        snprintf(name, sizeof name, "%s%s", path, SUFFIXES[s]);
        remove(name);
    }
}

#endif
