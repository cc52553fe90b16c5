/* Displacement of the flat face of a periodic elastic block under a frictionless pressure, wave by
 * wave.
 *
 * Displacement and pressure are linked by u_hat(k) = S(k) p_hat(k) for every wave vector k != 0.
 * The mean pressure moves the whole face, which contact includes in the approach. Pressures are in
 * units of E* = E/(1 - nu^2), so that S is a length; profiles are in plane strain.
 *
 * halfspace: S = 2/|k| (infinite depth), or the exact layer whose far side stays flat and free of
 *   shear, S = (2/k) (cosh 2kH - 1)/(sinh 2kH + 2kH). A bonded layer on either is exact too
 *   (coating.h); E* is that of what lies below.
 * layered: linear finite elements, a column of bilinear quadrilaterals (trilinear hexahedra) a grid
 *   cell, in layers that grow with depth by a factor. The mean dilatation of each element replaces
 *   the local one (as in B-bar; Hughes 1980), except for a part that makes the error of S of fourth
 *   order along x and y (layered.c); so nu = 0.4999 does not lock. All columns are equal and the
 *   mesh is periodic, so that its stiffness decouples into one block-tridiagonal system in depth a
 *   wave vector. It is eliminated from the far side up, which gives the mesh's exact compliance.
 *
 * A half-space may also be pressed in the grid's rectangle alone, in free space (free_space.h). Its
 * displacements then have a mean, and its wave vectors are those of a padded grid. */
#ifndef RUGO_CORE_CONTACT_COMPLIANCE_H
#define RUGO_CORE_CONTACT_COMPLIANCE_H

#include "core/contact/block.h"

/* Immutable once made: share it between threads. Arrays hold a value a wave vector in the layout of
 * transform.h: [mx*ny + row], mx = 0 .. nx/2, row = my for my >= 0 and ny + my below. */
struct compliance {
    struct grid grid;
    struct block block;
    bool open;         /* in free space, not periodic */
    struct grid waved; /* the grid of the wave vectors: grid, or where open the padded one */
    size_t waves;      /* (nx/2 + 1) * ny of that */
    double *length;    /* owned: S E*; 0 for the mean, where open what free_space.h says */
    double *weight;    /* owned: symbol of the gap weighting; NULL: 1 */
    size_t layers;     /* of the mesh; 0 for a half-space */
};

/* S E* of a block itself, without a mesh (F10.1, F10.2), under a wave number k > 0. */
double block_compliance_exact(double k, const struct block *block);

/* ERROR_INPUT where one spacing is more than 100 times the other: the memory and the time of free
 * space and of area laws (area_law.h) grow with that ratio, however few the points. */
int compliance_check_spacings(const struct grid *grid, struct error *err);

/* ERROR_INPUT for a grid or block out of range (grid_check, block_check), too many layers, or a
 * height out of proportion to the cell; ERROR_MEMORY. Time: about waves x
 * layers. */
int compliance_create(struct compliance **out, const struct grid *grid, const struct block *block,
                      struct error *err);
/* Of a half-space in free space. ERROR_INPUT as above, for any other block, and for spacings too
 * far apart; ERROR_MEMORY. */
int compliance_create_open(struct compliance **out, const struct grid *grid,
                           const struct block *block, struct error *err);
void compliance_destroy(struct compliance **compliance);
/* Returns whether the gap of such a block is weighted. */
bool compliance_has_weight(const struct block *block);
double compliance_bytes(const struct grid *grid, const struct block *block);

#endif
