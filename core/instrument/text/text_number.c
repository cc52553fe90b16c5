#include "core/instrument/text/text_number.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

/* Returns whether the commas of a line stand within numbers between blanks: "0,12 0,13". */
static bool commas_are_marks(struct text_line line) {
    bool blanks = false;
    for (const char *at = line.at; at < line.end; at++) {
        blanks = blanks || text_is_blank(*at);
        if (*at != ',')
            continue;
        bool digits = at > line.at && at[-1] >= '0' && at[-1] <= '9' && at + 1 < line.end &&
                      at[1] >= '0' && at[1] <= '9';
        if (!digits)
            return false;
    }
    return blanks;
}

struct text_dialect text_dialect_of(struct text_line line) {
    static const char FIRST[] = {';', '\t'};
    for (size_t s = 0; s < sizeof FIRST; s++)
        if (memchr(line.at, FIRST[s], (size_t)(line.end - line.at)) != NULL)
            return (struct text_dialect){.separator = FIRST[s]};
    bool commas = memchr(line.at, ',', (size_t)(line.end - line.at)) != NULL;
    return (struct text_dialect){.separator = commas && !commas_are_marks(line) ? ',' : ' '};
}

static bool is_word(const char *at, const char *end, const char *word) {
    return strlen(word) == (size_t)(end - at) && strncasecmp(at, word, (size_t)(end - at)) == 0;
}

/* Between blanks, "No Data" is one field. */
static void take_second_word(const struct text_line *line, struct text_field *out) {
    const char *at = out->end;
    while (at < line->end && text_is_blank(*at))
        at++;
    if (is_word(out->at, out->end, "No") && line->end - at >= 4 && is_word(at, at + 4, "Data"))
        out->end = at + 4;
}

bool text_field_next(struct text_line *line, char separator, struct text_field *out) {
    if (line->at == NULL)
        return false;
    while (line->at < line->end && text_is_blank(*line->at) &&
           (separator == ' ' || *line->at != separator))
        line->at++;
    if (line->at >= line->end && separator == ' ')
        return false;
    *out = (struct text_field){line->at, line->at, true};
    bool quoted = false;
    for (; out->end < line->end; out->end++) {
        quoted = quoted != (*out->end == '"');
        if (!quoted && (separator == ' ' ? text_is_blank(*out->end) : *out->end == separator))
            break;
    }
    if (separator == ' ')
        take_second_word(line, out);
    out->last = out->end >= line->end;
    line->at = out->last ? (separator == ' ' ? line->end : NULL) : out->end + (separator != ' ');
    while (out->end > out->at && text_is_blank(out->end[-1]))
        out->end--;
    if (out->end - out->at >= 2 && *out->at == '"' && out->end[-1] == '"') {
        out->at++;
        out->end--;
    }
    return true;
}

static bool is_hole(const char *at, const char *end) {
    static const char *const WORDS[] = {"",       "nan",  "-nan", "+nan", "bad",     "no data",
                                        "nodata", "null", "void", "n/a",  "na",      "-",
                                        "--",     "---",  "*",    "***",  "1.#qnan", "-1.#ind"};
    for (size_t w = 0; w < sizeof WORDS / sizeof WORDS[0]; w++)
        if (is_word(at, end, WORDS[w]))
            return true;
    return false;
}

enum text_value text_value_of(const struct text_field *field, struct text_dialect *dialect,
                              double *out) {
    char copy[64], *stop;
    size_t length = (size_t)(field->end - field->at);
    *out = NAN;
    if (length == 0 || length >= sizeof copy)
        return is_hole(field->at, field->end) ? TEXT_HOLE : TEXT_OTHER;
    memcpy(copy, field->at, length);
    copy[length] = '\0';
    /* This test is made on the copy: in the file, commas would lead on to the end of the line. */
    if (strspn(copy, "+-.,0123456789eE") < length)
        return is_hole(field->at, field->end) ? TEXT_HOLE : TEXT_OTHER;
    char *mark = strpbrk(copy, ".,");
    if (mark != NULL) {
        if (dialect->decimal == '\0')
            dialect->decimal = *mark;
        if (*mark != dialect->decimal)
            return TEXT_OTHER;
        *mark = '.';
    }
    double number = strtod(copy, &stop);
    if (stop == copy || *stop != '\0' || !isfinite(number))
        return is_hole(field->at, field->end) ? TEXT_HOLE : TEXT_OTHER;
    *out = number;
    return TEXT_NUMBER;
}

bool text_is_row(struct text_line line) {
    struct text_dialect dialect = text_dialect_of(line);
    struct text_field field;
    double number;
    size_t numbers = 0;
    while (text_field_next(&line, dialect.separator, &field)) {
        enum text_value value = text_value_of(&field, &dialect, &number);
        if (value == TEXT_OTHER)
            return false;
        numbers += value == TEXT_NUMBER ? 1 : 0;
    }
    return numbers > 0;
}
