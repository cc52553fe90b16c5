#include "schema/result/report.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

void case_report_clear(struct case_report *report) {
    result_clear(&report->about);
    *report = (struct case_report){0};
}

void study_report_clear(struct study_report *report) {
    for (size_t c = 0; c < report->case_count; c++)
        case_report_clear(&report->cases[c]);
    free(report->cases);
    free(report->id);
    free(report->name);
    free(report->kind);
    free(report->state);
    free(report->random);
    cJSON_Delete(report->swept);
    cJSON_Delete(report->provenance);
    *report = (struct study_report){0};
}

void study_report_take_head(struct study_report *report, const struct study_result *head) {
    report->id = head->id;
    report->name = head->name;
    report->kind = head->kind;
    report->state = head->state;
    report->random = head->random;
    report->swept = head->swept;
    report->provenance = head->provenance;
}

/* --- sizes --- */

/* Returns |above - minus|/|below| over the points where all are known; minus NULL: 0. NaN where
 * nothing is known. */
static double relative_size(size_t n, const double *above, const double *minus,
                            const double *below) {
    double squares = 0, reference = 0;
    for (size_t a = 0; a < n; a++) {
        double difference = above[a] - (minus != NULL ? minus[a] : 0);
        if (isnan(difference) || isnan(below[a]))
            continue;
        squares += difference * difference;
        reference += below[a] * below[a];
    }
    return reference > 0 ? sqrt(squares / reference) : (double)NAN;
}

static double statistical_error(const struct curve *curve) {
    return relative_size(curve_value_count(curve), curve->standard_error, NULL, curve->y);
}

/* --- which curve belongs to which --- */

/* Returns the curve of the same series and model that has errors of a source at its points, which
 * only that of the finest level has; NULL without one. */
static const struct curve *finest_with(const struct case_result *result, const struct curve *curve,
                                       enum error_source source) {
    for (size_t a = 0; a < result->curve_count; a++) {
        const struct curve *other = &result->curves[a];
        if (other->errors[source].value != NULL && curve_same_series(other, curve) &&
            same_text(other->model, curve->model))
            return other;
    }
    return NULL;
}

/* --- errors by source --- */

/* Computes the distance of every level from the limit, plus the bound of the limit. The limit is
 * the finest level less its own error. */
static void discretisation_sizes(const struct curve *finest, const struct curve *curve,
                                 double *limit, double *size) {
    const struct curve_error *error = &finest->errors[ERROR_DISCRETISATION];
    for (size_t a = 0; a < curve_value_count(curve); a++) {
        limit[a] = finest->y[a] - error->value[a];
        size[a] = fabs(curve->y[a] - limit[a]) + (error->bound != NULL ? error->bound[a] : 0);
    }
}

/* Returns the relative size of the error of a source; NaN where it is unknown at a point that has a
 * value. scratch has room for twice the longest curve. */
static double source_error(const struct case_result *result, const struct curve *curve,
                           enum error_source source, double *scratch) {
    const struct curve *finest = finest_with(result, curve, source);
    size_t n = curve_value_count(curve);
    double *below = scratch, *size = scratch + n;
    if (finest == NULL || finest->n != curve->n || (curve->columns > 0 && finest != curve))
        return NAN;
    for (size_t a = 0; a < n; a++)
        if (isnan(finest->errors[source].value[a]) && !isnan(finest->y[a]))
            return NAN;
    if (source == ERROR_DISCRETISATION) {
        discretisation_sizes(finest, curve, below, size);
        return relative_size(n, size, NULL, below);
    }
    const struct curve_error *error = &finest->errors[source];
    for (size_t a = 0; a < n; a++)
        size[a] = fabs(error->value[a]) + (error->bound != NULL ? error->bound[a] : 0);
    return relative_size(n, size, NULL, finest->y);
}

/* --- cost --- */

/* Cost of fast transforms: points times transforms of all loads, times log2 of the points. */
static double cost_of(const struct curve *work) {
    double sum = 0;
    for (size_t a = 0; a < work->n; a++)
        sum += isnan(work->y[a]) ? 0 : work->y[a];
    return isnan(work->points) ? sum : sum * log2(fmax(work->points, 2));
}

/* Returns the share of the case's time that its solves for a curve took, by the curves "work" of
 * all models and levels. All estimators use the same solves. 1 where the case has no such
 * curves. */
static double share_of(const struct case_result *result, const struct curve *curve) {
    double own = 0, all = 0;
    for (size_t a = 0; a < result->curve_count; a++) {
        const struct curve *work = &result->curves[a];
        if (strcmp(work->quantity, "work") != 0)
            continue;
        double cost = cost_of(work);
        own += same_text(work->model, curve->model) && same_number(work->level, curve->level) ? cost
                                                                                              : 0;
        all += cost;
    }
    return all > 0 ? own / all : 1;
}

/* --- together --- */

double curve_report_total(const struct curve_report *report) {
    double systematic = 0;
    for (size_t s = 0; s < ERROR_SOURCES; s++)
        systematic += report->applies[s] ? report->errors[s] : 0;
    return hypot(report->statistical, systematic);
}

static double most_valueless(const struct curve *curve) {
    double most = 0;
    for (size_t a = 0; curve_is_partial(curve) && a < curve->n; a++)
        most = fmax(most, curve->valueless[a]);
    return curve_is_partial(curve) ? most : (double)NAN;
}

/* Copies the quantity and the attributes of a curve. */
static int copy_attributes(struct case_result *about, const struct curve *curve,
                           struct curve *out) {
    *out = (struct curve){.quantity = result_text(about, curve->quantity)};
    bool done = out->quantity != NULL;
    for (size_t a = 0; a < CURVE_ATTRIBUTE_COUNT && done; a++) {
        const struct curve_attribute *row = &CURVE_ATTRIBUTES[a];
        const char *text = curve_attribute_text(curve, row), *copy = result_text(about, text);
        curve_set_attribute(out, row, copy, curve_attribute_number(curve, row));
        done = text == NULL || copy != NULL;
    }
    return done ? 0 : ERROR_MEMORY;
}

static int curve_report_make(struct case_report *report, const struct case_result *result,
                             const struct curve *curve, double *scratch, struct curve_report *out) {
    int status = copy_attributes(&report->about, curve, &out->place);
    out->seconds = out->cpu_seconds = share_of(result, curve);
    out->statistical = statistical_error(curve);
    for (size_t s = 0; s < ERROR_SOURCES; s++) {
        out->errors[s] = source_error(result, curve, (enum error_source)s, scratch);
        out->applies[s] = curve->errors[s].applies || !isnan(out->errors[s]);
    }
    out->total = curve_report_total(out);
    out->law = curve->law_difference != NULL
                   ? relative_size(curve_value_count(curve), curve->law_difference, NULL, curve->y)
                   : (double)NAN;
    out->valueless = most_valueless(curve);
    for (size_t t = 0; t < curve->theory_count && status == 0; t++) {
        const struct theory *theory = &curve->theories[t];
        if (theory->y == NULL || curve->columns > 0)
            continue;
        size_t n = out->theory_count++;
        out->theories[n].name = result_text(&report->about, theory->name);
        out->theories[n].deviation = relative_size(curve->n, curve->y, theory->y, theory->y);
        status = out->theories[n].name != NULL ? 0 : ERROR_MEMORY;
    }
    return status;
}

static const struct curve_report *main_curve(const struct case_report *report) {
    const struct curve_report *found = NULL;
    for (size_t a = 0; a < report->curve_count; a++) {
        const struct curve_report *one = &report->curves[a];
        bool random = one->statistical > 0; /* false for NaN, and for what is known exactly */
        if (random && one->theory_count > 0)
            return one;
        if (random && found == NULL)
            found = one;
    }
    return found;
}

static int copy_about(struct case_result *out, const struct case_result *result) {
    out->case_number = result->case_number;
    out->realisations = result->realisations;
    out->parameters = result_room(out, result->parameter_count + 1, sizeof *out->parameters);
    out->notes = result_room(out, result->note_count + 1, sizeof *out->notes);
    bool done = out->parameters != NULL && out->notes != NULL;
    for (size_t p = 0; p < result->parameter_count && done; p++) {
        const struct result_parameter *from = &result->parameters[p];
        struct result_parameter *to = &out->parameters[out->parameter_count++];
        *to =
            (struct result_parameter){result_text(out, from->pointer), result_text(out, from->text),
                                      from->number, from->list, from->flag};
        done = to->pointer != NULL && (from->text == NULL || to->text != NULL);
    }
    for (size_t n = 0; n < result->note_count && done; n++) {
        struct result_note *to = &out->notes[out->note_count++];
        *to = (struct result_note){result->notes[n].realisation,
                                   result_text(out, result->notes[n].text)};
        done = to->text != NULL;
    }
    out->notes_all = result->notes_all;
    out->error = result_text(out, result->error);
    done = done && (result->error == NULL || out->error != NULL);
    return done ? 0 : ERROR_MEMORY;
}

static int make_scalars(struct case_report *report, const struct case_result *result) {
    report->scalars =
        result_room(&report->about, result->scalar_count + 1, sizeof *report->scalars);
    if (report->scalars == NULL)
        return ERROR_MEMORY;
    for (size_t s = 0; s < result->scalar_count; s++) {
        const struct scalar *from = &result->scalars[s];
        struct scalar_report *to = &report->scalars[report->scalar_count++];
        to->name = result_text(&report->about, from->name);
        to->value = from->value;
        to->statistical = from->standard_error / fabs(from->value);
        to->has_theory = !isnan(from->theory);
        to->deviation = fabs(from->value - from->theory) / fabs(from->theory);
        to->has_grid = !isnan(from->grid);
        to->grid_deviation = fabs(from->value - from->grid) / fabs(from->grid);
        if (to->name == NULL)
            return ERROR_MEMORY;
    }
    return 0;
}

static int make_curves(struct case_report *report, const struct case_result *result) {
    size_t longest = 1;
    for (size_t a = 0; a < result->curve_count; a++)
        longest = curve_value_count(&result->curves[a]) > longest
                      ? curve_value_count(&result->curves[a])
                      : longest;
    double *scratch = array_create(longest, 2 * sizeof *scratch);
    report->curves = result_room(&report->about, result->curve_count + 1, sizeof *report->curves);
    int status = scratch != NULL && report->curves != NULL ? 0 : ERROR_MEMORY;
    for (size_t a = 0; a < result->curve_count && status == 0; a++)
        status = curve_report_make(report, result, &result->curves[a], scratch,
                                   &report->curves[report->curve_count++]);
    free(scratch);
    return status;
}

int case_report_make(struct case_report *out, const struct case_result *result, struct error *err) {
    struct case_report report = {.time = {.seconds = 1, .cpu_seconds = 1}};
    int status = copy_about(&report.about, result);
    if (status == 0)
        status = make_curves(&report, result);
    if (status == 0)
        status = make_scalars(&report, result);
    if (status != 0) {
        case_report_clear(&report);
        return error_set(err, ERROR_MEMORY, "no memory left for a report");
    }
    report.main = main_curve(&report);
    *out = report;
    return 0;
}

void case_report_spend(struct case_report *report, const struct work_time *time) {
    report->time = *time;
    for (size_t a = 0; a < report->curve_count; a++) {
        report->curves[a].seconds *= time->seconds;
        report->curves[a].cpu_seconds *= time->cpu_seconds;
    }
}

double case_report_seconds_to_halve(const struct case_report *report) {
    return report->main != NULL ? 3 * report->time.cpu_seconds : (double)NAN;
}
