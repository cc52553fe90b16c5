/* Contact patches: nodes in contact, joined along grid lines, also across the sides of a periodic
 * cell. */
#ifndef RUGO_CORE_CONTACT_PATCHES_H
#define RUGO_CORE_CONTACT_PATCHES_H

#include "core/surface/grid.h"

struct patches {
    size_t count;
    size_t largest; /* nodes */
    double mean;    /* nodes a patch; NaN without patches */
};
struct patch_finder;
int patch_finder_create(struct patch_finder **out, const struct grid *grid, struct error *err);
/* From then on patches are those of the first nx by ny nodes alone, at most those of the grid, and
 * nothing is joined across the sides of these: a map in free space, or one that the grid repeats by
 * its mirror images. */
void patch_finder_open(struct patch_finder *finder, size_t nx, size_t ny);
void patch_finder_destroy(struct patch_finder **finder);
/* Returns the bytes that patches_find touches where the caller lends no memory. */
double patch_finder_bytes(const struct grid *grid);
/* Lends the next patches_find grid_points doubles, whose values are lost. NULL, the initial value:
 * it takes memory of its own, which stays untouched as long as some is lent. */
void patch_finder_lend(struct patch_finder *finder, double *scratch);
/* A node is in contact where p > 0. sizes (NULL: not wanted) gets the nodes of each patch, room for
 * grid_points. */
void patches_find(struct patch_finder *finder, const double *p, struct patches *out, size_t *sizes);

#endif
