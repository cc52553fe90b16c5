#include "core/full/volumetric.h"
#include "core/vectors.h"
#include <stdlib.h>

enum { PARITIES = 4 };

static size_t count_of(const struct mesh *mesh, bool one_per_layer) {
    return one_per_layer ? PARITIES * mesh->layers : mesh->elements;
}

static size_t gradients_of(const struct mesh *mesh) {
    return (size_t)mesh->dimension << mesh->dimension;
}

int volumetric_create(struct volumetric **out, const struct mesh *mesh,
                      const struct material *material, bool one_per_layer, struct error *err) {
    size_t count = count_of(mesh, one_per_layer);
    *out = NULL;
    struct volumetric *volumetric = array_create(1, sizeof *volumetric);
    if (volumetric == NULL)
        return error_memory(err, sizeof *volumetric, "mean dilatations");
    *volumetric = (struct volumetric){
        .mesh = mesh, .one_per_layer = one_per_layer, .row = material->shear / material->mean};
    volumetric->gradient = array_create(count, gradients_of(mesh) * sizeof(double));
    volumetric->stiffness = array_create(count, sizeof *volumetric->stiffness);
    if (volumetric->gradient == NULL || volumetric->stiffness == NULL) {
        volumetric_destroy(&volumetric);
        return error_memory(err, (size_t)volumetric_bytes(mesh, one_per_layer), "mean dilatations");
    }
    *out = volumetric;
    return 0;
}

void volumetric_destroy(struct volumetric **volumetric) {
    if (*volumetric == NULL)
        return;
    free((*volumetric)->gradient);
    free((*volumetric)->stiffness);
    free(*volumetric);
    *volumetric = NULL;
}

double volumetric_bytes(const struct mesh *mesh, bool one_per_layer) {
    return (double)count_of(mesh, one_per_layer) * (double)(gradients_of(mesh) + 1) *
           sizeof(double);
}

void volumetric_store(struct volumetric *volumetric, size_t entry,
                      const struct mesh_element *element, const struct element_volumetric *own) {
    size_t d = (size_t)volumetric->mesh->dimension, sideways = (size_t)1 << (d - 1);
    double *gradient = volumetric->gradient + entry * gradients_of(volumetric->mesh);
    volumetric->stiffness[entry] = own->stiffness;
    for (size_t f = 0; f < 2 * sideways * d; f++)
        gradient[f] = own->gradient[f];
    for (size_t b = 0; element->hangs && b < sideways; b++)
        for (size_t k = 0; k < d; k++) {
            double sum = 0;
            for (size_t a = 0; a < sideways; a++)
                sum += element->weight[a][b] * own->gradient[(sideways + a) * d + k];
            gradient[(sideways + b) * d + k] = sum;
        }
}

void volumetric_store_layer(struct volumetric *volumetric, size_t layer,
                            const struct element_volumetric *own) {
    const struct mesh *mesh = volumetric->mesh;
    struct mesh_element element;
    for (size_t parity = 0; parity < PARITIES; parity++) {
        mesh_element(mesh, layer, parity / 2 % mesh->level[layer].ny,
                     parity % 2 % mesh->level[layer].nx, &element);
        volumetric_store(volumetric, layer * PARITIES + parity, &element, own);
    }
}

/* --- products --- */

/* The elements of one row of a layer: number of the first, of its entry, and of the entries from
 * one to the next but one. */
struct row_of_elements {
    const struct level *upper, *lower;
    size_t j, first, entry;
    bool each; /* has an entry of its own */
};

/* Finds the nodes that stand for the corners of the element in a column. */
INLINE void nodes_of(int d, const struct row_of_elements *row, size_t i, size_t node[8]) {
    const size_t sideways = (size_t)1 << (d - 1);
    size_t wide = row->upper->width != row->lower->width;
    for (size_t a = 0; a < sideways; a++) {
        node[a] = level_node(row->upper, row->j + (a >> 1), i + (a & 1));
        node[a + sideways] =
            level_node(row->lower, (row->j >> wide) + (a >> 1), (i >> wide) + (a & 1));
    }
}

INLINE size_t entry_of(const struct row_of_elements *row, size_t i) {
    return row->entry + (row->each ? i : i % 2);
}

INLINE void pressures_of_row(int d, const struct volumetric *volumetric,
                             const struct row_of_elements *row, const double *u, double factor,
                             const double *p, double *out) {
    const size_t n = (size_t)d, corners = (size_t)1 << d;
    size_t node[8];
    for (size_t i = 0; i < row->upper->nx; i++) {
        size_t entry = entry_of(row, i), e = row->first + i;
        const double *gradient = volumetric->gradient + entry * corners * n;
        double sum = 0;
        nodes_of(d, row, i, node);
        for (size_t a = 0; a < corners; a++)
            for (size_t k = 0; k < n; k++)
                sum += gradient[a * n + k] * u[node[a] * n + k];
        out[e] = p[e] + factor * volumetric->stiffness[entry] * sum;
    }
}

INLINE void forces_of_row(int d, const struct volumetric *volumetric,
                          const struct row_of_elements *row, const double *p, double factor,
                          double *force) {
    const size_t n = (size_t)d, corners = (size_t)1 << d;
    size_t node[8];
    for (size_t i = 0; i < row->upper->nx; i++) {
        const double *gradient = volumetric->gradient + entry_of(row, i) * corners * n;
        double pressure = factor * p[row->first + i];
        nodes_of(d, row, i, node);
        for (size_t a = 0; a < corners; a++)
            for (size_t k = 0; k < n; k++)
                force[node[a] * n + k] += pressure * gradient[a * n + k];
    }
}

/* Finds the row behind `row` of a layer, or its first one where j is 0. */
INLINE struct row_of_elements row_at(const struct volumetric *volumetric, size_t layer, size_t j,
                                     size_t first) {
    const struct level *upper = &volumetric->mesh->level[layer];
    bool each = !volumetric->one_per_layer;
    return (struct row_of_elements){
        .upper = upper,
        .lower = upper + 1,
        .j = j,
        .first = first,
        .entry = each ? first : layer * PARITIES + j % 2 * 2,
        .each = each,
    };
}

WIDE_VECTORS void volumetric_pressures(const struct volumetric *volumetric, const double *u,
                                       double factor, const double *p, double *out) {
    const struct mesh *mesh = volumetric->mesh;
    size_t first = 0;
    for (size_t layer = 0; layer < mesh->layers; layer++)
        for (size_t j = 0; j < mesh->level[layer].ny; j++) {
            struct row_of_elements row = row_at(volumetric, layer, j, first);
            if (mesh->dimension == 2)
                pressures_of_row(2, volumetric, &row, u, factor, p, out);
            else
                pressures_of_row(3, volumetric, &row, u, factor, p, out);
            first += mesh->level[layer].nx;
        }
}

WIDE_VECTORS void volumetric_forces(const struct volumetric *volumetric, const double *p,
                                    double factor, double *force) {
    const struct mesh *mesh = volumetric->mesh;
    size_t first = 0;
    for (size_t layer = 0; layer < mesh->layers; layer++)
        for (size_t j = 0; j < mesh->level[layer].ny; j++) {
            struct row_of_elements row = row_at(volumetric, layer, j, first);
            if (mesh->dimension == 2)
                forces_of_row(2, volumetric, &row, p, factor, force);
            else
                forces_of_row(3, volumetric, &row, p, factor, force);
            first += mesh->level[layer].nx;
        }
}

void volumetric_scale(const struct volumetric *volumetric, double factor, const double *p,
                      double *out) {
    for (size_t e = 0; e < volumetric->mesh->elements; e++)
        out[e] = factor * p[e];
}
