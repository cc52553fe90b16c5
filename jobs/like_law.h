/* Laws that fit a measured surface, as the parameters of a study take them. */
#ifndef RUGO_JOBS_LIKE_LAW_H
#define RUGO_JOBS_LIKE_LAW_H

#include "core/statistics/measured_map.h"
#include "core/surface/spectrum.h"

/* Fits the self-affine law to an open map. law: NULL where it is not wanted. trusted: the longest
 * and the shortest wavelength at which the map tells its spectrum. ERROR_INPUT where a law is
 * wanted and none fits. */
int like_law_fit(const struct measured_map *map, struct spectrum *law, double trusted[2],
                 struct error *err);

/* Finds the distribution that fits its heights best: the name that studies know, static, and the
 * shape, NaN without one. */
int like_law_heights(const struct measured_map *map, const char **name, double *shape,
                     struct error *err);

/* Finds how many times longer waves are along the grooves of a surface than across: 1 where chance
 * alone may make it look so, and of profiles. across: the angle from x of the steepest slopes. */
int like_law_anisotropy(const struct measured_map *map, double *ratio, double *across,
                        struct error *err);

#endif
