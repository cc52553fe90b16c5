/* A step of the alternation between spectrum and heights that ranks by a table (rank_table.h) and
 * handles rows while they are in cache. Heights are in standard deviations. */
#ifndef RUGO_CORE_SURFACE_FAST_STEP_H
#define RUGO_CORE_SURFACE_FAST_STEP_H

#include "core/surface/height_error.h"
#include "core/surface/transform.h"

/* With s the surface of exact spectrum nearest to the iterate and h the heights in the order of y:
 *     momentum     y = s,        next iterate h + factor (h - h of the step before);
 *     reflection   y = 2 s - x,  next iterate x <- factor (x + h) + (1 - 2 factor) s
 * (FORMULAS.md, F5.4 and F5.6). */
enum fast_kind { FAST_MOMENTUM, FAST_REFLECTION };
struct fast_move {
    enum fast_kind kind;
    double factor;
    bool first; /* of its kind: there is no x yet, which is s, nor h of a step before, which is h */
};

struct fast_step;

/* Borrows all arguments, as the steps do. ERROR_MEMORY. */
int fast_step_create(struct fast_step **out, const struct modes *modes, struct error *err);
void fast_step_destroy(struct fast_step **step);
double fast_step_bytes(const struct grid *grid);

/* Begins a run with this surface. */
void fast_step_start(struct fast_step *step, const double *z);
/* From the transform's spectrum of an iterate to that of the next. amplitude: of s, laid out as
 * modes->power; sorted: the heights, rising; z, x: points each, z is overwritten by y, and x is
 * kept from step to step of a kind. Returns eps_h of s where errors are given, NaN where NULL. */
double fast_step_run(struct fast_step *step, struct transform *transform, const double *amplitude,
                     const double *sorted, struct fast_move move, double *z, double *x,
                     struct height_error *errors);

#endif
