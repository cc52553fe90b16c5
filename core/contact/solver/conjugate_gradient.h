/* Solves the quadratic programme of contact (F9.2) for the pressures p >= 0, up to the solver's
 * hardness (F21.2), of a given mean whose energy p.Sp/2 - p.z is least, and for the tangent of that
 * solution by the load. Private to core/contact.
 *
 * The caller scales heights and pressures to be near 1. */
#ifndef RUGO_CORE_CONTACT_SOLVER_CONJUGATE_GRADIENT_H
#define RUGO_CORE_CONTACT_SOLVER_CONJUGATE_GRADIENT_H

#include "core/contact/solver/conjugate_step.h"

/* Iterates from the p given (of mean `mean` > 0) until no violation is larger than tolerance *
 * deepest or than rounding errors. When stall_iterations have not halved the violation, careful
 * steps follow: each lowers the energy, so that they converge from any start, though slowly. A
 * finite hardness is above the mean and above all p; there the steps are careful after each stall
 * of sets. p keeps its mean whether the iteration converged or not. */
void conjugate_gradient_run(struct conjugate_gradient *solver, double mean, double tolerance,
                            size_t stall_iterations, size_t max_iterations,
                            struct conjugate_gradient_end *end);
/* Solves for q in the nodes where set > 0 (padded nodes; the pressures, or some of them), starting
 * from the q given, and returns -d(approach)/d(mean p) > 0, which is minus the derivative of the
 * mean gap. The largest residual is `enough` of that at most. The value is an energy, whose error
 * is the square of that of q. Keeps u. Sets solver->stopped, and returns what was reached, where
 * stop asks for it; the next call returns at once as long as that is set. */
double conjugate_gradient_tangent(struct conjugate_gradient *solver, const double *set,
                                  double enough);

#endif
