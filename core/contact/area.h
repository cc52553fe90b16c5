/* The real contact area of a discrete solution, by several estimators. Fractions of the cell. */
#ifndef RUGO_CORE_CONTACT_AREA_H
#define RUGO_CORE_CONTACT_AREA_H

#include "core/contact/compliance.h"

struct contact_area {
    double nodes; /* share of nodes in contact, each with the cell around it: an upper value */
    double lower; /* segments (profiles) or cells with all corners in contact ... */
    double upper; /* ... and with any */
    double edges; /* every edge found below the grid; in surfaces the mean over all grid lines */
    /* Surfaces: nodes less 0.1181 x perimeter x dx (Yastrebov, Anciaux & Molinari 2017); profiles:
     * NaN. */
    double perimeter;
};

struct area_workspace;
/* Learns where edges lie in this model on this grid (edge.h): some milliseconds. */
int area_workspace_create(struct area_workspace **out, const struct compliance *compliance,
                          struct error *err);
void area_workspace_destroy(struct area_workspace **workspace);

/* Takes p in E* and opening, both grid_points values, as contact_press gives them. */
void contact_area(struct area_workspace *workspace, const double *p, const double *opening,
                  struct contact_area *out);

#endif
