#include "core/file/text_mark.h"
#include <string.h>

/* The code point U+FEFF (RFC 3629, RFC 2781). */
static const char UTF8[] = "\xef\xbb\xbf", UTF16_LOW[] = "\xff\xfe", UTF16_HIGH[] = "\xfe\xff";

static bool begins(const char *text, size_t size, const char *mark) {
    size_t length = strlen(mark);
    return size >= length && memcmp(text, mark, length) == 0;
}

size_t text_mark_length(const char *text, size_t size) {
    return begins(text, size, UTF8) ? strlen(UTF8) : 0;
}

bool text_mark_is_utf16(const char *text, size_t size, bool *low_first) {
    bool low = begins(text, size, UTF16_LOW);
    if (low_first != NULL)
        *low_first = low;
    return low || begins(text, size, UTF16_HIGH);
}
