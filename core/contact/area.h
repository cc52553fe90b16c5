/* The real contact area of a discrete solution by several estimators, and its mean gap. Both are
 * estimates for the exact block from the solution on a mesh. */
#ifndef RUGO_CORE_CONTACT_AREA_H
#define RUGO_CORE_CONTACT_AREA_H

#include "core/contact/contact.h"

/* Fractions of the cell. */
struct contact_area {
    double nodes; /* share of nodes in contact, each with the cell around it */
    double lower; /* segments (profiles) or cells with all corners in contact ... */
    double upper; /* ... and with any */
    double edges; /* within edges found between nodes; without the mesh's error to second order */
    /* Surfaces: nodes less what they count beyond edges, in proportion to the length of the
     * boundary of their cells (after Yastrebov, Anciaux & Molinari 2017); profiles: NaN. */
    double perimeter;
    double mean_gap; /* without the mesh's error to first order (mesh_error.h); the grid's length */
    /* Beside yielded nodes, and where the face ends in a side, edges and perimeter are half a step
     * beyond the nodes in contact. By how much the edge can be off if it lies anywhere between
     * these and the open ones: edges lies within this of the true area. 0 where no edge is. */
    double edges_unknown;
};

struct area_law;
struct area_workspace;
/* Calibrates the position of edges for this model on this grid (area_law.h), in some ten
 * milliseconds. Borrows the compliance, which must outlive it. Fails as area_law_make. */
int area_workspace_create(struct area_workspace **out, const struct compliance *compliance,
                          struct error *err);
void area_workspace_destroy(struct area_workspace **workspace);
/* Lets a team of threads work along, with the same digits; it is borrowed until the next call.
 * ERROR_MEMORY. */
int area_workspace_set_team(struct area_workspace *workspace, struct team *team, struct error *err);
/* Of states that bring scratch; else a value a point is added. */
double area_workspace_bytes(const struct grid *grid, const struct block *block);
/* Both live as long as the workspace. */
const struct grid *area_workspace_grid(const struct area_workspace *workspace);
const struct area_law *area_workspace_law(const struct area_workspace *workspace);

/* Of a state on the workspace's grid. Where nodes have yielded, nothing is corrected for the mesh's
 * own compliance and weighting. */
void contact_area(struct area_workspace *workspace, const struct contact_state *state,
                  struct contact_area *out);

#endif
