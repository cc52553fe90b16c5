#include "core/statistics/correlation_field.h"
#include "core/statistics/isotropy.h"
#include "core/statistics/scalar_errors.h"
#include "core/statistics/scales.h"
#include "server/show/characterise_heights.h"
#include <math.h>

struct scale_columns {
    double *length, *height, *height_error, *slope, *slope_error, *curvature, *curvature_error;
};
/* NULL throughout for profiles. */
struct direction_columns {
    double *length, *ratio, *ratio_error, *direction, *direction_error, *p_value;
};

static bool scale_columns_add(struct characterisation *out, size_t count,
                              struct scale_columns *columns) {
    static const char GROUP[] = "scales";
    *columns = (struct scale_columns){
        characterisation_column_length(out, GROUP, "length", count, 1),
        characterisation_column_length(out, GROUP, "rms_height", count, 1),
        characterisation_column_length(out, GROUP, "rms_height_error", count, 1),
        characterisation_column(out, GROUP, "rms_slope", count),
        characterisation_column(out, GROUP, "rms_slope_error", count),
        characterisation_column_length(out, GROUP, "rms_curvature", count, -1),
        characterisation_column_length(out, GROUP, "rms_curvature_error", count, -1)};
    return columns->length != NULL && columns->height != NULL && columns->height_error != NULL &&
           columns->slope != NULL && columns->slope_error != NULL && columns->curvature != NULL &&
           columns->curvature_error != NULL;
}

static bool direction_columns_add(struct characterisation *out, size_t count,
                                  struct direction_columns *columns) {
    static const char GROUP[] = "isotropy_by_scale";
    *columns =
        (struct direction_columns){characterisation_column_length(out, GROUP, "length", count, 1),
                                   characterisation_column(out, GROUP, "ratio", count),
                                   characterisation_column(out, GROUP, "ratio_error", count),
                                   characterisation_column(out, GROUP, "direction", count),
                                   characterisation_column(out, GROUP, "direction_error", count),
                                   characterisation_column(out, GROUP, "p_value", count)};
    return columns->length != NULL && columns->ratio != NULL && columns->ratio_error != NULL &&
           columns->direction != NULL && columns->direction_error != NULL &&
           columns->p_value != NULL;
}

static void errors_fill(const struct scale_columns *columns, size_t n,
                        const struct map_chance *chance, const struct cell_differences *differences,
                        double excess) {
    struct scalar_errors errors;
    scalar_errors_differences(differences, chance->heights, &chance->modes, &errors);
    double more = sqrt(excess), none = chance->told ? 1 : (double)NAN;
    columns->height_error[n] = columns->height[n] * errors.slope * more * none;
    columns->slope_error[n] = columns->slope[n] * errors.slope * more * none;
    columns->curvature_error[n] = columns->curvature[n] * errors.curvature * more * none;
}

static void directions_fill(const struct direction_columns *columns, size_t n,
                            const struct map_chance *chance,
                            const struct cell_differences *differences, double length,
                            double excess) {
    static const double DEGREE = M_PI / 180;
    struct isotropy isotropy;
    /* Longer differences are as unlike as chance has it, which few of them tell. */
    bool told = chance->told && length <= correlation_length(chance->correlation);
    isotropy_measure(differences, length, &chance->modes, told ? excess : (double)NAN, &isotropy);
    columns->length[n] = length;
    columns->ratio[n] = isotropy.ratio;
    columns->ratio_error[n] = isotropy.ratio_error;
    columns->direction[n] = isotropy.direction / DEGREE;
    columns->direction_error[n] = isotropy.direction_error / DEGREE;
    columns->p_value[n] = isotropy.p_value;
}

int characterise_scales(struct characterisation *out, const struct measured_map *map,
                        const struct map_chance *chance, struct error *err) {
    struct scale scales[SCALES_MOST];
    struct scale_columns columns;
    struct direction_columns directions = {0};
    size_t count = scales_measure(map, scales);
    bool profile = grid_is_profile(map->grid);
    if (!scale_columns_add(out, count, &columns) ||
        (!profile && !direction_columns_add(out, count, &directions)))
        return error_memory(err, count * sizeof *columns.length, "a table of scales");
    for (size_t n = 0; n < count; n++) {
        struct cell_differences differences;
        double length = scales[n].length;
        double excess = chance->told ? low_modes_excess_slopes(&chance->modes, chance->correlation,
                                                               map->grid, length)
                                     : 1;
        columns.length[n] = length;
        columns.height[n] = scales[n].height;
        columns.slope[n] = scales[n].slope;
        columns.curvature[n] = scales[n].curvature;
        cell_differences_measure(map, &chance->modes, (size_t)1 << n, &differences);
        errors_fill(&columns, n, chance, &differences, excess);
        if (!profile)
            directions_fill(&directions, n, chance, &differences, length, excess);
    }
    return 0;
}
