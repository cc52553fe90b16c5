/* The spectrum of a map, as `characterise` tells it. */
#ifndef RUGO_SERVER_SHOW_CHARACTERISE_SPECTRUM_H
#define RUGO_SERVER_SHOW_CHARACTERISE_SPECTRUM_H

#include "core/statistics/spectrum_fit.h"
#include "server/show/characterisation.h"

/* Adds densities with their 95 % bands (columns psd, psd_x, psd_y), and the law that fits them
 * (group spectrum_fit). A map under a window of its own has neither bands nor a law: chance in it
 * is another. *out is undefined after a failure. */
int characterise_spectrum(struct characterisation *out, const struct measured_map *map,
                          bool under_window, const struct spectrum_fit_request *request,
                          struct error *err);

#endif
