/* The kind "statistics": summit statistics, spectra and roughness of random surfaces. */
#ifndef RUGO_JOBS_STATISTICS_H
#define RUGO_JOBS_STATISTICS_H

#include "jobs/kind.h"

extern const struct job_kind STATISTICS_KIND;

#endif
