#include "jobs/maps/map_parameters.h"
#include "core/statistics/summits/local_wave.h"
#include "core/statistics/summits/open_refined.h"
#include "core/statistics/summits/open_summits.h"
#include <math.h>
#include <stdlib.h>

#define NONE ((double)NAN)

/* searched: the area, or length, that they were found in. */
static void average(struct map_summits *out, double searched, const struct summit_list *list) {
    double n = (double)list->count, height = 0, variance = 0, curvature = 0;
    for (size_t a = 0; a < list->count; a++) {
        height += list->summits[a].height / n;
        curvature += list->summits[a].curvature / n;
    }
    for (size_t a = 0; a < list->count; a++)
        variance += pow(list->summits[a].height - height, 2) / n;
    double none = list->count > 0 ? 0 : NAN;
    *out = (struct map_summits){.sought = true,
                                .count = n,
                                .density = searched > 0 ? n / searched : (double)NAN,
                                .height_mean = height + none,
                                .height_deviation = sqrt(variance) + none,
                                .curvature_mean = curvature + none};
}

/* The errors of summits with so many points searched around each. */
static int add_errors(struct map_summits *out, size_t before, size_t after,
                      const struct measured_map *map, const struct map_chance *chance,
                      const struct summit_list *list, struct error *err) {
    double searched[LOW_CELLS_MOST];
    if (chance == NULL || !chance->told)
        return 0;
    int status = summit_cells_count(map, &chance->modes, before, after, searched, err);
    if (status != 0)
        return status;
    summit_errors_measure(list, out->density, map->grid, searched, chance->heights, &chance->modes,
                          &out->errors);
    out->has_errors = true;
    return 0;
}

static int find_periodic(const struct measured_map *map, enum summit_stencil stencil, size_t mode_x,
                         size_t mode_y, struct summit_list *list, double *searched,
                         struct error *err) {
    const struct grid *grid = map->grid;
    struct summit_finder *finder = NULL;
    int status = summit_finder_create(&finder, grid, stencil, CURVATURE_FINITE_DIFFERENCE, mode_x,
                                      mode_y, err);
    if (status == 0)
        status = summits_find(finder, map->z, list, err);
    summit_finder_destroy(&finder);
    *searched = grid_is_profile(grid) ? grid->lx : grid->lx * grid->ly;
    return status;
}

int map_summits_find(const struct measured_map *map, enum summit_stencil stencil, size_t mode_x,
                     size_t mode_y, struct summit_list *list, double *searched, struct error *err) {
    return map->boundary == BOUNDARY_OPEN
               ? open_summits_find(map, stencil, list, searched, err)
               : find_periodic(map, stencil, mode_x, mode_y, list, searched, err);
}

static int find_summits(struct map_parameters *out, const struct measured_map *map, size_t mode_x,
                        size_t mode_y, const struct map_chance *chance, enum map_extent extent,
                        struct error *err) {
    const bool open = map->boundary == BOUNDARY_OPEN;
    struct summit_list list = {0};
    int status = 0;
    for (enum summit_stencil s = SUMMITS_NINE_POINT; s <= SUMMITS_REFINED && status == 0; s++) {
        const bool refined = s == SUMMITS_REFINED;
        const size_t before = !open ? 0 : refined ? OPEN_REFINED_BEFORE : 1;
        const size_t after = !open ? 0 : refined ? OPEN_REFINED_AFTER : 1;
        double searched = 0;
        out->summits[s] = (struct map_summits){.sought = false};
        if (grid_is_profile(map->grid) && s == SUMMITS_FIVE_POINT)
            continue;
        if (extent == MAP_MAIN && s != SUMMITS_NINE_POINT) {
            out->summits[s] =
                (struct map_summits){true, NONE, NONE, NONE, NONE, NONE, .has_errors = false};
            continue;
        }
        status = map_summits_find(map, s, mode_x, mode_y, &list, &searched, err);
        if (status == 0) {
            average(&out->summits[s], searched, &list);
            status = add_errors(&out->summits[s], before, after, map, chance, &list, err);
        }
    }
    summit_list_clear(&list);
    return status;
}

static const struct moments NO_MOMENTS = {.m0 = NONE,
                                          .m2 = NONE,
                                          .m4 = NONE,
                                          .nayak_alpha = NONE,
                                          .rms_height = NONE,
                                          .rms_slope = NONE,
                                          .rms_curvature = NONE};

static int measure_share(struct map_parameters *out, const struct measured_map *map,
                         struct error *err) {
    const size_t points = grid_points(map->grid);
    unsigned char *whole = array_create(points, 1);
    if (whole == NULL)
        return error_memory(err, points, "marks of a map");
    const double all = (double)map_mark_whole(map, 1, 1, whole);
    const double inside = (double)map_mark_whole(map, LOCAL_HALF, LOCAL_HALF, whole);
    out->moments_share = inside / all;
    free(whole);
    return 0;
}

int map_parameters_measure(struct map_parameters *out, const struct measured_map *map,
                           size_t mode_x, size_t mode_y, const struct map_chance *chance,
                           enum map_extent extent, struct error *err) {
    const bool open = map->boundary == BOUNDARY_OPEN;
    out->grid = *map->grid;
    out->boundary = map->boundary;
    out->moments = NO_MOMENTS;
    int status = 0;
    if (extent == MAP_WHOLE)
        status = open ? local_moments_measure(map, &out->moments, err)
                      : roughness_spectral(map->grid, map->z, &out->moments, err);
    out->moments_share = 1;
    if (status == 0 && extent == MAP_WHOLE && open)
        status = measure_share(out, map, err);
    if (status != 0)
        return status;
    map_roughness_measure(map, &out->roughness);
    return find_summits(out, map, mode_x, mode_y, chance, extent, err);
}
