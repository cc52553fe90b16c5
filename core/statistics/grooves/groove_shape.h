/* The shape that the lines of a family make (FORMULAS.md, F18.74). */
#ifndef RUGO_CORE_STATISTICS_GROOVES_GROOVE_SHAPE_H
#define RUGO_CORE_STATISTICS_GROOVES_GROOVE_SHAPE_H

#include "core/statistics/grooves/groove_lines.h"
#include "core/surface/grooves/groove_profile.h"

/* The shape that lines make. */
struct groove_shape_depth {
    double probability, depth, depth_error;
};
struct groove_shape_fit {
    enum groove_shape shape; /* GROOVE_HARMONICS: none of the named ones */
    bool reversed;           /* a saw that falls along the wave vector */
    double p_value;          /* of that shape, by the lines of all harmonics; NaN: harmonics */
    double depth, depth_error;
    struct groove_shape_depth of[GROOVE_HARMONICS]; /* if it were that shape */
    double at;       /* where that shape begins, in periods before the middle */
    size_t standing; /* harmonics up to the last that stands out of the random part */
};
/* Finds the named shape that fits best. */
void groove_shape_find(struct groove_shape_fit *out, const struct groove_lines *lines);
#define GROOVE_SHAPE_LEVEL 0.003 /* of the p-value, below which no named shape holds */
/* Makes the shape that of the lines themselves. */
void groove_shape_forget(struct groove_shape_fit *fit, const struct groove_lines *lines);
/* Returns the coefficient of exp(2 pi i h t), t = 0 in the middle of the map, that harmonic h of
 * the shape has; 0 of GROOVE_HARMONICS. A saw falls within the share `jump` of its period. */
double complex groove_shape_line(const struct groove_shape_fit *fit, size_t h, double jump);
/* Whether the shape has lines without end, so that its heights come from groove_shape_height: a
 * sine is its first line, and GROOVE_HARMONICS are the lines themselves. */
bool groove_shape_endless(const struct groove_shape_fit *fit);
/* Returns the lines beyond those of an endless shape; all of another. */
struct groove_lines groove_lines_beyond(const struct groove_lines *lines,
                                        const struct groove_shape_fit *fit, double jump);
/* Returns the height of such a shape but GROOVE_HARMONICS at t periods from the middle. */
double groove_shape_height(const struct groove_shape_fit *fit, double t, double jump);

#endif
