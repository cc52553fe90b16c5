/* What each load leaves at the nodes of one surface: steps for files (core/nodal). */
#ifndef RUGO_JOBS_CONTACT_CONTACT_STEPS_H
#define RUGO_JOBS_CONTACT_CONTACT_STEPS_H

#include "core/nodal/nodal_step.h"
#include "jobs/contact/case/contact_case.h"

/* As press_steps of a kind has it, of a struct contact_case. ERROR_INPUT for a model that the case
 * lacks; ERROR_NUMERIC, with the load, where a model finds no solution: the steps before have been
 * put. */
int contact_press_steps(const void *of, const struct steps_order *order,
                        const struct steps_sink *sink, struct error *err);

/* As kept of a kind has it. */
struct kept_steps contact_kept_steps(const void *of);
/* What these files take. generation: seconds of a surface. */
struct study_kept contact_kept_cost(const struct contact_case *one_case, double generation);

/* A step of a solved load, with its arrays. Zeroed at first, cleared in any case. */
struct contact_step {
    struct nodal_step step;
    struct mesh_step on_mesh;
    double *values; /* owned: pressures, contact, displacements */
    char title[160];
};
/* How a step is made of a solution. */
struct contact_step_order {
    const struct contact_model *model;
    struct contact_solver *solver;
    struct grid grid;      /* of the nodes that are kept */
    size_t row;            /* nodes of a row of the grid as it is pressed */
    const double *z;       /* as it is pressed */
    double load;           /* as it was given; 0: out of contact */
    double unit;           /* pressures are written over this, E* */
    const char *unit_name; /* E* h' or Pa */
    const char *lengths;   /* unit of lengths, or "the map" */
};
/* Fills *out with the nodes of the first rows and columns. It borrows the solver's mesh, until the
 * solver's next call. */
int contact_step_fill(struct contact_step *out, const struct contact_step_order *order,
                      const struct contact_state *state, struct error *err);
void contact_step_clear(struct contact_step *step);

#endif
