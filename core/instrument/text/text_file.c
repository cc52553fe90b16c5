#include "core/instrument/text/text_file.h"
#include "core/file/text_mark.h"
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

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

/* Surrogate pairs of UTF-16, which no header needs, become '?' twice. */
static int decode_utf16(struct text_file *out, const char *data, size_t size, bool low_first,
                        struct error *err) {
    size_t used = 0, room = size / 2 * 3 + 1;
    out->owned = malloc(room);
    if (out->owned == NULL)
        return error_memory(err, room, "a text in UTF-16");
    for (size_t at = 2; at + 1 < size; at += 2) {
        unsigned char first = (unsigned char)data[at], second = (unsigned char)data[at + 1];
        uint32_t code =
            low_first ? (uint32_t)(second << 8 | first) : (uint32_t)(first << 8 | second);
        used += put_utf8(out->owned + used, code >= 0xd800 && code < 0xe000 ? '?' : code);
    }
    out->owned[used] = '\0';
    out->text = out->owned;
    out->size = used;
    return 0;
}

int text_file_open(struct text_file *out, const char *data, size_t size, struct error *err) {
    struct text_file file = {.text = data, .size = size};
    int status = 0;
    bool low = false;
    size_t mark = text_mark_length(data, size);
    if (text_mark_is_utf16(data, size, &low))
        status = decode_utf16(&file, data, size, low, err);
    else
        file = (struct text_file){.text = data + mark, .size = size - mark};
    if (status == 0 && memchr(file.text, 0, file.size) != NULL)
        status = error_set(err, ERROR_INPUT, "this is no text file: it holds a zero byte");
    if (status != 0)
        text_file_close(&file);
    else
        *out = file;
    return status;
}

void text_file_close(struct text_file *file) {
    free(file->owned);
    *file = (struct text_file){0};
}

bool text_line_next(struct text_line *line, const char **next, const char *end) {
    if (*next >= end)
        return false;
    const char *stop = memchr(*next, '\n', (size_t)(end - *next));
    stop = stop != NULL ? stop : end;
    *line = (struct text_line){*next, stop, line->number + 1};
    while (line->at < line->end && text_is_blank(*line->at))
        line->at++;
    while (line->end > line->at && text_is_blank(line->end[-1]))
        line->end--;
    *next = stop + (stop < end);
    return true;
}
