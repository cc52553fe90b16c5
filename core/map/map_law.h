/* The law that fits the spectrum of a map, along a lay where its directions differ. */
#ifndef RUGO_CORE_MAP_MAP_LAW_H
#define RUGO_CORE_MAP_MAP_LAW_H

#include "core/statistics/spectra/spectrum_fit.h"

struct map_law {
    struct spectrum_fit fit; /* of waves across the lay, without a ratio */
    struct lay lay;
    /* Densities over circles, or along the lay over ellipses; owned. */
    struct map_spectrum *circles, *ellipses;
};
/* Fits. ERROR_MEMORY; *out needs no map_law_clear then. */
int map_law_fit(struct map_law *out, const struct measured_map *map, struct error *err);
void map_law_clear(struct map_law *law);

/* Returns the density of the law at a wave number across the lay. Longer waves than the law's have
 * that of its longest, shorter ones 0. */
double map_law_density(const struct map_law *law, double wave_number);
/* Does likewise between the trusted wavelengths. Longer waves have the densities of the map's
 * rings, and those longer than its shorter side that of this. Shorter waves than the law's, where
 * no noise hides them, have those of the rings, too, and behind a sharp end those of three rings
 * further. */
double map_law_whole_density(const struct map_law *law, double wave_number);

/* Fills one value a wave of the half spectrum of transform.h: of_wave at its wave number across the
 * lay. */
void map_law_fill(const struct map_law *law, const struct grid *cell,
                  double of_wave(const struct map_law *law, double wave_number), double *out);

#endif
