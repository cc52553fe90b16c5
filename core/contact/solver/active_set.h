/* Solves the quadratic programme of contact by sets of nodes in contact
 * (Hintermueller, Ito & Kunisch 2003). Private to core/contact.
 *
 * At the given load the gap is closed in a set of nodes, whatever the signs of the pressures. Then
 * nodes with negative pressures leave the set, and nodes that penetrate join it. The inverse
 * compliance is an M-matrix (nothing off its diagonal is positive), so that a set that is too large
 * shrinks to the solution without oscillating. On a profile of 128 longest waves this takes 5 to 10
 * sets, on a surface 5 to 8, of one to three steps each. Steps that cut pressures at 0 take 40 to
 * 80, and more on longer cells. The proof assumes a given approach, and gaps that are not averaged
 * by a mesh. With a given load all random contacts on half-spaces, layers and meshes ended at their
 * solutions all the same: 3588 of profiles, 66 300 of surfaces of 16 to 1023 nodes a side under
 * loads of 0.001 to 0.9.
 *
 * A coating some times stiffer than the block bends as a plate does, and its matrix is none. Such
 * contacts converged all the same. Thin ones of hundreds of times the modulus did only where sets
 * are solved closely, and where one node alone leaves or joins after sets that come back (Judice &
 * Pires 1994). */
#ifndef RUGO_CORE_CONTACT_SOLVER_ACTIVE_SET_H
#define RUGO_CORE_CONTACT_SOLVER_ACTIVE_SET_H

#include "core/contact/solver/conjugate_step.h"

/* Begins with p >= 0 of mean `mean`, its displacements u, and the set r != 0, which must hold all p
 * > 0. Ends converged as conjugate_gradient_run does; or stopped; or neither, when sets do not
 * improve or max_iterations are reached. In the last case p >= 0 has that mean and may start
 * another method, but u does not belong to it. Counts on from end->iterations. closely: each set is
 * solved to a smaller residual, in more steps, and only max_iterations end it. */
void active_set_run(struct conjugate_gradient *solver, double mean, double tolerance, bool closely,
                    size_t max_iterations, struct conjugate_gradient_end *end);

/* Closes the gap in the set r != 0, which is not empty, to a share of what it was, or to `enough`.
 * Fills approach and inside, and counts the steps, max_iterations at most. u keeps to p. */
void active_set_close(struct conjugate_gradient *solver, double enough, double share,
                      size_t max_iterations, struct conjugate_gradient_end *end);
/* Returns the share to which a set is closed that follows so many that were no better. */
double active_set_share(const struct conjugate_gradient *solver, int stalled);

/* What sets came to, from infinity on. */
struct set_progress {
    double least, best; /* changes of the set, violations */
    int stalled;        /* sets since the last that was better */
};
/* Notes a set: it is better where fewer nodes change, or the violation is less than half of the
 * best. never_rises: what is held is the least of all sets; else of both that of the last better
 * one. */
void set_progress_watch(struct set_progress *progress, double changed, double violation,
                        bool never_rises);

#endif
