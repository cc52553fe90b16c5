#include "jobs/contact/contact_errors.h"
#include <math.h>

/* Orders outside of these say that the levels are too coarse to tell. */
static const double ORDER_LOW = 1, ORDER_HIGH = 3;

/* As measured on rough profiles and surfaces; the gap has no clear order, its error is small. */
static double assumed_order(const struct contact_case *study, enum contact_measure measure,
                            size_t model) {
    switch (measure) {
    case MEASURE_EDGES:
        if (study->surface.dimension == 1)
            return 2;
        return study->blocks[model].model == MODEL_HALFSPACE ? 1.5 : 2.5;
    case MEASURE_GAP:
        return 2;
    default:
        return 1;
    }
}

/* h of a level over that of the next finer one. */
static double refinement(const struct contact_case *study, size_t level) {
    return (double)study->levels[level + 1].grid.nx / (double)study->levels[level].grid.nx;
}

/* Change between the two coarser of three levels over that between the two finer ones, at an order:
 * fine^q (coarse^q - 1)/(fine^q - 1), rising in q. */
static double change_ratio(double order, double fine, double coarse) {
    return pow(fine, order) * expm1(order * log(coarse)) / expm1(order * log(fine));
}

/* The order whose change_ratio is `ratio`, within the bounds. */
static double solve_order(double ratio, double fine, double coarse) {
    double low = ORDER_LOW, high = ORDER_HIGH;
    for (int step = 0; step < 60; step++) {
        double middle = (low + high) / 2;
        if (change_ratio(middle, fine, coarse) < ratio)
            low = middle;
        else
            high = middle;
    }
    return (low + high) / 2;
}

/* Least squares over the curve: the ratio s that makes the coarser changes s times the finer ones.
 * NaN where nothing changes. */
static double observed_ratio(const struct contact_tally *tally, enum contact_measure measure,
                             size_t model) {
    const struct contact_case *study = tally->study;
    size_t finest = study->level_count - 1;
    double product = 0, square = 0;
    for (size_t k = 0; k < study->load_count; k++) {
        double fine = contact_tally_level(tally, measure, model, k).value;
        double coarse =
            contact_tally_mean(tally, measure, contact_case_cell(study, model, finest - 1, k))
                .value -
            contact_tally_mean(tally, measure, contact_case_cell(study, model, finest - 2, k))
                .value;
        if (isfinite(fine * coarse)) {
            product += fine * coarse;
            square += fine * fine;
        }
    }
    return product / square;
}

struct contact_extrapolation contact_extrapolate(const struct contact_tally *tally,
                                                 enum contact_measure measure, size_t model) {
    const struct contact_case *study = tally->study;
    size_t next = study->level_count - 2;
    struct contact_extrapolation out = {.order = assumed_order(study, measure, model)};
    double fine = refinement(study, next);
    if (study->level_count > 2) {
        double ratio = observed_ratio(tally, measure, model);
        out.observed = isfinite(ratio);
        if (out.observed)
            out.order = solve_order(ratio, fine, refinement(study, next - 1));
    }
    out.factor = 1 / expm1(out.order * log(fine));
    return out;
}
