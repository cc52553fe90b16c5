/* A periodic cell and its sampling. x runs fastest: z[j*nx + i] is at (i*lx/nx, j*ly/ny).
 * A profile has ny == 1; its ly is ignored. */
#ifndef RUGO_CORE_SURFACE_GRID_H
#define RUGO_CORE_SURFACE_GRID_H

#include "core/error.h"
#include <stdbool.h>
#include <stddef.h>

struct grid {
    size_t nx, ny; /* points, at least 2 by 1 */
    double lx, ly; /* cell lengths, any unit */
};

/* ERROR_INPUT for fewer than 2 by 1 points, for more than memory can hold, and for a length that is
 * not positive and finite; ly of a profile is not looked at. */
int grid_check(const struct grid *grid, struct error *err);
static inline bool grid_is_profile(const struct grid *grid) {
    return grid->ny == 1;
}
static inline size_t grid_points(const struct grid *grid) {
    return grid->nx * grid->ny;
}
static inline double grid_dx(const struct grid *grid) {
    return grid->lx / (double)grid->nx;
}
static inline double grid_dy(const struct grid *grid) {
    return grid->ly / (double)grid->ny;
}
/* Returns the wider spacing: waves of the grid along both axes are at least twice as long. */
static inline double grid_widest_spacing(const struct grid *grid) {
    const double dx = grid_dx(grid), dy = grid_dy(grid);
    return grid_is_profile(grid) || dx > dy ? dx : dy;
}
/* Returns the longer side, of a profile its length. */
static inline double grid_longest_side(const struct grid *grid) {
    return grid_is_profile(grid) || grid->lx > grid->ly ? grid->lx : grid->ly;
}

#endif
