/* Areas of a face that slides within edges found between nodes: of what touches, and of what
 * sticks. What sticks is found as the contact of the lighter load that it is without coupling
 * (F14.20). Private to jobs/contact/quantity. */
#ifndef RUGO_JOBS_CONTACT_QUANTITY_SLIDING_EDGES_H
#define RUGO_JOBS_CONTACT_QUANTITY_SLIDING_EDGES_H

#include "core/contact/area.h"
#include <stdbool.h>

/* A state by node, on the grid of the areas. Lengths are the grid's, tractions in E*; along the
 * drag. */
struct sliding_nodes {
    const double *p, *q, *opening; /* weighted gaps, as of struct contact_state */
    const double *over; /* displacement of the face over the flat since the end of pressing */
    const bool *sticks;
};
/* Shares of the cell. */
struct sliding_area {
    double contact, stick;
    double crossed; /* segments or cells that the edge of what sticks crosses */
};

struct sliding_edges {
    size_t n;
    double friction, ratio; /* of the tangential compliance and the normal one */
    double forward;         /* 1 or -1: where the flat goes */
    double legs;            /* 1, or 2 after a turn */
    double *turned;         /* owned, as the next: `over` where the flat turned last */
    double *lighter_p, *lighter_gap;
};
/* poisson: of the block. ERROR_MEMORY. */
int sliding_edges_create(struct sliding_edges *out, const struct grid *grid, double poisson,
                         double friction, struct error *err);
void sliding_edges_clear(struct sliding_edges *edges);
double sliding_edges_bytes(const struct grid *grid);
/* Begins a path, forward or backward. */
void sliding_edges_begin(struct sliding_edges *edges, double forward);
/* Turns the path in this state. */
void sliding_edges_turn(struct sliding_edges *edges, const struct sliding_nodes *nodes);
struct sliding_area sliding_edges_measure(struct sliding_edges *edges, struct area_workspace *areas,
                                          const struct sliding_nodes *nodes);
/* Returns the area by edges of pressures and weighted gaps, share of the cell: without the mesh's
 * own compliance, which a ratio of such areas has not. */
double sliding_edges_area(struct area_workspace *areas, const double *p, const double *opening);

#endif
