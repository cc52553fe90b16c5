/* Spikes: single points, or two beside each other, that do not go with their neighbours
 * (FORMULAS.md, F18.31). */
#ifndef RUGO_CORE_MAP_DESPIKE_H
#define RUGO_CORE_MAP_DESPIKE_H

#include "core/surface/grid.h"

struct despike_result {
    size_t spikes;
    double deviation; /* robust standard deviation of heights from what two on either side of them
                         along an axis predict; 0: of none */
    double largest;   /* of a spike, in these from what its neighbours predict; 0: there is none */
};

/* Replaces by NaN each height that lies more than `most` robust deviations from what its neighbours
 * predict, in all directions but one of four, of a profile from both sides and from each. The
 * deviation is that of the map, or half that of the neighbours from their median where this is
 * more, so that high and rough parts of skewed heights stay. Nothing is known beyond the sides.
 * Heights that have neighbours in fewer than two directions stay. Memory: a map. ERROR_MEMORY; the
 * heights are untouched then. */
int despike(const struct grid *grid, double *z, double most, struct despike_result *out,
            struct error *err);

#endif
