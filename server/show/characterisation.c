#include "server/show/characterisation.h"
#include "core/statistics/roughness.h"
#include "core/statistics/summits.h"
#include "schema/json/json.h"
#include <math.h>
#include <stdbool.h>

static bool put(cJSON *object, const char *key, cJSON *item) {
    if (object != NULL && item != NULL && cJSON_AddItemToObject(object, key, item))
        return true;
    cJSON_Delete(item);
    return false;
}

struct named_number {
    const char *name;
    double value;
};

static cJSON *object_of(size_t n, const struct named_number *entries) {
    cJSON *object = cJSON_CreateObject();
    for (size_t a = 0; a < n; a++) {
        if (!put(object, entries[a].name, json_number(entries[a].value))) {
            cJSON_Delete(object);
            return NULL;
        }
    }
    return object;
}

static cJSON *grid_object(const struct grid *grid) {
    const struct named_number entries[] = {{"nx", (double)grid->nx},
                                           {"ny", (double)grid->ny},
                                           {"dx", grid_dx(grid)},
                                           {"dy", grid_is_profile(grid) ? NAN : grid_dy(grid)}};
    return object_of(sizeof entries / sizeof *entries, entries);
}

static cJSON *heights_object(const struct roughness *roughness) {
    const struct named_number entries[] = {
        {"mean", roughness->mean},         {"rms", roughness->rms_height},
        {"skewness", roughness->skewness}, {"kurtosis", roughness->kurtosis},
        {"lowest", roughness->lowest},     {"highest", roughness->highest}};
    return object_of(sizeof entries / sizeof *entries, entries);
}

static cJSON *differences_object(const struct roughness *roughness) {
    const struct named_number entries[] = {{"rms_slope", roughness->rms_slope},
                                           {"rms_curvature", roughness->rms_curvature},
                                           {"m2", roughness->m2},
                                           {"m4", roughness->m4},
                                           {"nayak_alpha", roughness->nayak_alpha}};
    return object_of(sizeof entries / sizeof *entries, entries);
}

static cJSON *spectral_object(const struct moments *moments) {
    const struct named_number entries[] = {{"rms_slope", moments->rms_slope},
                                           {"rms_curvature", moments->rms_curvature},
                                           {"m0", moments->m0},
                                           {"m2", moments->m2},
                                           {"m4", moments->m4},
                                           {"nayak_alpha", moments->nayak_alpha}};
    return object_of(sizeof entries / sizeof *entries, entries);
}

static cJSON *summits_object(const struct grid *grid, const struct summit_list *list) {
    double n = (double)list->count, height = 0, variance = 0, curvature = 0;
    for (size_t a = 0; a < list->count; a++) {
        height += list->summits[a].height / n;
        curvature += list->summits[a].curvature / n;
    }
    for (size_t a = 0; a < list->count; a++)
        variance += pow(list->summits[a].height - height, 2) / n;
    double area = grid_is_profile(grid) ? grid->lx : grid->lx * grid->ly;
    double none = list->count > 0 ? 0 : NAN;
    const struct named_number entries[] = {{"count", n},
                                           {"density", n / area},
                                           {"height_mean", height + none},
                                           {"height_deviation", sqrt(variance) + none},
                                           {"curvature_mean", curvature + none}};
    return object_of(sizeof entries / sizeof *entries, entries);
}

static int put_summits(cJSON *out, const struct grid *grid, const double *z, size_t mode_x,
                       size_t mode_y, struct error *err) {
    static const char *const names[] = {"summits_nine_point", "summits_five_point",
                                        "summits_refined"};
    static const char *const profile_names[] = {"peaks", NULL, "peaks_refined"};
    struct summit_list list = {0};
    int status = 0;
    for (int stencil = SUMMITS_NINE_POINT; stencil <= SUMMITS_REFINED && status == 0; stencil++) {
        const char *name = grid_is_profile(grid) ? profile_names[stencil] : names[stencil];
        struct summit_finder *finder = NULL;
        if (name == NULL)
            continue;
        status = summit_finder_create(&finder, grid, (enum summit_stencil)stencil,
                                      CURVATURE_FINITE_DIFFERENCE, mode_x, mode_y, err);
        if (status == 0)
            status = summits_find(finder, z, &list, err);
        summit_finder_destroy(&finder);
        if (status == 0 && !put(out, name, summits_object(grid, &list)))
            status = error_memory(err, sizeof(cJSON), "a characterisation");
    }
    summit_list_clear(&list);
    return status;
}

int characterisation_create(cJSON **out, const struct grid *grid, const double *z, size_t mode_x,
                            size_t mode_y, struct error *err) {
    struct roughness roughness;
    struct moments moments;
    int status = roughness_spectral(grid, z, &moments, err);
    if (status != 0)
        return status;
    roughness_measure(grid, z, &roughness);
    cJSON *object = cJSON_CreateObject();
    if (!put(object, "grid", grid_object(grid)) ||
        !put(object, "heights", heights_object(&roughness)) ||
        !put(object, "finite_difference", differences_object(&roughness)) ||
        !put(object, "spectral", spectral_object(&moments)))
        status = error_memory(err, sizeof(cJSON), "a characterisation");
    if (status == 0)
        status = put_summits(object, grid, z, mode_x, mode_y, err);
    if (status != 0)
        cJSON_Delete(object);
    else
        *out = object;
    return status;
}

void characterisation_print(FILE *file, const cJSON *characterisation) {
    const cJSON *group, *value;
    cJSON_ArrayForEach(group, characterisation) {
        fprintf(file, "%s\n", group->string);
        cJSON_ArrayForEach(value, group) {
            if (cJSON_IsNumber(value))
                fprintf(file, "  %-18s %.10g\n", value->string, value->valuedouble);
            else
                fprintf(file, "  %-18s -\n", value->string);
        }
    }
}
