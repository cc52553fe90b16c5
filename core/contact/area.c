#include "core/contact/area.h"
#include "core/contact/area_law.h"
#include "core/contact/edge/edge_area.h"
#include "core/contact/mesh_error.h"
#include <math.h>
#include <stdlib.h>

struct area_workspace {
    struct grid grid;
    bool open; /* nothing is in contact beyond the sides */
    struct area_law law;
    struct mesh_error_workspace *mesh_error;
    double *rise; /* grid_points: scratch */
};

int area_workspace_create(struct area_workspace **out, const struct compliance *compliance,
                          struct error *err) {
    const struct grid *grid = &compliance->grid;
    size_t n = grid_points(grid);
    struct area_workspace *workspace = array_create(1, sizeof *workspace);
    if (workspace != NULL)
        workspace->rise = array_create(n, sizeof *workspace->rise);
    if (workspace == NULL || workspace->rise == NULL) {
        area_workspace_destroy(&workspace);
        return error_memory(err, n * sizeof(double), "contact areas");
    }
    workspace->grid = *grid;
    workspace->open = compliance->open;
    int status = area_law_make(grid, &compliance->block, &workspace->law, err);
    if (status == 0)
        status = mesh_error_create(&workspace->mesh_error, compliance, err);
    if (status != 0)
        area_workspace_destroy(&workspace);
    *out = workspace;
    return status;
}

void area_workspace_destroy(struct area_workspace **workspace) {
    if (*workspace == NULL)
        return;
    mesh_error_destroy(&(*workspace)->mesh_error);
    free((*workspace)->rise);
    free(*workspace);
    *workspace = NULL;
}

double area_workspace_bytes(const struct grid *grid, const struct block *block) {
    return 8.0 * (double)grid_points(grid) + mesh_error_bytes(grid, block);
}

const struct grid *area_workspace_grid(const struct area_workspace *workspace) {
    return &workspace->grid;
}

const struct area_law *area_workspace_law(const struct area_workspace *workspace) {
    return &workspace->law;
}

static void count_nodes(const struct grid *grid, bool open, const double *p,
                        struct contact_area *out) {
    size_t nx = grid->nx, ny = grid->ny, nodes = 0, all = 0, any = 0;
    for (size_t j = 0; j < ny; j++)
        for (size_t i = 0; i < nx; i++) {
            size_t i2 = open && i + 1 == nx ? i : (i + 1) % nx;
            size_t j2 = open && j + 1 == ny ? j : (j + 1) % ny;
            bool a = p[j * nx + i] > 0, b = p[j * nx + i2] > 0;
            bool c = p[j2 * nx + i] > 0, d = p[j2 * nx + i2] > 0;
            nodes += a;
            all += a && b && c && d;
            any += a || b || c || d;
        }
    double n = (double)grid_points(grid);
    out->nodes = (double)nodes / n;
    out->lower = (double)all / n;
    out->upper = (double)any / n;
}

/* Limits an estimate to what an area can be; only states that are no solutions exceed it. */
static double within(const struct contact_area *area, double estimate) {
    return fmin(area->upper, fmax(estimate, area->nodes / 100));
}

void contact_area(struct area_workspace *workspace, const struct contact_state *state,
                  struct contact_area *out) {
    const struct grid *grid = &workspace->grid;
    const struct area_law *law = &workspace->law;
    struct edge_area edges;
    struct mesh_error error;
    count_nodes(grid, workspace->open, state->p, out);
    edge_area_measure(&law->edge, grid, workspace->open, state, workspace->rise, &edges);
    mesh_error_measure(workspace->mesh_error, state, &error);
    out->mean_gap = state->mean_gap - error.weighting - error.compliance;
    /* The pressure that the exact block would have at this mean gap, less the mesh's. */
    double pressure =
        state->tangent == NULL
            ? 0
            : -state->stiffness * (law->weighting * error.weighting + error.compliance);
    double less = edges.rate * pressure;
    out->edges = within(out, edges.straight + law->patch * edges.patches - less);
    out->perimeter = NAN;
    if (grid_is_profile(grid))
        return;
    /* A side across x is dy long, and contact by nodes reaches beyond it along x by a fraction of
     * dx; for sides across y the axes are exchanged. */
    out->perimeter = within(out, out->nodes - law->overlap * edges.sides +
                                     law->patch_of_nodes * edges.patches - less);
}
