/* Power densities that depend on |k| alone, in a band, and their autocorrelation along a line: the
 * transforms between the two, of an endless profile or surface (FORMULAS.md, F5.10).
 *
 * Densities are values at nodes in the band, rising and linear in between. Along the line a density
 * is projected (Abel's transform; none for profiles) on a lattice of wave numbers, from which a
 * Fourier transform leads to lags. */
#ifndef RUGO_CORE_SURFACE_TRANSLATION_RADIAL_H
#define RUGO_CORE_SURFACE_TRANSLATION_RADIAL_H

#include "core/error.h"
#include <stddef.h>

struct radial;

enum { RADIAL_RATIO_MOST = 1024 };

/* dimension 1 or 2; nodes k[n], n >= 2, rising, above 0: copied. ERROR_INPUT where the last is more
 * than RADIAL_RATIO_MOST times the first; ERROR_MEMORY. */
int radial_create(struct radial **out, int dimension, size_t n, const double *k, struct error *err);
void radial_destroy(struct radial **radial);

/* Returns the number of lags of an autocorrelation, of which the first is 0. The last is half the
 * period of the lattice: lags behind it are the mirror image of these. */
size_t radial_lags(const struct radial *radial);
/* Fills the autocorrelation of a density at all lags. */
void radial_correlate(struct radial *radial, const double *density, double *correlation);
/* Fills the density, at the nodes, of what has this autocorrelation. The outer half of the lags is
 * weighted down to 0. */
void radial_density(struct radial *radial, const double *correlation, double *density);
/* Returns the integral of a density over the band: over the line, or the plane. */
double radial_integral(const struct radial *radial, const double *density);

#endif
