#include "core/surface/inverse_cdf.h"
#include <gsl/gsl_cdf.h>
#include <math.h>
#include <stdbool.h>

/* A tail: the logarithm of its probability at u = log(x) or u = log(x/(1 - x)), and the slope of
 * that. */
struct tail {
    double a, b;      /* shapes */
    double logarithm; /* of the gamma or the beta function of the shapes */
    bool upper;       /* the probability above */
    double (*at)(const struct tail *tail, double u, double *slope);
};

static double gamma_tail(const struct tail *tail, double u, double *slope) {
    double x = exp(u), k = tail->a;
    double p = tail->upper ? gsl_cdf_gamma_Q(x, k, 1) : gsl_cdf_gamma_P(x, k, 1);
    *slope = (tail->upper ? -1 : 1) * exp(k * u - x - tail->logarithm) / p;
    return log(p);
}

static double beta_tail(const struct tail *tail, double u, double *slope) {
    double x = 1 / (1 + exp(-u)), p = gsl_cdf_beta_P(x, tail->a, tail->b);
    *slope = exp(-tail->a * log1p(exp(-u)) - tail->b * log1p(exp(u)) - tail->logarithm) / p;
    return log(p);
}

/* Solves for the u of a probability by Newton's steps, each within what is known of u; halves that
 * where a step leaves it. The tail is concave in u, so that steps converge from one side. */
static double tail_solve(const struct tail *tail, double probability, double u) {
    static const double REACH = 800, DIGITS = 4e-16; /* exp(-REACH) is below all numbers */
    enum { STEPS_MOST = 200 };
    double low = -REACH, high = REACH, target = log(probability);
    for (int n = 0; n < STEPS_MOST; n++) {
        double slope, off = tail->at(tail, u, &slope) - target;
        bool beyond = isnan(off) ? u > 0 : (off > 0) != tail->upper;
        *(beyond ? &high : &low) = u;
        double next = u - off / slope;
        if (!(next > low && next < high))
            next = (low + high) / 2;
        if (fabs(next - u) <= DIGITS * fmax(1, fabs(u)) || high - low <= DIGITS)
            return next;
        u = next;
    }
    return u;
}

double gamma_quantile_of(double shape, double below, double above) {
    int sign; /* lgamma() would write a global variable */
    struct tail tail = {
        .a = shape, .logarithm = lgamma_r(shape, &sign), .upper = above < below, .at = gamma_tail};
    double smaller = tail.upper ? above : below;
    /* Wilson and Hilferty (1931), or the beginning of the series, which is exact near 0. */
    double score = tail.upper ? gsl_cdf_ugaussian_Qinv(above) : gsl_cdf_ugaussian_Pinv(below);
    double root = 1 - 1 / (9 * shape) + score / (3 * sqrt(shape));
    double start = (log(below) + lgamma_r(shape + 1, &sign)) / shape;
    if (root > 0.2)
        start = log(shape) + 3 * log(root);
    else if (start < -40)
        return exp(start);
    return exp(tail_solve(&tail, smaller, start));
}

double beta_quantile_of(double a, double b, double below, double above) {
    int sign;
    if (above < below)
        return 1 - beta_quantile_of(b, a, above, below);
    struct tail tail = {.a = a,
                        .b = b,
                        .logarithm =
                            lgamma_r(a, &sign) + lgamma_r(b, &sign) - lgamma_r(a + b, &sign),
                        .at = beta_tail};
    /* The beginning of the series, and no more than the mean. */
    double start = fmin((log(below * a) + tail.logarithm) / a, log(a / b));
    if (start < -40)
        return exp(start);
    return 1 / (1 + exp(-tail_solve(&tail, below, start)));
}
