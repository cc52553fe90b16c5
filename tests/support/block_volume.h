/* Volume of a meshed block under displacements, element by element: an independent judge of the
 * volume between its face and the flat. Include after check.h. */
#ifndef RUGO_TESTS_SUPPORT_BLOCK_VOLUME_H
#define RUGO_TESTS_SUPPORT_BLOCK_VOLUME_H

#include "core/full/element.h"
#include "core/full/mesh.h"

/* In the mesh's unit, as u. */
static inline double block_volume(const struct mesh *mesh, const double *u) {
    size_t d = (size_t)mesh->dimension;
    double volume = 0, position[8][3], moved[8][3];
    struct mesh_element element;
    struct element_shape shape;
    for (size_t layer = 0; layer < mesh->layers; layer++)
        for (size_t j = 0; j < mesh->level[layer].ny; j++)
            for (size_t i = 0; i < mesh->level[layer].nx; i++) {
                mesh_element(mesh, layer, j, i, &element);
                mesh_position(mesh, &element, position);
                mesh_corners(mesh, &element, u, d, moved);
                for (size_t a = 0; a < (size_t)1 << d; a++)
                    for (size_t k = 0; k < d; k++)
                        position[a][k] += moved[a][k];
                (void)element_shape_make(mesh->dimension, position, &shape);
                volume += shape.volume;
            }
    return volume;
}

#endif
