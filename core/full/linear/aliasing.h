/* How waves on a level correspond to those on the next level, whose columns are twice as wide.
 * Private to core/full (preconditioner.h).
 *
 * With half as many nodes along each axis the lower level represents a half (of profiles) or a
 * quarter of the waves: there, wave k equals all its aliases. Corners between the lower nodes are
 * means of these. So a wave of unit amplitude at the lower nodes gives its alias k above the
 * amplitude (1 + cos k)/2 along each axis (wave_phases_hanging). An alias in the half plane that is
 * not stored is represented by its mirror image: the complex conjugate, with the opposite sign for
 * sideways components. Fields are [component][real, imaginary][wave] with waves in the layout of
 * transform.h; the vertical component is the last. */
#ifndef RUGO_CORE_FULL_LINEAR_ALIASING_H
#define RUGO_CORE_FULL_LINEAR_ALIASING_H

#include "core/full/mesh.h"

static inline size_t level_waves(const struct level *level) {
    return (level->nx / 2 + 1) * level->ny;
}
/* Returns the wave of the level below that equals a wave of the level above; *mirrored: whether it
 * is the mirror image. */
size_t aliasing_below(const struct level *above, size_t wave, bool *mirrored);
/* Copies a field of the level below to all its aliases above. */
void aliasing_unfold(const struct level *above, size_t components, const double *below,
                     double *out);
/* The transpose: sums a field of the level above over the aliases of each wave below. */
void aliasing_fold(const struct level *above, size_t components, const double *field,
                   double *below);

#endif
