#include "core/full/volumetric.h"
#include <stdlib.h>

static size_t count_of(const struct mesh *mesh, bool one_per_layer) {
    return one_per_layer ? mesh->layers : mesh->elements;
}

int volumetric_create(struct volumetric **out, const struct mesh *mesh, bool one_per_layer,
                      struct error *err) {
    *out = NULL;
    struct volumetric *volumetric = array_create(1, sizeof *volumetric);
    if (volumetric == NULL)
        return error_memory(err, sizeof *volumetric, "mean dilatations");
    *volumetric = (struct volumetric){.mesh = mesh, .one_per_layer = one_per_layer};
    volumetric->element = array_create(count_of(mesh, one_per_layer), sizeof *volumetric->element);
    if (volumetric->element == NULL) {
        volumetric_destroy(&volumetric);
        return error_memory(err, (size_t)volumetric_bytes(mesh, one_per_layer), "mean dilatations");
    }
    *out = volumetric;
    return 0;
}

void volumetric_destroy(struct volumetric **volumetric) {
    if (*volumetric == NULL)
        return;
    free((*volumetric)->element);
    free(*volumetric);
    *volumetric = NULL;
}

double volumetric_bytes(const struct mesh *mesh, bool one_per_layer) {
    return (double)count_of(mesh, one_per_layer) * sizeof(struct element_volumetric);
}

/* Returns the change of volume of one element by displacements u of the whole mesh. */
static double volume_of(const struct mesh *mesh, const struct mesh_element *element,
                        const struct element_volumetric *volumetric, const double *u) {
    size_t d = (size_t)mesh->dimension;
    double moved[8][3], sum = 0;
    mesh_corners(mesh, element, u, d, moved);
    for (size_t a = 0; a < (size_t)1 << d; a++)
        for (size_t i = 0; i < d; i++)
            sum += volumetric->gradient[a * d + i] * moved[a][i];
    return sum;
}

void volumetric_pressures(const struct volumetric *volumetric, const double *u, double factor,
                          const double *p, double *out) {
    const struct mesh *mesh = volumetric->mesh;
    struct mesh_element element;
    size_t e = 0;
    for (size_t layer = 0; layer < mesh->layers; layer++)
        for (size_t j = 0; j < mesh->level[layer].ny; j++)
            for (size_t i = 0; i < mesh->level[layer].nx; i++, e++) {
                const struct element_volumetric *own =
                    &volumetric->element[volumetric->one_per_layer ? layer : e];
                mesh_element(mesh, layer, j, i, &element);
                out[e] = p[e] + factor * own->stiffness * volume_of(mesh, &element, own, u);
            }
}

void volumetric_forces(const struct volumetric *volumetric, const double *p, double factor,
                       double *force) {
    const struct mesh *mesh = volumetric->mesh;
    size_t d = (size_t)mesh->dimension, e = 0;
    struct mesh_element element;
    double corner[8][3];
    for (size_t layer = 0; layer < mesh->layers; layer++)
        for (size_t j = 0; j < mesh->level[layer].ny; j++)
            for (size_t i = 0; i < mesh->level[layer].nx; i++, e++) {
                const struct element_volumetric *own =
                    &volumetric->element[volumetric->one_per_layer ? layer : e];
                for (size_t a = 0; a < (size_t)1 << d; a++)
                    for (size_t k = 0; k < d; k++)
                        corner[a][k] = factor * p[e] * own->gradient[a * d + k];
                mesh_element(mesh, layer, j, i, &element);
                mesh_corners_add(mesh, &element, corner, d, force);
            }
}
