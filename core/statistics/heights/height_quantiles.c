#include "core/statistics/heights/height_quantiles.h"
#include <gsl/gsl_cdf.h>
#include <gsl/gsl_statistics_double.h>
#include <math.h>
#include <stdlib.h>

static const double SCORE_STEP = 0.1, HEIGHTS_BEYOND = 10;
enum { HEIGHTS_LEAST = 50 };

/* Returns how many steps the scores reach to either side of 0. */
static size_t steps_beside(size_t n) {
    return (size_t)floor(-gsl_cdf_ugaussian_Pinv(HEIGHTS_BEYOND / (double)n) / SCORE_STEP);
}

size_t height_quantiles_count(size_t n) {
    return n < HEIGHTS_LEAST ? 0 : 2 * steps_beside(n) + 1;
}

/* Heights, and how many steps the scores reach to either side of 0. */
struct quantiles {
    double *height; /* owned; those that quantiles lie between come to where they are in order */
    size_t n, beside;
};

static double probability_of(const struct quantiles *quantiles, size_t number) {
    return gsl_cdf_ugaussian_P(((double)number - (double)quantiles->beside) * SCORE_STEP);
}

/* Height number a, counted from 0 in order, is the quantile (a + 1/2)/n. */
static double position_of(const struct quantiles *quantiles, size_t number) {
    return probability_of(quantiles, number) * (double)quantiles->n - 0.5;
}

/* Puts in order what the quantiles first .. end - 1 need of the heights from .. to - 1, which are
 * already between those of other quantiles: half of them at a time. */
static void put_in_order(struct quantiles *quantiles, size_t from, size_t to, size_t first,
                         size_t end) {
    if (first == end)
        return;
    size_t middle = first + (end - first) / 2, above = (size_t)position_of(quantiles, middle) + 1;
    gsl_stats_select(quantiles->height + from, 1, to - from, above - from);
    gsl_stats_select(quantiles->height + from, 1, above - from, above - 1 - from);
    put_in_order(quantiles, from, above, first, middle);
    put_in_order(quantiles, above, to, middle + 1, end);
}

int height_quantiles_measure(const struct measured_map *map, size_t n, double *probability,
                             double *quantile, struct error *err) {
    struct quantiles quantiles = {array_create(n, sizeof(double)), n, steps_beside(n)};
    if (quantiles.height == NULL)
        return error_memory(err, n * sizeof(double), "heights in order");
    size_t taken = 0, points = grid_points(map->grid), count = height_quantiles_count(n);
    for (size_t i = 0; i < points && taken < n; i++)
        if (!isnan(map->z[i]))
            quantiles.height[taken++] = map->z[i];
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
