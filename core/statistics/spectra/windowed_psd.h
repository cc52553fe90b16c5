/* The spectral density of a map that does not repeat. */
#ifndef RUGO_CORE_STATISTICS_SPECTRA_WINDOWED_PSD_H
#define RUGO_CORE_STATISTICS_SPECTRA_WINDOWED_PSD_H

#include "core/statistics/measured_map.h"
#include <stdlib.h>

/* Under Hann's window so many waves beside each other count as one, along an axis:
 * 1 + 2 (2/3)^2 + 2 (1/6)^2. */
#define WINDOWED_ALIKE (35.0 / 18)
/* Waves this far apart, along an axis, have powers that are alike by these shares. */
enum { WINDOWED_REACH = 2 };
static inline double windowed_alike(long apart) {
    return apart == 0 ? 1 : labs(apart) == 1 ? 4.0 / 9 : labs(apart) == 2 ? 1.0 / 36 : 0;
}
/* Returns Hann's window at point i of n; 1 of a single one, as profiles have along their second
 * axis.
 */
double hann_window(size_t i, size_t n);

/* Fills rings as psd_measure does, radial_bins(grid) of them, of an open map times Hann's window,
 * its density divided by the mean square of the window; the mean under the window is taken out.
 * Holes are filled from their rim inwards by means of neighbours (FORMULAS.md, F18.7).
 * ERROR_MEMORY, or ERROR_INPUT for a map of holes alone. */
int windowed_psd_measure(const struct measured_map *map, double *wave_number, double *density,
                         struct error *err);

/* Fills z with the heights of the map under the window, as above; *power: mean square of the
 * window. */
int windowed_heights(const struct measured_map *map, double *z, double *power, struct error *err);

#endif
