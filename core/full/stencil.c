#include "core/full/stencil.h"
#include "core/sum.h"
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#define INLINE static inline __attribute__((always_inline))

static size_t slot_count(const struct mesh *mesh) {
    return mesh->dimension == 2 ? 9 : 27;
}

static size_t value_count(const struct stencil *stencil) {
    size_t d = (size_t)stencil->mesh->dimension;
    return stencil->mesh->nodes * stencil->slots * d * d;
}

int stencil_create(struct stencil **out, const struct mesh *mesh, struct error *err) {
    *out = NULL;
    struct stencil *stencil = array_create(1, sizeof *stencil);
    if (stencil == NULL)
        return error_memory(err, sizeof *stencil, "a stiffness matrix");
    stencil->mesh = mesh;
    stencil->slots = slot_count(mesh);
    size_t count = value_count(stencil);
    stencil->values = array_create(count, sizeof *stencil->values);
    if (stencil->values == NULL) {
        stencil_destroy(&stencil);
        return error_memory(err, count * sizeof(double), "a stiffness matrix");
    }
    *out = stencil;
    return 0;
}

void stencil_destroy(struct stencil **stencil) {
    if (*stencil == NULL)
        return;
    free((*stencil)->values);
    free(*stencil);
    *stencil = NULL;
}

/* Slots count one step back, none, one on: x fastest, the level slowest. */
size_t stencil_neighbour(const struct mesh *mesh, size_t node, size_t slot) {
    size_t level = node / mesh->face, j = node % mesh->face / mesh->nx, i = node % mesh->nx;
    size_t up = mesh->dimension == 2 ? slot / 3 : slot / 9;
    size_t row = mesh->dimension == 2 ? 0 : (j + mesh->ny + slot / 3 % 3 - 1) % mesh->ny;
    if (level + up < 1 || level + up - 1 > mesh->layers)
        return SIZE_MAX;
    size_t column = (i + mesh->nx + slot % 3 - 1) % mesh->nx;
    return (level + up - 1) * mesh->face + row * mesh->nx + column;
}

/* Slot of element node b as seen from its node a. */
INLINE size_t slot_between(int d, int a, int b) {
    int slot = 0, power = 1;
    for (int k = 0; k < d; k++) {
        slot += ((b >> k & 1) - (a >> k & 1) + 1) * power;
        power *= 3;
    }
    return (size_t)slot;
}

INLINE void apply(size_t d, const struct stencil *stencil, const double *x, double *y) {
    const struct mesh *mesh = stencil->mesh;
    for (size_t node = 0; node < mesh->nodes; node++) {
        double sum[3] = {0};
        const double *value = stencil->values + node * stencil->slots * d * d;
        for (size_t slot = 0; slot < stencil->slots; slot++, value += d * d) {
            size_t other = stencil_neighbour(mesh, node, slot);
            if (other == SIZE_MAX)
                continue;
            for (size_t i = 0; i < d; i++)
                for (size_t j = 0; j < d; j++)
                    sum[i] += value[i * d + j] * x[other * d + j];
        }
        for (size_t i = 0; i < d; i++)
            y[node * d + i] = sum[i];
    }
}

void stencil_apply(const struct stencil *stencil, const double *x, double *y) {
    if (stencil->mesh->dimension == 2)
        apply(2, stencil, x, y);
    else
        apply(3, stencil, x, y);
}

/* What an element gives. */
struct contribution {
    double energy, force[ELEMENT_FREEDOMS], stiffness[ELEMENT_FREEDOMS][ELEMENT_FREEDOMS];
};

INLINE void scatter(int d, const size_t node[8], struct contribution *c, double *force,
                    struct stencil *tangent) {
    size_t n = (size_t)d;
    for (int a = 0; a < 1 << d; a++)
        for (size_t i = 0; i < n; i++)
            force[node[a] * n + i] += c->force[(size_t)a * n + i];
    if (tangent == NULL)
        return;
    for (int a = 0; a < 1 << d; a++)
        for (int b = 0; b < 1 << d; b++) {
            double *value =
                tangent->values + (node[a] * tangent->slots + slot_between(d, a, b)) * n * n;
            for (size_t i = 0; i < n; i++)
                for (size_t j = 0; j < n; j++)
                    value[i * n + j] += c->stiffness[(size_t)a * n + i][(size_t)b * n + j];
        }
}

INLINE bool evaluate(int d, const struct mesh *mesh, const struct solid *solid, const double *u,
                     double *energy, double *force, struct stencil *tangent) {
    struct sum total = {0};
    struct element_shape shape;
    struct contribution c;
    double position[8][3], moved[8][3];
    size_t node[8];
    for (size_t layer = 0; layer < mesh->layers; layer++)
        for (size_t j = 0; j < mesh->ny; j++)
            for (size_t i = 0; i < mesh->nx; i++) {
                mesh_position(mesh, layer, j, i, position);
                for (int a = 0; a < 1 << d; a++) {
                    node[a] = mesh_node(mesh, layer, j, i, a);
                    for (int k = 0; k < d; k++)
                        moved[a][k] = u[node[a] * (size_t)d + (size_t)k];
                }
                if (!element_shape_make(d, position, &shape) ||
                    !element_evaluate(d, solid, &shape, moved, energy ? &c.energy : NULL, c.force,
                                      tangent ? c.stiffness : NULL))
                    return false;
                if (energy != NULL)
                    sum_add(&total, c.energy);
                scatter(d, node, &c, force, tangent);
            }
    if (energy != NULL)
        *energy = sum_value(&total);
    return true;
}

bool stencil_evaluate(const struct mesh *mesh, const struct solid *solid, const double *u,
                      double *energy, double *force, struct stencil *tangent) {
    memset(force, 0, mesh_freedoms(mesh) * sizeof *force);
    if (tangent != NULL)
        memset(tangent->values, 0, value_count(tangent) * sizeof *tangent->values);
    return mesh->dimension == 2 ? evaluate(2, mesh, solid, u, energy, force, tangent)
                                : evaluate(3, mesh, solid, u, energy, force, tangent);
}
