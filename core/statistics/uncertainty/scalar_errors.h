/* Standard errors of the parameters of a map, as of a sub-map of an infinite surface of the same
 * kind. They follow from what each height, slope or summit changes in a parameter, and from the
 * variance of sums of that (low_modes.h). */
#ifndef RUGO_CORE_STATISTICS_UNCERTAINTY_SCALAR_ERRORS_H
#define RUGO_CORE_STATISTICS_UNCERTAINTY_SCALAR_ERRORS_H

#include "core/statistics/heights/plateau.h"
#include "core/statistics/summits/summit_list.h"
#include "core/statistics/uncertainty/cell_heights.h"
#include "core/surface/heights.h"

/* FORMULAS.md, F18.16. */
struct scalar_errors {
    double sa, sq, ssk, sku; /* of the parameters; sq is the RMS height */
    /* Of parameters from differences over the lag, over their values. */
    double slope, curvature, area, m0, m2, m4, alpha; /* area: of the developed one beyond 1 */
    double bends; /* of m4/m2^2: the part of alpha that is not of m0 */
};
void scalar_errors_heights(const struct cell_heights *heights, const struct low_modes *modes,
                           struct scalar_errors *out);
void scalar_errors_differences(const struct cell_differences *differences,
                               const struct cell_heights *heights, const struct low_modes *modes,
                               struct scalar_errors *out);
/* Errors of heights rest on far ones, which a map that has few of them underestimates. Changes
 * those of RMS height, skewness and kurtosis by the mean square that their influence has over the
 * distribution that fits the heights, over that which it has over the map (FORMULAS.md, F18.77).
 * law: standardised by `moments`. */
void scalar_errors_by_law(struct scalar_errors *errors, const struct measured_map *map,
                          const struct heights *law, const struct height_moments *moments);
/* The same by the law of a stratified face. */
void scalar_errors_by_strata(struct scalar_errors *errors, const struct measured_map *map,
                             const struct plateau_law *law);
/* Fills those of the same parameters over a share of the area alone, heights being those of all: a
 * mean over it differs from that over all by what a field has at wave number 0, over one area less
 * that over the other. */
void scalar_errors_inside(const struct scalar_errors *all, double share, struct scalar_errors *out);

struct summit_errors {
    double density, height_mean, height_deviation, curvature_mean;
};
/* Heights of summits are those above the mean of the map. searched[cells]: how many points of each
 * cell were searched; density: that which was found. NaN with fewer than 2 summits. */
void summit_errors_measure(const struct summit_list *list, double density, const struct grid *grid,
                           const double *searched, const struct cell_heights *heights,
                           const struct low_modes *modes, struct summit_errors *out);
/* Counts points with so many neighbours to all sides by cell. ERROR_MEMORY. */
int summit_cells_count(const struct measured_map *map, const struct low_modes *modes, size_t before,
                       size_t after, double *searched, struct error *err);

#endif
