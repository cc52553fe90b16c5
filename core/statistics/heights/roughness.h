/* Roughness parameters, autocorrelation and spectral density of a height map. */
#ifndef RUGO_CORE_STATISTICS_HEIGHTS_ROUGHNESS_H
#define RUGO_CORE_STATISTICS_HEIGHTS_ROUGHNESS_H

#include "core/statistics/measured_map.h"
#include "core/surface/spectrum.h"
#include <math.h>

/* These parameters come from finite differences on the periodic grid (FORMULAS.md, F1.3): forward
 * differences for slopes, central second ones for curvatures, as in the reference
 * (core/theory/BIBLIOGRAPHY.md). */
struct roughness {
    double mean, rms_height, rms_slope, rms_curvature; /* about the mean; profile: |z'|, z'' */
    double skewness, kurtosis;                         /* NaN for a flat map */
    double m2, m4, nayak_alpha; /* finite-difference moments (mean of x and y) */
    double lowest, highest;
};
void roughness_measure(const struct grid *grid, const double *z, struct roughness *out);
/* Of a map that does not repeat, or that has holes. Measures as roughness_measure does, over the
 * heights and differences that are there (FORMULAS.md, F18.2); NaN where there are none. */
void open_roughness_measure(const struct measured_map *map, struct roughness *out);
/* Measures as one of these does, by whether the map repeats. */
void map_roughness_measure(const struct measured_map *map, struct roughness *out);

/* Spectral moments of a height map by its transform (F2.3). Works on any map, band-limited or not.
 */
int roughness_spectral(const struct grid *grid, const double *z, struct moments *out,
                       struct error *err);

/* Fills *modes with the squared amplitudes of a map, on the whole half plane; the caller frees
 * their power. */
int map_modes_measure(const struct grid *grid, const double *z, struct modes *modes,
                      struct error *err);
/* Returns the number of radial bins of the functions below for a grid: rings of width one in |m|
 * (min(lx,ly)). */
size_t radial_bins(const struct grid *grid);
/* Returns the nearest whole number to the length of (x, y), (size_t)(hypot(x, y) + 0.5), 2^52 of
 * those beyond. A root of squares, which takes a fraction of the time, decides it but where its
 * rounding may matter. */
static inline size_t ring_of(double x, double y) {
    static const double ROUNDING = 1e-12, WHOLE_MOST = 0x1p52;
    double reach = sqrt(x * x + y * y) + 0.5, margin = ROUNDING * reach;
    if (!(reach < WHOLE_MOST)) /* squares of lengths may overflow, and no grid has such a ring */
        return (size_t)WHOLE_MOST;
    size_t ring = (size_t)reach;
    double beyond = reach - (double)ring;
    return beyond > margin && 1 - beyond > margin ? ring : (size_t)(hypot(x, y) + 0.5);
}
/* Returns the bin of a wave vector of the grid, and fills how many of the full plane each bin
 * has. */
size_t radial_bin(const struct grid *grid, size_t mx, long my);
void radial_counts(const struct grid *grid, double *count);
/* Power spectral density, radially averaged for surfaces: C(k) such that m00 = integral of
 * C dkx dky (surface) or of C dk over both signs (profile). wave_number and density have
 * radial_bins entries (bin r: r - 1/2 <= |m| < r + 1/2, wave_number 2 pi r / min(lx, ly)). */
int psd_measure(const struct grid *grid, const double *z, double *wave_number, double *density,
                struct error *err);
/* Does likewise for a discrete spectrum, which costs no transform. */
void psd_of_modes(const struct modes *modes, double *wave_number, double *density);
/* The same over the waves of a ring that lie within the band, so that rings at its ends have its
 * density, too. */
void psd_of_band(const struct modes *modes, double *wave_number, double *density);
/* Returns the number of lags 0, dx, 2dx ... up to half of the shorter side, so that all directions
 * of a ring are there: nx/2 + 1 of profiles and squares. */
size_t acf_lags(const struct grid *grid);
/* Measures the autocorrelation R(r)/R(0) at these lags, radially averaged for surfaces. */
int acf_measure(const struct grid *grid, const double *z, double *lag, double *correlation,
                struct error *err);
/* Means of a field over the same rings, over its value at the origin, about which it is even. */
int ring_average(const struct grid *grid, const double *field, double *lag, double *mean,
                 struct error *err);
int acf_of_modes(const struct modes *modes, double *lag, double *correlation, struct error *err);
/* The same, and by how much less it would be on every second point of the grid: at lags 0, 2 dx, 4
 * dx ..., (acf_lags + 1)/2 of them; NaN where a side has an odd number of points, or y two; NULL:
 * not wanted. This is the effect of the width of rings on the correlation; it is 0 for profiles,
 * whose rings are single lags. */
int acf_of_modes_changes(const struct modes *modes, double *lag, double *correlation,
                         double *change, struct error *err);

#endif
