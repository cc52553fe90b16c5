/* What a contact with a finite hardness remembers: the face as it was, and how far nodes have been
 * lowered for good. Private to core/contact.
 *
 * Lengths and pressures are in the solver's units (contact.c), but for depth. Arrays belong to the
 * flattening. */
#ifndef RUGO_CORE_CONTACT_FLATTENING_H
#define RUGO_CORE_CONTACT_FLATTENING_H

#include "core/contact/solver/conjugate_gradient.h"

struct flattening {
    double hardness;   /* INFINITY: none, and no arrays */
    double *face;      /* weighted heights as they were */
    double *depth;     /* by which the highest load has lowered nodes, the grid's length */
    double *kept;      /* scratch of padded nodes */
    double *resisting; /* tangent with all nodes in contact held */
    double volume;     /* mean depth; 0 as long as no node has yielded */
    double approach;   /* highest point of the face less that of the lowered one, likewise */
    double highest;    /* mean pressure of the load that made the depths */
    bool lowered;      /* the solver's heights are those of the lowered face */
};

int flattening_create(struct flattening *out, const struct conjugate_gradient *solver,
                      struct error *err);
void flattening_clear(struct flattening *flattening);
double flattening_bytes(const struct grid *grid);

/* Forgets all loads, and takes the solver's heights and the hardness. */
void flattening_begin(struct flattening *flattening, const struct conjugate_gradient *solver,
                      double hardness);
/* Gives the solver the face that a load of this mean presses: below the highest the lowered one,
 * which is elastic, else the one that was, under the hardness. Tangents follow. unit: of heights,
 * the grid's length. */
void flattening_turn(struct flattening *flattening, struct conjugate_gradient *solver, double mean,
                     double unit);
/* Exchanges the solver's tangent and the resisting one. */
void flattening_swap(struct flattening *flattening, struct conjugate_gradient *solver);
/* Brings the solver's first guess of pressures, of this mean, below the hardness. Returns whether
 * it exceeded it. */
bool flattening_limit(const struct flattening *flattening, struct conjugate_gradient *solver,
                      double mean);
/* Takes the depths of a solution on the face as it was. Returns the number of yielded nodes. */
size_t flattening_take(struct flattening *flattening, const struct conjugate_gradient *solver,
                       double approach, double mean, double unit);

#endif
