#include "core/map/extend.h"
#include "core/error.h"
#include "core/map/map_law.h"
#include "core/map/membrane.h"
#include "core/statistics/heights/normal_scores.h"
#include "core/statistics/heights/roughness.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* A map is held to within this share of its RMS height where no noise is seen. */
static const double NOISE_LEAST = 1e-3;
/* Heights are Gaussian up to this skewness, and to a kurtosis so far from 3. */
static const double SKEWNESS_MOST = 0.5, KURTOSIS_MOST = 1;

/* Fills the powers of the waves of the cell. */
static int powers_create(double **out, const struct grid *cell, const struct map_law *law,
                         struct error *err) {
    const size_t modes = (cell->nx / 2 + 1) * cell->ny;
    const double x = 2 * M_PI / cell->lx, y = grid_is_profile(cell) ? 1 : 2 * M_PI / cell->ly;
    double *power = array_create(modes, sizeof *power);
    if (power == NULL)
        return error_memory(err, modes * sizeof *power, "the law of a map");
    map_law_fill(law, cell, map_law_whole_density, power);
    for (size_t m = 0; m < modes; m++)
        power[m] *= x * y;
    *out = power;
    return 0;
}

/* Draws on the cell. *out is the caller's to free. */
static int draw(double **out, const struct height_map *map, const struct conditional_law *law,
                double mean, uint64_t seed, struct conditional_report *report, struct error *err) {
    const struct grid *grid = &map->grid;
    const size_t points = grid_points(grid), cell_points = grid_points(law->cell);
    double *z = array_create(cell_points, sizeof *z), *held = array_create(points, sizeof *z);
    int status = z != NULL && held != NULL ? 0
                                           : error_memory(err, (cell_points + points) * sizeof *z,
                                                          "a map of twice the sides");
    if (status == 0) {
        for (size_t p = 0; p < points; p++)
            held[p] = map->z[p] - mean;
        status = conditional_draw(law, &(struct conditional_patch){grid->nx, grid->ny, held},
                                  (struct random_key){seed, 0, 0}, z, report, err);
    }
    free(held);
    if (status != 0) {
        free(z);
        return status;
    }
    for (size_t p = 0; p < cell_points; p++)
        z[p] += mean;
    *out = z;
    return 0;
}

/* --- heights that are not Gaussian --- */

static int rising(const void *a, const void *b) {
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* Returns the height of a score, between those of the map: straight, and beyond them as over the
 * outermost thousandth of them. */
static double height_of(const double *score, const double *height, size_t count, double at) {
    const size_t outermost = count / 1000 > 0 ? count / 1000 : 1;
    size_t low = 0, high = count - 1;
    if (at <= score[low])
        high = outermost;
    else if (at >= score[high])
        low = high - outermost;
    else
        while (high - low > 1) {
            const size_t middle = low + (high - low) / 2;
            *(score[middle] <= at ? &low : &high) = middle;
        }
    const size_t base = at <= score[0] ? low : high;
    const double slope = (height[high] - height[low]) / (score[high] - score[low]);
    return height[base] + slope * (at - score[base]);
}

/* Replaces the scores of a draw by heights, in the order that those of the map have. */
static int translate(double *z, size_t points, const struct height_map *map, const double *scores,
                     struct error *err) {
    const size_t most = grid_points(&map->grid);
    double *height = array_create(2 * most, sizeof *height), *score = NULL;
    size_t count = 0;
    if (height == NULL)
        return error_memory(err, 2 * most * sizeof *height, "heights of scores");
    score = height + most;
    for (size_t p = 0; p < most; p++)
        if (!isnan(map->z[p])) {
            height[count] = map->z[p];
            score[count++] = scores[p];
        }
    qsort(height, count, sizeof *height, rising);
    qsort(score, count, sizeof *score, rising);
    for (size_t p = 0; p < points; p++)
        z[p] = height_of(score, height, count, z[p]);
    free(height);
    return 0;
}

/* Returns the RMS difference of the map and its part of the cell. */
static double difference_of(const struct height_map *map, const double *z) {
    double total = 0;
    size_t count = 0;
    for (size_t j = 0; j < map->grid.ny; j++)
        for (size_t i = 0; i < map->grid.nx; i++) {
            const double less = map->z[j * map->grid.nx + i] - z[j * 2 * map->grid.nx + i];
            total += isnan(less) ? 0 : less * less;
            count += isnan(less) ? 0 : 1;
        }
    return sqrt(total / (double)count);
}

/* Fits the law to the map with its holes filled: what a spectrum leaves at the rims of holes looks
 * like noise. */
static int fit(struct map_law *out, const struct height_map *map, struct error *err) {
    const size_t points = grid_points(&map->grid);
    double *filled = array_create(points, sizeof *filled);
    if (filled == NULL)
        return error_memory(err, points * sizeof *filled, "the law of a map");
    memcpy(filled, map->z, points * sizeof *filled);
    const struct measured_map whole = {&map->grid, filled, BOUNDARY_OPEN};
    struct roughness roughness;
    int status = membrane_fill(&map->grid, filled, BOUNDARY_OPEN, err);
    if (status == 0)
        status = map_law_fit(out, &whole, err);
    if (status == 0 && !out->fit.fitted) {
        map_law_clear(out);
        status = error_set(err, ERROR_INPUT,
                           "no law fits the spectrum of the map: it has too few wavelengths that "
                           "can be trusted");
    }
    if (status == 0) {
        map_roughness_measure(&whole, &roughness);
        /* what governs nothing is held as part of the surface */
        if (!(spectrum_fit_noise_share(&out->fit, &map->grid, roughness.rms_curvature) >
              NOISE_SHARE_MOST))
            out->fit.noise = 0;
    }
    free(filled);
    return status;
}

/* Extends the map of heights, or of their scores, which have the same RMS. */
static int extend(double **out, const struct height_map *map, const struct roughness *roughness,
                  const struct grid *cell, uint64_t seed, struct extend_result *result,
                  struct error *err) {
    const struct grid *grid = &map->grid;
    const double x = 2 * M_PI / grid_dx(grid), y = 2 * M_PI / grid_dy(grid);
    struct map_law law;
    double *power = NULL;
    int status = fit(&law, map, err);
    if (status != 0)
        return status;
    status = powers_create(&power, cell, &law, err);
    map_law_clear(&law);
    if (status != 0)
        return status;
    const double seen = sqrt(law.fit.noise * (grid_is_profile(grid) ? x : x * y));
    const double least = NOISE_LEAST * roughness->rms_height;
    result->noise_seen = seen > least;
    result->noise = fmax(seen, least);
    result->law_holds = law.fit.deviance <= law.fit.deviance_limit;
    const struct conditional_law conditional = {cell, power, result->noise * result->noise};
    status = draw(out, map, &conditional, roughness->mean, seed, &result->draw, err);
    free(power);
    return status;
}

/* Does likewise by normal scores. */
static int extend_translated(double **out, const struct height_map *map,
                             const struct roughness *roughness, const struct grid *cell,
                             uint64_t seed, struct extend_result *result, struct error *err) {
    const struct measured_map measured = {&map->grid, map->z, BOUNDARY_OPEN};
    struct roughness of_scores = *roughness;
    struct height_map scores = *map;
    double *z = NULL;
    of_scores.mean = 0;
    scores.z = array_create(grid_points(&map->grid), sizeof *scores.z);
    if (scores.z == NULL)
        return error_memory(err, grid_points(&map->grid) * sizeof *scores.z, "normal scores");
    int status = normal_scores_fill(&measured, scores.z, err);
    if (status == 0)
        status = extend(&z, &scores, &of_scores, cell, seed, result, err);
    if (status == 0)
        status = translate(z, grid_points(cell), map, scores.z, err);
    if (status == 0) {
        result->draw.difference = difference_of(map, z);
        *out = z;
    } else
        free(z);
    free(scores.z);
    return status;
}

int map_extend(struct height_map *map, uint64_t seed, struct extend_result *out,
               struct error *err) {
    const struct grid *grid = &map->grid;
    const bool profile = grid_is_profile(grid);
    const struct grid cell = {2 * grid->nx, profile ? 1 : 2 * grid->ny, 2 * grid->lx,
                              profile ? grid->ly : 2 * grid->ly};
    const struct measured_map measured = {grid, map->z, BOUNDARY_OPEN};
    struct roughness roughness;
    double *z = NULL;
    *out = (struct extend_result){.noise = 0};
    if (grid_points(&cell) > (size_t)1 << 31)
        return error_set(err, ERROR_INPUT,
                         "a map of %zu by %zu points has one of twice its sides of more than the "
                         "2^31 points that a map may have",
                         grid->nx, grid->ny);
    map_roughness_measure(&measured, &roughness);
    if (!(roughness.rms_height > 0))
        return error_set(err, ERROR_INPUT, "the map has no heights that differ");
    out->translated =
        fabs(roughness.skewness) > SKEWNESS_MOST || fabs(roughness.kurtosis - 3) > KURTOSIS_MOST;
    int status =
        (out->translated ? extend_translated : extend)(&z, map, &roughness, &cell, seed, out, err);
    if (status != 0)
        return status;
    free(map->z);
    map->z = z;
    map->grid = cell;
    return 0;
}
