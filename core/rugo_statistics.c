/* Implements the statistics of rugo.h. */
#include "core/map/height_map.h"
#include "core/rugo_shared.h"
#include "core/statistics/heights/roughness.h"
#include "core/statistics/summits/summits.h"
#include <stdlib.h>

/* Takes the grid of a periodic map, which has no holes. */
static int map_take(struct grid *out, const struct rugo_grid *grid, const double *z,
                    struct error *err) {
    int status = grid_take(out, grid, err);
    return status == 0 ? heights_check_whole(out, z, err) : status;
}

int rugo_roughness(const struct rugo_grid *grid, const double *z, struct rugo_roughness *out,
                   struct rugo_error *err) {
    struct error why = {0};
    struct grid cell;
    struct roughness r;
    int status = map_take(&cell, grid, z, &why);
    if (status != 0)
        return error_give(status, &why, err);
    roughness_measure(&cell, z, &r);
    roughness_give(&r, out);
    return 0;
}

int rugo_moments(const struct rugo_grid *grid, const double *z, struct rugo_moments *out,
                 struct rugo_error *err) {
    struct error why = {0};
    struct grid cell;
    struct moments moments;
    int status = map_take(&cell, grid, z, &why);
    if (status == 0)
        status = roughness_spectral(&cell, z, &moments, &why);
    if (status == 0)
        moments_give(&moments, out);
    return error_give(status, &why, err);
}

size_t rugo_psd_size(const struct rugo_grid *grid) {
    struct grid cell;
    return grid_take(&cell, grid, NULL) == 0 ? radial_bins(&cell) : 0;
}

int rugo_psd(const struct rugo_grid *grid, const double *z, double *wave_number, double *density,
             struct rugo_error *err) {
    struct error why = {0};
    struct grid cell;
    int status = map_take(&cell, grid, z, &why);
    if (status == 0)
        status = psd_measure(&cell, z, wave_number, density, &why);
    return error_give(status, &why, err);
}

int rugo_summits_find(struct rugo_summits *out, const struct rugo_grid *grid, const double *z,
                      enum rugo_summit_rule rule, struct rugo_error *err) {
    struct error why = {0};
    struct grid cell;
    struct summit_finder *finder = NULL;
    struct summit_list list = {0};
    int status = map_take(&cell, grid, z, &why);
    enum summit_stencil stencil = SUMMITS_NINE_POINT;
    if (status == 0)
        status = stencil_take(&stencil, rule, &why);
    if (status == 0)
        status = summit_finder_create(&finder, &cell, stencil, CURVATURE_FINITE_DIFFERENCE,
                                      cell.nx / 2, cell.ny / 2, &why);
    if (status == 0)
        status = summits_find(finder, z, &list, &why);
    if (status == 0)
        status = summits_give(&list, out, &why);
    summit_list_clear(&list);
    summit_finder_destroy(&finder);
    return error_give(status, &why, err);
}

void rugo_summits_clear(struct rugo_summits *summits) {
    if (summits == NULL)
        return;
    free(summits->summits);
    *summits = (struct rugo_summits){.summits = NULL};
}
