#include "core/contact/area.h"
#include "core/contact/area_law.h"
#include "core/contact/edge/edge_area.h"
#include "core/contact/mesh_error.h"
#include <math.h>
#include <stdlib.h>

struct area_workspace {
    struct grid grid;
    struct area_law law;
    struct mesh_error_workspace *mesh_error;
    struct edge_scan *scan;
};

int area_workspace_create(struct area_workspace **out, const struct compliance *compliance,
                          struct error *err) {
    const struct grid *grid = &compliance->grid;
    struct area_workspace *workspace = array_create(1, sizeof *workspace);
    if (workspace == NULL)
        return error_memory(err, sizeof *workspace, "contact areas");
    workspace->grid = *grid;
    int status = area_law_make(grid, &compliance->block, &workspace->law, err);
    if (status == 0)
        status =
            edge_scan_create(&workspace->scan, &workspace->law.edge, grid, compliance->open, err);
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
    edge_scan_destroy(&(*workspace)->scan);
    free(*workspace);
    *workspace = NULL;
}

int area_workspace_set_team(struct area_workspace *workspace, struct team *team,
                            struct error *err) {
    edge_scan_set_team(workspace->scan, team);
    return mesh_error_set_team(workspace->mesh_error, team, err);
}

double area_workspace_bytes(const struct grid *grid, const struct block *block) {
    return edge_scan_bytes(grid) + mesh_error_bytes(grid, block);
}

const struct grid *area_workspace_grid(const struct area_workspace *workspace) {
    return &workspace->grid;
}

const struct area_law *area_workspace_law(const struct area_workspace *workspace) {
    return &workspace->law;
}

/* Limits an estimate to what an area can be. Where its corrections take nearly all of it, with a
 * node or two in contact or on faces whose waves the mesh does not have, the nodes are counted. */
static double within(const struct contact_area *area, double estimate) {
    return estimate < area->nodes / 100 ? area->nodes : fmin(area->upper, estimate);
}

void contact_area(struct area_workspace *workspace, const struct contact_state *state,
                  struct contact_area *out) {
    const struct grid *grid = &workspace->grid;
    const struct area_law *law = &workspace->law;
    struct edge_area edges;
    struct mesh_error error;
    edge_area_measure(workspace->scan, state, &edges);
    out->nodes = edges.nodes;
    out->lower = edges.lower;
    out->upper = edges.upper;
    mesh_error_measure(workspace->mesh_error, state, &error);
    if (state->yielded > 0)
        error = (struct mesh_error){0};
    out->mean_gap = state->mean_gap - error.weighting - error.compliance;
    out->edges_unknown = edges.unknown;
    /* The pressure that the exact block would have at this mean gap, less the mesh's. */
    double pressure =
        state->tangent == NULL
            ? 0
            : -state->stiffness * (law->weighting * error.weighting + error.compliance);
    double less = edges.rate * pressure;
    if (edges.unknown_sides > 0) /* edges between nodes have no curvature to correct for */
        edges.patches *= fmax(0, 1 - edges.unknown_sides / edges.sides);
    out->edges = within(out, edges.straight + law->patch * edges.patches - less);
    out->perimeter = NAN;
    if (grid_is_profile(grid))
        return;
    /* A side across x is dy long, and contact by nodes reaches beyond it along x by a fraction of
     * dx; for sides across y the axes are exchanged. */
    out->perimeter = within(out, out->nodes - law->overlap * (edges.sides - edges.unknown_sides) +
                                     law->patch_of_nodes * edges.patches - less);
}
