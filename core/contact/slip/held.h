/* Stiffness of a set of nodes that is held against a rigid flat, without slip and without opening,
 * across the face and along it: both of an elastic half-space on a periodic grid (F24.2).
 *
 * Along the face the load is the mean traction in one direction; that across it is 0. All nodes of
 * the set move alike in both directions, and pressures do not change. A solve takes some ten steps
 * of 8 transforms, across the face of 4. */
#ifndef RUGO_CORE_CONTACT_SLIP_HELD_H
#define RUGO_CORE_CONTACT_SLIP_HELD_H

#include "core/surface/grid.h"

struct held_stiffness {
    double normal;     /* d(mean pressure)/d(approach), E* per length */
    double tangential; /* d(mean traction)/d(displacement) in its direction, E* per length */
    double ratio;      /* tangential over normal; NaN where these are 0 or infinite */
    size_t iterations; /* of both */
    double work;       /* points x transforms, as that of contact_state */
};

struct held;
/* Makes a workspace, which belongs to one thread. poisson in [0, 0.5]. ERROR_INPUT for others, or
 * for a grid out of range; ERROR_MEMORY. */
int held_create(struct held **out, const struct grid *grid, double poisson, struct error *err);
void held_destroy(struct held **held);
double held_bytes(const struct grid *grid);
/* Sets stop, which is called every few iterations. When it returns non-zero, held_measure fails
 * with ERROR_STOPPED. NULL, the initial value, never stops. */
void held_set_stop(struct held *held, int (*stop)(void *context), void *context);

/* Of the nodes p[grid_points] > 0, for a load at this angle from the x axis, in radians; profiles
 * have one direction, and a ratio of 1. residual: the largest one, over the displacement; the error
 * of a stiffness is about its square. Both are 0 without such nodes, INFINITY where all are.
 * ERROR_INPUT for a residual that is not above 0; ERROR_NUMERIC, with what was reached, where it is
 * not met. */
int held_measure(struct held *held, const double *p, double angle, double residual,
                 struct held_stiffness *out, struct error *err);

#endif
