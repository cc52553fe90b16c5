/* What lines of "key: value unit" before the heights of a text export say. */
#ifndef RUGO_CORE_INSTRUMENT_TEXT_HEADER_H
#define RUGO_CORE_INSTRUMENT_TEXT_HEADER_H

#include "core/instrument/text_file.h"

enum { TEXT_UNIT_ROOM = 24, TEXT_TITLE_ROOM = 64 };

enum text_key {
    TEXT_COLUMNS, /* points along x */
    TEXT_ROWS,
    TEXT_WIDTH, /* length of the map along x, of all its points; a count where it has no unit */
    TEXT_HEIGHT,
    TEXT_DX, /* from point to point; along y too where no DY is there */
    TEXT_DY,
    TEXT_Z_SCALE, /* units of z in one of a number */
    TEXT_VOID,    /* the number that stands for a hole */
    TEXT_NUMBERS,
    TEXT_X_UNIT = TEXT_NUMBERS,
    TEXT_Y_UNIT,
    TEXT_XY_UNIT,
    TEXT_Z_UNIT,
    TEXT_TITLE,
    TEXT_KEYS
};

struct text_quantity {
    bool there;
    double value;
    char unit[TEXT_UNIT_ROOM]; /* "" where the line has none */
    bool usual;                /* not of the line, but what its program means */
};

struct text_header {
    struct text_quantity numbers[TEXT_NUMBERS];
    char x_unit[TEXT_UNIT_ROOM], y_unit[TEXT_UNIT_ROOM], z_unit[TEXT_UNIT_ROOM];
    char title[TEXT_TITLE_ROOM];
    bool keyed; /* a line but the title was understood */
};

/* Takes what a line says; false where it has no key that is known. */
bool text_header_take(struct text_header *header, struct text_line line);
/* Copies a unit out of its brackets and blanks. */
void text_unit_copy(char unit[TEXT_UNIT_ROOM], const char *at, const char *end);

#endif
