/* The parameters of a surface, which every kind of study takes. */
#ifndef RUGO_JOBS_SURFACE_PARAMETERS_H
#define RUGO_JOBS_SURFACE_PARAMETERS_H

#include "schema/study/parameter.h"

enum alpha_formula { ALPHA_DISCRETE, ALPHA_CONTINUOUS };

extern const struct parameter_table SURFACE_PARAMETERS;

#endif
