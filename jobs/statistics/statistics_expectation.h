/* Theory of a case, without any surface: the curves and scalars of a result with the values of
 * theory. A theory is a series: "nayak" (profiles: "longuet_higgins") without a grid, and "grid" of
 * the grid in use, where they apply. A scalar has the value of surfaces without a grid, and in
 * `grid` that of the grid.
 *
 * Surfaces whose heights are not Gaussian have the series "translation" in place of "nayak", and
 * "pits" and "grid_pits" of the summits of the mirrored surface. Of an iterated surface it is that
 * of the translated surface with its heights and its spectrum, if there is one. */
#ifndef RUGO_JOBS_STATISTICS_STATISTICS_EXPECTATION_H
#define RUGO_JOBS_STATISTICS_STATISTICS_EXPECTATION_H

#include "schema/result/result.h"
#include <cjson/cJSON.h>

/* Fills an empty result from the effective parameters of a case of any kind with a surface. It
 * reads those of the surface; those of statistics have their defaults where the kind has none.
 * joint: with the joint density of heights and curvatures, a matrix of all bins. On failure the
 * result is cleared. */
int statistics_expectation(const cJSON *parameters, bool joint, struct case_result *out,
                           struct error *err);

#endif
