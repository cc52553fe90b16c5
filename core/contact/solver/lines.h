/* Continuation of values in a set of nodes of a profile over the whole periodic grid, by straight
 * lines between its nodes: a linear map, and its transpose. Private to core/contact. */
#ifndef RUGO_CORE_CONTACT_SOLVER_LINES_H
#define RUGO_CORE_CONTACT_SOLVER_LINES_H

#include <stddef.h>

/* Copies r to out, and fills the nodes outside the set r != 0. */
void lines_continue(size_t n, const double *r, double *out);
/* The transpose in the set r != 0, in place: w of each node outside is shared between its two
 * neighbours in the set. What is outside is of no meaning then. */
void lines_transpose(size_t n, const double *r, double *w);

#endif
