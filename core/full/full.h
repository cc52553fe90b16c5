/* Elastic, frictionless contact of a rough block on a rigid flat by finite elements on the rough
 * geometry itself: finite strain (material.h), dual mortar contact, Newton with an active set.
 *
 * The scene and what is told are those of core/contact/contact.h. The linear layered model of the
 * same block guesses which nodes touch at each load; it has no part in the answer. Pressures p are
 * contact forces over the nodes' tributary areas on the undeformed grid, so that their mean is the
 * load, exactly; how much the contact has shrunk or stretched sideways is told beside
 * (full_report.stretch). The face does not touch itself: where it would fold over itself a load
 * finds no equilibrium. In a load step no cell of the face stretches by more than a quarter, so
 * that one load and many lead to the same answer, or fail at the same load within a few least
 * steps. A solver belongs to one thread; the elastic state has no history, but each load starts
 * from the one before. */
#ifndef RUGO_CORE_FULL_FULL_H
#define RUGO_CORE_FULL_FULL_H

#include "core/contact/contact.h"
#include "core/full/newton.h"

struct full_options {
    enum kinematics kinematics;
    enum equation_solver solver;
    double transition;     /* of the columns (mesh.h) */
    double tolerance;      /* largest out-of-balance force over the largest contact force */
    size_t max_iterations; /* Newton's, a load step */
    double least_step;     /* of the pressure asked less that before: smaller ones are failure */
};
extern const struct full_options FULL_DEFAULTS;

/* How the last load was solved; sums over its steps. */
struct full_report {
    enum kinematics kinematics;
    size_t newton;      /* iterations */
    size_t linear;      /* iterations of the linear equations */
    size_t factored;    /* factorisations */
    size_t changes;     /* of single nodes of the active set */
    size_t cycles;      /* active sets that came back */
    size_t steps, cuts; /* load steps that went well, and that had to be made smaller */
    double reached;     /* mean pressure of the last step that went well, E* */
    double balance;     /* (sum of contact forces over load) - 1 */
    double residual;    /* largest out-of-balance force, over the largest contact force */
    /* Of the nodes through the flat, the deepest, and the largest of the weighted gap outside of
     * the contact (contact_state.penetration), which alone the solver keeps at 0; they differ with
     * GAP_STANDARD. Over the RMS height, >= 0. */
    double penetration, weighted_penetration;
    double stretch; /* tributary area of nodes in contact now, over that undeformed; or NaN */
    double slope;   /* steepest edge of the face */
    double quality; /* least Jacobian over edges' lengths of all elements: 1 for bricks */
    double history[NEWTON_HISTORY]; /* of residuals, the latest last ... */
    size_t unchanged;               /* ... and how many of them since the active set changed */
};

struct full;

/* block->model is not looked at. ERROR_INPUT, ERROR_MEMORY. */
int full_create(struct full **out, const struct grid *grid, const struct block *block,
                const struct full_options *options, struct error *err);
void full_destroy(struct full **full);
/* Of the mesh; 0 where there is none for the block. */
size_t full_degrees_of_freedom(const struct grid *grid, const struct block *block,
                               const struct full_options *options);
/* Memory of a solver that takes so many iterations of the linear equations in each of Newton's; NaN
 * where there is no mesh for the block. A factorisation, where one is needed, is not in it. */
double full_bytes(const struct grid *grid, const struct block *block,
                  const struct full_options *options, double iterations);

/* stop is asked before each iteration of Newton's from now on; non-zero ends full_press with
 * ERROR_STOPPED, which leaves the solver as a load not reached does. NULL, as it begins: not. */
void full_set_stop(struct full *full, int (*stop)(void *context), void *context);

/* Meshes the block of a surface (copies; any height of its mean), lifted off. ERROR_INPUT for a
 * surface that is not finite or too steep. */
int full_begin(struct full *full, const double *z, struct error *err);
/* Presses to a mean pressure >= 0, in steps where needed. ERROR_NUMERIC tells the load reached; the
 * solver keeps that state, and a later load may be tried from it. report: NULL where not wanted. */
int full_press(struct full *full, double pressure, struct contact_state *out,
               struct full_report *report, struct error *err);
/* Displacements of the state pressed, in the grid's length, and the mesh they belong to: freedom
 * node*dimension + axis. Valid until the next call. */
const struct mesh *full_mesh(const struct full *full);
const double *full_displacement(struct full *full);

#endif
