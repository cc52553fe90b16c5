/* How far the mesh and its weighting shift the mean gap of a block.
 *
 * With the block's exact compliance S (F10.2) and the gap at each point, the energy is
 * p.Sp/2 - p.z. At the mesh's solution p it exceeds its least value only by the square of p's
 * error. Minus the derivative of that energy by the mean pressure is the approach: with q = dp/d
 * pressure, the mean of q (S p - z) in place of the mesh's own (F12.6). */
#ifndef RUGO_CORE_CONTACT_MESH_ERROR_H
#define RUGO_CORE_CONTACT_MESH_ERROR_H

#include "core/contact/contact.h"

/* Mean gap of the state less that of the block, to first order, the grid's length. */
struct mesh_error {
    double weighting; /* because contact holds in the mean about a node, not at the node */
    double compliance;
};

struct mesh_error_workspace;
/* Borrows the compliance, which must outlive it. */
int mesh_error_create(struct mesh_error_workspace **out, const struct compliance *compliance,
                      struct error *err);
void mesh_error_destroy(struct mesh_error_workspace **workspace);
/* Lets a team of threads work along, with the same digits; borrowed. ERROR_MEMORY. */
int mesh_error_set_team(struct mesh_error_workspace *workspace, struct team *team,
                        struct error *err);
double mesh_error_bytes(const struct grid *grid, const struct block *block);
/* Zeros for a half-space, and for a state without a tangent. */
void mesh_error_measure(struct mesh_error_workspace *workspace, const struct contact_state *state,
                        struct mesh_error *out);

#endif
