#include "core/contact/mesh_error.h"
#include "core/surface/transform.h"
#include <math.h>
#include <stdlib.h>

struct mesh_error_workspace {
    size_t points;
    struct transform *transform; /* NULL for a half-space, as all below */
    double *missing;             /* by wave: exact compliance less the mesh's */
    double *displacement;        /* grid_points: of the pressures under it */
};

static void fill_missing(struct mesh_error_workspace *workspace,
                         const struct compliance *compliance) {
    const struct grid *grid = &compliance->grid;
    for (size_t mx = 0; mx <= grid->nx / 2; mx++)
        for (size_t row = 0; row < grid->ny; row++) {
            size_t k = mx * grid->ny + row;
            if (k > 0)
                workspace->missing[k] = block_compliance_exact(transform_wave_number(grid, mx, row),
                                                               &compliance->block) -
                                        compliance->length[k];
        }
}

int mesh_error_create(struct mesh_error_workspace **out, const struct compliance *compliance,
                      struct error *err) {
    const struct grid *grid = &compliance->grid;
    struct mesh_error_workspace *workspace = array_create(1, sizeof *workspace);
    int status = 0;
    if (workspace == NULL)
        return error_memory(err, sizeof *workspace, "the error of a mesh");
    workspace->points = grid_points(grid);
    if (compliance->block.model == MODEL_LAYERED) {
        status = transform_create(&workspace->transform, grid, grid->nx / 2, grid->ny / 2, err);
        workspace->missing = array_create(compliance->waves, sizeof(double));
        workspace->displacement = array_create(workspace->points, sizeof(double));
        if (status == 0 && (workspace->missing == NULL || workspace->displacement == NULL))
            status = error_memory(err, (compliance->waves + workspace->points) * sizeof(double),
                                  "the error of a mesh");
        if (status == 0)
            fill_missing(workspace, compliance);
    }
    if (status != 0)
        mesh_error_destroy(&workspace);
    *out = workspace;
    return status;
}

void mesh_error_destroy(struct mesh_error_workspace **workspace) {
    struct mesh_error_workspace *w = *workspace;
    if (w == NULL)
        return;
    transform_destroy(&w->transform);
    free(w->missing);
    free(w->displacement);
    free(w);
    *workspace = NULL;
}

int mesh_error_set_team(struct mesh_error_workspace *workspace, struct team *team,
                        struct error *err) {
    return workspace->transform != NULL ? transform_set_team(workspace->transform, team, err) : 0;
}

double mesh_error_bytes(const struct grid *grid, const struct block *block) {
    double waves = ((double)grid->nx / 2 + 1) * (double)grid->ny;
    if (block->model != MODEL_LAYERED)
        return 0;
    return sizeof(double) * (waves + (double)grid_points(grid)) +
           transform_bytes(grid, grid->nx / 2);
}

void mesh_error_measure(struct mesh_error_workspace *workspace, const struct contact_state *state,
                        struct mesh_error *out) {
    double weighting = 0, compliance = 0;
    if (workspace->transform != NULL && state->tangent != NULL) {
        transform_filter(workspace->transform, workspace->missing, 1, state->p,
                         workspace->displacement);
        for (size_t i = 0; i < workspace->points; i++) {
            weighting += state->tangent[i] * state->gap[i];
            compliance += state->tangent[i] * workspace->displacement[i];
        }
    }
    *out = (struct mesh_error){weighting / (double)workspace->points,
                               compliance / (double)workspace->points};
}
