/* Standard errors of functional parameters from one map (FORMULAS.md, F18.61), as those of other
 * parameters (scalar_errors.h): what a slow wave of weights changes in them. */
#ifndef RUGO_CORE_STATISTICS_UNCERTAINTY_FUNCTIONAL_ERRORS_H
#define RUGO_CORE_STATISTICS_UNCERTAINTY_FUNCTIONAL_ERRORS_H

#include "core/statistics/heights/functional.h"
#include "core/statistics/heights/plateau.h"
#include "core/statistics/uncertainty/map_chance.h"
#include "core/surface/heights.h"

/* A standard error in the place of each parameter; NaN where none is known. */
struct functional_errors {
    struct functional found;
    struct plateau_law plateau; /* NaN where the map has none, or only just */
};

/* map: of the material curve, and of map_chance. All errors are NaN where that knows none. Time:
 * that of some 40 sorted curves of at most 65536 heights. ERROR_MEMORY. */
int functional_errors_measure(struct functional_errors *out, const struct measured_map *map,
                              const struct material_curve *curve, const struct map_chance *chance,
                              struct error *err);
/* Heights that end at a bound end less sharply where a trend was taken out, as that holds tilts of
 * the surface itself. Adds what such tilts change in the parameters of the distribution that fits
 * the heights (F18.52). law: standardised by `moments`. ERROR_MEMORY. */
int functional_errors_by_law(struct functional_errors *out, const struct map_chance *chance,
                             const struct heights *law, const struct height_moments *moments,
                             bool profile, struct error *err);

#endif
