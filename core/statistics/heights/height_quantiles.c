#include "core/statistics/heights/height_quantiles.h"
#include <gsl/gsl_cdf.h>
#include <gsl/gsl_statistics_double.h>
#include <math.h>
#include <stdlib.h>

static const double SCORE_STEP = 0.1, HEIGHTS_BEYOND = 10;
enum { HEIGHTS_LEAST = 50, CELLS = 2048 };

/* Returns how many steps the scores reach to either side of 0. */
static size_t steps_beside(size_t n) {
    return (size_t)floor(-gsl_cdf_ugaussian_Pinv(HEIGHTS_BEYOND / (double)n) / SCORE_STEP);
}

size_t height_quantiles_count(size_t n) {
    return n < HEIGHTS_LEAST ? 0 : 2 * steps_beside(n) + 1;
}

/* Heights, and how many steps the scores reach to either side of 0. */
struct quantiles {
    /* Owned. They are sorted by cell, equal parts of their range; within a cell those that
     * quantiles lie between come to where they are in order. */
    double *height;
    size_t n, beside;
    size_t start[CELLS + 1]; /* of the heights of a cell */
    double low, scale;       /* cells a height */
};

static double probability_of(const struct quantiles *quantiles, size_t number) {
    return gsl_cdf_ugaussian_P(((double)number - (double)quantiles->beside) * SCORE_STEP);
}

/* Height number a, counted from 0 in order, is the quantile (a + 1/2)/n. */
static double position_of(const struct quantiles *quantiles, size_t number) {
    return probability_of(quantiles, number) * (double)quantiles->n - 0.5;
}

static size_t cell_of(const struct quantiles *quantiles, double z) {
    double cell = (z - quantiles->low) * quantiles->scale;
    return cell < CELLS - 1 ? (size_t)cell : CELLS - 1;
}

static void cells_choose(struct quantiles *quantiles, const struct measured_map *map) {
    double low = INFINITY, high = -INFINITY;
    for (size_t point = 0; point < grid_points(map->grid); point++) {
        low = map->z[point] < low ? map->z[point] : low;
        high = map->z[point] > high ? map->z[point] : high;
    }
    double scale = CELLS / (high - low);
    quantiles->low = low;
    quantiles->scale = isfinite(scale) ? scale : 0;
}

/* Sorts the heights of a map by cell. */
static void heights_deal(struct quantiles *quantiles, const struct measured_map *map) {
    size_t points = grid_points(map->grid), *start = quantiles->start, next[CELLS];
    cells_choose(quantiles, map);
    for (size_t point = 0; point < points; point++)
        if (!isnan(map->z[point]))
            start[cell_of(quantiles, map->z[point]) + 1]++;
    for (size_t cell = 0; cell < CELLS; cell++) {
        next[cell] = start[cell];
        start[cell + 1] += start[cell];
    }
    for (size_t point = 0; point < points; point++)
        if (!isnan(map->z[point]))
            quantiles->height[next[cell_of(quantiles, map->z[point])]++] = map->z[point];
}

/* Puts height number `rank` of the heights from .. to - 1, which lie between all others, where it
 * is in order, lower ones before it. */
static void select_height(struct quantiles *quantiles, size_t from, size_t to, size_t rank) {
    size_t cell = 0;
    for (size_t half = CELLS / 2; half > 0; half /= 2)
        cell += quantiles->start[cell + half] <= rank ? half : 0;
    size_t first = quantiles->start[cell], end = quantiles->start[cell + 1];
    first = first > from ? first : from;
    end = end < to ? end : to;
    gsl_stats_select(quantiles->height + first, 1, end - first, rank - first);
}

/* Puts in order what the quantiles first .. end - 1 need of the heights from .. to - 1, which are
 * already between those of other quantiles: half of them at a time. */
static void put_in_order(struct quantiles *quantiles, size_t from, size_t to, size_t first,
                         size_t end) {
    if (first == end)
        return;
    size_t middle = first + (end - first) / 2, above = (size_t)position_of(quantiles, middle) + 1;
    select_height(quantiles, from, to, above);
    select_height(quantiles, from, above, above - 1);
    put_in_order(quantiles, from, above, first, middle);
    put_in_order(quantiles, above, to, middle + 1, end);
}

int height_quantiles_measure(const struct measured_map *map, size_t n, double *probability,
                             double *quantile, struct error *err) {
    struct quantiles quantiles = {
        .height = array_create(n, sizeof(double)), .n = n, .beside = steps_beside(n)};
    if (quantiles.height == NULL)
        return error_memory(err, n * sizeof(double), "heights in order");
    size_t count = height_quantiles_count(n);
    heights_deal(&quantiles, map);
    put_in_order(&quantiles, 0, n, 0, count);
    for (size_t a = 0; a < count; a++) {
        double position = position_of(&quantiles, a);
        const double *below = quantiles.height + (size_t)position;
        probability[a] = probability_of(&quantiles, a);
        quantile[a] = below[0] + (position - floor(position)) * (below[1] - below[0]);
    }
    free(quantiles.height);
    return 0;
}
