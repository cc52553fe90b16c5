/* Families of straight, evenly spaced grooves, which a machined face has beside its
 * random part: FORMULAS.md, F18.71. */
#ifndef RUGO_CORE_SURFACE_GROOVES_GROOVES_H
#define RUGO_CORE_SURFACE_GROOVES_GROOVES_H

#include "core/random.h"
#include "core/surface/grid.h"
#include "core/surface/grooves/groove_profile.h"

enum { GROOVE_FAMILIES_MOST = 2 };
struct groove_family {
    struct groove_profile profile;
    double depth;          /* over the RMS height of the random part */
    double wave_x, wave_y; /* periods a unit length */
};
struct grooves {
    size_t families;
    struct groove_family family[GROOVE_FAMILIES_MOST];
    double phase; /* at the origin, in periods; NaN: at random for each realisation and family */
};

/* Returns the whole numbers of periods along the sides of a cell that a wave vector is nearest to,
 * and how far from them it is, in periods. */
struct groove_fit {
    double along_x, along_y, off;
};
struct groove_fit groove_fit_cell(double wave_x, double wave_y, double lx, double ly);
/* Returns how many harmonics of a wave vector, in periods along the sides, a grid holds. A cosine
 * with as many waves along a side as half of its points, or more, is another wave there. */
size_t groove_harmonics_most(const struct grid *grid, double along_x, double along_y);
/* Returns whether every family has whole numbers of periods along both sides of a cell, to 1e-6. */
bool grooves_fit(const struct grooves *grooves, double lx, double ly);

/* Adds the grooves of a realisation, times `height`, at the points of a grid: the same grooves on
 * all grids of a cell. height: the RMS height of the random part, negative to take them off. */
void grooves_add(const struct grooves *grooves, const struct grid *grid, struct random_key key,
                 double height, double *z);

/* Returns whether heights of the families are independent: at random phases, or where they cross.
 * Parallel families of a fixed phase have the same heights beside each other in every realisation.
 */
bool grooves_independent(const struct grooves *grooves);
/* Returns the moments of all families together where they are independent, else NaN, in units of
 * the RMS height of the random part: mean square, third and fourth cumulant of heights, and the
 * mean square slope by the unit length. */
struct groove_moments grooves_cumulants(const struct grooves *grooves);

#endif
