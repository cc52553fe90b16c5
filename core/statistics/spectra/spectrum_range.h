/* Where the spectrum of a map can be trusted, by its shape alone: FORMULAS.md, F18.13. */
#ifndef RUGO_CORE_STATISTICS_SPECTRA_SPECTRUM_RANGE_H
#define RUGO_CORE_STATISTICS_SPECTRA_SPECTRUM_RANGE_H

#include "core/statistics/spectra/map_spectrum.h"

/* What ends the trusted wavelengths. */
enum spectrum_end {
    SPECTRUM_END_OPTION,   /* the caller said so */
    SPECTRUM_END_SIDE,     /* long: too few waves on a side of the map */
    SPECTRUM_END_SPACING,  /* short: too few points a wave */
    SPECTRUM_END_CUTOFF,   /* short: the spectrum ends there, sharply */
    SPECTRUM_END_LOW_PASS, /* short: it falls faster than any self-affine one, as by an instrument
                            */
    SPECTRUM_END_NOISE,    /* short: it is flat or rises, as noise does */
    SPECTRUM_ENDS
};
/* "option", "map side", "point spacing", "cut-off", "low pass", "noise". */
extern const char *const SPECTRUM_END_NAMES[SPECTRUM_ENDS];

struct low_modes;
struct spectrum_fit_request {
    double longest, shortest; /* wavelengths that are trusted; 0: by the map itself */
    /* The map of the spectrum, and its slow waves: where heights are not Gaussian their own scatter
     * counts in the errors of a fit. NULL: that of Gaussian ones. Borrowed. */
    const struct measured_map *map;
    const struct low_modes *modes;
};

struct spectrum_range {
    size_t first, last; /* rings; first > last where there are none */
    enum spectrum_end from_end, to_end;
    size_t steep;        /* the first ring where the density falls faster than any law's; 0: none */
    size_t edge;         /* the ring in which a sharp end lies; 0: none */
    double noise;        /* density of a flat tail; 0: none */
    double tail_density; /* of the shortest waves of the map: white noise has no more */
};
/* So many rings before a sharp end hold what the window blurs of it. */
enum { SPECTRUM_BLURRED = 3 };
/* ERROR_INPUT where the request leaves no ring. */
int spectrum_range_find(const struct map_spectrum *spectrum,
                        const struct spectrum_fit_request *request, struct spectrum_range *out,
                        struct error *err);

#endif
