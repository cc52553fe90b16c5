/* Whether noise governs a map. */
#ifndef RUGO_JOBS_MAPS_MAP_NOISE_H
#define RUGO_JOBS_MAPS_MAP_NOISE_H

#include "core/error.h"
#include "core/statistics/measured_map.h"

struct map_noise {
    bool governs; /* it has more than NOISE_SHARE_MOST of the curvature (spectrum_fit.h), and the
                     law without it a smaller slope: holes make noise that is none */
    double slope, without; /* RMS slope by differences, and that of the law that fits without it */
};
/* Fits the law of the spectrum, over circles. ERROR_MEMORY, or ERROR_INPUT for a periodic map with
 * holes. */
int map_noise_measure(struct map_noise *out, const struct measured_map *map, struct error *err);

#endif
