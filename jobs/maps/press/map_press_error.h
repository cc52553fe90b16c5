/* The errors of the contact of one map by source, as of a study's case (schema/result/result.h).
 *
 * What each source is estimated from:
 * discretisation: the change from every second point along each axis, under the same force. It is
 *     the error where that falls with the spacing, more where it falls faster. At single loads the
 *     change may vanish. Where edges are sides, or yielded, the area errs by half a step besides,
 *     and the approach by what the summit rises above the points. Of `full` what wider columns in
 * the depth leave is added, as in studies. block: the pair of an exact layer and a half-space on
 * the map, where the block is low (block_error.h). model: the difference to the most complete of
 * the models asked for; of this one, where it is linear, the area's first order of sideways strain
 * (FORMULAS.md, F14.5). solver: the tolerance and the number of nodes in contact
 * (contact_errors.h).
 *
 * One map has no error of sampling, and nothing is known of its cell and its generation. */
#ifndef RUGO_JOBS_MAPS_MAP_PRESS_ERROR_H
#define RUGO_JOBS_MAPS_MAP_PRESS_ERROR_H

#include "jobs/maps/press/map_press.h"

/* Returns whether a source bears on a value of series m of so many. */
bool map_press_applies(size_t count, const struct press_series *series, size_t m, size_t value,
                       enum error_source source);
/* Fills the errors of all series, of the points of their paths too. What needs every second point
 * is not known of maps that cannot be thinned (fewer than 16 points along a side, of a periodic one
 * an odd number), nor of loads whose coarse contact is not found. map: as it is pressed. press may
 * be released; pressures are the loads, in E*. ERROR_MEMORY alone. */
int map_press_error(const struct map_press *press, const struct height_map *map, size_t count,
                    const struct press_series *series, size_t loads, const double *pressures,
                    struct error *err);

#endif
