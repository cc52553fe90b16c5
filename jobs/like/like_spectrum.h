/* The spectral density of a measured surface as the table spectrum of a study. */
#ifndef RUGO_JOBS_LIKE_LIKE_SPECTRUM_H
#define RUGO_JOBS_LIKE_LIKE_SPECTRUM_H

#include "core/map/detrend.h"
#include "core/statistics/measured_map.h"
#include "core/surface/spectrum.h"

struct like_table {
    double anisotropy;   /* of waves along x; 1: isotropic */
    double highest;      /* wave number of the last row */
    size_t count;        /* rows */
    double *wave_number; /* owned, as the density: count values, rising, in radians per length */
    double *density;     /* of any scale */
};
void like_table_clear(struct like_table *table);

/* Measures the density over the wave numbers of an open map, smoothed over quarters of octaves. The
 * last is `most`, or where that is 0 its Nyquist frequency or an earlier end of the spectrum. Below
 * the first ring the density is constant. */
int like_table_measure(struct like_table *out, const struct measured_map *map, double anisotropy,
                       double most, struct error *err);
/* Changes the density so that sub-maps of random surfaces on the cell, as large as the map and
 * without such a trend, have the density of the map in the mean: a window mixes waves, and a trend
 * contains the longest ones. A small and smooth change follows, so that they have the map's mean
 * squares of height, slope and curvature (forward and central differences). */
enum { LIKE_MOMENTS = 3 };
int like_table_calibrate(struct like_table *table, const struct grid *map, enum detrend kind,
                         const struct grid *cell, const double squares[LIKE_MOMENTS],
                         struct error *err);
/* Changes the density by a parabola of logarithms, so that the zeroth, second and fourth moments of
 * the table on the cell change by these factors. Does nothing where that takes more than a factor
 * of four somewhere. */
void like_table_bend(struct like_table *table, const struct grid *cell,
                     const double factors[LIKE_MOMENTS]);

/* Computes the RMS slope of surfaces with this density on a cell, in a scale such that forward
 * differences between the points of the cell have the measured RMS. */
int like_table_slope(const struct like_table *table, const struct grid *cell, double measured,
                     double *rms_slope, struct error *err);

#endif
