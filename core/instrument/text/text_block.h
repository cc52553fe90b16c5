/* A text export in blocks: lines of a header, followed by lines of numbers. A program that writes
 * several layers to one file writes a block for each. */
#ifndef RUGO_CORE_INSTRUMENT_TEXT_TEXT_BLOCK_H
#define RUGO_CORE_INSTRUMENT_TEXT_TEXT_BLOCK_H

#include "core/instrument/text/text_file.h"

/* The header of a text export: lines of "key: value unit" before the heights. */

enum { TEXT_UNIT_ROOM = 24, TEXT_TITLE_ROOM = 64 };

enum text_key {
    TEXT_COLUMNS, /* points along x */
    TEXT_ROWS,
    TEXT_WIDTH, /* length of the map along x, of all its points; a count where it has no unit */
    TEXT_HEIGHT,
    TEXT_DX, /* between points; along y too where there is no DY */
    TEXT_DY,
    TEXT_Z_SCALE, /* units of z for a number of 1 */
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
    bool usual;                /* not from the line: the usual unit of its program */
};

struct text_header {
    struct text_quantity numbers[TEXT_NUMBERS];
    char x_unit[TEXT_UNIT_ROOM], y_unit[TEXT_UNIT_ROOM], z_unit[TEXT_UNIT_ROOM];
    char title[TEXT_TITLE_ROOM];
    bool keyed; /* a line other than the title was understood */
};

/* Reads a line; returns false where its key is not known. */
bool text_header_take(struct text_header *header, struct text_line line);
/* Copies a unit without its brackets and blanks. */
void text_unit_copy(char unit[TEXT_UNIT_ROOM], const char *at, const char *end);

/* The named columns x, y and z of a list of points, or x and z of a trace, in any order and among
 * others. */
struct text_columns {
    bool named;   /* all three */
    bool trace;   /* x and z alone */
    size_t of[3]; /* the column of x, y, z, from 0 */
    size_t count; /* of the columns that the line of names or units has */
};

struct text_block {
    struct text_header header;
    struct text_columns columns;
    struct text_line first; /* its first line of numbers; at NULL: there is none */
    const char *next;       /* borrowed: where the line after it begins */
};

struct text_blocks {
    struct text_block *blocks; /* owned */
    size_t count;
};

/* Finds the blocks that have numbers. ERROR_INPUT where none has, or for a line among numbers that
 * is neither header nor numbers. */
int text_blocks_find(struct text_blocks *out, const char *text, size_t size, struct error *err);
/* Returns whether a non-empty line that follows a line of numbers is one too: its first field is a
 * number or a hole, or a damaged one. Its reader reports the damage. */
bool text_goes_on(struct text_line line, char separator);
void text_blocks_clear(struct text_blocks *blocks);

/* Returns whether the first lines are of an export for this reader: they have lengths, units or
 * names of columns, or their numbers have decimal commas. */
bool text_blocks_own(const char *text, size_t size);

#endif
