/* Heights that stand for points which were not measured, in files whose format has no other mark:
 * -9999, the least number of 16 bits, the largest of 32 (FORMULAS.md, F18.81). */
#ifndef RUGO_CORE_MAP_MISSING_H
#define RUGO_CORE_MAP_MISSING_H

#include "core/map/height_map.h"

enum { MISSING_MOST = 4, MISSING_TEXT = 160 };

/* What the caller says of them. */
struct missing_marks {
    bool asked; /* false: whether there are some is looked for */
    size_t count;
    double value[MISSING_MOST]; /* in the unit of the heights as they were read */
    bool has_unit;              /* they are in metres, as lengths with a unit are */
};

/* Makes holes of all heights that have one of the values, but for rounding to 32 bits, and writes
 * how many they are to text; "" where nothing was asked. Where nothing was, ERROR_INPUT names
 * heights that look like marks: of a map without a unit of heights, or of a text whose header has
 * one and no mark, those whose number in the file has a usual value and is farther than ten
 * standard deviations below or above all others. ERROR_INPUT also where values have a unit and
 * heights none, or the reverse. The heights are untouched then; z_of_one is 0 afterwards. */
int missing_take_out(struct height_map *map, const struct missing_marks *marks,
                     char text[MISSING_TEXT], struct error *err);

#endif
