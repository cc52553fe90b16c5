/* From the numbers of a text export to a height map. Private to text*.c. */
#ifndef RUGO_CORE_INSTRUMENT_TEXT_MAP_H
#define RUGO_CORE_INSTRUMENT_TEXT_MAP_H

#include "core/instrument/text_block.h"
#include "core/map/height_map.h"

/* All numbers of a block, row by row; NaN for holes. */
struct text_table {
    double *numbers; /* owned */
    size_t rows, columns;
    size_t line; /* of the first row */
};

/* columns: of each row where the header tells it; 0: as many as the first row has. */
int text_table_read(struct text_table *out, const struct text_block *block, const char *end,
                    size_t columns, struct error *err);

/* Takes the numbers of a matrix of heights; NULL is in the table then. On failure *map may hold
 * heights, for the caller to clear. */
int text_matrix_map(struct height_map *map, struct text_table *table,
                    const struct text_header *header, struct error *err);
/* Puts a list of points x y z, in any order, on the regular grid on which they lie; nodes without a
 * point are holes. */
int text_points_map(struct height_map *map, const struct text_table *table,
                    const struct text_block *block, struct error *err);

/* Scales heights in place by the header's scale and unit, and sets map->z_unit. */
int text_scale_heights(struct height_map *map, const struct text_header *header, struct error *err);
/* Metres in one unit of x and of y, 1 where they are no lengths, and map->xy_unit. */
int text_lateral_units(struct height_map *map, const char *x_unit, const char *y_unit,
                       double metres[2], struct error *err);

#endif
