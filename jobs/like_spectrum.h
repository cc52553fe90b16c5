/* The spectral density of a measured surface as the table spectrum of a study. */
#ifndef RUGO_JOBS_LIKE_SPECTRUM_H
#define RUGO_JOBS_LIKE_SPECTRUM_H

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

/* Measures it over the wave numbers of an open map, smoothed over quarters of octaves, up to
 * `most`, or where that is 0 to its Nyquist frequency or to where it ends before; below the first
 * ring it stays as it is there. */
int like_table_measure(struct like_table *out, const struct measured_map *map, double anisotropy,
                       double most, struct error *err);
/* Changes the density so that pieces of random surfaces on the cell, as large as the map and less
 * such a trend, have in the mean the density that the map has, since a window mixes waves and a
 * trend takes the longest ones, and then by little and smoothly, so that they have the map's mean
 * squares of height, slope and curvature (forward and central differences). */
enum { LIKE_MOMENTS = 3 };
int like_table_calibrate(struct like_table *table, const struct grid *map, enum detrend kind,
                         const struct grid *cell, const double squares[LIKE_MOMENTS],
                         struct error *err);
/* Changes the density by a parabola of logarithms, so that the zeroth, second and fourth moments of
 * the table on the cell change by these factors; leaves it where that takes more than a factor of
 * four somewhere. */
void like_table_bend(struct like_table *table, const struct grid *cell,
                     const double factors[LIKE_MOMENTS]);

/* RMS slope of surfaces with this density on a cell, of such a scale that forward differences
 * between the points of the cell have the RMS that was measured. */
int like_table_slope(const struct like_table *table, const struct grid *cell, double measured,
                     double *rms_slope, struct error *err);

#endif
