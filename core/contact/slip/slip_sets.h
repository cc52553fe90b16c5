/* The linear equations of partial slip in given sets of nodes: open, stuck and sliding ones
 * (F24.4). Private to core/contact/slip.
 *
 * Changes of the pressures of nodes in contact, of the tractions of stuck nodes, and of the
 * tractions of sliding nodes across their direction are unknown. A sliding node bears friction
 * times its pressure in its direction. So the equations are not symmetric: they are solved by
 * stabilised biconjugate gradients (Bi-CGSTAB), preconditioned as those of contact without
 * friction.
 *
 * A vector has a field of n values after the other (transfer.h). Of sliding nodes it holds what is
 * across their direction alone, of open nodes 0. */
#ifndef RUGO_CORE_CONTACT_SLIP_SLIP_SETS_H
#define RUGO_CORE_CONTACT_SLIP_SLIP_SETS_H

#include "core/contact/slip/transfer.h"
#include "core/contact/solver/pyramid.h"

enum slip_node { NODE_OPEN, NODE_STUCK, NODE_SLIDING };
enum { SLIP_VECTORS = 10 };

struct slip_sets {
    struct transfer transfer; /* owned, as all below */
    size_t n, fields;
    double friction;
    double local; /* displacement of a node under a pressure of 1 on it alone */
    /* Of each node, filled by the caller: */
    unsigned char *node;        /* enum slip_node */
    double *direction[2];       /* of the traction of sliding nodes, of length 1; profiles: 1 or -1
                                   along x, 0 along y */
    double *turn;               /* sliding nodes: slip over traction, by which their slip follows
                                   the direction of the traction; above 0, a compliance */
    size_t contact;             /* number of nodes, filled by slip_sets_count as the next two */
    double share[3];            /* xx, xy, yy of the inverse of the sum of what nodes can bear of a
                                   traction: 1 of stuck ones, less of those that can turn */
    bool determined;            /* whether that exists: tractions can take up any mean */
    struct pyramid pyramids[2]; /* of surfaces: over the contact, and over tractions */
    double *vectors[SLIP_VECTORS];
};

int slip_sets_create(struct slip_sets *out, const struct grid *grid, double poisson,
                     double friction, struct error *err);
void slip_sets_clear(struct slip_sets *sets);
double slip_sets_bytes(const struct grid *grid);

/* Returns the number behind the last field. */
static inline size_t slip_sets_end(const struct slip_sets *sets) {
    return sets->fields == FIELDS ? FIELDS : ALONG_Y;
}
/* Fills the pointers to the fields of a vector; of profiles the last one is its end. */
static inline void slip_sets_fields(const struct slip_sets *sets, double *vector,
                                    double *fields[FIELDS]) {
    fields[NORMAL] = vector;
    fields[ALONG_X] = vector + sets->n;
    fields[ALONG_Y] = vector + 2 * sets->n;
}
/* Counts the sets. */
void slip_sets_count(struct slip_sets *sets);
/* Prepares the equations of counted sets that are determined. */
void slip_sets_take(struct slip_sets *sets);
/* Fills the motion of the flat that a residual of gaps and slips has on average, by the shares of
 * nodes. */
void slip_sets_flat(const struct slip_sets *sets, double *residual, double flat[FIELDS]);
/* Takes off a residual that motion, and of sliding nodes what is along their direction. What is
 * across it is multiplied by local/(turn + local), as all residuals below: else nodes that turn
 * hardly would have residuals up to any size, which hide those of the others. */
void slip_sets_centre(const struct slip_sets *sets, double *residual);
/* Adds tractions of this sum along the face, each node its share. */
void slip_sets_spread(const struct slip_sets *sets, const double sum[FIELDS], double *tractions);
/* Adds to the tractions the change of them that takes off a centred residual, with the same means
 * of all tractions, until the largest residual is `enough`, or for max_iterations. Returns the
 * number of iterations, of two products and two preconditionings each. residual is lost. */
size_t slip_sets_solve(struct slip_sets *sets, double *residual, double enough,
                       size_t max_iterations, double *tractions);

#endif
