/* What levelling of scan lines takes of the surface itself. */
#ifndef RUGO_CORE_MAP_LINE_LOSSES_H
#define RUGO_CORE_MAP_LINE_LOSSES_H

#include "core/map/preparation/scan_lines.h"
#include "core/statistics/measured_map.h"

/* Shares of mean squares that the map had, were its lines not levelled: of heights, slopes, second
 * differences along both axes, and mean curvatures. */
struct line_losses {
    double height, slope, bend, curvature;
};
/* A polynomial takes from each line as much as as many slow waves along it have, by those of one to
 * four waves a line (FORMULAS.md, F18.78). All 0 where nothing was levelled. ERROR_MEMORY. */
int line_losses_measure(const struct measured_map *map, enum scan_lines kind, enum scan_axis along,
                        struct line_losses *out, struct error *err);

#endif
