#include "core/map/map_resample.h"
#include "core/map/preparation.h"
#include "core/map/preparation_internal.h"
#include <math.h>

/* The points that are asked for. */
struct points {
    double nx, ny; /* whole, and perhaps too many */
    double dx, dy;
};

/* Returns how many points `spacing` apart lie within n points `old` apart. */
static double count_within(size_t n, double old, double spacing) {
    return floor((double)(n - 1) * old / spacing * (1 + 1e-12) + 1e-9) + 1;
}

/* Points within the old ones, along y as far apart as along x where nothing else is asked for. */
static void points_of_open(struct points *out, const struct grid *grid, double spacing,
                           const struct preparation *asked) {
    const double dx = grid_dx(grid), dy = grid_dy(grid);
    out->dx = spacing > 0 ? spacing
                          : (double)(grid->nx - 1) * dx / fmax((double)asked->resample_x - 1, 1);
    out->nx = spacing > 0 ? count_within(grid->nx, dx, spacing) : (double)asked->resample_x;
    out->dy = asked->resample_y > 1 ? (double)(grid->ny - 1) * dy / (double)(asked->resample_y - 1)
                                    : out->dx;
    out->ny =
        asked->resample_y > 0 ? (double)asked->resample_y : count_within(grid->ny, dy, out->dy);
}

/* Points that share out the cell. */
static void points_of_periodic(struct points *out, const struct grid *grid, double spacing,
                               const struct preparation *asked) {
    out->nx = spacing > 0 ? round(grid->lx / spacing) : (double)asked->resample_x;
    out->dx = grid->lx / out->nx;
    out->ny =
        asked->resample_y > 0 ? (double)asked->resample_y : fmax(round(grid->ly / out->dx), 1);
    out->dy = grid->ly / out->ny;
}

int preparation_resample(struct preparation_record *record, struct height_map *map,
                         const struct preparation *asked, struct error *err) {
    const struct grid before = map->grid;
    const bool open = record->boundary == BOUNDARY_OPEN, profile = grid_is_profile(&before);
    struct points points = {0};
    double spacing = 0;
    char dx[40], dy[40];
    if (asked->resample_x == 0 && asked->resample_dx.value == 0)
        return 0;
    int status = height_map_check_whole(map, err);
    if (status != 0)
        return error_context(err, "--resample, before which --fill fills holes");
    if (asked->resample_dx.value > 0)
        status = preparation_length(&spacing, map, &asked->resample_dx, "--resample", err);
    if (status != 0)
        return status;
    if (open)
        points_of_open(&points, &before, spacing, asked);
    else
        points_of_periodic(&points, &before, spacing, asked);
    if (profile && asked->resample_y == 0)
        points.ny = 1;
    if (profile != (points.ny == 1))
        return error_set(err, ERROR_INPUT,
                         "--resample: %g rows of a map of %zu; a profile has 1, other maps more",
                         points.ny, before.ny);
    const double most = 0x1p31;
    status = map_resample(map, record->boundary, (size_t)fmin(points.nx, most),
                          (size_t)fmin(points.ny, most), points.dx, points.dy, err);
    if (status != 0)
        return error_context(err, "--resample");
    preparation_note(record, "resample", "%zu by %zu points to %zu by %zu, %s by %s apart, %s",
                     before.nx, before.ny, map->grid.nx, map->grid.ny,
                     preparation_length_text(map, grid_dx(&map->grid), dx),
                     preparation_length_text(map, grid_dy(&map->grid), dy),
                     !open                          ? "by waves"
                     : points.dx > grid_dx(&before) ? "without waves that these cannot show"
                                                    : "by a cubic spline");
    return 0;
}
