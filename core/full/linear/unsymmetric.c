#include "core/full/linear/unsymmetric.h"
#include "core/full/linear/hessenberg.h"
#include "core/full/linear/vectors.h"
#include <limits.h>
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <suitesparse/umfpack.h>

/* Solves with an old factorisation, after which it is made anew. */
enum { BASIS = 16 };
_Static_assert((int)BASIS <= (int)HESSENBERG_MOST, "a longer basis than the matrix has");

struct unsymmetric {
    const struct mesh *mesh; /* borrowed */
    int *unknown; /* by degree of freedom: number of its unknown; shear and flat are the last two */
    size_t unknowns, entries; /* entries: triplets, at most */
    size_t links;             /* of the tangent that was analysed */
    size_t count;             /* of triplets */
    int *row, *column;        /* triplets, as value */
    double *value;
    int *start, *index; /* compressed columns, as number */
    double *number;
    double *load, *solution;
    double *basis[BASIS + 1]; /* orthonormal residuals */
    double *direction[BASIS]; /* preconditioned */
    struct hessenberg hessenberg;
    void *symbolic, *numeric;
    double control[UMFPACK_CONTROL];
};

static size_t entries_of(const struct mesh *mesh) {
    /* Four values a slot, of which those to the level below also stand in its rows; of the face's
     * rows along it twice as many; 5 more a node of the face, 2 a node of the far side. */
    return mesh->nodes * (3 + 2 * 3) * 4 + mesh->face * (6 * 2 + 5) +
           level_nodes(&mesh->level[mesh->layers]) * 2 + 2;
}

static void number_unknowns(struct unsymmetric *lu) {
    const struct mesh *mesh = lu->mesh;
    size_t far_side = mesh_vertical(mesh, mesh_far_side(mesh));
    int count = 0;
    for (size_t n = 0; n < mesh_degrees_of_freedom(mesh); n++)
        lu->unknown[n] = n > far_side && n % 2 == 1 ? lu->unknown[far_side] : count++;
    lu->unknowns = (size_t)count + 2;
}

static int arrays_create(struct unsymmetric *lu, struct error *err) {
    size_t degrees_of_freedom = mesh_degrees_of_freedom(lu->mesh), n = degrees_of_freedom + 2;
    lu->entries = entries_of(lu->mesh);
    lu->unknown = array_create(degrees_of_freedom, sizeof *lu->unknown);
    lu->row = array_create(lu->entries, sizeof *lu->row);
    lu->column = array_create(lu->entries, sizeof *lu->column);
    lu->value = array_create(lu->entries, sizeof *lu->value);
    lu->start = array_create(n + 1, sizeof *lu->start);
    lu->index = array_create(lu->entries, sizeof *lu->index);
    lu->number = array_create(lu->entries, sizeof *lu->number);
    lu->load = array_create(n, sizeof *lu->load);
    lu->solution = array_create(n, sizeof *lu->solution);
    for (size_t b = 0; b < 2 * BASIS + 1; b++) {
        double **array = b <= BASIS ? &lu->basis[b] : &lu->direction[b - BASIS - 1];
        *array = array_create(n, sizeof **array);
        if (*array == NULL)
            return error_memory(err, n * sizeof **array, "equations with friction");
    }
    if (lu->unknown == NULL || lu->row == NULL || lu->column == NULL || lu->value == NULL ||
        lu->start == NULL || lu->index == NULL || lu->number == NULL || lu->load == NULL ||
        lu->solution == NULL)
        return error_memory(err, (size_t)unsymmetric_bytes(lu->mesh), "equations with friction");
    return 0;
}

int unsymmetric_create(struct unsymmetric **out, const struct mesh *mesh, struct error *err) {
    *out = NULL;
    if (mesh->dimension != 2)
        return error_set(
            err, ERROR_INPUT,
            "a sparse factorisation with friction is of profiles, not of surfaces of %zu "
            "x %zu nodes",
            mesh->level[0].nx, mesh->level[0].ny);
    if (entries_of(mesh) > INT_MAX)
        return error_set(err, ERROR_INPUT,
                         "friction at finite strain on a mesh of %zu nodes; allowed: matrices of "
                         "%d entries, where these have %zu",
                         mesh->nodes, INT_MAX, entries_of(mesh));
    struct unsymmetric *lu = array_create(1, sizeof *lu);
    if (lu == NULL)
        return error_memory(err, sizeof *lu, "equations with friction");
    lu->mesh = mesh;
    int status = arrays_create(lu, err);
    if (status == 0) {
        number_unknowns(lu);
        umfpack_di_defaults(lu->control);
        lu->control[UMFPACK_PRL] = 0;
        lu->control[UMFPACK_IRSTEP] = 0;
        lu->control[UMFPACK_STRATEGY] = UMFPACK_STRATEGY_SYMMETRIC;
    } else
        unsymmetric_destroy(&lu);
    *out = lu;
    return status;
}

void unsymmetric_destroy(struct unsymmetric **handle) {
    struct unsymmetric *lu = *handle;
    if (lu == NULL)
        return;
    umfpack_di_free_symbolic(&lu->symbolic);
    umfpack_di_free_numeric(&lu->numeric);
    free(lu->unknown);
    free(lu->row);
    free(lu->column);
    free(lu->value);
    free(lu->start);
    free(lu->index);
    free(lu->number);
    free(lu->load);
    free(lu->solution);
    for (size_t b = 0; b <= BASIS; b++)
        free(lu->basis[b]);
    for (size_t b = 0; b < BASIS; b++)
        free(lu->direction[b]);
    free(lu);
    *handle = NULL;
}

double unsymmetric_bytes(const struct mesh *mesh) {
    double entries = (double)entries_of(mesh), unknowns = (double)mesh_degrees_of_freedom(mesh) + 2;
    return entries * (2 * sizeof(double) + 3 * sizeof(int)) +
           unknowns * ((2 * BASIS + 3) * sizeof(double) + 2 * sizeof(int));
}

/* --- the matrix --- */

static void put(struct unsymmetric *lu, int row, int column, double value) {
    lu->row[lu->count] = row;
    lu->column[lu->count] = column;
    lu->value[lu->count++] = value;
}

/* Puts the derivative of force i of a node by displacement j of another. Rows of nodes in contact
 * keep the pattern of those of free ones. */
static void put_force(struct unsymmetric *lu, const struct face_conditions *conditions, size_t node,
                      size_t i, int column, double value) {
    bool face = node < lu->mesh->face;
    enum face_node does = face ? conditions->node[node] : NODE_FREE;
    int row = lu->unknown[node * 2 + i];
    bool slides = face_node_slides(does);
    bool stays = does == NODE_FREE || (slides && i == 0);
    put(lu, row, column, stays ? value : 0);
    if (face && i == 1) {
        double share = slides ? -conditions->friction * conditions->direction[node] : 0;
        put(lu, row - 1, column, slides ? share * value : 0);
    }
}

static void put_block(struct unsymmetric *lu, const struct face_conditions *conditions, size_t node,
                      size_t other, const double *value, bool transposed) {
    for (size_t i = 0; i < 2; i++)
        for (size_t j = 0; j < 2; j++)
            put_force(lu, conditions, node, i, lu->unknown[other * 2 + j],
                      value[transposed ? j * 2 + i : i * 2 + j]);
}

static void put_stiffness(struct unsymmetric *lu, const struct tangent *tangent,
                          const struct face_conditions *conditions) {
    const struct mesh *mesh = lu->mesh;
    size_t node = 0, neighbour[NEIGHBOURS_MOST], slots = tangent->slots;
    for (size_t level = 0; level <= mesh->layers; level++)
        for (size_t i = 0; i < mesh->level[level].nx; i++, node++) {
            tangent_neighbours(mesh, level, 0, i, neighbour);
            for (size_t slot = 0; slot < slots && neighbour[slot] != SIZE_MAX; slot++) {
                const double *value = tangent->values + (node * slots + slot) * 4;
                put_block(lu, conditions, node, neighbour[slot], value, false);
                if (slot >= slots / 2)
                    put_block(lu, conditions, neighbour[slot], node, value, true);
            }
        }
}

/* Stiffness of nodes that meet across air. */
static void put_links(struct unsymmetric *lu, const struct tangent *tangent,
                      const struct face_conditions *conditions) {
    for (size_t l = 0; l < tangent->links; l++) {
        const struct tangent_link *link = &tangent->link[l];
        for (size_t i = 0; i < LINK_MOST; i++)
            for (size_t j = 0; j < LINK_MOST; j++)
                put_force(lu, conditions, link->at[i] / 2, link->at[i] % 2,
                          lu->unknown[link->at[j]], link->stiffness[i][j]);
    }
}

/* Makes room for the entries of links. What was analysed without them, or with others, is
 * forgotten. */
static int make_room(struct unsymmetric *lu, const struct tangent *tangent, struct error *err) {
    size_t most = entries_of(lu->mesh) + tangent->links * 2 * LINK_MOST * LINK_MOST;
    if (tangent->links == 0 && lu->links == 0)
        return 0;
    umfpack_di_free_symbolic(&lu->symbolic);
    lu->links = tangent->links;
    if (most <= lu->entries)
        return 0;
    int **const numbers[] = {&lu->row, &lu->column, &lu->index};
    double **const values[] = {&lu->value, &lu->number};
    for (size_t a = 0; a < sizeof numbers / sizeof *numbers; a++) {
        free(*numbers[a]);
        *numbers[a] = array_create(most, sizeof **numbers[a]);
    }
    for (size_t a = 0; a < sizeof values / sizeof *values; a++) {
        free(*values[a]);
        *values[a] = array_create(most, sizeof **values[a]);
    }
    lu->entries = most;
    if (lu->row != NULL && lu->column != NULL && lu->index != NULL && lu->value != NULL &&
        lu->number != NULL)
        return 0;
    lu->entries = 0;
    return error_memory(err, most * (2 * sizeof(double) + 3 * sizeof(int)),
                        "equations with friction");
}

static void put_contact(struct unsymmetric *lu, const struct face_conditions *conditions) {
    const struct level *face = &lu->mesh->level[0];
    double beside = conditions->weighting == GAP_STANDARD ? 1.0 / 6 : 0;
    int flat = (int)lu->unknowns - 1;
    for (size_t i = 0; i < face->nx; i++) {
        bool touches = conditions->node[i] != NODE_FREE,
             sticks = conditions->node[i] == NODE_STICKS;
        size_t left = level_node(face, 0, i == 0 ? face->nx - 1 : i - 1),
               right = level_node(face, 0, i + 1);
        int along = lu->unknown[i * 2], across = along + 1;
        put(lu, across, across, touches ? 1 - 2 * beside : 0);
        put(lu, across, lu->unknown[left * 2 + 1], touches ? beside : 0);
        put(lu, across, lu->unknown[right * 2 + 1], touches ? beside : 0);
        put(lu, along, along, sticks ? 1 : 0);
        put(lu, along, flat, sticks ? -1 : 0);
    }
}

static void put_far_side(struct unsymmetric *lu, const struct face_conditions *conditions) {
    const struct mesh *mesh = lu->mesh;
    int shear = (int)lu->unknowns - 2, flat = shear + 1;
    double share = 1 / (double)level_nodes(&mesh->level[mesh->layers]);
    for (size_t node = mesh_far_side(mesh); node < mesh->nodes; node++) {
        put(lu, lu->unknown[node * 2], shear, share);
        put(lu, shear, lu->unknown[node * 2], share);
    }
    put(lu, flat, shear, conditions->drive->shear);
    put(lu, flat, flat, conditions->drive->flat);
}

static int failure(const struct unsymmetric *lu, int status, struct error *err) {
    if (status == UMFPACK_ERROR_out_of_memory)
        return error_set(err, ERROR_MEMORY, "%zu equations with friction need too much memory",
                         lu->unknowns);
    return error_set(err, ERROR_NUMERIC,
                     "%zu equations with friction have no one solution (UMFPACK: %d)", lu->unknowns,
                     status);
}

int unsymmetric_set(struct unsymmetric *lu, const struct tangent *tangent,
                    const struct face_conditions *conditions, struct error *err) {
    int n = (int)lu->unknowns;
    int status = make_room(lu, tangent, err);
    if (status != 0)
        return status;
    lu->count = 0;
    put_stiffness(lu, tangent, conditions);
    put_links(lu, tangent, conditions);
    put_contact(lu, conditions);
    put_far_side(lu, conditions);
    status = umfpack_di_triplet_to_col(n, n, (int)lu->count, lu->row, lu->column, lu->value,
                                       lu->start, lu->index, lu->number, NULL);
    return status == UMFPACK_OK ? 0 : failure(lu, status, err);
}

void unsymmetric_forget(struct unsymmetric *lu) {
    umfpack_di_free_numeric(&lu->numeric);
}

static int factorise(struct unsymmetric *lu, struct error *err) {
    int n = (int)lu->unknowns, status = UMFPACK_OK;
    unsymmetric_forget(lu);
    if (lu->symbolic == NULL)
        status =
            umfpack_di_symbolic(n, n, lu->start, lu->index, NULL, &lu->symbolic, lu->control, NULL);
    if (status == UMFPACK_OK)
        status = umfpack_di_numeric(lu->start, lu->index, lu->number, lu->symbolic, &lu->numeric,
                                    lu->control, NULL);
    if (status == UMFPACK_OK)
        return 0;
    unsymmetric_forget(lu);
    return failure(lu, status, err);
}

/* --- solutions --- */

/* y = A x */
static void operate(const struct unsymmetric *lu, const double *x, double *y) {
    memset(y, 0, lu->unknowns * sizeof *y);
    for (size_t column = 0; column < lu->unknowns; column++)
        for (int e = lu->start[column]; e < lu->start[column + 1]; e++)
            y[lu->index[e]] += lu->number[e] * x[column];
}

/* x = the inverse of the matrix that was factorised, times r */
static int precondition(struct unsymmetric *lu, const double *r, double *x, struct error *err) {
    int status = umfpack_di_solve(UMFPACK_A, lu->start, lu->index, lu->number, x, r, lu->numeric,
                                  lu->control, NULL);
    return status == UMFPACK_OK ? 0 : failure(lu, status, err);
}

static void combine(struct unsymmetric *lu, size_t count) {
    double factor[BASIS];
    memset(lu->solution, 0, lu->unknowns * sizeof *lu->solution);
    hessenberg_solve(&lu->hessenberg, count, factor);
    for (size_t a = count; a-- > 0;)
        for (size_t i = 0; i < lu->unknowns; i++)
            lu->solution[i] += factor[a] * lu->direction[a][i];
}

/* Extends the basis by direction c, and makes it orthonormal. Returns the size that was left. */
static double extend(struct unsymmetric *lu, size_t c) {
    size_t n = lu->unknowns;
    double *next = lu->basis[c + 1];
    operate(lu, lu->direction[c], next);
    for (size_t a = 0; a <= c; a++) {
        double part = lu->hessenberg.h[a][c] = dot(n, next, lu->basis[a]);
        for (size_t i = 0; i < n; i++)
            next[i] -= part * lu->basis[a][i];
    }
    double size = lu->hessenberg.h[c + 1][c] = sqrt(dot(n, next, next));
    for (size_t i = 0; size > 0 && i < n; i++)
        next[i] /= size;
    return size;
}

/* Solves for the load by minimal residuals. *reached: whether to the tolerance. */
static int iterate(struct unsymmetric *lu, double tolerance, bool *reached,
                   struct unsymmetric_work *work, struct error *err) {
    size_t n = lu->unknowns, c = 0;
    double first = sqrt(dot(n, lu->load, lu->load)), left = first, size = 1;
    for (size_t i = 0; i < n; i++)
        lu->basis[0][i] = first > 0 ? lu->load[i] / first : 0;
    lu->hessenberg.right[0] = first;
    for (; c < BASIS && left > tolerance * first && size > 0; c++) {
        int status = precondition(lu, lu->basis[c], lu->direction[c], err);
        if (status != 0)
            return status;
        size = extend(lu, c);
        left = hessenberg_rotate(&lu->hessenberg, c);
    }
    combine(lu, c);
    work->iterations += c;
    *reached = left <= tolerance * first;
    return 0;
}

int unsymmetric_solve(struct unsymmetric *lu, double tolerance, double *x,
                      struct unsymmetric_work *work, struct error *err) {
    size_t degrees_of_freedom = mesh_degrees_of_freedom(lu->mesh);
    bool reached = false;
    int status = 0;
    memset(lu->load, 0, lu->unknowns * sizeof *lu->load);
    for (size_t n = 0; n < degrees_of_freedom; n++)
        lu->load[lu->unknown[n]] += x[n];
    for (size_t k = 0; k < 2; k++)
        lu->load[lu->unknowns - 2 + k] = x[degrees_of_freedom + k];
    if (lu->numeric != NULL)
        status = iterate(lu, tolerance, &reached, work, err);
    if (status == 0 && !reached) {
        status = factorise(lu, err);
        work->factored++;
        if (status == 0)
            status = iterate(lu, tolerance, &reached, work, err);
    }
    if (status == 0 && !reached)
        status =
            error_set(err, ERROR_NUMERIC, "%zu equations with friction were not solved to %.2g",
                      lu->unknowns, tolerance);
    if (status != 0)
        return status;
    for (size_t n = 0; n < degrees_of_freedom; n++)
        x[n] = lu->solution[lu->unknown[n]];
    for (size_t k = 0; k < 2; k++)
        x[degrees_of_freedom + k] = lu->solution[lu->unknowns - 2 + k];
    return 0;
}
