#include "core/statistics/summits/open_summits.h"
#include "core/statistics/summits/grid_summits.h"
#include "core/statistics/summits/open_refined.h"
#include <stdlib.h>

static int summit_add(const struct measured_map *map, size_t i, size_t j, struct summit_list *list,
                      struct error *err) {
    const struct grid *grid = map->grid;
    bool profile = grid_is_profile(grid);
    const double *at = map->z + j * grid->nx + i;
    double dx = grid_dx(grid), dy = grid_dy(grid);
    double xx = (at[-1] - 2 * *at + at[1]) / (dx * dx), yy = 0;
    if (!profile)
        yy = (at[-(long)grid->nx] - 2 * *at + at[grid->nx]) / (dy * dy);
    struct summit summit = {.x = (double)i * dx,
                            .y = profile ? 0 : (double)j * dy,
                            .height = *at,
                            .curvature = profile ? -xx : -(xx + yy) / 2};
    return summit_list_add(list, &summit, err);
}

/* Goes through the points that are marked: those with all neighbours. */
static int grid_search(const struct measured_map *map, const unsigned char *whole, bool corners,
                       struct summit_list *list, struct error *err) {
    size_t nx = map->grid->nx, ny = map->grid->ny;
    bool profile = grid_is_profile(map->grid);
    size_t *columns = array_create(nx, sizeof *columns);
    if (columns == NULL)
        return error_memory(err, nx * sizeof *columns, "a row of summits");
    int status = 0;
    for (size_t j = profile ? 0 : 1; j < (profile ? 1 : ny - 1) && status == 0; j++) {
        const double *row = map->z + j * nx;
        size_t found = row_summits(profile ? NULL : row - nx, row, profile ? NULL : row + nx, nx,
                                   corners, columns);
        for (size_t s = 0; s < found && status == 0; s++)
            if (whole[j * nx + columns[s]] != 0)
                status = summit_add(map, columns[s], j, list, err);
    }
    free(columns);
    return status;
}

int open_summits_find(const struct measured_map *map, enum summit_stencil stencil,
                      struct summit_list *list, double *searched, struct error *err) {
    const struct grid *grid = map->grid;
    bool refined = stencil == SUMMITS_REFINED;
    unsigned char *whole = array_create(grid_points(grid), 1);
    if (whole == NULL)
        return error_memory(err, grid_points(grid), "marks of a map");
    size_t marked = map_mark_whole(map, refined ? OPEN_REFINED_BEFORE : 1,
                                   refined ? OPEN_REFINED_AFTER : 1, whole);
    list->count = 0;
    int status = refined ? open_refined_find(map, whole, list, err)
                         : grid_search(map, whole, stencil == SUMMITS_NINE_POINT, list, err);
    *searched = (double)marked * grid_dx(grid) * (grid_is_profile(grid) ? 1 : grid_dy(grid));
    free(whole);
    return status;
}
