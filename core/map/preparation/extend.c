#include "core/map/preparation/extend.h"
#include "core/error.h"
#include "core/map/map_law.h"
#include "core/map/preparation/membrane.h"
#include "core/statistics/grooves/groove_extension.h"
#include "core/statistics/heights/normal_scores.h"
#include "core/statistics/heights/roughness.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* A map is held to within this share of its RMS height where no noise is seen. */
static const double NOISE_LEAST = 1e-3;
/* Heights are Gaussian up to this skewness, and to a kurtosis so far from 3. */
static const double SKEWNESS_MOST = 0.5, KURTOSIS_MOST = 1;
/* Surfaces of which one is to have a sub-map with a law. */
enum { TRIALS = 4, TRIAL_BIT = 40 };

/* The heights of scores: pairs, both rising. Empty where heights are Gaussian. */
struct scores {
    size_t count;
    double *score, *height; /* one block, owned by height */
};

/* A law on the cell. */
struct cell_law {
    double *power; /* owned, a value a wave */
    double noise;  /* RMS height to within which a map of it is held */
    bool noise_seen, holds;
    struct scores scores;
};

struct extension {
    const struct height_map *map; /* borrowed, or `rest` */
    struct map_grooves grooves;
    struct height_map
        rest; /* without grooves, with heights of its own; no heights: there are none */
    enum detrend trend;
    struct grid cell;
    struct roughness roughness;
    bool translated;
    struct cell_law law, drawn; /* of the map; of the last sub-map */
    double *held;               /* owned, as the next: heights or scores of the patch */
    double *cell_z;             /* of a surface that sub-maps are cut from */
};

static void law_clear(struct cell_law *law) {
    free(law->power);
    free(law->scores.height);
    *law = (struct cell_law){0};
}

/* --- the law of a map --- */

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

/* Fits the law to the map with its holes filled: what a spectrum leaves at the rims of holes looks
 * like noise. */
static int fit(struct map_law *out, const struct grid *grid, const double *z, struct error *err) {
    const size_t points = grid_points(grid);
    double *filled = array_create(points, sizeof *filled);
    if (filled == NULL)
        return error_memory(err, points * sizeof *filled, "the law of a map");
    memcpy(filled, z, points * sizeof *filled);
    const struct measured_map whole = {grid, filled, BOUNDARY_OPEN};
    struct roughness roughness;
    int status = membrane_fill(grid, filled, BOUNDARY_OPEN, err);
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
        if (!(spectrum_fit_noise_share(&out->fit, grid, roughness.rms_curvature) >
              NOISE_SHARE_MOST))
            out->fit.noise = 0;
    }
    free(filled);
    return status;
}

/* Fills the law of heights, or of their scores, which have the same RMS. */
static int law_of(struct cell_law *out, const struct extension *e, const double *z,
                  struct error *err) {
    const struct grid *grid = &e->map->grid;
    const double x = 2 * M_PI / grid_dx(grid), y = 2 * M_PI / grid_dy(grid);
    struct map_law law;
    int status = fit(&law, grid, z, err);
    if (status != 0)
        return status;
    status = powers_create(&out->power, &e->cell, &law, err);
    map_law_clear(&law);
    if (status != 0)
        return status;
    const double seen = sqrt(law.fit.noise * (grid_is_profile(grid) ? x : x * y));
    const double least = NOISE_LEAST * e->roughness.rms_height;
    out->noise_seen = seen > least;
    out->noise = fmax(seen, least);
    out->holds = law.fit.deviance <= law.fit.deviance_limit;
    return 0;
}

/* --- heights that are not Gaussian --- */

static int rising(const void *a, const void *b) {
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* Returns what belongs to `at` by pairs that rise: straight between them, and beyond them as over
 * the outermost thousandth. */
static double paired(const double *from, const double *to, size_t count, double at) {
    const size_t outermost = count / 1000 > 0 ? count / 1000 : 1;
    size_t low = 0, high = count - 1;
    if (at <= from[low])
        high = outermost;
    else if (at >= from[high])
        low = high - outermost;
    else
        while (high - low > 1) {
            const size_t middle = low + (high - low) / 2;
            *(from[middle] <= at ? &low : &high) = middle;
        }
    const size_t base = at <= from[0] ? low : high;
    const double run = from[high] - from[low];
    return to[base] + (run > 0 ? (to[high] - to[low]) / run * (at - from[base]) : 0);
}

static double height_of(const struct scores *scores, double score) {
    return paired(scores->score, scores->height, scores->count, score);
}

static double score_of(const struct scores *scores, double height) {
    return paired(scores->height, scores->score, scores->count, height);
}

/* Fills the scores of heights and the pairs of both; out may be z. */
static int scores_make(struct scores *pairs, const struct grid *grid, const double *z, double *out,
                       struct error *err) {
    const struct measured_map measured = {grid, z, BOUNDARY_OPEN};
    const size_t most = grid_points(grid);
    pairs->height = array_create(2 * most, sizeof *pairs->height);
    if (pairs->height == NULL)
        return error_memory(err, 2 * most * sizeof *pairs->height, "heights of scores");
    pairs->score = pairs->height + most;
    for (size_t p = 0; p < most; p++)
        if (!isnan(z[p]))
            pairs->height[pairs->count++] = z[p];
    int status = normal_scores_fill(&measured, out, err);
    for (size_t p = 0, count = 0; p < most && status == 0; p++)
        if (!isnan(out[p]))
            pairs->score[count++] = out[p];
    qsort(pairs->height, pairs->count, sizeof *pairs->height, rising);
    qsort(pairs->score, pairs->count, sizeof *pairs->score, rising);
    return status;
}

/* --- a law that is drawn --- */

/* Fills heights of a sub-map of a surface of the map's law, as the map was measured: about 0,
 * without its trend, with its noise and holes. */
static int submap(struct extension *e, struct random_key key, double *z, struct error *err) {
    const struct grid *grid = &e->map->grid;
    const size_t points = grid_points(grid);
    const struct conditional_law law = {&e->cell, e->law.power, e->law.noise * e->law.noise};
    struct trend trend;
    int status = conditional_free_draw(&law, key, e->cell_z, err);
    if (status != 0)
        return status;
    if (e->law.noise_seen)
        conditional_noise(key, points, z);
    for (size_t p = 0; p < points; p++) {
        const double noise = e->law.noise_seen ? e->law.noise * z[p] : 0;
        const double height = e->cell_z[p / grid->nx * e->cell.nx + p % grid->nx] + noise;
        const double measured = e->translated ? height_of(&e->law.scores, height) : height;
        z[p] = isnan(e->map->z[p]) ? (double)NAN : measured;
    }
    return detrend(grid, z, e->trend > DETREND_NONE ? e->trend : DETREND_MEAN, &trend, err);
}

/* A draw of the law errs from that of the map as this one does from the surface's, so that the
 * surface's may be as far on the other side: the power of a wave is the square of the map's over
 * that of the sub-map. Where one of both has no such wave but leakage, as behind a sharp end, it is
 * that of the sub-map. */
static void reflect(const struct extension *e, double *power) {
    static const double LEAKAGE = 16, FACTOR_MOST = 4;
    for (size_t m = 0; m < (e->cell.nx / 2 + 1) * e->cell.ny; m++) {
        const double ratio = e->law.power[m] / power[m];
        if (ratio < LEAKAGE && ratio > 1 / LEAKAGE)
            power[m] = e->law.power[m] * fmin(fmax(ratio, 1 / FACTOR_MOST), FACTOR_MOST);
    }
}

/* Draws law and heights; the sub-map of a surface may have no law, or not show the noise. */
static int law_draw(struct extension *e, struct random_key key, struct error *err) {
    int status = ERROR_INPUT;
    bool alike = false;
    key.sequence ^= UINT64_C(1) << SUBMAP_BIT;
    for (uint64_t trial = 0; trial < TRIALS && !alike; trial++) {
        struct error reason = {0};
        law_clear(&e->drawn);
        status = submap(e, key, e->held, &reason);
        if (status == 0 && e->translated)
            status = scores_make(&e->drawn.scores, &e->map->grid, e->held, e->held, &reason);
        if (status == 0)
            status = law_of(&e->drawn, e, e->held, &reason);
        if (status != 0 && status != ERROR_INPUT && status != ERROR_NUMERIC)
            return error_set(err, status, "%s", reason.text);
        alike = status == 0 && e->drawn.noise_seen == e->law.noise_seen;
        key.sequence += UINT64_C(1) << TRIAL_BIT;
    }
    if (alike)
        reflect(e, e->drawn.power);
    else
        law_clear(&e->drawn);
    return 0;
}

/* --- a draw --- */

/* Fills the patch's heights about its mean, or their scores; scaled: scores have the RMS height of
 * the map. *plane, a value a point: added to the heights; NULL: nothing. */
static void held_fill(struct extension *e, const struct scores *scores, const double *plane) {
    const size_t points = grid_points(&e->map->grid);
    for (size_t p = 0; p < points; p++) {
        const double height = e->map->z[p] - e->roughness.mean + (plane != NULL ? plane[p] : 0);
        e->held[p] = e->translated && !isnan(height) ? score_of(scores, height) : height;
    }
}

static int condition(struct extension *e, const struct cell_law *law, int trend,
                     struct random_key key, double *z, struct extend_result *out,
                     struct error *err) {
    const struct grid *grid = &e->map->grid;
    const struct conditional_law conditional = {&e->cell, law->power, law->noise * law->noise};
    const struct conditional_patch patch = {grid->nx, grid->ny, e->held, trend};
    return conditional_draw(&conditional, &patch, key, z, &out->draw, err);
}

/* Replaces the held scores by those of the heights with the trend that a draw gave them: the
 * draw's trend in scores, times the mean slope of heights over scores. */
static int hold_trend(struct extension *e, const struct scores *scores, const double *z,
                      struct error *err) {
    const struct grid *grid = &e->map->grid;
    const size_t points = grid_points(grid);
    double products = 0, squares = 0;
    double *plane = array_create(points, sizeof *plane), *rest = NULL;
    struct trend trend;
    int status = plane != NULL ? 0 : error_memory(err, points * sizeof *plane, "a trend");
    for (size_t a = 0; a < scores->count; a++) {
        products += scores->score[a] * scores->height[a];
        squares += scores->score[a] * scores->score[a];
    }
    rest = status == 0 ? array_create(points, sizeof *rest) : NULL;
    if (status == 0 && rest == NULL)
        status = error_memory(err, points * sizeof *rest, "a trend");
    for (size_t p = 0; p < points && status == 0; p++)
        plane[p] = rest[p] = z[p / grid->nx * e->cell.nx + p % grid->nx] - e->held[p];
    if (status == 0)
        status = detrend(grid, rest, e->trend, &trend, err);
    for (size_t p = 0; p < points && status == 0; p++)
        plane[p] = isnan(rest[p]) ? 0 : (plane[p] - rest[p]) * products / squares;
    if (status == 0)
        held_fill(e, scores, plane);
    free(plane);
    free(rest);
    return status;
}

/* Returns the RMS difference of the map and its part of the cell, but for a trend. */
static int difference_of(const struct extension *e, const double *z, double *held, double *out,
                         struct error *err) {
    const struct grid *grid = &e->map->grid;
    const size_t points = grid_points(grid);
    double total = 0, count = 0;
    struct trend trend;
    for (size_t p = 0; p < points; p++)
        held[p] = e->map->z[p] - e->roughness.mean - z[p / grid->nx * e->cell.nx + p % grid->nx];
    int status = e->trend > DETREND_NONE ? detrend(grid, held, e->trend, &trend, err) : 0;
    for (size_t p = 0; p < points; p++) {
        total += isnan(held[p]) ? 0 : held[p] * held[p];
        count += isnan(held[p]) ? 0 : 1;
    }
    *out = sqrt(total / count);
    return status;
}

int extension_draw(struct extension *e, struct random_key key, double *z, struct extend_result *out,
                   struct error *err) {
    const size_t points = grid_points(&e->cell);
    int status = law_draw(e, key, err);
    if (status != 0)
        return status;
    const bool drawn = e->drawn.power != NULL;
    const struct cell_law *law = drawn ? &e->drawn : &e->law;
    *out = (struct extend_result){.noise = law->noise,
                                  .noise_seen = e->law.noise_seen,
                                  .law_holds = e->law.holds,
                                  .translated = e->translated,
                                  .drawn = drawn};
    held_fill(e, &law->scores, NULL);
    status = condition(e, law, (int)e->trend, key, z, out, err);
    if (status == 0 && e->translated && e->trend > DETREND_NONE) {
        status = hold_trend(e, &law->scores, z, err);
        if (status == 0)
            status = condition(e, law, 0, key, z, out, err);
    }
    if (status == 0 && e->translated) {
        for (size_t p = 0; p < points; p++)
            z[p] = height_of(&law->scores, z[p]);
        status = difference_of(e, z, e->held, &out->draw.difference, err);
    }
    for (size_t p = 0; p < points && status == 0; p++)
        z[p] += e->roughness.mean;
    out->grooves = e->grooves;
    return status == 0 ? groove_extension_add(&e->grooves, &e->map->grid, &e->cell, 1, z, err)
                       : status;
}

/* --- together --- */

void extension_destroy(struct extension **extension) {
    struct extension *gone = *extension;
    if (gone == NULL)
        return;
    law_clear(&gone->law);
    law_clear(&gone->drawn);
    free(gone->held);
    free(gone->cell_z);
    free(gone->rest.z);
    free(gone);
    *extension = NULL;
}

const struct grid *extension_cell(const struct extension *extension) {
    return &extension->cell;
}

int extension_grooves(struct map_grooves *out, const struct height_map *map, struct error *err) {
    const size_t points = grid_points(&map->grid);
    double *filled = array_create(points, sizeof *filled);
    if (filled == NULL)
        return error_memory(err, points * sizeof *filled, "a map without holes");
    memcpy(filled, map->z, points * sizeof *filled);
    const struct measured_map whole = {&map->grid, filled, BOUNDARY_OPEN};
    int status = membrane_fill(&map->grid, filled, BOUNDARY_OPEN, err);
    if (status == 0)
        status = map_grooves_find(out, &whole, err);
    free(filled);
    return status;
}

/* Takes the grooves out of the map, to go on by themselves: no law of a random face has them. */
static int take_grooves(struct extension *e, struct error *err) {
    const struct grid *grid = &e->map->grid;
    int status = extension_grooves(&e->grooves, e->map, err);
    if (status != 0 || e->grooves.families == 0)
        return status;
    e->rest = (struct height_map){.grid = *grid};
    status = map_grooves_rest(&e->rest.z, &e->grooves, grid, e->map->z, err);
    if (status == 0)
        e->map = &e->rest;
    return status;
}

static int check(const struct extension *e, struct error *err) {
    const struct grid *grid = &e->map->grid;
    if (grid_points(&e->cell) > (size_t)1 << 31)
        return error_set(err, ERROR_INPUT,
                         "a map of %zu by %zu points has one of twice its sides of more than the "
                         "2^31 points that a map may have",
                         grid->nx, grid->ny);
    return e->roughness.rms_height > 0
               ? 0
               : error_set(err, ERROR_INPUT, "the map has no heights that differ");
}

static int extension_fill(struct extension *e, struct error *err) {
    const struct grid *grid = &e->map->grid;
    const size_t points = grid_points(grid);
    int status = check(e, err);
    if (status != 0)
        return status;
    e->held = array_create(points, sizeof *e->held);
    e->cell_z = array_create(grid_points(&e->cell), sizeof *e->cell_z);
    if (e->held == NULL || e->cell_z == NULL)
        return error_memory(err, 5 * points * sizeof *e->held, "a map of twice the sides");
    for (size_t p = 0; p < points; p++)
        e->held[p] = e->map->z[p] - e->roughness.mean;
    if (e->translated)
        status = scores_make(&e->law.scores, grid, e->held, e->held, err);
    return status == 0 ? law_of(&e->law, e, e->held, err) : status;
}

int extension_create(struct extension **out, const struct height_map *map, enum detrend trend,
                     struct error *err) {
    const struct grid *grid = &map->grid;
    const bool profile = grid_is_profile(grid);
    struct extension *e = array_create(1, sizeof *e);
    *out = NULL;
    if (e == NULL)
        return error_memory(err, sizeof *e, "a map of twice the sides");
    e->map = map;
    e->trend = trend;
    e->cell = (struct grid){2 * grid->nx, profile ? 1 : 2 * grid->ny, 2 * grid->lx,
                            profile ? grid->ly : 2 * grid->ly};
    int status = take_grooves(e, err);
    const struct measured_map measured = {grid, e->map->z, BOUNDARY_OPEN};
    map_roughness_measure(&measured, &e->roughness);
    e->translated = fabs(e->roughness.skewness) > SKEWNESS_MOST ||
                    fabs(e->roughness.kurtosis - 3) > KURTOSIS_MOST;
    if (status == 0)
        status = extension_fill(e, err);
    if (status != 0)
        extension_destroy(&e);
    *out = e;
    return status;
}

double extension_bytes(const struct grid *map) {
    /* equations of about five cells, a fit of a map, and what the object keeps */
    return 64 * sizeof(double) * (double)grid_points(map);
}

double extension_seconds(const struct grid *map) {
    static const double STEPS = 400, NANOSECONDS = 100; /* of a point of the cell a step */
    return 1e-9 * STEPS * NANOSECONDS * (grid_is_profile(map) ? 2 : 4) * (double)grid_points(map);
}

int map_extend(struct height_map *map, enum detrend trend, uint64_t seed, struct extend_result *out,
               struct error *err) {
    struct extension *e = NULL;
    double *z = NULL;
    int status = extension_create(&e, map, trend, err);
    if (status != 0)
        return status;
    const struct grid cell = *extension_cell(e);
    z = array_create(grid_points(&cell), sizeof *z);
    status = z != NULL
                 ? extension_draw(e, (struct random_key){seed, 0, 0}, z, out, err)
                 : error_memory(err, grid_points(&cell) * sizeof *z, "a map of twice the sides");
    extension_destroy(&e);
    if (status != 0) {
        free(z);
        return status;
    }
    free(map->z);
    map->z = z;
    map->grid = cell;
    return 0;
}
