#include "jobs/curve.h"

static cJSON *values_of(const struct curve *curve, const double *values) {
    return curve->columns > 0 ? value_matrix(curve->n, curve->columns, values)
                              : value_numbers(curve->n, values);
}

static cJSON *theory_of(const struct curve *curve) {
    cJSON *theory = cJSON_CreateObject();
    bool done = theory != NULL;
    for (size_t a = 0; done && a < CURVE_THEORIES_MOST && curve->theories[a].name != NULL; a++)
        done = value_put(theory, curve->theories[a].name, values_of(curve, curve->theories[a].y));
    if (done)
        return theory;
    cJSON_Delete(theory);
    return NULL;
}

/* What tells curves of one quantity apart. */
static bool put_place(cJSON *object, const struct curve *curve) {
    const char *series = curve->series != NULL ? curve->series : "";
    bool done = value_put(object, "series", cJSON_CreateString(series));
    if (done && curve->model != NULL)
        done = value_put(object, "model", cJSON_CreateString(curve->model)) &&
               value_put(object, "level", value_number(curve->level)) &&
               value_put(object, "points", value_number(curve->points));
    if (done && curve->kinematics != NULL)
        done = value_put(object, "kinematics", cJSON_CreateString(curve->kinematics));
    if (done && curve->pressure > 0)
        done = value_put(object, "pressure", value_number(curve->pressure));
    return done;
}

static bool put_errors(cJSON *object, const struct curve *curve) {
    const struct curve_errors *errors = &curve->errors;
    bool done = value_put(object, "standard_error", values_of(curve, curve->standard_error));
    if (done && errors->discretisation == NULL)
        done = value_put(object, "discretisation_error", cJSON_CreateNull());
    else if (done)
        done =
            value_put(object, "discretisation_error", values_of(curve, errors->discretisation)) &&
            value_put(object, "discretisation_standard_error",
                      values_of(curve, errors->discretisation_standard_error)) &&
            value_put(object, "discretisation_order", value_number(errors->order)) &&
            value_put(object, "discretisation_order_from",
                      cJSON_CreateString(errors->order_known ? "levels" : "assumed"));
    if (done && errors->model != NULL)
        done = value_put(object, "model_error", values_of(curve, errors->model)) &&
               value_put(object, "model_error_standard_error",
                         values_of(curve, errors->model_standard_error));
    return done;
}

static bool fill(cJSON *object, const struct curve *curve) {
    bool done = value_put(object, "quantity", cJSON_CreateString(curve->quantity)) &&
                put_place(object, curve) &&
                value_put(object, "x", value_numbers(curve->n, curve->x)) &&
                (curve->columns == 0 ||
                 value_put(object, "x2", value_numbers(curve->columns, curve->x2))) &&
                value_put(object, "y", values_of(curve, curve->y)) && put_errors(object, curve) &&
                value_put(object, "theory", theory_of(curve)) &&
                value_put(object, "x_label", cJSON_CreateString(curve->x_label));
    if (done && curve->columns > 0)
        done = value_put(object, "x2_label", cJSON_CreateString(curve->x2_label));
    if (done && curve->counted)
        done = value_put(object, "underflow", value_number(curve->underflow)) &&
               value_put(object, "overflow", value_number(curve->overflow));
    if (done && curve->valueless != NULL)
        done = value_put(object, "valueless", value_numbers(curve->n, curve->valueless));
    return done && value_put(object, "y_label", cJSON_CreateString(curve->y_label));
}

bool curve_append(cJSON *curves, const struct curve *curve) {
    cJSON *object = cJSON_CreateObject();
    if (fill(object, curve))
        return value_append(curves, object);
    cJSON_Delete(object);
    return false;
}
