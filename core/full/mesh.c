#include "core/full/mesh.h"
#include "core/full/element.h"
#include "core/sum.h"
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

/* Steeper edges make elements sheared beyond 80 degrees. */
static const double SLOPE_MOST = 6;
/* Fine zone: in RMS heights, and at least so many largest heights, where the factor's slope
 * of 3/2 over the zone still leaves the columns upright. */
static const double ZONE_RMS = 40, ZONE_HEIGHTS = 4;

void mesh_destroy(struct mesh **mesh) {
    if (*mesh == NULL)
        return;
    free((*mesh)->depth);
    free((*mesh)->height);
    free(*mesh);
    *mesh = NULL;
}

static int block_refused(const struct block *block, struct error *err) {
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

static int levels_create(struct mesh *mesh, const struct grid *grid, const struct block *block,
                         struct error *err) {
    double *thickness = array_create(LAYERS_MOST, sizeof *thickness);
    if (thickness == NULL)
        return error_memory(err, LAYERS_MOST * sizeof *thickness, "a mesh");
    mesh->layers = block_layers(grid, block, thickness);
    int status = 0;
    if (mesh->layers == 0)
        status = error_set(err, ERROR_INPUT,
                           "a block of height %g needs more than %d layers that grow by %g",
                           block->height, LAYERS_MOST, block->layer_growth);
    else if ((double)(mesh->layers + 1) * (double)mesh->face > (double)INT32_MAX / 8)
        status = error_set(err, ERROR_INPUT, "%zu layers of %zu nodes are too many", mesh->layers,
                           mesh->face);
    if (status == 0) {
        mesh->nodes = (mesh->layers + 1) * mesh->face;
        mesh->depth = array_create(mesh->layers + 1, sizeof *mesh->depth);
        mesh->height = array_create(mesh->nodes, sizeof *mesh->height);
        if (mesh->depth == NULL || mesh->height == NULL)
            status = error_memory(err, mesh->nodes * sizeof *mesh->height, "a mesh");
    }
    for (size_t k = 0; status == 0 && k < mesh->layers; k++)
        mesh->depth[k + 1] = mesh->depth[k] + thickness[k] / mesh->unit;
    free(thickness);
    return status;
}

int mesh_create(struct mesh **out, const struct grid *grid, const struct block *block,
                struct error *err) {
    *out = NULL;
    int status = grid_check(grid, err);
    if (status == 0)
        status = block_refused(block, err);
    if (status != 0)
        return status;
    struct mesh *mesh = array_create(1, sizeof *mesh);
    if (mesh == NULL)
        return error_memory(err, sizeof *mesh, "a mesh");
    bool profile = grid_is_profile(grid);
    *mesh = (struct mesh){.dimension = profile ? 2 : 3,
                          .nx = grid->nx,
                          .ny = grid->ny,
                          .face = grid_points(grid),
                          .unit = grid_dx(grid),
                          .across = profile ? 1 : grid_dy(grid) / grid_dx(grid)};
    status = levels_create(mesh, grid, block, err);
    if (status != 0)
        mesh_destroy(&mesh);
    *out = mesh;
    return status;
}

size_t mesh_node(const struct mesh *mesh, size_t layer, size_t j, size_t i, int a) {
    size_t column = (i + (size_t)(a & 1)) % mesh->nx;
    bool deep = a >> (mesh->dimension - 1) & 1;
    size_t row = mesh->dimension == 3 ? (j + (size_t)(a >> 1 & 1)) % mesh->ny : 0;
    return (layer + deep) * mesh->face + row * mesh->nx + column;
}

void mesh_position(const struct mesh *mesh, size_t layer, size_t j, size_t i,
                   double position[8][3]) {
    for (int a = 0; a < 1 << mesh->dimension; a++) {
        position[a][0] = a & 1;
        position[a][1] = (a >> 1 & 1) * mesh->across;
        position[a][mesh->dimension - 1] = mesh->height[mesh_node(mesh, layer, j, i, a)];
    }
}

static double zone_depth(const struct mesh *mesh, const double *z) {
    struct sum square = {0};
    double highest = 0;
    for (size_t i = 0; i < mesh->face; i++) {
        sum_add(&square, z[i] * z[i]);
        highest = fmax(highest, fabs(z[i]));
    }
    double rms = sqrt(sum_value(&square) / (double)mesh->face);
    double zone = fmax(ZONE_RMS * rms, ZONE_HEIGHTS * highest);
    return fmin(fmax(zone, mesh->depth[1]), mesh->depth[mesh->layers]);
}

static int slope_check(struct mesh *mesh, const double *z, struct error *err) {
    size_t nx = mesh->nx, ny = mesh->ny;
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
    mesh->quality = 1;
    for (size_t layer = 0; layer < mesh->layers; layer++)
        for (size_t j = 0; j < mesh->ny; j++)
            for (size_t i = 0; i < mesh->nx; i++) {
                mesh_position(mesh, layer, j, i, position);
                mesh->quality = fmin(mesh->quality, element_quality(mesh->dimension, position));
            }
    if (!(mesh->quality > 0))
        return error_set(err, ERROR_INPUT,
                         "the surface is too high for a block of height %g: elements fold over "
                         "(least Jacobian over edges %.2g); steepest slope %g",
                         mesh->depth[mesh->layers] * mesh->unit, mesh->quality, mesh->slope);
    return 0;
}

int mesh_shape(struct mesh *mesh, const double *z, struct error *err) {
    int status = slope_check(mesh, z, err);
    if (status != 0)
        return status;
    double zone = zone_depth(mesh, z);
    for (size_t level = 0; level <= mesh->layers; level++) {
        double s = fmin(1, mesh->depth[level] / zone);
        double factor = (1 - s) * (1 - s) * (1 + 2 * s);
        for (size_t i = 0; i < mesh->face; i++)
            mesh->height[level * mesh->face + i] = mesh->depth[level] - factor * z[i];
    }
    return quality_check(mesh, err);
}
