#include "core/full/mesh.h"
#include "core/full/element.h"
#include "core/sum.h"
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

enum { COLUMNS_LEAST = 4 };
/* The steepest edge of the face: steeper ones would shear elements by more than 80 degrees. */
static const double SLOPE_MOST = 6;
/* Depth of the fine zone in RMS heights, and its least depth in largest heights: the factor of
 * mesh.h falls by 3/2 over the zone at most, so that 4 heights keep elements upright. */
static const double ZONE_RMS = 40, ZONE_HEIGHTS = 4;

void mesh_destroy(struct mesh **mesh) {
    if (*mesh == NULL)
        return;
    free((*mesh)->level);
    free((*mesh)->height);
    free(*mesh);
    *mesh = NULL;
}

static int block_refused(const struct block *block, double transition, struct error *err) {
    if (!(transition >= 1))
        return error_set(err, ERROR_INPUT, "transition depth = %g; allowed: 1 or more", transition);
    if (!(block->height > 0 && isfinite(block->height)))
        return error_set(err, ERROR_INPUT,
                         "block height = %g; allowed: above 0, finite for finite "
                         "elements",
                         block->height);
    if (!(block->layer_growth >= 1 && block->layer_growth <= 2))
        return error_set(err, ERROR_INPUT, "layer growth = %g; allowed: 1 to 2",
                         block->layer_growth);
    if (!(block->poisson >= 0 && block->poisson < 0.5))
        return error_set(err, ERROR_INPUT, "Poisson's ratio = %g; allowed: 0 or more, below 0.5",
                         block->poisson);
    return 0;
}

/* Returns whether half as many columns suffice from this depth on. */
static bool widens(const struct mesh *mesh, const struct level *above, double depth,
                   double transition) {
    bool profile = mesh->dimension == 2;
    double wide = 2 * (double)above->width * fmax(1, mesh->across);
    return depth >= transition * wide && above->nx % 2 == 0 && above->nx / 2 >= COLUMNS_LEAST &&
           (profile || (above->ny % 2 == 0 && above->ny / 2 >= COLUMNS_LEAST));
}

static void levels_fill(struct mesh *mesh, const double *thickness, double transition) {
    for (size_t k = 0; k < mesh->layers; k++) {
        struct level *above = &mesh->level[k], *level = above + 1;
        *level = *above;
        level->first = above->first + level_nodes(above);
        level->depth = above->depth + thickness[k] / mesh->unit;
        if (widens(mesh, above, level->depth, transition)) {
            level->width *= 2;
            level->nx /= 2;
            level->ny = mesh->dimension == 2 ? 1 : above->ny / 2;
        }
        mesh->elements += level_nodes(above);
    }
    mesh->nodes = mesh->elements + level_nodes(&mesh->level[mesh->layers]);
}

static int levels_create(struct mesh *mesh, const struct grid *grid, const struct block *block,
                         double transition, struct error *err) {
    double *thickness = array_create(LAYERS_MOST, sizeof *thickness);
    if (thickness == NULL)
        return error_memory(err, LAYERS_MOST * sizeof *thickness, "a mesh");
    mesh->layers = block_layers(grid, block, thickness);
    int status = 0;
    if (mesh->layers == 0)
        status = error_set(err, ERROR_INPUT,
                           "a block of height %g needs more than %d layers that grow by %g",
                           block->height, LAYERS_MOST, block->layer_growth);
    else if (mesh_nodes_bound(grid, mesh->layers) > MESH_NODES_MOST)
        status = error_set(err, ERROR_INPUT,
                           "%zu layers under %zu points are too many; allowed: %.0f "
                           "nodes",
                           mesh->layers, mesh->face, MESH_NODES_MOST);
    if (status == 0) {
        mesh->level = array_create(mesh->layers + 1, sizeof *mesh->level);
        if (mesh->level == NULL)
            status = error_memory(err, (mesh->layers + 1) * sizeof *mesh->level, "a mesh");
    }
    if (status == 0) {
        mesh->level[0] = (struct level){.nx = grid->nx, .ny = grid->ny, .width = 1};
        levels_fill(mesh, thickness, transition);
        mesh->height = array_create(mesh->nodes, sizeof *mesh->height);
        if (mesh->height == NULL)
            status = error_memory(err, mesh->nodes * sizeof *mesh->height, "a mesh");
    }
    free(thickness);
    return status;
}

int mesh_create(struct mesh **out, const struct grid *grid, const struct block *block,
                double transition, struct error *err) {
    *out = NULL;
    int status = grid_check(grid, err);
    if (status == 0)
        status = block_refused(block, transition, err);
    if (status != 0)
        return status;
    struct mesh *mesh = array_create(1, sizeof *mesh);
    if (mesh == NULL)
        return error_memory(err, sizeof *mesh, "a mesh");
    bool profile = grid_is_profile(grid);
    *mesh = (struct mesh){.dimension = profile ? 2 : 3,
                          .face = grid_points(grid),
                          .unit = grid_dx(grid),
                          .across = profile ? 1 : grid_dy(grid) / grid_dx(grid)};
    status = levels_create(mesh, grid, block, transition, err);
    if (status != 0)
        mesh_destroy(&mesh);
    *out = mesh;
    return status;
}

/* --- elements --- */

/* Weight of a wide column's node in a corner: the corner at side s of the column of parity p lies
 * at (p + s)/2 of the wide column. */
static double hanging_weight(size_t parity, int corner, int node) {
    double at = (double)(parity + (size_t)corner) / 2;
    return node == 1 ? at : 1 - at;
}

void mesh_element(const struct mesh *mesh, size_t layer, size_t j, size_t i,
                  struct mesh_element *out) {
    const struct level *upper = &mesh->level[layer], *lower = upper + 1;
    int sideways = 1 << (mesh->dimension - 1);
    *out = (struct mesh_element){.hangs = lower->width != upper->width};
    out->side[0] = (double)upper->width;
    out->side[1] = (double)upper->width * mesh->across;
    for (int a = 0; a < sideways; a++) {
        size_t right = (size_t)(a & 1), back = (size_t)(a >> 1 & 1);
        out->node[a] = level_node(upper, j + back, i + right);
        out->node[a + sideways] =
            level_node(lower, (j >> out->hangs) + back, (i >> out->hangs) + right);
    }
    for (int a = 0; out->hangs && a < sideways; a++)
        for (int b = 0; b < sideways; b++) {
            out->weight[a][b] = hanging_weight(i % 2, a & 1, b & 1);
            if (mesh->dimension == 3)
                out->weight[a][b] *= hanging_weight(j % 2, a >> 1, b >> 1);
        }
}

void mesh_corners(const struct mesh *mesh, const struct mesh_element *element, const double *field,
                  size_t components, double out[8][3]) {
    size_t sideways = (size_t)1 << (mesh->dimension - 1);
    for (size_t a = 0; a < 2 * sideways; a++)
        for (size_t k = 0; k < components; k++)
            out[a][k] = field[element->node[a] * components + k];
    if (!element->hangs)
        return;
    double lower[4][3] = {{0}};
    memcpy(lower, out + sideways, sideways * sizeof *lower);
    for (size_t a = 0; a < sideways; a++)
        for (size_t k = 0; k < components; k++) {
            out[sideways + a][k] = 0;
            for (size_t b = 0; b < sideways; b++)
                out[sideways + a][k] += element->weight[a][b] * lower[b][k];
        }
}

void mesh_position(const struct mesh *mesh, const struct mesh_element *element,
                   double position[8][3]) {
    double height[8][3] = {{0}};
    mesh_corners(mesh, element, mesh->height, 1, height);
    for (int a = 0; a < 1 << mesh->dimension; a++) {
        position[a][0] = (a & 1) * element->side[0];
        position[a][1] = (a >> 1 & 1) * element->side[1];
        position[a][mesh->dimension - 1] = height[a][0];
    }
}

/* --- the rough face --- */

static double zone_depth(const struct mesh *mesh, const double *z) {
    struct sum square = {0};
    double highest = 0;
    for (size_t i = 0; i < mesh->face; i++) {
        sum_add(&square, z[i] * z[i]);
        highest = fmax(highest, fabs(z[i]));
    }
    double rms = sqrt(sum_value(&square) / (double)mesh->face);
    double zone = fmax(ZONE_RMS * rms, ZONE_HEIGHTS * highest);
    return fmin(fmax(zone, mesh->level[1].depth), mesh->level[mesh->layers].depth);
}

static int slope_check(struct mesh *mesh, const double *z, struct error *err) {
    size_t nx = mesh->level[0].nx, ny = mesh->level[0].ny;
    mesh->slope = 0;
    for (size_t j = 0; j < ny; j++)
        for (size_t i = 0; i < nx; i++) {
            double here = z[j * nx + i];
            double right = z[j * nx + (i + 1) % nx] - here, back = z[(j + 1) % ny * nx + i] - here;
            mesh->slope = fmax(mesh->slope, fmax(fabs(right), fabs(back) / mesh->across));
        }
    if (!(mesh->slope <= SLOPE_MOST))
        return error_set(err, ERROR_INPUT,
                         "the steepest slope of the surface between grid points is %g; the finite "
                         "elements allow %g at most",
                         mesh->slope, SLOPE_MOST);
    return 0;
}

static int quality_check(struct mesh *mesh, struct error *err) {
    double position[8][3];
    struct mesh_element element;
    mesh->quality = 1;
    for (size_t layer = 0; layer < mesh->layers; layer++)
        for (size_t j = 0; j < mesh->level[layer].ny; j++)
            for (size_t i = 0; i < mesh->level[layer].nx; i++) {
                mesh_element(mesh, layer, j, i, &element);
                mesh_position(mesh, &element, position);
                mesh->quality = fmin(mesh->quality, element_quality(mesh->dimension, position));
            }
    if (!(mesh->quality > 0))
        return error_set(err, ERROR_INPUT,
                         "the surface is too high for a block of height %g: elements fold over "
                         "(least Jacobian over edges %.2g); steepest slope %g",
                         mesh->level[mesh->layers].depth * mesh->unit, mesh->quality, mesh->slope);
    return 0;
}

int mesh_shape(struct mesh *mesh, const double *z, struct error *err) {
    int status = slope_check(mesh, z, err);
    if (status != 0)
        return status;
    double zone = zone_depth(mesh, z);
    for (size_t k = 0; k <= mesh->layers; k++) {
        const struct level *level = &mesh->level[k];
        double s = fmin(1, level->depth / zone);
        double factor = (1 - s) * (1 - s) * (1 + 2 * s);
        size_t row = level->width * mesh->level[0].nx;
        double *height = mesh->height + level->first;
        for (size_t j = 0; j < level->ny; j++)
            for (size_t i = 0; i < level->nx; i++)
                *height++ = level->depth - factor * z[j * row + i * level->width];
    }
    return quality_check(mesh, err);
}

double mesh_stretch(const struct mesh *mesh, const double *u, size_t j, size_t i) {
    size_t nx = mesh->level[0].nx, d = (size_t)mesh->dimension;
    size_t right = (i + 1) % nx, back = (j + 1) % mesh->level[0].ny;
    const double *a = u + (j * nx + i) * d, *b = u + (j * nx + right) * d;
    if (d == 2)
        return 1 + b[0] - a[0];
    const double *c = u + (back * nx + i) * d, *e = u + (back * nx + right) * d;
    double x1 = 1 + e[0] - a[0], y1 = mesh->across + e[1] - a[1];
    double x2 = -1 + c[0] - b[0], y2 = mesh->across + c[1] - b[1];
    return (x1 * y2 - x2 * y1) / (2 * mesh->across);
}

double mesh_largest_move(const struct mesh *mesh, const double *u, const double *before) {
    double most = 0;
    for (size_t f = 0; f < mesh_degrees_of_freedom(mesh); f++)
        most = fmax(most, fabs(u[f] - before[f]));
    return most;
}
