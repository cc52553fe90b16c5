/* Extends a map to a periodic one of twice its sides, which holds it and goes on as the law of its
 * spectrum says (FORMULAS.md, F18.49). */
#ifndef RUGO_CORE_MAP_EXTEND_H
#define RUGO_CORE_MAP_EXTEND_H

#include "core/map/height_map.h"
#include "core/surface/conditional.h"

struct extend_result {
    struct conditional_report draw;
    double noise;    /* RMS height to within which the map is held */
    bool noise_seen; /* in the spectrum of the map, so that it governs slopes (denoise.h); false: it
                        is a thousandth of the RMS height */
    bool law_holds;  /* the deviance of the fit (spectrum_fit.h) is within its limit */
    bool translated; /* heights are not Gaussian: normal scores (normal_scores.h) are extended, in
                        which all of the above but draw.difference is, and have the map's heights */
};
/* The map, open and with holes or none, is then in the first rows and columns. Holes are filled by
 * the law. A number of the seed is one draw. ERROR_INPUT, the map untouched, for maps to which no
 * law can be fitted or that are too large; ERROR_MEMORY; what conditional_draw() fails with. */
int map_extend(struct height_map *map, uint64_t seed, struct extend_result *out, struct error *err);

#endif
