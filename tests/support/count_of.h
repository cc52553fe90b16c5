/* How often a text stands in another. */
#ifndef RUGO_TESTS_SUPPORT_COUNT_OF_H
#define RUGO_TESTS_SUPPORT_COUNT_OF_H

#include <stddef.h>
#include <string.h>

static inline size_t count_of(const char *text, const char *part) {
    size_t count = 0;
    for (; (text = strstr(text, part)) != NULL; text += strlen(part))
        count++;
    return count;
}

#endif
