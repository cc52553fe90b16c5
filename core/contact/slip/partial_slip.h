/* Partial slip of a rough block on a rigid flat under a load along the face, with friction after
 * Coulomb: an elastic half-space on a periodic grid, whose pressures and tractions along the face
 * are coupled (F24.3).
 *
 * The flat is pressed on with a mean pressure, without friction or with it. Then the mean traction
 * along the face follows loads below friction times the mean pressure, which may rise and fall; the
 * pressure stays. Slip of a load is that since the one before: a path of loads is as fine as its
 * steps. Tractions are in units of E* = E/(1 - nu^2), lengths in the grid's.
 *
 * A workspace belongs to one thread. Order of calls: slip_press, then slip_load for each load. */
#ifndef RUGO_CORE_CONTACT_SLIP_PARTIAL_SLIP_H
#define RUGO_CORE_CONTACT_SLIP_PARTIAL_SLIP_H

#include "core/surface/grid.h"
#include <stdbool.h>

struct slip_options {
    double poisson;     /* of the block, in [0, 0.5]; 0.5: no coupling */
    double friction;    /* coefficient, 0 or more; up to 1 is tested */
    double angle;       /* of the load from the x axis, in radians; profiles have 0 alone */
    size_t press_steps; /* 0: pressed without friction; else friction acts in so many steps of the
                           pressure, whose root rises evenly */
    double tolerance;   /* on the largest violation of gaps over the largest displacement; of slips
                           over that times friction, where this is below 1, and of directions
                           of tractions by what these move a node; default 1e-8 */
    size_t max_sets;    /* sets of nodes a step, after which it is halved; default 40 */
    size_t max_iterations; /* of linear equations a load with all its halves, after which it fails;
                              of each step of pressing; default 400 */
};
extern const struct slip_options SLIP_DEFAULTS;

/* The state under one load. The arrays belong to the workspace and are valid until its next
 * call. */
struct slip_state {
    double pressure, traction; /* means; the traction is that along the load */
    const double *p;           /* grid_points */
    const double *qx, *qy;     /* grid_points: tractions on the block; qy of profiles is NULL */
    const double *gap;         /* grid_points */
    const double *over;      /* grid_points: displacement of the face over the flat, along the load,
                                since the end of pressing */
    const bool *sticks;      /* grid_points */
    size_t nodes, stuck;     /* with p > 0, and those of them that do not slip */
    double stick_area;       /* stuck over nodes; 0 without contact */
    double stick_load;       /* pressures of stuck nodes over all */
    double mean_gap;         /* the grid's length */
    double displacement;     /* of the flat over the mean plane of the face, along the load, since
                                the end of pressing */
    double work;             /* of the traction on it, by area: E* times a length, by trapezoids */
    double dissipation;      /* by slip, likewise */
    size_t sets, iterations; /* of this load; of linear equations */
    double cost;             /* points x transforms, as the work of contact_state */
    double violation;        /* largest, over what the tolerance refers to */
};

struct slip;
/* ERROR_INPUT for options out of the ranges above, or for a grid out of range; ERROR_MEMORY. */
int slip_create(struct slip **out, const struct grid *grid, const struct slip_options *options,
                struct error *err);
void slip_destroy(struct slip **slip);
double slip_bytes(const struct grid *grid);
/* Sets stop, which is called at each set of nodes. When it returns non-zero, a call fails with
 * ERROR_STOPPED. NULL, the initial value, never stops. */
void slip_set_stop(struct slip *slip, int (*stop)(void *context), void *context);

/* Presses heights z[grid_points], of any mean, to a mean pressure above 0. Without friction p has
 * the digits of contact_press (core/contact/contact.h) with this tolerance. ERROR_INPUT for a
 * height that is not finite or a pressure out of range; ERROR_NUMERIC, with loads and residual,
 * where it does not converge. After a failure it must be called again. */
int slip_press(struct slip *slip, const double *z, double pressure, struct slip_state *out,
               struct error *err);
/* Takes the mean traction to this value, between -friction * pressure and friction * pressure,
 * without these. ERROR_INPUT with both where it is not, ERROR_STATE before slip_press,
 * ERROR_NUMERIC as above. After one of these the state is that before the call. A load that was
 * halved and then failed, or was stopped, ends at a load between, from which the next one goes on.
 */
int slip_load(struct slip *slip, double traction, struct slip_state *out, struct error *err);

#endif
