#include "core/full/linear/factorisation.h"
#include <stdint.h>
#include <stdlib.h>
#include <suitesparse/cholmod.h>

enum { HELD = -1 };

struct factorisation {
    const struct mesh *mesh; /* borrowed */
    int *unknown;            /* by degree of freedom: number of its unknown, or HELD */
    bool *held;              /* by unknown: whether contact holds it */
    size_t unknowns;
    size_t links; /* of the tangent that was analysed */
    cholmod_common common;
    cholmod_triplet *triplet;
    cholmod_factor *factor;
    /* Vectors of a solve, allocated beforehand: where cholmod_solve2 cannot allocate its own, it
     * goes on without. */
    cholmod_dense *load, *solution, *permuted, *beyond;
};

static void number_unknowns(struct factorisation *f) {
    const struct mesh *mesh = f->mesh;
    size_t d = (size_t)mesh->dimension, far_side = mesh_far_side(mesh) * d;
    int count = 0, common = HELD;
    for (size_t n = 0; n < mesh_degrees_of_freedom(mesh); n++) {
        bool vertical = n % d == d - 1;
        if (n >= far_side && vertical) {
            if (common == HELD)
                common = count++;
            f->unknown[n] = common;
        } else
            f->unknown[n] = n >= far_side && n < far_side + d ? HELD : count++;
    }
    f->unknowns = (size_t)count;
}

static cholmod_dense *vector(struct factorisation *f, size_t n) {
    return cholmod_allocate_dense(n, 1, n, CHOLMOD_REAL, &f->common);
}

static size_t entries_of(const struct mesh *mesh) {
    return mesh_degrees_of_freedom(mesh) * (mesh->dimension == 2 ? 6 : 18) *
               (size_t)mesh->dimension +
           mesh->face;
}

int factorisation_create(struct factorisation **out, const struct mesh *mesh, struct error *err) {
    *out = NULL;
    size_t degrees_of_freedom = mesh_degrees_of_freedom(mesh), entries = entries_of(mesh);
    struct factorisation *f = array_create(1, sizeof *f);
    if (f == NULL)
        return error_memory(err, sizeof *f, "a factorisation");
    cholmod_start(&f->common);
    f->common.print = 0;
    f->common.supernodal = CHOLMOD_SUPERNODAL;
    f->mesh = mesh;
    f->unknown = array_create(degrees_of_freedom, sizeof *f->unknown);
    f->held = array_create(degrees_of_freedom, sizeof *f->held);
    int status = 0;
    if (f->unknown != NULL && f->held != NULL) {
        number_unknowns(f);
        f->triplet = cholmod_allocate_triplet(f->unknowns, f->unknowns, entries, -1, CHOLMOD_REAL,
                                              &f->common);
        f->load = vector(f, f->unknowns);
        f->solution = vector(f, f->unknowns);
        f->permuted = vector(f, f->unknowns);
    }
    if (f->triplet == NULL || f->load == NULL || f->solution == NULL || f->permuted == NULL) {
        status = error_memory(err, entries * 16, "a factorisation");
        factorisation_destroy(&f);
    }
    *out = f;
    return status;
}

void factorisation_destroy(struct factorisation **factorisation) {
    struct factorisation *f = *factorisation;
    if (f == NULL)
        return;
    cholmod_free_triplet(&f->triplet, &f->common);
    cholmod_free_factor(&f->factor, &f->common);
    cholmod_free_dense(&f->load, &f->common);
    cholmod_free_dense(&f->solution, &f->common);
    cholmod_free_dense(&f->permuted, &f->common);
    cholmod_free_dense(&f->beyond, &f->common);
    cholmod_finish(&f->common);
    free(f->unknown);
    free(f->held);
    free(f);
    *factorisation = NULL;
}

/* Appends the entries of one d x d block with first row r0 and first column c0, and returns the new
 * count. The matrix stores its lower half. twice: the tangent stores the block and its transpose,
 * of which only one may be taken. */
static size_t fill_block(struct factorisation *f, size_t r0, size_t c0, bool twice,
                         const double *value, size_t count) {
    size_t d = (size_t)f->mesh->dimension;
    int *row = f->triplet->i, *column = f->triplet->j;
    double *entry = f->triplet->x;
    for (size_t i = 0; i < d; i++)
        for (size_t j = 0; j < d; j++) {
            int r = f->unknown[r0 + i], c = f->unknown[c0 + j];
            if (r == HELD || c == HELD || (twice && r < c))
                continue;
            row[count] = r < c ? c : r;
            column[count] = r < c ? r : c;
            entry[count++] = f->held[r] || f->held[c] ? 0 : value[i * d + j];
        }
    return count;
}

static size_t fill_link(struct factorisation *f, const struct tangent_link *link, size_t count) {
    int *row = f->triplet->i, *column = f->triplet->j;
    double *entry = f->triplet->x;
    for (int i = 0; i < LINK_MOST; i++)
        for (int j = 0; j < LINK_MOST; j++) {
            int r = f->unknown[link->at[i]], c = f->unknown[link->at[j]];
            if (r < c || f->held[r] || f->held[c])
                continue;
            row[count] = r;
            column[count] = c;
            entry[count++] = link->stiffness[i][j];
        }
    return count;
}

/* Makes room for the entries of links. What was analysed without them, or with others, is
 * forgotten. */
static bool make_room(struct factorisation *f, const struct tangent *tangent) {
    if (tangent->links == 0 && f->links == 0)
        return true;
    size_t most = entries_of(f->mesh) + tangent->links * LINK_MOST * LINK_MOST;
    f->links = tangent->links;
    cholmod_free_factor(&f->factor, &f->common);
    cholmod_free_dense(&f->beyond, &f->common);
    return f->triplet->nzmax >= most ||
           cholmod_reallocate_triplet(most, f->triplet, &f->common) != 0;
}

/* CHOLMOD adds entries of the same row and column. Zeros are kept, so that the pattern stays the
 * same. */
static void fill(struct factorisation *f, const struct tangent *tangent) {
    const struct mesh *mesh = f->mesh;
    size_t d = (size_t)mesh->dimension, count = 0, node = 0, neighbour[NEIGHBOURS_MOST];
    for (size_t level = 0; level <= mesh->layers; level++)
        for (size_t j = 0; j < mesh->level[level].ny; j++)
            for (size_t i = 0; i < mesh->level[level].nx; i++, node++) {
                tangent_neighbours(mesh, level, j, i, neighbour);
                for (size_t slot = 0; slot < tangent->slots && neighbour[slot] != SIZE_MAX; slot++)
                    count =
                        fill_block(f, node * d, neighbour[slot] * d, slot < tangent->slots / 2,
                                   tangent->values + (node * tangent->slots + slot) * d * d, count);
            }
    for (size_t l = 0; l < tangent->links; l++)
        count = fill_link(f, &tangent->link[l], count);
    for (size_t u = 0; u < f->unknowns; u++)
        if (f->held[u]) {
            ((int *)f->triplet->i)[count] = ((int *)f->triplet->j)[count] = (int)u;
            ((double *)f->triplet->x)[count++] = 1;
        }
    f->triplet->nnz = count;
}

static int failure(struct factorisation *f, struct error *err) {
    if (f->common.status == CHOLMOD_OUT_OF_MEMORY || f->common.status == CHOLMOD_TOO_LARGE)
        return error_set(err, ERROR_MEMORY,
                         "the factorisation of %zu equations needs too much "
                         "memory",
                         f->unknowns);
    return error_set(err, ERROR_NUMERIC, "the stiffness of the block is not positive definite");
}

int factorisation_run(struct factorisation *f, const struct tangent *tangent, const bool *active,
                      struct error *err) {
    for (size_t u = 0; u < f->unknowns; u++)
        f->held[u] = false;
    for (size_t node = 0; node < f->mesh->face; node++)
        f->held[f->unknown[mesh_vertical(f->mesh, node)]] = active[node];
    if (!make_room(f, tangent))
        return failure(f, err);
    fill(f, tangent);
    cholmod_sparse *matrix = cholmod_triplet_to_sparse(f->triplet, 0, &f->common);
    if (matrix != NULL && f->factor == NULL)
        f->factor = cholmod_analyze(matrix, &f->common);
    /* The longest part of a supernode's columns below its diagonal block. */
    if (f->factor != NULL && f->beyond == NULL)
        f->beyond = vector(f, f->factor->maxesize > 0 ? f->factor->maxesize : 1);
    bool done = matrix != NULL && f->factor != NULL && f->beyond != NULL &&
                cholmod_factorize(matrix, f->factor, &f->common) != 0 &&
                f->common.status == CHOLMOD_OK;
    int status = done ? 0 : failure(f, err);
    cholmod_free_sparse(&matrix, &f->common);
    return status;
}

int factorisation_solve(struct factorisation *f, double *x, struct error *err) {
    double *load = f->load->x;
    size_t degrees_of_freedom = mesh_degrees_of_freedom(f->mesh);
    for (size_t u = 0; u < f->unknowns; u++)
        load[u] = 0;
    for (size_t n = 0; n < degrees_of_freedom; n++)
        if (f->unknown[n] != HELD && !f->held[f->unknown[n]])
            load[f->unknown[n]] += x[n];
    if (cholmod_solve2(CHOLMOD_A, f->factor, f->load, NULL, &f->solution, NULL, &f->permuted,
                       &f->beyond, &f->common) == 0)
        return failure(f, err);
    const double *displacement = f->solution->x;
    for (size_t n = 0; n < degrees_of_freedom; n++)
        x[n] = f->unknown[n] == HELD ? 0 : displacement[f->unknown[n]];
    return 0;
}
