/* Implements the statistics of open maps of rugo.h. */
#include "core/map/preparation/detrend.h"
#include "core/rugo_shared.h"
#include "core/statistics/heights/areal.h"
#include "core/statistics/heights/roughness.h"
#include "core/statistics/spectra/windowed_psd.h"
#include "core/statistics/summits/local_wave.h"
#include "core/statistics/summits/open_summits.h"
#include "core/statistics/uncertainty/seam.h"

int rugo_detrend(const struct rugo_grid *grid, double *z, enum rugo_trend trend,
                 struct rugo_error *err) {
#define KIND(type, name, value) [RUGO_##type] = DETREND_##type,
    static const enum detrend KINDS[] = {RUGO_TRENDS(KIND)};
#undef KIND
    struct error why = {0};
    struct grid cell;
    struct trend found;
    int status = grid_take(&cell, grid, &why);
    if (status == 0 && (unsigned)trend >= sizeof KINDS / sizeof *KINDS)
        status = error_set(&why, ERROR_INPUT, "there is no trend %d", (int)trend);
    if (status == 0)
        status = detrend(&cell, z, KINDS[trend], &found, &why);
    return error_give(status, &why, err);
}

int rugo_seam(const struct rugo_grid *grid, const double *z, double *seam, struct rugo_error *err) {
    struct error why = {0};
    struct grid cell;
    struct seam both;
    int status = grid_take(&cell, grid, &why);
    if (status == 0)
        status = seam_measure(&cell, z, &both, &why);
    if (status == 0)
        *seam = fmax(both.x, both.y);
    return error_give(status, &why, err);
}

/* Converts an open map; *cell becomes the grid that it points to. */
static int map_take(struct measured_map *out, struct grid *cell, const struct rugo_grid *grid,
                    const double *z, struct error *err) {
    *out = (struct measured_map){cell, z, BOUNDARY_OPEN};
    return grid_take(cell, grid, err);
}

int rugo_open_roughness(const struct rugo_grid *grid, const double *z, struct rugo_roughness *out,
                        struct rugo_error *err) {
    struct error why = {0};
    struct grid cell;
    struct measured_map map;
    struct roughness roughness;
    int status = map_take(&map, &cell, grid, z, &why);
    if (status != 0)
        return error_give(status, &why, err);
    open_roughness_measure(&map, &roughness);
    roughness_give(&roughness, out);
    return 0;
}

int rugo_open_moments(const struct rugo_grid *grid, const double *z, struct rugo_moments *out,
                      struct rugo_error *err) {
    struct error why = {0};
    struct grid cell;
    struct measured_map map;
    struct moments moments;
    int status = map_take(&map, &cell, grid, z, &why);
    if (status == 0)
        status = local_moments_measure(&map, &moments, &why);
    if (status == 0)
        moments_give(&moments, out);
    return error_give(status, &why, err);
}

int rugo_open_psd(const struct rugo_grid *grid, const double *z, double *wave_number,
                  double *density, struct rugo_error *err) {
    struct error why = {0};
    struct grid cell;
    struct measured_map map;
    int status = map_take(&map, &cell, grid, z, &why);
    if (status == 0)
        status = windowed_psd_measure(&map, wave_number, density, &why);
    return error_give(status, &why, err);
}

int rugo_open_summits_find(struct rugo_summits *out, double *searched, const struct rugo_grid *grid,
                           const double *z, enum rugo_summit_rule rule, struct rugo_error *err) {
    struct error why = {0};
    struct grid cell;
    struct measured_map map;
    struct summit_list list = {0};
    enum summit_stencil stencil = SUMMITS_NINE_POINT;
    double area;
    int status = map_take(&map, &cell, grid, z, &why);
    if (status == 0)
        status = stencil_take(&stencil, rule, &why);
    if (status == 0)
        status = open_summits_find(&map, stencil, &list, &area, &why);
    if (status == 0)
        status = summits_give(&list, out, &why);
    if (status == 0)
        *searched = area;
    summit_list_clear(&list);
    return error_give(status, &why, err);
}

static int areal_check(const struct measured_map *map, struct error *err) {
    if (grid_is_profile(map->grid))
        return error_set(err, ERROR_INPUT, "areal parameters of a profile; they are of surfaces");
    for (size_t point = 0; map->boundary == BOUNDARY_PERIODIC && point < grid_points(map->grid);
         point++)
        if (isnan(map->z[point]))
            return error_set(err, ERROR_INPUT, "a hole (NaN), point %zu, in a map that repeats",
                             point);
    return 0;
}

int rugo_areal(const struct rugo_grid *grid, const double *z, int open, struct rugo_areal *out,
               struct rugo_error *err) {
    struct error why = {0};
    struct grid cell;
    struct measured_map map;
    struct correlation *correlation = NULL;
    struct roughness roughness;
    struct areal a;
    int status = map_take(&map, &cell, grid, z, &why);
    map.boundary = open != 0 ? BOUNDARY_OPEN : BOUNDARY_PERIODIC;
    if (status == 0)
        status = areal_check(&map, &why);
    if (status == 0)
        status = correlation_create(&correlation, &map, &why);
    if (status == 0) {
        open_roughness_measure(&map, &roughness);
        status = areal_measure(&map, &roughness, correlation, NULL, &a, &why);
    }
    if (status == 0)
        *out = (struct rugo_areal){a.sa,  a.sq,  a.ssk, a.sku, a.sp,  a.sv, a.sz,
                                   a.sdq, a.sdr, a.sal, a.str, a.spd, a.spc};
    correlation_destroy(&correlation);
    return error_give(status, &why, err);
}
