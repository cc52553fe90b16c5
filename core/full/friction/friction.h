/* Contact of a rough face with a rigid flat by finite elements at finite strain, with friction
 * after Coulomb (F14.7): the model `full` (core/full/full.h), pressed on without friction or with
 * it, and then dragged along.
 *
 * The flat is pressed on with a mean pressure. Then it is dragged to displacements along x, of
 * surfaces also along y, or the mean traction there is taken to values below friction times the
 * pressure. Both may rise and fall; the pressure stays. Across the drag, on surfaces, the flat is
 * free to follow, and the mean traction is 0. Slip of a step is that since the step before: a path
 * is as fine as its steps, and a step that fails is halved. Where a face does not go on so, it
 * may overhang, meet itself with the same friction, and jump against a drag (F14.10), whose
 * work is none of the works below. Tractions are forces of the flat on the block over the tributary
 * areas of the flat grid, in E* = E/(1 - nu^2), positive where the flat pulls forward.
 *
 * A workspace belongs to one thread. Order of calls: friction_begin, friction_press, then
 * friction_drag and friction_load; friction_press may be called again. */
#ifndef RUGO_CORE_FULL_FRICTION_FRICTION_H
#define RUGO_CORE_FULL_FRICTION_FRICTION_H

#include "core/full/full.h"

struct friction_options {
    double coefficient; /* above 0; up to 1 is tested. Without friction there is core/full/full.h */
    size_t press_steps; /* 0: pressed without friction; else friction acts in so many steps of the
                           pressure, whose root rises evenly */
    struct full_limit limit; /* of all that follows friction_press, and of it, but for the contact
                                without friction, which full_options limit; {0}: none */
    bool along_y;            /* the flat is dragged along y; of surfaces alone */
};

/* The face under load (full_options.current_areas). Over the flat grid open_stretch is 1, tilt 0.
 */
struct friction_face {
    double area;         /* of the nodes in contact, share of the face */
    double open_stretch; /* as that of full_report */
    double tilt;         /* as face_tilt of full_report */
};

/* A state. The arrays belong to the workspace and are valid until its next call. Lengths are in the
 * grid's unit, works by area in E* times it, all since the end of pressing. */
struct friction_state {
    double pressure, traction; /* means; the traction is that along the drag */
    const double *p, *q;       /* by node of the face: pressures, and tractions along x */
    const double *gap;         /* along the normal of the face with full_options.normal_gaps */
    const double *opening;     /* weighted gaps, as of struct contact_state */
    const double *over;        /* displacement of all nodes over the flat along the drag */
    const bool *sticks;
    const double *slip; /* of the nodes in contact over the flat, along x; NaN of others */
    const double *q_across, *slip_across; /* likewise along y; NULL of profiles */
    double mean_gap;                      /* as that of full_press */
    /* Without friction, under the same pressure; of a block pressed with friction, which guesses by
     * it. Valid as the arrays. */
    const struct contact_state *without;
    struct friction_face face, face_without;
    size_t nodes, stuck;      /* in contact, and those of them that do not slide */
    double stick_area;        /* stuck over nodes; with full_options.current_areas by their areas */
    double stick_load;        /* pressures of stuck nodes over all */
    double displacement;      /* of the flat over the mean of the far side */
    double sliding;           /* of the flat over the mean of the face */
    double work;              /* of the traction on the flat, by trapezoids */
    double pressing_work;     /* of the pressure on the far side */
    double dissipation;       /* by slip on the face, by trapezoids */
    double energy;            /* gained by the block */
    size_t steps, cuts;       /* of this call: steps that converged, and steps that were halved */
    size_t jumps;             /* steps that a drag led to their equilibrium */
    size_t newton;            /* iterations, those without friction too */
    size_t linear;            /* iterations of the equations with friction */
    size_t factored;          /* their factorisations */
    double residual;          /* largest out-of-balance force, over the largest contact force */
    struct self_measure self; /* as in full_report */
};

struct friction;

/* ERROR_INPUT for options out of the ranges above, what full_create refuses, a profile of too many
 * nodes or one that is dragged along y; ERROR_MEMORY. */
int friction_create(struct friction **out, const struct grid *grid, const struct block *block,
                    const struct full_options *options, const struct friction_options *friction,
                    struct error *err);
void friction_destroy(struct friction **friction);
/* As full_set_stop. */
void friction_set_stop(struct friction *friction, int (*stop)(void *context), void *context);

/* Takes a surface, as full_begin. */
int friction_begin(struct friction *friction, const double *z, struct error *err);
/* Presses to a mean pressure above 0, from no contact, and begins works and displacements at 0.
 * Without friction the pressures are those of full_press. ERROR_NUMERIC names the load that was
 * reached. After a failure it must be called again. */
int friction_press(struct friction *friction, double pressure, struct friction_state *out,
                   struct error *err);
/* Drags the flat to a displacement over the far side. ERROR_INPUT where it is not finite;
 * ERROR_STATE before friction_press;
 * ERROR_NUMERIC, with positions and residual, where no step converges or the limit is used up.
 * After a failure the state is that of the last step that did, which may be dragged on. */
int friction_drag(struct friction *friction, double displacement, struct friction_state *out,
                  struct error *err);
/* Takes the mean traction to a value whose size is below coefficient times the pressure;
 * ERROR_INPUT where it is not. Else as friction_drag. */
int friction_load(struct friction *friction, double traction, struct friction_state *out,
                  struct error *err);

#endif
