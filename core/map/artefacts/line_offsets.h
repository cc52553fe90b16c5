/* Offsets of scan lines: heights that all points of a line have and its neighbours have not
 * (FORMULAS.md, F18.40). */
#ifndef RUGO_CORE_MAP_ARTEFACTS_LINE_OFFSETS_H
#define RUGO_CORE_MAP_ARTEFACTS_LINE_OFFSETS_H

#include "core/error.h"
#include "core/map/artefacts/differences.h"
#include "core/map/preparation/scan_lines.h"

#define LINE_OFFSETS_LEVEL 1e-4 /* of the test */

struct line_offsets {
    bool found;       /* beyond what the waves of the lines would show, and of some size */
    double p_value;   /* of lines without offsets; NaN: the map is too small to say */
    double rms;       /* of the offsets, as independent ones; 0: lines have no more than waves */
    double slope;     /* RMS slope without them over that with them */
    double curvature; /* share of independent ones in the mean square of second differences across
                         the lines */
};
/* Tests the lines along an axis. Holes (NaN) are left out. Memory: ten lines. ERROR_MEMORY. */
int line_offsets_measure(const struct grid *grid, const double *z, enum scan_axis along,
                         const struct map_differences *differences, struct line_offsets *out,
                         struct error *err);

#endif
