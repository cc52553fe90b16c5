/* A text export in blocks: lines of a header, and the lines of numbers behind them. A program that
 * puts several layers into one file writes a block for each. */
#ifndef RUGO_CORE_INSTRUMENT_TEXT_BLOCK_H
#define RUGO_CORE_INSTRUMENT_TEXT_BLOCK_H

#include "core/instrument/text_header.h"

/* Where columns have names: x, y and z of a list of points, in any order and among others. */
struct text_columns {
    bool named;
    size_t of[3]; /* the column of x, y, z, from 0 */
};

struct text_block {
    struct text_header header;
    struct text_columns columns;
    struct text_line first; /* its first line of numbers; at NULL: none is there */
    const char *next;       /* borrowed: where the line behind it begins */
};

struct text_blocks {
    struct text_block *blocks; /* owned */
    size_t count;
};

/* Finds the blocks that have numbers. ERROR_INPUT where none has, or for a line that is neither
 * header nor numbers among numbers. */
int text_blocks_find(struct text_blocks *out, const struct text_file *file, struct error *err);
/* Whether a line, not an empty one, behind a line of numbers is one too: its first field is a
 * number or a hole, or would be one; what is wrong with it is found when it is read. */
bool text_goes_on(struct text_line line, char separator);
void text_blocks_clear(struct text_blocks *blocks);

/* Whether the first lines are of an export that this reader is for: they say lengths, units or
 * names of columns, or their numbers have a comma for a point. */
bool text_blocks_own(const char *text, size_t size);

#endif
