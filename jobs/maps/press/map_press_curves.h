/* The contact of one map as the curves of a case with one realisation. */
#ifndef RUGO_JOBS_MAPS_MAP_PRESS_CURVES_H
#define RUGO_JOBS_MAPS_MAP_PRESS_CURVES_H

#include "jobs/maps/press/map_press.h"

/* Appends the curves of all series to *out, {0} at first, which the caller clears in any case: x is
 * the load. The columns come first, in their order, then measures that studies show beside, then
 * the models' own. A source of error that bears on a curve is there as in studies, also where
 * nothing is known of it. RMS height and slope of the map are scalars, notes of series are notes of
 * the case. ERROR_MEMORY. */
int map_press_result(struct case_result *out, const struct map_press *press, size_t count,
                     const struct press_series *series, size_t loads, struct error *err);
/* Returns the curve of a column, or NULL. model: its name. */
const struct curve *map_press_curve(const struct case_result *result,
                                    const struct press_column *column, const char *model);

#endif
