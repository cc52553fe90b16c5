/* Mean squares of differences of neighbours, against which artefacts are measured. */
#ifndef RUGO_CORE_MAP_ARTEFACTS_DIFFERENCES_H
#define RUGO_CORE_MAP_ARTEFACTS_DIFFERENCES_H

#include "core/surface/grid.h"

/* Of one axis; NaN where the map has none of these. */
struct differences {
    double mean;   /* of z[i+1] - z[i] */
    double first;  /* their variance */
    double second; /* mean square of z[i-1] - 2 z[i] + z[i+1] */
};
struct map_differences {
    struct differences axis[2]; /* along x and along y; of profiles NaN along y */
    double rms_height;          /* about the mean */
    double highest;             /* size of the height farthest from 0, as it was stored */
};
/* Holes (NaN) are left out. */
void map_differences_measure(const struct grid *grid, const double *z, struct map_differences *out);

/* Returns the second difference along an axis (0: x, 1: y) about a point inside. */
static inline double second_difference(const double *at, size_t stride) {
    return at[stride] - at[0] - (at[0] - *(at - stride));
}
/* Returns the slope, and its square, that the variances of first differences come to. */
double differences_square(const struct grid *grid, const double first[2]);

/* Whether an artefact counts: it changes the RMS slope by more than ARTEFACT_SLOPE_MOST, or has
 * more than ARTEFACT_SHARE_MOST of the mean square of second differences. slope: RMS slope without
 * it over that with it; NaN: not known. */
#define ARTEFACT_SLOPE_MOST 0.02
#define ARTEFACT_SHARE_MOST 0.05
static inline bool artefact_counts(double slope, double share) {
    return !(slope > 1 - ARTEFACT_SLOPE_MOST) || share > ARTEFACT_SHARE_MOST;
}

#endif
