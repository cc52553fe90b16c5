#include "core/instrument/text/text_file.h"
#include <string.h>

int text_check(const char *data, size_t size, struct error *err) {
    return memchr(data, 0, size) == NULL
               ? 0
               : error_set(err, ERROR_INPUT, "this is no text file: it holds a zero byte");
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
