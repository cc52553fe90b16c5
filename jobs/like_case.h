/* The measured surface that a case is like, and pieces of random surfaces as an instrument would
 * have measured them (FORMULAS.md, F18.28). */
#ifndef RUGO_JOBS_LIKE_CASE_H
#define RUGO_JOBS_LIKE_CASE_H

#include "core/map/detrend.h"
#include "core/statistics/patch.h"
#include "jobs/like_parameters.h"
#include "jobs/surface_case.h"

struct like_case {
    bool given;           /* the case is like a measured surface */
    size_t nx, ny;        /* points of its map; of a profile ny is 1 */
    size_t stride;        /* distance of its points in those of the surface's grid; 0: the pieces
                             would not fit into the cell, or not have its points: none are cut */
    enum detrend detrend; /* of the map, and of each piece */
    double measured[PATCH_QUANTITY_COUNT]; /* of the map, lengths in lambda_s; NaN: not known */
};
/* Reads it from values that a kind has checked by tables with LIKE_PARAMETERS among them, for a
 * surface that was read from them; adds faults. ERROR_MEMORY alone. */
int like_case_fill(struct like_case *out, struct values *values, const struct surface_case *surface,
                   struct error *err);
static inline bool like_case_is_cut(const struct like_case *like) {
    return like->given && like->stride > 0;
}

/* Pieces of the surfaces of a case. */
struct like_patch;
/* Borrows both. */
int like_patch_create(struct like_patch **out, const struct like_case *like,
                      const struct grid *grid, struct error *err);
void like_patch_destroy(struct like_patch **patch);
/* Cuts the piece at the origin out of z and takes its trend out: *piece, nx by ny heights, lives
 * until the next call. */
int like_patch_cut(struct like_patch *patch, const double *z, const double **piece,
                   struct error *err);
/* Cuts it and measures it as the map was. */
int like_patch_measure(struct like_patch *patch, const double *z, double out[PATCH_QUANTITY_COUNT],
                       struct error *err);
/* Peak bytes of cutting and measuring, and CPU seconds of it, on a 3 GHz core. */
double like_patch_bytes(const struct like_case *like);
double like_patch_seconds(const struct like_case *like);

#endif
