#include "jobs/maps/press/map_press_cost.h"
#include "jobs/contact/model/model_linear.h"
#include <math.h>

bool press_cost_is_known(const struct contact_model *model) {
    return model->nodes != NULL;
}

/* Returns the grid of so many points with the map's spacing, as it is pressed. */
static struct grid grid_of(const struct map_press *press, size_t nx, size_t ny) {
    const struct grid *map = &press->map;
    const bool profile = grid_is_profile(map);
    const size_t times = press->boundary == PRESS_MIRRORED ? 2 : 1;
    const double rows = profile ? 1 : (double)times;
    return (struct grid){times * nx, profile ? 1 : times * ny,
                         (double)times * grid_dx(map) * (double)nx,
                         profile ? map->ly : rows * grid_dy(map) * (double)ny};
}

struct case_cost {
    double nodes, bytes, seconds;
};

static struct case_cost cost_on(const struct map_press *press, const struct press_block *block,
                                const struct press_goals *goals, const struct grid *grid) {
    struct contact_case one_case = map_press_case(press, grid, block);
    const struct contact_model *model = block->model;
    one_case.load_count = goals->count;
    one_case.loads = goals->loads;
    one_case.slip_load = goals->count - 1;
    const struct quantity_scene scene = {.one_case = &one_case,
                                         .grid = *grid,
                                         .block = one_case.blocks[0],
                                         .exact = linear_is_exact(model),
                                         .slides = model->slides};
    return (struct case_cost){
        .nodes = model->nodes(&one_case, 0, grid),
        .bytes = model->bytes(&one_case, 0, grid) + area_workspace_bytes(grid, one_case.blocks) +
                 compliance_bytes(grid, one_case.blocks) + contact_quantities_bytes(&scene),
        .seconds = model->seconds(&one_case, 0, grid) + contact_quantities_seconds(&scene)};
}

struct press_cost press_cost_of(const struct map_press *press, const struct press_block *block,
                                const struct press_goals *goals, size_t nx, size_t ny) {
    const struct grid grid = grid_of(press, nx, ny);
    const bool profile = grid_is_profile(&grid);
    const struct grid half = {(grid.nx + 1) / 2, profile ? 1 : (grid.ny + 1) / 2, grid.lx, grid.ly};
    const struct case_cost fine = cost_on(press, block, goals, &grid);
    const struct case_cost coarse = cost_on(press, block, goals, &half);
    /* the heights, and the values of a file */
    const double heights = 12.0 * sizeof(double) * (double)grid_points(&grid);
    return (struct press_cost){.pressed = grid,
                               .nodes = fine.nodes,
                               .bytes = fine.bytes + heights + PROCESS_BYTES,
                               .seconds = fine.seconds,
                               .error_seconds = coarse.seconds};
}

bool press_cost_fits(const struct press_cost *cost, const struct press_room *room) {
    double seconds = cost->seconds + (room->with_errors ? cost->error_seconds : 0);
    return cost->nodes > 0 && !(room->bytes > 0 && cost->bytes > room->bytes) &&
           !(room->seconds > 0 && seconds > room->seconds);
}

/* Returns an even part of a side, which every second point needs. */
static size_t part_of(size_t side, double part) {
    size_t half = (size_t)(part * (double)side / 2);
    return side == 1 ? 1 : 2 * half;
}

bool press_cost_largest(const struct map_press *press, const struct press_block *block,
                        const struct press_goals *goals, const struct press_room *room, size_t *nx,
                        size_t *ny) {
    enum { HALVINGS = 20 };
    const struct grid *map = &press->map;
    double fits = 0, fails = 1;
    for (int k = 0; k < HALVINGS; k++) {
        double middle = (fits + fails) / 2;
        *nx = part_of(map->nx, middle);
        *ny = part_of(map->ny, middle);
        bool small = *nx < PRESS_SIDE_LEAST || (map->ny > 1 && *ny < PRESS_SIDE_LEAST);
        const struct press_cost cost =
            small ? (struct press_cost){.nodes = 0} : press_cost_of(press, block, goals, *nx, *ny);
        if (small || press_cost_fits(&cost, room))
            fits = middle;
        else
            fails = middle;
    }
    *nx = part_of(map->nx, fits);
    *ny = part_of(map->ny, fits);
    return *nx >= PRESS_SIDE_LEAST && (map->ny == 1 || *ny >= PRESS_SIDE_LEAST);
}
