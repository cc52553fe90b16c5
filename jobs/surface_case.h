/* The "surface" part of a case, shared by every kind and by `rugo generate`. */
#ifndef RUGO_JOBS_SURFACE_CASE_H
#define RUGO_JOBS_SURFACE_CASE_H

#include "core/surface/surface.h"
#include "schema/study/values.h"

struct surface_case {
    int dimension;    /* 1 profile, 2 surface */
    struct grid grid; /* cell in units of lambda_s = 1: lx = length_ratio * wavelength_ratio */
    struct spectrum spectrum;
    struct surface_options options;
    double wavelength_ratio; /* as given, or solved for nayak_alpha */
    double length_ratio;
    double *table;                     /* owned: memory behind a table spectrum */
    struct height_table *height_table; /* owned: heights of one's own; NULL: none */
    const char *heights_name;          /* of the theory curves of heights */
};
/* Reads the surface of a case; adds faults (pointer "/surface/...") where values do not fit their
 * rows or each other, and returns ERROR_INPUT. faults may be NULL: the first fault is the error in
 * any case. *out is left cleared on failure. Absent values are their defaults. */
int surface_case_read(struct surface_case *out, const cJSON *parameters, struct fault_list *faults,
                      struct error *err);
/* The same from values that a kind has checked by tables with SURFACE_PARAMETERS among them: what
 * does not fit together is told by values_status alone, and *out then lacks what depends on it (a
 * grid that cannot be made has nx = 0). Fails only with ERROR_MEMORY; *out is to be cleared either
 * way. */
int surface_case_fill(struct surface_case *out, struct values *values, struct error *err);
void surface_case_clear(struct surface_case *surface);

/* Returns whether the returned surfaces have no waves but those of the prescribed band. */
static inline bool surface_case_band_limited(const struct surface_case *surface) {
    return surface->options.heights.type == HEIGHTS_GAUSSIAN ||
           surface->options.keep == KEEP_SPECTRUM;
}
/* Returns whether each of them has the prescribed spectrum exactly; with random amplitudes it is
 * that of their mean. */
static inline bool surface_case_exact(const struct surface_case *surface) {
    return surface_case_band_limited(surface) && surface->options.amplitudes == AMPLITUDES_FIXED;
}
/* Highest wave number that the spectrum can have on the grid, in x as in y: at most nx/2. */
size_t surface_case_band(const struct surface_case *surface);

/* Peak bytes of a generator of the surface, with heights on its grid. */
double surface_case_bytes(const struct surface_case *surface);

/* Points a side of a cell that asks for `points`, at least that: where it is no integer, rounded up
 * to an even number without prime factors above 7. */
size_t surface_case_side(double points);
/* A grid has at most 2^31 points. */
#define SURFACE_POINTS_MOST 2147483648.0

#endif
