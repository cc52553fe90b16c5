/* Whether a form, such as a bow, is left in a map: a quadratic form of least squares, beside what
 * a surface with the long waves of the rest would have of it (FORMULAS.md, F18.62). */
#ifndef RUGO_CORE_MAP_FORM_H
#define RUGO_CORE_MAP_FORM_H

#include "core/statistics/measured_map.h"
#include <stdbool.h>

struct map_form {
    double height;   /* RMS of the quadratic form; NaN: not sought, as the next */
    double expected; /* RMS that a surface has of it, by its long waves */
    double share;    /* of the form in the mean square height about a plane */
    double p_value;  /* of a surface without a form */
};
/* It is sought in open maps of at least 32 points a side, up to 16 times as long as wide, that have
 * a quadratic form. Holes are left out. Memory: two maps of 64 points across. ERROR_MEMORY. */
int map_form_find(struct map_form *out, const struct measured_map *map, struct error *err);
/* Returns whether a map has one, at a level of 1e-4 (F18.62 has how many do that have none). */
bool map_form_found(const struct map_form *form);

#endif
