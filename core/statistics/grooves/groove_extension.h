/* Grooves of a map on a periodic cell of twice its sides, which has them in its first rows and
 * columns as they are and goes on with them (FORMULAS.md, F18.64). */
#ifndef RUGO_CORE_STATISTICS_GROOVES_GROOVE_EXTENSION_H
#define RUGO_CORE_STATISTICS_GROOVES_GROOVE_EXTENSION_H

#include "core/statistics/grooves/map_grooves.h"

/* Adds `times` the mean profiles of all families to heights on any grid of the cell, whose first
 * point is that of the map. Beyond the map a family has up to
 * half a period more or less along each side, so that the cell has whole numbers of them.
 * ERROR_MEMORY. */
int groove_extension_add(const struct map_grooves *grooves, const struct grid *map,
                         const struct grid *cell, double times, double *z, struct error *err);
/* Returns the period of a family beyond the map along both axes. */
double groove_extension_period(const struct map_groove *family, const struct grid *map);

#endif
