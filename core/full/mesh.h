/* The mesh of a rough block: a column of elements a grid cell, layers that grow with depth as the
 * layered model's (block_layers), the lower face on the surface. Deeper down, where short waves
 * have died out, columns are twice as wide, and twice again: an element above such a level has the
 * wide column's nodes on its lower side and its corners on the lines between them, so that
 * displacements stay continuous (hanging nodes). Sides are periodic: a node stands for all its
 * images.
 *
 * Lengths in steps along x (dx = 1). Node level.first + j*level.nx + i, level 0 on the face; its
 * vertical position is level.depth - z * factor, the factor falling smoothly from 1 to 0 over the
 * fine zone: 40 RMS heights as the reference's, where the block is high enough. */
#ifndef RUGO_CORE_FULL_MESH_H
#define RUGO_CORE_FULL_MESH_H

#include "core/contact/compliance.h"

struct level {
    size_t nx, ny; /* nodes, and columns of the layer below */
    size_t width;  /* of its columns: 1, 2, 4, ... steps */
    size_t first;  /* node */
    double depth;  /* of the flat mesh */
};

struct mesh {
    int dimension; /* 2: profiles */
    size_t face;   /* nodes of level 0: nx*ny */
    size_t layers; /* levels less 1 */
    size_t nodes, elements;
    double across;       /* dy/dx; 1 in profiles */
    double unit;         /* dx, the grid's length */
    struct level *level; /* owned: layers + 1 */
    double *height;      /* owned: nodes, reference positions upward from the mean face */
    double slope;        /* steepest edge of the face */
    double quality;      /* of the worst element (element_quality) */
};

/* A flat face. transition: depth, in their widths, from which columns are twice as wide, as long as
 * their numbers are even and at least 4 are left; INFINITY: all are equal. ERROR_INPUT for a grid
 * or block out of range (compliance.h) or a transition below 1; ERROR_MEMORY. */
int mesh_create(struct mesh **out, const struct grid *grid, const struct block *block,
                double transition, struct error *err);
void mesh_destroy(struct mesh **mesh);
/* Puts the face on a surface of mean 0, z[face] in steps. ERROR_INPUT for one too steep or too high
 * for the block; the mesh is of no use then until the next call. */
int mesh_shape(struct mesh *mesh, const double *z, struct error *err);

/* Whether the level below the layer has wider columns. */
static inline bool mesh_widens(const struct mesh *mesh, size_t layer) {
    return mesh->level[layer].width != mesh->level[layer + 1].width;
}

/* Element over column (j, i) of a layer's upper level. */
struct mesh_element {
    /* Node a as in element.h, side 1 of the last axis the deeper one; where the columns below are
     * wider, the deeper ones are those of the whole wide column. */
    size_t node[8];
    bool hangs;          /* so that the deeper corners lie between them: */
    double weight[4][4]; /* of deeper node b in deeper corner a */
    double side[3];      /* lengths of the columns along x and y */
};
void mesh_element(const struct mesh *mesh, size_t layer, size_t j, size_t i,
                  struct mesh_element *out);
/* A nodal field's values at the element's corners: field[node*components + k]. */
void mesh_corners(const struct mesh *mesh, const struct mesh_element *element, const double *field,
                  size_t components, double out[8][3]);
/* The transpose: adds the corners' share, e.g. of forces, to a nodal field; corner is spoilt. */
void mesh_corners_add(const struct mesh *mesh, const struct mesh_element *element,
                      double corner[8][3], size_t components, double *field);
/* Reference positions of the corners, from the element's own first one sideways. */
void mesh_position(const struct mesh *mesh, const struct mesh_element *element,
                   double position[8][3]);

/* Area of the face's cell in row j, column i as seen from the flat under displacements u
 * (mesh_degrees_of_freedom), over that undeformed: half of the cross product of its diagonals. */
double mesh_stretch(const struct mesh *mesh, const double *u, size_t j, size_t i);

static inline size_t mesh_degrees_of_freedom(const struct mesh *mesh) {
    return mesh->nodes * (size_t)mesh->dimension;
}
/* With the pressures of elements, where these are unknowns of their own (gmres.h). */
static inline size_t mesh_unknowns(const struct mesh *mesh, bool pressures) {
    return mesh_degrees_of_freedom(mesh) + (pressures ? mesh->elements : 0);
}
/* Freedom of a node's vertical displacement. */
static inline size_t mesh_vertical(const struct mesh *mesh, size_t node) {
    return (node + 1) * (size_t)mesh->dimension - 1;
}
/* First node of the far side: it and all behind it. */
static inline size_t mesh_far_side(const struct mesh *mesh) {
    return mesh->level[mesh->layers].first;
}
/* Node in a row and column; one beyond the last is the first. */
static inline size_t level_node(const struct level *level, size_t j, size_t i) {
    size_t row = j < level->ny ? j : 0, column = i < level->nx ? i : 0;
    return level->first + row * level->nx + column;
}
static inline size_t level_nodes(const struct level *level) {
    return level->nx * level->ny;
}

#endif
