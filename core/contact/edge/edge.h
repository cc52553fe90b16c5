/* Where the edge of a contact lies between the nodes of a grid.
 *
 * At a distance d from a smooth frictionless edge the pressure inside is p = c sqrt(d) E* and the
 * gap outside (4 c/3) d^(3/2), with one c (Johnson 1985, chapter 4). So p^2/c^2 and (3
 * gap/4c)^(2/3) are distances to the edge. At nodes of a discrete solution they differ from the
 * true ones, but alike near every straight edge of the same direction. An edge law gives, for a few
 * directions, the true distance for each of these. It is calibrated on a wave with its crests along
 * the direction, whose edges and fields are known in closed form (Westergaard 1939). At the grid's
 * nodes such a wave depends on one whole number, so that it is a profile's problem with the grid's
 * own compliances. On a coated block the wave itself is solved on a fine grid. There the pressure
 * is c sqrt(d) E* times a stiffness, between 1 and that of the coating, by its thickness over the
 * spacing (F22.3).
 *
 * Lengths are in units of the spacing of the grid along the edge's normal n, hypot(nx dx, ny dy),
 * which is dx wherever dx = dy. */
#ifndef RUGO_CORE_CONTACT_EDGE_EDGE_H
#define RUGO_CORE_CONTACT_EDGE_EDGE_H

#include "core/contact/compliance.h"

enum { EDGE_DIRECTIONS = 11, EDGE_SAMPLES = 129, EDGE_SAMPLES_A_UNIT = 64 };

/* True distance less that of the fields, at equal steps of the root of the latter; after the last
 * step it is constant. The root is p/c inside, and distances rise evenly with p/c where nodes come
 * into contact. A node in contact can lie beyond the edge, and an open node inside it. */
struct edge_table {
    double inside[EDGE_SAMPLES], outside[EDGE_SAMPLES];
};
struct edge_law {
    size_t count;                  /* 1 of a profile, 11 of a surface */
    double angle[EDGE_DIRECTIONS]; /* of the normal to the x axis, rising from 0 to pi/2 */
    struct edge_table table[EDGE_DIRECTIONS];
    double stiffness; /* near edges, over E*; 1 without a coating */
};

/* Takes some milliseconds. Errors of compliance_create and contact_press. */
int edge_law_make(const struct grid *grid, const struct block *block, struct edge_law *out,
                  struct error *err);
/* Returns how far contact by nodes reaches beyond the edge, averaged over all directions. */
double edge_overlap(const struct edge_law *law);

/* The law of one direction: a weighted mean of two tables. */
struct edge_direction {
    const struct edge_table *low, *high;
    double part; /* of high */
};
struct edge_direction edge_direction(const struct edge_law *law, double angle);
/* Return the true distance to the edge of a node inside, and of one outside, by the distance of the
 * fields. */
double edge_inside(const struct edge_direction *direction, double distance);
double edge_outside(const struct edge_direction *direction, double distance);
/* Returns the derivative of edge_inside by the logarithm of the pressure. */
double edge_inside_slope(const struct edge_direction *direction, double distance);
/* Returns 1/c^(2/3) of an edge between two nodes whose true distances to it add up to `apart`, from
 * the squared pressure at the node inside (above 0) and (3 gap/4)^(2/3) at the node outside. start:
 * near it, or 0. */
double edge_scale(const struct edge_direction *direction, double pressure_squared, double gap_rise,
                  double apart, double start);

/* Returns half the width of a patch of one node, in steps: that of Hertz's line contact with the
 * same force and the same gaps at the two nodes beside it (gaps and force over E*, lengths in
 * steps). */
double edge_lone(double force, double gap_left, double gap_right);
/* Returns the same for a patch of a surface: the semi-axis, in steps, towards two opposite nodes
 * beside it, from Hertz's contact of a sphere (force over E* in steps squared). */
double edge_lone_axis(double force, double gap_left, double gap_right);

#endif
