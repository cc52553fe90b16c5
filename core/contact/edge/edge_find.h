/* Edges of contact on the grid lines that cross them. Private to core/contact. */
#ifndef RUGO_CORE_CONTACT_EDGE_EDGE_FIND_H
#define RUGO_CORE_CONTACT_EDGE_EDGE_FIND_H

#include "core/contact/contact.h"
#include "core/contact/edge/edge.h"

/* One of the two families of grid lines: nodes of a line are `along` apart, lines `beside`. */
struct edge_family {
    size_t lines, nodes;  /* lines, nodes of a line */
    size_t along, beside; /* steps in the array */
    double step, across;  /* lengths */
    bool row;
    bool open; /* lines end at the sides of the grid */
};
static inline struct edge_family edge_rows(const struct grid *grid) {
    return (struct edge_family){grid->ny,      grid->nx,      1,    grid->nx,
                                grid_dx(grid), grid_dy(grid), true, false};
}
static inline struct edge_family edge_columns(const struct grid *grid) {
    return (struct edge_family){grid->nx,      grid->ny,      grid->nx, 1,
                                grid_dy(grid), grid_dx(grid), false,    false};
}
/* Returns the index of a node; both numbers count modulo what there is. */
static inline size_t edge_node(const struct edge_family *family, size_t line, size_t node) {
    return line % family->lines * family->beside + node % family->nodes * family->along;
}

/* The nodes around one edge on a grid line, from a node in contact to its neighbour out of contact.
 */
struct edge_crossing {
    size_t inside, outside;    /* the two nodes; all names below are nodes too */
    size_t before, far_before; /* further inside */
    size_t beyond, far_beyond; /* further outside */
    size_t inside_left, inside_right, outside_left, outside_right; /* beside the two */
    double step, across;                                           /* spacings, along and beside */
    bool row;                                                      /* along x */
    bool profile;
};
/* The crossing from node a of the line to node b, one step forth or back (nodes counted modulo the
 * line). On open lines both are nodes of the line, and the outermost nodes and lines stand for
 * those beyond a side. */
struct edge_crossing edge_crossing_at(const struct edge_family *family, size_t line, size_t a,
                                      size_t b);

/* Returns the largest pressure of n nodes. */
double edge_highest_pressure(size_t n, const double *p);
/* Fills rise, of nodes first .. end - 1, with quantities that are proportional to a distance from
 * the edge: in contact the square of the pressure over the highest one of all nodes; elsewhere
 * -(3 gap/4)^(2/3) of the gap over that pressure. An edge does not depend on this unit, and squares
 * stay in range. Gaps are in the grid's lengths. stiffness: that of the law. */
void edge_fill_rise(const struct contact_state *state, double highest, double stiffness,
                    size_t first, size_t end, double *rise);

/* The result of a crossing. Distances are true ones; t is the distance to the edge along the line,
 * in steps. */
struct edge_found {
    double lone;  /* NaN, unless the inside node is a patch of its own: then half of what it covers,
                     in cells, and all else is undefined */
    double part;  /* weight of the crossing: the squared cosine between line and normal */
    double share; /* t at the inside node */
    /* The face ends in a side, as that of a punch does: beside a smooth edge the pressure falls
     * towards it, beside a side it rises without limit (Johnson 1985, chapter 2). Seen where three
     * nodes in contact lie on the line. Then the law holds for none of the values here. */
    bool side;
    double slope, bend; /* inside the edge, rise = slope t (1 - bend t) */
    double next;        /* rise at the next node further inside, by the law over that found */
    double reach;       /* the largest t that an inside node can have, wherever the edge lies */
    double apart;       /* a step of the line along the normal, in spacings along that */
    double rate;        /* derivative of the distance along the normal of the inside node, in these,
                           by the logarithm of its pressure */
};
struct edge_found edge_find(const struct edge_crossing *crossing, const struct edge_law *law,
                            const double *rise);

#endif
