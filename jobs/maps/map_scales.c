#include "jobs/maps/map_scales.h"
#include "core/statistics/uncertainty/scalar_errors.h"
#include <math.h>

/* Differences are correlated over their lag, too, so that of longer ones too few are independent.
 */
static const double LAGS_INSIDE_LEAST = 6;

/* Returns how many points of a side have as many others to both sides, or to one, as the lag. */
static double points_of(size_t n, double lags) {
    return fmax((double)n - lags, 1);
}

/* Errors are of the points that have both neighbours along both axes. Differences of first order
 * are taken over more of an open map, and have less error by the root of the areas. */
static double share_of(const struct measured_map *map, size_t lag) {
    const struct grid *grid = map->grid;
    const double x = (double)lag;
    if (map->boundary != BOUNDARY_OPEN)
        return 1;
    if (grid_is_profile(grid))
        return points_of(grid->nx, 2 * x) / points_of(grid->nx, x);
    const double y = fmax(rint(x * grid_dx(grid) / grid_dy(grid)), 1);
    const double both = points_of(grid->nx, 2 * x) * points_of(grid->ny, 2 * y);
    return 2 * both /
           (points_of(grid->nx, x) * (double)grid->ny + points_of(grid->ny, y) * (double)grid->nx);
}

static void fill_errors(struct map_scale *scale, const struct measured_map *map, size_t lag,
                        const struct map_chance *chance, const struct cell_differences *differences,
                        double excess) {
    struct scalar_errors errors;
    scalar_errors_differences(differences, chance->heights, &chance->modes, &errors);
    const struct grid *grid = map->grid;
    const double side = grid_is_profile(grid) ? grid->lx : fmin(grid->lx, grid->ly);
    const bool known = chance->told && side >= LAGS_INSIDE_LEAST * scale->found.length;
    double more = (double)NAN;
    if (known) {
        const double freedom = low_modes_freedom_slopes(&chance->modes, chance->correlation, grid,
                                                        scale->found.length, differences->count);
        more = sqrt(excess) * low_modes_factor_over(&chance->modes, freedom);
    }
    const double slope = errors.slope * more * sqrt(share_of(map, lag));
    scale->height_error = scale->found.height * slope;
    scale->slope_error = scale->found.slope * slope;
    scale->curvature_error = scale->found.curvature * errors.curvature * more;
}

static void measure_directions(struct map_scale *scale, const struct map_chance *chance,
                               const struct cell_differences *differences, double excess) {
    double length = scale->found.length;
    /* Of longer differences too few are independent. */
    bool known = chance->told && length <= correlation_length(chance->correlation);
    isotropy_measure(differences, length, &chance->modes, known ? excess : (double)NAN,
                     &scale->isotropy);
}

void map_scales_measure(struct map_scales *out, const struct measured_map *map,
                        const struct map_chance *chance, const struct cell_differences *nearest) {
    struct scale scales[SCALES_MOST];
    out->count = scales_measure(map, scales);
    for (size_t n = 0; n < out->count; n++) {
        struct cell_differences farther;
        const struct cell_differences *differences = n == 0 ? nearest : &farther;
        struct map_scale *scale = &out->scale[n];
        *scale = (struct map_scale){.found = scales[n]};
        double excess = chance->told ? low_modes_excess_slopes(&chance->modes, chance->correlation,
                                                               map->grid, scales[n].length)
                                     : 1;
        if (n > 0)
            cell_differences_measure(map, &chance->modes, (size_t)1 << n, &farther);
        fill_errors(scale, map, (size_t)1 << n, chance, differences, excess);
        if (!grid_is_profile(map->grid))
            measure_directions(scale, chance, differences, excess);
    }
}
