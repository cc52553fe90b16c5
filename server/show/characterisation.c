#include "server/show/characterisation.h"
#include "core/statistics/local_wave.h"
#include "core/statistics/open_roughness.h"
#include "core/statistics/open_summits.h"
#include <math.h>
#include <stdlib.h>

void characterisation_add(struct characterisation *out, const char *group, const char *name,
                          double value) {
    if (out->count < CHARACTERISTICS_MOST)
        out->list[out->count++] = (struct characteristic){group, name, value, NULL};
}

void characterisation_add_text(struct characterisation *out, const char *group, const char *name,
                               const char *text) {
    if (out->count < CHARACTERISTICS_MOST)
        out->list[out->count++] = (struct characteristic){group, name, (double)NAN, text};
}

double *characterisation_column(struct characterisation *out, const char *group, const char *name,
                                size_t count) {
    double *values = out->column_count < CHARACTERISTIC_COLUMNS_MOST
                         ? array_create(count > 0 ? count : 1, sizeof *values)
                         : NULL;
    if (values != NULL)
        out->columns[out->column_count++] =
            (struct characteristic_column){group, name, values, count};
    return values;
}

void characterisation_clear(struct characterisation *characterisation) {
    for (size_t c = 0; c < characterisation->column_count; c++)
        free(characterisation->columns[c].values);
    *characterisation = (struct characterisation){0};
}

static void add_grid(struct characterisation *out, const struct grid *grid) {
    static const char GROUP[] = "grid";
    characterisation_add(out, GROUP, "nx", (double)grid->nx);
    characterisation_add(out, GROUP, "ny", (double)grid->ny);
    characterisation_add(out, GROUP, "dx", grid_dx(grid));
    characterisation_add(out, GROUP, "dy", grid_is_profile(grid) ? (double)NAN : grid_dy(grid));
}

static void add_heights(struct characterisation *out, const struct roughness *roughness) {
    static const char GROUP[] = "heights";
    characterisation_add(out, GROUP, "mean", roughness->mean);
    characterisation_add(out, GROUP, "rms", roughness->rms_height);
    characterisation_add(out, GROUP, "skewness", roughness->skewness);
    characterisation_add(out, GROUP, "kurtosis", roughness->kurtosis);
    characterisation_add(out, GROUP, "lowest", roughness->lowest);
    characterisation_add(out, GROUP, "highest", roughness->highest);
}

static void add_differences(struct characterisation *out, const struct roughness *roughness) {
    static const char GROUP[] = "finite_difference";
    characterisation_add(out, GROUP, "rms_slope", roughness->rms_slope);
    characterisation_add(out, GROUP, "rms_curvature", roughness->rms_curvature);
    characterisation_add(out, GROUP, "m2", roughness->m2);
    characterisation_add(out, GROUP, "m4", roughness->m4);
    characterisation_add(out, GROUP, "nayak_alpha", roughness->nayak_alpha);
}

static void add_moments(struct characterisation *out, const char *group,
                        const struct moments *moments) {
    characterisation_add(out, group, "rms_slope", moments->rms_slope);
    characterisation_add(out, group, "rms_curvature", moments->rms_curvature);
    characterisation_add(out, group, "m0", moments->m0);
    characterisation_add(out, group, "m2", moments->m2);
    characterisation_add(out, group, "m4", moments->m4);
    characterisation_add(out, group, "nayak_alpha", moments->nayak_alpha);
}

/* searched: the area, or length, that they were found in. */
static void add_summits(struct characterisation *out, const char *group, double searched,
                        const struct summit_list *list) {
    double n = (double)list->count, height = 0, variance = 0, curvature = 0;
    for (size_t a = 0; a < list->count; a++) {
        height += list->summits[a].height / n;
        curvature += list->summits[a].curvature / n;
    }
    for (size_t a = 0; a < list->count; a++)
        variance += pow(list->summits[a].height - height, 2) / n;
    double none = list->count > 0 ? 0 : NAN;
    characterisation_add(out, group, "count", n);
    characterisation_add(out, group, "density", searched > 0 ? n / searched : (double)NAN);
    characterisation_add(out, group, "height_mean", height + none);
    characterisation_add(out, group, "height_deviation", sqrt(variance) + none);
    characterisation_add(out, group, "curvature_mean", curvature + none);
}

/* Returns the group of a stencil's summits; NULL: profiles have none. */
static const char *summits_name(const struct grid *grid, int stencil) {
    static const char *const NAMES[] = {"summits_nine_point", "summits_five_point",
                                        "summits_refined"};
    static const char *const PROFILE_NAMES[] = {"peaks", NULL, "peaks_refined"};
    return grid_is_profile(grid) ? PROFILE_NAMES[stencil] : NAMES[stencil];
}

static int find_summits(struct characterisation *out, const struct grid *grid, const double *z,
                        size_t mode_x, size_t mode_y, struct error *err) {
    double area = grid_is_profile(grid) ? grid->lx : grid->lx * grid->ly;
    struct summit_list list = {0};
    int status = 0;
    for (int stencil = SUMMITS_NINE_POINT; stencil <= SUMMITS_REFINED && status == 0; stencil++) {
        const char *group = summits_name(grid, stencil);
        struct summit_finder *finder = NULL;
        if (group == NULL)
            continue;
        status = summit_finder_create(&finder, grid, (enum summit_stencil)stencil,
                                      CURVATURE_FINITE_DIFFERENCE, mode_x, mode_y, err);
        if (status == 0)
            status = summits_find(finder, z, &list, err);
        summit_finder_destroy(&finder);
        if (status == 0)
            add_summits(out, group, area, &list);
    }
    summit_list_clear(&list);
    return status;
}

int characterise_heights(struct characterisation *out, const struct grid *grid, const double *z,
                         size_t mode_x, size_t mode_y, struct error *err) {
    struct roughness roughness;
    struct moments moments;
    int status = roughness_spectral(grid, z, &moments, err);
    if (status != 0)
        return status;
    roughness_measure(grid, z, &roughness);
    add_grid(out, grid);
    add_heights(out, &roughness);
    add_differences(out, &roughness);
    add_moments(out, "spectral", &moments);
    return find_summits(out, grid, z, mode_x, mode_y, err);
}

static int find_open_summits(struct characterisation *out, const struct measured_map *map,
                             struct error *err) {
    struct summit_list list = {0};
    int status = 0;
    for (int stencil = SUMMITS_NINE_POINT; stencil <= SUMMITS_REFINED && status == 0; stencil++) {
        const char *group = summits_name(map->grid, stencil);
        double searched = 0;
        if (group == NULL)
            continue;
        status = open_summits_find(map, (enum summit_stencil)stencil, &list, &searched, err);
        if (status == 0)
            add_summits(out, group, searched, &list);
    }
    summit_list_clear(&list);
    return status;
}

int characterise_open(struct characterisation *out, const struct measured_map *map,
                      struct error *err) {
    struct roughness roughness;
    struct moments moments;
    int status = local_moments_measure(map, &moments, err);
    if (status != 0)
        return status;
    open_roughness_measure(map, &roughness);
    add_grid(out, map->grid);
    add_heights(out, &roughness);
    add_differences(out, &roughness);
    add_moments(out, "interpolated", &moments);
    return find_open_summits(out, map, err);
}
