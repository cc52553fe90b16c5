/* Heights, slopes and curvatures by scale: root mean squares of differences over lags of 1, 2, 4,
 * ... points. */
#ifndef RUGO_CORE_STATISTICS_HEIGHTS_SCALES_H
#define RUGO_CORE_STATISTICS_HEIGHTS_SCALES_H

#include "core/statistics/measured_map.h"

enum { SCALES_MOST = 32 };

/* Of a lag along x and along y, of as many points; length is that along x. NaN: none. */
struct scale {
    double length;
    double height;    /* root of half the mean square difference of two heights */
    double slope;     /* of the differences over the lag; surface: of the gradient */
    double curvature; /* of second differences over the lag's square; surface: mean curvature */
};
/* Fills out[SCALES_MOST] with lags up to a quarter of the shorter side, at least one; returns how
 * many (FORMULAS.md, F18.6). */
size_t scales_measure(const struct measured_map *map, struct scale *out);

#endif
