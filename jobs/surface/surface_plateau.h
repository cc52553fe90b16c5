/* The plateau of a stratified face: /surface/plateau. The face is at each point the lower of the
 * surface of the other rows, which has the valleys, and of this one (core/surface/plateau_face.h).
 * Both share the cell and the grid, which resolves the shorter of their shortest waves. */
#ifndef RUGO_JOBS_SURFACE_SURFACE_PLATEAU_H
#define RUGO_JOBS_SURFACE_SURFACE_PLATEAU_H

#include "jobs/surface/surface_case.h"

/* Adds the plateau that the values ask for to a surface without faults; without one nothing is
 * done. What does not fit is a fault. ERROR_MEMORY alone. */
int surface_plateau_fill(struct surface_case *out, struct values *values, struct error *err);
/* Adds a fault where a stratified face is to be like a measured one; of kinds with LIKE_PARAMETERS.
 */
void surface_plateau_check_like(struct values *values);

#endif
