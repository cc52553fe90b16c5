#include "jobs/contact/contact_errors.h"
#include "core/statistics/richardson.h"
#include <math.h>

/* As measured on rough profiles and surfaces; the gap has no clear order, its error is small. */
static double assumed_order(const struct contact_case *one_case, enum contact_measure measure,
                            size_t model) {
    switch (measure) {
    case MEASURE_EDGES:
    case MEASURE_EDGES_STRETCHED:
        return one_case->models[model]->edge_order[one_case->surface.dimension - 1];
    case MEASURE_GAP:
        return 2;
    default:
        return 1;
    }
}

/* Returns h of a level over that of the next finer one. */
static double refinement(const struct contact_case *one_case, size_t level) {
    return (double)one_case->levels[level + 1].grid.nx / (double)one_case->levels[level].grid.nx;
}

/* Returns the ratio of the changes between levels over the whole curve; NaN where nothing changes.
 */
static double observed_ratio(const struct contact_tally *tally, enum contact_measure measure,
                             size_t model) {
    const struct contact_case *one_case = tally->one_case;
    size_t finest = one_case->level_count - 1;
    struct richardson_fit fit = {0};
    for (size_t k = 0; k < one_case->load_count; k++) {
        double fine = contact_tally_level(tally, measure, model, k).value;
        double coarse =
            contact_tally_mean(tally, measure, contact_case_cell(one_case, model, finest - 1, k))
                .value -
            contact_tally_mean(tally, measure, contact_case_cell(one_case, model, finest - 2, k))
                .value;
        richardson_fit_add(&fit, fine, coarse);
    }
    return richardson_fit_ratio(&fit);
}

struct contact_extrapolation contact_extrapolate(const struct contact_tally *tally,
                                                 enum contact_measure measure, size_t model) {
    const struct contact_case *one_case = tally->one_case;
    size_t next = one_case->level_count - 2;
    struct contact_extrapolation out = {.order = assumed_order(one_case, measure, model)};
    double fine = refinement(one_case, next);
    if (one_case->level_count > 2) {
        double ratio = observed_ratio(tally, measure, model);
        out.observed = isfinite(ratio);
        if (out.observed)
            out.order = richardson_order(ratio, fine, refinement(one_case, next - 1));
    }
    out.factor = richardson_factor(out.order, fine);
    return out;
}
