/* What contact areas of a model on a grid are corrected by: all is learnt from waves whose contact
 * is known, pressed with the same compliance on the same grid. Private to core/contact. */
#ifndef RUGO_CORE_CONTACT_AREA_LAW_H
#define RUGO_CORE_CONTACT_AREA_LAW_H

#include "core/contact/edge.h"

/* To second order in the spacing an edge also moves by its curvature, summed over a closed edge
 * 2 pi, and with the mean gap: contact in the mean about a node makes a given gap take more
 * pressure than contact at it. Learnt on the double sine of Johnson, Greenwood & Higginson (1985),
 * F12.5. */
struct area_law {
    struct edge_law edge;
    double overlap; /* area by nodes beyond that by edges, over the length of the boundary of
                       their cells */
    double patch;   /* cells that a patch has more than straight edges tell; a hole has as many
                       less. 0 for a profile */
    double patch_of_nodes; /* the same of the area by nodes less overlap */
    double weighting; /* share of the weighting's error of the gap that counts; 1 for a profile */
};

/* Some ten milliseconds of a surface, a few of a profile. */
int area_law_make(const struct grid *grid, const struct block *block, struct area_law *out,
                  struct error *err);

#endif
