/* The plateau of a stratified face: /surface/plateau. The face is at each point the lower of the
 * surface of the other rows, which has the valleys, and of this one (core/surface/plateau_face.h).
 * Both share the cell and the grid, which resolves the shorter of their shortest waves. */
#ifndef RUGO_JOBS_SURFACE_SURFACE_PLATEAU_H
#define RUGO_JOBS_SURFACE_SURFACE_PLATEAU_H

#include "core/surface/plateau_face.h"
#include "schema/study/values.h"

/* The surface with the valleys, which has no fault. */
struct valley_face {
    int dimension;
    double lx; /* of the cell, in lambda_s */
    double length_ratio, wavelength_ratio;
    const struct spectrum *spectrum;
    const struct surface_options *options;
};

/* Makes the plateau that the values ask for, with wavelengths in lambda_s of the valleys, for the
 * caller to free. *out is NULL where none is asked for, and where something does not fit, which is
 * a fault. ERROR_MEMORY alone. */
int surface_plateau_fill(struct plateau_face **out, const struct valley_face *valleys,
                         struct values *values, struct error *err);

#endif
