/* Speed against error: what each case cost, and the errors that this bought.
 *
 * The errors of a curve are sizes over all its points: the statistical one is |standard error|/|y|,
 * the deviation from a theory |y - theory|/|theory|, |.| being the root of the sum of squares over
 * the points where both are known. A case's statistical error is that of its main curve, the first
 * one that has an error and a theory beside it, or else the first one with an error at all.
 * Statistical errors fall with the square root of the realisations, so that half the error costs
 * three times what was spent. */
#include "worker/aggregate.h"
#include "worker/flat.h"
#include "worker/wire_field.h"

#include <math.h>
#include <stdlib.h>

/* Sums of squares of a quotient: over the points where both numbers are known. */
struct quotient {
    double above, below;
};

/* Arrays of equal length, or matrices row by row. minus (NULL: 0) is taken from above. */
static void quotient_add(struct quotient *sums, const cJSON *above, const cJSON *minus,
                         const cJSON *below) {
    const cJSON *a = above ? above->child : NULL, *b = below ? below->child : NULL;
    const cJSON *m = minus ? minus->child : NULL;
    for (; a && b && (m || !minus); a = a->next, b = b->next, m = m ? m->next : NULL) {
        if (cJSON_IsArray(a) && cJSON_IsArray(b)) {
            quotient_add(sums, a, m, b);
        } else if (cJSON_IsNumber(a) && cJSON_IsNumber(b) && (!minus || cJSON_IsNumber(m))) {
            double difference = a->valuedouble - (minus ? m->valuedouble : 0);
            sums->above += difference * difference;
            sums->below += b->valuedouble * b->valuedouble;
        }
    }
}

/* NaN where nothing is known. */
static double quotient_value(const struct quotient *sums) {
    return sums->below > 0 ? sqrt(sums->above / sums->below) : (double)NAN;
}

static double curve_error(const cJSON *curve) {
    struct quotient sums = {0};
    quotient_add(&sums, field_at(curve, "standard_error"), NULL, field_at(curve, "y"));
    return quotient_value(&sums);
}

static double curve_discretisation(const cJSON *curve) {
    struct quotient sums = {0};
    quotient_add(&sums, field_at(curve, "discretisation_error"), NULL, field_at(curve, "y"));
    return quotient_value(&sums);
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
        struct quotient sums = {0};
        quotient_add(&sums, field_at(curve, "y"), theory, theory);
        complete = complete && put_number(deviations, theory->string, quotient_value(&sums));
    }
    return fields_finish(deviations, complete);
}

static cJSON *curve_report(const cJSON *curve) {
    cJSON *report = cJSON_CreateObject();
    return fields_finish(
        report, report && put_copy(report, "quantity", curve) &&
                    put_copy(report, "series", curve) && put_copy(report, "model", curve) &&
                    put_copy(report, "level", curve) &&
                    put_number(report, "statistical_error", curve_error(curve)) &&
                    put_number(report, "discretisation_error", curve_discretisation(curve)) &&
                    field_put(report, "theory_deviation", curve_deviations(curve)));
}

static cJSON *curve_reports(const cJSON *curves) {
    cJSON *reports = cJSON_CreateArray();
    bool complete = reports != NULL;
    const cJSON *curve;
    cJSON_ArrayForEach(curve, curves) {
        cJSON *report = complete ? curve_report(curve) : NULL;
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

static bool put_errors(cJSON *report, const struct case_cost *cost, const cJSON *document) {
    const cJSON *curves = field_at(document, "curves"), *main = main_curve(curves);
    const cJSON *quantity = field_at(main, "quantity");
    double halving = main ? 3.0 * cost->seconds : (double)NAN;
    return field_put(report, "main_curve",
                     quantity ? cJSON_Duplicate(quantity, true) : cJSON_CreateNull()) &&
           put_number(report, "statistical_error", main ? curve_error(main) : (double)NAN) &&
           put_number(report, "discretisation_error",
                      main ? curve_discretisation(main) : (double)NAN) &&
           field_put(report, "model_error", cJSON_CreateNull()) &&
           field_put(report, "theory_deviation",
                     main ? curve_deviations(main) : cJSON_CreateNull()) &&
           put_number(report, "seconds_to_halve_error", halving) &&
           field_put(report, "curves", curve_reports(curves)) &&
           field_put(report, "scalars", scalar_reports(field_at(document, "scalars")));
}

static int case_report(struct store *store, const char *study, const struct case_cost *cost,
                       cJSON *cases, struct error *err) {
    struct case_info info = {0};
    cJSON *document = NULL;
    int status = store_case(store, study, cost->case_number, &info, err);
    if (status) {
        return status;
    }
    status = aggregate_case(store, study, cost->case_number, &document, err);
    if (!status) {
        cJSON *report = cJSON_CreateObject();
        bool complete = report && put_cost(report, cost) &&
                        field_put(report, "parameters", flat_parameters(info.parameters)) &&
                        put_errors(report, cost, document) && cJSON_AddItemToArray(cases, report);
        if (!complete) {
            cJSON_Delete(report);
            status = error_set(err, ERROR_MEMORY, "no memory left for a report");
        }
    }
    cJSON_Delete(document);
    case_info_clear(&info);
    return status;
}

static cJSON *report_begin(const struct study_status *about, cJSON **cases) {
    cJSON *document = cJSON_CreateObject();
    bool complete = document && field_put_text(document, "study", about->id) &&
                    field_put_text(document, "name", about->name) &&
                    field_put_text(document, "kind", about->kind) &&
                    field_put_text(document, "state", about->state) &&
                    put_number(document, "seconds", about->seconds);
    *cases = complete ? cJSON_AddArrayToObject(document, "cases") : NULL;
    return fields_finish(document, *cases != NULL);
}

int aggregate_report(struct store *store, const char *study, cJSON **out, struct error *err) {
    struct study_status about = {0};
    int status = store_status(store, study, &about, err);
    if (status) {
        return status;
    }
    struct case_cost *costs = NULL;
    size_t count = 0;
    cJSON *cases = NULL, *document = report_begin(&about, &cases);
    study_status_clear(&about);
    status = document ? store_costs(store, study, &costs, &count, err)
                      : error_set(err, ERROR_MEMORY, "no memory left for a report");
    for (size_t n = 0; n < count && !status; n++) {
        status = case_report(store, study, &costs[n], cases, err);
    }
    free(costs);
    if (status) {
        cJSON_Delete(document);
        return status;
    }
    *out = document;
    return 0;
}
