/* Waves of levels of unlike columns. Private to core/full (preconditioner.h).
 *
 * Half as many nodes tell only half (a quarter) of the waves apart: on the level below, wave k is
 * the same as its aliases. Corners between the nodes are means, so that a wave there moves its
 * aliases k above by (1 + cos k)/2 in each direction (wave_phases_hanging). A wave that is an alias
 * of one of the other half plane is that one's mirror image: complex conjugate, sideways with the
 * other sign. Fields are [component][real, imaginary][wave], waves in the layout of transform.h,
 * the last component the vertical one. */
#ifndef RUGO_CORE_FULL_ALIASING_H
#define RUGO_CORE_FULL_ALIASING_H

#include "core/full/mesh.h"

static inline size_t level_waves(const struct level *level) {
    return (level->nx / 2 + 1) * level->ny;
}
/* The wave of the level below that a wave of the level above it is an alias of. */
size_t aliasing_below(const struct level *above, size_t wave, bool *mirrored);
/* A field of the level below, given to all aliases above. */
void aliasing_unfold(const struct level *above, size_t components, const double *below,
                     double *out);
/* The transpose: a field of the level above, summed over aliases below. */
void aliasing_fold(const struct level *above, size_t components, const double *field,
                   double *below);

#endif
