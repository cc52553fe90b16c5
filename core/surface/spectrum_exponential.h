/* The exponential autocorrelation (FORMULAS.md, F2.2) of a periodic cell: what is prescribed is the
 * autocorrelation at the points of the grid, so that the spectrum is its transform there. Private
 * to core/surface and to theory of what was prescribed. */
#ifndef RUGO_CORE_SURFACE_SPECTRUM_EXPONENTIAL_H
#define RUGO_CORE_SURFACE_SPECTRUM_EXPONENTIAL_H

#include "core/surface/modes.h"

/* Returns the autocorrelation over its value at 0 for the lag (i dx, j dy), the shorter way round
 * the cell. */
double exponential_correlation(const struct spectrum *spectrum, const struct grid *grid, size_t i,
                               size_t j);
/* Fills the powers of modes, whose band is the whole grid, and their count. Where a transform is
 * negative there is no such surface: its power is 0, and modes->clipped their share of all.
 * ERROR_MEMORY alone. */
int exponential_fill(struct modes *modes, const struct spectrum *spectrum, struct error *err);

#endif
