#include "core/quantity/network/coarsening.h"
#include <stdbool.h>
#include <string.h>

/* --- interpolation --- */

/* A node on a side whose ties to both sides are less than this part of all its own hardly follows
 * the corners, as in a narrow channel between them. Where one of them is closed, the coarser grid
 * has its value there. With 0.39 of the area in contact and 8 points a wave that takes 14 steps,
 * not 40. */
static const double WEAK = 0.1;

static double positive(double x) {
    return x > 0 ? x : 0;
}

/* What a node on a side is tied to. */
struct ties {
    double to_k, to_l, to_ends; /* conductances to the sides of corners k and l, and to the ends */
    double inverse;             /* of all its conductances; 0 without */
};

/* Weights of corners k and l, of the coarser grid, in a node between them. taken: whether a corner
 * stands for a node already; NULL where there is no such corner. */
static void interpolate(struct ties node, double *taken_k, double *taken_l, double *weight_k,
                        double *weight_l) {
    double to_k = positive(node.to_k), to_l = positive(node.to_l);
    double sum = to_k + to_l + positive(node.to_ends);
    bool weak = node.inverse > 0 && sum * node.inverse < WEAK;
    *weight_k = *weight_l = 0;
    if (weak && *taken_k == 0)
        *weight_k = *taken_k = 1;
    else if (weak && taken_l != NULL && *taken_l == 0)
        *weight_l = *taken_l = 1;
    else if (to_k + to_l > 0) {
        *weight_k = to_k / sum;
        *weight_l = to_l / sum;
    }
}

static double at(const double *x, size_t k) {
    return x != NULL ? x[k] : 0;
}

/* u of the coarser grid is scratch: not 0 where a corner is taken. */
static void take_open_corners(const struct level *fine, struct level *coarse) {
    for (size_t J = 0; J < coarse->rows; J++)
        for (size_t I = 0; I < coarse->nx; I++)
            coarse->u[level_row(coarse, J) + I] =
                fine->inverse[level_row(fine, 2 * J) + 2 * I] > 0 ? 1 : 0;
}

static void interpolate_sides(const struct level *fine, struct level *coarse) {
    const double *e = fine->e, *n = fine->n, *ne = fine->ne, *nw = fine->nw;
    const struct interpolation *to = &coarse->to;
    take_open_corners(fine, coarse);
    for (size_t J = 0; J < coarse->rows; J++) {
        size_t up = level_row(coarse, J + 1 < coarse->rows ? J + 1 : 0);
        for (size_t I = 0; I < coarse->nx; I++) {
            size_t K = level_row(coarse, J) + I, L = up + I;
            size_t a = level_row(fine, 2 * J) + 2 * I, b = a + fine->stride;
            size_t below = level_below(fine, 2 * J) + 2 * I;
            const struct ties south = {e[a] + at(nw, a + 1) + at(ne, below),
                                       e[a + 1] + at(ne, a + 1) + at(nw, below + 2), fine->s[a + 1],
                                       fine->inverse[a + 1]};
            const struct ties west = {n[a] + at(ne, a - 1) + at(nw, a + 1),
                                      n[b] + at(nw, b) + at(ne, b), fine->s[b], fine->inverse[b]};
            double *taken = coarse->u;
            interpolate(south, &taken[K], I + 1 < coarse->nx ? &taken[K + 1] : NULL, &to->x_a[K],
                        &to->x_b[K]);
            interpolate(west, &taken[K], &taken[L], &to->y_a[K], &to->y_c[K]);
        }
    }
}

/* A node's value as a combination of those at the corners of a cell. */
enum { A, B, C, D, CORNERS };
struct combination {
    double weight[CORNERS];
    double missing; /* 1 less the sum of the weights, without rounding */
};

static const struct combination CORNER[CORNERS] = {
    {{1, 0, 0, 0}, 0}, {{0, 1, 0, 0}, 0}, {{0, 0, 1, 0}, 0}, {{0, 0, 0, 1}, 0}};

static bool is_lost(const struct combination *node) {
    return node->missing >= 1;
}

/* Of a node on a side, between corners k and l. */
static struct combination side(double s, int k, double to_k, int l, double to_l) {
    struct combination out = {{0}, 1};
    double sum = to_k + to_l;
    out.weight[k] = to_k;
    out.weight[l] = to_l;
    if (sum > 0)
        out.missing = s > 0 ? positive(1 - sum) : 0;
    return out;
}

static void add(double c, const struct combination *from, double *sum, struct combination *out) {
    if (!(c > 0) || is_lost(from))
        return;
    for (int k = 0; k < CORNERS; k++)
        out->weight[k] += c * from->weight[k];
    out->missing += c * from->missing;
    *sum += c;
}

/* The nodes of a cell that the coarser grid lacks, and where they are. */
struct cell {
    struct combination south, west, north, east, middle;
    size_t a, b; /* the finer grid's index of the corner A, and of the node above it */
    size_t c;    /* ... of the corner C */
};

static void middle_of(const struct level *fine, struct cell *cell) {
    const double *e = fine->e, *n = fine->n, *ne = fine->ne, *nw = fine->nw;
    size_t a = cell->a, b = cell->b;
    double s = positive(fine->s[b + 1]), sum = s;
    struct combination *out = &cell->middle;
    *out = (struct combination){{0}, s};
    add(n[a + 1], &cell->south, &sum, out);
    add(n[b + 1], &cell->north, &sum, out);
    add(e[b], &cell->west, &sum, out);
    add(e[b + 1], &cell->east, &sum, out);
    if (ne != NULL) {
        add(ne[a], &CORNER[A], &sum, out);
        add(nw[a + 2], &CORNER[B], &sum, out);
        add(nw[b + 1], &CORNER[C], &sum, out);
        add(ne[b + 1], &CORNER[D], &sum, out);
    }
    if (!(sum > s)) {
        *out = (struct combination){{0}, 1};
        return;
    }
    for (int k = 0; k < CORNERS; k++)
        out->weight[k] /= sum;
    out->missing /= sum;
}

static void cell_of(const struct level *fine, const struct level *coarse, size_t I, size_t J,
                    struct cell *cell) {
    const struct interpolation *to = &coarse->to;
    size_t a = level_row(fine, 2 * J) + 2 * I, c = level_above(fine, 2 * J + 1) + 2 * I;
    size_t K = level_row(coarse, J) + I;
    size_t above = level_row(coarse, J + 1 < coarse->rows ? J + 1 : 0) + I;
    cell->a = a;
    cell->b = a + fine->stride;
    cell->c = c;
    cell->south = side(fine->s[a + 1], A, to->x_a[K], B, to->x_b[K]);
    cell->north = side(fine->s[c + 1], C, to->x_a[above], D, to->x_b[above]);
    cell->west = side(fine->s[cell->b], A, to->y_a[K], C, to->y_c[K]);
    cell->east = side(fine->s[cell->b + 2], B, to->y_a[K + 1], D, to->y_c[K + 1]);
    middle_of(fine, cell);
}

/* --- the coarser network --- */

/* Conductances between the corners of a cell, and to the ends. */
struct small_network {
    double ab, ac, ad, bc, bd, cd, s[CORNERS];
};

/* Adds a conductance c between two nodes. With d the difference of their combinations its energy is
 * c (d.v)^2 = -c sum over k < l of d_k d_l (v_k - v_l)^2 + c (sum of d) sum of d_k v_k^2. */
static void connect(double c, const struct combination *p, const struct combination *q,
                    struct small_network *out) {
    if (c == 0)
        return;
    double d[CORNERS], rest = c * (q->missing - p->missing);
    for (int k = 0; k < CORNERS; k++)
        d[k] = p->weight[k] - q->weight[k];
    out->ab -= c * d[A] * d[B];
    out->ac -= c * d[A] * d[C];
    out->ad -= c * d[A] * d[D];
    out->bc -= c * d[B] * d[C];
    out->bd -= c * d[B] * d[D];
    out->cd -= c * d[C] * d[D];
    if (rest != 0)
        for (int k = 0; k < CORNERS; k++)
            out->s[k] += rest * d[k];
}

/* Adds a conductance to the ends. */
static void ground(double c, const struct combination *p, struct small_network *out) {
    if (c == 0 || is_lost(p))
        return;
    const double *d = p->weight;
    out->ab -= c * d[A] * d[B];
    out->ac -= c * d[A] * d[C];
    out->ad -= c * d[A] * d[D];
    out->bc -= c * d[B] * d[C];
    out->bd -= c * d[B] * d[D];
    out->cd -= c * d[C] * d[D];
    for (int k = 0; k < CORNERS; k++)
        out->s[k] += c * (1 - p->missing) * d[k];
}

/* Adds what a cell has, with its south and west sides, whose other sides are other cells'. */
static void gather(const struct level *fine, const struct cell *cell, struct small_network *out) {
    const double *e = fine->e, *n = fine->n, *ne = fine->ne, *nw = fine->nw, *s = fine->s;
    size_t a = cell->a, b = cell->b;
    connect(e[a], &CORNER[A], &cell->south, out);
    connect(e[a + 1], &cell->south, &CORNER[B], out);
    connect(n[a], &CORNER[A], &cell->west, out);
    connect(n[b], &cell->west, &CORNER[C], out);
    connect(n[a + 1], &cell->south, &cell->middle, out);
    connect(n[b + 1], &cell->middle, &cell->north, out);
    connect(e[b], &cell->west, &cell->middle, out);
    connect(e[b + 1], &cell->middle, &cell->east, out);
    if (ne != NULL) {
        connect(ne[a], &CORNER[A], &cell->middle, out);
        connect(ne[b + 1], &cell->middle, &CORNER[D], out);
        connect(nw[a + 2], &CORNER[B], &cell->middle, out);
        connect(nw[b + 1], &cell->middle, &CORNER[C], out);
        connect(ne[a + 1], &cell->south, &cell->east, out);
        connect(ne[b], &cell->west, &cell->north, out);
        connect(nw[a + 1], &cell->south, &cell->west, out);
        connect(nw[b + 2], &cell->east, &cell->north, out);
    }
    ground(s[a], &CORNER[A], out);
    ground(s[a + 1], &cell->south, out);
    ground(s[b], &cell->west, out);
    ground(s[b + 1], &cell->middle, out);
}

/* Rows of a coarser grid must be even in number: where they are not, a row without conductances
 * along x is added between the last and the first, whose conductances are twice those that it
 * parts. A diagonal one of c becomes c along each side of its cell, which has no less energy:
 * (a + b)^2 <= 2 a^2 + 2 b^2 by both paths. So the network stays positive definite. */
static void add_row(struct level *coarse) {
    double *e = coarse->e, *n = coarse->n, *ne = coarse->ne, *nw = coarse->nw;
    size_t last = level_row(coarse, coarse->rows - 1), added = last + coarse->stride;
    size_t first = level_row(coarse, 0);
    for (size_t i = 0; i + 1 < coarse->nx; i++) {
        double both = positive(ne[last + i]) + positive(nw[last + i + 1]);
        e[last + i] += both;
        e[first + i] += both;
        n[last + i] += both;
        n[last + i + 1] += both;
    }
    for (size_t i = 0; i < coarse->nx; i++) {
        n[last + i] = n[added + i] = 2 * positive(n[last + i]);
        ne[last + i] = nw[last + i] = 0;
    }
}

void coarsening_make(const struct level *fine, struct level *coarse) {
    double *const sums[] = {coarse->e, coarse->n, coarse->ne, coarse->nw, coarse->s};
    for (size_t a = 0; a < sizeof sums / sizeof *sums; a++)
        memset(sums[a], 0, level_size(coarse) * sizeof(double));
    interpolate_sides(fine, coarse);
    const struct interpolation *to = &coarse->to;
    for (size_t J = 0; J < coarse->rows; J++)
        for (size_t I = 0; I < coarse->nx; I++) {
            struct cell cell;
            struct small_network net = {0};
            size_t K = level_row(coarse, J) + I;
            size_t up = level_row(coarse, J + 1 < coarse->rows ? J + 1 : 0) + I;
            cell_of(fine, coarse, I, J, &cell);
            gather(fine, &cell, &net);
            to->z_a[K] = cell.middle.weight[A];
            to->z_b[K] = cell.middle.weight[B];
            to->z_c[K] = cell.middle.weight[C];
            to->z_d[K] = cell.middle.weight[D];
            coarse->e[K] += net.ab;
            coarse->e[up] += net.cd;
            coarse->n[K] += net.ac;
            coarse->n[K + 1] += net.bd;
            coarse->ne[K] += net.ad;
            coarse->nw[K + 1] += net.bc;
            coarse->s[K] += net.s[A];
            coarse->s[K + 1] += net.s[B];
            coarse->s[up] += net.s[C];
            coarse->s[up + 1] += net.s[D];
        }
    if (coarse->ny > coarse->rows)
        add_row(coarse);
}

/* --- between the grids --- */

/* all: from all nodes of the fine grid, else from the corners and middles of coarse cells alone. */
static inline void restrict_from(const struct level *fine, struct level *coarse, bool all) {
    const struct interpolation *to = &coarse->to;
    const double *from = fine->residual;
    for (size_t J = 0; J < coarse->rows; J++) {
        size_t row = level_row(coarse, J);
        size_t under = level_row(coarse, J > 0 ? J - 1 : coarse->rows - 1);
        /* from the column before the first */
        const double *a = from + level_row(fine, 2 * J) - 1, *b = a + fine->stride;
        const double *below = from + level_below(fine, 2 * J) - 1;
        for (size_t I = 0; I < coarse->nx; I++) {
            size_t K = row + I, U = under + I, i = 2 * I + 1;
            double r = a[i];
            if (all)
                r = r + to->x_a[K] * a[i + 1] + to->x_b[K - 1] * a[i - 1] + to->y_a[K] * b[i] +
                    to->y_c[U] * below[i];
            coarse->r[K] = r + to->z_a[K] * b[i + 1] + to->z_b[K - 1] * b[i - 1] +
                           to->z_c[U] * below[i + 1] + to->z_d[U - 1] * below[i - 1];
        }
    }
}

/* all: to all nodes of the fine grid, else as above. */
static inline void prolong_to(const struct level *coarse, struct level *fine, bool all) {
    const struct interpolation *to = &coarse->to;
    for (size_t J = 0; J < coarse->rows; J++) {
        size_t row = level_row(coarse, J);
        size_t up = level_row(coarse, J + 1 < coarse->rows ? J + 1 : 0);
        double *a = fine->u + level_row(fine, 2 * J), *b = a + fine->stride;
        for (size_t I = 0; I < coarse->nx; I++) {
            size_t K = row + I, i = 2 * I;
            const double *low = coarse->u + K, *high = coarse->u + up + I;
            a[i] += low[0];
            if (all) {
                a[i + 1] += to->x_a[K] * low[0] + to->x_b[K] * low[1];
                b[i] += to->y_a[K] * low[0] + to->y_c[K] * high[0];
            }
            b[i + 1] += to->z_a[K] * low[0] + to->z_b[K] * low[1] + to->z_c[K] * high[0] +
                        to->z_d[K] * high[1];
        }
    }
}

void coarsening_restrict(const struct level *fine, struct level *coarse) {
    restrict_from(fine, coarse, true);
}

void coarsening_prolong(const struct level *coarse, struct level *fine) {
    prolong_to(coarse, fine, true);
}

void coarsening_restrict_finest(const struct level *fine, struct level *coarse) {
    restrict_from(fine, coarse, false);
}

void coarsening_prolong_finest(const struct level *coarse, struct level *fine) {
    prolong_to(coarse, fine, false);
}
