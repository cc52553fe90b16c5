/* Nayak parameter of self-affine spectra, and the bandwidth that gives a required one. */
#include "core/error.h"
#include "core/surface/spectrum.h"
#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* The discrete Nayak parameter of a cell as a function of its shortest wave. The rings of the
 * lattice of wave vectors, all those of one length, are added one after another. */

/* Sums over the modes with L/lambda_l <= |m| <= R. */
struct ring_sums {
    int dimension;
    double hurst, lowest, rolloff; /* |m| of lambda_l and lambda_r */
    double highest;                /* |m| of lambda_s; INFINITY while it is sought */
    double m0, m2, m4;             /* of the full plane, in units of 2 pi/L */
    double quartic;                /* sum of |m|^4: m40 + 2 m22 + m04 */
};

/* With TERMS (FEW_TERMS) terms the series has 15 digits where |m| is at least SERIES_FROM
 * (FEW_FROM). */
enum { TERMS = 8, SERIES_FROM = 64, FEW_TERMS = 4, FEW_FROM = 4096 };

/* Sums of u^k over the points of an annulus, with |m|^2 = centre (1 + u), and of (mx^4 + my^4)/2
 * times u^k. A ring is an annulus of one term. */
struct annulus {
    double inner, outer;  /* |m|^2 */
    double centre, scale; /* and 1/centre */
    size_t terms;         /* TERMS or FEW_TERMS */
    double points[TERMS], fourths[TERMS];
};

/* Annuli and rings that were added to sums; failed: there was no memory for one. */
struct annulus_list {
    size_t count, room;
    struct annulus *of; /* owned */
    bool failed;
};

struct ring_search {
    struct ring_sums sums;
    double alpha;   /* required */
    double times;   /* ratio of the distances of waves along y and along x; 1: a square */
    double largest; /* |m| tried */
    double best_square, best_alpha; /* ring whose alpha is nearest so far; NaN before the first */
    double between_square;          /* the first ring with alpha between those so far; or NaN */
    double least_alpha, most_alpha; /* of all rings so far; NaN before the first */
    bool left_behind; /* the search ended before `largest`: alpha is less than that of all rings */
    double
        passed_by; /* lower bound of the distance to alpha of rings that were not visited singly */
    struct annulus_list *visited; /* takes what is added; NULL: nobody asks */
};

/* Largest |m| tried of squares and lines: a grid of 8 points a wave would have 131072 a side. Of
 * rectangles, in waves along the longer side. */
enum { RINGS_MOST = 16384, LATTICE_MOST = 6000 };

/* Rings are visited one by one where alpha is near the required one; elsewhere whole annuli are
 * added. In an annulus of inner radius r the lengths of waves differ by 1/r of themselves. So a
 * power of the length is a short series over them, whose moments need no power of each wave. */

static bool is_in_band(const struct ring_sums *sums, double m) {
    return m >= sums->lowest * (1 - 1e-9) && m <= sums->highest * (1 + 1e-9);
}

/* Adds a ring |m|^2 = square that holds `points` modes with sum of (mx^4 + my^4)/2 = fourth. */
static void ring_add(struct ring_sums *sums, double square, double points, double fourth) {
    double m = sqrt(square);
    if (!is_in_band(sums, m))
        return;
    double relative = m / sums->rolloff;
    double exponent = sums->dimension == 2 ? -2 * (sums->hurst + 1) : -1 - 2 * sums->hurst;
    double power = relative > 1 ? pow(relative, exponent) : 1;
    sums->m0 += points * power;
    sums->m2 += points * power * (sums->dimension == 2 ? square / 2 : square);
    sums->m4 += fourth * power;
    sums->quartic += points * power * square * square;
}

/* The first rings of a plane have four or twelve modes, which are no isotropic surface: alpha of
 * such sums is left out. */
static const double ANISOTROPY_MOST = 0.1;
static bool is_isotropic(const struct ring_sums *sums) {
    double m22 = sums->quartic / 2 - sums->m4;
    return sums->dimension == 1 || fabs(3 * m22 / sums->m4 - 1) <= ANISOTROPY_MOST;
}

static double ring_alpha(const struct ring_sums *sums) {
    return sums->m2 > 0 ? sums->m0 / sums->m2 * (sums->m4 / sums->m2) : NAN;
}

static void visited_add(struct annulus_list *list, const struct annulus *annulus) {
    if (list == NULL || list->failed)
        return;
    if (list->count == list->room) {
        size_t room = 2 * list->room + 1024;
        struct annulus *of = realloc(list->of, room * sizeof *of);
        list->failed = of == NULL;
        if (of == NULL)
            return;
        list->of = of;
        list->room = room;
    }
    list->of[list->count++] = *annulus;
}

static void visited_add_ring(const struct ring_search *search, double square, double points,
                             double fourth) {
    if (is_in_band(&search->sums, sqrt(square)))
        visited_add(search->visited, &(struct annulus){.inner = square,
                                                       .centre = square,
                                                       .terms = 1,
                                                       .points = {points},
                                                       .fourths = {fourth}});
}

/* Rings of a plane are near each other, but for those of short cells: there alpha rises and falls
 * from ring to ring, and those up to twice as far out may come nearer. */
static const double APART_MOST = 0.01, FARTHER = 4;

/* Visits the next ring; returns true once alpha lies between those of the rings so far, of which
 * one is near. */
static bool ring_visit(struct ring_search *search, double square, double points, double fourth) {
    ring_add(&search->sums, square, points, fourth);
    if (search->visited != NULL)
        visited_add_ring(search, square, points, fourth);
    double reached = ring_alpha(&search->sums);
    /* The shortest wave may not be longer than the roll-off. */
    if (isnan(reached) || sqrt(square) < search->sums.rolloff * (1 - 1e-9) ||
        !is_isotropic(&search->sums))
        return false;
    search->least_alpha = fmin(search->least_alpha, reached); /* fmin and fmax pass over NaN */
    search->most_alpha = fmax(search->most_alpha, reached);
    if (!(fabs(reached - search->alpha) >= fabs(search->best_alpha - search->alpha))) {
        search->best_alpha = reached;
        search->best_square = square;
    }
    bool between = search->least_alpha <= search->alpha && search->alpha <= search->most_alpha;
    if (between && isnan(search->between_square))
        search->between_square = square;
    bool near = search->sums.dimension == 1 ||
                fabs(search->best_alpha - search->alpha) <= APART_MOST * search->alpha;
    return between && (near || square > FARTHER * search->between_square);
}

/* --- rings of an annulus, one by one --- */

/* Fills in, for the rings r^2 <= |m|^2 < (r + 1)^2 of the plane, the number of points of each and
 * their fourth powers. counts and fourths have 2r + 1 entries. */
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

/* A number of waves of one quadrant with |m|^2 = square, in units of waves along the longer
 * side. */
struct lattice_ring {
    double square, points, fourth;
};

static int compare_rings(const void *a, const void *b) {
    double x = ((const struct lattice_ring *)a)->square,
           y = ((const struct lattice_ring *)b)->square;
    return (x > y) - (x < y);
}

/* Waves whose |m|^2 differ by less than this part belong to one ring. */
static const double SAME_RING = 1e-9;

/* Rounds to an integer what differs from it by rounding, because integers bound an annulus. */
static double square_of(double x2, double y2) {
    double square = x2 + y2, whole = round(square);
    return fabs(square - whole) <= SAME_RING * square ? whole : square;
}

/* Fills rings with the waves of r <= |m| < r + 1 in rising order, where those along y are `times`
 * as far apart as those along x (times >= 1). Returns their number. rings has room for
 * 4 (r + 2). */
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

/* Room for the rings of the largest annulus, and for the first point of each row that is not
 * visited yet. */
struct lattice {
    double *counts;             /* of a square, with fourth powers behind; NULL: no square */
    struct lattice_ring *rings; /* of a rectangle; NULL: none */
    uint32_t *next;             /* of both; NULL: a line */
    size_t rows;                /* number of rows of next in use */
};

static bool plane_visit(struct ring_search *search, size_t r, double *counts) {
    double *fourths = counts + 2 * r + 1;
    annulus_count(r, counts, fourths);
    for (size_t s = 0; s <= 2 * r; s++)
        if (counts[s] > 0 && ring_visit(search, (double)(r * r + s), counts[s], fourths[s]))
            return true;
    return false;
}

static bool lattice_visit(struct ring_search *search, size_t r, struct lattice_ring *rings) {
    size_t count = lattice_annulus((double)r, search->times, rings), next;
    for (size_t first = 0; first < count; first = next) {
        struct lattice_ring ring = rings[first];
        for (next = first + 1; next < count && rings[next].square <= ring.square * (1 + SAME_RING);
             next++) {
            ring.points += rings[next].points;
            ring.fourth += rings[next].fourth;
        }
        if (ring.square > 0 && ring_visit(search, ring.square, ring.points, ring.fourth))
            return true;
    }
    return false;
}

static bool annulus_visit(struct ring_search *search, size_t r, struct lattice *lattice) {
    if (search->sums.dimension == 1) {
        double square = (double)(r * r);
        return r > 0 && ring_visit(search, square, 2, 2 * square * square);
    }
    return lattice->rings != NULL
               ? lattice_visit(search, r, lattice->rings)
               : lattice->counts != NULL && plane_visit(search, r, lattice->counts);
}

/* --- annuli as a whole --- */

static void annulus_begin(struct annulus *annulus, double r) {
    *annulus = (struct annulus){.inner = r * r,
                                .outer = (r + 1) * (r + 1),
                                .centre = r * r + r + 0.5,
                                .scale = 1 / (r * r + r + 0.5),
                                .terms = r < FEW_FROM ? TERMS : FEW_TERMS};
}

/* Callers pass constant terms, so that the loop is unrolled. */
static inline void annulus_add(struct annulus *annulus, size_t terms, double copies, double x2,
                               double y2) {
    double u = (x2 + y2 - annulus->centre) * annulus->scale;
    double points = copies, fourth = copies * (x2 * x2 + y2 * y2) / 2;
    for (size_t k = 0; k < terms; k++, points *= u, fourth *= u) {
        annulus->points[k] += points;
        annulus->fourths[k] += fourth;
    }
}

static inline void plane_walk_rows(struct lattice *lattice, size_t terms, uint64_t outer,
                                   struct annulus *out) {
    struct annulus annulus = *out; /* a local copy can be held in registers */
    for (uint64_t x = 0; x < lattice->rows; x++) {
        uint64_t y = lattice->next[x], x2 = x * x;
        for (; x2 + y * y < outer; y++)
            annulus_add(&annulus, terms, x == 0 || x == y ? 4 : 8, (double)x2, (double)(y * y));
        lattice->next[x] = (uint32_t)y;
    }
    *out = annulus;
}

/* Visits the next points of an eighth of the plane, 0 <= x <= y, from |m| = r to r + 1. */
static void plane_walk(struct lattice *lattice, size_t r, struct annulus *annulus) {
    uint64_t inner = r * r, outer = (r + 1) * (r + 1);
    annulus_begin(annulus, (double)r);
    for (; 2 * lattice->rows * lattice->rows < outer; lattice->rows++) {
        uint64_t x = lattice->rows, y = x;
        if (2 * x * x < inner) {
            y = (uint64_t)sqrt((double)(inner - x * x));
            y += x * x + y * y < inner;
        }
        lattice->next[x] = (uint32_t)y;
    }
    if (annulus->terms == TERMS)
        plane_walk_rows(lattice, TERMS, outer, annulus);
    else
        plane_walk_rows(lattice, FEW_TERMS, outer, annulus);
}

/* As plane_walk, over a quarter of a lattice of rectangles. */
static void lattice_walk(struct lattice *lattice, size_t r, double times, struct annulus *annulus) {
    annulus_begin(annulus, (double)r);
    for (; (double)lattice->rows * times < (double)r + 1; lattice->rows++) {
        double y2 = (double)lattice->rows * times * ((double)lattice->rows * times);
        double x = fmax(0, ceil(sqrt(fmax(0, annulus->inner - y2))) - 1);
        while (square_of(x * x, y2) < annulus->inner)
            x++;
        lattice->next[lattice->rows] = (uint32_t)x;
    }
    for (size_t row = 0; row < lattice->rows; row++) {
        double y = (double)row * times, y2 = y * y, x = lattice->next[row];
        for (; square_of(x * x, y2) < annulus->outer; x++)
            annulus_add(annulus, TERMS, (x != 0 ? 2 : 1) * (row != 0 ? 2 : 1), x * x, y2);
        lattice->next[row] = (uint32_t)x;
    }
}

/* Returns the sum over k of (p choose k) moments[k], which is that of (1 + u)^p. */
static double series(double p, size_t terms, const double *moments) {
    double sum = 0, factor = 1;
    for (size_t k = 0; k < terms; k++) {
        sum += factor * moments[k];
        factor *= (p - (double)k) / (double)(k + 1);
    }
    return sum;
}

static void sums_add_annulus(struct ring_sums *sums, const struct annulus *annulus) {
    bool plateau = annulus->inner < sums->rolloff * sums->rolloff;
    double p = plateau ? 0 : -(sums->hurst + 1);
    double power = plateau ? 1 : pow(annulus->centre / (sums->rolloff * sums->rolloff), p);
    sums->m0 += power * series(p, annulus->terms, annulus->points);
    sums->m2 += power * annulus->centre / 2 * series(p + 1, annulus->terms, annulus->points);
    sums->m4 += power * series(p, annulus->terms, annulus->fourths);
    sums->quartic +=
        power * annulus->centre * annulus->centre * series(p + 2, annulus->terms, annulus->points);
}

/* Returns a lower bound of the distance from the required alpha to that of any ring of an annulus,
 * given that all rings so far are on the same side of it. The result is 0 where the required alpha
 * may be reached. The bounds hold because sums only grow. */
static double annulus_misses_by(const struct ring_search *search, const struct ring_sums *after) {
    const struct ring_sums *before = &search->sums;
    if (!(before->m2 > 0))
        return 0;
    double least = before->m0 / after->m2 * (before->m4 / after->m2);
    double most = after->m0 / before->m2 * (after->m4 / before->m2);
    if (search->alpha > most && !(search->least_alpha > search->alpha))
        return search->alpha - most;
    if (search->alpha < least && !(search->most_alpha < search->alpha))
        return least - search->alpha;
    return 0;
}

/* Adds a whole annulus; returns false where its rings must be visited one by one. */
static bool annulus_pass(struct ring_search *search, size_t r, struct lattice *lattice) {
    struct annulus annulus;
    struct ring_sums after = search->sums;
    double m = (double)r, rolloff = search->sums.rolloff;
    if (lattice->next == NULL || r < SERIES_FROM || m < search->sums.lowest + 1 ||
        m + 1 > search->sums.highest)
        return false;
    if (lattice->rings != NULL)
        lattice_walk(lattice, r, search->times, &annulus);
    else
        plane_walk(lattice, r, &annulus);
    sums_add_annulus(&after, &annulus);
    if (m < rolloff && m + 2 > rolloff)
        return false;
    if (m >= rolloff) { /* otherwise no ring of it may be the shortest */
        double by = annulus_misses_by(search, &after);
        if (!(by > 0))
            return false;
        search->passed_by = fmin(search->passed_by, by);
        search->least_alpha = fmin(search->least_alpha, ring_alpha(&after));
        search->most_alpha = fmax(search->most_alpha, ring_alpha(&after));
    }
    search->sums = after;
    visited_add(search->visited, &annulus);
    return true;
}

/* --- the search --- */

/* Returns whether the required alpha is out of reach: below that of all rings so far, while alpha
 * grows with ever shorter waves. */
static bool is_left_behind(const struct ring_search *search, size_t r) {
    enum { RADIUS_LEAST = 1024 };
    return search->sums.dimension == 2 && r > RADIUS_LEAST && search->alpha < search->least_alpha &&
           (double)r > 4 * search->sums.rolloff && ring_alpha(&search->sums) > 2 * search->alpha;
}

static bool search_annuli(struct ring_search *search, struct lattice *lattice, bool pass) {
    search->passed_by = INFINITY;
    search->best_square = search->best_alpha = search->least_alpha = search->most_alpha = NAN;
    search->between_square = NAN;
    search->sums.m0 = search->sums.m2 = search->sums.m4 = search->sums.quartic = 0;
    lattice->rows = 0;
    search->left_behind = false;
    for (size_t r = (size_t)search->sums.lowest;
         (double)r < search->largest && !search->left_behind; r++) {
        if (!(pass && annulus_pass(search, r, lattice)) && annulus_visit(search, r, lattice))
            return true;
        search->left_behind = is_left_behind(search, r);
    }
    return false;
}

static void lattice_clear(struct lattice *lattice) {
    free(lattice->counts);
    free(lattice->rings);
    free(lattice->next);
}

static int lattice_fill(struct lattice *lattice, const struct ring_search *search,
                        struct error *err) {
    size_t most = (size_t)search->largest + 2;
    bool square = search->times == 1;
    *lattice = (struct lattice){.next = array_create(most, sizeof *lattice->next)};
    if (square)
        lattice->counts = array_create(4 * most, sizeof *lattice->counts);
    else
        lattice->rings = array_create(4 * most, sizeof *lattice->rings);
    if (lattice->next == NULL || (square && lattice->counts == NULL) ||
        (!square && lattice->rings == NULL)) {
        lattice_clear(lattice);
        return error_memory(err, 4 * most * sizeof *lattice->rings, "rings of modes");
    }
    return 0;
}

/* Finds the ring whose alpha is nearest. The search ends at the first ring after which alpha lies
 * between those so far. Fills best_square and best_alpha, and *found, false where no ring gets
 * there. The largest |m| takes some tenths of a second. ERROR_MEMORY. */
static int ring_search_run(struct ring_search *search, bool *found, struct error *err) {
    struct lattice lattice = {.counts = NULL};
    int status = search->sums.dimension == 2 ? lattice_fill(&lattice, search, err) : 0;
    if (status != 0)
        return status;
    *found = search_annuli(search, &lattice, true);
    if (*found && fabs(search->best_alpha - search->alpha) > search->passed_by)
        *found = search_annuli(search, &lattice, false);
    lattice_clear(&lattice);
    return 0;
}

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

/* Returns about the largest alpha, that with the shortest wave. */
static double most_of(const struct ring_search *search, double ratio_rolloff) {
    double ratio = fmax(search->largest / search->sums.lowest, ratio_rolloff);
    return spectrum_alpha_continuous(2, search->sums.hurst, ratio, ratio_rolloff);
}

/* sides: of the cell, as the message prints them. */
static int ratio_of(struct ring_search *search, double ratio_rolloff, const char *sides,
                    double *ratio, double *reached, struct error *err) {
    static const double DISCRETE_MOST = 4; /* times the continuous value: small cells have more */
    double most = search->sums.dimension == 2 ? most_of(search, ratio_rolloff) : INFINITY;
    bool found = false;
    if (search->alpha > DISCRETE_MOST * most)
        return error_set(err, ERROR_NUMERIC,
                         "no wavelength ratio gives alpha = %g at hurst = %g and a cell of %s long "
                         "waves; allowed: up to about %.2g",
                         search->alpha, search->sums.hurst, sides, most);
    int status = ring_search_run(search, &found, err);
    if (status != 0)
        return status;
    if (!found && isnan(search->least_alpha)) /* no ring beyond the roll-off was visited */
        return error_set(err, ERROR_NUMERIC,
                         "a roll-off ratio of %g with a cell of %s long waves leaves no shorter "
                         "wave to be found; allowed: below %.6g",
                         ratio_rolloff, sides, search->largest / search->sums.lowest);
    if (!found && search->left_behind)
        return error_set(err, ERROR_NUMERIC,
                         "no wavelength ratio gives alpha = %g at hurst = %g and a cell of %s long "
                         "waves; allowed: %.6g to about %.2g",
                         search->alpha, search->sums.hurst, sides, search->least_alpha, most);
    if (!found)
        return error_set(err, ERROR_NUMERIC,
                         "no wavelength ratio gives alpha = %g at hurst = %g and a cell of %s long "
                         "waves; allowed: %.6g to %.6g",
                         search->alpha, search->sums.hurst, sides, search->least_alpha,
                         search->most_alpha);
    if (search->sums.dimension == 2 &&
        fabs(search->best_alpha - search->alpha) > APART_MOST * search->alpha)
        return error_set(err, ERROR_NUMERIC,
                         "no wavelength ratio gives alpha = %g at hurst = %g and a cell of %s long "
                         "waves within %g %%; the nearest is %.6g, and longer cells come nearer",
                         search->alpha, search->sums.hurst, sides, 100 * APART_MOST,
                         search->best_alpha);
    *ratio = sqrt(search->best_square) / search->sums.lowest;
    *reached = search->best_alpha;
    return 0;
}

int spectrum_ratio_discrete(int dimension, double hurst, double ratio_rolloff, double length_ratio,
                            double alpha, double *ratio, double *reached, struct error *err) {
    char sides[32];
    struct ring_search search = {
        .sums = {.dimension = dimension,
                 .hurst = hurst,
                 .lowest = length_ratio,
                 .rolloff = length_ratio * ratio_rolloff,
                 .highest = INFINITY},
        .alpha = alpha,
        .times = 1,
        .largest = RINGS_MOST,
    };
    int status = ratio_refused(dimension, hurst, ratio_rolloff, length_ratio, RINGS_MOST, err);
    if (status != 0)
        return status;
    snprintf(sides, sizeof sides, "%g", length_ratio);
    return ratio_of(&search, ratio_rolloff, sides, ratio, reached, err);
}

int spectrum_ratio_rectangle(double hurst, double ratio_rolloff, double length_x, double length_y,
                             double alpha, double *ratio, double *reached, struct error *err) {
    double longer = fmax(length_x, length_y), shorter = fmin(length_x, length_y);
    char sides[64];
    struct ring_search search = {
        .sums = {.dimension = 2,
                 .hurst = hurst,
                 .lowest = longer,
                 .rolloff = longer * ratio_rolloff,
                 .highest = INFINITY},
        .alpha = alpha,
        .times = longer / shorter,
        .largest = LATTICE_MOST,
    };
    int status = ratio_refused(2, hurst, ratio_rolloff, longer, LATTICE_MOST, err);
    if (status == 0)
        status = ratio_refused(2, hurst, ratio_rolloff, shorter, LATTICE_MOST, err);
    if (status != 0)
        return status;
    snprintf(sides, sizeof sides, "%g by %g", length_x, length_y);
    return ratio_of(&search, ratio_rolloff, sides, ratio, reached, err);
}

/* --- the Hurst exponent of a required alpha --- */

/* A search for this alpha goes through the whole band, and passes whole annuli. */
static const double OUT_OF_REACH = 1e300;

/* Alpha of a spectrum by its Hurst exponent. */
struct alpha_of_hurst {
    int dimension;
    double ratio, rolloff;
    bool of_cell;               /* else by the continuous formula */
    struct ring_search search;  /* of a cell: what its rings are summed to */
    struct annulus_list annuli; /* of a cell; owned */
};

static double alpha_at(struct alpha_of_hurst *of, double hurst) {
    struct ring_sums *sums = &of->search.sums;
    if (!of->of_cell)
        return spectrum_alpha_continuous(of->dimension, hurst, of->ratio, of->rolloff);
    sums->hurst = hurst;
    sums->m0 = sums->m2 = sums->m4 = sums->quartic = 0;
    for (size_t a = 0; a < of->annuli.count; a++) {
        const struct annulus *annulus = &of->annuli.of[a];
        if (annulus->terms == 1)
            ring_add(sums, annulus->centre, annulus->points[0], annulus->fourths[0]);
        else
            sums_add_annulus(sums, annulus);
    }
    return ring_alpha(sums);
}

static const double HURST_LEAST = 1e-3;
enum { HURST_SCAN = 64 };

static double scanned(int n) {
    return HURST_LEAST + (1 - HURST_LEAST) * n / HURST_SCAN;
}

/* Alpha rises with the exponent, but in short cells, where it may fall near 1 or throughout. Finds
 * the first interval of a scan that holds the required one, and the range of all. */
static int scan(struct alpha_of_hurst *of, double alpha, double *low, double *high,
                struct error *err) {
    double last = NAN, least = NAN, most = NAN;
    bool found = false;
    for (int n = 0; n <= HURST_SCAN; n++) {
        double at = alpha_at(of, scanned(n));
        if (!found && (last - alpha) * (at - alpha) <= 0) {
            found = true;
            *low = scanned(n - 1);
            *high = scanned(n);
        }
        least = fmin(least, at);
        most = fmax(most, at);
        last = at;
    }
    bool sloped = most > least * (1 + 1e-9);
    if (sloped && found)
        return 0;
    if (sloped)
        return error_set(err, ERROR_NUMERIC,
                         "no Hurst exponent gives alpha = %g at a wavelength ratio of %g; allowed: "
                         "%.6g to %.6g",
                         alpha, of->ratio, least, most);
    return error_set(err, ERROR_NUMERIC,
                     "a band of this wavelength ratio, %g, has no waves shorter than the roll-off "
                     "whose power depends on the Hurst exponent",
                     of->ratio);
}

static int hurst_of(struct alpha_of_hurst *of, double alpha, double *hurst, struct error *err) {
    enum { HURST_HALVINGS = 34 };
    double low = NAN, high = NAN;
    int status = scan(of, alpha, &low, &high, err);
    if (status != 0)
        return status;
    bool rises = alpha_at(of, high) >= alpha_at(of, low);
    for (int n = 0; n < HURST_HALVINGS; n++) {
        *hurst = (low + high) / 2;
        *((alpha_at(of, *hurst) < alpha) == rises ? &low : &high) = *hurst;
    }
    if (of->of_cell && !is_isotropic(&of->search.sums))
        return error_set(err, ERROR_NUMERIC,
                         "the few waves of this cell at a wavelength ratio of %g are no isotropic "
                         "surface; longer cells are",
                         of->ratio);
    return 0;
}

int spectrum_hurst_continuous(int dimension, double ratio, double ratio_rolloff, double alpha,
                              double *hurst, struct error *err) {
    struct alpha_of_hurst of = {.dimension = dimension, .ratio = ratio, .rolloff = ratio_rolloff};
    return hurst_of(&of, alpha, hurst, err);
}

int spectrum_hurst_discrete(int dimension, double ratio, double ratio_rolloff, double length_x,
                            double length_y, double alpha, double *hurst, struct error *err) {
    double longer = fmax(length_x, length_y), shorter = fmin(length_x, length_y);
    double most = longer == shorter ? RINGS_MOST : LATTICE_MOST;
    struct alpha_of_hurst of = {
        .dimension = dimension, .ratio = ratio, .rolloff = ratio_rolloff, .of_cell = true};
    bool found;
    if (!(longer * ratio < most))
        return error_set(err, ERROR_INPUT,
                         "the shortest wave is 1/%g of the cell; allowed: down to 1/%g",
                         longer * ratio, most);
    of.search = (struct ring_search){.sums = {.dimension = dimension,
                                              .lowest = longer,
                                              .rolloff = longer * ratio_rolloff,
                                              .highest = longer * ratio},
                                     .alpha = OUT_OF_REACH,
                                     .times = longer / shorter,
                                     .largest = floor(longer * ratio * (1 + 1e-9)) + 1,
                                     .visited = &of.annuli};
    int status = ring_search_run(&of.search, &found, err);
    if (status == 0 && of.annuli.failed)
        status = error_memory(err, 2 * of.annuli.count * sizeof *of.annuli.of, "rings of modes");
    if (status == 0)
        status = hurst_of(&of, alpha, hurst, err);
    free(of.annuli.of);
    return status;
}
