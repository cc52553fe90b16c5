#include "core/statistics/heights/height_quantiles.h"
#include <gsl/gsl_cdf.h>
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

static int compare(const void *a, const void *b) {
    double one = *(const double *)a, other = *(const double *)b;
    return (one > other) - (one < other);
}

int height_quantiles_measure(const struct measured_map *map, size_t n, double *probability,
                             double *quantile, struct error *err) {
    double *sorted = array_create(n, sizeof *sorted);
    if (sorted == NULL)
        return error_memory(err, n * sizeof *sorted, "heights in order");
    size_t taken = 0, points = grid_points(map->grid), count = height_quantiles_count(n);
    for (size_t i = 0; i < points && taken < n; i++)
        if (!isnan(map->z[i]))
            sorted[taken++] = map->z[i];
    qsort(sorted, n, sizeof *sorted, compare);
    double beside = (double)steps_beside(n);
    for (size_t a = 0; a < count; a++) {
        double score = ((double)a - beside) * SCORE_STEP;
        probability[a] = gsl_cdf_ugaussian_P(score);
        double place = probability[a] * (double)n - 0.5; /* number a is the quantile (a + 1/2)/n */
        size_t below = (size_t)place;
        quantile[a] = sorted[below] + (place - (double)below) * (sorted[below + 1] - sorted[below]);
    }
    free(sorted);
    return 0;
}
