#include "jobs/estimate.h"
#include "core/sum.h"
#include <math.h>

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

struct estimate estimate_weighted(size_t n, const double *x, const double *weight) {
    return estimate_ratio(n, x, weight);
}
