/* Half-spaces and exact layers on the coarse meshes of probes: what one is solved with. */
#ifndef RUGO_JOBS_CONTACT_CONTACT_COARSE_H
#define RUGO_JOBS_CONTACT_CONTACT_COARSE_H

#include "jobs/contact/contact_case.h"
#include "jobs/contact/contact_tally.h"

/* To be asked before each load whether to stop. */
struct contact_stopper {
    int (*stop)(void *context);
    void *context;
};

struct contact_coarse;
/* Borrows the case; height in lambda_s, INFINITY for a half-space; moments: of the prescribed
 * spectrum on this grid, which set the scale. */
int contact_coarse_create(struct contact_coarse **out, const struct contact_case *one_case,
                          const struct grid *grid, double height, const struct moments *moments,
                          struct error *err);
void contact_coarse_destroy(struct contact_coarse **coarse);
/* Presses z, heights on the grid, to all loads from a surface lifted off: the paired measures, into
 * the cells of the tally from `cell` on; where no answer is found, there are no values. Non-zero of
 * the stopper ends it with ERROR_STOPPED. */
int contact_coarse_solve(struct contact_coarse *coarse, const double *z, size_t cell,
                         struct contact_tally *tally, const struct contact_stopper *stopper,
                         struct error *err);
/* Copies the paired measures of all loads from the cells from `from` on to those from `to` on. */
void contact_coarse_copy(const struct contact_case *one_case, size_t from, size_t to,
                         struct contact_tally *tally);

double contact_coarse_bytes(const struct grid *grid);
/* CPU seconds of all loads in the mean, on a 3 GHz core. */
double contact_coarse_seconds(const struct contact_case *one_case, const struct grid *grid);

#endif
