/* The parameters of a surface, which every kind of study takes. */
#ifndef RUGO_JOBS_SURFACE_SURFACE_PARAMETERS_H
#define RUGO_JOBS_SURFACE_SURFACE_PARAMETERS_H

#include "core/surface/heights.h"
#include "schema/study/parameter.h"

enum alpha_formula { ALPHA_DISCRETE, ALPHA_CONTINUOUS };
/* Choices of /surface/heights/distribution beside the RUGO_DISTRIBUTIONS; both are a
 * HEIGHTS_TABLE. */
enum heights_given { GIVEN_SAMPLES = HEIGHTS_TABLE, GIVEN_QUANTILES };

/* The choice of /surface/spectrum/type beside the RUGO_SPECTRA, which becomes a table. */
enum spectrum_given { SPECTRUM_GIVEN_ACF = 100 };

extern const struct parameter_table SURFACE_PARAMETERS;
/* Those of a second face that the first is pressed on, and of its body: kinds of contact. */
extern const struct parameter_table COUNTER_PARAMETERS;

#endif
