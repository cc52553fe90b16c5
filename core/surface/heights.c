#include "core/surface/heights.h"
#include "core/surface/inverse_cdf.h"
#include <gsl/gsl_cdf.h>
#include <math.h>
#include <stddef.h>

/* Tails of less probability than this should add next to nothing to any moment. */
static const double TAIL_PROBABILITY = 1e-12;
static const double TAIL_SHARE = 1e-3;
/* The highest probability below 1. */
static const double PROBABILITY_MOST = 1 - 0x1p-53;

/* --- Gaussian --- */

static void gaussian_moments(const struct heights *of, struct height_moments *out) {
    (void)of;
    *out = (struct height_moments){0, 1, 0, 3, -INFINITY, INFINITY};
}

static double gaussian_quantile(const struct heights *of, double probability) {
    (void)of;
    return gsl_cdf_ugaussian_Pinv(probability);
}

/* Returns the share of standard Gaussian numbers below a score. */
static double share_below(double score) {
    return erfc(-score / M_SQRT2) / 2;
}

static double gaussian_cdf(const struct heights *of, double raw) {
    (void)of;
    return share_below(raw);
}

static double gaussian_at_score(const struct heights *of, double score) {
    (void)of;
    return score;
}

/* --- Weibull, scale 1: a minimum lies above 0, a maximum is its mirror image below 0 --- */

/* Central moments of a Weibull minimum of scale 1 in units of its mean, F4.2. They are written in
 * e_k = Gamma(1 + k/C)/Gamma(1 + 1/C)^k - 1, so that the large equal terms cancel exactly. */
static void weibull_min_moments(const struct heights *of, struct height_moments *out) {
    double shape = of->shape;
    int sign; /* lgamma() would write a global variable */
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

/* x to the power 1/shape: x itself of the exponential distribution. */
static double weibull_power(double x, double shape) {
    return shape == 1 ? x : pow(x, 1 / shape);
}

static double weibull_min_quantile(const struct heights *of, double probability) {
    return weibull_power(-log1p(-probability), of->shape);
}

static double weibull_min_cdf(const struct heights *of, double raw) {
    return -expm1(-(raw > 0 ? pow(raw, of->shape) : 0));
}

/* The logarithm of the share above a score: from the share below where that is the smaller. */
static double weibull_min_at_score(const struct heights *of, double score) {
    double smaller = erfc(fabs(score) / M_SQRT2) / 2;
    return pow(score > 0 ? -log(smaller) : -log1p(-smaller), 1 / of->shape);
}

static void weibull_max_moments(const struct heights *of, struct height_moments *out) {
    weibull_min_moments(of, out);
    out->mean = -out->mean;
    out->skewness = -out->skewness;
    out->highest = -out->lowest;
    out->lowest = -INFINITY;
}

static double weibull_max_quantile(const struct heights *of, double probability) {
    return -weibull_power(-log(probability), of->shape);
}

static double weibull_max_cdf(const struct heights *of, double raw) {
    return exp(-(raw < 0 ? pow(-raw, of->shape) : 0));
}

static double weibull_max_at_score(const struct heights *of, double score) {
    return -weibull_min_at_score(of, -score);
}

/* --- log-normal: exp(s x) of a Gaussian x, median 1 (Johnson, Kotz & Balakrishnan 1994, chapter
 * 14); the shape is s, the standard deviation of the logarithm --- */

static void lognormal_moments(const struct heights *of, struct height_moments *out) {
    double square = of->shape * of->shape, spread = sqrt(expm1(square)); /* deviation over mean */
    out->mean = exp(square / 2);
    out->deviation = out->mean * spread;
    out->skewness = (exp(square) + 2) * spread;
    out->kurtosis = exp(4 * square) + 2 * exp(3 * square) + 3 * exp(2 * square) - 3;
    out->lowest = -1 / spread;
    out->highest = INFINITY;
}

static double lognormal_quantile(const struct heights *of, double probability) {
    return exp(of->shape * gsl_cdf_ugaussian_Pinv(probability));
}

static double lognormal_cdf(const struct heights *of, double raw) {
    return raw > 0 ? share_below(log(raw) / of->shape) : 0;
}

static double lognormal_at_score(const struct heights *of, double score) {
    return exp(of->shape * score);
}

/* --- gamma, scale 1 (Johnson, Kotz & Balakrishnan 1994, chapter 17), F4.7 --- */

/* Scores beyond these have probabilities that no number holds. */
static const double SCORE_MOST = 37;

static void gamma_moments(const struct heights *of, struct height_moments *out) {
    double root = sqrt(of->shape);
    *out = (struct height_moments){of->shape, root, 2 / root, 3 + 6 / of->shape, -root, INFINITY};
}

static double gamma_quantile(const struct heights *of, double probability) {
    return gamma_quantile_of(of->shape, probability, 1 - probability);
}

static double gamma_cdf(const struct heights *of, double raw) {
    return raw > 0 ? gsl_cdf_gamma_P(raw, of->shape, 1) : 0;
}

static double gamma_at_score(const struct heights *of, double score) {
    score = fmax(-SCORE_MOST, fmin(SCORE_MOST, score));
    return gamma_quantile_of(of->shape, share_below(score), share_below(-score));
}

/* --- beta on [0, 1] (Johnson, Kotz & Balakrishnan 1995, chapter 25), F4.8 --- */

/* Without a second shape the distribution is symmetric. */
static double second_shape(const struct heights *of) {
    return of->second > 0 ? of->second : of->shape;
}

static void beta_moments(const struct heights *of, struct height_moments *out) {
    double a = of->shape, b = second_shape(of), sum = a + b;
    double root = sqrt(a * b / (sum + 1)); /* deviation times the sum */
    out->mean = a / sum;
    out->deviation = root / sum;
    out->skewness = 2 * (b - a) * sqrt((sum + 1) / (a * b)) / (sum + 2);
    out->kurtosis = 3 + 6 * ((a - b) * (a - b) * (sum + 1) - a * b * (sum + 2)) /
                            (a * b * (sum + 2) * (sum + 3));
    out->lowest = -a / root;
    out->highest = b / root;
}

static double beta_quantile(const struct heights *of, double probability) {
    return beta_quantile_of(of->shape, second_shape(of), probability, 1 - probability);
}

static double beta_cdf(const struct heights *of, double raw) {
    return gsl_cdf_beta_P(fmax(0, fmin(1, raw)), of->shape, second_shape(of));
}

static double beta_at_score(const struct heights *of, double score) {
    score = fmax(-SCORE_MOST, fmin(SCORE_MOST, score));
    return beta_quantile_of(of->shape, second_shape(of), share_below(score), share_below(-score));
}

/* The functions of a distribution have its name at their beginning. */
#define FUNCTIONS(name)                                                                            \
    .moments = name##_moments, .quantile = name##_quantile, .cdf = name##_cdf,                     \
    .at_score = name##_at_score
#define WEIBULL                                                                                    \
    .family = "weibull", .shape_means = "shape C of a Weibull distribution", .shape_low = 0.5,     \
    .shape_high = 20

static const struct distribution DISTRIBUTIONS[] = {
    [HEIGHTS_GAUSSIAN] = {.family = "gaussian", FUNCTIONS(gaussian)},
    [HEIGHTS_WEIBULL_MIN] = {WEIBULL, FUNCTIONS(weibull_min)},
    [HEIGHTS_WEIBULL_MAX] = {WEIBULL, FUNCTIONS(weibull_max)},
    [HEIGHTS_LOGNORMAL] = {.family = "lognormal",
                           .shape_means = "standard deviation of the logarithm",
                           .shape_low = 0.01,
                           .shape_high = 1,
                           FUNCTIONS(lognormal)},
    [HEIGHTS_GAMMA] = {.family = "gamma",
                       .shape_means = "shape of a gamma distribution",
                       .shape_low = 0.25,
                       .shape_high = 1000,
                       FUNCTIONS(gamma)},
    [HEIGHTS_BETA] = {.family = "beta",
                      .shape_means = "first shape of a beta distribution",
                      .shape_low = 0.5,
                      .shape_high = 100,
                      .has_second = true,
                      FUNCTIONS(beta)},
};
_Static_assert(sizeof DISTRIBUTIONS / sizeof *DISTRIBUTIONS == HEIGHTS_QUANTILE,
               "every distribution with a name has its row");

const struct distribution *heights_distribution(enum heights_type type) {
    return type < HEIGHTS_QUANTILE ? &DISTRIBUTIONS[type] : NULL;
}

/* --- any quantile function --- */

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

/* Integrates the powers 2 to 4 of the quantile function about mean into central[0..2], and the
 * parts of the tails separately. */
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
    if (heights->quantile == NULL)
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

/* --- all distributions --- */

static int table_moments(const struct heights *heights, struct height_moments *out,
                         struct error *err) {
    if (heights->table == NULL)
        return error_set(err, ERROR_INPUT, "heights by a table without one");
    height_table_moments(heights->table, out);
    return 0;
}

int heights_moments(const struct heights *heights, struct height_moments *out, struct error *err) {
    if (heights->type == HEIGHTS_QUANTILE)
        return quantile_moments(heights, out, err);
    if (heights->type == HEIGHTS_TABLE)
        return table_moments(heights, out, err);
    const struct distribution *row = heights_distribution(heights->type);
    if (row == NULL)
        return error_set(err, ERROR_INPUT, "unknown height distribution %d", (int)heights->type);
    if (row->shape_means != NULL &&
        !(heights->shape >= row->shape_low && heights->shape <= row->shape_high))
        return error_set(err, ERROR_INPUT, "%s: %g is not in [%g, %g]", row->shape_means,
                         heights->shape, row->shape_low, row->shape_high);
    if (row->has_second && heights->second != 0 &&
        !(heights->second >= row->shape_low && heights->second <= row->shape_high))
        return error_set(err, ERROR_INPUT,
                         "second shape of a %s distribution: %g is not in [%g, %g]", row->family,
                         heights->second, row->shape_low, row->shape_high);
    row->moments(heights, out);
    return 0;
}

static double skewness_at(const struct distribution *row, const struct heights *of, double shape) {
    struct heights heights = *of;
    struct height_moments moments;
    heights.shape = shape;
    row->moments(&heights, &moments);
    return moments.skewness;
}

/* The skewness of each distribution rises or falls over the whole range of its shape, unless it is
 * symmetric for all. */
int heights_shape_of_skewness(const struct heights *of, double skewness, double *shape,
                              struct error *err) {
    enum { HALVINGS = 100 };
    const struct distribution *row = heights_distribution(of->type);
    if (row == NULL || row->shape_means == NULL)
        return error_set(err, ERROR_INPUT, "these heights have no shape to be solved for");
    double low = row->shape_low, high = row->shape_high;
    double at_low = skewness_at(row, of, low), at_high = skewness_at(row, of, high);
    if (at_low == at_high)
        return error_set(err, ERROR_INPUT,
                         "with equal shapes the skewness is %g; give the second shape", at_low);
    double sign = at_high > at_low ? 1 : -1;
    if (!(sign * skewness >= sign * at_low && sign * skewness <= sign * at_high))
        return error_set(err, ERROR_INPUT, "no shape has the skewness %g; allowed: %.4g to %.4g",
                         skewness, fmin(at_low, at_high), fmax(at_low, at_high));
    for (int n = 0; n < HALVINGS; n++) {
        double middle = (low + high) / 2;
        if (sign * skewness_at(row, of, middle) < sign * skewness)
            low = middle;
        else
            high = middle;
    }
    *shape = (low + high) / 2;
    return 0;
}

/* F4.8. */
int heights_shapes_of_moments(double skewness, double kurtosis, struct heights *out,
                              struct error *err) {
    const struct distribution *row = &DISTRIBUTIONS[HEIGHTS_BETA];
    double square = skewness * skewness, least = square + 1, most = 3 + 1.5 * square;
    if (!(kurtosis > least && kurtosis < most))
        return error_set(err, ERROR_INPUT,
                         "no beta distribution of skewness %g has the kurtosis %g; allowed: (%.4g, "
                         "%.4g)",
                         skewness, kurtosis, least, most);
    double sum = 6 * (kurtosis - least) / (2 * (most - kurtosis));
    double apart = (sum + 2) * skewness / sqrt((sum + 2) * (sum + 2) * square + 16 * (sum + 1));
    double a = sum / 2 * (1 - apart), b = sum / 2 * (1 + apart);
    if (!(fmin(a, b) >= row->shape_low && fmax(a, b) <= row->shape_high))
        return error_set(
            err, ERROR_INPUT,
            "skewness %g and kurtosis %g are those of a beta distribution of the shapes "
            "%.4g and %.4g; allowed: [%g, %g]",
            skewness, kurtosis, a, b, row->shape_low, row->shape_high);
    out->shape = a;
    out->second = b;
    return 0;
}

double heights_quantile(const struct heights *heights, const struct height_moments *moments,
                        double probability) {
    const struct distribution *row = heights_distribution(heights->type);
    double raw = row != NULL ? row->quantile(heights, probability)
                 : heights->type == HEIGHTS_TABLE
                     ? height_table_quantile(heights->table, probability)
                     : heights->quantile(probability, heights->context);
    return (raw - moments->mean) / moments->deviation;
}

double heights_at_score(const struct heights *heights, const struct height_moments *moments,
                        double score) {
    const struct distribution *row = heights_distribution(heights->type);
    double raw;
    if (row != NULL)
        raw = row->at_score(heights, score);
    else if (heights->type == HEIGHTS_TABLE)
        raw = height_table_at_score(heights->table, score);
    else
        raw = heights->quantile(fmin(share_below(score), PROBABILITY_MOST), heights->context);
    return (raw - moments->mean) / moments->deviation;
}

double heights_cdf(const struct heights *heights, const struct height_moments *moments, double z) {
    const struct distribution *row = heights_distribution(heights->type);
    double raw = moments->mean + moments->deviation * z;
    if (row != NULL)
        return row->cdf(heights, raw);
    return heights->type == HEIGHTS_TABLE ? height_table_cdf(heights->table, raw) : NAN;
}
