/* The search for a true maximum of a surface that is known by its interpolant, cell by cell. */
#ifndef RUGO_CORE_STATISTICS_SUMMITS_SUMMIT_CLIMB_H
#define RUGO_CORE_STATISTICS_SUMMITS_SUMMIT_CLIMB_H

#include "core/statistics/summits/summit_list.h"
#include "core/surface/grid.h"

enum { CLIMB_TRAVEL = 6 }; /* cells that a search may move from its start, along each axis */

/* Value and derivatives at a point, in units of the fine grid. */
struct jet {
    double z, x, y, xx, xy, yy;
};
struct climb_cell {
    long x, y;
};
/* Moves to the cell whose interpolant is used at x: the last one until x is well outside of it, by
 * a quarter. Derivatives jump a little from cell to cell, and a search that changed cells on the
 * border would never settle on a maximum there. */
void cell_follow(double x, long *cell);

/* A surface on a fine grid that resolves its waves. */
struct climb {
    const void *surface;
    /* Fills the jet at x, y by the interpolant of *cell, which follows. */
    void (*jet)(const void *surface, double x, double y, struct climb_cell *cell, struct jet *jet);
    bool profile;
};
/* Searches the true maximum near a maximum x0, y0 among fine points; returns false when there is
 * none within CLIMB_TRAVEL. */
bool summit_climb(const struct climb *climb, double x0, double y0, double *x, double *y,
                  struct jet *jet);

/* Drops what was found from several starts, and sorts by row; the fine grid counts as periodic. */
void summits_merge(const struct grid *fine, struct summit_list *list);

#endif
