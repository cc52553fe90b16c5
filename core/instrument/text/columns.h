/* Plain columns of numbers: a trace (x z a line), a list of points (x y z a line) or a map. */
#ifndef RUGO_CORE_INSTRUMENT_TEXT_COLUMNS_H
#define RUGO_CORE_INSTRUMENT_TEXT_COLUMNS_H

#include "core/instrument/formats.h"

/* Numbers row by row, NaN for holes; borrows. */
struct columns_table {
    const double *numbers;
    size_t rows, columns;
};

/* Decides what a table is that has neither names nor lengths. Two columns are a trace where the
 * first rises or falls throughout: evenly, or in eight rows at least of which the second does not
 * as well. Three columns are a list of points where the first two lie on a regular grid of which at
 * least half is there. Fewer than four rows, other numbers of columns, holes among the positions
 * and first columns that go up and down are maps. ERROR_INPUT asks back, naming the option, where
 * it can be either, and where a first row or column numbers the others. */
int columns_choose(enum instrument_columns *out, const struct columns_table *table,
                   struct error *err);

/* Makes a profile of positions in column x and heights in column z, sorted by x; sets its grid and
 * heights, and leaves its units. metres: in one unit of x. Positions that differ from even ones by
 * 5 % of a step, or by no more than the rounding of their last digit, keep their heights bit for
 * bit; even ones of which at most a tenth is missing get holes there. Others are resampled at their
 * mean distance by Steffen's monotone cubics (FORMULAS.md, F18.22), without crossing holes. done:
 * INSTRUMENT_DONE bytes for a sentence on that. ERROR_INPUT where two heights have one position, or
 * they are fewer than 3; map->z is NULL then. */
int columns_trace(struct height_map *map, const struct columns_table *table, size_t x, size_t z,
                  double metres, char *done, struct error *err);

/* Replaces a map that was read from plain columns, one row of it a line, by what they are. asked:
 * COLUMNS_AUTO decides as above. *map is as it was, or cleared, on failure. */
int columns_of_plain(struct height_map *map, enum instrument_columns asked, char *done,
                     struct error *err);

#endif
