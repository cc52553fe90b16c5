#include "core/full/bulk.h"
#include <stdlib.h>

static size_t count_of(const struct mesh *mesh, bool flat) {
    return flat ? mesh->layers : mesh->elements;
}

int bulk_create(struct bulk **out, const struct mesh *mesh, bool flat, struct error *err) {
    *out = NULL;
    struct bulk *bulk = array_create(1, sizeof *bulk);
    if (bulk == NULL)
        return error_memory(err, sizeof *bulk, "mean dilatations");
    *bulk = (struct bulk){.mesh = mesh, .flat = flat};
    bulk->element = array_create(count_of(mesh, flat), sizeof *bulk->element);
    if (bulk->element == NULL) {
        bulk_destroy(&bulk);
        return error_memory(err, (size_t)bulk_bytes(mesh, flat), "mean dilatations");
    }
    *out = bulk;
    return 0;
}

void bulk_destroy(struct bulk **bulk) {
    if (*bulk == NULL)
        return;
    free((*bulk)->element);
    free(*bulk);
    *bulk = NULL;
}

double bulk_bytes(const struct mesh *mesh, bool flat) {
    return (double)count_of(mesh, flat) * sizeof(struct element_bulk);
}

/* Of one element. */
static double volume_of(const struct mesh *mesh, const struct mesh_element *element,
                        const struct element_bulk *bulk, const double *u) {
    size_t d = (size_t)mesh->dimension;
    double moved[8][3], sum = 0;
    mesh_corners(mesh, element, u, d, moved);
    for (size_t a = 0; a < (size_t)1 << d; a++)
        for (size_t i = 0; i < d; i++)
            sum += bulk->gradient[a * d + i] * moved[a][i];
    return sum;
}

void bulk_bind(const struct bulk *bulk, const double *u, double factor, const double *p,
               double *out) {
    const struct mesh *mesh = bulk->mesh;
    struct mesh_element element;
    size_t e = 0;
    for (size_t layer = 0; layer < mesh->layers; layer++)
        for (size_t j = 0; j < mesh->level[layer].ny; j++)
            for (size_t i = 0; i < mesh->level[layer].nx; i++, e++) {
                const struct element_bulk *own = &bulk->element[bulk->flat ? layer : e];
                mesh_element(mesh, layer, j, i, &element);
                out[e] = p[e] + factor * own->stiffness * volume_of(mesh, &element, own, u);
            }
}

void bulk_push(const struct bulk *bulk, const double *p, double factor, double *force) {
    const struct mesh *mesh = bulk->mesh;
    size_t d = (size_t)mesh->dimension, e = 0;
    struct mesh_element element;
    double corner[8][3];
    for (size_t layer = 0; layer < mesh->layers; layer++)
        for (size_t j = 0; j < mesh->level[layer].ny; j++)
            for (size_t i = 0; i < mesh->level[layer].nx; i++, e++) {
                const struct element_bulk *own = &bulk->element[bulk->flat ? layer : e];
                for (size_t a = 0; a < (size_t)1 << d; a++)
                    for (size_t k = 0; k < d; k++)
                        corner[a][k] = factor * p[e] * own->gradient[a * d + k];
                mesh_element(mesh, layer, j, i, &element);
                mesh_corners_add(mesh, &element, corner, d, force);
            }
}
