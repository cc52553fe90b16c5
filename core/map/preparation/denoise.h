/* Takes out of a map the noise that governs its slopes, by the law that fits its spectrum
 * (FORMULAS.md, F18.44). */
#ifndef RUGO_CORE_MAP_DENOISE_H
#define RUGO_CORE_MAP_DENOISE_H

#include "core/statistics/measured_map.h"

struct denoise_result {
    bool found;      /* noise that governs slopes (spectrum_fit.h); false: z is as it was */
    double noise;    /* its RMS height up to the shortest waves of the points */
    double shortest; /* wave of the law */
    double slope_before, slope_after;    /* RMS slopes, by differences */
    double slope_error, curvature_error; /* relative standard errors that this adds (F18.78) */
};
/* Multiplies each wave of the law, along a lay where directions differ, by the root of the share
 * that the law has in its power, and shorter ones by 0. z has no holes. An open map goes on as its
 * mirror images. Memory: four maps, of an open one sixteen. ERROR_MEMORY; z is undefined then. */
int map_denoise(const struct grid *grid, double *z, enum boundary boundary,
                struct denoise_result *out, struct error *err);

#endif
