/* One page about a measured surface, for a report: the map, its heights, spectrum and scales with
 * what was fitted to them, the main parameters, and where all of it comes from. */
#ifndef RUGO_SERVER_SHOW_MAP_MAP_FIGURE_H
#define RUGO_SERVER_SHOW_MAP_MAP_FIGURE_H

#include "jobs/maps/map_characterisation.h"
#include "server/show/map/named_values.h"

struct map_figure { /* borrows */
    const struct map_characterisation *measured;
    const struct named_values *found;        /* the same by names; drawn where it has the columns */
    const struct height_map *map;            /* as it was measured: prepared */
    const struct preparation_record *record; /* of its preparation, from the file on */
};
/* Draws an SVG of an A4 page, which reads in grey as well. Its <metadata>, one line, holds the
 * characterisation as JSON. Lengths are in units that read well where the map has units. Write
 * errors are left to the file's own flag. */
int map_figure_draw(const struct map_figure *figure, FILE *file, struct error *err);

#endif
