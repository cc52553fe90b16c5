/* Corrections of contact areas of a model on a grid. They are calibrated on waves whose contact is
 * known, pressed with the same compliance on the same grid. Private to core/contact. */
#ifndef RUGO_CORE_CONTACT_AREA_LAW_H
#define RUGO_CORE_CONTACT_AREA_LAW_H

#include "core/contact/edge/edge.h"

/* To second order in the spacing an edge also moves by its curvature, whose integral along a closed
 * edge is 2 pi, and with the mean gap: where contact is averaged about a node, a given gap takes
 * more pressure than where it holds at the node. Both are calibrated on the double sine of Johnson,
 * Greenwood & Higginson (1985), F12.5, on the block without its coating. */
struct area_law {
    struct edge_law edge;
    double overlap;        /* area by nodes beyond that by edges, over the length of the boundary of
                              their cells */
    double patch;          /* cells that a patch covers beyond straight edges; a hole covers as many
                              fewer. 0 for a profile */
    double patch_of_nodes; /* as patch, for the area by nodes less overlap */
    double
        weighting; /* fraction of the weighting's error of the gap that counts; 1 for a profile */
};

/* Does not depend on which of two spacings is along x. Takes some ten milliseconds for a surface,
 * of unequal spacings twice as many times the larger over the smaller; a few for a profile.
 * ERROR_INPUT where that ratio is above 100; ERROR_NUMERIC where a solution for it fails;
 * ERROR_MEMORY. */
int area_law_make(const struct grid *grid, const struct block *block, struct area_law *out,
                  struct error *err);

#endif
