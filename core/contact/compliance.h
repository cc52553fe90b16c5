/* How the flat face of a periodic elastic block yields to a frictionless pressure, wave by wave.
 *
 * Displacement and pressure are linked by u_hat(k) = S(k) p_hat(k) for every wave vector k != 0;
 * the mean pressure moves the whole face, which contact absorbs into the approach. Pressures are in
 * units of E* = E/(1 - nu^2), so that S is a length; plane strain for profiles.
 *
 * halfspace: S = 2/|k| (infinite depth), or the exact layer whose far side stays flat and free of
 *   shear, S = (2/k) (cosh 2kH - 1)/(sinh 2kH + 2kH).
 * layered: linear finite elements, a column of bilinear quadrilaterals (trilinear hexahedra) a grid
 *   cell, layers that grow with depth by a factor; the mean dilatation of each element replaces the
 *   local one (as in B-bar; Hughes 1980) but for a part that makes the face's compliance of fourth
 *   order along x and y (layered.c), so that nu = 0.4999 does not lock. Periodic, equal sideways,
 *   its stiffness falls apart into one block-tridiagonal system in depth a wave vector, which is
 *   eliminated from the far side up: the exact compliance of the mesh.
 *
 * A half-space may also be pressed in the grid's rectangle alone, in free space (free_space.h): its
 * displacements have a level then, and it knows no wave vectors of its own. */
#ifndef RUGO_CORE_CONTACT_COMPLIANCE_H
#define RUGO_CORE_CONTACT_COMPLIANCE_H

#include "core/contact/block.h"

/* Immutable once made: share it between threads. Arrays hold a value a wave vector in the layout of
 * transform.h: [mx*ny + row], mx = 0 .. nx/2, row = my for my >= 0 and ny + my below. */
struct compliance {
    struct grid grid;
    struct block block;
    bool open;         /* in free space, not periodic */
    struct grid waved; /* whose wave vectors the arrays hold: grid, or where open the padded one */
    size_t waves;      /* (nx/2 + 1) * ny of that */
    double *length;    /* owned: S E*; 0 for the mean, where open what free_space.h says */
    double *weight;    /* owned: symbol of the gap weighting; NULL: 1 */
    size_t layers;     /* of the mesh; 0 for a half-space */
};

/* S E* of the block itself, without a mesh (F10.1, F10.2), under a wave number k > 0. */
double block_compliance(double k, double height);

/* ERROR_INPUT for a block out of its ranges (block_check); ERROR_MEMORY. Time: about waves x
 * layers. */
int compliance_create(struct compliance **out, const struct grid *grid, const struct block *block,
                      struct error *err);
/* Of a half-space in free space. ERROR_INPUT as above, and for any other block; ERROR_MEMORY. */
int compliance_create_open(struct compliance **out, const struct grid *grid,
                           const struct block *block, struct error *err);
void compliance_destroy(struct compliance **compliance);
double compliance_bytes(const struct grid *grid, const struct block *block);

#endif
