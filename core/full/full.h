/* Elastic, frictionless contact of a rough block on a rigid flat, by finite elements on the rough
 * geometry itself: finite strain (material.h), dual mortar contact, Newton's method with an active
 * set (newton.h).
 *
 * The surface, the loads and the results are those of core/contact/contact.h. The linear layered
 * model of the same block predicts which nodes touch at each load; the solution does not depend on
 * it. Pressures are contact forces over the nodes' tributary areas on the undeformed grid, so that
 * their mean equals the load exactly. full_report.stretch is how much the contact shrank or
 * stretched sideways. Mean gap and stiffness are of the face under load (F14.6), unless strains are
 * small. No load step changes the area of a cell of the face by more than a quarter. So one load
 * and many lead to the same solution, or fail at the same load to within a few smallest steps.
 * Where this ends, the face goes on with overhangs, contact with itself (self_contact.h) and jumps
 * (F14.10, F14.11), which a drag leads to the equilibrium beyond; linear equations of surfaces then
 * take up to 250 MB more (gmres_lengthen). Small strains have no equilibrium there. A solver
 * belongs to one thread. The elastic state has no history, but the iteration for each load starts
 * from the load before. */
#ifndef RUGO_CORE_FULL_FULL_H
#define RUGO_CORE_FULL_FULL_H

#include "core/contact/contact.h"
#include "core/full/newton.h"

struct full_options {
    enum kinematics kinematics;
    enum equation_solver solver;
    double transition;     /* depth, in column widths, from which columns may widen (mesh.h) */
    double tolerance;      /* largest out-of-balance force over the largest contact force */
    size_t max_iterations; /* iterations of Newton's method a load step */
    double least_step;     /* smallest load step over the change of load asked; smaller ones fail */
    struct full_limit limit; /* of all loads since full_begin; {0}: none */
    /* What is measured of a solution, which stays the same (face.h). current_areas: tilts of areas
     * are reported, and the mean gap is that over the face as it stands. normal_gaps: gaps of nodes
     * out of contact, and so their mean, are along the normal of the face. The conditions of
     * contact are those of vertical gaps: in both directions a gap is 0 alike, and has the same
     * sign, so that conditions node by node, those of dual functions, are the same. Standard
     * functions average gaps around a node, which cosines would weight otherwise by the little that
     * they differ near an edge of contact. The stiffness is that of the vertical gap over the flat,
     * by which the load does its work. */
    bool current_areas, normal_gaps;
};
extern const struct full_options FULL_DEFAULTS;

/* Statistics of the last load; counts are sums over its load steps. */
struct full_report {
    enum kinematics kinematics;
    size_t newton;            /* iterations */
    size_t linear;            /* iterations of the linear equations */
    size_t factored;          /* factorisations */
    size_t changes;           /* nodes that entered or left the active set */
    size_t cycles;            /* active sets that were met before */
    size_t steps, cuts;       /* load steps that converged, and load steps that were halved */
    size_t jumps;             /* load steps that drag led to their equilibrium */
    struct self_measure self; /* what the face does to itself; lengths and force in columns, and E*
                                 times columns */
    double reached;           /* mean pressure of the last step that converged, E* */
    double balance;           /* (sum of contact forces over load) - 1 */
    double residual;          /* largest out-of-balance force, over the largest contact force */
    /* Depth of the deepest node beyond the flat, and the largest negative weighted gap outside of
     * the contact (contact_state.penetration). The solver keeps only the latter at 0; with
     * GAP_STANDARD they differ. Over the RMS height, >= 0. */
    double penetration, weighted_penetration;
    double stretch; /* deformed over undeformed tributary area of the nodes in contact; NaN without
                       contact */
    double open_stretch; /* as stretch, of the nodes out of contact; 1 where there are none */
    /* As struct face_tilt with current_areas, else 0; contact_tilt is 0 without contact. */
    double face_tilt, contact_tilt;
    double slope;   /* steepest edge of the face */
    double quality; /* smallest quality of an element (element_quality); 1 for bricks */
    double history[NEWTON_HISTORY]; /* residuals of Newton's method, the latest last */
    size_t unchanged;               /* residuals in history since the active set last changed */
};

struct full;

/* Fails with ERROR_INPUT or ERROR_MEMORY; block->model is ignored. */
int full_create(struct full **out, const struct grid *grid, const struct block *block,
                const struct full_options *options, struct error *err);
void full_destroy(struct full **full);
/* Returns the degrees of freedom of the mesh; 0 where the block cannot be meshed. */
size_t full_degrees_of_freedom(const struct grid *grid, const struct block *block,
                               const struct full_options *options);
/* Bytes of a solver that takes this many iterations of the linear equations in each iteration of
 * Newton's method, without a factorisation; NaN where the block cannot be meshed. overhangs: with
 * the vectors, pairs and patches that a face takes which may overhang. */
double full_bytes(const struct grid *grid, const struct block *block,
                  const struct full_options *options, double iterations, bool overhangs);

/* Sets stop, which is called before each iteration of Newton's method and of its linear equations,
 * and every few iterations of the linear model. When it returns non-zero, full_press ends with
 * ERROR_STOPPED and leaves the solver as after a load that was not reached; during those of the
 * stiffness, as after one that was. NULL, the initial value, never stops. */
void full_set_stop(struct full *full, int (*stop)(void *context), void *context);

/* Lets faces overhang and meet themselves where they do not go on otherwise; the
 * initial value is true. */
void full_set_overhangs(struct full *full, bool allowed);

/* Meshes the block below a surface (copied; the mean height does not matter), without contact.
 * ERROR_INPUT for a surface that is not finite, too steep, or too high for the block. */
int full_begin(struct full *full, const double *z, struct error *err);
/* Presses to a mean pressure >= 0, in load steps where needed. The message of ERROR_NUMERIC names
 * the load that was reached, as where the limit is used up, which ends steps and iterations of the
 * linear equations within them. The solver keeps that state, and another load may be tried from
 * there. Normal gaps of a face that overhangs are none: ERROR_NUMERIC. report may be NULL. */
int full_press(struct full *full, double pressure, struct contact_state *out,
               struct full_report *report, struct error *err);
/* The mesh, and the displacements of the last state in the grid's unit of length: component k of a
 * node is at node*dimension + k. Valid until the next call. */
const struct mesh *full_mesh(const struct full *full);
const double *full_displacement(struct full *full);
/* Returns the mean gap under displacements u as the options measure it, in the grid's unit of
 * length. By node of the face: whether it touches, its vertical gap in columns, and the same in the
 * grid's unit, which normal_gaps turns into that along the normal where the node does not touch. */
double full_mean_gap(const struct full_options *options, const struct mesh *mesh, const double *u,
                     const bool *touches, const double *columns, double *gap);
/* The equilibrium of the last state (core/full/friction goes on from there). Valid until the next
 * call. */
const struct newton *full_newton(const struct full *full);

#endif
