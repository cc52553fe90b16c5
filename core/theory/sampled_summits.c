#include "core/theory/sampled_summits.h"
#include "core/random.h"
#include "core/statistics/summits/summits.h"
#include "core/theory/height_cells.h"
#include "core/theory/quadrature.h"
#include "core/theory/sampled_field.h"
#include <float.h>
#include <gsl/gsl_cdf.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* The integrand of sampled_summits.h, over the Gaussian vectors of a point and its neighbours
 * (sampled_field.h) for which the point is a summit.
 *
 * The even vector is transformed to other coordinates. The first is the curvature by differences,
 * which is positive at a summit; then s along x, which it bounds (s along y is the rest of the
 * curvature); then s along the diagonals. */

/* A lower triangle such that root root' is a covariance. A pivot that is 0 but for rounding, given
 * the pivots before it, is set to 0: such a variable follows from those before. */
struct triangle {
    size_t n;
    double root[PAIRS_MOST][PAIRS_MOST];
};

/* A Gaussian variable as a linear function of the unit normals of a triangle, plus an independent
 * normal variable. */
struct regression {
    double slope[PAIRS_MOST];
    double variance; /* of the independent variable */
};

static inline double regression_value(const struct regression *regression, const double *y) {
    double sum = 0;
    for (size_t a = 0; a < PAIRS_MOST; a++)
        sum += regression->slope[a] * y[a];
    return sum;
}

/* The data of the integrand. */
struct summit_integrand {
    size_t pairs;
    double bend[2];
    struct triangle even, odd;
    struct regression height, curvature; /* of z* and of kappa_m/sqrt(m4) */
    double common; /* covariance of the independent parts of height and curvature */
    const struct translated_surface *translated; /* borrowed; NULL: none */
};

/* A point and its neighbours: s of each pair; t along x, and two values of t along y that stand for
 * all with the others, where the surface is translated. */
struct neighbours {
    double s[PAIRS_MOST];
    double t_x, t_y[2];
};

/* The curvature by differences runs from 0 to this many of its deviations, beyond which exp(-36) of
 * the density remains. */
#define LEAD_MOST 8.5
enum { UNIFORMS = 2 * PAIRS_MOST - 2 }; /* dimensions beside that of the curvature */

/* A pivot that is 0 but for rounding, given the ones before it, is set to 0. */
static const double EXPLAINED = 1e-13; /* of a variance, by the variables before */

static void triangle_fill(size_t n, double covariance[PAIRS_MOST][PAIRS_MOST],
                          struct triangle *out) {
    *out = (struct triangle){.n = n};
    for (size_t a = 0; a < n; a++)
        for (size_t b = 0; b <= a; b++) {
            double rest = covariance[a][b];
            for (size_t c = 0; c < b; c++)
                rest -= out->root[a][c] * out->root[b][c];
            if (a == b)
                out->root[a][a] = rest > EXPLAINED * covariance[a][a] ? sqrt(rest) : 0;
            else
                out->root[a][b] = out->root[b][b] > 0 ? rest / out->root[b][b] : 0;
        }
}

static struct regression regress(const struct triangle *t, const double *covariance,
                                 double variance) {
    struct regression out = {.variance = variance};
    for (size_t a = 0; a < t->n; a++) {
        double rest = covariance[a];
        for (size_t c = 0; c < a; c++)
            rest -= out.slope[c] * t->root[a][c];
        out.slope[a] = t->root[a][a] > 0 ? rest / t->root[a][a] : 0;
        out.variance -= out.slope[a] * out.slope[a];
    }
    out.variance = fmax(out.variance, 0);
    return out;
}

static double dot(size_t n, const double *a, const double *b) {
    double sum = 0;
    for (size_t c = 0; c < n; c++)
        sum += a[c] * b[c];
    return sum;
}

/* Expresses the coordinates by the even vector, a row each. */
static void coordinates_fill(const struct sampled_field *field,
                             double rows[PAIRS_MOST][EVEN_MOST]) {
    memset(rows, 0, sizeof(double[PAIRS_MOST][EVEN_MOST]));
    rows[0][0] = field->bend[0];
    if (field->pairs > 1) {
        rows[0][1] = field->bend[1];
        rows[1][0] = 1;
    }
    for (size_t a = 2; a < field->pairs; a++)
        rows[a][a] = 1;
}

static void summit_integrand_prepare(struct sampled_field *field, enum summit_curvature curvature,
                                     struct summit_integrand *out) {
    size_t n = field->pairs, all = n + 2;
    double rows[PAIRS_MOST][EVEN_MOST], half[PAIRS_MOST][EVEN_MOST];
    double covariance[PAIRS_MOST][PAIRS_MOST], heights[PAIRS_MOST] = {0};
    double curvatures[PAIRS_MOST] = {0};
    coordinates_fill(field, rows);
    for (size_t a = 0; a < n; a++)
        for (size_t b = 0; b < all; b++)
            half[a][b] = dot(all, rows[a], field->even[b]);
    for (size_t a = 0; a < n; a++) {
        for (size_t b = 0; b < n; b++)
            covariance[a][b] = dot(all, half[a], rows[b]);
        heights[a] = half[a][n];
        curvatures[a] = half[a][n + 1];
    }
    *out = (struct summit_integrand){.pairs = n, .bend = {field->bend[0], field->bend[1]}};
    triangle_fill(n, covariance, &out->even);
    triangle_fill(n, field->odd, &out->odd);
    out->height = regress(&out->even, heights, field->even[n][n]);
    if (curvature == CURVATURE_FINITE_DIFFERENCE) {
        out->curvature.slope[0] = out->even.root[0][0];
        return;
    }
    out->curvature = regress(&out->even, curvatures, field->even[n + 1][n + 1]);
    out->common = field->even[n][n + 1] - dot(n, out->height.slope, out->curvature.slope);
}

/* --- the integrand --- */

static double normal_below(double x) {
    return erfc(-x / M_SQRT2) / 2;
}

/* Returns the unit normal variable at the share u of its probability between low and high, and
 * multiplies the weight by that probability. */
static double between(double low, double high, double u, double *weight) {
    bool upper = low > 0; /* mirrored: lower tails are accurate to the last digit */
    double a = upper ? -high : low, b = upper ? -low : high;
    double below = normal_below(a), share = normal_below(b) - below;
    if (!(share > 0 && high > low)) {
        *weight = 0;
        return 0;
    }
    *weight *= share;
    /* limited to where the quantile is finite */
    double y = gsl_cdf_ugaussian_Pinv(fmin(fmax(below + u * share, DBL_MIN), 1 - 0x1p-53));
    return upper ? -y : y;
}

/* Bounds of one variable by several conditions. */
struct interval {
    double low, high;
};

/* Narrows the interval to where low < fixed + slope x < high. */
static void narrow(struct interval *x, double fixed, double slope, double low, double high) {
    if (slope == 0) {
        if (!(fixed > low && fixed < high))
            x->high = -INFINITY;
        return;
    }
    double one = (low - fixed) / slope, other = (high - fixed) / slope;
    x->low = fmax(x->low, fmin(one, other));
    x->high = fmin(x->high, fmax(one, other));
}

/* Returns the interval of the unit normal y[at], which is 0 on entry, in which a triangle's
 * variables from `first` on satisfy low[a] < variable < high[a]; the others are known. */
static struct interval bounds(const struct triangle *t, size_t at, size_t first, const double *y,
                              const double *low, const double *high) {
    struct interval x = {-INFINITY, INFINITY};
    for (size_t a = first; a < t->n && a < PAIRS_MOST; a++)
        narrow(&x, dot(a + 1, t->root[a], y), t->root[a][at], low[a], high[a]);
    return x;
}

/* On fine grids the diagonals follow nearly from the sides: s of the second one from s of the other
 * three, t of both from t along x and y. Their independent parts are drawn first. All conditions
 * then bound the variable before at once, so that no condition is a step. */

/* Draws the unit normals of the even vector of a point from y[1] on, fills s of each pair and
 * returns the weight. */
static double weigh_even(const struct summit_integrand *f, const double *u, double *y, double *s) {
    static const double LEAST[PAIRS_MOST] = {0, 0, 0, 0};
    static const double MOST[PAIRS_MOST] = {INFINITY, INFINITY, INFINITY, INFINITY};
    double curvature = y[0] * f->even.root[0][0], weight = 1;
    s[0] = curvature / f->bend[0];
    if (f->pairs == 1)
        return weight;
    struct interval x = {-INFINITY, INFINITY};
    narrow(&x, f->even.root[1][0] * y[0], f->even.root[1][1], 0, s[0]);
    y[1] = between(x.low, x.high, u[0], &weight);
    s[0] = dot(2, f->even.root[1], y);
    s[1] = (curvature - f->bend[0] * s[0]) / f->bend[1];
    if (f->pairs == PAIRS_NINE_POINT) {
        y[3] = gsl_cdf_ugaussian_Pinv(u[1]);
        x = bounds(&f->even, 2, 2, y, LEAST, MOST);
        y[2] = between(x.low, x.high, u[2], &weight);
        for (size_t a = 2; a < f->pairs; a++)
            s[a] = dot(a + 1, f->even.root[a], y);
    }
    return weight;
}

/* Gauss and Legendre's rule of two points on [0, 1]. */
static const double HALVES[2] = {0.21132486540518712, 0.78867513459481288};

/* Returns the probability that |t| < s for all pairs, by draws of t along x and of the independent
 * parts of the diagonals. */
static double weigh_odd(const struct summit_integrand *f, const double *u, struct neighbours *n) {
    const double *s = n->s;
    const struct triangle *t = &f->odd;
    double y[PAIRS_MOST] = {0}, least[PAIRS_MOST] = {0}, weight = 2;
    for (size_t a = 0; a < f->pairs; a++)
        least[a] = -s[a];
    struct interval x = {0, INFINITY}; /* the other half is its mirror image */
    narrow(&x, 0, t->root[0][0], -s[0], s[0]);
    y[0] = between(x.low, x.high, u[0], &weight);
    n->t_x = t->root[0][0] * y[0];
    if (f->pairs == 1)
        return weight;
    for (size_t a = 2; a < f->pairs; a++)
        y[a] = gsl_cdf_ugaussian_Pinv(u[a - 1]);
    x = bounds(t, 1, 1, y, least, s);
    for (size_t half = 0; half < 2 && f->translated != NULL; half++) {
        double share = 1;
        y[1] = between(x.low, x.high, HALVES[half], &share);
        n->t_y[half] = dot(2, t->root[1], y);
    }
    between(x.low, x.high, 0.5, &weight);
    return weight;
}

/* Fills the unit normals y[PAIRS_MOST] of the even vector of a point, whose curvature by
 * differences is lead of its deviations, and its neighbours, and returns its weight. The mean of
 * weights over lead, evenly from 0 to LEAD_MOST, and over u, evenly in the unit cube, is the share
 * of points that are summits. u[UNIFORMS] lies inside (0, 1). */
static double summit_integrand_weigh(const struct summit_integrand *f, double lead, const double *u,
                                     double *y, struct neighbours *neighbours) {
    *neighbours = (struct neighbours){0};
    y[0] = lead;
    for (size_t a = 1; a < PAIRS_MOST; a++)
        y[a] = 0;
    double weight = weigh_even(f, u, y, neighbours->s);
    if (weight > 0)
        weight *= weigh_odd(f, u + UNIFORMS / 2, neighbours);
    return weight * LEAD_MOST * exp(-lead * lead / 2) * 0.39894228040143268;
}

/* --- curvature of translated surfaces --- */

/* Returns the curvature by differences of a translated surface in sqrt(m4) of z, where its field
 * has the height and neighbours: the mean over t along y. */
static double translated_curvature(const struct summit_integrand *f, double height,
                                   const struct neighbours *n) {
    const struct translated_heights *heights = &f->translated->heights;
    double top = translated_heights_at(heights, height).height, side = height - n->s[0];
    double sum = f->bend[0] * (top - (translated_heights_at(heights, side + n->t_x).height +
                                      translated_heights_at(heights, side - n->t_x).height) /
                                         2);
    side = height - n->s[1];
    for (size_t half = 0; half < 2 && f->pairs > 1; half++) {
        double across = translated_heights_at(heights, side + n->t_y[half]).height +
                        translated_heights_at(heights, side - n->t_y[half]).height;
        sum += f->bend[1] / 2 * (top - across / 2);
    }
    return sum * translated_stretch(f->translated);
}

/* Mean curvatures at levels of the height of the field: the weight of summits at each, and that
 * times their curvature, up to a factor. All points with means of heights near a level count there,
 * so that curvatures rise smoothly from level to level. */
enum { LEVELS = 49 };
static const double LEVEL_STEP = 0.5, LEVEL_FIRST = -12;
struct levels {
    double weight[LEVELS], moment[LEVELS];
};

/* Levels within so many deviations of a mean count. A field whose heights follow from their
 * neighbours has some deviation, too. */
static const double ASIDE = 5, DEVIATION_LEAST = 0.05;

static void levels_add(const struct summit_integrand *f, double mean,
                       const struct neighbours *neighbours, double weight, struct levels *levels) {
    double deviation = fmax(sqrt(f->height.variance), DEVIATION_LEAST);
    double from = (mean - ASIDE * deviation - LEVEL_FIRST) / LEVEL_STEP;
    double to = (mean + ASIDE * deviation - LEVEL_FIRST) / LEVEL_STEP;
    size_t last = (size_t)fmin(fmax(floor(to), 0), LEVELS - 1);
    for (size_t level = (size_t)fmin(fmax(ceil(from), 0), LEVELS); level <= last; level++) {
        double height = LEVEL_FIRST + LEVEL_STEP * (double)level, x = (height - mean) / deviation;
        double part = weight * exp(-x * x / 2);
        levels->weight[level] += part;
        levels->moment[level] += part * translated_curvature(f, height, neighbours);
    }
}

static double levels_mean(const struct levels *levels) {
    double weight = 0, moment = 0;
    for (size_t level = 0; level < LEVELS; level++) {
        weight += levels->weight[level];
        moment += levels->moment[level];
    }
    return moment / weight;
}

/* Near the bound of the heights f is flat to its last digit: curvatures below are of no account. */
static const double CURVATURE_LEAST = 1e-14;

/* Returns the weight and the mean curvature at a height by cubics of their logarithms at four
 * levels; both are near to those of normal densities. Where a level has no summit the weight is 0.
 */
static struct level_values {
    double weight, curvature;
} levels_at(const struct levels *levels, double height) {
    double at = fmin(fmax((height - LEVEL_FIRST) / LEVEL_STEP, 1), LEVELS - 2.001);
    size_t first = (size_t)at - 1;
    double t = at - floor(at), weight = 0, curvature = 0;
    const double parts[4] = {-t * (t - 1) * (t - 2) / 6, (t + 1) * (t - 1) * (t - 2) / 2,
                             -(t + 1) * t * (t - 2) / 2, (t + 1) * t * (t - 1) / 6};
    for (size_t a = 0; a < 4; a++) {
        double of = levels->weight[first + a];
        if (!(of > 0))
            return (struct level_values){0, NAN};
        weight += parts[a] * log(of);
        curvature += parts[a] * log(fmax(levels->moment[first + a] / of, CURVATURE_LEAST));
    }
    return (struct level_values){exp(weight), exp(curvature)};
}

/* Returns the mean curvature between two heights of the field; NaN where there is no summit. */
static double levels_between(const struct levels *levels, double low, double high) {
    double weight = 0, moment = 0;
    low = fmax(low, LEVEL_FIRST);
    high = fmin(high, -LEVEL_FIRST);
    size_t panels = (size_t)fmax(ceil((high - low) / LEVEL_STEP), 1);
    double half = (high - low) / (2 * (double)panels);
    for (size_t panel = 0; panel < panels; panel++)
        for (size_t q = 0; q < GAUSS_4; q++) {
            double height = low + half * ((double)(2 * panel + 1) + GAUSS_4_NODES[q]);
            struct level_values at = levels_at(levels, height);
            double part = GAUSS_4_WEIGHTS[q] * at.weight;
            if (!(part > 0))
                continue;
            weight += part;
            moment += part * at.curvature;
        }
    return moment / weight;
}

/* --- sums over a lattice --- */

/* A lattice rule: point n is at the fractional parts of n times these steps, and 1 for the
 * curvature. The steps are chosen component by component (Sloan & Reztsov 2002) for smooth periodic
 * functions; folding makes other functions periodic. Independent shifts estimate the error: 2e-4 of
 * the density of nine-point summits, 1e-6 of others. */
enum { SHIFTS_MOST = 8, LATTICE_SEED = 1, LATTICE_POINTS = 16381, PROFILE_POINTS = 2039 };
static const unsigned STEPS[UNIFORMS] = {3711, 5711, 3321, 7766, 7145, 6041};
static size_t shift_count(size_t pairs) {
    return pairs == PAIRS_NINE_POINT ? SHIFTS_MOST : 2;
}

/* Curvatures of translated surfaces, which are dear and smooth, are summed on each so many shifts:
 * their error is 2e-4. */
enum { SHIFTS_A_LEVEL = 4 };

/* Profiles have an integral over one line. */
static size_t point_count(size_t pairs) {
    return pairs == PAIRS_PROFILE ? PROFILE_POINTS : LATTICE_POINTS;
}

struct lattice_sums {
    double weight, curvature, height[4]; /* weight times curvature, means of heights to a power */
    double shifted[SHIFTS_MOST];         /* weight of each shift */
    double *cells, *moments;             /* owned, HEIGHT_CELLS each; NULL: not wanted */
    struct levels levels;                /* of a translated surface: its curvature */
    double *t1;                          /* of the caller; NULL: not wanted */
    double *joint;                       /* owned, HEIGHT_CELLS of each bin of t1; NULL */
};

/* Adds a weight that is evenly distributed over an interval of t1 to the bins under it: to
 * counts[b], or to heights with this mean in the cells of bin b. */
static void add_t1(const struct bins *bins, double low, double high, double weight, double *counts,
                   double *joint, double mean) {
    double width = bins_width(bins), from = (low - bins->low) / width;
    double to = (high - bins->low) / width, span = to - from;
    size_t last = (size_t)fmin(fmax(ceil(to), 0), (double)bins->count);
    for (size_t b = (size_t)fmin(fmax(from, 0), (double)bins->count); b < last; b++) {
        double share = span > 0 ? (fmin(to, (double)b + 1) - fmax(from, (double)b)) / span : 1;
        if (counts != NULL)
            counts[b] += weight * share;
        if (joint != NULL)
            height_cells_add(joint + b * HEIGHT_CELLS, mean, weight * share);
    }
}

/* Gauss and Hermite's rule for a unit normal. */
enum { HERMITE = 5 };
static const double HERMITE_NODES[HERMITE] = {-2.8569700138728056, -1.3556261799742659, 0,
                                              1.3556261799742659, 2.8569700138728056};
static const double HERMITE_WEIGHTS[HERMITE] = {0.011257411327720689, 0.22207592200561266,
                                                0.53333333333333333, 0.22207592200561266,
                                                0.011257411327720689};

/* Returns the regression of height on the part of the curvature that is independent of the even
 * vector. */
static double height_by_curvature(const struct summit_integrand *f) {
    return f->curvature.variance > 0 ? f->common / f->curvature.variance : 0;
}

static void add_curvatures(const struct summit_integrand *f, const struct bins *t1, double height,
                           double curvature, double interval, double weight,
                           struct lattice_sums *sums) {
    double factor = f->pairs == PAIRS_PROFILE ? 1 : sqrt(3), half = factor * interval / 2;
    double deviation = sqrt(f->curvature.variance);
    for (size_t node = 0; node < HERMITE; node++) {
        bool single = deviation == 0;
        double rest = single ? 0 : deviation * HERMITE_NODES[node];
        double at = -factor * (curvature + rest);
        add_t1(t1, at - half, at + half, weight * (single ? 1 : HERMITE_WEIGHTS[node]), sums->t1,
               sums->joint, height + height_by_curvature(f) * rest);
        if (single)
            break;
    }
}

static void add_point(const struct summit_integrand *f, const struct bins *t1, const double *y,
                      double interval, double weight, struct lattice_sums *sums) {
    double height = regression_value(&f->height, y);
    double curvature = regression_value(&f->curvature, y), power = weight;
    sums->weight += weight;
    if (sums->cells != NULL)
        height_cells_add(sums->cells, height, weight);
    if (f->translated != NULL)
        return;
    sums->curvature += weight * curvature;
    for (size_t n = 0; n < 4; n++)
        sums->height[n] += power *= height;
    if (sums->moments != NULL)
        height_cells_add(sums->moments, height, weight * curvature);
    if (sums->t1 != NULL || sums->joint != NULL)
        add_curvatures(f, t1, height, curvature, interval * fabs(f->curvature.slope[0]), weight,
                       sums);
}

/* Curvatures by differences rise in equal steps, so that each bin of t1 gets as many points as the
 * next. The other coordinates are those of a lattice, folded to make the integrand periodic. */
static void integrate(const struct summit_integrand *f, const struct bins *t1,
                      struct lattice_sums *sums) {
    const size_t points = point_count(f->pairs);
    const double interval = LEAD_MOST / (double)points;
    for (size_t shift = 0; shift < shift_count(f->pairs); shift++) {
        double random[UNIFORMS + 1], u[UNIFORMS], y[PAIRS_MOST] = {0};
        struct neighbours neighbours;
        double before = sums->weight;
        random_uniform((struct random_key){LATTICE_SEED, 0, shift}, STREAM_PHASES, 0, UNIFORMS + 1,
                       random);
        for (size_t n = 0; n < points; n++) {
            for (size_t a = 0; a < UNIFORMS; a++) {
                double position = (double)n * STEPS[a] / (double)points + random[a];
                u[a] = fmin(fmax(fabs(2 * (position - floor(position)) - 1), 1e-15), 1 - 1e-15);
            }
            double lead = interval * ((double)n + random[UNIFORMS]);
            double weight = summit_integrand_weigh(f, lead, u, y, &neighbours);
            if (weight > 0)
                add_point(f, t1, y, interval, weight, sums);
            if (weight > 0 && f->translated != NULL && shift % SHIFTS_A_LEVEL == 0)
                levels_add(f, regression_value(&f->height, y), &neighbours, weight, &sums->levels);
        }
        sums->shifted[shift] = sums->weight - before;
    }
}

/* --- results --- */

static double relative_error(const struct lattice_sums *sums, size_t shifts) {
    double n = (double)shifts, mean = sums->weight / n, squares = 0;
    for (size_t shift = 0; shift < shifts; shift++)
        squares += (sums->shifted[shift] - mean) * (sums->shifted[shift] - mean);
    return sqrt(squares / (n * (n - 1))) / mean;
}

/* Heights are their means, with these moments, plus an independent normal variable. */
static void moments_take(const struct lattice_sums *sums, double rest,
                         struct sampled_summits *out) {
    double m[4];
    for (size_t n = 0; n < 4; n++)
        m[n] = sums->height[n] / sums->weight;
    double second = m[1] - m[0] * m[0];
    double third = m[2] - 3 * m[0] * m[1] + 2 * m[0] * m[0] * m[0];
    double fourth = m[3] - 4 * m[0] * m[2] + 6 * m[0] * m[0] * m[1] - 3 * m[0] * m[0] * m[0] * m[0];
    double variance = second + rest;
    out->height_mean = m[0];
    out->height_variance = variance;
    out->height_skewness = third / (variance * sqrt(variance));
    out->height_kurtosis = (fourth + 6 * rest * second + 3 * rest * rest) / (variance * variance);
}

/* A rule for a unit normal variable within RULE_MOST of its deviations. */
enum { RULE_PANELS = 4, RULE = RULE_PANELS * QUADRATURE_NODES };
static const double RULE_MOST = 8;
struct normal_rule {
    double node[RULE], weight[RULE];
};

static void normal_rule_fill(struct normal_rule *rule) {
    for (size_t panel = 0; panel < RULE_PANELS; panel++) {
        size_t first = panel * QUADRATURE_NODES;
        double length = 2 * RULE_MOST / RULE_PANELS, low = (double)panel * length - RULE_MOST;
        quadrature_panel(low, low + length, rule->node + first, rule->weight + first);
    }
    for (size_t q = 0; q < RULE; q++)
        rule->weight[q] *= exp(-rule->node[q] * rule->node[q] / 2) * 0.39894228040143268;
}

/* Replaces the sums of heights of the Gaussian field, which are normal about the means in the
 * cells, by those of the surface. */
static void heights_translate(const struct translated_heights *translated, double variance,
                              struct lattice_sums *sums) {
    struct normal_rule rule;
    double deviation = height_cells_deviation(variance);
    normal_rule_fill(&rule);
    for (size_t n = 0; n < 4; n++)
        sums->height[n] = 0;
    for (size_t cell = 0; cell < HEIGHT_CELLS; cell++) {
        if (sums->cells[cell] == 0)
            continue;
        for (size_t q = 0; q < RULE; q++) {
            double score = height_cells_mean(cell) + deviation * rule.node[q];
            double height = translated_heights_at(translated, score).height;
            double power = sums->cells[cell] * rule.weight[q];
            for (size_t n = 0; n < 4; n++)
                sums->height[n] += power *= height;
        }
    }
}

/* With less than this share of all summits, a bin reports no mean curvature. */
static const double SHARE_LEAST = 1e-14;

static int heights_take(const struct summit_integrand *f, const struct lattice_sums *sums,
                        const struct sampled_bins *bins, struct error *err) {
    size_t edges = bins->height->count + 1;
    double *room = array_create(edges, 4 * sizeof *room), width = bins_width(bins->height);
    if (room == NULL)
        return error_memory(err, edges * 4 * sizeof *room, "bins of theory");
    struct height_edges out = {room, room + edges, room + 2 * edges, room + 3 * edges, NULL};
    double rest = f->height.variance;
    int status = height_cells_spread(sums->cells, sums->moments, rest,
                                     rest > 0 ? f->common / rest : 0, bins->height, &out, err);
    for (size_t b = 0; b + 1 < edges && status == 0; b++) {
        double weight = height_edges_within(out.below, out.above, b);
        bool lower = out.below[b] < out.above[b + 1];
        double moment = lower ? out.below_moment[b + 1] - out.below_moment[b]
                              : out.above_moment[b] - out.above_moment[b + 1];
        bins->pdf[b] = weight / sums->weight / width;
        bins->cdf[b] = fmin(out.below[b + 1] / sums->weight, 1);
        if (bins->curvature != NULL)
            bins->curvature[b] =
                weight > SHARE_LEAST * sums->weight ? moment / weight : (double)NAN;
    }
    free(room);
    return status;
}

/* Fills the same of a translated surface, whose edges of bins are heights of the field. */
static int translated_take(const struct summit_integrand *f, const struct lattice_sums *sums,
                           const struct sampled_bins *bins,
                           const struct translated_heights *heights, struct error *err) {
    size_t edges = bins->height->count + 1;
    double *room = array_create(edges, 3 * sizeof *room), width = bins_width(bins->height);
    if (room == NULL)
        return error_memory(err, edges * 3 * sizeof *room, "bins of theory");
    double *at = room + 2 * edges;
    const struct height_edges out = {.below = room, .above = room + edges, .at = at};
    for (size_t b = 0; b < edges; b++)
        at[b] = translated_heights_inverse(heights, bins->height->low + (double)b * width);
    int status =
        height_cells_spread(sums->cells, NULL, f->height.variance, 0, bins->height, &out, err);
    for (size_t b = 0; b + 1 < edges && status == 0; b++) {
        double weight = height_edges_within(out.below, out.above, b);
        bins->pdf[b] = weight / sums->weight / width;
        bins->cdf[b] = fmin(out.below[b + 1] / sums->weight, 1);
        if (bins->curvature == NULL)
            continue;
        bool known = f->translated != NULL && weight > SHARE_LEAST * sums->weight;
        bins->curvature[b] = known ? levels_between(&sums->levels, at[b], at[b + 1]) : (double)NAN;
    }
    free(room);
    return status;
}

static int joint_take(const struct summit_integrand *f, const struct lattice_sums *sums,
                      const struct sampled_bins *bins, struct error *err) {
    size_t edges = bins->height->count + 1, columns = bins->t1->count;
    double *room = array_create(edges, 2 * sizeof *room);
    if (room == NULL)
        return error_memory(err, edges * 2 * sizeof *room, "bins of theory");
    struct height_edges out = {.below = room, .above = room + edges};
    double rest = fmax(f->height.variance - f->common * height_by_curvature(f), 0);
    double cell = bins_width(bins->height) * bins_width(bins->t1) * sums->weight;
    int status = 0;
    for (size_t column = 0; column < columns && status == 0; column++) {
        status = height_cells_spread(sums->joint + column * HEIGHT_CELLS, NULL, rest, 0,
                                     bins->height, &out, err);
        for (size_t b = 0; b + 1 < edges && status == 0; b++)
            bins->joint[b * columns + column] = height_edges_within(out.below, out.above, b) / cell;
    }
    free(room);
    return status;
}

static int take(const struct summit_integrand *f, const struct sampled_surface *surface,
                struct lattice_sums *sums, const struct sampled_bins *bins,
                struct sampled_summits *out, struct error *err) {
    const struct grid *grid = &surface->modes->grid;
    const struct translated_surface *translated = surface->translated;
    int status = 0;
    if (bins != NULL && bins->pdf != NULL)
        status = translated != NULL ? translated_take(f, sums, bins, &translated->heights, err)
                                    : heights_take(f, sums, bins, err);
    if (bins != NULL && sums->joint != NULL && status == 0)
        status = joint_take(f, sums, bins, err);
    if (status != 0)
        return status;
    for (size_t b = 0; bins != NULL && sums->t1 != NULL && b < bins->t1->count; b++)
        sums->t1[b] /= sums->weight * bins_width(bins->t1);
    double points = (double)(shift_count(f->pairs) * point_count(f->pairs));
    double area = grid_is_profile(grid) ? grid_dx(grid) : grid_dx(grid) * grid_dy(grid);
    out->density = sums->weight / points / area;
    out->density_error = relative_error(sums, shift_count(f->pairs));
    out->curvature = sums->curvature / sums->weight;
    if (translated != NULL) /* of exact derivatives there is none */
        out->curvature = f->translated != NULL ? levels_mean(&sums->levels) : (double)NAN;
    if (translated != NULL)
        heights_translate(&translated->heights, f->height.variance, sums);
    moments_take(sums, translated != NULL ? 0 : f->height.variance, out);
    return 0;
}

/* Of a translated surface the means of heights are counted in cells in any case, those of
 * curvatures are not. */
static int sums_create(struct lattice_sums *sums, const struct sampled_surface *surface,
                       const struct sampled_bins *bins, struct error *err) {
    bool gaussian = surface->translated == NULL && bins != NULL;
    size_t cells = surface->translated != NULL ? 1 : gaussian && bins->pdf != NULL ? 2 : 0;
    size_t joint = gaussian && bins->joint != NULL ? bins->t1->count : 0;
    size_t bytes = (cells + joint) * HEIGHT_CELLS * sizeof(double);
    *sums = (struct lattice_sums){.t1 = gaussian ? bins->t1_pdf : NULL};
    if (sums->t1 != NULL)
        memset(sums->t1, 0, bins->t1->count * sizeof *sums->t1);
    if (cells != 0)
        sums->cells = array_create(cells * HEIGHT_CELLS, sizeof *sums->cells);
    if (joint != 0)
        sums->joint = array_create(joint * HEIGHT_CELLS, sizeof *sums->joint);
    if ((cells != 0 && sums->cells == NULL) || (joint != 0 && sums->joint == NULL))
        return error_memory(err, bytes, "sums of theory");
    sums->moments = cells > 1 ? sums->cells + HEIGHT_CELLS : NULL;
    return 0;
}

int sampled_summits(const struct sampled_surface *surface, struct sampled_summits *out,
                    const struct sampled_bins *bins, struct error *err) {
    struct sampled_field field;
    struct summit_integrand f;
    struct lattice_sums sums;
    size_t pairs = grid_is_profile(&surface->modes->grid)   ? PAIRS_PROFILE
                   : surface->stencil == SUMMITS_NINE_POINT ? PAIRS_NINE_POINT
                                                            : PAIRS_FIVE_POINT;
    if (surface->stencil == SUMMITS_REFINED)
        return error_set(err, ERROR_INPUT,
                         "refined summits are not those of a grid; allowed: "
                         "nine-point and five-point ones");
    int status = sampled_field_fill(surface->modes, surface->moments, pairs, &field, err);
    if (status != 0)
        return status;
    summit_integrand_prepare(&field, surface->curvature, &f);
    if (surface->curvature == CURVATURE_FINITE_DIFFERENCE)
        f.translated = surface->translated;
    status = sums_create(&sums, surface, bins, err);
    if (status == 0) {
        integrate(&f, bins != NULL ? bins->t1 : NULL, &sums);
        status = take(&f, surface, &sums, bins, out, err);
    }
    free(sums.cells);
    free(sums.joint);
    return status;
}
