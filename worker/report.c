/* Speed against error: what each case cost, and the errors that this bought.
 *
 * The errors of a curve are sizes over all its points: the statistical one is |standard error|/|y|,
 * the deviation from a theory |y - theory|/|theory|, |.| being the root of the sum of squares over
 * the points where both are known; those of mesh and model are in report_series.h. A case's errors
 * are those of its main curve, the first one that has an error and a theory beside it, or else the
 * first one with an error at all.
 * Statistical errors fall with the square root of the realisations, so that half the error costs
 * three times what was spent. */
#include "schema/json/flat.h"
#include "schema/json/wire_field.h"
#include "worker/aggregate.h"
#include "worker/report_series.h"

#include <math.h>
#include <stdlib.h>

static double curve_error(const cJSON *curve) {
    return relative_size(field_at(curve, "standard_error"), NULL, field_at(curve, "y"));
}

static bool put_number(cJSON *object, const char *key, double number) {
    return field_put(object, key, json_number(number));
}

static bool put_copy(cJSON *object, const char *key, const cJSON *from) {
    const cJSON *value = field_at(from, key);
    return !value || field_put(object, key, cJSON_Duplicate(value, true));
}

/* {"nayak": 0.01}: deviation from each theory of a curve. */
static cJSON *curve_deviations(const cJSON *curve) {
    cJSON *deviations = cJSON_CreateObject();
    bool complete = deviations != NULL;
    const cJSON *theory;
    cJSON_ArrayForEach(theory, field_at(curve, "theory")) {
        double deviation = relative_size(field_at(curve, "y"), theory, theory);
        complete = complete && put_number(deviations, theory->string, deviation);
    }
    return fields_finish(deviations, complete);
}

/* Root of the sum of squares of those that are known. NaN without a statistical one. */
static double whole_error(double statistical, const struct series_errors *errors) {
    double discretisation = isnan(errors->discretisation) ? 0 : errors->discretisation;
    double model = isnan(errors->model) ? 0 : errors->model;
    return sqrt(statistical * statistical + discretisation * discretisation + model * model);
}

/* Of the point that lacks most of them; nothing where the curve does not tell. */
static bool put_valueless(cJSON *report, const cJSON *curve) {
    const cJSON *valueless, *list = field_at(curve, "valueless");
    double most = 0;
    cJSON_ArrayForEach(valueless, list) {
        most = fmax(most, valueless->valuedouble);
    }
    return !list || put_number(report, "valueless", most);
}

static bool put_curve_errors(cJSON *report, const cJSON *curves, const cJSON *curve) {
    struct series_errors errors;
    double statistical = curve_error(curve);
    return series_errors(curves, curve, &errors) && put_valueless(report, curve) &&
           put_number(report, "statistical_error", statistical) &&
           put_number(report, "discretisation_error", errors.discretisation) &&
           put_number(report, "model_error", errors.model) &&
           put_number(report, "total_error", whole_error(statistical, &errors)) &&
           field_put(report, "theory_deviation", curve_deviations(curve));
}

static cJSON *curve_report(const cJSON *curves, const cJSON *curve, double seconds) {
    static const char *const PLACE[] = {"quantity",   "series", "model",
                                        "kinematics", "level",  "pressure"};
    cJSON *report = cJSON_CreateObject();
    bool complete = report != NULL;
    for (size_t n = 0; n < sizeof PLACE / sizeof *PLACE; n++) {
        complete = complete && put_copy(report, PLACE[n], curve);
    }
    complete = complete && put_number(report, "seconds", seconds * series_share(curves, curve)) &&
               put_curve_errors(report, curves, curve);
    return fields_finish(report, complete);
}

static cJSON *curve_reports(const cJSON *curves, double seconds) {
    cJSON *reports = cJSON_CreateArray();
    bool complete = reports != NULL;
    const cJSON *curve;
    cJSON_ArrayForEach(curve, curves) {
        cJSON *report = complete ? curve_report(curves, curve, seconds) : NULL;
        complete = report && cJSON_AddItemToArray(reports, report);
        if (!complete) {
            cJSON_Delete(report);
        }
    }
    return fields_finish(reports, complete);
}

static double member(const cJSON *object, const char *key) {
    const cJSON *number = field_at(object, key);
    return cJSON_IsNumber(number) ? number->valuedouble : (double)NAN;
}

/* {"value", "statistical_error", "theory_deviation"}: both relative, null where the value is 0. */
static cJSON *scalar_report(const cJSON *scalar) {
    double value = member(scalar, "value"), theory = member(scalar, "theory");
    double error = member(scalar, "standard_error") / fabs(value);
    cJSON *report = cJSON_CreateObject();
    bool complete = report && put_number(report, "value", value) &&
                    put_number(report, "statistical_error", error);
    if (complete && field_at(scalar, "theory")) {
        complete = put_number(report, "theory_deviation", fabs(value - theory) / fabs(theory));
    }
    return fields_finish(report, complete);
}

static cJSON *scalar_reports(const cJSON *scalars) {
    cJSON *reports = cJSON_CreateObject();
    bool complete = reports != NULL;
    const cJSON *scalar;
    cJSON_ArrayForEach(scalar, scalars) {
        complete = complete && field_put(reports, scalar->string, scalar_report(scalar));
    }
    return fields_finish(reports, complete);
}

static const cJSON *main_curve(const cJSON *curves) {
    const cJSON *curve, *found = NULL;
    cJSON_ArrayForEach(curve, curves) {
        const cJSON *theory = field_at(curve, "theory");
        bool random = curve_error(curve) > 0; /* false for NaN, and for what is known exactly */
        if (random && theory && theory->child) {
            return curve;
        }
        if (random && !found) {
            found = curve;
        }
    }
    return found;
}

static bool put_cost(cJSON *report, const struct case_cost *cost) {
    double each =
        cost->realisations_done ? cost->seconds / (double)cost->realisations_done : (double)NAN;
    return field_put_count(report, "case", cost->case_number) &&
           field_put_count(report, "realisations", cost->realisations_done) &&
           field_put_count(report, "realisations_total", cost->realisations) &&
           field_put_count(report, "jobs", cost->jobs) &&
           field_put_count(report, "attempts", cost->attempts) &&
           put_number(report, "seconds", cost->seconds) &&
           put_number(report, "seconds_per_realisation", each);
}

/* Of the main curve; without one, of nothing. */
static bool put_errors(cJSON *report, const cJSON *main, double seconds, const cJSON *curves) {
    static const char *const PLACE[] = {"series", "model", "kinematics", "level"};
    const cJSON *quantity = field_at(main, "quantity");
    bool complete = field_put(report, "main_curve",
                              quantity ? cJSON_Duplicate(quantity, true) : cJSON_CreateNull());
    for (size_t n = 0; n < sizeof PLACE / sizeof *PLACE; n++) {
        complete = complete && put_copy(report, PLACE[n], main);
    }
    if (complete && main) {
        complete = put_curve_errors(report, curves, main);
    } else {
        static const char *const ERRORS[] = {"statistical_error", "discretisation_error",
                                             "model_error", "total_error", "theory_deviation"};
        for (size_t n = 0; n < sizeof ERRORS / sizeof *ERRORS; n++) {
            complete = complete && field_put(report, ERRORS[n], cJSON_CreateNull());
        }
    }
    return complete &&
           put_number(report, "seconds_to_halve_error", main ? 3.0 * seconds : (double)NAN);
}

static bool put_document(cJSON *report, const struct case_cost *cost, const cJSON *document) {
    const cJSON *curves = field_at(document, "curves");
    return put_errors(report, main_curve(curves), cost->seconds, curves) &&
           put_copy(report, "notes", document) &&
           field_put(report, "curves", curve_reports(curves, cost->seconds)) &&
           field_put(report, "scalars", scalar_reports(field_at(document, "scalars")));
}

int aggregate_report_case(struct store *store, const struct aggregate *aggregate,
                          uint64_t case_number, cJSON **out, struct error *err) {
    struct case_info info = {0};
    struct case_cost cost;
    cJSON *document = NULL;
    int status = store_cost(store, aggregate->about.id, case_number, &cost, err);
    if (!status) {
        status = aggregate_open(store, aggregate, case_number, &info, &document, err);
    }
    if (status) {
        return status;
    }
    cJSON *report = cJSON_CreateObject();
    bool complete = report && put_cost(report, &cost) &&
                    field_put(report, "parameters", flat_parameters(info.parameters)) &&
                    put_document(report, &cost, document);
    cJSON_Delete(document);
    case_info_clear(&info);
    *out = fields_finish(report, complete);
    return *out ? 0 : error_set(err, ERROR_MEMORY, "no memory left for a report");
}

int aggregate_report(struct store *store, const char *study, cJSON **out, struct error *err) {
    struct aggregate aggregate;
    int status = aggregate_begin(store, study, &aggregate, err);
    if (status) {
        return status;
    }
    cJSON *cases = NULL, *document = aggregate_head(&aggregate, true, &cases);
    status = document ? 0 : error_set(err, ERROR_MEMORY, "no memory left for a report");
    for (uint64_t c = 0; c < aggregate.about.cases && !status; c++) {
        cJSON *report = NULL;
        status = aggregate_report_case(store, &aggregate, c, &report, err);
        if (!status && !cJSON_AddItemToArray(cases, report)) {
            cJSON_Delete(report);
            status = error_set(err, ERROR_MEMORY, "no memory left for a report");
        }
    }
    aggregate_end(&aggregate);
    if (status) {
        cJSON_Delete(document);
        return status;
    }
    *out = document;
    return 0;
}
