#include "server/show/map_characterisation.h"
#include "core/statistics/areal.h"
#include "core/statistics/height_quantiles.h"
#include "core/statistics/roughness.h"
#include "server/show/characterise_heights.h"
#include "server/show/characterise_spectrum.h"
#include <math.h>
#include <string.h>

static void add_preparation(struct characterisation *out, const struct preparation_record *record) {
    for (size_t step = 0; step < record->count; step++)
        characterisation_add_text(out, "preparation", record->steps[step].name,
                                  record->steps[step].text);
}

static void add_decision(struct characterisation *out, const struct preparation_record *decision,
                         const struct height_map *map) {
    static const char GROUP[] = "map";
    static const char *const DETRENDS[] = {"none", "mean", "plane", "quadratic"};
    const struct trend *trend = &decision->trend;
    bool profile = grid_is_profile(&map->grid);
    if (*map->xy_unit != '\0')
        characterisation_add_text(out, GROUP, "unit", map->xy_unit);
    characterisation_add_text(out, GROUP, "boundary",
                              decision->boundary == BOUNDARY_OPEN ? "open" : "periodic");
    characterisation_add_text(out, GROUP, "boundary_by", decision->boundary_by);
    characterisation_add(out, GROUP, "seam_x", decision->seam.x);
    characterisation_add(out, GROUP, "seam_y", profile ? (double)NAN : decision->seam.y);
    characterisation_add(out, GROUP, "holes", decision->holes);
    characterisation_add_text(out, GROUP, "psd_window",
                              decision->boundary == BOUNDARY_OPEN ? "hann" : "none");
    if (decision->window_power < 1)
        characterisation_add(out, GROUP, "window_power", decision->window_power);
    characterisation_add_text(out, GROUP, "detrend", DETRENDS[decision->detrend]);
    if (decision->detrend != DETREND_NONE)
        characterisation_add_length(out, GROUP, "trend_height", trend->height, 1);
    if (decision->detrend >= DETREND_PLANE) {
        characterisation_add(out, GROUP, "trend_slope_x", trend->slope_x);
        characterisation_add(out, GROUP, "trend_slope_y", trend->slope_y);
    }
    if (decision->detrend == DETREND_QUADRATIC) {
        characterisation_add_length(out, GROUP, "trend_bend_xx", trend->bend_xx, -1);
        characterisation_add_length(out, GROUP, "trend_bend_xy", trend->bend_xy, -1);
        characterisation_add_length(out, GROUP, "trend_bend_yy", trend->bend_yy, -1);
    }
}

static int add_quantiles(struct characterisation *out, const struct measured_map *map, size_t n,
                         struct error *err) {
    static const char GROUP[] = "quantiles";
    size_t count = height_quantiles_count(n);
    if (count == 0)
        return 0;
    double *probability = characterisation_column(out, GROUP, "probability", count);
    double *quantile = characterisation_column_length(out, GROUP, "quantile", count, 1);
    if (probability == NULL || quantile == NULL)
        return error_memory(err, count * sizeof *quantile, "quantiles of the heights");
    return height_quantiles_measure(map, n, probability, quantile, err);
}

static int add_acf(struct characterisation *out, const struct correlation *correlation,
                   struct error *err) {
    static const char GROUP[] = "acf";
    size_t rings = correlation_rings(correlation);
    double *lag = characterisation_column_length(out, GROUP, "lag", rings, 1);
    double *mean = characterisation_column(out, GROUP, "correlation", rings);
    if (lag == NULL || mean == NULL)
        return error_memory(err, rings * sizeof *mean, "an autocorrelation");
    correlation_radial(correlation, lag, mean);
    return 0;
}

static int add_areal(struct characterisation *out, const struct measured_map *map,
                     const struct map_chance *chance, struct error *err) {
    static const char GROUP[] = "areal";
    struct areal areal = {0};
    struct summit_list hills = {0};
    int status = areal_measure(map, chance->correlation, &hills, &areal, err);
    const struct {
        const char *name;
        double value;
        int power;
    } rows[] = {{"Sa", areal.sa, 1},   {"Sq", areal.sq, 1},   {"Ssk", areal.ssk, 0},
                {"Sku", areal.sku, 0}, {"Sp", areal.sp, 1},   {"Sv", areal.sv, 1},
                {"Sz", areal.sz, 1},   {"Sdq", areal.sdq, 0}, {"Sdr", areal.sdr, 0},
                {"Sal", areal.sal, 1}, {"Str", areal.str, 0}, {"Spd", areal.spd, -2},
                {"Spc", areal.spc, -1}};
    for (size_t r = 0; r < sizeof rows / sizeof *rows && status == 0; r++)
        characterisation_add_length(out, GROUP, rows[r].name, rows[r].value, rows[r].power);
    if (status == 0)
        status = characterise_hills(out, map, chance, &hills, err);
    summit_list_clear(&hills);
    return status;
}

static int add_correlated(struct characterisation *out, const struct measured_map *map,
                          const struct map_chance *chance, const struct preparation_record *record,
                          const struct spectrum_fit_request *trusted, struct error *err) {
    int status = 0;
    if (!grid_is_profile(map->grid))
        status = add_areal(out, map, chance, err);
    if (status == 0)
        status = characterise_chance(out, map, chance, err);
    if (status == 0)
        status = characterise_scales(out, map, chance, err);
    if (status == 0)
        status = characterise_spectrum(out, map, record->window_power < 1, trusted, err);
    if (status == 0)
        status = add_acf(out, chance->correlation, err);
    return status;
}

int map_characterise(struct characterisation *out, const struct height_map *map,
                     const struct preparation_record *record,
                     const struct spectrum_fit_request *trusted, struct error *err) {
    const struct grid *grid = &map->grid;
    const struct measured_map measured = {grid, map->z, record->boundary};
    struct map_chance *chance = NULL;
    int status = map_chance_create(&chance, &measured, err);
    if (status != 0)
        return status;
    if (record->window_power < 1)
        map_chance_forgo(chance, "none: the map is under a window");
    out->in_metres = strcmp(map->xy_unit, "m") == 0 && strcmp(map->z_unit, "m") == 0;
    add_preparation(out, record);
    add_decision(out, record, map);
    if (record->boundary == BOUNDARY_OPEN)
        status = characterise_open(out, &measured, chance, err);
    else
        status = characterise_heights(out, grid, map->z, grid->nx / 2, grid->ny / 2, chance, err);
    if (status == 0)
        status = add_correlated(out, &measured, chance, record, trusted, err);
    map_chance_destroy(&chance);
    size_t heights = grid_points(grid) - height_map_holes(map);
    return status == 0 ? add_quantiles(out, &measured, heights, err) : status;
}
