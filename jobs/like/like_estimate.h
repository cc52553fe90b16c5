/* What random surfaces like a measured one have, fitted to it (FORMULAS.md, F18.27). All lengths
 * are in the unit of the map. */
#ifndef RUGO_JOBS_LIKE_LIKE_ESTIMATE_H
#define RUGO_JOBS_LIKE_LIKE_ESTIMATE_H

#include "core/map/preparation/detrend.h"
#include "core/statistics/patch.h"
#include "core/statistics/spectra/spectrum_fit.h"
#include "core/surface/heights.h"
#include "jobs/like/like_parameters.h"
#include "jobs/like/like_spectrum.h"

struct like_choices {
    enum like_spectrum spectrum;
    enum like_heights heights;
    enum detrend detrend; /* of the trend that was removed */
    bool exact_cell; /* of twice the points of the map, also where these make slow transforms */
    bool off_stated; /* surfaces whose RMS values are off by more than 5 % are made all the same */
};

/* Filled by like_estimate_measure; fields are read by all, changed by none. */
struct like_estimate {
    double measured[PATCH_QUANTITY_COUNT]; /* of the map; NaN: not known */
    struct spectrum_fit law;               /* that fits the map, whatever was chosen */
    struct grid cell;                      /* on which the surfaces have the RMS slope */
    struct lay lay;                        /* LAY_NONE: no directions differ */
    struct like_table table;               /* owned; LIKE_SPECTRUM_TABLE, else empty */
    struct spectrum self_affine;           /* LIKE_SPECTRUM_FIT, else empty */
    double rms_slope;                      /* of random surfaces on the cell; 0: not fitted */
    double noise; /* RMS of that of the map, which its surfaces do not have; 0: all is theirs */
    struct like_left left;
    enum heights_type distribution; /* LIKE_HEIGHTS_FIT */
    double shape;                   /* of it; NaN: it has none */
    size_t quantile_count;          /* LIKE_HEIGHTS_QUANTILES, else 0 */
    double *probability, *quantile; /* owned: quantile_count each */
};

/* ERROR_INPUT: a flat map, too few heights, grooves that do not end, no spectrum that gives the RMS
 * values. *out is to be cleared in any case. */
int like_estimate_measure(struct like_estimate *out, const struct measured_map *map,
                          const struct like_choices *choices, struct error *err);
/* Returns the RMS of the noise of a map, as the law that fits it has it: 0 where it does not govern
 * the curvature. */
double like_estimate_noise(const struct spectrum_fit *law, const struct grid *grid,
                           double rms_curvature);
void like_estimate_clear(struct like_estimate *estimate);

#endif
