/* Solvers of half-spaces and exact layers on the coarse meshes of companions. */
#ifndef RUGO_JOBS_CONTACT_COMPANION_COARSE_SOLVER_H
#define RUGO_JOBS_CONTACT_COMPANION_COARSE_SOLVER_H

#include "jobs/contact/case/contact_case.h"

/* Called before each load: non-zero stops. */
struct contact_stopper {
    int (*stop)(void *context);
    void *context;
};

/* Returns the coarse mesh of a case that has its levels: half as fine as the coarsest one if that
 * leaves 4 points a shortest wave, else that one. */
struct contact_level coarse_level(const struct contact_case *one_case);

struct coarse_solver;
/* Borrows the case. height in lambda_s, INFINITY for a half-space; moments: of the prescribed
 * spectrum on this grid, which set the scale. */
int coarse_solver_create(struct coarse_solver **out, const struct contact_case *one_case,
                         const struct grid *grid, double height, const struct moments *moments,
                         struct error *err);
void coarse_solver_destroy(struct coarse_solver **solver);
/* Presses z, heights on the grid, to all loads, from out of contact. Fills a series of a companion
 * (companion_series); without a solution there are no values. Non-zero of the stopper ends it with
 * ERROR_STOPPED. */
int coarse_solver_press(struct coarse_solver *solver, const double *z, double *series,
                        const struct contact_stopper *stopper, struct error *err);

double coarse_solver_bytes(const struct contact_case *one_case, const struct grid *grid);
/* Returns the mean CPU seconds of all loads on a 3 GHz core. */
double coarse_solver_seconds(const struct contact_case *one_case, const struct grid *grid);
/* Returns the seconds by which companions are planned (cost_linear_contact), with those of
 * quantities. */
double coarse_solver_planned_seconds(const struct contact_case *one_case, const struct grid *grid);

#endif
