/* Surfaces of a realisation by alternative generators, from the same start and with the same
 * heights. Many surfaces have one spectrum and nearly the same heights, and each iteration produces
 * its own (FORMULAS.md, F5.7). The error "generation" is estimated from the changes between
 * them. */
#ifndef RUGO_JOBS_SURFACE_SURFACE_PATHS_H
#define RUGO_JOBS_SURFACE_SURFACE_PATHS_H

#include "jobs/surface/surface_case.h"

enum surface_path {
    PATH_OTHER,  /* another iteration, to the same error */
    PATH_LONGER, /* more of the case's own kind of iterations, at most to half of it */
    SURFACE_PATHS
};

/* Returns whether surfaces are made by iteration: heights are not Gaussian. */
bool surface_paths_apply(const struct surface_case *surface);

struct surface_paths;
/* Borrows the surface. */
int surface_paths_create(struct surface_paths **out, const struct surface_case *surface,
                         struct error *err);
void surface_paths_destroy(struct surface_paths **paths);
/* Makes the surface of this key by a path; own: the report of the case's own generation. *z are its
 * heights on the grid of the case, valid until the next call. */
int surface_paths_make(struct surface_paths *paths, enum surface_path path, struct random_key key,
                       const struct surface_report *own, const double **z,
                       struct surface_report *report, struct error *err);
/* Return the bytes of this object, and the CPU seconds of both paths of a realisation on a 3 GHz
 * core. */
double surface_paths_bytes(const struct surface_case *surface);
double surface_paths_seconds(const struct surface_case *surface);

/* Returns the factor from the change that longer iterations made to that at half of eps_h:
 * 1/halvings, within a limit, as the change is assumed to go on with the logarithm of eps_h.
 * halvings: how often they halved eps_h in the mean. */
double surface_paths_drift(double halvings);

#endif
