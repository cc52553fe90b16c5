/* The parameters that say which measured surface the surfaces of a study are like. */
#ifndef RUGO_JOBS_LIKE_PARAMETERS_H
#define RUGO_JOBS_LIKE_PARAMETERS_H

#include "schema/study/parameter.h"

/* Where the spectrum and the heights of a study come from that is like a measured surface; GIVEN:
 * the study had them before. */
enum like_spectrum { LIKE_SPECTRUM_TABLE, LIKE_SPECTRUM_FIT, LIKE_SPECTRUM_GIVEN };
enum like_heights {
    LIKE_HEIGHTS_QUANTILES,
    LIKE_HEIGHTS_FIT,
    LIKE_HEIGHTS_GAUSSIAN,
    LIKE_HEIGHTS_GIVEN
};
extern const struct choice LIKE_SPECTRA[], LIKE_HEIGHTS[], LIKE_DETRENDS[], LIKE_QUANTITIES[];

/* The rows of /surface/like/... */
extern const struct parameter_table LIKE_PARAMETERS;

#endif
