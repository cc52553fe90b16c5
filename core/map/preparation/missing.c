#include "core/map/preparation/missing.h"
#include "core/map/length_unit.h"
#include "core/statistics/measured_map.h"
#include <float.h>
#include <math.h>
#include <stdio.h>

static const double ROUNDING = 1e-6; /* relative, of numbers of 32 bits */
/* No length in any unit; Surfer's blanks are 1.7e38, the largest number of 32 bits is 3.4e38. */
static const double HUGE_LEAST = 1e30;
static const double FAR = 10; /* standard deviations of the others */

static bool is_value(double z, double value) {
    return fabs(z - value) <= ROUNDING * fabs(value);
}

static bool is_usual(double z) {
    static const double USUAL[] = {-999,   -9999, 9999,  -99999,       99999,      -32768,
                                   -32767, 32767, 65535, -2147483648., 2147483647.};
    for (size_t n = 0; n < sizeof USUAL / sizeof *USUAL; n++)
        if (is_value(z, USUAL[n]))
            return true;
    return fabs(z) >= HUGE_LEAST;
}

/* Returns a height as the number that stands in the file, which a mark has. */
static double number_at(const struct height_map *map, size_t point) {
    return map->z_of_one != 0 ? map->z[point] / map->z_of_one : map->z[point];
}

static size_t count_value(const struct height_map *map, double value) {
    size_t count = 0;
    for (size_t point = 0; point < grid_points(&map->grid); point++)
        count += is_value(number_at(map, point), value) ? 1 : 0;
    return count;
}

/* Whether the lowest or the highest height has a usual value. */
static bool has_usual_end(const struct height_map *map) {
    double low = INFINITY, high = -INFINITY;
    for (size_t point = 0; point < grid_points(&map->grid); point++) {
        low = fmin(low, number_at(map, point)); /* holes are passed over */
        high = fmax(high, number_at(map, point));
    }
    return is_usual(low) || is_usual(high);
}

/* Heights of other than usual values, as numbers of the file. */
struct others {
    double low, high, deviation;
};

static void others_measure(struct others *out, const struct height_map *map) {
    const size_t points = grid_points(&map->grid);
    struct average mean = {0}, square = {0};
    *out = (struct others){INFINITY, -INFINITY, 0};
    for (size_t point = 0; point < points; point++) {
        const double z = number_at(map, point);
        if (isnan(z) || is_usual(z))
            continue;
        out->low = fmin(out->low, z);
        out->high = fmax(out->high, z);
        average_add(&mean, z);
    }
    for (size_t point = 0; point < points; point++)
        if (!is_usual(number_at(map, point)))
            average_add(&square, pow(number_at(map, point) - average_value(&mean), 2));
    out->deviation = sqrt(average_value(&square));
}

/* Returns the lowest height above `after` that is far from the others; infinity: there is none. */
static double next_far(const struct height_map *map, const struct others *others, double after) {
    const double least = others->low - FAR * others->deviation;
    const double most = others->high + FAR * others->deviation;
    double next = INFINITY;
    for (size_t point = 0; point < grid_points(&map->grid); point++) {
        const double z = number_at(map, point);
        if (z > after && (z < least || z > most) && !is_value(z, after))
            next = fmin(next, z);
    }
    return next;
}

/* A list of values with commas between. */
struct list {
    char text[120];
    size_t used;
};

static void list_add(struct list *list, double value, const char *unit) {
    const size_t room = sizeof list->text - list->used;
    const int length =
        snprintf(list->text + list->used, room, "%s%.9g%s", list->used > 0 ? "," : "", value, unit);
    list->used += length > 0 && (size_t)length < room ? (size_t)length : 0;
}

/* Adds a number of the file as --missing takes it: with a unit where the heights have one, that of
 * the file where there is such a unit. */
static void list_asked(struct list *list, const struct height_map *map, double number) {
    const double z = map->z_of_one != 0 ? number * map->z_of_one : number;
    const char *unit = length_unit_typed(map->z_of_one);
    if (!length_unit_is_metre(map->z_unit))
        list_add(list, z, "");
    else if (unit != NULL)
        list_add(list, number, unit);
    else
        list_add(list, z / 1e-9, "nm");
}

/* Other heights that are all alike, as in a mask, have no scale to be far by. */
static int find(const struct height_map *map, struct error *err) {
    struct others others = {0};
    struct list values = {"", 0}, asked = {"", 0};
    size_t count = 0, listed = 0;
    if (has_usual_end(map))
        others_measure(&others, map);
    if (!(others.deviation > 0))
        return 0;
    double value = next_far(map, &others, -DBL_MAX);
    for (; isfinite(value) && listed < MISSING_MOST; value = next_far(map, &others, value)) {
        list_add(&values, value, "");
        list_asked(&asked, map, value);
        count += count_value(map, value);
        listed++;
    }
    if (listed == 0)
        return 0;
    return error_set(err, ERROR_INPUT,
                     "%zu of %zu heights are %s%s, far from all others, %.6g to %.6g, as marks of "
                     "points that were not measured are: --missing %s makes holes of them, "
                     "--missing none keeps them (missing in studies and requests)",
                     count, grid_points(&map->grid), values.text,
                     map->z_of_one != 0 ? " in the file" : "", others.low, others.high, asked.text);
}

static int check_unit(const struct height_map *map, const struct missing_marks *marks,
                      struct error *err) {
    const bool metres = length_unit_is_metre(map->z_unit);
    if (marks->count == 0 || marks->has_unit == metres)
        return 0;
    if (metres)
        return error_set(err, ERROR_INPUT,
                         "--missing %g needs a unit, such as %gnm, since the file's heights have "
                         "one",
                         marks->value[0], marks->value[0]);
    return error_set(err, ERROR_INPUT,
                     "--missing has a unit, %g m, and the file's heights have none; allowed: "
                     "numbers as they stand in the file",
                     marks->value[0]);
}

int missing_take_out(struct height_map *map, const struct missing_marks *marks,
                     char text[MISSING_TEXT], struct error *err) {
    const size_t points = grid_points(&map->grid);
    size_t holes = 0;
    *text = '\0';
    int status = 0;
    if (!marks->asked && (*map->z_unit == '\0' || map->z_of_one != 0))
        status = find(map, err);
    else if (marks->asked)
        status = check_unit(map, marks, err);
    map->z_of_one = 0; /* what is done from here on is no longer what the file has */
    if (status != 0 || marks->count == 0)
        return status;
    for (size_t point = 0; point < points; point++)
        for (size_t n = 0; n < marks->count; n++)
            if (is_value(map->z[point], marks->value[n])) {
                map->z[point] = (double)NAN;
                holes++;
            }
    snprintf(text, MISSING_TEXT, "%zu points, %.4g %%, became holes: heights of %g%s%s", holes,
             100 * (double)holes / (double)points, marks->value[0], marks->has_unit ? " m" : "",
             marks->count > 1 ? " and others" : "");
    return 0;
}
