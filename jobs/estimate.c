#include "jobs/estimate.h"
#include "core/sum.h"
#include <gsl/gsl_cdf.h>
#include <math.h>
#include <stdbool.h>

static double weight_of(const double *x, const double *weight, size_t r) {
    if (!isfinite(x[r]))
        return 0;
    return weight == NULL ? 1 : weight[r];
}

static struct estimate estimate_ratio(size_t n, const double *x, const double *weight) {
    struct sum weights = {0, 0}, products = {0, 0}, squares = {0, 0};
    size_t used = 0;
    for (size_t r = 0; r < n; r++) {
        double w = weight_of(x, weight, r);
        if (!(w > 0))
            continue;
        used++;
        sum_add(&weights, w);
        sum_add(&products, w * x[r]);
    }
    double total = sum_value(&weights);
    double mean = used > 0 ? sum_value(&products) / total : NAN;
    for (size_t r = 0; r < n; r++) {
        double w = weight_of(x, weight, r);
        if (w > 0)
            sum_add(&squares, (w * (x[r] - mean)) * (w * (x[r] - mean)));
    }
    double m = (double)used;
    double error = used > 1 ? sqrt(m / (m - 1) * sum_value(&squares)) / total : NAN;
    return (struct estimate){mean, error};
}

struct estimate estimate_mean(size_t n, const double *x) {
    return estimate_ratio(n, x, NULL);
}

double estimate_effective(size_t n, const double *x, const double *weight) {
    size_t used = 0;
    for (size_t r = 0; r < n; r++)
        used += weight_of(x, weight, r) > 0;
    return used < n ? (double)used : 0;
}

struct estimate estimate_of_few(struct estimate mean, size_t count) {
    if (count < 2)
        return (struct estimate){NAN, NAN};
    const double student = gsl_cdf_tdist_Pinv(0.975, (double)count - 1);
    mean.standard_error *= student / gsl_cdf_ugaussian_Pinv(0.975);
    return mean;
}

struct estimate estimate_weighted(size_t n, const double *x, const double *weight) {
    return estimate_ratio(n, x, weight);
}

/* What a realisation adds to a mean of pairs: its weighted deviation over the mean weight. */
struct column_mean {
    double mean, weight;
};

static bool is_pair(const struct estimate_column *a, const struct estimate_column *b, size_t r) {
    return weight_of(a->x, a->weight, r) > 0 && weight_of(b->x, b->weight, r) > 0;
}

static struct column_mean mean_of(size_t n, const struct estimate_column *column,
                                  const struct estimate_column *other, size_t *pairs) {
    struct sum weights = {0, 0}, products = {0, 0};
    *pairs = 0;
    for (size_t r = 0; r < n; r++) {
        if (!is_pair(column, other, r))
            continue;
        double w = weight_of(column->x, column->weight, r);
        sum_add(&weights, w);
        sum_add(&products, w * column->x[r]);
        (*pairs)++;
    }
    double total = sum_value(&weights);
    return (struct column_mean){sum_value(&products) / total, total / (double)*pairs};
}

static double deviation_of(const struct estimate_column *column, const struct column_mean *mean,
                           size_t r) {
    return weight_of(column->x, column->weight, r) * (column->x[r] - mean->mean) / mean->weight;
}

/* The error of a difference of two ratios over the same realisations is that of the mean of their
 * linear parts (Cochran 1977, section 2.11). Without weights it is that of the mean difference. */
struct pair_estimate estimate_pairs(size_t n, const struct estimate_column *minuend,
                                    const struct estimate_column *subtrahend) {
    struct pair_estimate out = {NAN, NAN, NAN, 0};
    struct column_mean a = mean_of(n, minuend, subtrahend, &out.pairs);
    struct column_mean b = mean_of(n, subtrahend, minuend, &out.pairs);
    struct sum squares = {0, 0};
    double m = (double)out.pairs;
    if (out.pairs > 0)
        out.value = a.mean - b.mean;
    if (out.pairs < 2)
        return out;
    for (size_t r = 0; r < n; r++) {
        if (!is_pair(minuend, subtrahend, r))
            continue;
        double d = deviation_of(minuend, &a, r) - deviation_of(subtrahend, &b, r);
        sum_add(&squares, d * d);
    }
    out.deviation = sqrt(sum_value(&squares) / (m - 1));
    out.standard_error = out.deviation / sqrt(m);
    return out;
}

/* Computes a ratio over n groups. The mean number of things is over the groups that have any in
 * either case. */
static struct column_mean ratio_of(size_t n, size_t used, const struct estimate_groups *groups) {
    struct sum counted = {0, 0}, things = {0, 0};
    for (size_t g = 0; g < n; g++) {
        sum_add(&counted, groups->counted[g]);
        sum_add(&things, groups->things[g]);
    }
    double total = sum_value(&things);
    return (struct column_mean){sum_value(&counted) / total, total / (double)used};
}

static double residual_of(const struct estimate_groups *groups, const struct column_mean *ratio,
                          size_t g) {
    return (groups->counted[g] - ratio->mean * groups->things[g]) / ratio->weight;
}

struct pair_estimate estimate_group_pairs(size_t n, const struct estimate_groups *minuend,
                                          const struct estimate_groups *subtrahend) {
    struct pair_estimate out = {NAN, NAN, NAN, 0};
    struct sum squares = {0, 0};
    for (size_t g = 0; g < n; g++)
        out.pairs += minuend->things[g] > 0 || subtrahend->things[g] > 0;
    if (out.pairs == 0)
        return out;
    struct column_mean a = ratio_of(n, out.pairs, minuend);
    struct column_mean b = ratio_of(n, out.pairs, subtrahend);
    double m = (double)out.pairs;
    out.value = a.mean - b.mean;
    for (size_t g = 0; g < n && out.pairs > 1; g++) {
        double d = residual_of(minuend, &a, g) - residual_of(subtrahend, &b, g);
        sum_add(&squares, d * d);
    }
    if (out.pairs > 1) {
        out.deviation = sqrt(sum_value(&squares) / (m - 1));
        out.standard_error = out.deviation / sqrt(m);
    }
    return out;
}
