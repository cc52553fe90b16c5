#include "core/quantity/network/coarsest.h"
#include <limits.h>
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <suitesparse/cholmod.h>

/* Diagonals are larger by such a part of a node's conductances, so that nodes which are tied to the
 * ends by less than rounding stay positive definite: the first one that does. The conjugate
 * gradients make up for it. */
static const double SHIFTS[] = {1e-12, 1e-9, 1e-6, 1e-3};
enum { SHIFT_COUNT = sizeof SHIFTS / sizeof *SHIFTS };

enum { ENTRIES = 5 }; /* a node: its diagonal, and half of its neighbours */

struct coarsest {
    const struct level *level; /* borrowed */
    size_t nodes;
    cholmod_common common;
    cholmod_triplet *triplet;
    cholmod_factor *factor;
    /* Vectors of a solve, allocated beforehand: where cholmod_solve2 cannot allocate its own, it
     * goes on without. */
    cholmod_dense *load, *solution, *permuted, *beyond;
};

static cholmod_dense *vector(struct coarsest *c, size_t n) {
    return cholmod_allocate_dense(n, 1, n, CHOLMOD_REAL, &c->common);
}

int coarsest_create(struct coarsest **out, const struct level *level, struct error *err) {
    struct coarsest *c = array_create(1, sizeof *c);
    *out = NULL;
    if (c == NULL)
        return error_memory(err, sizeof *c, "a leak");
    c->level = level;
    c->nodes = level->nx * level->ny;
    if (c->nodes > INT_MAX / ENTRIES) { /* its indices are int */
        free(c);
        return error_memory(err, level->nx * level->ny * ENTRIES * 16, "a leak");
    }
    cholmod_start(&c->common);
    c->common.print = 0;
    c->common.supernodal = CHOLMOD_SUPERNODAL;
    c->triplet = cholmod_allocate_triplet(c->nodes, c->nodes, c->nodes * ENTRIES, -1, CHOLMOD_REAL,
                                          &c->common);
    c->load = vector(c, c->nodes);
    c->solution = vector(c, c->nodes);
    c->permuted = vector(c, c->nodes);
    if (c->triplet == NULL || c->load == NULL || c->solution == NULL || c->permuted == NULL) {
        coarsest_destroy(&c);
        return error_memory(err, level->nx * level->ny * ENTRIES * 16, "a leak");
    }
    *out = c;
    return 0;
}

void coarsest_destroy(struct coarsest **coarsest) {
    struct coarsest *c = *coarsest;
    if (c == NULL)
        return;
    cholmod_free_triplet(&c->triplet, &c->common);
    cholmod_free_factor(&c->factor, &c->common);
    cholmod_free_dense(&c->load, &c->common);
    cholmod_free_dense(&c->solution, &c->common);
    cholmod_free_dense(&c->permuted, &c->common);
    cholmod_free_dense(&c->beyond, &c->common);
    cholmod_finish(&c->common);
    free(c);
    *coarsest = NULL;
}

/* A triplet, its matrix, four vectors and a factor with nested dissection. */
double coarsest_bytes(size_t nodes) {
    double n = (double)nodes;
    return n * (16 * ENTRIES + 12 * ENTRIES + 8 * 4) + 8 * 8 * n * log2(n + 2);
}

/* Sum of the sizes of a node's conductances. */
static double size_at(const struct level *level, size_t j, size_t i) {
    const double *e = level->e, *n = level->n, *ne = level->ne, *nw = level->nw;
    size_t k = level_row(level, j) + i, b = level_below(level, j) + i;
    double size = fabs(e[k]) + fabs(e[k - 1]) + fabs(n[k]) + fabs(n[b]) + fabs(level->s[k]);
    if (ne != NULL)
        size += fabs(ne[k]) + fabs(nw[k]) + fabs(ne[b - 1]) + fabs(nw[b + 1]);
    return size;
}

static double value_at(const double *x, size_t k) {
    return x != NULL ? x[k] : 0;
}

static double inverse_of(const struct level *level, size_t node) {
    return level->inverse[level_row(level, node / level->nx) + node % level->nx];
}

static void put(cholmod_triplet *matrix, size_t a, size_t b, double value) {
    ((int *)matrix->i)[matrix->nnz] = (int)(a > b ? a : b);
    ((int *)matrix->j)[matrix->nnz] = (int)(a > b ? b : a);
    ((double *)matrix->x)[matrix->nnz++] = value;
}

/* The conductance c between nodes a and b, of which one may have cancelled to none. */
static void put_face(struct coarsest *c, size_t a, size_t b, double conductance) {
    bool both = inverse_of(c->level, a) > 0 && inverse_of(c->level, b) > 0;
    put(c->triplet, a, b, both ? -conductance : 0);
}

/* CHOLMOD adds entries of the same row and column. Zeros are kept, so that the pattern stays the
 * same. */
static void fill(struct coarsest *c, double shift) {
    const struct level *level = c->level;
    size_t nx = level->nx, ny = level->ny;
    c->triplet->nnz = 0;
    for (size_t j = 0; j < ny; j++)
        for (size_t i = 0; i < nx; i++) {
            size_t k = level_row(level, j) + i, a = j * nx + i, up = (j + 1) % ny * nx + i;
            double inverse = level->inverse[k];
            put(c->triplet, a, a, inverse > 0 ? 1 / inverse + shift * size_at(level, j, i) : 1);
            put_face(c, a, up, level->n[k]);
            if (i + 1 < nx)
                put_face(c, a, a + 1, level->e[k]);
            if (i + 1 < nx)
                put_face(c, a, up + 1, value_at(level->ne, k));
            if (i > 0)
                put_face(c, a, up - 1, value_at(level->nw, k));
        }
}

static int failure(struct coarsest *c, struct error *err) {
    if (c->common.status == CHOLMOD_OUT_OF_MEMORY || c->common.status == CHOLMOD_TOO_LARGE)
        return error_set(err, ERROR_MEMORY,
                         "the leak's factorisation of %zu equations needs too "
                         "much memory",
                         c->nodes);
    return error_set(err, ERROR_NUMERIC, "the conductances of %zu nodes are not positive definite",
                     c->nodes);
}

/* Returns whether the matrix is positive definite; out of memory it has a status of CHOLMOD. */
static bool factorise(struct coarsest *c, double shift) {
    fill(c, shift);
    cholmod_sparse *matrix = cholmod_triplet_to_sparse(c->triplet, 0, &c->common);
    if (matrix != NULL && c->factor == NULL)
        c->factor = cholmod_analyze(matrix, &c->common);
    /* The longest part of a supernode's columns below its diagonal block. */
    if (c->factor != NULL && c->beyond == NULL)
        c->beyond = vector(c, c->factor->maxesize > 0 ? c->factor->maxesize : 1);
    bool done = matrix != NULL && c->factor != NULL && c->beyond != NULL &&
                cholmod_factorize(matrix, c->factor, &c->common) != 0 &&
                c->common.status == CHOLMOD_OK;
    cholmod_free_sparse(&matrix, &c->common);
    return done;
}

int coarsest_factorise(struct coarsest *c, struct error *err) {
    size_t shift = 0;
    bool done = false;
    do
        done = factorise(c, SHIFTS[shift++]);
    while (!done && c->common.status == CHOLMOD_NOT_POSDEF && shift < SHIFT_COUNT);
    return done ? 0 : failure(c, err);
}

int coarsest_solve(struct coarsest *c, struct error *err) {
    const struct level *level = c->level;
    double *load = c->load->x;
    for (size_t j = 0; j < level->ny; j++)
        for (size_t i = 0; i < level->nx; i++) {
            size_t k = level_row(level, j) + i;
            load[j * level->nx + i] = level->inverse[k] > 0 ? level->r[k] : 0;
        }
    if (cholmod_solve2(CHOLMOD_A, c->factor, c->load, NULL, &c->solution, NULL, &c->permuted,
                       &c->beyond, &c->common) == 0)
        return failure(c, err);
    const double *solution = c->solution->x;
    for (size_t j = 0; j < level->ny; j++)
        for (size_t i = 0; i < level->nx; i++)
            level->u[level_row(level, j) + i] = solution[j * level->nx + i];
    return 0;
}
