/* One case of a statistics study. */
#ifndef RUGO_JOBS_STATISTICS_STATISTICS_CASE_H
#define RUGO_JOBS_STATISTICS_STATISTICS_CASE_H

#include "core/statistics/heights/histogram.h"
#include "core/statistics/summits/summits.h"
#include "jobs/kind.h"
#include "jobs/like/like_case.h"
#include "jobs/surface/surface_case.h"
#include "schema/study/fault.h"

extern const struct parameter_table STATISTICS_PARAMETERS;
/* Tables of the kind: SURFACE_PARAMETERS, LIKE_PARAMETERS and the above. */
extern const struct parameter_table *const STATISTICS_TABLES[];

/* Coarser levels at most. */
enum { STATISTICS_LEVELS_MOST = 4 };

struct statistics_case {
    struct surface_case surface;
    struct like_case like; /* a measured surface that these resemble */
    enum summit_stencil stencil;
    enum summit_curvature curvature;
    struct bins height;     /* of z* = z/sqrt(m0) */
    struct bins equivalent; /* of t1 = -sqrt(3/m4) kappa_m; profiles z''/sqrt(m4) */
    /* Coarser grids on which the surfaces are also measured: every n-th of their points, n
     * rising. */
    size_t level_count, strides[STATISTICS_LEVELS_MOST];
};
/* Reads a case as surface_case_read does. */
int statistics_case_read(struct statistics_case *out, const cJSON *parameters,
                         struct fault_list *faults, struct error *err);
void statistics_case_clear(struct statistics_case *one_case);

/* Returns whether surfaces have the same distribution as their mirror images -z. Then pits are
 * counted as summits. */
static inline bool statistics_case_symmetric(const struct statistics_case *one_case) {
    return one_case->surface.options.heights.type == HEIGHTS_GAUSSIAN &&
           one_case->surface.plateau == NULL && one_case->surface.grooves == NULL;
}
/* Returns how many kinds of summits are distinguished: summits, and pits where they differ from
 * them. */
static inline size_t statistics_case_sides(const struct statistics_case *one_case) {
    return statistics_case_symmetric(one_case) ? 1 : 2;
}

/* Returns whether summits are found by the Gaussian field of a translated surface. */
bool statistics_case_wants_gaussian(const struct statistics_case *one_case);
/* Makes a finder of such summits know the function of the field (summits.h). height: RMS height.
 * Does nothing for other cases. */
int statistics_case_translate(const struct statistics_case *one_case, struct summit_finder *finder,
                              double height, struct error *err);

/* Estimates memory, time and error of one realisation before anything ran (statistics_cost.c). */
void statistics_case_estimate(const struct statistics_case *one_case, struct study_cost *out);

#endif
