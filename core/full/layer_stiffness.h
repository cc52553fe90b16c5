/* The stiffness of a layer of equal bricks, and its symbol for each wave. Private to core/full
 * (preconditioner.h). */
#ifndef RUGO_CORE_FULL_LAYER_STIFFNESS_H
#define RUGO_CORE_FULL_LAYER_STIFFNESS_H

#include "core/full/element.h"
#include "core/full/mesh.h"

/* block[s][t][step]: force on side s by displacements of side t (0 is the upper side), where step
 * says by how many nodes the second lies further along: -1, 0, 1 in x, fastest, then in y. */
struct layer_stiffness {
    double block[2][2][9][3][3];
};

/* Fills the stiffness of a layer of the flat mesh without displacements; its columns are those of
 * its upper level. volumetric may be NULL. */
void layer_stiffness_make(const struct mesh *mesh, const struct material *material, size_t layer,
                          struct layer_stiffness *out, struct element_volumetric *volumetric);

/* A wave's phase over each step has this cosine and sine. */
struct wave_phases {
    double cosine[9], sine[9];
};
/* The phases of wave (mx, row) on a level's nodes; mx and row may exceed the level's band. */
struct wave_phases wave_phases_of(const struct level *level, size_t mx, size_t row);
/* The amplitude at corners that are means of the nodes beside them, over the amplitude at the
 * nodes. */
double wave_phases_hanging(int dimension, const struct wave_phases *phases);

/* Adds factor times the symbol of a block to out. It is real, because sideways displacements are i
 * X and i Y (preconditioner.h). */
void layer_stiffness_add_symbol(int dimension, double block[9][3][3],
                                const struct wave_phases *phases, double factor, double out[3][3]);

#endif
