/* Spectra of maps with waves up to those of the grid, measured one after the other: nothing is
 * allocated or planned twice. One thread at a time. */
#ifndef RUGO_CORE_STATISTICS_SPECTRA_WHOLE_BAND_H
#define RUGO_CORE_STATISTICS_SPECTRA_WHOLE_BAND_H

#include "core/surface/modes.h"

struct whole_band;
/* coarser: the grid of every second point of each side, which must have an even number of points
 * (a profile along x alone); NULL: not wanted. */
int whole_band_create(struct whole_band **out, const struct grid *grid, const struct grid *coarser,
                      struct error *err);
void whole_band_destroy(struct whole_band **band);
double whole_band_bytes(const struct grid *grid, const struct grid *coarser);

/* Fills the modes below from a map by one transform, and returns its mean, which they lack. */
double whole_band_measure(struct whole_band *band, const double *z);
/* The squared amplitudes of the map, and those of every second point of it, whose waves are folded;
 * NULL where these are not wanted. Both are valid until the next map. */
const struct modes *whole_band_modes(const struct whole_band *band);
const struct modes *whole_band_coarser(const struct whole_band *band);

#endif
