/* Surfaces of a realisation found again, from the same start and with the same heights, in other
 * ways: many surfaces have one spectrum and nearly the heights, and each way of iterating finds its
 * own kind (FORMULAS.md, F5.7). What is measured changes between them by the error "generation". */
#ifndef RUGO_JOBS_SURFACE_PATHS_H
#define RUGO_JOBS_SURFACE_PATHS_H

#include "jobs/surface_case.h"

enum surface_path {
    PATH_OTHER,  /* another iteration, to the same error */
    PATH_LONGER, /* more of the case's own kind of iterations, at most to half of it */
    SURFACE_PATHS
};

/* Whether anything is iterated: heights are not Gaussian. */
bool surface_paths_apply(const struct surface_case *surface);

struct surface_paths;
/* Borrows the surface. */
int surface_paths_create(struct surface_paths **out, const struct surface_case *surface,
                         struct error *err);
void surface_paths_destroy(struct surface_paths **paths);
/* Makes the surface of this key by a path; own: what the case's own generation of it did. *z are
 * its heights on the grid of the case, and live until the next call. */
int surface_paths_make(struct surface_paths *paths, enum surface_path path, struct random_key key,
                       const struct surface_report *own, const double **z,
                       struct surface_report *report, struct error *err);
/* Of this object; and CPU seconds of both paths of one realisation, on a 3 GHz core. */
double surface_paths_bytes(const struct surface_case *surface);
double surface_paths_seconds(const struct surface_case *surface);

/* How many times the change that longer iterations made is that to half of eps_h, where they halved
 * it so often in the mean: it is taken to go on with the logarithm of eps_h, within a limit. */
double surface_paths_drift(double halvings);

#endif
