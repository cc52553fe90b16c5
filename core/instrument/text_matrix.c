#include "core/instrument/text_map.h"
#include "core/instrument/unit_of.h"
#include <math.h>
#include <string.h>

int text_scale_heights(struct height_map *map, const struct text_header *header,
                       struct error *err) {
    const struct text_quantity *scale = &header->numbers[TEXT_Z_SCALE];
    const struct text_quantity *empty = &header->numbers[TEXT_VOID];
    double metres, factor = scale->there ? scale->value : 1;
    /* The unit of a scale is that of the product: "height conversion factor (-> m)". */
    unit_keep(map->z_unit, scale->there && scale->unit[0] != '\0' ? scale->unit : header->z_unit,
              &metres);
    for (size_t point = 0; point < grid_points(&map->grid); point++) {
        bool hole = empty->there && map->z[point] == empty->value;
        map->z[point] = hole ? NAN : map->z[point] * factor * metres;
        if (isinf(map->z[point]))
            return error_set(err, ERROR_INPUT, "a height is too large with the scale %g", factor);
    }
    return 0;
}

int text_lateral_units(struct height_map *map, const char *x_unit, const char *y_unit,
                       double metres[2], struct error *err) {
    char other[UNIT_ROOM];
    unit_keep(map->xy_unit, x_unit, &metres[0]);
    unit_keep(other, y_unit, &metres[1]);
    if (strcmp(map->xy_unit, other) == 0)
        return 0;
    return error_set(err, ERROR_INPUT,
                     "x is in '%.20s' and y in '%.20s'; allowed: lengths for both, or one unit",
                     x_unit, y_unit);
}

/* The unit of a quantity: its own, or that which the header has for its axis. */
static const char *unit_for(const struct text_quantity *quantity, const char *of_axis) {
    bool own = quantity->unit[0] != '\0' && !(quantity->usual && of_axis[0] != '\0');
    return own ? quantity->unit : of_axis;
}

/* The distance from point to point along an axis, in the file's unit; 0 where it does not tell. */
static double spacing(const struct text_quantity *step, const struct text_quantity *length,
                      size_t points, const char **unit) {
    const struct text_quantity *told = step->there ? step : length;
    if (!told->there)
        return 0;
    *unit = unit_for(told, *unit);
    return step->there ? step->value : length->value / (double)points;
}

static int check_lengths(const struct text_header *header, struct error *err) {
    static const char *const NAMES[] = {"length along x", "length along y", "spacing along x",
                                        "spacing along y"};
    for (int key = TEXT_WIDTH; key <= TEXT_DY; key++) {
        const struct text_quantity *length = &header->numbers[key];
        if (length->there && !(length->value > 0))
            return error_set(err, ERROR_INPUT, "the header says a %s of %g %s; allowed: above 0",
                             NAMES[key - TEXT_WIDTH], length->value, length->unit);
    }
    return 0;
}

static int set_lengths(struct height_map *map, const struct text_header *header,
                       struct error *err) {
    const struct text_quantity *numbers = header->numbers;
    const char *x_unit = header->x_unit, *y_unit = header->y_unit;
    double metres[2];
    double dx = spacing(&numbers[TEXT_DX], &numbers[TEXT_WIDTH], map->grid.nx, &x_unit);
    double dy = spacing(&numbers[TEXT_DY], &numbers[TEXT_HEIGHT], map->grid.ny, &y_unit);
    if (!numbers[TEXT_DY].there && (dy == 0 || numbers[TEXT_DX].there)) {
        dy = dx;
        y_unit = x_unit;
    }
    if (dx == 0) {
        dx = dy != 0 ? dy : 1;
        x_unit = dy != 0 ? y_unit : "";
        y_unit = x_unit;
    }
    if (dy == 0)
        dy = dx;
    if (y_unit[0] == '\0')
        y_unit = x_unit;
    int status = check_lengths(header, err);
    if (status == 0)
        status = text_lateral_units(map, x_unit, y_unit, metres, err);
    if (status != 0)
        return status;
    map->grid.lx = dx * metres[0] * (double)map->grid.nx;
    map->grid.ly = dy * metres[1] * (double)map->grid.ny;
    status = grid_check(&map->grid, err);
    return status == 0 ? 0 : error_context(err, "the header's lengths");
}

/* What the header says of the counts must be so. */
static int check_count(const struct text_quantity *said, const char *what, size_t found,
                       struct error *err) {
    if (!said->there || said->value == (double)found)
        return 0;
    return error_set(err, ERROR_INPUT, "the header says %g %s, %zu are there", said->value, what,
                     found);
}

int text_matrix_map(struct height_map *map, struct text_table *table,
                    const struct text_header *header, struct error *err) {
    const struct text_quantity *numbers = header->numbers;
    bool column =
        table->columns == 1 && !(numbers[TEXT_ROWS].there && numbers[TEXT_COLUMNS].there &&
                                 numbers[TEXT_COLUMNS].value == 1);
    size_t nx = column ? table->rows : table->columns, ny = column ? 1 : table->rows;
    int status = check_count(&numbers[TEXT_COLUMNS], "points a row", nx, err);
    if (status == 0)
        status = check_count(&numbers[TEXT_ROWS], "rows", ny, err);
    if (status == 0)
        status = height_map_shape(map, ny, nx, 1, err);
    if (status == 0)
        status = set_lengths(map, header, err);
    if (status != 0)
        return status;
    map->z = table->numbers;
    table->numbers = NULL;
    return text_scale_heights(map, header, err);
}
