/* Quick estimates from the radial spectrum alone, before a discrete spectrum is made. */
#ifndef RUGO_CORE_SURFACE_SPECTRUM_ESTIMATE_H
#define RUGO_CORE_SURFACE_SPECTRUM_ESTIMATE_H

#include "core/surface/spectrum.h"

/* Summits (of profiles: peaks) that a cell of the grid's size is expected to hold, and the Nayak
 * parameter: Nayak's density (F6.7, F7.2) with moments integrated over the radial spectrum from
 * wave number long_waves to short_waves, both in waves per side lx of the cell. A table counts as
 * a constant density. */
double spectrum_expected_summits(const struct spectrum *spectrum, const struct grid *grid,
                                 double long_waves, double short_waves, double *alpha);

#endif
