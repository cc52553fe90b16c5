/* A rough block pressed by any of the models: the one face over core/contact and core/full. */
#ifndef RUGO_JOBS_CONTACT_SOLVER_H
#define RUGO_JOBS_CONTACT_SOLVER_H

#include "jobs/contact_case.h"

/* Freedoms of the finite elements of the model on a grid; 0 where it takes too many layers. */
double contact_full_freedoms(const struct grid *grid, const struct block *block);

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

/* Takes a surface of the grid and lifts it off: nothing is left of the last one. */
int contact_solver_begin(struct contact_solver *solver, const double *z, struct error *err);
/* As contact_press and full_press. *report: NULL for linear models, or of the solver. */
int contact_solver_press(struct contact_solver *solver, double pressure, struct contact_state *out,
                         const struct full_report **report, struct error *err);
/* The finite elements on the true geometry; NULL of linear models. */
struct full *contact_solver_full(struct contact_solver *solver);

#endif
