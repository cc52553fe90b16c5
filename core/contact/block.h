/* The elastic block under a rough face: its model, its shape and its layers. */
#ifndef RUGO_CORE_CONTACT_BLOCK_H
#define RUGO_CORE_CONTACT_BLOCK_H

#include "core/rugo_lists.h"
#include "core/surface/grid.h"

/* The linear models. The finite elements of core/full use a block's other fields alone. */
#define BLOCK_MODEL(type, name, value) MODEL_##type,
enum block_model { RUGO_LINEAR_MODELS(BLOCK_MODEL) };
#undef BLOCK_MODEL
/* Weighting of the gap by the mortar functions of the finite elements (F10.5): the standard ones
 * (Petrov-Galerkin, as in the reference, core/theory/BIBLIOGRAPHY.md) average it over neighbours by
 * (1, 4, 1)/6 along each axis; the dual ones take the gap at the node. */
enum gap_weighting { GAP_STANDARD, GAP_DUAL };
/* Returns the symbol of the mean (1, 4, 1)/6 along an axis of n nodes, by mode (F10.5). */
double gap_weight_symbol(size_t mode, size_t n);

/* A layer of another material, bonded to the face (F22.1). E* stays that of the block below it. */
struct coating {
    double thickness; /* unit of the grid's lengths, below the block's height; 0: no coating, and
                       * the others are not read */
    double modulus;   /* Young's, over that of the block below; COATING_LEAST to COATING_MOST */
    double poisson;   /* in [0, 0.5) */
};
#define COATING_LEAST 1e-3
#define COATING_MOST 1e3

struct block {
    enum block_model model;
    double poisson;               /* in [0, 0.5); without influence on an uncoated half-space */
    double height;                /* unit of the grid's lengths; INFINITY: MODEL_HALFSPACE alone */
    double layer_growth;          /* layered: thickness of a layer over that above it, in [1, 2] */
    enum gap_weighting weighting; /* layered; a half-space takes the gap at the node */
    struct coating coating;       /* of the linear models */
};
enum { LAYERS_MOST = 4096 };

/* Fails with ERROR_INPUT for a block out of the ranges above. */
int block_check(const struct block *block, struct error *err);

static inline bool block_is_coated(const struct block *block) {
    return block->coating.thickness > 0;
}
/* Returns the plane-strain modulus of the coating over E*, that of the block; 1 without one. */
double block_coating_stiffness(const struct block *block);

/* Thicknesses of the layers of a block from the face down, at most LAYERS_MOST into thickness. The
 * first is the finer of dx and dy; one factor scales all of them down so that they fill the block.
 * With a coating there are two factors, so that some layers fill it and the others what is below.
 * Returns their number, or 0 when too many are needed. */
size_t block_layers(const struct grid *grid, const struct block *block, double *thickness);

#endif
