#include "core/file/text_mark.h"
#include <stdint.h>
#include <stdlib.h>
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

static size_t put_utf8(char *to, uint32_t code) {
    if (code < 0x80) {
        to[0] = (char)code;
        return 1;
    }
    if (code < 0x800) {
        to[0] = (char)(0xc0 | code >> 6);
        to[1] = (char)(0x80 | (code & 0x3f));
        return 2;
    }
    to[0] = (char)(0xe0 | code >> 12);
    to[1] = (char)(0x80 | (code >> 6 & 0x3f));
    to[2] = (char)(0x80 | (code & 0x3f));
    return 3;
}

static int decode_utf16(struct unmarked_text *out, const char *data, size_t size, bool low_first,
                        struct error *err) {
    size_t used = 0, room = size / 2 * 3 + 1;
    char *text = malloc(room);
    if (text == NULL)
        return error_memory(err, room, "a text in UTF-16");
    for (size_t at = strlen(UTF16_LOW); at + 1 < size; at += 2) {
        unsigned char first = (unsigned char)data[at], second = (unsigned char)data[at + 1];
        uint32_t code =
            low_first ? (uint32_t)(second << 8 | first) : (uint32_t)(first << 8 | second);
        used += put_utf8(text + used, code >= 0xd800 && code < 0xe000 ? '?' : code);
    }
    text[used] = '\0';
    *out = (struct unmarked_text){text, used, text};
    return 0;
}

/* Returns whether bytes are a text whose lines end with CR alone. */
static bool has_old_ends(const char *text, size_t size) {
    return size > 0 && memchr(text, '\n', size) == NULL && memchr(text, '\r', size) != NULL &&
           memchr(text, 0, size) == NULL;
}

int unmarked_text_own(struct unmarked_text *text, struct error *err) {
    if (text->owned != NULL)
        return 0;
    char *copy = malloc(text->size + 1);
    if (copy == NULL)
        return error_memory(err, text->size + 1, "a text");
    if (text->size > 0)
        memcpy(copy, text->text, text->size);
    copy[text->size] = '\0';
    *text = (struct unmarked_text){copy, text->size, copy};
    return 0;
}

/* Ends lines with LF in place of CR. */
static int end_lines(struct unmarked_text *text, struct error *err) {
    int status = unmarked_text_own(text, err);
    for (size_t c = 0; status == 0 && c < text->size; c++)
        text->owned[c] = (char)(text->owned[c] == '\r' ? '\n' : text->owned[c]);
    return status;
}

int text_unmark(struct unmarked_text *out, const char *data, size_t size, struct error *err) {
    struct unmarked_text text = {0};
    bool low_first;
    int status = 0;
    if (text_mark_is_utf16(data, size, &low_first)) {
        status = decode_utf16(&text, data, size, low_first, err);
    } else {
        const size_t mark = text_mark_length(data, size);
        text = (struct unmarked_text){data + mark, size - mark, NULL};
    }
    if (status == 0 && has_old_ends(text.text, text.size))
        status = end_lines(&text, err);
    if (status == 0)
        *out = text;
    else
        unmarked_text_clear(&text);
    return status;
}

void unmarked_text_clear(struct unmarked_text *text) {
    free(text->owned);
    *text = (struct unmarked_text){0};
}
