#include "core/statistics/heights/normal_scores.h"
#include "core/surface/iteration/target_heights.h"
#include <math.h>
#include <stdlib.h>

/* Packs the heights that are there; returns how many, and their standard deviation. */
static size_t heights_pack(const struct measured_map *map, double *heights, double *deviation) {
    struct average mean = {0}, square = {0};
    size_t count = 0;
    for (size_t point = 0; point < grid_points(map->grid); point++)
        if (!isnan(map->z[point])) {
            heights[count++] = map->z[point];
            average_add(&mean, map->z[point]);
        }
    for (size_t n = 0; n < count; n++)
        average_add(&square, pow(heights[n] - average_value(&mean), 2));
    *deviation = count > 0 ? sqrt(average_value(&square)) : 0;
    return count;
}

/* heights, sorted, scores: of `count` values each. */
static int scores_order(size_t count, const double *heights, double *sorted, double *scores,
                        struct error *err) {
    static const struct heights GAUSSIAN = {.type = HEIGHTS_GAUSSIAN};
    static const struct random_key NONE = {0};
    struct ranker *ranker = NULL;
    struct height_moments moments;
    int status = heights_moments(&GAUSSIAN, &moments, err);
    if (status == 0)
        status = ranker_create(&ranker, count, err);
    if (status == 0)
        status = target_heights_draw(&GAUSSIAN, &moments, DRAW_QUANTILES, NONE, count, ranker,
                                     sorted, err);
    if (status == 0)
        status = rank_order(ranker, heights, sorted, scores, err);
    ranker_destroy(&ranker);
    return status;
}

int normal_scores_fill(const struct measured_map *map, double *out, struct error *err) {
    const size_t points = grid_points(map->grid);
    double deviation, *heights = array_create(points, 3 * sizeof *heights);
    if (heights == NULL)
        return error_memory(err, 3 * points * sizeof *heights, "normal scores");
    double *sorted = heights + points, *scores = sorted + points;
    const size_t count = heights_pack(map, heights, &deviation);
    int status =
        count >= 2 && deviation > 0
            ? scores_order(count, heights, sorted, scores, err)
            : error_set(err, ERROR_INPUT, "%zu heights that do not differ have no order", count);
    for (size_t point = 0, n = 0; point < points && status == 0; point++)
        out[point] = isnan(map->z[point]) ? (double)NAN : deviation * scores[n++];
    free(heights);
    return status;
}
