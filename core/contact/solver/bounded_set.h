/* Sets of nodes for pressures up to the hardness (F21.2): p.Sp/2 - p.z least over 0 <= p <=
 * hardness of a given mean. Private to core/contact.
 *
 * Nodes are open (p = 0), elastic, or yielded (p = hardness). At the given load the gap is closed
 * in the set of elastic nodes, whatever their pressures (active_set.h). Then nodes under tension
 * open, nodes above the hardness yield, and open nodes that penetrate and yielded ones that stand
 * off become elastic. */
#ifndef RUGO_CORE_CONTACT_SOLVER_BOUNDED_SET_H
#define RUGO_CORE_CONTACT_SOLVER_BOUNDED_SET_H

#include "core/contact/solver/conjugate_step.h"

/* Begins with 0 <= p <= hardness of mean `mean`, its displacements u, and the set r != 0, which
 * must hold all nodes with 0 < p < hardness. Ends as active_set_run does. As long as no node
 * exceeds the hardness it takes the same steps, to the digit. */
void bounded_set_run(struct conjugate_gradient *solver, double mean, double tolerance,
                     size_t max_iterations, struct conjugate_gradient_end *end);

/* Returns the approach where no node is elastic: that at which the yielded nodes all touch. */
double bounded_approach(const struct conjugate_gradient *solver);
/* Replaces p by the pressures of this mean, within 0 and the hardness, that are nearest to p -
 * stride gap. Uses t. */
void bounded_project(struct conjugate_gradient *solver, double mean, double stride);
/* Gives 0 <= p <= hardness the mean by its elastic nodes. Where they cannot bear it, returns false
 * after bounded_project, for which u must be the displacements before p was cut. */
bool bounded_balance(struct conjugate_gradient *solver, double mean);

#endif
