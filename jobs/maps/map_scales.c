#include "jobs/maps/map_scales.h"
#include "core/statistics/uncertainty/scalar_errors.h"
#include <math.h>

static void fill_errors(struct map_scale *scale, const struct map_chance *chance,
                        const struct cell_differences *differences, double excess) {
    struct scalar_errors errors;
    scalar_errors_differences(differences, chance->heights, &chance->modes, &errors);
    double more = sqrt(excess), none = chance->told ? 1 : (double)NAN;
    scale->height_error = scale->found.height * errors.slope * more * none;
    scale->slope_error = scale->found.slope * errors.slope * more * none;
    scale->curvature_error = scale->found.curvature * errors.curvature * more * none;
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
        fill_errors(scale, chance, differences, excess);
        if (!grid_is_profile(map->grid))
            measure_directions(scale, chance, differences, excess);
    }
}
