#include "core/file/plain_text.h"
#include <stdbool.h>
#include <stdint.h>

size_t text_character(const char *text) {
    static const unsigned char LEAST_SECOND[5] = {[3] = 0xa0, [4] = 0x90};
    const unsigned char *s = (const unsigned char *)text;
    size_t length = s[0] < 0x80 ? 1 : s[0] < 0xc2 ? 0 : s[0] < 0xe0 ? 2 : s[0] < 0xf0 ? 3 : 4;
    for (size_t i = 1; i < length; i++)
        if ((s[i] & 0xc0) != 0x80)
            return 0;
    bool overlong = (s[0] == 0xe0 || s[0] == 0xf0) && s[1] < LEAST_SECOND[length];
    bool beyond = s[0] > 0xf4 || (s[0] == 0xf4 && s[1] > 0x8f) || (s[0] == 0xed && s[1] > 0x9f);
    return overlong || beyond ? 0 : length;
}

/* Returns the code point of a well-formed sequence. */
static uint32_t code_point(const char *text, size_t length) {
    static const unsigned char FIRST_BITS[5] = {[1] = 0x7f, [2] = 0x1f, [3] = 0x0f, [4] = 0x07};
    uint32_t point = (unsigned char)text[0] & FIRST_BITS[length];
    for (size_t i = 1; i < length; i++)
        point = point << 6 | ((unsigned char)text[i] & 0x3f);
    return point;
}

size_t text_shown(const char *text) {
    size_t length = text_character(text);
    uint32_t point = length > 0 ? code_point(text, length) : 0;
    bool control = point < ' ' || (point >= 0x7f && point < 0xa0);
    bool turns = (point >= 0x202a && point <= 0x202e) || (point >= 0x2066 && point <= 0x2069);
    return control || turns || point == 0xfffe || point == 0xffff ? 0 : length;
}

char *text_make_plain(char *text) {
    if (text == NULL)
        return NULL;
    for (char *at = text; *at != '\0';) {
        size_t length = text_shown(at);
        if (length == 0)
            *at = '?';
        at += length > 0 ? length : 1;
    }
    return text;
}

void text_print_plain(FILE *file, const char *text) {
    while (*text != '\0') {
        size_t length = text_shown(text);
        if (length > 0)
            fwrite(text, 1, length, file);
        else
            fputc('?', file);
        text += length > 0 ? length : 1;
    }
}
