#include "core/theory/translated_summits.h"
#include "core/theory/quadrature.h"
#include <math.h>

static bool is_surface(const struct translated_surface *surface) {
    return surface->dimension == 2;
}

double translated_stretch(const struct translated_surface *surface) {
    const struct moments *g = &surface->gaussian, *z = &surface->reached;
    return sqrt(z->m0 / g->m0 * (g->m4 / z->m4));
}

/* --- rules over values of g --- */

/* Outside of SCORE_MOST lie 1e-21 of all summits; at SCORE_END densities underflow. */
static const double SCORE_MOST = 10, SCORE_END = 38;
/* Panels are as long as densities are smooth: near 0, where those of alpha near its bound bend,
 * they are shorter. On NARROW ones 4 points have an error below 1e-12. */
static const double PANEL_MOST = 0.5, NARROW = 0.125;

static double alpha_least(const struct translated_surface *surface) {
    return is_surface(surface) ? 1.5 : 1;
}

double translated_panel_end(const struct translated_surface *surface, double at, double high) {
    double bend = sqrt(fmax(1 - alpha_least(surface) / surface->gaussian.nayak_alpha, 0));
    double end = at + fmin(PANEL_MOST, bend + fabs(at) / 2);
    return end < high && end > at ? end : high;
}

struct rule {
    size_t n;
    double node[QUADRATURE_NODES], weight[QUADRATURE_NODES];
};

static void rule_fill(struct rule *rule, double low, double high, double narrow) {
    if (high - low > narrow) {
        rule->n = QUADRATURE_NODES;
        quadrature_panel(low, high, rule->node, rule->weight);
        return;
    }
    double half = (high - low) / 2;
    rule->n = GAUSS_4;
    for (size_t q = 0; q < GAUSS_4; q++) {
        rule->node[q] = low + half * (1 + GAUSS_4_NODES[q]);
        rule->weight[q] = half * GAUSS_4_WEIGHTS[q];
    }
}

/* The density of summits of g over its heights, and their mean curvature in sqrt(m4) of g. */
struct summit_at {
    double pdf, curvature;
};

static struct summit_at summit_at(const struct translated_surface *surface, double score) {
    double alpha = surface->gaussian.nayak_alpha;
    struct summit_at at;
    if (is_surface(surface))
        at = (struct summit_at){nayak_summit_pdf(score, alpha), nayak_mean_curvature(score, alpha)};
    else
        profile_peak(score, alpha, &at.pdf, &at.curvature);
    return at;
}

/* Sums over summits between two values of g: their share, their heights to a power, and their
 * curvature over sqrt(m4) of z. */
struct summit_sums {
    double share, height[4], curvature;
};

static struct summit_sums sums_between(const struct translated_surface *surface, double low,
                                       double high) {
    struct summit_sums sums = {0};
    double factor = translated_stretch(surface);
    double at = low, end;
    while (at < high) {
        struct rule rule;
        end = translated_panel_end(surface, at, high);
        rule_fill(&rule, at, end, NARROW);
        for (size_t q = 0; q < rule.n; q++) {
            struct summit_at summit = summit_at(surface, rule.node[q]);
            struct height_slope z = translated_heights_at(&surface->heights, rule.node[q]);
            double power = rule.weight[q] * summit.pdf;
            sums.share += power;
            sums.curvature += power * factor * z.slope * summit.curvature;
            for (size_t n = 0; n < 4; n++)
                sums.height[n] += power *= z.height;
        }
        at = end;
    }
    return sums;
}

struct summit_expectation translated_summits_expectation(const struct translated_surface *surface) {
    const struct moments *g = &surface->gaussian;
    struct summit_expectation out =
        summit_expectation(surface->dimension, g->m2, g->m4, g->nayak_alpha);
    struct summit_sums sums = sums_between(surface, -SCORE_MOST, SCORE_MOST);
    const double *m = sums.height;
    double variance = m[1] - m[0] * m[0];
    double third = m[2] - 3 * m[0] * m[1] + 2 * m[0] * m[0] * m[0];
    double fourth = m[3] - 4 * m[0] * m[2] + 6 * m[0] * m[0] * m[1] - 3 * m[0] * m[0] * m[0] * m[0];
    out.height_mean = m[0];
    out.height_variance = variance;
    out.height_skewness = third / (variance * sqrt(variance));
    out.height_kurtosis = fourth / (variance * variance);
    out.curvature = sums.curvature;
    return out;
}

/* --- bins of heights --- */

static double upper_edge(const struct bins *bins, size_t b) {
    return bins->low + (double)(b + 1) * bins_width(bins);
}

static double score_of(const struct translated_surface *surface, double height) {
    double score = translated_heights_inverse(&surface->heights, height);
    return fmin(fmax(score, -SCORE_END), SCORE_END);
}

/* Below this share a bin's mean curvature is that in the middle of it, as in bin_averages.c. */
static const double SHARE_LEAST = 1e-200;

static double mean_curvature(const struct translated_surface *surface, double low, double high,
                             const struct summit_sums *sums) {
    double middle = (low + high) / 2;
    if (!(high > low))
        return NAN;
    if (sums->share > SHARE_LEAST)
        return sums->curvature / sums->share;
    return translated_stretch(surface) * translated_heights_at(&surface->heights, middle).slope *
           summit_at(surface, middle).curvature;
}

void translated_summits_heights(const struct translated_surface *surface, const struct bins *bins,
                                double *pdf, double *cdf, double *curvature) {
    double alpha = surface->gaussian.nayak_alpha, low = score_of(surface, bins->low);
    for (size_t b = 0; b < bins->count; b++) {
        double high = score_of(surface, upper_edge(bins, b));
        struct summit_sums sums = sums_between(surface, low, high);
        pdf[b] = sums.share / bins_width(bins);
        cdf[b] =
            is_surface(surface) ? nayak_summit_cdf(high, alpha) : profile_peak_cdf(high, alpha);
        curvature[b] = mean_curvature(surface, low, high, &sums);
        low = high;
    }
}

/* --- curvatures at a value of g --- */

static const double DEPTH = 45; /* exp(-DEPTH) of the peak */

struct curvature_range translated_curvatures_at(const struct translated_surface *surface,
                                                double score) {
    double alpha = surface->gaussian.nayak_alpha;
    double sharp = is_surface(surface) ? alpha / (2 * alpha - 3) : alpha / (alpha - 1);
    double centre = score * sqrt((is_surface(surface) ? 3 : 1) / alpha);
    double reach = sqrt(2 * DEPTH / sharp), b = sharp * centre;
    if (centre > 0)
        return (struct curvature_range){fmax(centre - reach, 0), centre + reach};
    return (struct curvature_range){0, 2 * DEPTH / (sqrt(b * b + 2 * sharp * DEPTH) - b)};
}

/* Returns the joint density of height and s at a height, integrated between two values of s. */
static double joint_between(const struct translated_surface *surface, double score,
                            struct curvature_range range, double low, double high) {
    double alpha = surface->gaussian.nayak_alpha, whole = range.high - range.low, sum = 0;
    low = fmax(low, range.low);
    high = fmin(high, range.high);
    double at = low, end;
    while (at < high) {
        struct rule rule;
        end = fmin(at + whole / 8, high);
        rule_fill(&rule, at, end, whole / 64);
        for (size_t q = 0; q < rule.n; q++)
            sum += rule.weight[q] * (is_surface(surface)
                                         ? nayak_joint_pdf(score, -rule.node[q], alpha)
                                         : profile_peak_joint_pdf(score, -rule.node[q], alpha));
        at = end;
    }
    return sum;
}

/* Adds the summits at a value of g, times a weight, to bins of t1, as densities. */
static void curvatures_add(const struct translated_surface *surface, double score, double weight,
                           const struct bins *t1, double *pdf) {
    struct curvature_range range = translated_curvatures_at(surface, score);
    double unit =
        translated_stretch(surface) * translated_heights_at(&surface->heights, score).slope;
    double width = bins_width(t1);
    if (!(unit > 0))
        return;
    for (size_t b = 0; b < t1->count; b++) {
        double high = -(t1->low + (double)b * width) / unit, low = -upper_edge(t1, b) / unit;
        if (high > range.low && low < range.high)
            pdf[b] += weight / width * joint_between(surface, score, range, low, high);
    }
}

static void curvatures_between(const struct translated_surface *surface, double low, double high,
                               double weight, const struct bins *t1, double *pdf) {
    bool in_domain = surface->gaussian.nayak_alpha > alpha_least(surface);
    for (size_t b = 0; b < t1->count; b++)
        pdf[b] = in_domain ? 0 : NAN;
    double at = low, end;
    while (at < high) {
        struct rule rule;
        end = translated_panel_end(surface, at, high);
        rule_fill(&rule, at, end, NARROW);
        for (size_t q = 0; q < rule.n; q++)
            curvatures_add(surface, rule.node[q], weight * rule.weight[q], t1, pdf);
        at = end;
    }
}

void translated_summits_curvatures(const struct translated_surface *surface,
                                   const struct bins *bins, double *pdf) {
    curvatures_between(surface, -SCORE_MOST, SCORE_MOST, 1, bins, pdf);
}

void translated_summits_joint(const struct translated_surface *surface, const struct bins *height,
                              const struct bins *t1, double *pdf) {
    double low = score_of(surface, height->low);
    for (size_t b = 0; b < height->count; b++) {
        double high = score_of(surface, upper_edge(height, b));
        curvatures_between(surface, low, high, 1 / bins_width(height), t1, pdf + b * t1->count);
        low = high;
    }
}
