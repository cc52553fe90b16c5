#include "core/quantity/network/relaxation.h"
#include "core/vectors.h"
#include <math.h>
#include <string.h>

/* A node whose conductances cancel to less than this part of them has none. */
static const double CANCELLED = 1e-14;

void relaxation_prepare(struct level *level) {
    const double *e = level->e, *n = level->n, *ne = level->ne, *nw = level->nw;
    for (size_t j = 0; j < level->ny; j++) {
        size_t row = level_row(level, j), below = level_below(level, j);
        for (size_t i = 0; i < level->nx; i++) {
            size_t k = row + i, b = below + i;
            double sum = e[k] + e[k - 1] + n[k] + n[b] + level->s[k];
            double size = fabs(e[k]) + fabs(e[k - 1]) + fabs(n[k]) + fabs(n[b]);
            if (ne != NULL) {
                sum += ne[k] + nw[k] + ne[b - 1] + nw[b + 1];
                size += fabs(ne[k]) + fabs(nw[k]) + fabs(ne[b - 1]) + fabs(nw[b + 1]);
            }
            level->inverse[k] = sum > CANCELLED * size ? 1 / sum : 0;
        }
    }
}

/* Rows of arrays about a row of nodes; each from its first node. */
struct rows {
    size_t nx;
    const double *e, *n, *n_below, *ne, *ne_below, *nw, *nw_below, *inverse, *r;
    const double *above, *below; /* of u */
    double *u;
};

static struct rows rows_of(const struct level *level, size_t j) {
    size_t row = level_row(level, j), below = level_below(level, j), above = level_above(level, j);
    return (struct rows){level->nx,        level->e + row,    level->n + row,
                         level->n + below, level->ne + row,   level->ne + below,
                         level->nw + row,  level->nw + below, level->inverse + row,
                         level->r + row,   level->u + above,  level->u + below,
                         level->u + row};
}

/* What flows into a node from its neighbours at a pressure of 0. */
static inline double inflow(const struct rows *w, ptrdiff_t i) {
    return w->e[i] * w->u[i + 1] + w->e[i - 1] * w->u[i - 1] + w->n[i] * w->above[i] +
           w->n_below[i] * w->below[i] + w->ne[i] * w->above[i + 1] +
           w->ne_below[i - 1] * w->below[i - 1] + w->nw[i] * w->above[i - 1] +
           w->nw_below[i + 1] * w->below[i + 1];
}

static void relax_colour(const struct level *level, size_t first, size_t row) {
    for (size_t j = row; j < level->ny; j += 2) {
        struct rows w = rows_of(level, j);
        for (ptrdiff_t i = (ptrdiff_t)first; i < (ptrdiff_t)w.nx; i += 2)
            w.u[i] = w.inverse[i] * (w.r[i] + inflow(&w, i));
    }
}

void relaxation_first(const struct level *level) {
    memset(level->u, 0, level_size(level) * sizeof *level->u);
    relax_colour(level, 0, 0);
    relax_colour(level, 1, 0);
    relax_colour(level, 0, 1);
    relax_colour(level, 1, 1);
}

void relaxation_second(const struct level *level) {
    relax_colour(level, 1, 1);
    relax_colour(level, 0, 1);
    relax_colour(level, 1, 0);
    relax_colour(level, 0, 0);
}

void relaxation_residual(const struct level *level) {
    for (size_t j = 0; j < level->ny; j++) {
        struct rows w = rows_of(level, j);
        double *out = level->residual + level_row(level, j);
        for (ptrdiff_t i = 0; i < (ptrdiff_t)w.nx; i++)
            out[i] = w.inverse[i] > 0 ? w.r[i] + inflow(&w, i) - w.u[i] / w.inverse[i] : 0;
    }
}

/* --- the finest level --- */

static struct rows finest_rows(const struct level *level, size_t j) {
    size_t row = level_row(level, j), below = level_below(level, j), above = level_above(level, j);
    return (struct rows){.nx = level->nx,
                         .e = level->e + row,
                         .n = level->n + row,
                         .n_below = level->n + below,
                         .inverse = level->inverse + row,
                         .r = level->r + row,
                         .above = level->u + above,
                         .below = level->u + below,
                         .u = level->u + row};
}

static inline double finest_inflow(const struct rows *w, ptrdiff_t i) {
    return w->e[i] * w->u[i + 1] + w->e[i - 1] * w->u[i - 1] + w->n[i] * w->above[i] +
           w->n_below[i] * w->below[i];
}

static void relax_finest(const struct level *level, size_t j, size_t first) {
    struct rows w = finest_rows(level, j);
    for (ptrdiff_t i = (ptrdiff_t)first; i < (ptrdiff_t)w.nx; i += 2)
        w.u[i] = w.inverse[i] * (w.r[i] + finest_inflow(&w, i));
}

void relaxation_first_finest(const struct level *level) {
    for (size_t j = 0; j < level->ny; j++) {
        struct rows w = finest_rows(level, j);
        for (size_t i = 0; i < w.nx; i++)
            w.u[i] = w.inverse[i] * w.r[i];
    }
    for (size_t j = 0; j < level->ny; j++) {
        struct rows w = finest_rows(level, j);
        for (ptrdiff_t i = (ptrdiff_t)(1 - j % 2); i < (ptrdiff_t)w.nx; i += 2)
            w.u[i] += w.inverse[i] * finest_inflow(&w, i);
    }
    for (size_t j = 0; j < level->ny; j++) {
        struct rows w = finest_rows(level, j);
        double *out = level->residual + level_row(level, j);
        for (ptrdiff_t i = (ptrdiff_t)(j % 2); i < (ptrdiff_t)w.nx; i += 2)
            out[i] = finest_inflow(&w, i);
    }
}

void relaxation_second_finest(const struct level *level) {
    for (size_t j = 0; j < level->ny; j++)
        relax_finest(level, j, 1 - j % 2);
    for (size_t j = 0; j < level->ny; j++)
        relax_finest(level, j, j % 2);
}
