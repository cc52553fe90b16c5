/* The "surface" part of a case, shared by every kind and by `rugo generate`. */
#ifndef RUGO_JOBS_SURFACE_CASE_H
#define RUGO_JOBS_SURFACE_CASE_H

#include "core/surface/surface.h"
#include "schema/study/fault.h"
#include "schema/study/parameter.h"
#include <cjson/cJSON.h>

/* Table rows of /surface/...: a kind puts the same rows at the head of its own table by including
 * surface_parameters.inc there. */
enum { SURFACE_PARAMETER_COUNT = 24 };
extern const struct parameter SURFACE_PARAMETERS[];

struct surface_case {
    int dimension;    /* 1 profile, 2 surface */
    struct grid grid; /* cell in units of lambda_s = 1: lx = length_ratio * wavelength_ratio */
    struct spectrum spectrum;
    struct surface_options options;
    double wavelength_ratio; /* as given, or solved for nayak_alpha */
    double length_ratio;
    double *table; /* owned: memory behind a table spectrum */
};
/* Reads the surface of a case; adds faults (pointer "/surface/...") where values do not fit
 * together and returns ERROR_INPUT. faults may be NULL: the first fault is the error in any case.
 * *out is left cleared on failure. Absent values are their defaults. */
int surface_case_read(struct surface_case *out, const cJSON *parameters, struct fault_list *faults,
                      struct error *err);
void surface_case_clear(struct surface_case *surface);

/* Whether the returned surfaces have the prescribed spectrum exactly. */
static inline bool surface_case_exact(const struct surface_case *surface) {
    return surface->options.heights.type == HEIGHTS_GAUSSIAN ||
           surface->options.keep == KEEP_SPECTRUM;
}
/* Highest wave number that the spectrum can have on the grid, in x as in y: at most nx/2. */
size_t surface_case_band(const struct surface_case *surface);

/* Points a side of a cell that asks for `points`, at least that: where it is no integer, rounded up
 * to an even number without prime factors above 7. */
size_t surface_case_side(double points);
/* Most points of a grid: 2^31. */
#define SURFACE_POINTS_MOST 2147483648.0

#endif
