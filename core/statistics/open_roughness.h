/* Roughness parameters of maps that do not repeat, or that have holes: sums over what is inside. */
#ifndef RUGO_CORE_STATISTICS_OPEN_ROUGHNESS_H
#define RUGO_CORE_STATISTICS_OPEN_ROUGHNESS_H

#include "core/statistics/measured_map.h"
#include "core/statistics/roughness.h"

/* Measures as roughness_measure does, over the heights and differences that are there (FORMULAS.md,
 * F18.2); NaN where there are none. */
void open_roughness_measure(const struct measured_map *map, struct roughness *out);

#endif
