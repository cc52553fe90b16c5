#include "core/map/length_unit.h"
#include "core/map/preparation.h"
#include "core/map/preparation_internal.h"
#include <stdio.h>
#include <string.h>

static bool is_metre(const char *unit) {
    return strcmp(unit, "m") == 0;
}

int height_map_check_units(const struct height_map *map, struct error *err) {
    if (strcmp(map->xy_unit, map->z_unit) == 0)
        return 0;
    if (is_metre(map->xy_unit))
        return error_set(
            err, ERROR_INPUT,
            "x and y are lengths and heights are %s%s, so that slopes have no meaning; "
            "--z-unit nm (or another; z_unit in studies and requests) says what they "
            "are in",
            *map->z_unit != '\0' ? "in " : "without a unit", map->z_unit);
    return error_set(err, ERROR_INPUT,
                     "the unit of heights is '%s' and that of x and y '%s', so that slopes have no "
                     "meaning; --unit um (or another) and --z-unit say what they are",
                     map->z_unit, map->xy_unit);
}

const char *preparation_length_text(const struct height_map *map, double length, char text[40]) {
    double one = 1;
    const char *unit = is_metre(map->xy_unit) ? length_unit_readable(length, &one) : "";
    snprintf(text, 40, "%.6g%s%s", length / one, *unit != '\0' ? " " : "", unit);
    return text;
}

int preparation_length(double *out, const struct height_map *map, const struct asked_length *asked,
                       const char *option, struct error *err) {
    if (asked->has_unit && !is_metre(map->xy_unit))
        return error_set(err, ERROR_INPUT,
                         "%s has a unit, %g m, and the map's lengths have none: --unit um (or "
                         "another) says it, or a plain number is in the unit of the map",
                         option, asked->value);
    if (!asked->has_unit && is_metre(map->xy_unit))
        return error_set(err, ERROR_INPUT,
                         "%s %g needs a unit, such as %gum, since the map's lengths have one",
                         option, asked->value, asked->value);
    *out = asked->value;
    return 0;
}

static int set_spacing(struct height_map *map, const struct preparation *asked, struct error *err) {
    struct grid *grid = &map->grid;
    double dx = asked->dx.value, ratio = grid_dy(grid) / grid_dx(grid);
    double dy = asked->dy.value > 0 ? asked->dy.value : dx * ratio;
    if (asked->dx.has_unit && asked->unit > 0)
        return error_set(err, ERROR_INPUT, "--dx has a unit, so that --unit has nothing to say");
    if (!asked->dx.has_unit && is_metre(map->xy_unit) && !(asked->unit > 0))
        return error_set(err, ERROR_INPUT,
                         "--dx %g needs a unit, such as %gum, since the file's lengths have one",
                         dx, dx);
    double one = asked->unit > 0 ? asked->unit : 1;
    grid->lx = dx * one * (double)grid->nx;
    grid->ly = dy * one * (double)grid->ny;
    if (asked->dx.has_unit || asked->unit > 0)
        strcpy(map->xy_unit, "m");
    return grid_check(grid, err);
}

int preparation_units(struct preparation_record *record, struct height_map *map,
                      const struct preparation *asked, struct error *err) {
    char dx[40], dy[40];
    int status = 0;
    if (asked->dx.value > 0)
        status = set_spacing(map, asked, err);
    else if (asked->unit > 0 && is_metre(map->xy_unit))
        return error_set(err, ERROR_INPUT,
                         "the file tells lengths with their unit; --unit is for files that tell "
                         "none, and for --dx");
    else if (asked->unit > 0) {
        map->grid.lx *= asked->unit;
        map->grid.ly *= asked->unit;
        strcpy(map->xy_unit, "m");
        status = grid_check(&map->grid, err);
    }
    if (status == 0 && (asked->dx.value > 0 || asked->unit > 0))
        preparation_note(record, "spacing", "%s by %s",
                         preparation_length_text(map, grid_dx(&map->grid), dx),
                         preparation_length_text(map, grid_dy(&map->grid), dy));
    if (status != 0 || asked->z_unit == 0)
        return status;
    if (is_metre(map->z_unit))
        return error_set(err, ERROR_INPUT,
                         "the file tells heights with their unit; --z-unit is for files that tell "
                         "none");
    for (size_t i = 0; i < grid_points(&map->grid); i++)
        map->z[i] *= asked->z_unit;
    preparation_note(record, "z_unit", "1%s%s is %g m", *map->z_unit != '\0' ? " " : "",
                     map->z_unit, asked->z_unit);
    strcpy(map->z_unit, "m");
    return 0;
}
