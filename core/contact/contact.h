/* Elastic, frictionless, non-adhesive contact of a rough block on a rigid flat, under a prescribed
 * mean pressure: the linear models.
 *
 * The unknowns are the pressures p at the grid points. With u = S p (compliance.h), roughness z
 * towards the flat and an approach D, the gap is g = D + u - z; p >= 0, g >= 0, p g = 0, mean
 * p = pressure. Pressures are in units of E*, lengths in the grid's. In free space
 * (compliance_create_open) the same holds within the grid's rectangle, outside of which nothing
 * touches.
 *
 * A solver belongs to one thread and one grid. It keeps the surface and the last state, from which
 * the next load starts. Loads may rise and fall. Without a hardness the contact is elastic.
 *
 * With a hardness p <= hardness, and nodes that reach it are lowered for good: their gap is 0, and
 * their depth is what the flat pushed out of the face as it was (F21.2). States depend on the load
 * and on the highest load since contact_begin. From that on the face yields; below it the lowered
 * face is elastic. Under coatings of more than about three times the modulus it may yield again, at
 * which contact_press fails. */
#ifndef RUGO_CORE_CONTACT_CONTACT_H
#define RUGO_CORE_CONTACT_CONTACT_H

#include "core/contact/compliance.h"
#include "core/team.h"

struct contact_options {
    double tolerance;        /* on the largest violation of complementarity, over the largest
                                displacement: from the mean, in free space from the reference of
                                free_space.h; default 1e-8; 1e-12 is reachable */
    size_t max_iterations;   /* a load; default 5000; on sides of more than 4096 nodes more, as the
                                square root of their number */
    size_t stall_iterations; /* without halving the violation, after which steps become careful
                                (conjugate_gradient.h); default 400 */
    bool without_tangent; /* neither stiffness nor tangent is computed, which saves up to a quarter
                             of the work; without effect on meshes of elements, whose areas need
                             them */
    double hardness; /* the largest pressure, in E*, at which a node yields; default INFINITY */
};
extern const struct contact_options CONTACT_DEFAULTS;

/* The state under one load, and the cost of its solution. The arrays belong to the solver and are
 * valid until its next call. */
struct contact_state {
    double pressure;   /* mean, in E* */
    const double *p;   /* grid_points, in E*; mean = pressure, 0 where open */
    const double *gap; /* grid_points, at the nodes whatever the weighting; mean_gap is its mean,
                          in core/full over the face as pressed */
    const double *opening; /* grid_points: the weighted gap, which is 0 in contact */
    const double *tangent; /* grid_points, d p/d pressure with the contact held: mean 1, 0 where
                              open or yielded; NULL where nothing or (periodic) all touches, or
                              without_tangent, or no node is between open and yielded */
    const double *depth;   /* grid_points: by how much nodes were lowered for good, the grid's
                              length; NULL without a hardness */
    double *scratch;       /* grid_points: of no use to the solver until its next call; NULL from
                              core/full */
    double mean_gap;       /* the grid's length */
    double approach;  /* of the flat, from where it touches first, the grid's length: towards the
                         mean plane of the face, in free space towards far points (free_space.h);
                         NaN from core/full */
    double stiffness; /* d pressure/d approach, E* per length: periodic, without a hardness, -d
                         pressure/d mean_gap. Yielded nodes do not resist. INFINITY in full contact
                         of a periodic face, 0 when nothing touches; NaN without_tangent */
    double unload_stiffness;   /* the same for a falling load, under which all nodes in contact
                                  resist; NaN without a hardness or without_tangent */
    double plastic_load;       /* share of the load that yielded nodes bear */
    double plastic_volume;     /* mean depth, the grid's length */
    double permanent_approach; /* by which the face as lowered touches first later than it did, the
                                  grid's length: what is left of the approach without the load */
    size_t yielded;            /* nodes with p = hardness */
    size_t nodes;              /* in contact (p > 0) */
    size_t iterations;         /* of the conjugate gradients on this grid, 0 in full contact */
    double work;        /* points x transforms over all grids, to which the time is proportional */
    double violation;   /* largest |g| inside or penetration outside, over the RMS height */
    double penetration; /* largest -g outside of the contact, over the RMS height; >= 0 */
};

struct contact;

/* Borrows the compliance, which must outlive it. ERROR_INPUT for a tolerance outside (0, 1) or a
 * hardness that is not above 0; ERROR_MEMORY. */
int contact_create(struct contact **out, const struct compliance *compliance,
                   const struct contact_options *options, struct error *err);
void contact_destroy(struct contact **contact);
/* Returns the bytes of a solver, but for its compliance: of a periodic grid; in free space
 * free_space_bytes are added. */
double contact_bytes(const struct grid *grid, const struct block *block,
                     const struct contact_options *options);
/* Sets stop, which is called every few iterations. When it returns non-zero, contact_press fails
 * with ERROR_STOPPED, as it fails where it does not converge. NULL, the initial value, never
 * stops. */
void contact_set_stop(struct contact *contact, int (*stop)(void *context), void *context);
/* Lets a team of threads work along, with the same digits; it is borrowed until the next call or
 * contact_destroy. NULL, the initial value: the caller alone. ERROR_MEMORY. */
int contact_set_team(struct contact *contact, struct team *team, struct error *err);

/* Copies a surface (any mean height) and removes the load and all depths: the next load starts
 * anew. ERROR_INPUT for a height that is not finite. */
int contact_begin(struct contact *contact, const double *z, struct error *err);
/* Presses to a mean pressure >= 0 and below the hardness, in free space over the rectangle.
 * ERROR_INPUT with both where it is not. ERROR_NUMERIC, with the load and what was reached, when
 * the tolerance is not met, or where a lowered face under a coating would bear more than its
 * hardness; the state before is lost then, and the next load starts anew. */
int contact_press(struct contact *contact, double pressure, struct contact_state *out,
                  struct error *err);
/* Returns the stiffness d pressure/d approach, E* per length, with the nodes p[grid_points] > 0
 * held in contact, whatever the surface that was begun. It removes the load. residual: the largest
 * one, over the approach; the error of the value is about its square, and unknown where
 * stop asked for an end. 0 without such nodes, INFINITY where all of a periodic face are. */
double contact_held_stiffness(struct contact *contact, const double *p, double residual);
/* Returns the smallest mean pressure of full contact of the elastic face, in E*; it is known from
 * contact_begin on. INFINITY in free space, where it is not known. */
double contact_full_pressure(const struct contact *contact);

#endif
