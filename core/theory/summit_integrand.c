#include "core/theory/summit_integrand.h"
#include <float.h>
#include <gsl/gsl_cdf.h>
#include <math.h>
#include <string.h>

/* A pivot that the ones before it explain to rounding is 0. */
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

/* Rows of the coordinates over the even vector. */
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

void summit_integrand_prepare(struct sampled_field *field, enum summit_curvature curvature,
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

/* Returns the unit normal variable below which lies the share u of its probability between low and
 * high, by which the weight is multiplied. */
static double between(double low, double high, double u, double *weight) {
    bool upper = low > 0; /* is mirrored: lower tails are told to the last digit */
    double a = upper ? -high : low, b = upper ? -low : high;
    double below = normal_below(a), share = normal_below(b) - below;
    if (!(share > 0 && high > low)) {
        *weight = 0;
        return 0;
    }
    *weight *= share;
    /* kept where the quantile is finite */
    double y = gsl_cdf_ugaussian_Pinv(fmin(fmax(below + u * share, DBL_MIN), 1 - 0x1p-53));
    return upper ? -y : y;
}

/* Bounds of one variable by many conditions. */
struct interval {
    double low, high;
};

/* Narrows it to where low < fixed + slope x < high. */
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

/* Conditions of a triangle's variables from `first` on, low < variable < high[a], narrow the unit
 * normal y[at], which is 0 on entry; the others are known. */
static struct interval bounds(const struct triangle *t, size_t at, size_t first, const double *y,
                              const double *low, const double *high) {
    struct interval x = {-INFINITY, INFINITY};
    for (size_t a = first; a < t->n && a < PAIRS_MOST; a++)
        narrow(&x, dot(a + 1, t->root[a], y), t->root[a][at], low[a], high[a]);
    return x;
}

/* On fine grids the diagonals are nearly known from the sides: s of the second one from s of the
 * other three, t of both from t along x and y. What is left of them is drawn first, and the
 * variable before is held by all conditions at once, so that no condition falls like a step. */

/* Draws the unit normals of the even vector of a point behind y[0], fills s of each pair and
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

/* Returns the probability that |t| < s for all pairs, by draws of t along x and of what is left of
 * the diagonals. */
static double weigh_odd(const struct summit_integrand *f, const double *u, const double *s) {
    const struct triangle *t = &f->odd;
    double y[PAIRS_MOST] = {0}, least[PAIRS_MOST] = {0}, weight = 2;
    for (size_t a = 0; a < f->pairs; a++)
        least[a] = -s[a];
    struct interval x = {0, INFINITY}; /* the other half is its mirror image */
    narrow(&x, 0, t->root[0][0], -s[0], s[0]);
    y[0] = between(x.low, x.high, u[0], &weight);
    if (f->pairs == 1)
        return weight;
    for (size_t a = 2; a < f->pairs; a++)
        y[a] = gsl_cdf_ugaussian_Pinv(u[a - 1]);
    x = bounds(t, 1, 1, y, least, s);
    between(x.low, x.high, 0.5, &weight);
    return weight;
}

double summit_integrand_weigh(const struct summit_integrand *f, double lead, const double *u,
                              double *y) {
    double s[PAIRS_MOST] = {0};
    y[0] = lead;
    for (size_t a = 1; a < PAIRS_MOST; a++)
        y[a] = 0;
    double weight = weigh_even(f, u, y, s);
    if (weight > 0)
        weight *= weigh_odd(f, u + UNIFORMS / 2, s);
    return weight * LEAD_MOST * exp(-lead * lead / 2) * 0.39894228040143268;
}
