#include "core/instrument/text/decimal_column.h"
#include "core/instrument/text/text_file.h"
#include "core/instrument/text/text_number.h"
#include <string.h>

enum { ROWS_LEAST = 8 }; /* fewer may have as many digits by accident */

static const char *after_digits(const char *at, const char *end) {
    while (at < end && *at >= '0' && *at <= '9')
        at++;
    return at;
}

/* Returns the comma of a row that looks like two numbers or one; NULL: it does not. */
static const char *comma_of(struct text_line line) {
    const char *first = line.at;
    if (first < line.end && (*first == '-' || *first == '+'))
        first++;
    const char *comma = after_digits(first, line.end);
    if (comma == first || comma == line.end || *comma != ',' || comma + 1 == line.end)
        return NULL;
    return after_digits(comma + 1, line.end) == line.end ? comma : NULL;
}

/* Returns whether a line is no row: it is empty or a comment, or before all rows. A header that has
 * commas may name two columns. */
static bool is_passed(struct text_line line, size_t rows) {
    if (line.at == line.end)
        return true;
    if (rows > 0)
        return *line.at == '#';
    return memchr(line.at, ',', (size_t)(line.end - line.at)) == NULL &&
           (*line.at == '#' || !text_is_row(line));
}

enum decimal_column decimal_column_judge(const char *text, size_t size, size_t *rows) {
    struct text_line line = {0};
    const char *next = text, *end = text + size;
    size_t digits = 0;
    bool alike = true, sure = false;
    *rows = 0;
    if (memchr(text, 0, size) != NULL)
        return DECIMAL_NO;
    while (text_line_next(&line, &next, end)) {
        const char *comma = comma_of(line);
        if (comma == NULL && is_passed(line, *rows))
            continue;
        if (comma == NULL)
            return DECIMAL_NO;
        const size_t behind = (size_t)(line.end - comma) - 1;
        digits = *rows == 0 ? behind : digits;
        alike = alike && behind == digits;
        sure = sure || (behind > 1 && comma[1] == '0') ||
               (comma - line.at == 2 && memcmp(line.at, "-0", 2) == 0);
        ++*rows;
    }
    if (*rows < ROWS_LEAST)
        return DECIMAL_NO;
    return alike && sure ? DECIMAL_YES : DECIMAL_OPEN;
}

void decimal_column_point(char *text, size_t size) {
    struct text_line line = {0};
    const char *next = text;
    while (text_line_next(&line, &next, text + size)) {
        const char *comma = comma_of(line);
        if (comma != NULL)
            text[comma - text] = '.';
    }
}
