/* Functional parameters of ISO 25178-2 (2021), of profiles ISO 21920-2 (2021): what the curve of
 * heights over the share of material says of running in, carrying and holding oil (FORMULAS.md,
 * F18.34 to F18.36). Names are those of the areal parameters without S (k: Sk, and Rk). */
#ifndef RUGO_CORE_STATISTICS_HEIGHTS_FUNCTIONAL_H
#define RUGO_CORE_STATISTICS_HEIGHTS_FUNCTIONAL_H

#include "core/statistics/measured_map.h"
#include "core/statistics/summits/summit_list.h"

/* Heights in order, as the material ratio curve: height number k of n from the highest, from 0, is
 * at the ratio (k + 1/2)/n; linear between, level beyond. */
struct material_curve {
    size_t n;    /* heights that are no holes; 1 at least */
    double *z;   /* owned, n, rising, about their mean */
    double mean; /* of the heights */
};
/* Copies and sorts the heights. Memory: 8 bytes a height, and for a while what a ranker has
 * (rank.h) beside. ERROR_MEMORY, or ERROR_INPUT for a map without heights. */
int material_curve_create(struct material_curve *out, const struct measured_map *map,
                          struct error *err);
void material_curve_clear(struct material_curve *curve);
/* Returns the height about the mean that a share of the points (0 to 1) reaches: Smc. */
double material_height(const struct material_curve *curve, double ratio);
/* Returns the share of the points that reach a height about the mean: Smr. */
double material_ratio(const struct material_curve *curve, double height);

/* What an equivalent straight line divides the curve into. */
struct material_core {
    double k;        /* height of the core: of the line between the ratios 0 and 1 */
    double pk, vk;   /* of triangles with the area of the curve above and below the core */
    double mr1, mr2; /* ratios at which the curve leaves the core, 0 to 1 */
};

struct functional {
    struct material_core line;   /* by the line of least squares, as the standards say */
    struct material_core secant; /* by the flattest secant itself */
    double xp;                   /* height at 2.5 % over that at 50 % */
    double vmp, vmc;             /* volume of material by area: of peaks (10 %), core (to 80 %) */
    double vvc, vvv;             /* of voids, likewise: of the core, of valleys */
};
/* The central region is where the secant over 40 % of the curve is flattest, the first of equal
 * ones; it is exact over the curve. Time: proportional to the heights. */
void functional_measure(const struct material_curve *curve, struct functional *out);

/* The five highest hills and the five deepest dales that stand out by 5 % of Sz (F18.10), or as
 * many as there are. */
struct ten_points {
    size_t hills, dales;   /* that stand out */
    double s5p, s5v, s10z; /* mean height of the hills, mean depth of the dales, sum; NaN: none */
};
/* hills: the list of areal_measure(); mean: of the heights. Memory: a map, and that of
 * hills_find(). */
int ten_points_measure(const struct measured_map *map, const struct summit_list *hills, double mean,
                       double sz, struct ten_points *out, struct error *err);

/* Mean widths of the elements of a profile, a hill with a dale. */
struct profile_spacing {
    size_t elements, elements_old;
    double rsm;     /* ISO 21920-2 (2021): by crossing lines; NaN without an element, as the next */
    double rsm_old; /* ISO 4287 (1997), the whole profile being its sampling length */
};
void profile_spacing_measure(const struct measured_map *profile, double mean,
                             struct profile_spacing *out);

#endif
