/* The stiffness of a layer of equal bricks, wave by wave. Private to core/full (preconditioner.h).
 */
#ifndef RUGO_CORE_FULL_LAYER_STIFFNESS_H
#define RUGO_CORE_FULL_LAYER_STIFFNESS_H

#include "core/full/element.h"
#include "core/full/mesh.h"

/* Between its sides (0 the upper), by the step sideways from one node to another: -1, 0, 1 in x,
 * then y. */
struct layer_stiffness {
    double block[2][2][9][3][3];
};

/* Of the flat mesh's layer at rest, columns as of its upper level. volumetric: NULL where not
 * wanted. */
void layer_stiffness_make(const struct mesh *mesh, const struct material *material, size_t layer,
                          struct layer_stiffness *out, struct element_volumetric *volumetric);

/* cos and sin of a wave's phase over each step. */
struct wave_phases {
    double cosine[9], sine[9];
};
/* Wave (mx, row) of a level's nodes, of any period. */
struct wave_phases wave_phases_of(const struct level *level, size_t mx, size_t row);
/* What a wave of corners halfway between nodes and at them is of the nodes'. */
double wave_phases_hanging(int dimension, const struct wave_phases *phases);

/* out += factor * the block's symbol: real, with sideways displacements i X and i Y
 * (preconditioner.h). */
void layer_stiffness_add_symbol(int dimension, double block[9][3][3],
                                const struct wave_phases *phases, double factor, double out[3][3]);

#endif
