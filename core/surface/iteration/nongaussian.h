/* Non-Gaussian surfaces, made by alternating between a spectrum and a height distribution
 * (Perez-Rafols & Almqvist 2019; FORMULAS.md, F5.1 to F5.6). The generator in surface.c draws the
 * Gaussian start and owns one of these for each case; it is a workspace for one thread. */
#ifndef RUGO_CORE_SURFACE_NONGAUSSIAN_H
#define RUGO_CORE_SURFACE_NONGAUSSIAN_H

#include "core/random.h"
#include "core/surface/spectrum.h"
#include "core/surface/surface_options.h"
#include "core/surface/transform.h"

struct nongaussian;

/* Borrows modes; copies options. With random amplitudes modes are those of the next run's start:
 * their powers may change from run to run, but not to or from 0. ERROR_INPUT (options or heights
 * out of range), ERROR_MEMORY. */
int nongaussian_create(struct nongaussian **out, const struct modes *modes,
                       const struct surface_options *options, struct error *err);
void nongaussian_destroy(struct nongaussian **nongaussian);

/* Changes the tolerances and limits of the next runs. */
void nongaussian_aim(struct nongaussian *g, const struct surface_aim *aim);
/* Changes what the next runs ask whether to stop, as stop and stop_context of their options. */
void nongaussian_set_stop(struct nongaussian *g, int (*stop)(void *context), void *context);

/* On entry z[ny*nx] is the Gaussian start, on return the surface. transform belongs to the grid and
 * band of modes; its spectrum is overwritten. report may be NULL. ERROR_NUMERIC where the heights
 * that were drawn are all equal or not finite; ERROR_STOPPED where options.stop says so;
 * ERROR_MEMORY. After an error z is undefined. */
int nongaussian_run(struct nongaussian *g, struct transform *transform, struct random_key key,
                    double *z, struct surface_report *report, struct error *err);

/* Returns the peak bytes of a workspace on a grid and band, without z and the caller's
 * transform. */
double nongaussian_bytes(const struct grid *grid, size_t mode_x, size_t mode_y,
                         const struct surface_options *options);

#endif
