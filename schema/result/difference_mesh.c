#include "schema/result/difference_mesh.h"
#include <math.h>

struct mesh_curves mesh_curves_of(const struct case_result *result, const struct curve *finest) {
    struct mesh_curves out = {finest, NULL};
    for (size_t n = 0; n < result->curve_count; n++) {
        const struct curve *curve = &result->curves[n];
        if (curve_same_series(curve, finest) && same_text(curve->model, finest->model) &&
            same_text(curve->kinematics, finest->kinematics) && curve->level < finest->level &&
            curve->n == finest->n && (out.coarse == NULL || curve->level > out.coarse->level))
            out.coarse = curve;
    }
    return out;
}

static bool lacks_values(const struct curve *curve) {
    for (size_t k = 0; k < curve->n && curve->valueless != NULL; k++)
        if (curve->valueless[k] > 0)
            return true;
    return false;
}

static bool is_comparable(const struct mesh_curves *a, const struct mesh_curves *b) {
    return a->coarse != NULL && b->coarse != NULL && same_number(a->fine->level, b->fine->level) &&
           same_number(a->coarse->level, b->coarse->level) && !lacks_values(a->fine) &&
           !lacks_values(a->coarse) && !lacks_values(b->fine) && !lacks_values(b->coarse);
}

static double change_at(const struct mesh_curves *curves, size_t at) {
    return curves->fine->y[at] - curves->coarse->y[at];
}

/* Returns whether all that is known at a place is a bound. */
static bool is_bounded(const struct mesh_curves *curves, size_t at) {
    const struct curve_error *error = &curves->fine->errors[ERROR_DISCRETISATION];
    return error->value != NULL && error->bound != NULL && error->value[at] == 0 &&
           error->bound[at] > 0;
}

void difference_mesh_bounds(const struct mesh_curves *minuend, const struct mesh_curves *subtrahend,
                            size_t n, const size_t *a, const size_t *b, double *bound) {
    for (size_t k = 0; k < n && is_comparable(minuend, subtrahend); k++) {
        double changes = fabs(change_at(minuend, a[k])) + fabs(change_at(subtrahend, b[k])),
               largest = 0;
        if (!is_bounded(minuend, a[k]) || !is_bounded(subtrahend, b[k]) || !(changes > 0))
            continue;
        for (size_t near = k > 0 ? k - 1 : 0; near < n && near <= k + 1; near++)
            largest =
                fmax(largest, fabs(change_at(minuend, a[near]) - change_at(subtrahend, b[near])));
        bound[k] = fmin(bound[k], bound[k] / changes * largest);
    }
}
