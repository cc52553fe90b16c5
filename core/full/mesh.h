/* The mesh of a rough block: one column of elements for each grid cell, with layers that grow with
 * depth as in the layered model (block_layers). The lower face of the block is the surface. At
 * depths where short waves have decayed, columns become twice as wide, and again further down. The
 * elements above such a level have their deeper corners on the lines between the nodes of the wide
 * columns, where displacements are interpolated (hanging nodes), so that they stay continuous. The
 * sides are periodic: one node stands for all its images.
 *
 * Lengths are in units of dx. The node in row j and column i of a level is level.first +
 * j*level.nx + i; level 0 is the face. Its vertical position is level.depth - z * factor. The
 * factor falls smoothly from 1 at the face to 0 at the end of the fine zone, which is 40 RMS
 * heights deep where the block allows, as in the reference (core/theory/BIBLIOGRAPHY.md). */
#ifndef RUGO_CORE_FULL_MESH_H
#define RUGO_CORE_FULL_MESH_H

#include "core/contact/compliance.h"

struct level {
    size_t nx, ny; /* nodes, and columns of the layer below */
    size_t width;  /* of its columns: 1, 2, 4, ... dx */
    size_t first;  /* node */
    double depth;  /* of its nodes in the flat mesh */
};

struct mesh {
    int dimension; /* 2: profiles */
    size_t face;   /* nodes of level 0: nx*ny */
    size_t layers; /* number of layers; there is one more level */
    size_t nodes, elements;
    double across;       /* dy/dx; 1 in profiles */
    double unit;         /* dx, the grid's length */
    struct level *level; /* owned: layers + 1 */
    double *height; /* owned, by node: undeformed vertical position, counted upward from the mean
                       face */
    double slope;   /* steepest edge of the face */
    double quality; /* smallest element_quality of an element */
};

/* Nodes under each point of the face, whatever the columns' widths: their numbers are of 32 bits in
 * the factorisation of their equations. */
#define MESH_NODES_MOST 268435455.0
static inline double mesh_nodes_bound(const struct grid *grid, size_t layers) {
    return ((double)layers + 1) * (double)grid_points(grid);
}

/* Makes the mesh of a block with a flat face. transition: depth in widths of the wide columns from
 * which columns become twice as wide, where their numbers are even and at least 4 remain; INFINITY
 * keeps all columns equal. ERROR_INPUT for a grid or block out of range (block.h), too
 * many layers or nodes, or a transition below 1; ERROR_MEMORY. */
int mesh_create(struct mesh **out, const struct grid *grid, const struct block *block,
                double transition, struct error *err);
void mesh_destroy(struct mesh **mesh);
/* Moves the nodes so that the face is a surface of mean 0, z[face] in units of dx. ERROR_INPUT for
 * a surface that is too steep or too high for the block; the mesh is invalid then until the next
 * call. */
int mesh_shape(struct mesh *mesh, const double *z, struct error *err);

/* Returns whether the columns of the level below the layer are wider than those above it. */
static inline bool mesh_widens(const struct mesh *mesh, size_t layer) {
    return mesh->level[layer].width != mesh->level[layer + 1].width;
}

/* The element in column (j, i) of a layer's upper level. */
struct mesh_element {
    /* Nodes in the order of element.h; side 1 of the last axis is the deeper one. Where the columns
     * below are wider, the deeper nodes are the corners of the wide column. */
    size_t node[8];
    bool hangs;          /* the deeper corners are interpolated with these weights: */
    double weight[4][4]; /* weight of deeper node b in deeper corner a */
    double side[3];      /* of the column along x and y */
};
void mesh_element(const struct mesh *mesh, size_t layer, size_t j, size_t i,
                  struct mesh_element *out);
/* Gathers the values of a nodal field, field[node*components + k], at the element's corners. */
void mesh_corners(const struct mesh *mesh, const struct mesh_element *element, const double *field,
                  size_t components, double out[8][3]);
/* Undeformed positions of the corners; sideways they count from the element's first corner. */
void mesh_position(const struct mesh *mesh, const struct mesh_element *element,
                   double position[8][3]);

/* Returns the area of the face's cell in row j and column i under displacements u
 * (mesh_degrees_of_freedom values), projected on the flat, over the undeformed area: half of the
 * cross product of its diagonals. */
double mesh_stretch(const struct mesh *mesh, const double *u, size_t j, size_t i);

/* Returns the largest change of a displacement between two states. */
double mesh_largest_move(const struct mesh *mesh, const double *u, const double *before);

static inline size_t mesh_degrees_of_freedom(const struct mesh *mesh) {
    return mesh->nodes * (size_t)mesh->dimension;
}
/* Returns the number of degrees of freedom and, where they are unknowns of their own (gmres.h),
 * pressures of elements. */
static inline size_t mesh_unknowns(const struct mesh *mesh, bool pressures) {
    return mesh_degrees_of_freedom(mesh) + (pressures ? mesh->elements : 0);
}
/* Returns the index of a node's vertical displacement. */
static inline size_t mesh_vertical(const struct mesh *mesh, size_t node) {
    return (node + 1) * (size_t)mesh->dimension - 1;
}
/* Returns the first node of the far side, whose nodes are the last ones. */
static inline size_t mesh_far_side(const struct mesh *mesh) {
    return mesh->level[mesh->layers].first;
}
/* Returns the node in a row and column; the index one beyond the last means the first. */
static inline size_t level_node(const struct level *level, size_t j, size_t i) {
    size_t row = j < level->ny ? j : 0, column = i < level->nx ? i : 0;
    return level->first + row * level->nx + column;
}
static inline size_t level_nodes(const struct level *level) {
    return level->nx * level->ny;
}

#endif
