/* The flat block's stiffness, inverted: what preconditions the rough one's.
 *
 * Equal columns make the stiffness fall apart into a block-tridiagonal system in depth a wave
 * vector (as in core/contact/layered.c, which keeps the face alone). With sideways displacements i
 * X and i Y it is real; it is eliminated from the far side up, once. Where columns widen, waves and
 * their aliases meet: there the inverse is approximate in what short waves do so deep, and exact to
 * exp(-pi depth) (depth in columns) for forces on the face. The far side has one vertical
 * displacement; sideways, and vertically where nothing is in contact, the block floats: the mean
 * of its far side, and of its face, is left 0. */
#ifndef RUGO_CORE_FULL_FLAT_H
#define RUGO_CORE_FULL_FLAT_H

#include "core/full/bulk.h"

struct flat;

/* bulk: filled, of the layers; may be NULL. */
int flat_create(struct flat **out, const struct mesh *mesh, const struct solid *solid,
                struct bulk *bulk, struct error *err);
void flat_destroy(struct flat **flat);
double flat_bytes(const struct mesh *mesh);

/* Vertical displacement of the face over force a node, a value a wave in the layout of transform.h;
 * 0 for the mean. Borrowed. */
const double *flat_compliance(const struct flat *flat);

/* Takes forces (mesh_freedoms; the far side's vertical ones count by their sum) and eliminates them
 * down to the face. */
void flat_load(struct flat *flat, const double *forces);
/* The face's vertical displacements under the forces taken, mean 0. */
void flat_face(struct flat *flat, double *vertical);
/* Adds vertical forces on the face to those taken, and gives all displacements. May be called once
 * after flat_load. */
void flat_displace(struct flat *flat, const double *vertical, double *displacements);

#endif
