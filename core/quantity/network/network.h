/* Flow through a network of conductances between the nodes of a grid, nx across and ny along: open
 * across, where the nodes of the first and of the last column are tied to ends at pressures of 1
 * and 0, half a spacing away, and along periodic or between walls. Private to core/quantity.
 *
 * A network belongs to one thread and is reused. */
#ifndef RUGO_CORE_QUANTITY_NETWORK_NETWORK_H
#define RUGO_CORE_QUANTITY_NETWORK_NETWORK_H

#include "core/error.h"
#include <stdbool.h>

enum face_mean { MEAN_HARMONIC, MEAN_ARITHMETIC, MEAN_COUNT };

struct network;
/* For grids of nx by ny nodes, in both directions; nx, ny >= 2. A solution may take so many
 * iterations. ERROR_MEMORY. */
int network_create(struct network **out, size_t nx, size_t ny, size_t max_iterations,
                   struct error *err);
void network_destroy(struct network **network);
double network_bytes(size_t nx, size_t ny, size_t max_iterations);

/* Conductances of nodes, >= 0: of node i across and j along values[i * step_across + j *
 * step_along]. A face along has `along` times what one across has between the same nodes: the
 * spacing across over that along, squared. */
struct conductances {
    const double *values;
    size_t nx, ny; /* across and along */
    size_t step_across, step_along;
    double along;
    bool walled; /* the first and the last row are no neighbours */
};
/* Copies them. Those that are not joined to both ends become 0; *open: whether any is.
 * ERROR_MEMORY.
 */
int network_take(struct network *network, const struct conductances *nodes, bool *open,
                 struct error *err);

struct network_flow {
    double flow; /* from end to end, in conductances across */
    size_t iterations;
    double error; /* estimated, over flow */
};
/* Solves for faces whose conductances are such means of their nodes'; 0 beside nodes without. The
 * last solution since network_take is where it starts.
 *
 * The flow is the energy of the solution, sum of c (difference)^2, which is the least of all. So
 * its error is the energy of the solution's error; it is at most the product of residual and
 * preconditioned residual, over the least eigenvalue of the preconditioned equations, which the
 * iterations estimate from above. ERROR_NUMERIC, with what was reached, where this is not below the
 * tolerance times the flow; ERROR_MEMORY. */
int network_solve(struct network *network, enum face_mean mean, double tolerance,
                  struct network_flow *out, struct error *err);

#endif
