/* Solves the quadratic programme of contact for profiles by sets of nodes in contact
 * (Hintermueller, Ito & Kunisch 2003). Private to core/contact.
 *
 * The gap is closed in a set of nodes, at the load asked for, whatever the signs of the pressures;
 * nodes that come out pulled leave the set, nodes that penetrate join it. The inverse compliance is
 * an M-matrix (nothing off its diagonal is positive), so that a set that is too large shrinks to
 * the solution and does not go to and fro: some 5 to 10 sets of two or three steps, where steps
 * that cut pressures at 0 take 40 to 80 on a cell of 128 longest waves, and more on longer ones.
 * The proof is for a given approach, and for gaps that no mesh averages; with a given load, on
 * half-spaces, layers and meshes, 3588 random contacts ended at their solutions all the same. */
#ifndef RUGO_CORE_CONTACT_ACTIVE_SET_H
#define RUGO_CORE_CONTACT_ACTIVE_SET_H

#include "core/contact/conjugate_step.h"

/* Begins with p >= 0 of mean `mean`, its displacements u, and the set r != 0, which must hold all p
 * > 0. Ends converged as conjugate_gradient_run does; stopped; or neither, where sets come to no
 * end or max_iterations are over: p >= 0 of that mean then is a start for another way, and u is
 * not of it. Counts on from end->iterations. */
void active_set_run(struct conjugate_gradient *solver, double mean, double tolerance,
                    size_t max_iterations, struct conjugate_gradient_end *end);

#endif
