/* The profile of a groove over one period, of mean 0 and of depth 1 from its lowest to its highest
 * point: FORMULAS.md, F18.70. */
#ifndef RUGO_CORE_SURFACE_GROOVES_GROOVE_PROFILE_H
#define RUGO_CORE_SURFACE_GROOVES_GROOVE_PROFILE_H

#include "core/error.h"
#include <complex.h>

enum groove_shape {
    GROOVE_SINE,
    GROOVE_ARCS,      /* arcs that open upwards, with cusps between them, as of a turning tool */
    GROOVE_TRIANGLE,  /* even flanks */
    GROOVE_SAW,       /* rises evenly and falls at once */
    GROOVE_HARMONICS, /* a sum of cosines */
    GROOVE_SHAPES
};
/* "sine", "arcs", "triangle", "saw", "harmonics". */
extern const char *const GROOVE_SHAPE_NAMES[GROOVE_SHAPES];

enum { GROOVE_HARMONICS_MOST = 64 };
struct groove_profile {
    enum groove_shape shape;
    size_t count;                                      /* of harmonics */
    double complex coefficient[GROOVE_HARMONICS_MOST]; /* of exp(2 pi i h t), h from 1 */
};

/* Returns the coefficient of exp(2 pi i h t), h >= 1, of a shape but GROOVE_HARMONICS. */
double complex groove_shape_coefficient(enum groove_shape shape, size_t h);
/* Makes the profile sum_h amplitude[h] cos(2 pi h t + phase[h]), h from 1, scaled to depth 1.
 * ERROR_INPUT where it is flat, and for no harmonics or more than GROOVE_HARMONICS_MOST. */
int groove_profile_of_harmonics(struct groove_profile *out, size_t count, const double *amplitude,
                                const double *phase, struct error *err);
/* Returns the height at t periods. */
double groove_profile_height(const struct groove_profile *profile, double t);
/* Fills the lowest and the highest point of sum_h 2 Re(coefficient[h] exp(2 pi i h t)) and where
 * they are, in periods. */
struct groove_extremes {
    double low, high, low_at, high_at;
};
struct groove_extremes groove_extremes_find(size_t count, const double complex *coefficient);

/* Means over a period of powers of the height, and of the slope by t squared: infinite where the
 * profile jumps. */
struct groove_moments {
    double second, third, fourth, slope;
};
struct groove_moments groove_profile_moments(const struct groove_profile *profile);

#endif
