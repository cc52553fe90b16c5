/* Nayak parameter of self-affine spectra, and the bandwidth that gives a wanted one. */
#include "core/surface/spectrum.h"
#include <math.h>
#include <stdint.h>
#include <stdlib.h>

/* Returns (zeta^e - 1)/e, and log(zeta) at e = 0. */
static double power_integral(double zeta, double e) {
    double x = e * log(zeta);
    return e == 0 ? log(zeta) : expm1(x) / e;
}

double spectrum_alpha_continuous(int dimension, double hurst, double ratio_long,
                                 double ratio_rolloff) {
    bool domain = (dimension == 1 || dimension == 2) && hurst >= 0 && hurst <= 1 &&
                  ratio_rolloff >= 1 && ratio_long >= ratio_rolloff && isfinite(ratio_long);
    if (!domain)
        return NAN;
    double xi = 1 / ratio_rolloff, zeta = ratio_long / ratio_rolloff;
    double m[3];
    for (int order = 0; order < 3; order++) {
        double plateau = dimension == 2 ? 2 * order + 2 : 2 * order + 1;
        m[order] =
            -expm1(plateau * log(xi)) / plateau + power_integral(zeta, 2 * order - 2 * hurst);
    }
    /* One ring or line of waves is the limit of a vanishing band. */
    if (!(m[1] > 0))
        return dimension == 2 ? 1.5 : 1;
    return (dimension == 2 ? 1.5 : 1) * (m[0] / m[1]) * (m[2] / m[1]);
}

enum { BISECTIONS = 200 };
static const double RATIO_MOST = 1e9;

int spectrum_ratio_continuous(int dimension, double hurst, double ratio_rolloff, double alpha,
                              double *ratio, struct error *err) {
    double low = ratio_rolloff, high = RATIO_MOST;
    double least = spectrum_alpha_continuous(dimension, hurst, low, ratio_rolloff);
    double most = spectrum_alpha_continuous(dimension, hurst, high, ratio_rolloff);
    if (!(alpha >= least && alpha <= most))
        return error_set(
            err, ERROR_NUMERIC,
            "no wavelength ratio gives alpha = %g at hurst = %g; allowed: %.6g to %.6g", alpha,
            hurst, least, most);
    for (int step = 0; step < BISECTIONS && high > low; step++) {
        double middle = sqrt(low * high);
        if (spectrum_alpha_continuous(dimension, hurst, middle, ratio_rolloff) < alpha)
            low = middle;
        else
            high = middle;
    }
    *ratio = sqrt(low * high);
    return 0;
}

/* Moments of the modes with L/lambda_l <= |m| <= R, updated as R grows ring by ring. */
struct ring_sums {
    int dimension;
    double hurst, lowest, rolloff; /* |m| of lambda_l and lambda_r */
    double m0, m2, m4;             /* of the full plane, in units of 2 pi/L */
};

/* Adds a ring |m|^2 = square that holds `points` modes with sum of (mx^4 + my^4)/2 = fourth. */
static void ring_add(struct ring_sums *sums, double square, double points, double fourth) {
    double m = sqrt(square);
    if (m < sums->lowest * (1 - 1e-9))
        return;
    double relative = m / sums->rolloff;
    double exponent = sums->dimension == 2 ? -2 * (sums->hurst + 1) : -1 - 2 * sums->hurst;
    double power = relative > 1 ? pow(relative, exponent) : 1;
    sums->m0 += points * power;
    sums->m2 += points * power * (sums->dimension == 2 ? square / 2 : square);
    sums->m4 += fourth * power;
}

static double ring_alpha(const struct ring_sums *sums) {
    return sums->m2 > 0 ? sums->m0 / sums->m2 * (sums->m4 / sums->m2) : NAN;
}

/* The rings r^2 <= |m|^2 < (r + 1)^2 of the plane: how many points each holds, and their fourth
 * powers. counts and fourths have 2r + 1 entries. */
static void annulus_count(uint64_t r, double *counts, double *fourths) {
    uint64_t inner = r * r, outer = (r + 1) * (r + 1);
    for (uint64_t s = 0; s < outer - inner; s++)
        counts[s] = fourths[s] = 0;
    for (uint64_t x = 0; x <= r; x++) {
        uint64_t first = (uint64_t)sqrt((double)(x * x < inner ? inner - x * x : 0));
        for (uint64_t y = first; x * x + y * y < outer; y++) {
            uint64_t square = x * x + y * y;
            if (square < inner)
                continue;
            double copies = (x != 0 ? 2 : 1) * (y != 0 ? 2 : 1);
            double x2 = (double)(x * x), y2 = (double)(y * y);
            counts[square - inner] += copies;
            fourths[square - inner] += copies * (x2 * x2 + y2 * y2) / 2;
        }
    }
}

enum {
    RINGS_MOST = 16384
}; /* largest |m| tried: a grid of 8 points a wave would have 131072 a side */

struct ring_search {
    struct ring_sums sums;
    double alpha;
    double best_square, best_alpha; /* ring whose alpha is nearest so far */
    double least_alpha, most_alpha; /* of all rings so far; NaN before the first */
};

/* Visits one more ring; returns true once alpha lies between those of the rings so far. */
static bool ring_visit(struct ring_search *search, double square, double points, double fourth) {
    ring_add(&search->sums, square, points, fourth);
    double reached = ring_alpha(&search->sums);
    /* The shortest wave may not be longer than the roll-off. */
    if (isnan(reached) || sqrt(square) < search->sums.rolloff * (1 - 1e-9))
        return false;
    search->least_alpha = fmin(search->least_alpha, reached); /* which pass over NaN */
    search->most_alpha = fmax(search->most_alpha, reached);
    if (!(fabs(reached - search->alpha) >= fabs(search->best_alpha - search->alpha))) {
        search->best_alpha = reached;
        search->best_square = square;
    }
    return search->least_alpha <= search->alpha && search->alpha <= search->most_alpha;
}

static bool plane_search(struct ring_search *search, double *work) {
    double *counts = work, *fourths = work + 2 * RINGS_MOST + 1;
    for (uint64_t r = (uint64_t)search->sums.lowest; r < RINGS_MOST; r++) {
        annulus_count(r, counts, fourths);
        for (uint64_t s = 0; s <= 2 * r; s++)
            if (counts[s] > 0 && ring_visit(search, (double)(r * r + s), counts[s], fourths[s]))
                return true;
    }
    return false;
}

static bool line_search(struct ring_search *search) {
    for (uint64_t m = (uint64_t)search->sums.lowest; m < RINGS_MOST; m++) {
        double square = (double)(m * m);
        if (m > 0 && ring_visit(search, square, 2, 2 * square * square))
            return true;
    }
    return false;
}

int spectrum_ratio_discrete(int dimension, double hurst, double ratio_rolloff, double length_ratio,
                            double alpha, double *ratio, double *reached, struct error *err) {
    if (!(length_ratio >= 1 && length_ratio < RINGS_MOST) || !(ratio_rolloff >= 1) ||
        !(hurst >= 0 && hurst <= 1) || (dimension != 1 && dimension != 2))
        return error_set(
            err, ERROR_INPUT,
            "dimension %d, hurst %g, roll-off ratio %g, length ratio %g: allowed: 1 or 2, "
            "0 to 1, 1 or more, 1 to %d",
            dimension, hurst, ratio_rolloff, length_ratio, RINGS_MOST);
    struct ring_search search = {
        .sums = {dimension, hurst, length_ratio, length_ratio * ratio_rolloff, 0, 0, 0},
        .alpha = alpha,
        .best_alpha = NAN,
        .least_alpha = NAN,
        .most_alpha = NAN,
    };
    size_t bytes = 2 * (2 * RINGS_MOST + 1) * sizeof(double);
    double *work = dimension == 2 ? malloc(bytes) : NULL;
    if (dimension == 2 && work == NULL)
        return error_memory(err, bytes, "rings of modes");
    bool passed = dimension == 2 ? plane_search(&search, work) : line_search(&search);
    free(work);
    if (!passed)
        return error_set(err, ERROR_NUMERIC,
                         "no wavelength ratio gives alpha = %g at hurst = %g and a cell of %g long "
                         "waves; allowed: %.6g to %.6g",
                         alpha, hurst, length_ratio, search.least_alpha, search.most_alpha);
    *ratio = sqrt(search.best_square) / length_ratio;
    *reached = search.best_alpha;
    return 0;
}
