/* The measured surface that a case resembles, and sub-maps of random surfaces as an instrument
 * would have measured them (FORMULAS.md, F18.28). */
#ifndef RUGO_JOBS_LIKE_LIKE_CASE_H
#define RUGO_JOBS_LIKE_LIKE_CASE_H

#include "core/map/preparation/detrend.h"
#include "core/statistics/patch.h"
#include "core/statistics/spectra/joint_fit.h"
#include "jobs/like/like_parameters.h"
#include "jobs/surface/surface_case.h"

/* One of several maps of one surface. */
struct like_map {
    size_t nx, ny;
    double spacing;                      /* in lambda_s, as the next */
    struct spectrum_fit_request trusted; /* waves of its fit */
};

struct like_case {
    bool given;           /* the case resembles a measured surface */
    size_t nx, ny;        /* points of its map; of a profile ny is 1 */
    double spacing;       /* of its points, in lambda_s */
    size_t stride;        /* spacing of its points in those of the surface's grid; 0: no sub-maps,
                           * as they would not fit into the cell, or not have its points */
    enum detrend detrend; /* of the map, and of each sub-map */
    enum like_spectrum spectrum; /* where the parameters of the surfaces come from */
    enum like_heights heights;
    enum like_uncertainty uncertainty;
    size_t map_count; /* of several maps of one surface, of which the first is that above; 0: it is
                         the only one */
    struct like_map maps[JOINT_PATCHES_MOST];
    double between;            /* maps: deviation of ln C between them */
    double groove_depth_error; /* relative; NaN: the map has no grooves */
    double noise; /* RMS of that of the map, which its surfaces do not have, in lambda_s */
    bool hold;    /* surfaces hold the map (like_hold.h) */
    bool held[LIKE_HELD_COUNT];            /* given by the study */
    double measured[PATCH_QUANTITY_COUNT]; /* of the map, lengths in lambda_s; NaN: not known */
};
/* Reads the measured surface from values that a kind has checked by tables with LIKE_PARAMETERS
 * among them; adds faults. surface: that of the same values; NULL where it is at fault, and then
 * there are no sub-maps. Fails with ERROR_MEMORY alone. */
int like_case_fill(struct like_case *out, struct values *values, const struct surface_case *surface,
                   struct error *err);
static inline bool like_case_is_cut(const struct like_case *like) {
    return like->given && like->stride > 0;
}

/* Sub-maps of the surfaces of a case. */
struct like_patch;
/* Borrows both. */
int like_patch_create(struct like_patch **out, const struct like_case *like,
                      const struct grid *grid, struct error *err);
void like_patch_destroy(struct like_patch **patch);
/* Copies the sub-map at the origin from z, adds noise as the map has, from the random numbers of
 * the surface's key, and removes the trend: *heights, nx by ny heights, is valid until the next
 * call. */
int like_patch_cut(struct like_patch *patch, struct random_key key, const double *z,
                   const double **heights, struct error *err);
/* Measures this sub-map as the map was measured. */
int like_patch_measure(struct like_patch *patch, struct random_key key, const double *z,
                       double out[PATCH_QUANTITY_COUNT], struct error *err);
/* Return the peak bytes of this, and its CPU seconds on a 3 GHz core. */
double like_patch_bytes(const struct like_case *like);
double like_patch_seconds(const struct like_case *like);

#endif
