/* The least eigenvalue of preconditioned equations, from the steps of their conjugate gradients
 * (Lanczos 1950; Hestenes & Stiefel 1952). Private to core/quantity/network. */
#ifndef RUGO_CORE_QUANTITY_NETWORK_LANCZOS_H
#define RUGO_CORE_QUANTITY_NETWORK_LANCZOS_H

#include <stddef.h>

/* The tridiagonal matrix that the steps stand for. */
struct lanczos {
    size_t count;
    double step;      /* the last one */
    double *diagonal; /* borrowed, as many as there are steps */
    double *beside;   /* squares of what couples each with the one before */
};
/* Adds a step of the length `step` along a direction that kept beta of the one before. */
void lanczos_add(struct lanczos *lanczos, double step, double beta);
/* To 1 %, of one step at least. It falls with each step, towards that of the equations. */
double lanczos_least(const struct lanczos *lanczos);

#endif
