/* The contact area that edges between nodes enclose, and its derivative. Private to core/contact.
 *
 * An edge is found on every grid line that crosses one. The strip between the edge and the boundary
 * of the cells around the nodes in contact is measured along both families of lines. Each crossing
 * counts by the square of the cosine between its line and the edge's normal. So the two families
 * together count each part of the strip once, and lines nearly parallel to an edge, which cross it
 * inaccurately, hardly count. */
#ifndef RUGO_CORE_CONTACT_EDGE_EDGE_AREA_H
#define RUGO_CORE_CONTACT_EDGE_EDGE_AREA_H

#include "core/contact/contact.h"
#include "core/contact/edge/edge.h"

/* Shares of the cell. */
struct edge_area {
    double straight; /* the area if edges were straight */
    double rate;     /* its derivative by the mean pressure; 0 without a tangent */
    double patches; /* patches less holes, over the number of nodes; diagonal contact counts half */
    double nodes;   /* in contact */
    double lower;   /* segments (profiles) or cells with all corners in contact ... */
    double upper;   /* ... and with any */
    double sides;   /* of nodes in contact that face open ones, over the number of nodes */
    /* Where the node in contact has yielded, or the face ends in a side (edge_found.side), its
     * pressure says nothing of the edge, which is put half a step beyond, as node counting does. */
    double unknown;       /* the area between such edges and either node beside them */
    double unknown_sides; /* such sides, over the number of nodes */
};

/* Measures the area of states on one grid. */
struct edge_scan;
/* open: contact ends at the sides of the grid, on the borders of the cells of the outermost nodes.
 * Borrows the law, which must outlive it. */
int edge_scan_create(struct edge_scan **out, const struct edge_law *law, const struct grid *grid,
                     bool open, struct error *err);
void edge_scan_destroy(struct edge_scan **scan);
/* Of states that bring scratch. */
double edge_scan_bytes(const struct grid *grid);
/* Lets a team work along, with the same digits; it is borrowed until the next call. */
void edge_scan_set_team(struct edge_scan *scan, struct team *team);
void edge_area_measure(struct edge_scan *scan, const struct contact_state *state,
                       struct edge_area *out);

#endif
