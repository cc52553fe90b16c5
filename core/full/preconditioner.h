/* The flat block's stiffness, inverted: what preconditions the rough one's.
 *
 * Equal columns make the stiffness fall apart into a block-tridiagonal system in depth a wave
 * vector (as in core/contact/layered.c, which keeps the face alone). With sideways displacements i
 * X and i Y it is real; it is eliminated from the far side up, once. Where columns widen, waves and
 * their aliases meet: there the inverse is approximate in what short waves do so deep, and exact to
 * exp(-pi depth) (depth in columns) for forces on the face. The far side has one vertical
 * displacement; sideways, and vertically where nothing is in contact, the block floats: the mean
 * of its far side, and of its face, is left 0. */
#ifndef RUGO_CORE_FULL_PRECONDITIONER_H
#define RUGO_CORE_FULL_PRECONDITIONER_H

#include "core/full/volumetric.h"

struct preconditioner;

/* volumetric: filled, of the layers; may be NULL. */
int preconditioner_create(struct preconditioner **out, const struct mesh *mesh,
                          const struct material *material, struct volumetric *volumetric,
                          struct error *err);
void preconditioner_destroy(struct preconditioner **preconditioner);
double preconditioner_bytes(const struct mesh *mesh);

/* Vertical displacement of the face over force a node, a value a wave in the layout of transform.h;
 * 0 for the mean. Borrowed. */
const double *preconditioner_compliance(const struct preconditioner *preconditioner);

/* Takes forces (mesh_degrees_of_freedom; the far side's vertical ones count by their sum) and
 * eliminates them down to the face. */
void preconditioner_load(struct preconditioner *preconditioner, const double *forces);
/* The face's vertical displacements under the forces taken, mean 0. */
void preconditioner_face(struct preconditioner *preconditioner, double *vertical);
/* Adds vertical forces on the face to those taken, and gives all displacements. May be called once
 * after preconditioner_load. */
void preconditioner_displace(struct preconditioner *preconditioner, const double *vertical,
                             double *displacements);

#endif
