#include "core/surface/translation/height_function.h"
#include "core/vectors.h"
#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdlib.h>

/* Nodes of the table lie SCORE_STEP apart, up to SCORE_MOST on either side. A Gaussian value lies
 * beyond it once in 10^18. */
enum { NODES_A_UNIT = 256, SCORE_MOST = 9, NODES = 2 * SCORE_MOST * NODES_A_UNIT + 1 };
static const double SCORE_STEP = 1.0 / NODES_A_UNIT;

/* Between nodes f is the cubic of their values and slopes (Hermite), whose error is that of f over
 * four times the step: 1e-12. A cubic is the sum of of[n] t^n with t in [0, 1] from node to node.
 */
struct cubic {
    double of[4];
};
struct height_function {
    double height[NODES], slope[NODES]; /* f and f', at rising scores */
    struct cubic cubics[NODES - 1];
    struct hermite_powers powers;
};

/* Slopes by differences of four values, with an error of the fourth power of this distance. */
static const double DIFFERENCE = 1.0 / 1024;

static double slope_at(const struct heights *heights, const struct height_moments *moments,
                       double score) {
    double near = heights_at_score(heights, moments, score + DIFFERENCE) -
                  heights_at_score(heights, moments, score - DIFFERENCE);
    double far = heights_at_score(heights, moments, score + 2 * DIFFERENCE) -
                 heights_at_score(heights, moments, score - 2 * DIFFERENCE);
    return fmax((8 * near - far) / (12 * DIFFERENCE), 0);
}

static double node_score(size_t node) {
    return (double)node * SCORE_STEP - SCORE_MOST;
}

/* Heights within these scores, of which a share of 6e-5 lies outside, must differ. */
static const double SCORE_USUAL = 4;
static const double SLOPE_LEAST = 1e-12;

static int nodes_fill(struct height_function *function, const struct heights *heights,
                      struct error *err) {
    struct height_moments moments;
    int status = heights_moments(heights, &moments, err);
    if (status != 0)
        return status;
    for (size_t node = 0; node < NODES; node++) {
        double score = node_score(node);
        function->height[node] = heights_at_score(heights, &moments, score);
        function->slope[node] = slope_at(heights, &moments, score);
        if (!isfinite(function->height[node]) || !isfinite(function->slope[node]))
            return error_set(err, ERROR_INPUT,
                             "heights of the law \"translation\" are %g at the score %g; allowed: "
                             "finite and rising",
                             function->height[node], score);
        if (fabs(score) < SCORE_USUAL && !(function->slope[node] > SLOPE_LEAST))
            return error_set(err, ERROR_INPUT,
                             "heights near %.4g standard deviations are equal: the law "
                             "\"translation\" has no summits on flat ground; allowed: heights "
                             "that differ, or the law \"iterated\"",
                             function->height[node]);
    }
    return 0;
}

static void cubics_fill(struct height_function *function) {
    for (size_t node = 0; node + 1 < NODES; node++) {
        double a = function->height[node], b = function->height[node + 1];
        double p = function->slope[node] * SCORE_STEP, q = function->slope[node + 1] * SCORE_STEP;
        function->cubics[node] =
            (struct cubic){{a, p, 3 * (b - a) - 2 * p - q, 2 * (a - b) + p + q}};
    }
}

/* --- Hermite's series --- */

/* Integrals over g by the trapezoidal rule at the nodes. Beyond them the density is below 1e-18. */

/* Adds the nodes' shares of c_n, n from 0. He_n/sqrt(n!) by its recurrence. */
static void coefficients_sum(const struct height_function *function, double c[HERMITE_TERMS + 1]) {
    double root[HERMITE_TERMS + 2];
    for (int n = 0; n < HERMITE_TERMS + 2; n++)
        root[n] = sqrt(n);
    for (size_t node = 0; node < NODES; node++) {
        double g = node_score(node), last = 0, now = 1;
        double weight = SCORE_STEP * exp(-g * g / 2) / sqrt(2 * M_PI) * function->height[node];
        for (int n = 0; n <= HERMITE_TERMS; n++) {
            c[n] += weight * now;
            double next = (g * now - root[n] * last) / root[n + 1];
            last = now;
            now = next;
        }
    }
}

/* The mean of f'^2, and that of f''^2 by differences of the slopes. */
static void derivatives_sum(const struct height_function *function, struct hermite_powers *powers) {
    for (size_t node = 1; node + 1 < NODES; node++) {
        double g = node_score(node);
        double weight = SCORE_STEP * exp(-g * g / 2) / sqrt(2 * M_PI);
        double bend = (function->slope[node + 1] - function->slope[node - 1]) / (2 * SCORE_STEP);
        powers->slope += weight * function->slope[node] * function->slope[node];
        powers->curvature += weight * bend * bend;
    }
}

static void powers_fill(struct height_function *function) {
    struct hermite_powers *powers = &function->powers;
    double c[HERMITE_TERMS + 1] = {0}, all = 0;
    coefficients_sum(function, c);
    for (int n = 1; n <= HERMITE_TERMS; n++) {
        powers->of[n] = c[n] * c[n];
        all += powers->of[n];
    }
    powers->of[HERMITE_TERMS] += fmax(1 - all, 0);
    for (int n = 1; n <= HERMITE_TERMS; n++)
        powers->of[n] /= fmax(all, 1);
    derivatives_sum(function, powers);
}

int height_function_create(struct height_function **out, const struct heights *heights,
                           struct error *err) {
    struct height_function *function = array_create(1, sizeof *function);
    if (function == NULL)
        return error_memory(err, sizeof *function, "a height function");
    int status = nodes_fill(function, heights, err);
    if (status != 0) {
        height_function_destroy(&function);
        return status;
    }
    cubics_fill(function);
    powers_fill(function);
    *out = function;
    return 0;
}

void height_function_destroy(struct height_function **function) {
    free(*function);
    *function = NULL;
}

const struct hermite_powers *height_function_powers(const struct height_function *function) {
    return &function->powers;
}

double hermite_correlation(const struct hermite_powers *powers, double gaussian) {
    double sum = 0;
    for (int n = HERMITE_TERMS; n >= 1; n--)
        sum = (sum + powers->of[n]) * gaussian;
    return sum;
}

/* Sums a batch of lags term by term. Terms count as far as the largest value raises them above
 * rounding. */
enum { BATCH = 64 };
static void batch_beyond(const struct hermite_powers *powers, size_t n, double *values) {
    double sums[BATCH] = {0}, largest = 0;
    for (size_t i = 0; i < n; i++)
        largest = fmax(largest, fabs(values[i]));
    int last = HERMITE_TERMS;
    if (largest < 0.99)
        last = (int)fmin(HERMITE_TERMS, ceil(log(1e-18) / log(fmax(largest, 1e-18))) + 1);
    for (int term = last; term >= 2; term--)
        for (size_t i = 0; i < n; i++)
            sums[i] = (sums[i] + powers->of[term]) * values[i];
    for (size_t i = 0; i < n; i++)
        values[i] *= sums[i];
}

void hermite_correlations_beyond(const struct hermite_powers *powers, size_t n, double *values) {
    for (size_t i = 0; i < n; i += BATCH)
        batch_beyond(powers, n - i < BATCH ? n - i : BATCH, values + i);
}

/* The series rises from 0 to 1 on [0, 1], so that halving finds its inverse. */
double hermite_gaussian_correlation(const struct hermite_powers *powers, double correlation) {
    double low = 0, high = 1;
    if (!(correlation < 1))
        return 1;
    while (high - low > 1e-15) {
        double middle = (low + high) / 2;
        if (hermite_correlation(powers, middle) < correlation)
            low = middle;
        else
            high = middle;
    }
    return (low + high) / 2;
}

/* --- the function --- */

/* Returns the cubic between two nodes, and its slope; t in [0, 1]. */
static struct height_slope cubic(const struct height_function *function, size_t node, double t) {
    const double *of = function->cubics[node].of;
    return (struct height_slope){of[0] + t * (of[1] + t * (of[2] + t * of[3])),
                                 (of[1] + t * (2 * of[2] + t * 3 * of[3])) / SCORE_STEP};
}

/* Beyond the table f goes on along its outermost slopes. */
struct height_slope height_function_at(const struct height_function *function, double gaussian) {
    double at = (gaussian + SCORE_MOST) * NODES_A_UNIT;
    if (at >= 0 && at < NODES - 1) {
        size_t node = (size_t)at;
        return cubic(function, node, at - (double)node);
    }
    size_t node = at < 0 ? 0 : NODES - 1;
    double slope = function->slope[node];
    return (struct height_slope){function->height[node] + slope * (gaussian - node_score(node)),
                                 slope};
}

/* The cubics of neighbours have unlike second derivatives at their node; differences of slopes
 * between nodes, whose error is that of f'' over twice the step, do not. */
double height_function_bend(const struct height_function *function, double gaussian) {
    double at = (gaussian + SCORE_MOST) * NODES_A_UNIT;
    if (!(at >= 1 && at < NODES - 2))
        return 0;
    size_t node = (size_t)at;
    const double *slope = function->slope + node;
    double here = slope[1] - slope[-1], next = slope[2] - slope[0], t = at - (double)node;
    return (here + t * (next - here)) / (2 * SCORE_STEP);
}

/* Returns the node below a height within the table. */
static size_t node_below(const struct height_function *function, double height) {
    size_t low = 0, high = NODES - 1;
    while (high - low > 1) {
        size_t middle = (low + high) / 2;
        if (function->height[middle] <= height)
            low = middle;
        else
            high = middle;
    }
    return low;
}

/* Returns the node below a height within the table, first looking near another one. */
static size_t node_below_near(const struct height_function *function, double height, size_t near) {
    enum { REACH = 8 };
    for (int tries = 0; tries < REACH; tries++) {
        if (height < function->height[near])
            near--;
        else if (height >= function->height[near + 1])
            near++;
        else
            return near;
    }
    return node_below(function, height);
}

/* Returns the score of a height between two nodes, by Newton's steps from the chord. */
static double score_between(const struct height_function *function, size_t node, double height) {
    double a = function->height[node], b = function->height[node + 1];
    double low = 0, high = 1, t = b > a ? (height - a) / (b - a) : 0.5, step = 1;
    for (int tries = 0; tries < 60 && fabs(step) > 1e-14; tries++) {
        struct height_slope at = cubic(function, node, t);
        if (at.height <= height)
            low = t;
        else
            high = t;
        double newton = t - (at.height - height) / (at.slope * SCORE_STEP);
        double next = newton >= low && newton <= high ? newton : (low + high) / 2;
        step = next - t;
        t = next;
    }
    return node_score(node) + t * SCORE_STEP;
}

/* As height_function_inverse. *node, below NODES - 1, is where a search starts, and is left where
 * it ends. */
static double inverse_near(const struct height_function *function, double height, size_t *node) {
    size_t last = NODES - 1;
    if (!(height > function->height[0] && height < function->height[last])) {
        size_t end = height <= function->height[0] ? 0 : last;
        double beyond = height - function->height[end], slope = function->slope[end];
        return node_score(end) + (slope > SLOPE_LEAST ? beyond / slope : 0);
    }
    *node = node_below_near(function, height, *node);
    return score_between(function, *node, height);
}

double height_function_inverse(const struct height_function *function, double height) {
    size_t node = NODES / 2;
    return inverse_near(function, height, &node);
}

/* Replaces values within the table. */
WIDE_VECTORS static void within_apply(const double *restrict cubics, double factor, size_t n,
                                      double *restrict z) {
    for (size_t i = 0; i < n; i++) {
        double at = (z[i] + SCORE_MOST) * NODES_A_UNIT;
        int node = (int)at;
        double t = at - node;
        const double *of = cubics + 4 * node;
        z[i] = factor * (of[0] + t * (of[1] + t * (of[2] + t * of[3])));
    }
}

/* Returns whether all values lie within the table. */
WIDE_VECTORS static bool all_within(size_t n, const double *z) {
    int64_t outside = 0;
    for (size_t i = 0; i < n; i++)
        outside |= -(int64_t) !(fabs(z[i]) < SCORE_MOST);
    return outside == 0;
}

void height_function_apply(const struct height_function *function, double factor, size_t n,
                           double *z) {
    for (size_t first = 0; first < n; first += BATCH) {
        size_t count = n - first < BATCH ? n - first : BATCH;
        if (all_within(count, z + first))
            within_apply(function->cubics[0].of, factor, count, z + first);
        else
            for (size_t i = first; i < first + count; i++)
                z[i] = factor * height_function_at(function, z[i]).height;
    }
}

void height_function_undo(const struct height_function *function, double factor, size_t n,
                          double *z) {
    size_t node = NODES / 2;
    for (size_t i = 0; i < n; i++)
        z[i] = inverse_near(function, z[i] / factor, &node);
}
