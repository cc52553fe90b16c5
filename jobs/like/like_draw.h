/* What the patch leaves open of the surfaces that are like it (FORMULAS.md, F18.47).
 *
 * A sub-map of a random surface with the parameters of the case, as large as the map, from a cell
 * of twice its sides, is fitted as the map was. What it gives differs from the case's parameters as
 * these differ from those of the surface that the map was cut from. A surface of the drawn
 * parameters, from the random numbers of a realisation, less that realisation is one draw of
 * (reported - true), with the scatter of the realisations taken out. Spectrum, scale, lay and
 * heights are drawn together, each as far as it was fitted. */
#ifndef RUGO_JOBS_LIKE_LIKE_DRAW_H
#define RUGO_JOBS_LIKE_LIKE_DRAW_H

#include "jobs/like/like_case.h"
#include "jobs/subset.h"

/* Returns whether what the patch leaves open is wanted. */
static inline bool like_draw_applies(const struct like_case *like) {
    return like->given && !like->hold && like->uncertainty == LIKE_UNCERTAINTY_POSTERIOR;
}
/* The realisations that have a draw: the first LIKE_DRAWS, which show a deviation to a fifth. */
enum { LIKE_DRAWS = 16 };
static inline struct subset like_draw_due(void) {
    return (struct subset){LIKE_DRAWS, 1, UINT64_C(1) << 60};
}

struct like_draw;
/* Borrows both; to the case like_draw_applies. Where the points of the map do not hold the waves of
 * the case, no surface can be made. */
int like_draw_create(struct like_draw **out, const struct like_case *like,
                     const struct surface_case *surface, struct error *err);
void like_draw_destroy(struct like_draw **draw);
/* A surface of drawn parameters, all borrowed until the next call. */
struct like_drawn {
    const struct surface_case *surface; /* on the grid of the case, lengths in its lambda_s */
    const struct modes *modes;          /* prescribed */
    const struct modes *own;            /* of this surface, as generator_drawn */
    struct moments moments;             /* prescribed */
    const double *z, *gaussian;         /* the latter where it is wanted and there is one */
    struct surface_report report;
};
/* Changes what the next draws ask while a surface is made, as generator_set_stop. */
void like_draw_set_stop(struct like_draw *draw, int (*stop)(void *context), void *context);
/* Makes the surface from the random numbers of this key. gaussian: whether the field behind a
 * translated one is wanted. ERROR_INPUT or ERROR_NUMERIC where the sub-map has no fit, or what it
 * gives no surfaces; ERROR_STOPPED. */
int like_draw_make(struct like_draw *draw, struct random_key key, bool gaussian,
                   struct like_drawn *out, struct error *err);

/* Return the peak bytes of this object, and the CPU seconds of a draw on a 3 GHz core. */
double like_draw_bytes(const struct like_case *like, const struct surface_case *surface);
double like_draw_seconds(const struct like_case *like, const struct surface_case *surface);

/* The error of a value from n draws of (reported - true): its mean, and the half width of the 95 %
 * interval of one more draw (Student); NaN of fewer than two. */
struct like_error {
    double value, bound, standard_error;
};
struct like_error like_draw_error(double mean, double deviation, size_t n);

#endif
