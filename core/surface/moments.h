/* Spectral moments of a profile or surface. */
#ifndef RUGO_CORE_SURFACE_MOMENTS_H
#define RUGO_CORE_SURFACE_MOMENTS_H

#include <stdbool.h>

/* Spectral moments (FORMULAS.md, F2.3). A profile has m00 = m0, m20 = m2, m40 = m4; the others are
 * 0. */
struct moments {
    double m00, m20, m02, m11, m22, m40, m04, m31, m13;
    double m0, m2, m4;                           /* isotropic: m00, (m20+m02)/2, (m40+m04)/2 */
    double nayak_alpha;                          /* m0 m4 / m2^2 (F2.4) */
    double rms_height, rms_slope, rms_curvature; /* F1.2 */
};
/* Computes the fields from m0 on from those before. */
void moments_derive(struct moments *moments, bool profile);
/* Returns whether moments are those of an isotropic surface, within a quarter: m20 = m02 and
 * 3 m22 = m40 = m04. They are not on a lattice of four or twelve modes; they are on one of forty.
 * False for profiles. */
bool moments_isotropic(const struct moments *moments);

#endif
