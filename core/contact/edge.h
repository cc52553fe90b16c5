/* Where the edge of a contact lies between a node in contact and its neighbour out of contact.
 *
 * At a distance d from a smooth frictionless edge the pressure inside is p = c sqrt(d) E* and the
 * gap outside (4 c/3) d^(3/2), with one c (Johnson 1985, chapter 4). So p^2 = c^2 d and
 * (3 gap/4)^(2/3) = c^(2/3) d rise linearly on the two sides, and the two nodes of the pair give
 * the edge and c: the first guess. Values at nodes of a discrete solution are not those of the
 * exact one so near a singular edge, but near every straight edge they are off alike: an edge law
 * holds where the edge truly is for each first guess, as found on one wave, whose edges are known
 * (Westergaard 1939), pressed at many places of the same grid with the same model. */
#ifndef RUGO_CORE_CONTACT_EDGE_H
#define RUGO_CORE_CONTACT_EDGE_H

#include "core/contact/compliance.h"

enum { EDGE_PHASES = 64 };

struct edge_law {               /* a sample a phase, in rising order */
    double root[EDGE_PHASES];   /* square root of the first guess */
    double before[EDGE_PHASES]; /* squared pressure at the next node further inside, over that
                                   inside */
    double share[EDGE_PHASES];  /* edge beyond the node inside, in steps; from about -0.2 to 1 */
};

/* Makes the law of grid lines along x (columns false) or y, which takes some milliseconds. Fails as
 * compliance_create and contact_press do. */
int edge_law_make(const struct grid *grid, const struct block *block, bool columns,
                  struct edge_law *out, struct error *err);

/* First guess, in [0, 1] steps: squared pressure at the node inside, (3 gap/4)^(2/3) at that
 * outside, lengths in steps. */
double edge_guess(double pressure_squared, double gap_rise);
/* The edge beyond the node inside, in steps. before: squared pressure at the next node further
 * inside, which tells how p^2 bends (0: not known). */
double edge_share(const struct edge_law *law, double pressure_squared, double before,
                  double gap_rise);

/* Half the width of a patch of one node, in steps: that of Hertz's line contact with the same force
 * and the same gaps at the two nodes beside it (gaps and force over E*, lengths in steps). */
double edge_lone(double force, double gap_left, double gap_right);
/* The same of a surface's patch: semi-axis, in steps, towards two opposite nodes beside it, from
 * Hertz's contact of a sphere (force over E* in steps squared). */
double edge_lone_axis(double force, double gap_left, double gap_right);

#endif
