/* A rough block pressed by any of the models: the one face over core/contact and core/full. */
#ifndef RUGO_JOBS_CONTACT_CONTACT_SOLVER_H
#define RUGO_JOBS_CONTACT_CONTACT_SOLVER_H

#include "jobs/contact/contact_case.h"

/* What the study asks of the model full. */
struct full_options contact_full_options(const struct contact_case *study);

/* How large and how hard the equations of the model full are on a grid: its cost is made of these.
 * Fitted to profiles of 64 to 8192 points and surfaces of 8 x 8 to 64 x 64, RMS slopes 0.01 to 0.7,
 * Poisson's ratios 0.3 to 0.4999. */
struct contact_full_size {
    double freedoms; /* 0 where the block takes too many layers */
    double newton;   /* iterations a load, evenly spaced */
    double linear;   /* iterations of the linear equations in each of these */
    bool factored;   /* too many: they are factorised instead */
    bool bulk;       /* with the pressures of nearly incompressible elements */
};
struct contact_full_size contact_full_size(const struct contact_case *study, size_t model,
                                           const struct grid *grid);

/* What a linear model has for a block of finite elements on the true geometry: the same mesh below
 * a flat face. Other blocks are their own. */
struct block contact_linear_block(const struct block *block);

/* Of one model on one grid; belongs to one thread. */
struct contact_solver;
/* Borrows the compliance, that of contact_linear_block, which must outlive it. */
int contact_solver_create(struct contact_solver **out, const struct contact_case *study,
                          size_t model, const struct compliance *compliance, struct error *err);
void contact_solver_destroy(struct contact_solver **solver);
double contact_solver_bytes(const struct contact_case *study, size_t model,
                            const struct grid *grid);

/* Takes a surface of the grid and lifts it off: nothing is left of the last one. stop is asked
 * within the loads of the model full (full_set_stop), until the next surface. */
int contact_solver_begin(struct contact_solver *solver, const double *z, int (*stop)(void *context),
                         void *context, struct error *err);
/* Of the surface begun; NULL for linear models. */
const struct mesh *contact_solver_mesh(const struct contact_solver *solver);
/* As contact_press and full_press, with the work of both in transforms. *report: NULL for linear
 * models, or of the solver. */
int contact_solver_press(struct contact_solver *solver, double pressure, struct contact_state *out,
                         const struct full_report **report, struct error *err);

#endif
