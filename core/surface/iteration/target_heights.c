#include "core/surface/iteration/target_heights.h"
#include <math.h>

/* Sum of (z - shift)^power, power 1 or 2; pairwise, so that the error grows with log n. */
static double pairwise_sum(const double *z, size_t n, double shift, int power) {
    if (n > 128) {
        size_t half = n / 2;
        return pairwise_sum(z, half, shift, power) + pairwise_sum(z + half, n - half, shift, power);
    }
    double sum = 0;
    for (size_t i = 0; i < n; i++)
        sum += power == 1 ? z[i] - shift : (z[i] - shift) * (z[i] - shift);
    return sum;
}

static int standardise(double *z, size_t n, struct error *err) {
    double mean = pairwise_sum(z, n, 0, 1) / (double)n;
    mean += pairwise_sum(z, n, mean, 1) / (double)n;
    double deviation = sqrt(pairwise_sum(z, n, mean, 2) / (double)n);
    /* Heights are in standard deviations of their distribution: less than this is rounding. */
    if (!(deviation > 1e-12 && isfinite(deviation)))
        return error_set(err, ERROR_NUMERIC, "the %zu target heights do not differ", n);
    for (size_t i = 0; i < n; i++)
        z[i] = (z[i] - mean) / deviation;
    return 0;
}

int target_heights_draw(const struct heights *heights, const struct height_moments *moments,
                        enum surface_draw draw, struct random_key key, size_t n,
                        struct ranker *ranker, double *sorted, struct error *err) {
    if (draw == DRAW_RANDOM) {
        /* The values are evenly distributed: they are sorted before the quantile function, which
         * keeps the order. */
        random_uniform(key, STREAM_HEIGHTS, 0, n, sorted);
        int status = rank_sort(ranker, sorted, err);
        if (status != 0)
            return status;
    }
    double last = -INFINITY;
    for (size_t i = 0; i < n; i++) {
        /* A drawn 0 lies outside (0, 1); it is replaced by half a step of the generator. */
        double p = draw == DRAW_RANDOM ? fmax(sorted[i], 0x1p-54) : ((double)i + 0.5) / (double)n;
        double z = heights_quantile(heights, moments, p);
        if (!isfinite(z))
            return error_set(err, ERROR_NUMERIC, "the height of probability %g is not finite", p);
        last = fmax(last, z); /* pow() may fall in its last digit where p rises by one */
        sorted[i] = last;
    }
    return standardise(sorted, n, err);
}
