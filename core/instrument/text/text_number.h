/* Numbers in a line of text as instruments' programs write them: with comma or point as the decimal
 * mark; between commas, semicolons, tabs or blanks; in quotation marks or not. */
#ifndef RUGO_CORE_INSTRUMENT_TEXT_TEXT_NUMBER_H
#define RUGO_CORE_INSTRUMENT_TEXT_TEXT_NUMBER_H

#include "core/instrument/text/text_file.h"

struct text_dialect {
    char separator; /* ',' ';' '\t'; ' ': any blanks */
    char decimal;   /* '.' or ','; 0: not seen yet */
};

/* Returns the dialect of a line of numbers: the comma is the separator where there is no other. */
struct text_dialect text_dialect_of(struct text_line line);

struct text_field {
    const char *at, *end; /* borrowed: without blanks and quotation marks */
    bool last;            /* no separator follows it */
};
/* Takes the next field from a line; returns false where there is none. An empty one has at ==
 * end. */
bool text_field_next(struct text_line *line, char separator, struct text_field *out);

enum text_value { TEXT_NUMBER, TEXT_HOLE, TEXT_OTHER };
/* Classifies a field: a finite number, a word for a height that was not measured or nothing, or
 * neither. dialect->decimal is set by the first number that has a mark; a number with the other
 * mark is none. */
enum text_value text_value_of(const struct text_field *field, struct text_dialect *dialect,
                              double *out);
/* Returns whether all fields of a line are numbers or holes, at least one of them a number. */
bool text_is_row(struct text_line line);

#endif
