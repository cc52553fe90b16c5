/* The parameters of the measured surface that the surfaces of a study resemble. */
#ifndef RUGO_JOBS_LIKE_LIKE_PARAMETERS_H
#define RUGO_JOBS_LIKE_LIKE_PARAMETERS_H

#include "schema/study/parameter.h"

/* Sources of the spectrum and of the heights of such a study; GIVEN: the study had them before. */
enum like_spectrum { LIKE_SPECTRUM_TABLE, LIKE_SPECTRUM_FIT, LIKE_SPECTRUM_GIVEN };
enum like_heights {
    LIKE_HEIGHTS_QUANTILES,
    LIKE_HEIGHTS_FIT,
    LIKE_HEIGHTS_GAUSSIAN,
    LIKE_HEIGHTS_GIVEN
};
/* Whether what the patch leaves open is estimated (like_draw.h). */
enum like_uncertainty { LIKE_UNCERTAINTY_NONE, LIKE_UNCERTAINTY_POSTERIOR };
/* Characters of what is known of the files of further maps. */
enum { LIKE_OTHERS_TEXT = 60000 };
/* Of each of several maps: points along x and y, their distance, trusted waves from and to. */
enum { LIKE_MAP_NUMBERS = 5 };
/* The most points of a patch that surfaces hold, and the characters of its text. */
enum { LIKE_PATCH_POINTS = 1 << 18, LIKE_PATCH_TEXT = (4 * LIKE_PATCH_POINTS + 2) / 3 * 4 };
/* What the study gave itself, so that no patch leaves it open. */
enum like_held { LIKE_HELD_SCALE, LIKE_HELD_LAY, LIKE_HELD_ROLLOFF, LIKE_HELD_COUNT };
extern const struct choice LIKE_SPECTRA[], LIKE_HEIGHTS[], LIKE_DETRENDS[], LIKE_QUANTITIES[],
    LIKE_UNCERTAINTIES[], LIKE_HELD[];

/* The rows of /surface/like/... */
extern const struct parameter_table LIKE_PARAMETERS;

#endif
