#include "server/show/characterisation.h"
#include "core/statistics/local_wave.h"
#include "core/statistics/open_refined.h"
#include "core/statistics/open_roughness.h"
#include "core/statistics/open_summits.h"
#include "core/statistics/scalar_errors.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

void characterisation_add(struct characterisation *out, const char *group, const char *name,
                          double value) {
    if (out->count < CHARACTERISTICS_MOST)
        out->list[out->count++] = (struct characteristic){group, name, value, 0, NULL};
}

void characterisation_add_length(struct characterisation *out, const char *group, const char *name,
                                 double value, int power) {
    if (out->count < CHARACTERISTICS_MOST)
        out->list[out->count++] = (struct characteristic){group, name, value, power, NULL};
}

void characterisation_add_text(struct characterisation *out, const char *group, const char *name,
                               const char *text) {
    if (out->count < CHARACTERISTICS_MOST)
        out->list[out->count++] = (struct characteristic){group, name, (double)NAN, 0, text};
}

double *characterisation_column(struct characterisation *out, const char *group, const char *name,
                                size_t count) {
    double *values = out->column_count < CHARACTERISTIC_COLUMNS_MOST
                         ? array_create(count > 0 ? count : 1, sizeof *values)
                         : NULL;
    if (values != NULL)
        out->columns[out->column_count++] =
            (struct characteristic_column){group, name, values, count, 0};
    return values;
}

double *characterisation_column_length(struct characterisation *out, const char *group,
                                       const char *name, size_t count, int power) {
    double *values = characterisation_column(out, group, name, count);
    if (values != NULL)
        out->columns[out->column_count - 1].power = power;
    return values;
}

void characterisation_clear(struct characterisation *characterisation) {
    for (size_t c = 0; c < characterisation->column_count; c++)
        free(characterisation->columns[c].values);
    *characterisation = (struct characterisation){0};
}

void characterisation_add_error(struct characterisation *out, const char *group, const char *name,
                                const char *error_name, double error) {
    size_t n = 0;
    while (n < out->count &&
           (strcmp(out->list[n].group, group) != 0 || strcmp(out->list[n].name, name) != 0))
        n++;
    if (n == out->count || out->count == CHARACTERISTICS_MOST)
        return;
    memmove(&out->list[n + 2], &out->list[n + 1], (out->count - n - 1) * sizeof *out->list);
    out->list[n + 1] = (struct characteristic){group, error_name, error, out->list[n].power, NULL};
    out->count++;
}

static const struct characteristic *find(const struct characterisation *characterisation,
                                         const char *group, const char *name) {
    for (size_t n = 0; n < characterisation->count; n++)
        if (strcmp(characterisation->list[n].group, group) == 0 &&
            strcmp(characterisation->list[n].name, name) == 0)
            return &characterisation->list[n];
    return NULL;
}

double characterisation_value(const struct characterisation *characterisation, const char *group,
                              const char *name) {
    const struct characteristic *found = find(characterisation, group, name);
    return found != NULL ? found->value : (double)NAN;
}

const char *characterisation_text(const struct characterisation *characterisation,
                                  const char *group, const char *name) {
    const struct characteristic *found = find(characterisation, group, name);
    return found != NULL ? found->text : NULL;
}

const struct characteristic_column *
characterisation_find_column(const struct characterisation *characterisation, const char *group,
                             const char *name) {
    for (size_t c = 0; c < characterisation->column_count; c++)
        if (strcmp(characterisation->columns[c].group, group) == 0 &&
            strcmp(characterisation->columns[c].name, name) == 0)
            return &characterisation->columns[c];
    return NULL;
}

static void add_grid(struct characterisation *out, const struct grid *grid) {
    static const char GROUP[] = "grid";
    characterisation_add(out, GROUP, "nx", (double)grid->nx);
    characterisation_add(out, GROUP, "ny", (double)grid->ny);
    characterisation_add_length(out, GROUP, "dx", grid_dx(grid), 1);
    characterisation_add_length(out, GROUP, "dy",
                                grid_is_profile(grid) ? (double)NAN : grid_dy(grid), 1);
}

static void add_heights(struct characterisation *out, const struct roughness *roughness) {
    static const char GROUP[] = "heights";
    characterisation_add_length(out, GROUP, "mean", roughness->mean, 1);
    characterisation_add_length(out, GROUP, "rms", roughness->rms_height, 1);
    characterisation_add(out, GROUP, "skewness", roughness->skewness);
    characterisation_add(out, GROUP, "kurtosis", roughness->kurtosis);
    characterisation_add_length(out, GROUP, "lowest", roughness->lowest, 1);
    characterisation_add_length(out, GROUP, "highest", roughness->highest, 1);
}

static void add_differences(struct characterisation *out, const struct roughness *roughness) {
    static const char GROUP[] = "finite_difference";
    characterisation_add(out, GROUP, "rms_slope", roughness->rms_slope);
    characterisation_add_length(out, GROUP, "rms_curvature", roughness->rms_curvature, -1);
    characterisation_add(out, GROUP, "m2", roughness->m2);
    characterisation_add_length(out, GROUP, "m4", roughness->m4, -2);
    characterisation_add(out, GROUP, "nayak_alpha", roughness->nayak_alpha);
}

static void add_moments(struct characterisation *out, const char *group,
                        const struct moments *moments) {
    characterisation_add(out, group, "rms_slope", moments->rms_slope);
    characterisation_add_length(out, group, "rms_curvature", moments->rms_curvature, -1);
    characterisation_add_length(out, group, "m0", moments->m0, 2);
    characterisation_add(out, group, "m2", moments->m2);
    characterisation_add_length(out, group, "m4", moments->m4, -2);
    characterisation_add(out, group, "nayak_alpha", moments->nayak_alpha);
}

/* searched: the area, or length, that they were found in; dimensions: 2 or 1. */
static void add_summits(struct characterisation *out, const char *group, double searched,
                        int dimensions, const struct summit_list *list) {
    double n = (double)list->count, height = 0, variance = 0, curvature = 0;
    for (size_t a = 0; a < list->count; a++) {
        height += list->summits[a].height / n;
        curvature += list->summits[a].curvature / n;
    }
    for (size_t a = 0; a < list->count; a++)
        variance += pow(list->summits[a].height - height, 2) / n;
    double none = list->count > 0 ? 0 : NAN;
    characterisation_add(out, group, "count", n);
    characterisation_add_length(out, group, "density", searched > 0 ? n / searched : (double)NAN,
                                -dimensions);
    characterisation_add_length(out, group, "height_mean", height + none, 1);
    characterisation_add_length(out, group, "height_deviation", sqrt(variance) + none, 1);
    characterisation_add_length(out, group, "curvature_mean", curvature + none, -1);
}

/* The errors of summits with so many points searched around each. */
static int add_summit_errors(struct characterisation *out, const char *group, size_t before,
                             size_t after, const struct measured_map *map,
                             const struct map_chance *chance, const struct summit_list *list,
                             struct error *err) {
    double searched[LOW_CELLS_MOST];
    struct summit_errors errors;
    if (chance == NULL || !chance->told)
        return 0;
    int status = summit_cells_count(map, &chance->modes, before, after, searched, err);
    if (status != 0)
        return status;
    summit_errors_measure(list, characterisation_value(out, group, "density"), map->grid, searched,
                          chance->heights, &chance->modes, &errors);
    characterisation_add_error(out, group, "density", "density_error", errors.density);
    characterisation_add_error(out, group, "height_mean", "height_mean_error", errors.height_mean);
    characterisation_add_error(out, group, "height_deviation", "height_deviation_error",
                               errors.height_deviation);
    characterisation_add_error(out, group, "curvature_mean", "curvature_mean_error",
                               errors.curvature_mean);
    return 0;
}

/* Returns the group of a stencil's summits; NULL: profiles have none. */
static const char *summits_name(const struct grid *grid, int stencil) {
    static const char *const NAMES[] = {"summits_nine_point", "summits_five_point",
                                        "summits_refined"};
    static const char *const PROFILE_NAMES[] = {"peaks", NULL, "peaks_refined"};
    return grid_is_profile(grid) ? PROFILE_NAMES[stencil] : NAMES[stencil];
}

static int find_summits(struct characterisation *out, const struct grid *grid, const double *z,
                        size_t mode_x, size_t mode_y, const struct map_chance *chance,
                        struct error *err) {
    const struct measured_map map = {grid, z, BOUNDARY_PERIODIC};
    const int dimensions = grid_is_profile(grid) ? 1 : 2;
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
        if (status == 0) {
            add_summits(out, group, area, dimensions, &list);
            status = add_summit_errors(out, group, 0, 0, &map, chance, &list, err);
        }
    }
    summit_list_clear(&list);
    return status;
}

int characterise_heights(struct characterisation *out, const struct grid *grid, const double *z,
                         size_t mode_x, size_t mode_y, const struct map_chance *chance,
                         struct error *err) {
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
    return find_summits(out, grid, z, mode_x, mode_y, chance, err);
}

static int find_open_summits(struct characterisation *out, const struct measured_map *map,
                             const struct map_chance *chance, struct error *err) {
    const int dimensions = grid_is_profile(map->grid) ? 1 : 2;
    struct summit_list list = {0};
    int status = 0;
    for (int stencil = SUMMITS_NINE_POINT; stencil <= SUMMITS_REFINED && status == 0; stencil++) {
        const char *group = summits_name(map->grid, stencil);
        double searched = 0;
        if (group == NULL)
            continue;
        status = open_summits_find(map, (enum summit_stencil)stencil, &list, &searched, err);
        if (status == 0) {
            bool refined = stencil == SUMMITS_REFINED;
            add_summits(out, group, searched, dimensions, &list);
            status = add_summit_errors(out, group, refined ? OPEN_REFINED_BEFORE : 1,
                                       refined ? OPEN_REFINED_AFTER : 1, map, chance, &list, err);
        }
    }
    summit_list_clear(&list);
    return status;
}

int characterise_open(struct characterisation *out, const struct measured_map *map,
                      const struct map_chance *chance, struct error *err) {
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
    return find_open_summits(out, map, chance, err);
}
