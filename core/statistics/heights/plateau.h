/* Heights of stratified faces, such as honed ones: at each point the lower of two Gaussian
 * surfaces, of a plateau and of the valleys below it (FORMULAS.md, F18.37). */
#ifndef RUGO_CORE_STATISTICS_HEIGHTS_PLATEAU_H
#define RUGO_CORE_STATISTICS_HEIGHTS_PLATEAU_H

#include "core/statistics/heights/functional.h"
#include <stdbool.h>

/* NaN, all of it, where no such law fits better than one straight line. */
struct plateau_law {
    double plateau_mean, plateau_rms; /* heights about the mean of the curve: Spq */
    double valley_mean, valley_rms;   /* the greater RMS: Svq */
    double ratio;                     /* of material where both lines cross: Smq */
    double residual, line_residual;   /* root mean square distances from the curve on the normal
                                         plot, in scores, weighted: of this law, and of one line */
};

/* Fits the law to the curve on the normal probability plot. */
void plateau_fit(const struct material_curve *curve, struct plateau_law *out);
/* Returns whether two laws fit far better than one, and well, and each has a share of the points:
 * far tails alone are no second surface. False for NaN. */
static inline bool plateau_stands(double residual, double line_residual, double ratio) {
    static const double BETTER = 0.5, WELL = 0.2, SHARE[2] = {0.1, 0.95}; /* RMS heights, shares */
    return residual < BETTER * line_residual && residual < WELL && ratio > SHARE[0] &&
           ratio < SHARE[1];
}
/* Returns the share of the points that reach a height about the mean, by the law. */
double plateau_ratio(const struct plateau_law *law, double height);

#endif
