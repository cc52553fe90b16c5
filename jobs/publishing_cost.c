#include "jobs/publishing_cost.h"

/* Seconds for a case, a curve and a point. */
static const double CASE_SECONDS = 6e-4, CURVE_SECONDS = 1.6e-5, POINT_SECONDS = 1.5e-6;

double publishing_cost(size_t curves, size_t points) {
    return CASE_SECONDS + CURVE_SECONDS * (double)curves + POINT_SECONDS * (double)points;
}
