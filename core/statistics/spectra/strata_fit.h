/* The two laws of a stratified face (F18.37): the self-affine spectra of its valleys and of its
 * plateau, from pairs of points in one map of the lower of both (FORMULAS.md, F18.65). */
#ifndef RUGO_CORE_STATISTICS_SPECTRA_STRATA_FIT_H
#define RUGO_CORE_STATISTICS_SPECTRA_STRATA_FIT_H

#include "core/statistics/heights/plateau.h"
#include "core/statistics/measured_map.h"

enum stratum { STRATUM_VALLEYS, STRATUM_PLATEAU, STRATA };
struct strata_law {
    double wavelength_short; /* of both: a whole number of points, so that meshes of studies fit */
    double hurst[STRATA], wavelength_long[STRATA];
    double rms_slope[STRATA]; /* by forward differences */
    double rms_ratio, offset; /* as of plateau_face.h */
};
/* heights: the law of the map's heights (plateau_fit()). The map may have holes. ERROR_INPUT for a
 * map of fewer than 32 columns; ERROR_MEMORY. */
int strata_fit(struct strata_law *out, const struct measured_map *map,
               const struct plateau_law *heights, struct error *err);

#endif
