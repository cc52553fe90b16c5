/* The spectral density of a measured surface as the table spectrum of a study. */
#ifndef RUGO_JOBS_LIKE_LIKE_SPECTRUM_H
#define RUGO_JOBS_LIKE_LIKE_SPECTRUM_H

#include "core/map/preparation/detrend.h"
#include "core/statistics/spectra/map_spectrum.h"
#include "core/surface/spectrum.h"
#include "jobs/like/like_expectation.h"

struct like_table {
    struct lay lay;      /* wave numbers are those across it */
    double highest;      /* wave number of the last row */
    size_t count;        /* rows */
    double *wave_number; /* owned, as the density: count values, rising, in radians per length */
    double *density;     /* of any scale */
};
void like_table_clear(struct like_table *table);

/* White noise in a map, which its surfaces are not to have. */
struct like_noise {
    double density;     /* 0: none */
    double wave_number; /* up to which the rest can be seen */
};

/* Takes the density over the rings of an open map, without noise, smoothed over quarters of
 * octaves. The last row is at the Nyquist frequency of the points along x, at an earlier end of the
 * spectrum, or where noise begins. Below the first ring the density is constant. */
int like_table_measure(struct like_table *out, const struct map_spectrum *rings,
                       const struct like_noise *noise, struct error *err);
/* Fills rows[table->count] with what other densities, one a ring, have at the rows of the table. */
int like_table_rows(const struct like_table *table, const struct map_spectrum *rings,
                    const double *density, double *rows, struct error *err);
/* Fills a spectrum with the table, which it borrows. */
void like_table_spectrum(const struct like_table *table, struct spectrum *out);

/* Changes the density so that sub-maps of random surfaces on the cell, as large as the map and
 * without such a trend, have the density of the map in the mean: a window mixes waves, and a trend
 * contains the longest ones. A small and smooth change follows, so that they have the map's mean
 * squares of height, slope and curvature (forward and central differences). *left: the largest
 * relative difference that remains in one of their roots.
 *
 * Of a map with noise they have its mean squares less those of white noise. A slope or curvature
 * that is mostly noise follows from the density without noise instead. Squares become these. */
struct like_left {
    double relative; /* (surfaces - map)/map */
    int moment;      /* 0: height, 1: slope, 2: curvature */
};
int like_table_calibrate(struct like_table *table, const struct map_spectrum *rings,
                         enum detrend kind, const struct grid *cell, const struct like_noise *noise,
                         double squares[LIKE_MOMENTS], struct like_left *left, struct error *err);

/* Computes the RMS slope of surfaces with this density on a cell, in a scale such that forward
 * differences between the points of the cell have the measured RMS. */
int like_table_slope(const struct like_table *table, const struct grid *cell, double measured,
                     double *rms_slope, struct error *err);

#endif
