/* Leak: flow of a fluid through the gap that a pressed surface leaves open, from one side of the
 * cell to the opposite one.
 *
 * Reynolds' equation of lubrication, div(g^3 grad p) = 0 for the pressure p of a thin film in a gap
 * g (Reynolds 1886; Patir & Cheng 1978), on the nodes of a periodic surface. The fluid is not
 * compressible and does not press the gap open. Across the direction of flow the cell is open: half
 * a spacing before its first and behind its last nodes the pressure is 1 and 0. Along its sides it
 * is periodic, or, of a surface that does not repeat, between walls.
 *
 * The leak of a direction is the mean flow for a unit mean gradient of pressure, over that of a
 * uniform gap of the same mean, contact included (F20.1): Patir & Cheng's flow factor with the mean
 * gap. It is 1 for a uniform gap and 0 where contact closes the cell; along waves a (1 - cos) it is
 * 5/2.
 *
 * A node is closed where it is in contact, or without a gap. Free nodes are joined along grid
 * lines; those without a path to both ends carry nothing. A face between two free nodes has
 * - the harmonic mean of their g^3, as two halves in series, or
 * - the arithmetic mean, which is more,
 * and one beside a closed node has nothing. Both are of second order where the gap is smooth; the
 * flow with the first is never above that with the second (Rayleigh's law of monotonicity). They
 * are no bounds of the exact flow, but their difference is a measure of the mesh's error. */
#ifndef RUGO_CORE_QUANTITY_LEAK_H
#define RUGO_CORE_QUANTITY_LEAK_H

#include "core/surface/grid.h"
#include "core/team.h"
#include <stdbool.h>

struct leak_options {
    double tolerance;      /* on each leak by its faces, relative, as estimated; default 1e-10 */
    size_t max_iterations; /* of each; 1 to 1e6; default 2000 */
    bool walled;           /* nothing passes from one side to the opposite one; default false */
};
extern const struct leak_options LEAK_DEFAULTS;

struct leak_direction {
    bool open;       /* free nodes join both ends */
    double harmonic; /* leak by harmonic means of g^3; 0 where not open, as the next two */
    double arithmetic;
    double value;      /* the best estimate: harmonic and a third of the difference */
    size_t iterations; /* of both */
};

struct leak_result {
    struct leak_direction x, y; /* flow along x, along y */
    double mean_gap;            /* with 0 in contact, the gap's length; 0 where all is closed */
    double effective_medium;    /* the leak of a mixture of the same gaps, contact included, that
                                   does not know where each is (effective_medium.h; Dapp, Luecke,
                                   Persson & Mueser 2012); 0 where half of the nodes are closed */
};

struct leak;
/* Makes a workspace for gaps on a grid; it belongs to one thread. ERROR_INPUT for a profile, whose
 * contact closes it everywhere; ERROR_MEMORY. */
int leak_create(struct leak **out, const struct grid *grid, const struct leak_options *options,
                struct error *err);
void leak_destroy(struct leak **leak);
/* Lets a team work along, a thread for each direction, with the same digits; borrowed until the
 * next call or leak_destroy. NULL, the initial value: the caller alone. A team of more than one
 * takes the memory of another direction. ERROR_MEMORY. */
int leak_set_team(struct leak *leak, struct team *team, struct error *err);
/* Bytes of a workspace without a team, or with one of so many threads. */
double leak_bytes(const struct grid *grid, const struct leak_options *options, size_t threads);

/* The leak of a gap[grid_points] under the pressures p[grid_points]: nodes with p > 0 are closed,
 * whatever their gap; p may be NULL, then nodes with a gap > 0 are free. Gaps of free nodes below
 * 1e-5 of the mean count as 1e-5. ERROR_INPUT for a gap that is not finite; ERROR_NUMERIC, with
 * what was reached, where the tolerance is not met. */
int leak_measure(struct leak *leak, const double *gap, const double *p, struct leak_result *out,
                 struct error *err);

#endif
