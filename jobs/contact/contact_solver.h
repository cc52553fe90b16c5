/* A rough block pressed by any of the models: the one face over core/contact and core/full. */
#ifndef RUGO_JOBS_CONTACT_CONTACT_SOLVER_H
#define RUGO_JOBS_CONTACT_CONTACT_SOLVER_H

#include "core/cost.h"
#include "jobs/contact/contact_case.h"

/* What the study asks of the model full. */
struct full_options contact_full_options(const struct contact_case *study);

/* The equations of the model full on a grid. */
struct full_size contact_full_size(const struct contact_case *study, size_t model,
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
