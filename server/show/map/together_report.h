/* Several maps of one surface together: their numbers by name, and the picture of their spectral
 * densities. */
#ifndef RUGO_SERVER_SHOW_MAP_TOGETHER_REPORT_H
#define RUGO_SERVER_SHOW_MAP_TOGETHER_REPORT_H

#include "jobs/maps/map_together.h"
#include "server/show/map/named_values.h"

/* Fills groups: files; together, the law; maps, a row each; psd and psd_x, the densities over rings
 * and along lines, map by map. The caller clears *out in any case. ERROR_MEMORY. */
int together_report_fill(struct named_values *out, const struct map_together *together,
                         struct error *err);
/* Draws an SVG: C(q) of all maps with the law, and their densities of lines along x, on logarithmic
 * axes. Each map is a thick line in its trusted band, and a thin one beyond. The file has what was
 * found, as JSON in <metadata>. ERROR_MEMORY. */
int together_draw(const struct map_together *together, const struct named_values *found, FILE *file,
                  struct error *err);

#endif
