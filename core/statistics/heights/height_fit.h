/* Which distribution the heights of a map have: the shape of each that a surface can be asked for
 * (core/surface/heights.h), its interval, and how well it fits. Heights are taken about their mean
 * and over their RMS. Heights of neighbours are correlated, so that errors and tests count
 * independent heights (low_modes.h), not points. */
#ifndef RUGO_CORE_STATISTICS_HEIGHTS_HEIGHT_FIT_H
#define RUGO_CORE_STATISTICS_HEIGHTS_HEIGHT_FIT_H

#include "core/statistics/uncertainty/cell_heights.h"
#include "core/surface/heights.h"

struct height_fit {
    enum heights_type type;       /* its name and family by heights_distribution() */
    double shape;                 /* NaN: it has none */
    double shape_low, shape_high; /* 95 % interval; NaN without shape, and where the map has too few
                                     correlation lengths */
    double distance;              /* Anderson and Darling's, a mean square: 0 is a perfect fit */
    double p_value; /* of a surface that has these heights to be as far away; NaN: as above */
    double aic;     /* Akaike's criterion for so many independent heights; NaN: as above */
};
struct height_fits {
    size_t best;        /* in the list: the least aic, or Gaussian where that is nearly as good */
    double independent; /* heights that would determine the distribution as well, were they
                           independent; NaN: as above */
    struct height_fit list[HEIGHTS_QUANTILE]; /* in the order of enum heights_type */
};
/* FORMULAS.md, F18.17. modes: NULL where the map is too small for errors. Flat maps have NaN
 * throughout. */
void height_fit_measure(const struct cell_heights *heights, const struct low_modes *modes,
                        struct height_fits *out);

#endif
