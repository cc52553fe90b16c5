/* The "surface" part of a case, shared by every kind and by `rugo generate`. */
#ifndef RUGO_JOBS_SURFACE_CASE_H
#define RUGO_JOBS_SURFACE_CASE_H

#include "core/parameter.h"
#include "core/surface/surface.h"
#include <cjson/cJSON.h>

/* Table rows of /surface/..., to be put at the head of a kind's own table. */
#define SURFACE_PARAMETER_COUNT 20 /* surface_case.c asserts it */
extern const struct parameter SURFACE_PARAMETERS[SURFACE_PARAMETER_COUNT];

struct surface_case {
    int dimension; /* 1 profile, 2 surface */
    struct grid grid; /* cell in units of lambda_s = 1: lx = length_ratio * wavelength_ratio */
    struct spectrum spectrum;
    struct surface_options options;
    double wavelength_ratio; /* as given, or solved for nayak_alpha */
    double *table;           /* owned: memory behind a table spectrum */
};
/* Reads the surface of a case; adds faults (pointer "/surface/...") where values do not fit together.
 * faults may be NULL: then the first fault becomes the error. */
int surface_case_read(struct surface_case *out, const cJSON *parameters, struct fault_list *faults,
                      struct error *err);
void surface_case_clear(struct surface_case *surface);

#endif
