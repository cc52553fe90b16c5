/* The second of two rough faces, that the surface of a case is pressed on: /counter_surface. What
 * is pressed is the sum of both, each with heights towards the other. The faces share the cell and
 * the grid, which resolves the shorter of their shortest waves. Lengths of the second are in
 * lambda_s of the first, but for its ratios. Its random numbers are its own (counter_face.h). */
#ifndef RUGO_JOBS_SURFACE_SURFACE_COUNTER_H
#define RUGO_JOBS_SURFACE_SURFACE_COUNTER_H

#include "jobs/surface/surface_case.h"

/* Adds the second face to *surface, which is NULL where it is at fault. parameters: of the case,
 * which `values` have checked by COUNTER_PARAMETERS, too. Without a second face nothing is done.
 * Where it has faults, they are added and *surface is NULL. ERROR_MEMORY alone. */
int surface_counter_fill(struct surface_case *out, const cJSON *parameters, struct values *values,
                         const struct surface_case **surface, struct error *err);

/* The body of the second face. */
struct counter_body {
    bool given;     /* there is a second face */
    double young;   /* NaN: it is rigid */
    double poisson; /* of an elastic one */
};
/* Reads the body; poisson: of the block, which it has unless given. */
struct counter_body surface_counter_body(const cJSON *parameters, struct values *values,
                                         double poisson);

#endif
