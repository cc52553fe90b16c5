#include "jobs/curve.h"

static cJSON *values_of(const struct curve *curve, const double *values) {
    return curve->columns > 0 ? value_matrix(curve->n, curve->columns, values)
                              : value_numbers(curve->n, values);
}

static cJSON *theory_of(const struct curve *curve) {
    cJSON *theory = cJSON_CreateObject();
    if (curve->theory_name == NULL ||
        value_put(theory, curve->theory_name, values_of(curve, curve->theory)))
        return theory;
    cJSON_Delete(theory);
    return NULL;
}

static bool fill(cJSON *object, const struct curve *curve) {
    bool done = value_put(object, "quantity", cJSON_CreateString(curve->quantity)) &&
                value_put(object, "series", cJSON_CreateString("")) &&
                value_put(object, "x", value_numbers(curve->n, curve->x)) &&
                (curve->columns == 0 ||
                 value_put(object, "x2", value_numbers(curve->columns, curve->x2))) &&
                value_put(object, "y", values_of(curve, curve->y)) &&
                value_put(object, "standard_error", values_of(curve, curve->standard_error)) &&
                value_put(object, "discretisation_error", cJSON_CreateNull()) &&
                value_put(object, "theory", theory_of(curve)) &&
                value_put(object, "x_label", cJSON_CreateString(curve->x_label));
    if (done && curve->columns > 0)
        done = value_put(object, "x2_label", cJSON_CreateString(curve->x2_label));
    if (done && curve->counted)
        done = value_put(object, "underflow", value_number(curve->underflow)) &&
               value_put(object, "overflow", value_number(curve->overflow));
    return done && value_put(object, "y_label", cJSON_CreateString(curve->y_label));
}

bool curve_append(cJSON *curves, const struct curve *curve) {
    cJSON *object = cJSON_CreateObject();
    if (fill(object, curve))
        return value_append(curves, object);
    cJSON_Delete(object);
    return false;
}
