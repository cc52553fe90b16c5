/* Gaussian filters of profiles and surfaces (ISO 16610-21 and -61), and robust ones (-31 and -71).
 * FORMULAS.md, F18.21. */
#ifndef RUGO_CORE_MAP_GAUSSIAN_FILTER_H
#define RUGO_CORE_MAP_GAUSSIAN_FILTER_H

#include "core/statistics/measured_map.h"

struct gaussian_filter {
    double cut_off;        /* wavelength, in the unit of the grid */
    bool keeps_long_waves; /* an S-filter; otherwise an L-filter, which removes them */
    bool robust;           /* heights far from the mean surface lose their weight */
    bool metres;           /* that unit is the metre, which messages name */
};
struct gaussian_filter_result {
    double transmission; /* of the Gaussian, for waves as long as the cut-off */
    size_t steps;        /* of the weights of a robust filter */
    double rejected;     /* share of the heights whose weight is 0 in the end */
};

/* Filters the heights in place; holes stay. Near the sides of an open map, and near holes, the
 * weights of the heights present are normalised to sum 1. Memory: up to four maps. ERROR_INPUT
 * where the cut-off is too short for the points or longer than the map. */
int gaussian_filter_run(const struct grid *grid, double *z, enum boundary boundary,
                        const struct gaussian_filter *filter, struct gaussian_filter_result *out,
                        struct error *err);

#endif
