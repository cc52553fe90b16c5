#include "core/surface/grid.h"
#include <math.h>
#include <stdint.h>

int grid_check(const struct grid *grid, struct error *err) {
    if (grid->nx < 2 || grid->ny < 1)
        return error_set(err, ERROR_INPUT, "a grid of %zu by %zu points; allowed: at least 2 by 1",
                         grid->nx, grid->ny);
    if (grid->ny > SIZE_MAX / 32 / grid->nx)
        return error_set(err, ERROR_INPUT, "a grid of %zu by %zu points is more than memory holds",
                         grid->nx, grid->ny);
    if (!(grid->lx > 0 && isfinite(grid->lx)))
        return error_set(err, ERROR_INPUT, "cell length lx = %g; allowed: above 0, finite",
                         grid->lx);
    if (!grid_is_profile(grid) && !(grid->ly > 0 && isfinite(grid->ly)))
        return error_set(err, ERROR_INPUT, "cell length ly = %g; allowed: above 0, finite",
                         grid->ly);
    return 0;
}
