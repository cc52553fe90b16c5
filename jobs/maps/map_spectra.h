/* Spectral densities of a map with their 95 % bands, and the self-affine law that fits. */
#ifndef RUGO_JOBS_MAPS_MAP_SPECTRA_H
#define RUGO_JOBS_MAPS_MAP_SPECTRA_H

#include "core/statistics/spectra/spectrum_fit.h"
#include "core/statistics/uncertainty/map_directions.h"
#include "jobs/maps/map_extent.h"

/* One density; all arrays have `count` values and are owned by wave_number. */
struct map_density {
    size_t count; /* 0: there is none */
    double *wave_number, *density;
    double *low, *high; /* its band; NULL: none is known */
    double *law;        /* the fitted law; NaN beyond its ends; NULL: none fits */
};
struct map_spectra {
    struct map_density rings;   /* over |k| */
    struct map_density line[2]; /* along x, along y */
    bool has_fit;               /* the trusted range was sought, and a law in it */
    struct spectrum_fit fit;
    bool has_scores;   /* their normal scores have a sharp end, and these a law before it */
    double scores_end; /* wavelength of that */
    struct spectrum_fit scores;
};
/* Measures a map; directions: of surfaces alone. *out is {0} at first, and the caller's to clear in
 * any case. A map under a window of its own has neither bands nor a law, since its waves scatter
 * otherwise. Of MAP_MAIN the densities are NaN. ERROR_INPUT where the request leaves no wave;
 * ERROR_MEMORY. */
int map_spectra_measure(struct map_spectra *out, const struct measured_map *map,
                        const struct map_spectrum *spectrum,
                        const struct map_directions *directions, bool under_window,
                        const struct spectrum_fit_request *request, enum map_extent extent,
                        struct error *err);
/* Looks whether the normal scores (F18.46) have a sharp end at short waves, where skewed heights
 * fall off, and fits the law to their waves before it. */
int map_spectra_measure_scores(struct map_spectra *out, const struct measured_map *map,
                               const struct map_directions *directions,
                               const struct spectrum_fit_request *request, struct error *err);
void map_spectra_clear(struct map_spectra *spectra);

#endif
