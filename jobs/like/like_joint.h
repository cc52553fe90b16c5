/* What random surfaces like several maps of one surface have: one law fitted to all of them, and
 * the heights of all (FORMULAS.md, F18.51). All lengths are in the unit of the maps. */
#ifndef RUGO_JOBS_LIKE_LIKE_JOINT_H
#define RUGO_JOBS_LIKE_LIKE_JOINT_H

#include "core/statistics/spectra/joint_fit.h"
#include "jobs/like/like_estimate.h"

struct like_joint {
    size_t count;
    double between; /* deviation of ln C between maps beyond what their waves explain */
    /* Of each map; a shortest wave of 0: the spectrum ends there, and a map shows where. */
    struct spectrum_fit_request trusted[JOINT_PATCHES_MOST];
};

/* maps: 2 to JOINT_PATCHES_MOST, open, surfaces or all profiles; the first is that of which values
 * are measured. trusted: of each; NULL: by the maps. longest: that of the law; 0: the longest wave
 * that is trusted. choices: LIKE_SPECTRUM_FIT, and LIKE_HEIGHTS_QUANTILES or those that need no
 * map. Errors as of like_estimate_measure and joint_fit_measure. *out is to be cleared in any
 * case. */
int like_joint_measure(struct like_estimate *out, struct like_joint *joint, size_t count,
                       const struct measured_map *maps, const struct spectrum_fit_request *trusted,
                       double longest, const struct like_choices *choices, struct error *err);

#endif
