/* One pass over the rows of a surface for all that its points add up to: while a strip of rows is
 * in cache, its heights are counted and summed, and its summits and pits are found. */
#ifndef RUGO_CORE_STATISTICS_SURFACE_PASS_H
#define RUGO_CORE_STATISTICS_SURFACE_PASS_H

#include "core/statistics/heights/histogram.h"
#include "core/statistics/summits/summits.h"

/* Of heights about 0: of a surface without a mean, as generated ones are, those about its mean. */
struct height_sums {
    double third, fourth; /* means of powers */
    double lowest, highest;
};

struct surface_pass {
    struct summit_finder *finder; /* borrowed, as all; its grid is that of the surface */
    const struct bins *bins;      /* of scale * height; NULL: not wanted, with the next two */
    double scale;
    uint64_t *counts;         /* bins->count + 2, which are added to */
    struct height_sums *sums; /* NULL: not wanted */
    struct summit_list *summits, *pits;
};
int surface_pass_run(const struct surface_pass *pass, const struct grid *grid, const double *z,
                     struct error *err);

#endif
