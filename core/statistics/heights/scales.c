#include "core/statistics/heights/scales.h"
#include "core/statistics/lanes.h"
#include "core/vectors.h"

/* Adds the squares of n differences a - b, at most LANES, where both are there. */
WIDE_VECTORS static void differences_add(size_t n, const double *a, const double *b,
                                         struct lanes *restrict lanes) {
    for (size_t l = 0; l < n; l++) {
        lane_add(lanes, l, (a[l] - b[l]) * (a[l] - b[l]));
    }
}

/* Where the five points of second differences are: z itself, and those a lag from it. */
struct cross {
    const double *z, *left, *right, *up, *down; /* a profile: up and down are z */
};

/* Adds the squares of n second differences; along_x and along_y are weights. */
WIDE_VECTORS static void bends_add(size_t n, struct cross at, double along_x, double along_y,
                                   struct lanes *restrict lanes) {
    for (size_t l = 0; l < n; l++) {
        double z = at.z[l];
        double bend = along_x * ((at.left[l] - z) + (at.right[l] - z)) +
                      along_y * ((at.up[l] - z) + (at.down[l] - z));
        lane_add(lanes, l, bend * bend);
    }
}

struct scale_sums {
    size_t lag;
    double along_x, along_y; /* weights of second differences */
    struct lane_mean slope_x, slope_y, curvature;
};

static void row_differences(size_t n, const double *a, const double *b, struct lanes *lanes) {
    for (size_t i = 0; i < n; i += LANES)
        differences_add(n - i < LANES ? n - i : LANES, a + i, b + i, lanes);
}

/* Adds the second differences of n columns from `first` on; those beside them are `left` and
 * `right` columns ahead. */
static void row_bends(const struct scale_sums *sums, struct cross row, size_t first, size_t n,
                      long left, long right, struct lanes *lanes) {
    for (size_t i = first; i < first + n; i += LANES) {
        const struct cross at = {row.z + i, row.z + i + left, row.z + i + right, row.up + i,
                                 row.down + i};
        bends_add(first + n - i < LANES ? first + n - i : LANES, at, sums->along_x, sums->along_y,
                  lanes);
    }
}

/* Returns row j of a map, at most one side outside of it; NULL outside of an open one. */
static const double *row_at(const struct measured_map *map, long j) {
    long ny = (long)map->grid->ny;
    if (map->boundary == BOUNDARY_OPEN && (j < 0 || j >= ny))
        return NULL;
    return map->z + (size_t)((j + ny) % ny) * map->grid->nx;
}

static void row_add(const struct measured_map *map, size_t j, struct scale_sums *sums) {
    const size_t nx = map->grid->nx, lag = sums->lag;
    const bool open = map->boundary == BOUNDARY_OPEN, profile = grid_is_profile(map->grid);
    const double *z = map->z + j * nx;
    const double *down = profile ? z : row_at(map, (long)(j + lag));
    const double *up = profile ? z : row_at(map, (long)j - (long)lag);
    struct lanes x = {0}, y = {0}, bends = {0};
    row_differences(nx - lag, z + lag, z, &x);
    if (!open)
        row_differences(lag, z, z + nx - lag, &x);
    lane_mean_add(&sums->slope_x, &x);
    if (!profile && down != NULL)
        row_differences(nx, down, z, &y);
    lane_mean_add(&sums->slope_y, &y);
    if (up == NULL || down == NULL)
        return;
    const struct cross row = {.z = z, .up = up, .down = down};
    const long back = (long)lag, round = (long)nx - back;
    if (2 * lag < nx)
        row_bends(sums, row, lag, nx - 2 * lag, -back, back, &bends);
    if (!open) {
        row_bends(sums, row, 0, lag, round, back, &bends);
        row_bends(sums, row, nx - lag, lag, -back, -round, &bends);
    }
    lane_mean_add(&sums->curvature, &bends);
}

static struct scale scale_measure(const struct measured_map *map, size_t lag) {
    const struct grid *grid = map->grid;
    const bool profile = grid_is_profile(grid);
    double lx = (double)lag * grid_dx(grid), ly = profile ? lx : (double)lag * grid_dy(grid);
    struct scale_sums sums = {.lag = lag,
                              .along_x = (profile ? 1 : 0.5) / (lx * lx),
                              .along_y = profile ? 0 : 0.5 / (ly * ly)};
    for (size_t j = 0; j < grid->ny; j++)
        row_add(map, j, &sums);
    double x = lane_mean_value(&sums.slope_x), y = profile ? 0 : lane_mean_value(&sums.slope_y);
    double squares = sum_value(&sums.slope_x.sum) + sum_value(&sums.slope_y.sum);
    double count = sums.slope_x.count + sums.slope_y.count;
    return (struct scale){.length = lx,
                          .height = count > 0 ? sqrt(squares / count / 2) : (double)NAN,
                          .slope = sqrt(x / (lx * lx) + y / (ly * ly)),
                          .curvature = sqrt(lane_mean_value(&sums.curvature))};
}

size_t scales_measure(const struct measured_map *map, struct scale *out) {
    const struct grid *grid = map->grid;
    size_t side = grid_is_profile(grid) || grid->nx < grid->ny ? grid->nx : grid->ny, count = 0;
    for (size_t lag = 1; count < SCALES_MOST && (lag == 1 || 4 * lag <= side); lag *= 2)
        out[count++] = scale_measure(map, lag);
    return count;
}
