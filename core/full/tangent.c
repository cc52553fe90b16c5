#include "core/full/tangent.h"
#include "core/sum.h"
#include "core/vectors.h"
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

static size_t slot_count(const struct mesh *mesh) {
    return mesh->dimension == 2 ? 6 : 18;
}

static size_t value_count(const struct mesh *mesh) {
    return mesh_degrees_of_freedom(mesh) * slot_count(mesh) * (size_t)mesh->dimension;
}

int tangent_create(struct tangent **out, const struct mesh *mesh, const struct material *material,
                   bool pressures, struct error *err) {
    *out = NULL;
    struct tangent *tangent = array_create(1, sizeof *tangent);
    if (tangent == NULL)
        return error_memory(err, sizeof *tangent, "a stiffness matrix");
    tangent->mesh = mesh;
    tangent->slots = slot_count(mesh);
    tangent->values = array_create(value_count(mesh), sizeof *tangent->values);
    if (tangent->values == NULL) {
        tangent_destroy(&tangent);
        return error_memory(err, value_count(mesh) * sizeof(double), "a stiffness matrix");
    }
    int status =
        pressures ? volumetric_create(&tangent->volumetric, mesh, material, false, err) : 0;
    if (status != 0)
        tangent_destroy(&tangent);
    *out = tangent;
    return status;
}

void tangent_destroy(struct tangent **tangent) {
    if (*tangent == NULL)
        return;
    volumetric_destroy(&(*tangent)->volumetric);
    free((*tangent)->values);
    free(*tangent);
    *tangent = NULL;
}

double tangent_bytes(const struct mesh *mesh, bool pressures) {
    return (double)value_count(mesh) * sizeof(double) +
           (pressures ? volumetric_bytes(mesh, false) : 0);
}

/* Finds the neighbours of row j, column i within a level: one step back, none and one step on along
 * each axis, x fastest. */
INLINE void neighbours_of(int d, const struct level *level, size_t j, size_t i, size_t *out) {
    const size_t column[3] = {i == 0 ? level->nx - 1 : i - 1, i, i + 1 == level->nx ? 0 : i + 1};
    const size_t row[3] = {j == 0 ? level->ny - 1 : j - 1, j, j + 1 == level->ny ? 0 : j + 1};
    for (size_t r = d == 2; r < (d == 2 ? 2 : 3); r++)
        for (size_t c = 0; c < 3; c++)
            *out++ = level->first + row[r] * level->nx + column[c];
}

/* Finds neighbours in the level and in the next one. For a node between two wide columns of the
 * next level, the last slot along that axis repeats a neighbour, and its values are 0. */
INLINE void neighbours(int d, const struct mesh *mesh, size_t level, size_t j, size_t i,
                       size_t *out) {
    const size_t half = d == 2 ? 3 : 9;
    const struct level *upper = &mesh->level[level];
    neighbours_of(d, upper, j, i, out);
    if (level < mesh->layers) {
        size_t wide = upper[1].width / upper->width;
        neighbours_of(d, upper + 1, j / wide, i / wide, out + half);
    } else
        for (size_t slot = half; slot < 2 * half; slot++)
            out[slot] = SIZE_MAX;
}

void tangent_neighbours(const struct mesh *mesh, size_t level, size_t j, size_t i,
                        size_t neighbour[NEIGHBOURS_MOST]) {
    neighbours(mesh->dimension, mesh, level, j, i, neighbour);
}

/* Adds value x[neighbour] to y at the node and, because the matrix is symmetric, value^T x[node] to
 * y at neighbours in the level below. */
INLINE void apply_node(size_t d, size_t slots, const double *value, const size_t *neighbour,
                       size_t node, const double *x, double *y) {
    double sum[3] = {0}, here[3];
    for (size_t i = 0; i < d; i++)
        here[i] = x[node * d + i];
    for (size_t slot = 0; slot < slots && neighbour[slot] != SIZE_MAX; slot++, value += d * d) {
        const double *there = x + neighbour[slot] * d;
        for (size_t i = 0; i < d; i++)
            for (size_t j = 0; j < d; j++)
                sum[i] += value[i * d + j] * there[j];
        for (size_t j = 0; slot >= slots / 2 && j < d; j++)
            for (size_t i = 0; i < d; i++)
                y[neighbour[slot] * d + j] += value[i * d + j] * here[i];
    }
    for (size_t i = 0; i < d; i++)
        y[node * d + i] += sum[i];
}

INLINE void apply(int d, const struct tangent *tangent, const double *x, double *y) {
    const struct mesh *mesh = tangent->mesh;
    const size_t slots = d == 2 ? 6 : 18, n = (size_t)d;
    size_t neighbour[NEIGHBOURS_MOST], node = 0;
    memset(y, 0, mesh_degrees_of_freedom(mesh) * sizeof *y);
    for (size_t level = 0; level <= mesh->layers; level++)
        for (size_t j = 0; j < mesh->level[level].ny; j++)
            for (size_t i = 0; i < mesh->level[level].nx; i++, node++) {
                neighbours(d, mesh, level, j, i, neighbour);
                apply_node(n, slots, tangent->values + node * slots * n * n, neighbour, node, x, y);
            }
}

WIDE_VECTORS static void apply_stencil(const struct tangent *tangent, const double *x, double *y) {
    if (tangent->mesh->dimension == 2)
        apply(2, tangent, x, y);
    else
        apply(3, tangent, x, y);
}

static void apply_patch(const struct tangent_patch *patch, const double *x, double *y) {
    double by[PATCH_VECTORS] = {0}, factor[PATCH_VECTORS] = {0};
    for (size_t v = 0; v < PATCH_VECTORS; v++)
        for (size_t a = 0; a < 3 * (1 + PATCH_NODES); a++)
            by[v] += patch->vector[v][a] * x[3 * patch->node[a / 3] + a % 3];
    for (size_t v = 0; v < PATCH_VECTORS; v++)
        for (size_t w = 0; w < PATCH_VECTORS; w++)
            factor[v] += patch->matrix[v][w] * by[w];
    for (size_t v = 0; v < PATCH_VECTORS; v++)
        for (size_t a = 0; a < 3 * (1 + PATCH_NODES); a++)
            y[3 * patch->node[a / 3] + a % 3] += patch->vector[v][a] * factor[v];
}

static void apply_friction(const struct tangent_friction *rubbing, const double *x, double *y) {
    double by[FRICTION_VALUES] = {0}, factor[FRICTION_VALUES] = {0};
    for (size_t v = 0; v < FRICTION_VALUES; v++)
        for (size_t a = 0; a <= PATCH_NODES; a++)
            by[v] += rubbing->weight[v / 3][a] * x[3 * rubbing->node[a] + v % 3];
    for (size_t v = 0; v < FRICTION_VALUES; v++)
        for (size_t w = 0; w < FRICTION_VALUES; w++)
            factor[v] += rubbing->matrix[v][w] * by[w];
    for (size_t v = 0; v < FRICTION_VALUES; v++)
        for (size_t a = 0; a <= PATCH_NODES; a++)
            y[3 * rubbing->node[a] + v % 3] += rubbing->weight[v / 3][a] * factor[v];
}

void tangent_apply(const struct tangent *tangent, const double *x, double *y) {
    apply_stencil(tangent, x, y);
    for (size_t p = 0; p < tangent->patches; p++)
        apply_patch(&tangent->patch[p], x, y);
    for (size_t r = 0; r < tangent->rubbings; r++)
        apply_friction(&tangent->rubbing[r], x, y);
    for (size_t l = 0; l < tangent->links; l++) {
        const struct tangent_link *link = &tangent->link[l];
        for (int i = 0; i < LINK_MOST; i++)
            for (int j = 0; j < LINK_MOST; j++)
                y[link->at[i]] += link->stiffness[i][j] * x[link->at[j]];
    }
}

/* --- assembly --- */

/* Contribution of an element, by its corners. */
struct contribution {
    double energy, force[ELEMENT_DEGREES_OF_FREEDOM],
        stiffness[ELEMENT_DEGREES_OF_FREEDOM][ELEMENT_DEGREES_OF_FREEDOM];
};

/* Distributes values at the deeper corners, `step` apart, to the nodes that the corners are
 * interpolated from: out_b = sum over a of weight_ab in_a. It does so for rows and columns
 * alike. */
static void pass_on(size_t d, size_t sideways, const struct mesh_element *element, double *value,
                    size_t step) {
    for (size_t i = 0; i < d; i++) {
        double corner[4];
        double *lower = value + (sideways * d + i) * step;
        for (size_t a = 0; a < sideways; a++)
            corner[a] = lower[a * d * step];
        for (size_t b = 0; b < sideways; b++) {
            lower[b * d * step] = 0;
            for (size_t a = 0; a < sideways; a++)
                lower[b * d * step] += element->weight[a][b] * corner[a];
        }
    }
}

static void untie(size_t d, const struct mesh_element *element, struct contribution *c,
                  bool stiffness) {
    size_t sideways = (size_t)1 << (d - 1), degrees_of_freedom = 2 * sideways * d;
    pass_on(d, sideways, element, c->force, 1);
    for (size_t f = 0; stiffness && f < degrees_of_freedom; f++)
        pass_on(d, sideways, element, c->stiffness[f], 1);
    for (size_t f = 0; stiffness && f < degrees_of_freedom; f++)
        pass_on(d, sideways, element, &c->stiffness[0][f], ELEMENT_DEGREES_OF_FREEDOM);
}

/* Returns the slot of element node b among the neighbours of its node a, where b is not above a.
 * Steps sideways are counted in columns of b's level. A node above a wide column counts as that
 * column's first node, unless it lies on the second side of the column's second element. */
INLINE size_t slot_between(int d, int a, int b, int parity) {
    bool across = (a ^ b) >> (d - 1) & 1;
    size_t slot = 0, power = 1;
    for (int k = 0; k < d - 1; k++) {
        int from = a >> k & 1 & (across ? parity >> k : 1);
        slot += (size_t)((b >> k & 1) - from + 1) * power;
        power *= 3;
    }
    return slot + (across ? power : 0);
}

/* parity: bit k is set where the element is the second one of a wide column along axis k; all bits
 * are set where columns do not widen. */
INLINE void scatter(int d, const size_t node[8], int parity, struct contribution *c, double *force,
                    struct tangent *tangent) {
    const size_t n = (size_t)d, slots = d == 2 ? 6 : 18;
    for (int a = 0; a < 1 << d; a++)
        for (size_t i = 0; i < n; i++)
            force[node[a] * n + i] += c->force[(size_t)a * n + i];
    if (tangent == NULL)
        return;
    for (int a = 0; a < 1 << d; a++)
        for (int b = a >> (d - 1) << (d - 1); b < 1 << d; b++) {
            double *value =
                tangent->values + (node[a] * slots + slot_between(d, a, b, parity)) * n * n;
            for (size_t i = 0; i < n; i++)
                for (size_t j = 0; j < n; j++)
                    value[i * n + j] += c->stiffness[(size_t)a * n + i][(size_t)b * n + j];
        }
}

/* The pressures of a layer's elements begin with that of the first one, whose number is `first`. */
struct layer_pressures {
    const double *pressure;
    double *force;
    struct volumetric *volumetric;
    size_t first;
};

/* Evaluates element e of a layer at the displacements u. c has its energy and its stiffness only
 * where they are asked for. Returns false where the element is inverted. */
INLINE bool evaluate_element(int d, const struct mesh *mesh, const struct material *material,
                             const struct mesh_element *element, const double *u,
                             const struct layer_pressures *own, size_t e, bool energy,
                             bool stiffness, struct contribution *c) {
    struct element_shape shape;
    struct element_volumetric volumetric;
    double position[8][3], moved[8][3];
    mesh_position(mesh, element, position);
    mesh_corners(mesh, element, u, (size_t)d, moved);
    if (!element_shape_make(d, position, &shape) ||
        !element_evaluate(d, material, &shape, moved, own != NULL ? &own->pressure[e] : NULL,
                          energy ? &c->energy : NULL, c->force, stiffness ? c->stiffness : NULL,
                          own != NULL ? &volumetric : NULL))
        return false;
    if (own != NULL) {
        own->force[e] = own->volumetric->row * (own->pressure[e] - volumetric.bound);
        volumetric_store(own->volumetric, own->first + e, element, &volumetric);
    }
    return true;
}

INLINE bool evaluate_layer(int d, const struct mesh *mesh, const struct material *material,
                           size_t layer, const double *u, struct sum *energy, double *force,
                           struct tangent *tangent, const struct layer_pressures *own) {
    struct mesh_element element;
    struct contribution c;
    bool widens = mesh_widens(mesh, layer);
    size_t e = 0;
    for (size_t j = 0; j < mesh->level[layer].ny; j++)
        for (size_t i = 0; i < mesh->level[layer].nx; i++, e++) {
            mesh_element(mesh, layer, j, i, &element);
            if (!evaluate_element(d, mesh, material, &element, u, own, e, energy != NULL,
                                  tangent != NULL, &c))
                return false;
            if (energy != NULL)
                sum_add(energy, c.energy);
            if (widens)
                untie((size_t)d, &element, &c, tangent != NULL);
            int parity = widens ? (int)(i % 2 + j % 2 * 2) : 3;
            scatter(d, element.node, parity, &c, force, tangent);
        }
    return true;
}

size_t tangent_unknowns(const struct tangent *tangent) {
    return mesh_unknowns(tangent->mesh, tangent->volumetric != NULL);
}

bool tangent_evaluate(const struct mesh *mesh, const struct material *material, const double *u,
                      double *energy, double *force, struct tangent *tangent) {
    struct sum total = {0};
    bool made = true, apart = tangent != NULL && tangent->volumetric != NULL;
    size_t degrees_of_freedom = mesh_degrees_of_freedom(mesh), first = 0;
    memset(force, 0, degrees_of_freedom * sizeof *force);
    if (tangent != NULL)
        memset(tangent->values, 0, value_count(mesh) * sizeof *tangent->values);
    for (size_t layer = 0; made && layer < mesh->layers; layer++) {
        struct sum *sum = energy != NULL ? &total : NULL;
        struct layer_pressures own = {.pressure = u + degrees_of_freedom + first,
                                      .force = force + degrees_of_freedom + first,
                                      .volumetric = apart ? tangent->volumetric : NULL,
                                      .first = first};
        made = mesh->dimension == 2 ? evaluate_layer(2, mesh, material, layer, u, sum, force,
                                                     tangent, apart ? &own : NULL)
                                    : evaluate_layer(3, mesh, material, layer, u, sum, force,
                                                     tangent, apart ? &own : NULL);
        first += level_nodes(&mesh->level[layer]);
    }
    if (energy != NULL)
        *energy = sum_value(&total);
    return made;
}

void tangent_add_drag(struct tangent *tangent, double drag, const double *u, const double *before,
                      double *force) {
    const size_t d = (size_t)tangent->mesh->dimension, slots = tangent->slots, own = slots / 4;
    for (size_t f = 0; f < mesh_degrees_of_freedom(tangent->mesh); f++) {
        force[f] += drag * (u[f] - before[f]);
        tangent->values[((f / d * slots + own) * d + f % d) * d + f % d] += drag;
    }
}
