#include "core/surface/translation/translation.h"
#include "core/surface/moments.h"
#include "core/surface/spectrum_density.h"
#include "core/surface/translation/radial.h"
#include <math.h>
#include <stdlib.h>

struct translation {
    int dimension;
    struct height_function *function; /* owned */
    size_t nodes;                     /* 0: an exponential autocorrelation */
    double *k;                        /* rising; owned, as the factors */
    double *factor;
    struct translation_fit fit;
};

/* --- the nodes of the band --- */

/* Evenly in log |k|; a roll-off, where the density bends, lies on a node. */
enum { NODES = 97, NODES_LEAST = 9 };

static void nodes_between(double low, double high, size_t n, double *k) {
    for (size_t a = 0; a < n; a++)
        k[a] = low * pow(high / low, (double)a / (double)(n - 1));
    k[n - 1] = high;
}

/* Returns the number of nodes of the plateau; 1 where there is none. */
static size_t plateau_nodes(const struct spectrum *spectrum, double low, double high) {
    double bend = 2 * M_PI / spectrum->wavelength_rolloff;
    if (spectrum->type != SPECTRUM_SELF_AFFINE || !(bend > low * 1.001 && bend < high / 1.001))
        return 1;
    double part = log(bend / low) / log(high / low) * NODES;
    return (size_t)fmin(fmax(part, NODES_LEAST), NODES - NODES_LEAST);
}

/* Returns the integral, over all directions but for their number, of the density in part of the
 * band. */
static double variance_between(const struct translation *t, const struct spectrum *spectrum,
                               double low, double high) {
    enum { STEPS = 1 << 12 };
    double sum = 0, step = log(high / low) / STEPS;
    for (int i = 0; i < STEPS; i++) {
        double k = low * exp((i + 0.5) * step);
        sum += spectrum_density(spectrum, t->dimension == 1, k) * pow(k, t->dimension) * step;
    }
    return sum;
}

/* Longer waves than the transforms hold have the factor of the longest that they do. As nothing is
 * known of what z has there, all of it counts as misfit. A plateau has little of the variance. */
static const double LONGER_MOST = 0.01;

/* Returns where nodes begin: with the band, or later if next to nothing lies before. */
static double first_node(struct translation *t, const struct spectrum *spectrum, double low,
                         double high) {
    double cut = high / RADIAL_RATIO_MOST;
    if (low >= cut)
        return low;
    double longer = variance_between(t, spectrum, low, cut);
    double share = longer / (longer + variance_between(t, spectrum, cut, high));
    t->fit.misfit = share <= LONGER_MOST ? share : 0;
    return share <= LONGER_MOST ? cut : low;
}

static int nodes_create(struct translation *t, const struct spectrum *spectrum, double low,
                        double high, struct error *err) {
    double least = high * (1 - 1e-3); /* a band of one ring has some width */
    low = first_node(t, spectrum, low, high);
    t->k = array_create(NODES, sizeof *t->k);
    t->factor = array_create(NODES, sizeof *t->factor);
    if (t->k == NULL || t->factor == NULL)
        return error_memory(err, 2 * NODES * sizeof(double), "a law of heights");
    low = fmin(low, least);
    t->nodes = NODES;
    size_t plateau = plateau_nodes(spectrum, low, high);
    double bend = plateau > 1 ? 2 * M_PI / spectrum->wavelength_rolloff : low;
    if (plateau > 1)
        nodes_between(low, bend, plateau, t->k);
    nodes_between(bend, high, NODES - plateau + 1, t->k + plateau - 1);
    return 0;
}

/* --- the fixed point --- */

struct solver {
    struct radial *radial;
    const struct hermite_powers *powers;
    size_t nodes, lags;
    double *asked;       /* density at the nodes, of integral 1; owned, as all below */
    double *gaussian;    /* of g, of variance 1 */
    double *reached;     /* of z */
    double *correlation; /* lags */
};

static void solver_clear(struct solver *s) {
    radial_destroy(&s->radial);
    free(s->asked);
    free(s->gaussian);
    free(s->reached);
    free(s->correlation);
}

static int solver_create(struct solver *s, const struct translation *t,
                         const struct spectrum *spectrum, struct error *err) {
    *s = (struct solver){.powers = height_function_powers(t->function), .nodes = t->nodes};
    int status = radial_create(&s->radial, t->dimension, t->nodes, t->k, err);
    if (status != 0)
        return status;
    s->lags = radial_lags(s->radial);
    s->asked = array_create(t->nodes, sizeof *s->asked);
    s->gaussian = array_create(t->nodes, sizeof *s->gaussian);
    s->reached = array_create(t->nodes, sizeof *s->reached);
    s->correlation = array_create(s->lags, sizeof *s->correlation);
    if (s->asked == NULL || s->gaussian == NULL || s->reached == NULL || s->correlation == NULL)
        return error_memory(err, (3 * t->nodes + s->lags) * sizeof(double), "a law of heights");
    for (size_t a = 0; a < t->nodes; a++)
        s->asked[a] = s->gaussian[a] = spectrum_density(spectrum, t->dimension == 1, t->k[a]);
    double all = radial_integral(s->radial, s->asked);
    if (!(all > 0 && isfinite(all)))
        return error_set(err, ERROR_INPUT, "the spectrum has no density in its band");
    for (size_t a = 0; a < t->nodes; a++)
        s->asked[a] /= all;
    return 0;
}

static void multiply(double *values, size_t n, double factor) {
    for (size_t a = 0; a < n; a++)
        values[a] *= factor;
}

/* Computes the density of z from that of g. Of Hermite's series the first term has the density of g
 * itself; the others are summed at each lag. */
static void reach(struct solver *s) {
    double first = s->powers->of[1];
    radial_correlate(s->radial, s->gaussian, s->correlation);
    multiply(s->gaussian, s->nodes, 1 / s->correlation[0]);
    multiply(s->correlation, s->lags, 1 / s->correlation[0]);
    hermite_correlations_beyond(s->powers, s->lags, s->correlation);
    radial_density(s->radial, s->correlation, s->reached);
    for (size_t a = 0; a < s->nodes; a++)
        s->reached[a] += first * s->gaussian[a];
}

/* Steps of the logarithm of the density towards the asked one. Larger powers overshoot where most
 * of a density comes from the other terms. */
static const double STEP_POWER = 0.7, CHANGE_LEAST = 1e-7;
enum { STEPS_MOST = 200 };

/* Makes one step; returns the largest change of a logarithm. What z has too much of where g has
 * nothing left stays. */
static double step(struct solver *s) {
    double inside = radial_integral(s->radial, s->reached), largest = 0;
    for (size_t a = 0; a < s->nodes; a++) {
        if (!(s->asked[a] > 0 && s->gaussian[a] > 0))
            continue;
        double wanted = s->asked[a] * inside;
        double change = STEP_POWER * log(wanted / fmax(s->reached[a], 1e-6 * wanted));
        bool gone = s->gaussian[a] < 1e-12 * wanted && change < 0;
        s->gaussian[a] *= gone ? 1 : exp(change);
        largest = gone ? largest : fmax(largest, fabs(change));
    }
    return largest;
}

static void judge(const struct translation *t, const struct solver *s, double *difference,
                  struct translation_fit *fit) {
    double all = radial_integral(s->radial, s->gaussian);
    double inside = radial_integral(s->radial, s->reached), largest = 0;
    for (size_t a = 0; a < s->nodes; a++) {
        difference[a] = fabs(s->reached[a] / inside - s->asked[a]);
        if (difference[a] * t->k[a] > largest) {
            largest = difference[a] * t->k[a];
            fit->misfit_wave_number = t->k[a];
        }
    }
    fit->outside = fmax(1 - inside / all, 0);
    fit->misfit += radial_integral(s->radial, difference) / 2;
}

static int solve(struct translation *t, const struct spectrum *spectrum, struct error *err) {
    struct solver solver;
    int status = solver_create(&solver, t, spectrum, err);
    if (status == 0) {
        double change = 1;
        while (change > CHANGE_LEAST && t->fit.steps < STEPS_MOST) {
            reach(&solver);
            change = step(&solver);
            t->fit.steps++;
        }
        reach(&solver);
        for (size_t a = 0; a < t->nodes; a++)
            t->factor[a] = solver.asked[a] > 0 ? solver.gaussian[a] / solver.asked[a] : 0;
        judge(t, &solver, solver.correlation, &t->fit); /* lags outnumber the nodes */
    }
    solver_clear(&solver);
    return status;
}

/* --- the law --- */

int translation_create(struct translation **out, const struct spectrum *spectrum, int dimension,
                       const struct heights *heights, struct error *err) {
    double low, high;
    struct translation *t = array_create(1, sizeof *t);
    if (t == NULL)
        return error_memory(err, sizeof *t, "a law of heights");
    t->dimension = dimension;
    t->fit.outside = NAN;
    int status = height_function_create(&t->function, heights, err);
    if (status == 0 && spectrum_band(spectrum, &low, &high)) {
        status = nodes_create(t, spectrum, low, high, err);
        if (status == 0)
            status = solve(t, spectrum, err);
    }
    if (status != 0) {
        translation_destroy(&t);
        return status;
    }
    *out = t;
    return 0;
}

void translation_destroy(struct translation **translation) {
    struct translation *t = *translation;
    if (t == NULL)
        return;
    height_function_destroy(&t->function);
    free(t->k);
    free(t->factor);
    free(t);
    *translation = NULL;
}

const struct height_function *translation_function(const struct translation *translation) {
    return translation->function;
}

const struct translation_fit *translation_fit(const struct translation *translation) {
    return &translation->fit;
}

double translation_factor(const struct translation *t, double k) {
    if (t->nodes == 0)
        return 1;
    size_t low = 0, high = t->nodes - 1;
    while (high - low > 1) {
        size_t middle = (low + high) / 2;
        if (t->k[middle] <= k)
            low = middle;
        else
            high = middle;
    }
    double part = fmin(fmax((k - t->k[low]) / (t->k[high] - t->k[low]), 0), 1);
    return t->factor[low] + part * (t->factor[high] - t->factor[low]);
}

/* The derivatives at lag 0 of the sum of c_n^2 R^n: n and n (n - 1) times c_n^2 sum to the means of
 * f'^2 and f''^2. */
struct moments translation_moments(const struct translation *t, const struct moments *g,
                                   double height) {
    const struct hermite_powers *powers = height_function_powers(t->function);
    double square = height * height;
    double a = powers->slope * square, b = powers->curvature * square;
    struct moments z = {.m00 = g->m00 * square,
                        .m20 = a * g->m20,
                        .m02 = a * g->m02,
                        .m11 = a * g->m11,
                        .m22 = a * g->m22 + b * (g->m20 * g->m02 + 2 * g->m11 * g->m11),
                        .m40 = a * g->m40 + 3 * b * g->m20 * g->m20,
                        .m04 = a * g->m04 + 3 * b * g->m02 * g->m02,
                        .m31 = a * g->m31 + 3 * b * g->m20 * g->m11,
                        .m13 = a * g->m13 + 3 * b * g->m02 * g->m11};
    moments_derive(&z, t->dimension == 1);
    return z;
}
