/* How many files have a name that fits a pattern of the shell. */
#ifndef RUGO_TESTS_SUPPORT_COUNT_FILES_H
#define RUGO_TESTS_SUPPORT_COUNT_FILES_H

#include <glob.h>
#include <stddef.h>

static inline size_t count_files(const char *pattern) {
    glob_t found;
    size_t count = glob(pattern, 0, NULL, &found) == 0 ? found.gl_pathc : 0;
    if (count > 0)
        globfree(&found);
    return count;
}

#endif
