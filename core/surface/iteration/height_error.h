/* Errors of a pair of iterates in spectrum and heights (Perez-Rafols & Almqvist 2019; FORMULAS.md,
 * F5.2): z_s has the exact spectrum, z_h the exact heights in the same rank order. Heights are in
 * standard deviations throughout, so that the powers add up to 1. */
#ifndef RUGO_CORE_SURFACE_HEIGHT_ERROR_H
#define RUGO_CORE_SURFACE_HEIGHT_ERROR_H

#include "core/surface/spectrum.h"
#include "core/surface/surface_options.h"
#include <complex.h>

struct height_error;

/* Borrows modes. Memory: a transform of the whole grid, unless the band fills it. */
int height_error_create(struct height_error **out, const struct modes *modes, struct error *err);
void height_error_destroy(struct height_error **height_error);
double height_error_bytes(const struct grid *grid);

/* Reads the present powers of modes, and fixes the bins of a run: Scott's width, an edge on the
 * bound of the distribution (or on its mean). sorted[points]: all heights of z_h, rising. */
void height_error_start(struct height_error *e, const struct height_moments *moments,
                        const double *sorted);

/* eps_h alone of a surface z_s, whose heights are added in parts of n: the integral of the
 * difference between the histogram densities (F5.2). */
void height_error_heights_start(struct height_error *e);
void height_error_heights_add(struct height_error *e, size_t n, const double *z_s);
double height_error_heights(const struct height_error *e);

/* Sets what eps_h, eps_s and eps_s0 are multiplied by before the largest is taken; 1 each before.
 */
void height_error_weigh(struct height_error *e, const double weights[3]);
/* Fills the errors of report and returns the largest, with their weights. spectrum: the half
 * spectrum of z_h on the band, as transform_forward leaves it. eps_s0 needs a transform of the
 * whole grid. Without `complete` that is done only where its bound by Parseval's sum exceeds both
 * other errors; otherwise eps_s0 is that bound. The largest error is exact in both cases, because a
 * bound below another error does not change it. */
double height_error_measure(struct height_error *e, const double *z_s, const double *z_h,
                            const double complex *spectrum, bool complete,
                            struct surface_report *report);

#endif
