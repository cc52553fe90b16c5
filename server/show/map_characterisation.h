/* What `characterise` tells of a map in a file: first what was done to it, and why. */
#ifndef RUGO_SERVER_SHOW_MAP_CHARACTERISATION_H
#define RUGO_SERVER_SHOW_MAP_CHARACTERISATION_H

#include "core/map/preparation.h"
#include "core/statistics/spectrum_fit.h"
#include "server/show/characterisation.h"

/* Fills *out, {0} at first, which the caller clears either way, with what the map is like and what
 * was done to it before (preparation_run); out borrows the texts of the record. Its spectrum is
 * fitted over the wavelengths of `trusted` (spectrum_fit.h), which are {0} where the map is to tell
 * them. ERROR_INPUT where these leave no wave. */
int map_characterise(struct characterisation *out, const struct height_map *map,
                     const struct preparation_record *record,
                     const struct spectrum_fit_request *trusted, struct error *err);

#endif
