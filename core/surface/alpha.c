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

static int ratio_refused(int dimension, double hurst, double ratio_rolloff, double length,
                         double most, struct error *err) {
    if (length >= 1 && length < most && ratio_rolloff >= 1 && hurst >= 0 && hurst <= 1 &&
        (dimension == 1 || dimension == 2))
        return 0;
    return error_set(err, ERROR_INPUT,
                     "dimension %d, hurst %g, roll-off ratio %g, length ratio %g: allowed: 1 or 2, "
                     "0 to 1, 1 or more, 1 to %g",
                     dimension, hurst, ratio_rolloff, length, most);
}

int spectrum_ratio_discrete(int dimension, double hurst, double ratio_rolloff, double length_ratio,
                            double alpha, double *ratio, double *reached, struct error *err) {
    int status = ratio_refused(dimension, hurst, ratio_rolloff, length_ratio, RINGS_MOST, err);
    if (status != 0)
        return status;
    struct ring_search search = {
        .sums = {dimension, hurst, length_ratio, length_ratio * ratio_rolloff, 0, 0, 0},
        .alpha = alpha,
        .best_alpha = NAN,
        .least_alpha = NAN,
        .most_alpha = NAN,
    };
    const size_t room = 2 * (2 * RINGS_MOST + 1);
    double *work = dimension == 2 ? array_create(room, sizeof *work) : NULL;
    if (dimension == 2 && work == NULL)
        return error_memory(err, room * sizeof *work, "rings of modes");
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

/* --- rectangles --- */

/* Waves of one quadrant, counted in those along the longer side: that many, of |m|^2 = square. */
struct lattice_ring {
    double square, points, fourth;
};

static int compare_rings(const void *a, const void *b) {
    double x = ((const struct lattice_ring *)a)->square,
           y = ((const struct lattice_ring *)b)->square;
    return (x > y) - (x < y);
}

/* Waves whose |m|^2 differ by less than this part are of one ring. */
static const double SAME_RING = 1e-9;

/* Integers behind rounding are told as such: they bound an annulus. */
static double square_of(double x2, double y2) {
    double square = x2 + y2, whole = round(square);
    return fabs(square - whole) <= SAME_RING * square ? whole : square;
}

/* The waves with r <= |m| < r + 1, where those along y are `times` as far apart as those along x
 * (times >= 1), in rising order; returns how many. rings has room for 4 (r + 2). */
static size_t lattice_annulus(double r, double times, struct lattice_ring *rings) {
    double inner = r * r, outer = (r + 1) * (r + 1);
    size_t count = 0;
    for (size_t row = 0; (double)row * times < r + 1; row++) {
        double y = (double)row * times, y2 = y * y;
        size_t x = (size_t)fmax(0, ceil(sqrt(fmax(0, inner - y2))) - 1);
        for (double x2 = (double)x * (double)x; square_of(x2, y2) < outer;
             x++, x2 = (double)x * (double)x) {
            double copies = (x != 0 ? 2 : 1) * (row != 0 ? 2 : 1);
            if (square_of(x2, y2) >= inner)
                rings[count++] = (struct lattice_ring){square_of(x2, y2), copies,
                                                       copies * (x2 * x2 + y2 * y2) / 2};
        }
    }
    qsort(rings, count, sizeof *rings, compare_rings);
    return count;
}

/* Beyond so many waves along the longer side no grid of 8 points a wave is small enough. */
enum { LATTICE_MOST = 6000 };

static bool lattice_search(struct ring_search *search, double times, struct lattice_ring *rings) {
    for (size_t r = (size_t)search->sums.lowest; r < LATTICE_MOST; r++) {
        size_t count = lattice_annulus((double)r, times, rings), next;
        for (size_t first = 0; first < count; first = next) {
            struct lattice_ring ring = rings[first];
            for (next = first + 1;
                 next < count && rings[next].square <= ring.square * (1 + SAME_RING); next++) {
                ring.points += rings[next].points;
                ring.fourth += rings[next].fourth;
            }
            if (ring.square > 0 && ring_visit(search, ring.square, ring.points, ring.fourth))
                return true;
        }
    }
    return false;
}

int spectrum_ratio_rectangle(double hurst, double ratio_rolloff, double length_x, double length_y,
                             double alpha, double *ratio, double *reached, struct error *err) {
    double longer = fmax(length_x, length_y), shorter = fmin(length_x, length_y);
    int status = ratio_refused(2, hurst, ratio_rolloff, longer, LATTICE_MOST, err);
    if (status == 0)
        status = ratio_refused(2, hurst, ratio_rolloff, shorter, LATTICE_MOST, err);
    if (status != 0)
        return status;
    struct ring_search search = {
        .sums = {2, hurst, longer, longer * ratio_rolloff, 0, 0, 0},
        .alpha = alpha,
        .best_alpha = NAN,
        .least_alpha = NAN,
        .most_alpha = NAN,
    };
    size_t most = 4 * (LATTICE_MOST + 2);
    struct lattice_ring *rings = array_create(most, sizeof *rings);
    if (rings == NULL)
        return error_memory(err, most * sizeof *rings, "rings of modes");
    bool passed = lattice_search(&search, longer / shorter, rings);
    free(rings);
    if (!passed)
        return error_set(err, ERROR_NUMERIC,
                         "no wavelength ratio gives alpha = %g at hurst = %g and a cell of %g by "
                         "%g long waves; allowed: %.6g to %.6g",
                         alpha, hurst, length_x, length_y, search.least_alpha, search.most_alpha);
    *ratio = sqrt(search.best_square) / longer;
    *reached = search.best_alpha;
    return 0;
}
