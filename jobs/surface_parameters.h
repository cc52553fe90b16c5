/* The parameters of a surface, which every kind of study takes. */
#ifndef RUGO_JOBS_SURFACE_PARAMETERS_H
#define RUGO_JOBS_SURFACE_PARAMETERS_H

#include "core/surface/heights.h"
#include "schema/study/parameter.h"

enum alpha_formula { ALPHA_DISCRETE, ALPHA_CONTINUOUS };
/* What /surface/heights/distribution may be beside the HEIGHT_DISTRIBUTIONS; both are a
 * HEIGHTS_TABLE. */
enum heights_given { GIVEN_SAMPLES = HEIGHTS_TABLE, GIVEN_QUANTILES };

extern const struct parameter_table SURFACE_PARAMETERS;

#endif
