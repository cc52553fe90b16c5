/* The inverse stiffness of the block with a flat face, the preconditioner of the rough block.
 *
 * Because its columns are equal, the flat block's stiffness separates into one block-tridiagonal
 * system in depth for each wave vector (as in core/contact/layered.c, which keeps only the face).
 * With sideways displacements written as i X and i Y the systems are real. They are eliminated
 * once, from the far side up. Where columns widen, a wave and its aliases (aliasing.h) are coupled.
 * The inverse neglects that coupling; for forces on the face its relative error is exp(-pi depth),
 * with the depth of the wider columns in columns.
 *
 * All nodes of the far side have one vertical displacement. The block is free to move sideways, and
 * vertically where nothing is in contact; the mean displacements of its far side and of its face
 * are then set to 0. */
#ifndef RUGO_CORE_FULL_LINEAR_PRECONDITIONER_H
#define RUGO_CORE_FULL_LINEAR_PRECONDITIONER_H

#include "core/full/volumetric.h"

struct preconditioner;

/* Fills volumetric, which may be NULL, with the entries of the layers. */
int preconditioner_create(struct preconditioner **out, const struct mesh *mesh,
                          const struct material *material, struct volumetric *volumetric,
                          struct error *err);
/* A drag on the block. */
struct preconditioner_drag {
    double of; /* stiffness of each displacement but the mean vertical one of a level; 0 at first */
    /* Whether the mean of the far side does not move sideways, whatever forces are in balance. */
    bool held;
};
/* material and volumetric are those of preconditioner_create. */
int preconditioner_set_drag(struct preconditioner *preconditioner, const struct material *material,
                            struct volumetric *volumetric, struct preconditioner_drag drag,
                            struct error *err);
void preconditioner_destroy(struct preconditioner **handle);
double preconditioner_bytes(const struct mesh *mesh);

/* Vertical displacement of the face over the force on each node, one value a wave in the layout of
 * transform.h; 0 for the mean. The caller borrows the array. */
const double *preconditioner_compliance(const struct preconditioner *preconditioner);

/* Stores forces (mesh_degrees_of_freedom values; only the sum of the vertical ones on the far side
 * counts) and eliminates all levels but the face. */
void preconditioner_load(struct preconditioner *preconditioner, const double *forces);
/* Computes the face's vertical displacements under the forces stored; their mean is 0. */
void preconditioner_face(struct preconditioner *preconditioner, double *vertical);
/* Adds vertical forces on the face to those stored, and computes all displacements. May be called
 * once after each preconditioner_load. */
void preconditioner_displace(struct preconditioner *preconditioner, const double *vertical,
                             double *displacements);

/* The same for forces and displacements in all directions of the face, as an array for each
 * component, the vertical one last: [component * face + node]. Forces along the face are to be in
 * balance with those on the far side, where it is not held: else it gives by their mean there, and
 * the face with it. */
void preconditioner_face_all(struct preconditioner *preconditioner, double *face);
void preconditioner_displace_all(struct preconditioner *preconditioner, const double *forces,
                                 double *displacements);
/* Fills, with d components, compliance and stiffness of the face against a far side whose mean
 * stays, by wave: [(i*d + j)*waves + wave], by which components of forces and displacements are
 * multiplied where those along the face stand as -i times their spectra. The vertical mean has
 * neither. */
void preconditioner_matrices(const struct preconditioner *preconditioner, double *compliance,
                             double *stiffness);

#endif
