#include "schema/json/field.h"
#include "schema/result/report.h"
#include "schema/result/result_json.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* --- printing --- */

static void put_number(FILE *file, const char *key, double number) {
    fprintf(file, ",\"%s\":", key);
    json_print_number(file, number);
}

static bool put_text(FILE *file, const char *key, const char *text) {
    fprintf(file, ",\"%s\":", key);
    return json_print_text(file, text);
}

static bool put_errors(FILE *file, const struct curve_report *report) {
    bool done = true;
    if (!isnan(report->valueless))
        put_number(file, "valueless", report->valueless);
    put_number(file, "statistical_error", report->statistical);
    for (size_t s = 0; s < ERROR_SOURCES; s++)
        if (report->applies[s])
            put_number(file, ERROR_SOURCE_ROWS[s].key, report->errors[s]);
    put_number(file, "total_error", report->total);
    if (!isnan(report->law))
        put_number(file, "law_difference", report->law);
    fputs(",\"theory_deviation\":{", file);
    for (size_t t = 0; t < report->theory_count && done; t++) {
        fputs(t > 0 ? "," : "", file);
        done = json_print_text(file, report->theories[t].name);
        fputc(':', file);
        json_print_number(file, report->theories[t].deviation);
    }
    fputc('}', file);
    return done;
}

/* Prints the errors of the main curve; without one, nothing is known. */
static bool put_main(FILE *file, const struct case_report *report) {
    if (report->main != NULL)
        return put_text(file, "main_curve", report->main->place.quantity) &&
               curve_print_attributes(file, &report->main->place, false) &&
               put_errors(file, report->main);
    fputs(",\"main_curve\":null,\"statistical_error\":null,\"total_error\":null,"
          "\"theory_deviation\":null",
          file);
    return true;
}

static bool print_curve(FILE *file, const struct curve_report *report) {
    fputs("{\"quantity\":", file);
    bool done = json_print_text(file, report->place.quantity) &&
                curve_print_attributes(file, &report->place, false);
    put_number(file, "seconds", report->seconds);
    put_number(file, "cpu_seconds", report->cpu_seconds);
    done = done && put_errors(file, report);
    fputc('}', file);
    return done;
}

static bool print_scalar(FILE *file, const struct scalar_report *report) {
    bool done = json_print_text(file, report->name);
    fputs(":{\"value\":", file);
    json_print_number(file, report->value);
    put_number(file, "statistical_error", report->statistical);
    if (report->has_theory)
        put_number(file, "theory_deviation", report->deviation);
    if (report->has_grid)
        put_number(file, "grid_deviation", report->grid_deviation);
    fputc('}', file);
    return done;
}

static void put_cost(FILE *file, const struct case_report *report) {
    double done = (double)report->about.realisations;
    put_number(file, "realisations", done);
    put_number(file, "realisations_total", (double)report->realisations_total);
    put_number(file, "jobs", (double)report->jobs);
    put_number(file, "attempts", (double)report->attempts);
    fputc(',', file);
    work_time_print(file, &report->time);
    put_number(file, "seconds_per_realisation",
               done > 0 ? report->time.seconds / done : (double)NAN);
    put_number(file, "cpu_seconds_per_realisation",
               done > 0 ? report->time.cpu_seconds / done : (double)NAN);
}

bool case_report_print(FILE *file, const struct case_report *report) {
    const struct case_result *about = &report->about;
    fprintf(file, "{\"case\":%llu", (unsigned long long)about->case_number);
    put_cost(file, report);
    fputs(",\"parameters\":", file);
    bool done = result_print_parameters(file, about->parameter_count, about->parameters) &&
                put_main(file, report);
    put_number(file, "seconds_to_halve_error", case_report_seconds_to_halve(report));
    if (about->notes_all > 0) {
        fputs(",\"notes\":", file);
        done = done && result_print_notes(file, about->notes_all, about->note_count, about->notes);
    }
    done = done && result_print_error(file, about);
    fputs(",\"curves\":[", file);
    for (size_t a = 0; a < report->curve_count && done; a++) {
        fputs(a > 0 ? "," : "", file);
        done = print_curve(file, &report->curves[a]);
    }
    fputs("],\"scalars\":{", file);
    for (size_t s = 0; s < report->scalar_count && done; s++) {
        fputs(s > 0 ? "," : "", file);
        done = print_scalar(file, &report->scalars[s]);
    }
    fputs("}}", file);
    return done;
}

bool study_report_print(FILE *file, const struct study_report *report) {
    const struct study_result head = {.id = report->id,
                                      .name = report->name,
                                      .kind = report->kind,
                                      .state = report->state,
                                      .random = report->random,
                                      .swept = report->swept,
                                      .provenance = report->provenance};
    bool done = study_print_head(file, &head, &report->time);
    for (size_t c = 0; c < report->case_count && done; c++) {
        fputs(c > 0 ? "," : "", file);
        done = case_report_print(file, &report->cases[c]);
    }
    fputs("]}", file);
    return done;
}

/* --- reading --- */

static uint64_t count_at(const cJSON *object, const char *key) {
    double number = field_number(object, key);
    return number >= 0 && number <= 0x1p53 ? (uint64_t)number : 0;
}

static int no_memory(struct error *err) {
    return error_set(err, ERROR_MEMORY, "no memory left to read a report");
}

static int read_curve(struct case_result *about, const cJSON *object, struct curve_report *out,
                      struct error *err) {
    const char *quantity = cJSON_GetStringValue(field_at(object, "quantity"));
    if (quantity == NULL)
        return error_set(err, ERROR_INPUT, "\"quantity\" of a report must be a string");
    out->place.quantity = result_text(about, quantity);
    if (out->place.quantity == NULL)
        return no_memory(err);
    int status = curve_read_attributes(about, object, &out->place, err);
    struct work_time time;
    work_time_read(object, 0, &time);
    out->seconds = time.seconds;
    out->cpu_seconds = time.cpu_seconds;
    out->statistical = field_number(object, "statistical_error");
    for (size_t s = 0; s < ERROR_SOURCES; s++) {
        out->applies[s] = field_at(object, ERROR_SOURCE_ROWS[s].key) != NULL;
        out->errors[s] = field_number(object, ERROR_SOURCE_ROWS[s].key);
    }
    out->total =
        curve_report_total(out); /* that of an older program may have counted other sources */
    out->law = field_number(object, "law_difference");
    out->valueless = field_number(object, "valueless");
    const cJSON *deviations = field_at(object, "theory_deviation");
    for (const cJSON *item = deviations != NULL ? deviations->child : NULL;
         item != NULL && status == 0 && out->theory_count < THEORIES_MOST; item = item->next) {
        size_t t = out->theory_count++;
        out->theories[t].name = result_text(about, item->string);
        out->theories[t].deviation = cJSON_IsNumber(item) ? item->valuedouble : (double)NAN;
        status = out->theories[t].name != NULL ? 0 : no_memory(err);
    }
    return status;
}

static int read_scalar(struct case_result *about, const cJSON *object, struct scalar_report *out,
                       struct error *err) {
    *out = (struct scalar_report){.name = result_text(about, object->string),
                                  .value = field_number(object, "value"),
                                  .statistical = field_number(object, "statistical_error"),
                                  .deviation = field_number(object, "theory_deviation"),
                                  .grid_deviation = field_number(object, "grid_deviation"),
                                  .has_grid = field_at(object, "grid_deviation") != NULL,
                                  .has_theory = field_at(object, "theory_deviation") != NULL};
    return out->name != NULL ? 0 : no_memory(err);
}

/* Returns the main curve by its quantity and attributes. An attribute that the document leaves out
 * is absent. */
static const struct curve_report *find_main(const struct case_report *report,
                                            const cJSON *document) {
    const char *quantity = cJSON_GetStringValue(field_at(document, "main_curve"));
    for (size_t a = 0; a < report->curve_count && quantity != NULL; a++) {
        const struct curve *place = &report->curves[a].place;
        bool same = strcmp(place->quantity, quantity) == 0;
        for (size_t n = 0; n < CURVE_ATTRIBUTE_COUNT && same; n++) {
            const struct curve_attribute *row = &CURVE_ATTRIBUTES[n];
            const char *text = curve_attribute_text(place, row);
            const char *asked = cJSON_GetStringValue(field_at(document, row->key));
            double number = curve_attribute_number(place, row);
            double wanted = field_number(document, row->key);
            same = text != NULL && asked != NULL
                       ? strcmp(text, asked) == 0
                       : text == asked && (number == wanted || (isnan(number) && isnan(wanted)));
        }
        if (same)
            return &report->curves[a];
    }
    return NULL;
}

static int read_lists(const cJSON *document, struct case_report *report, struct error *err) {
    const cJSON *curves = field_at(document, "curves"), *scalars = field_at(document, "scalars");
    struct case_result *about = &report->about;
    report->curves =
        result_room(about, (size_t)cJSON_GetArraySize(curves) + 1, sizeof *report->curves);
    report->scalars =
        result_room(about, (size_t)cJSON_GetArraySize(scalars) + 1, sizeof *report->scalars);
    int status = report->curves != NULL && report->scalars != NULL ? 0 : no_memory(err);
    for (const cJSON *item = curves != NULL ? curves->child : NULL; item != NULL && status == 0;
         item = item->next)
        status = read_curve(about, item, &report->curves[report->curve_count++], err);
    for (const cJSON *item = scalars != NULL ? scalars->child : NULL; item != NULL && status == 0;
         item = item->next)
        status = read_scalar(about, item, &report->scalars[report->scalar_count++], err);
    return status;
}

int case_report_read(const cJSON *document, struct case_report *out, struct error *err) {
    struct case_report report = {.realisations_total = count_at(document, "realisations_total"),
                                 .jobs = count_at(document, "jobs"),
                                 .attempts = count_at(document, "attempts")};
    work_time_read(document, report.jobs, &report.time);
    report.about.case_number = count_at(document, "case");
    report.about.realisations = count_at(document, "realisations");
    int status = result_read_parameters(&report.about, field_at(document, "parameters"), err);
    if (status == 0)
        status = result_read_notes(&report.about, field_at(document, "notes"), err);
    if (status == 0)
        status = result_read_error(&report.about, field_at(document, "error"), err);
    if (status == 0)
        status = read_lists(document, &report, err);
    if (status != 0) {
        case_report_clear(&report);
        return status;
    }
    report.main = find_main(&report, document);
    *out = report;
    return 0;
}

int study_report_read(const cJSON *document, struct study_report *out, struct error *err) {
    struct study_result head = {0};
    struct study_report report = {0};
    const cJSON *cases = field_at(document, "cases");
    work_time_read(document, 0, &report.time);
    int status = study_head_read(document, &head, err);
    report.cases = array_create((size_t)cJSON_GetArraySize(cases), sizeof *report.cases);
    if (status == 0 && report.cases == NULL)
        status = no_memory(err);
    for (const cJSON *item = cases != NULL ? cases->child : NULL; item != NULL && status == 0;
         item = item->next) {
        status = case_report_read(item, &report.cases[report.case_count], err);
        report.case_count += status == 0;
    }
    study_report_take_head(&report, &head);
    if (status != 0) {
        study_report_clear(&report);
        return status;
    }
    *out = report;
    return 0;
}
