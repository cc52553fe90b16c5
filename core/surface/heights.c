#include "core/surface/heights.h"
#include <gsl/gsl_cdf.h>
#include <math.h>
#include <stddef.h>

static const double SHAPE_LOW = 0.5;
static const double SHAPE_HIGH = 20;
/* Tails of less probability than this should hold next to nothing of any moment. */
static const double TAIL_PROBABILITY = 1e-12;
static const double TAIL_SHARE = 1e-3;

/* Central moments of a Weibull minimum of scale 1 in units of its mean, theory.md 3.26-3.28. With
 * e_k = Gamma(1 + k/C)/Gamma(1 + 1/C)^k - 1 the large equal terms cancel on paper, not in digits.
 */
static void weibull_moments(double shape, struct height_moments *out) {
    int sign; /* lgamma() would write a global */
    double log1 = lgamma_r(1 + 1 / shape, &sign);
    double e2 = expm1(lgamma_r(1 + 2 / shape, &sign) - 2 * log1);
    double e3 = expm1(lgamma_r(1 + 3 / shape, &sign) - 3 * log1);
    double e4 = expm1(lgamma_r(1 + 4 / shape, &sign) - 4 * log1);
    double deviation = sqrt(e2);
    out->mean = exp(log1);
    out->deviation = out->mean * deviation;
    out->skewness = (e3 - 3 * e2) / (e2 * deviation);
    out->kurtosis = (e4 - 4 * e3 + 6 * e2) / (e2 * e2);
    out->lowest = -1 / deviation;
    out->highest = INFINITY;
}

static void moments_mirror(struct height_moments *moments) {
    double highest = -moments->lowest;
    moments->mean = -moments->mean;
    moments->skewness = -moments->skewness;
    moments->lowest = -moments->highest;
    moments->highest = highest;
}

/* Nodes and weights of the double exponential rule on (0, 1) (Takahasi and Mori 1974):
 * p = 1/(1 + exp(-pi sinh t)), |t| <= 3.1 where p reaches the last digit of 1. Smooth quantile
 * functions get 12 digits, those with jumps three. */
enum { NODES_A_SIDE = 793, NODES = 2 * NODES_A_SIDE + 1 };
static double node_probability(size_t node, double *weight) {
    double step = 3.1 / NODES_A_SIDE;
    double t = ((double)node - NODES_A_SIDE) * step;
    double low = 1 / (1 + exp(M_PI * fabs(sinh(t)))); /* the smaller of p and 1 - p */
    *weight = step * M_PI * cosh(t) * low * (1 - low);
    return t < 0 ? low : 1 - low;
}

/* Adds the powers 2..4 of the quantile function about mean to central[0..2]; tails apart. */
static void powers_integrate(const struct heights *heights, double mean, double *central,
                             double *tail) {
    for (size_t node = 0; node < NODES; node++) {
        double weight;
        double p = node_probability(node, &weight);
        double x = heights->quantile(p, heights->context) - mean;
        double term = weight * x * x;
        central[0] += term;
        central[1] += term * x;
        central[2] += term * x * x;
        if (fmin(p, 1 - p) < TAIL_PROBABILITY)
            *tail += term * x * x;
    }
}

static int quantile_moments(const struct heights *heights, struct height_moments *out,
                            struct error *err) {
    if (!heights->quantile)
        return error_set(err, ERROR_INPUT, "heights by quantile without a quantile function");
    double mean = 0;
    double last = -INFINITY;
    for (size_t node = 0; node < NODES; node++) {
        double weight;
        double p = node_probability(node, &weight);
        double x = heights->quantile(p, heights->context);
        if (!isfinite(x) || x < last)
            return error_set(err, ERROR_INPUT,
                             "the quantile function is %g at probability %g after %g; allowed: "
                             "finite and rising",
                             x, p, last);
        mean += weight * x;
        last = x;
    }
    double central[3] = {0};
    double tail = 0;
    powers_integrate(heights, mean, central, &tail);
    if (!isfinite(central[2]) || !(tail <= TAIL_SHARE * central[2]))
        return error_set(err, ERROR_INPUT, "the quantile function has no finite fourth moment");
    if (!(sqrt(central[0]) > 1e-12 * fabs(mean))) /* less is rounding */
        return error_set(err, ERROR_INPUT, "the quantile function is constant");
    out->mean = mean;
    out->deviation = sqrt(central[0]);
    out->skewness = central[1] / (central[0] * out->deviation);
    out->kurtosis = central[2] / (central[0] * central[0]);
    out->lowest = -INFINITY;
    out->highest = INFINITY;
    return 0;
}

int heights_moments(const struct heights *heights, struct height_moments *out, struct error *err) {
    switch (heights->type) {
    case HEIGHTS_GAUSSIAN:
        *out = (struct height_moments){0, 1, 0, 3, -INFINITY, INFINITY};
        return 0;
    case HEIGHTS_WEIBULL_MIN:
    case HEIGHTS_WEIBULL_MAX:
        if (!(heights->shape >= SHAPE_LOW && heights->shape <= SHAPE_HIGH))
            return error_set(err, ERROR_INPUT, "Weibull shape %g is not in [%g, %g]",
                             heights->shape, SHAPE_LOW, SHAPE_HIGH);
        weibull_moments(heights->shape, out);
        if (heights->type == HEIGHTS_WEIBULL_MAX)
            moments_mirror(out);
        return 0;
    case HEIGHTS_QUANTILE:
        return quantile_moments(heights, out, err);
    }
    return error_set(err, ERROR_INPUT, "unknown height distribution %d", (int)heights->type);
}

double heights_quantile(const struct heights *heights, const struct height_moments *moments,
                        double probability) {
    double raw = 0;
    switch (heights->type) {
    case HEIGHTS_GAUSSIAN:
        return gsl_cdf_ugaussian_Pinv(probability);
    case HEIGHTS_WEIBULL_MIN:
        raw = pow(-log1p(-probability), 1 / heights->shape);
        break;
    case HEIGHTS_WEIBULL_MAX:
        raw = -pow(-log(probability), 1 / heights->shape);
        break;
    case HEIGHTS_QUANTILE:
        raw = heights->quantile(probability, heights->context);
        break;
    }
    return (raw - moments->mean) / moments->deviation;
}

/* The distance from the bound of a Weibull variable in its own scale; negative beyond the bound. */
static double weibull_depth(const struct heights *heights, const struct height_moments *moments,
                            double z) {
    double raw = moments->mean + moments->deviation * z;
    return heights->type == HEIGHTS_WEIBULL_MAX ? -raw : raw;
}

double heights_pdf(const struct heights *heights, const struct height_moments *moments, double z) {
    if (heights->type == HEIGHTS_QUANTILE)
        return NAN;
    if (heights->type == HEIGHTS_GAUSSIAN)
        return exp(-z * z / 2) / sqrt(2 * M_PI);
    double x = weibull_depth(heights, moments, z);
    double c = heights->shape;
    if (x < 0)
        return 0;
    return moments->deviation * c * pow(x, c - 1) * exp(-pow(x, c));
}

double heights_cdf(const struct heights *heights, const struct height_moments *moments, double z) {
    if (heights->type == HEIGHTS_QUANTILE)
        return NAN;
    if (heights->type == HEIGHTS_GAUSSIAN)
        return erfc(-z / M_SQRT2) / 2;
    double x = weibull_depth(heights, moments, z);
    double exponent = x > 0 ? pow(x, heights->shape) : 0;
    return heights->type == HEIGHTS_WEIBULL_MAX ? exp(-exponent) : -expm1(-exponent);
}
