/* Offsets and bows of scan lines, which drift, creep and hysteresis of a scanning instrument leave:
 * of each line its mean, median or polynomial is taken out (FORMULAS.md, F18.30). */
#ifndef RUGO_CORE_MAP_SCAN_LINES_H
#define RUGO_CORE_MAP_SCAN_LINES_H

#include "core/surface/grid.h"

enum scan_lines {
    SCAN_LINES_NONE,
    SCAN_LINES_MEAN,
    SCAN_LINES_MEDIAN,
    SCAN_LINES_LINEAR,
    SCAN_LINES_QUADRATIC
};
enum scan_axis { SCAN_ALONG_X, SCAN_ALONG_Y };

struct scan_lines_result {
    size_t lines; /* with heights */
    double rms;   /* root mean square of what was subtracted, about its mean */
    double share; /* of it in the mean square height; NaN where all heights were the same */
};

/* Subtracts from each line along the axis its own mean, median or polynomial of least squares, each
 * of the heights that are there; holes stay. A line of too few heights for its polynomial loses one
 * of a lower degree. Memory: two lines. ERROR_MEMORY; the heights are undefined then. */
int scan_lines_level(const struct grid *grid, double *z, enum scan_lines kind, enum scan_axis along,
                     struct scan_lines_result *out, struct error *err);

#endif
