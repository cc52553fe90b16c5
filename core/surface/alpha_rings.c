/* Rings one by one where alpha is near, and whole annuli of them elsewhere: of an annulus of inner
 * radius r the waves differ in length by 1/r, so that a power of it is a short series over them,
 * whose moments need no power of each wave. */
#include "core/surface/alpha_rings.h"
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

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

/* --- rings of an annulus, one by one --- */

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

/* Room for the rings of the largest annulus, and for the first point of each row behind those
 * walked over. */
struct lattice {
    double *counts;             /* of a square, with fourth powers behind; NULL: no square */
    struct lattice_ring *rings; /* of a rectangle; NULL: none */
    uint32_t *next;             /* of both; NULL: a line */
    size_t rows;                /* of next that are in use */
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

/* |m| from where on so many terms hold 15 digits. */
enum { TERMS = 8, SERIES_FROM = 64, FEW_TERMS = 4, FEW_FROM = 4096 };

/* Sums over the points of an annulus of u^k, with |m|^2 = centre (1 + u), and of (mx^4 + my^4)/2
 * times that. */
struct annulus {
    double inner, outer;  /* |m|^2 */
    double centre, scale; /* and 1/centre */
    size_t terms;         /* TERMS or FEW_TERMS */
    double points[TERMS], fourths[TERMS];
};

static void annulus_begin(struct annulus *annulus, double r) {
    *annulus = (struct annulus){.inner = r * r,
                                .outer = (r + 1) * (r + 1),
                                .centre = r * r + r + 0.5,
                                .scale = 1 / (r * r + r + 0.5),
                                .terms = r < FEW_FROM ? TERMS : FEW_TERMS};
}

/* terms is a constant where it is called, so that the loop is laid out. */
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
    struct annulus annulus = *out; /* of its own, to be held in registers */
    for (uint64_t x = 0; x < lattice->rows; x++) {
        uint64_t y = lattice->next[x], x2 = x * x;
        for (; x2 + y * y < outer; y++)
            annulus_add(&annulus, terms, x == 0 || x == y ? 4 : 8, (double)x2, (double)(y * y));
        lattice->next[x] = (uint32_t)y;
    }
    *out = annulus;
}

/* Walks on over the points of an eighth of the plane, 0 <= x <= y, from |m| = r to r + 1. */
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

/* The same over a quarter of a lattice of rectangles. */
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

/* Sum over k of (p choose k) moments[k]: that of (1 + u)^p. */
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
}

/* How far alpha at any ring of an annulus stays from the one wanted, which all rings so far are on
 * the same side of: 0 or less where it may be reached. Sums only grow. */
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

/* Passes an annulus as a whole; false where its rings are to be looked at one by one. */
static bool annulus_pass(struct ring_search *search, size_t r, struct lattice *lattice) {
    struct annulus annulus;
    struct ring_sums after = search->sums;
    double m = (double)r, rolloff = search->sums.rolloff;
    if (lattice->next == NULL || r < SERIES_FROM || m < search->sums.lowest + 1)
        return false;
    if (lattice->rings != NULL)
        lattice_walk(lattice, r, search->times, &annulus);
    else
        plane_walk(lattice, r, &annulus);
    sums_add_annulus(&after, &annulus);
    if (m < rolloff && m + 2 > rolloff)
        return false;
    if (m >= rolloff) { /* else no ring of it may be the shortest */
        double by = annulus_misses_by(search, &after);
        if (!(by > 0))
            return false;
        search->passed_by = fmin(search->passed_by, by);
        search->least_alpha = fmin(search->least_alpha, ring_alpha(&after));
        search->most_alpha = fmax(search->most_alpha, ring_alpha(&after));
    }
    search->sums = after;
    return true;
}

/* --- the search --- */

/* Whether alpha, which grows with ever shorter waves, has left one behind that no ring had. */
static bool is_left_behind(const struct ring_search *search, size_t r) {
    enum { SETTLED = 1024 };
    return search->sums.dimension == 2 && r > SETTLED && search->alpha < search->least_alpha &&
           (double)r > 4 * search->sums.rolloff && ring_alpha(&search->sums) > 2 * search->alpha;
}

static bool search_annuli(struct ring_search *search, struct lattice *lattice, bool pass) {
    search->passed_by = INFINITY;
    search->best_square = search->best_alpha = search->least_alpha = search->most_alpha = NAN;
    search->sums.m0 = search->sums.m2 = search->sums.m4 = 0;
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

int ring_search_run(struct ring_search *search, bool *found, struct error *err) {
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
