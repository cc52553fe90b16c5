/* What the meshes of two cases leave of their difference. */
#ifndef RUGO_SCHEMA_RESULT_DIFFERENCE_MESH_H
#define RUGO_SCHEMA_RESULT_DIFFERENCE_MESH_H

#include "schema/result/result.h"

/* The finest curve of a case, and the next coarser one of its series and model; NULL: none. */
struct mesh_curves {
    const struct curve *fine, *coarse;
};
struct mesh_curves mesh_curves_of(const struct case_result *result, const struct curve *finest);

/* Where both cases bound the error of their mesh by so many changes between their levels, the same
 * multiple of the change of the difference bounds that of the difference, and is less where the
 * changes of the two go together. A change may vanish by chance: the largest one of neighbouring
 * places counts. Lowers bound[n] at the places a[n] and b[n] of the curves; leaves it where levels
 * are others, some realisation lacks a value, or a case knows more than a bound. */
void difference_mesh_bounds(const struct mesh_curves *minuend, const struct mesh_curves *subtrahend,
                            size_t n, const size_t *a, const size_t *b, double *bound);

#endif
