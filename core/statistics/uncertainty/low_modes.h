/* Variance of the mean of a field over a map about that over an infinite surface: the field's
 * spectral density at wave number 0, over the area. The slowest waves of the map that are not
 * constant estimate this density wherever the field is stationary. Its distribution may be any, and
 * its correlation, too, as long as that is short beside the map (FORMULAS.md, F18.16). A field is
 * handed in as its sums over the cells of a coarse lattice. */
#ifndef RUGO_CORE_STATISTICS_UNCERTAINTY_LOW_MODES_H
#define RUGO_CORE_STATISTICS_UNCERTAINTY_LOW_MODES_H

#include "core/statistics/measured_map.h"
#include "core/statistics/spectra/correlation.h"

/* How fields that are made of a Gaussian surface are correlated: its heights, their powers,
 * products of its slopes; sampled as far as the correlation reaches. */

enum { FIELD_LAGS = 20, FIELD_SIDE = 2 * FIELD_LAGS + 1 };

/* value[b][a] is that at the lag ((a - FIELD_LAGS) step, (b - FIELD_LAGS) step), of any scale; 0
 * beyond the reach, of profiles in all rows but the middle one. */
struct correlation_field {
    double step; /* a length */
    double value[FIELD_SIDE][FIELD_SIDE];
};

/* Returns the longest lag, over directions, at which the correlation first falls to 0.2; NaN where
 * it does not within half a side in each. */
double correlation_length(const struct correlation *correlation);
/* Fills in a power of the correlation: that of a Hermite polynomial of the heights. It is followed
 * up to 2.5 lengths, beyond which it is mostly noise. */
void correlation_field_power(const struct correlation *correlation, const struct grid *grid,
                             double length, int power, struct correlation_field *out);
/* Fills in the square of its Laplacian by differences over a lag, which is a length: that of
 * products of two slopes over this lag, as a mean over directions. */
void correlation_field_slopes(const struct correlation *correlation, const struct grid *grid,
                              double length, double lag, struct correlation_field *out);

enum { LOW_CELLS_MOST = 256, LOW_MODES_MOST = 20 };

struct low_modes {
    bool open;               /* the map */
    size_t cells_x, cells_y; /* 16 x 16; of profiles 64 x 1 */
    size_t count;            /* of waves, which are degrees of freedom; at least 10 */
    /* Of wave m in cell number cy*cells_x + cx; its mean square over the cells is 1. Waves repeat
     * where the map does, else they are cosines that are flat at the sides. */
    double value[LOW_MODES_MOST][LOW_CELLS_MOST];
    double wave_x[LOW_MODES_MOST], wave_y[LOW_MODES_MOST]; /* wave vectors */
    /* How many times higher the density at 0 is than the mean over the waves, of fields whose
     * correlation is the square [2], or the cube [3], of that of the heights; else 1. */
    double excess[4];
};
/* Returns false for a map with fewer points along a side than cells. correlation: NULL where
 * `excess` is to be 1 throughout, as with fewer lengths inside than LENGTHS_INSIDE_LEAST. */
bool low_modes_fill(const struct measured_map *map, const struct correlation *correlation,
                    struct low_modes *out);

/* Returns the same of products of slopes over a lag, which is a length. */
double low_modes_excess_slopes(const struct low_modes *modes, const struct correlation *correlation,
                               const struct grid *grid, double lag);
/* Returns the degrees of freedom of low_modes_variance_within() of such products, of which the
 * cells have these counts: at most as many as there are waves. */
double low_modes_freedom_slopes(const struct low_modes *modes,
                                const struct correlation *correlation, const struct grid *grid,
                                double lag, const double *counts);

/* Returns the first of the n points of a side that is in a cell. */
static inline size_t cell_begin(size_t cell, size_t cells, size_t n) {
    return (cell * n + cells - 1) / cells;
}
/* Returns the cell of a point of n along a side. */
static inline size_t cell_of(size_t i, size_t cells, size_t n) {
    return i * cells / n;
}

/* Returns the sum over cells of wave m times sums[cells_x*cells_y]. */
double low_mode_amplitude(const struct low_modes *modes, size_t m, const double *sums);
/* Returns the variance of a mean over n values whose deviations add up to these sums in the cells.
 */
double low_modes_variance(const struct low_modes *modes, const double *sums, double n);
#define LOW_MODE_WEIGHT_LEAST 0.1
/* Returns the mean square of a wave about its mean, over as many values as each cell counts: 1
 * where all cells have as many. It is what a wave weighs of a field that is known in a part of the
 * map. */
double low_mode_weight(const struct low_modes *modes, size_t m, const double *counts);
/* The same variance for values of which the cells have these counts. Waves that weigh less than a
 * tenth are left out. NaN where all are. */
double low_modes_variance_within(const struct low_modes *modes, const double *sums,
                                 const double *counts, double n);
/* Returns by how many standard errors a 95 % interval reaches to either side (Student). */
double low_modes_factor(size_t count);
/* The same with these degrees of freedom, over that with as many as there are waves. */
double low_modes_factor_over(const struct low_modes *modes, double freedom);

/* Returns how many times the longest lag, over directions, at which the correlation falls to 0.2
 * fits into the shorter side; 0 where it does not fall so far within half a side. */
double correlation_lengths_inside(const struct correlation *correlation, const struct grid *grid);
/* With fewer than these no errors are reported. */
enum { LENGTHS_INSIDE_LEAST = 12 };

#endif
