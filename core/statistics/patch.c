#include "core/statistics/patch.h"
#include "core/statistics/heights/roughness.h"
#include "core/statistics/spectra/correlation.h"
#include "core/statistics/summits/open_summits.h"
#include <math.h>
#include <stdlib.h>

static const double CORRELATION_LEVEL = 0.2; /* as of Sal in ISO 25178-2 */

#define PATCH_NAME(quantity, name, power) name,
const char *const PATCH_NAMES[PATCH_QUANTITY_COUNT] = {PATCH_QUANTITIES(PATCH_NAME)};
#define PATCH_POWER(quantity, name, power) power,
static const signed char POWERS[PATCH_QUANTITY_COUNT] = {PATCH_QUANTITIES(PATCH_POWER)};

int patch_power(enum patch_quantity quantity, bool profile) {
    return profile && POWERS[quantity] == PATCH_AREAL ? PATCH_AREAL + 1 : POWERS[quantity];
}

static double measure_roughness(const struct measured_map *map, double *out) {
    struct roughness roughness;
    open_roughness_measure(map, &roughness);
    out[PATCH_RMS_HEIGHT] = roughness.rms_height;
    out[PATCH_RMS_SLOPE] = roughness.rms_slope;
    out[PATCH_RMS_CURVATURE] = roughness.rms_curvature;
    out[PATCH_SKEWNESS] = roughness.skewness;
    out[PATCH_KURTOSIS] = roughness.kurtosis;
    out[PATCH_LOWEST] = roughness.lowest - roughness.mean;
    out[PATCH_HIGHEST] = roughness.highest - roughness.mean;
    out[PATCH_NAYAK_ALPHA] = roughness.nayak_alpha;
    return roughness.mean;
}

static int measure_correlation(const struct measured_map *map, double *out, struct error *err) {
    struct correlation *correlation = NULL;
    double shortest, longest;
    int status = correlation_create(&correlation, map, err);
    if (status != 0)
        return status;
    correlation_lengths(correlation, CORRELATION_LEVEL, &shortest, &longest);
    out[PATCH_CORRELATION_LENGTH] = shortest;
    out[PATCH_TEXTURE] = grid_is_profile(map->grid) ? (double)NAN : shortest / longest;
    correlation_destroy(&correlation);
    return 0;
}

/* Fills density, mean, deviation and curvature of the summits; mean: of the heights. */
static int measure_summits(const struct measured_map *map, double mean, struct summit_list *list,
                           double *out, struct error *err) {
    struct average height = {0}, square = {0}, curvature = {0};
    double searched = 0;
    int status = open_summits_find(map, SUMMITS_NINE_POINT, list, &searched, err);
    if (status != 0)
        return status;
    for (size_t a = 0; a < list->count; a++) {
        average_add(&height, list->summits[a].height - mean);
        average_add(&curvature, list->summits[a].curvature);
    }
    double middle = average_value(&height);
    for (size_t a = 0; a < list->count; a++)
        average_add(&square, pow(list->summits[a].height - mean - middle, 2));
    out[0] = searched > 0 ? (double)list->count / searched : (double)NAN;
    out[1] = middle;
    out[2] = sqrt(average_value(&square));
    out[3] = average_value(&curvature);
    return 0;
}

/* Pits are the summits of the map upside down. */
static int measure_pits(const struct measured_map *map, double mean, struct summit_list *list,
                        double *out, struct error *err) {
    size_t points = grid_points(map->grid);
    double *z = array_create(points, sizeof *z);
    if (z == NULL)
        return error_memory(err, points * sizeof *z, "a map upside down");
    for (size_t i = 0; i < points; i++)
        z[i] = -map->z[i];
    const struct measured_map upside_down = {map->grid, z, map->boundary};
    int status = measure_summits(&upside_down, -mean, list, out, err);
    free(z);
    return status;
}

int patch_measure(const struct measured_map *map, double out[PATCH_QUANTITY_COUNT],
                  struct error *err) {
    struct summit_list list = {0};
    double mean = measure_roughness(map, out);
    int status = measure_correlation(map, out, err);
    if (status == 0)
        status = measure_summits(map, mean, &list, out + PATCH_SUMMIT_DENSITY, err);
    if (status == 0)
        status = measure_pits(map, mean, &list, out + PATCH_PIT_DENSITY, err);
    summit_list_clear(&list);
    return status;
}
