#include "server/show/summary/summary.h"
#include "core/file/plain_text.h"
#include "schema/result/result.h"
#include "schema/result/view.h"
#include "server/show/summary/summary_cells.h"
#include "server/show/summary/summary_target.h"
#include "server/show/summary/summary_units.h"
#include "server/show/view.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

/* A measured surface among random ones like it, in plain text. */

/* Where a measured surface lies among random surfaces like it: a table a case. */

static const char PERCENTILE[] = "percentile_";

static const struct scalar *other(const struct case_result *one, const char *before,
                                  const char *quantity) {
    char name[120];
    snprintf(name, sizeof name, "%s_%s", before, quantity);
    return result_scalar(one, name);
}

static const char *quantity_of(const struct scalar *scalar) {
    bool is = strncmp(scalar->name, PERCENTILE, sizeof PERCENTILE - 1) == 0;
    return is ? scalar->name + sizeof PERCENTILE - 1 : NULL;
}

static void percentile_cell(struct text_table *table, const struct scalar *scalar) {
    if (isnan(scalar->value))
        table_cell(table, "-");
    else
        table_cell(table, "%.1f", scalar->value);
}

static void put_row(struct text_table *table, const struct case_result *one,
                    const struct scalar *scalar) {
    const char *quantity = quantity_of(scalar);
    const struct scalar *measured = other(one, "measured", quantity);
    const struct scalar *mean = other(one, "piece", quantity);
    double n = (double)one->realisations;
    table_cell(table, "%s", quantity);
    table_number(table, measured != NULL ? measured->value : (double)NAN);
    measured_cell(table, mean != NULL ? mean->value : (double)NAN,
                  mean != NULL ? mean->standard_error : (double)NAN);
    table_number(table, mean != NULL ? mean->standard_error * sqrt(n) : (double)NAN);
    percentile_cell(table, scalar);
}

static void print_name(const struct case_result *one, FILE *file) {
    const struct result_parameter *name = result_parameter(one, "/surface/like/file");
    fprintf(file, "\ncase %llu: the measured surface ", (unsigned long long)one->case_number);
    text_print_plain(file, name != NULL && name->text != NULL ? name->text : "?");
}

/* Contact reports percentiles by curves. */
static bool is_expected(const struct case_result *one) {
    return result_parameter(one, "/surface/like/file") != NULL &&
           result_parameter(one, "/contact/model") == NULL;
}

static void print_head(const struct case_result *one, FILE *file) {
    const struct result_parameter *unit = result_parameter(one, "/surface/like/unit");
    const struct result_parameter *length = result_parameter(one, "/surface/like/wavelength");
    print_name(one, file);
    fputs(" among sub-maps of random surfaces like it, lengths in lambda_s", file);
    if (length != NULL && unit != NULL && unit->text != NULL && *unit->text != '\0') {
        fprintf(file, " = %.4g ", length->number);
        text_print_plain(file, unit->text);
    }
    fputc('\n', file);
}

/* Says whether the measured surface may be one of them, and what differs most. */
static void print_verdict(const struct case_result *one, FILE *file) {
    static const double LEVEL = 0.05;
    static const char DIFFERENCE[] = "difference_";
    const struct scalar *p_value = result_scalar(one, "like_p_value"), *most = NULL;
    for (size_t s = 0; s < one->scalar_count; s++) {
        const struct scalar *scalar = &one->scalars[s];
        if (strncmp(scalar->name, DIFFERENCE, sizeof DIFFERENCE - 1) == 0 &&
            !isnan(scalar->value) && (most == NULL || fabs(scalar->value) > fabs(most->value)))
            most = scalar;
    }
    if (p_value == NULL || isnan(p_value->value) || most == NULL)
        return;
    const char *least = p_value->value * ((double)one->realisations + 1) < 1.5 ? ", the least" : "";
    fprintf(file, "%s: %s differs most, by %.1f deviations (p-value %.2g%s%s)\n",
            p_value->value < LEVEL ? "not one of them" : "may be one of them",
            most->name + sizeof DIFFERENCE - 1, fabs(most->value), p_value->value, least,
            *least != '\0' ? " of so many surfaces" : "");
}

/* Prints what was measured of each quantity, the mean and deviation over the sub-maps of the
 * surfaces, and the percentile; nothing of a case that is like no measured surface. */
static void summary_of_like(const struct case_result *one, FILE *file) {
    struct text_table table = {.columns = 5};
    static const char *const HEADINGS[] = {"quantity", "measured", "mean", "deviation",
                                           "percentile"};
    size_t rows = 0;
    for (size_t h = 0; h < sizeof HEADINGS / sizeof *HEADINGS; h++)
        table_cell(&table, "%s", HEADINGS[h]);
    for (size_t s = 0; s < one->scalar_count; s++)
        if (quantity_of(&one->scalars[s]) != NULL) {
            put_row(&table, one, &one->scalars[s]);
            rows++;
        }
    if (rows > 0) {
        print_head(one, file);
        table_print(&table, file);
        print_verdict(one, file);
    } else if (is_expected(one)) {
        print_name(one, file);
        fputs(
            " is not ranked among random ones: sub-maps of its size need a cell of at least twice "
            "its sides, and a whole number of the grid's points between two of its own\n",
            file);
    }
    table_clear(&table);
}

/* What theory expects: a table a case for a few cases, a row each for many. */

enum { TABLES_MOST = 3 };

/* Of many cases these are shown. */
static const char *const HEADLINES[] = {"wavelength_ratio",
                                        "skewness",
                                        "kurtosis",
                                        "nayak_alpha",
                                        "nayak_alpha_continuous",
                                        "summit_density",
                                        "summit_height_mean",
                                        "summit_height_variance",
                                        "summit_height_skewness",
                                        "summit_height_kurtosis",
                                        "summit_curvature_mean"};
enum { HEADLINE_COUNT = sizeof HEADLINES / sizeof *HEADLINES };

static bool has_grid(const struct shown_cases *shown, const char *name) {
    for (size_t c = 0; c < shown->count; c++) {
        const struct scalar *scalar = result_scalar(shown->list[c], name);
        if (scalar != NULL && !isnan(scalar->grid))
            return true;
    }
    return false;
}

static void print_rows(const struct shown_cases *shown, FILE *file) {
    struct text_table table = {.columns = 1 + shown->varied_count + HEADLINE_COUNT};
    bool grid[HEADLINE_COUNT];
    for (size_t h = 0; h < HEADLINE_COUNT; h++)
        table.columns += grid[h] = has_grid(shown, HEADLINES[h]);
    table_cell(&table, "case");
    varied_headings(&table, shown);
    for (size_t h = 0; h < HEADLINE_COUNT; h++) {
        table_fold(&table);
        table_cell(&table, "%s", HEADLINES[h]);
        if (grid[h])
            table_cell(&table, "grid");
    }
    for (size_t c = 0; c < shown->count; c++) {
        table_number(&table, (double)shown->list[c]->case_number);
        varied_cells(&table, shown, c);
        for (size_t h = 0; h < HEADLINE_COUNT; h++) {
            const struct scalar *scalar = result_scalar(shown->list[c], HEADLINES[h]);
            table_number(&table, scalar != NULL ? scalar->value : (double)NAN);
            if (grid[h])
                table_number(&table, scalar != NULL ? scalar->grid : (double)NAN);
        }
    }
    table_print(&table, file);
    table_clear(&table);
}

static void print_case(const struct shown_cases *shown, size_t c, FILE *file) {
    const struct case_result *one = shown->list[c];
    struct text_table table = {.columns = 4};
    if (shown->count > 1) {
        fprintf(file, "%scase %llu: ", c > 0 ? "\n" : "", (unsigned long long)one->case_number);
        print_swept(shown, c, file);
        fputs("by theory\n", file);
    }
    table_cell(&table, "expected");
    table_cell(&table, "without a grid");
    table_cell(&table, "on the grid");
    table_cell(&table, "ratio");
    for (size_t s = 0; s < one->scalar_count; s++) {
        const struct scalar *scalar = &one->scalars[s];
        table_cell(&table, "%s", scalar->name);
        table_number(&table, scalar->value);
        table_number(&table, scalar->grid);
        table_number(&table, scalar->grid / scalar->value);
    }
    table_print(&table, file);
    table_clear(&table);
}

void summary_of_theory(const struct study_result *study, FILE *file) {
    struct shown_cases shown;
    if (study->case_count == 0)
        return;
    if (!shown_of_results(study, &shown)) {
        fputs("(no memory for a table)\n", file);
        return;
    }
    if (shown.count > TABLES_MOST)
        print_rows(&shown, file);
    for (size_t c = 0; c < shown.count && shown.count <= TABLES_MOST; c++)
        print_case(&shown, c, file);
    shown_clear(&shown);
}

/* One case less another: tables of both, and of what lies between them. */

enum { PLACES_SHOWN = 12, COLUMNS = 6 };

/* Errors of the sources but the statistical one, |value| + bound each, added up; NaN where one that
 * bears on the curve is not known. */
static double other_errors(const struct curve *curve, size_t k, bool unknown[ERROR_SOURCES]) {
    double sum = 0;
    for (size_t s = 0; s < ERROR_SOURCES; s++) {
        const struct curve_error *error = &curve->errors[s];
        if (!error->applies)
            continue;
        if (error->value == NULL || isnan(error->value[k])) {
            unknown[s] = true;
            continue;
        }
        sum += fabs(error->value[k]) + (error->bound != NULL ? error->bound[k] : 0);
    }
    return sum;
}

static void put_heading(struct text_table *table, const char *first,
                        const struct case_result *one) {
    table_cell(table, "%s", first);
    table_cell(table, "case %llu", (unsigned long long)one->case_number);
    table_cell(table, "case %llu", (unsigned long long)one->less);
    table_cell(table, "difference");
    table_cell(table, "other errors");
    table_cell(table, "total");
}

/* Adds the sum of the other errors, and half the width of the total interval. */
static void put_errors(struct text_table *table, double errors, double value,
                       const struct total *total) {
    double half = total_half_width(value, total);
    if (errors > 0)
        table_cell(table, "+-%.2g", errors);
    else
        table_cell(table, "-");
    if (isnan(half))
        table_cell(table, "-");
    else
        table_cell(table, "%s%.2g", total_is_partial(total) ? ">" : "+-", half);
}

static void print_label(const struct curve *curve, FILE *file) {
    char model[80];
    fprintf(file, "\n%s", curve->quantity);
    if (curve->series != NULL && *curve->series != '\0')
        fprintf(file, ", %s", curve->series);
    if (curve->model != NULL)
        fprintf(file, ", %s", model_text(curve->model, curve->kinematics, model, sizeof model));
    if (!isnan(curve->pressure))
        fprintf(file, ", at %.4g", curve->pressure);
    fprintf(file, " (%s)%s\n", curve->y_label, curve->paired ? "" : ", not by pairs");
}

static void print_curve(const struct case_result *one, const struct curve *curve,
                        bool unknown[ERROR_SOURCES], FILE *file) {
    struct text_table table = {.columns = COLUMNS};
    size_t step = (curve->n + PLACES_SHOWN - 1) / PLACES_SHOWN;
    print_label(curve, file);
    put_heading(&table, curve->x_label, one);
    for (size_t k = curve->n > 0 ? (curve->n - 1) % step : 0; k < curve->n; k += step) {
        table_number(&table, curve->x[k]);
        table_number(&table, curve->minuend[k]);
        table_number(&table, curve->subtrahend[k]);
        measured_cell(&table, curve->y[k], curve->standard_error[k]);
        const struct total total = curve_total(curve, k);
        put_errors(&table, other_errors(curve, k, unknown), curve->y[k], &total);
    }
    table_print(&table, file);
    table_clear(&table);
}

static void print_scalars(const struct case_result *one, FILE *file) {
    struct text_table table = {.columns = COLUMNS};
    put_heading(&table, "scalar", one);
    for (size_t s = 0; s < one->scalar_count; s++) {
        const struct scalar *scalar = &one->scalars[s];
        double errors = 0;
        if (isnan(scalar->value) || (scalar->value == 0 && scalar->standard_error == 0))
            continue;
        for (size_t e = 0; e < ERROR_SOURCES; e++)
            if (scalar->errors[e].applies && scalar->errors[e].known)
                errors += fabs(scalar->errors[e].value) + scalar->errors[e].bound;
        table_cell(&table, "%s%s", scalar->name, scalar->paired ? "" : " (not by pairs)");
        table_number(&table, scalar->minuend);
        table_number(&table, scalar->subtrahend);
        measured_cell(&table, scalar->value, scalar->standard_error);
        const struct total total = scalar_total(scalar);
        put_errors(&table, errors, scalar->value, &total);
    }
    fputc('\n', file);
    table_print(&table, file);
    table_clear(&table);
}

/* The table of the kind has its quantity alone where others are there too. */
static bool is_shown(const struct study_result *study, const struct curve *curve) {
    const struct case_result *one = &study->cases[0];
    const struct result_view *view = view_of(study->kind);
    if (is_bracket(curve->series))
        return false;
    bool many = strcmp(one->curves[0].quantity, one->curves[one->curve_count - 1].quantity) != 0;
    if (!many)
        return true;
    return view->table != NULL && strcmp(curve->quantity, view->table->quantity) == 0;
}

void summary_of_difference(const struct study_result *study, FILE *file) {
    bool unknown[UNKNOWN_SOURCES] = {false}, paired = true;
    if (study->case_count == 0)
        return;
    const struct case_result *one = &study->cases[0];
    text_print_plain(file, study->name);
    fprintf(file, " (%s), study %s: case %llu less case %llu, %llu realisations\n", study->state,
            study->id, (unsigned long long)one->case_number, (unsigned long long)one->less,
            (unsigned long long)one->realisations);
    for (size_t p = 0; p < one->parameter_count; p++)
        if (one->parameters[p].text != NULL && strstr(one->parameters[p].text, " less ") != NULL)
            fprintf(file, "%s: %s\n", one->parameters[p].pointer, one->parameters[p].text);
    for (size_t a = 0; a < one->curve_count; a++)
        if (is_shown(study, &one->curves[a])) {
            print_curve(one, &one->curves[a], unknown, file);
            paired = paired && one->curves[a].paired;
        }
    print_scalars(one, file);
    fprintf(file,
            "\n+-: one standard error%s; other errors: bounds of both cases, added up; total: the "
            "truth lies within so much, to 95 %% (>: but for errors that are not known)\n",
            paired ? ", of pairs of realisations" : "");
    const struct quantity_table *words = view_of(study->kind)->table;
    print_unknown(unknown, words != NULL ? words->error_words : NULL, file);
    if (one->remark != NULL)
        fprintf(file, "%s\n", one->remark);
}

/* --- scalars --- */

/* What stands beside a scalar. */
enum comparison { ALONE, WITH_THEORY, WITH_GRID };

static double expected(const struct scalar *scalar, enum comparison with) {
    return scalar == NULL ? (double)NAN : with == WITH_GRID ? scalar->grid : scalar->theory;
}

/* Returns whether some case has a value of this scalar, with what stands beside it. */
static bool has_scalar(const struct shown_cases *shown, const char *name, enum comparison with) {
    for (size_t c = 0; c < shown->count; c++) {
        const struct scalar *scalar = result_scalar(shown->list[c], name);
        if (scalar != NULL && !isnan(scalar->value) &&
            (with == ALONE || isfinite(expected(scalar, with))))
            return true;
    }
    return false;
}

/* The largest error of a source, over its scalar, of those that are shown; NaN where none has one.
 */
static double largest_error(const struct case_result *one, size_t count, const char *const *names,
                            enum error_source source) {
    double largest = NAN;
    for (size_t s = 0; s < count; s++) {
        const struct scalar *scalar = result_scalar(one, names[s]);
        const struct scalar_error *error = scalar != NULL ? &scalar->errors[source] : NULL;
        if (error != NULL && error->applies && error->known)
            largest = fmax(largest, (fabs(error->value) + error->bound) / fabs(scalar->value));
    }
    return largest;
}

/* The largest law difference, over its scalar, likewise. */
static double largest_law(const struct case_result *one, size_t count, const char *const *names) {
    double largest = NAN;
    for (size_t s = 0; s < count; s++) {
        const struct scalar *scalar = result_scalar(one, names[s]);
        if (scalar != NULL)
            largest = fmax(largest, fabs(scalar->law_difference / scalar->value));
    }
    return largest;
}

/* The view's headlines; where these cases have none, all scalars with a theory. */
static size_t shown_scalars(const struct shown_cases *shown, const char *const *headlines,
                            const char **names) {
    const struct case_result *first = shown->list[0];
    size_t count = 0;
    for (; headlines != NULL && *headlines != NULL && count < COLUMNS_MOST; headlines++)
        if (strncmp(*headlines, "percentile_", 11) != 0 && /* those have a table of their own */
            has_scalar(shown, *headlines, ALONE))
            names[count++] = *headlines;
    if (count > 0)
        return count;
    for (size_t s = 0; s < first->scalar_count && count < COLUMNS_MOST; s++)
        if (has_scalar(shown, first->scalars[s].name, WITH_THEORY))
            names[count++] = first->scalars[s].name;
    return count;
}

static void comparison_cells(struct text_table *table, double value, double theory) {
    table_number(table, theory);
    if (theory != 0 && isfinite(value / theory))
        table_cell(table, "%.4f", value / theory);
    else
        table_cell(table, "-");
}

static void scalar_cells(struct text_table *table, const struct scalar *scalar, bool total,
                         const bool compared[]) {
    double value = scalar != NULL ? scalar->value : (double)NAN;
    measured_cell(table, value, scalar != NULL ? scalar->standard_error : (double)NAN);
    const struct total none = {.low = NAN, .high = NAN};
    const struct total own = scalar != NULL ? scalar_total(scalar) : none;
    if (total)
        total_cell(table, value, &own);
    for (enum comparison with = WITH_THEORY; with <= WITH_GRID; with++)
        if (compared[with])
            comparison_cells(table, value, expected(scalar, with));
}

/* --- a row a case --- */

/* Such a table has this beside the swept parameters. */
struct scalar_table {
    const struct shown_cases *shown;
    const struct study_report *report; /* or NULL */
    size_t scalar_count;
    const char *scalars[COLUMNS_MOST];
    bool compared[COLUMNS_MOST][WITH_GRID + 1]; /* with what beside it */
    bool sources[ERROR_SOURCES];                /* of which errors of these are known */
    bool totals[COLUMNS_MOST];                  /* its total beside it */
    bool law;                                   /* the other law of some of these is known */
    bool uneven;                                /* not all cases have as many realisations */
};

static bool is_even(const struct study_result *study) {
    for (size_t c = 1; c < study->case_count; c++)
        if (study->cases[c].realisations != study->cases[0].realisations)
            return false;
    return true;
}

static size_t column_count(const struct scalar_table *plan) {
    size_t columns = 1 + plan->shown->varied_count + plan->uneven + (plan->report != NULL);
    for (size_t s = 0; s < plan->scalar_count; s++)
        columns += 1 + plan->totals[s] + 2u * plan->compared[s][WITH_THEORY] +
                   2u * plan->compared[s][WITH_GRID];
    for (enum error_source e = 0; e < ERROR_SOURCES; e++)
        columns += plan->sources[e];
    return columns + plan->law;
}

static void scalar_table_heading(const struct scalar_table *plan, struct text_table *table) {
    table_cell(table, "case");
    varied_headings(table, plan->shown);
    if (plan->uneven)
        table_cell(table, "realisations");
    for (size_t s = 0; s < plan->scalar_count; s++) {
        table_fold(table);
        table_cell(table, "%s", plan->scalars[s]);
        if (plan->totals[s])
            table_cell(table, "total %%");
        for (enum comparison with = WITH_THEORY; with <= WITH_GRID; with++)
            if (plan->compared[s][with]) {
                table_cell(table, with == WITH_GRID ? "grid" : "theory");
                table_cell(table, "ratio");
            }
    }
    for (enum error_source e = 0; e < ERROR_SOURCES; e++)
        if (plan->sources[e])
            table_cell(table, "%s %%", ERROR_SOURCE_ROWS[e].name);
    if (plan->law)
        table_cell(table, "law %%");
    if (plan->report != NULL) {
        table_fold(table);
        table_cell(table, "CPU time");
    }
}

static void scalar_table_row(const struct scalar_table *plan, size_t c, struct text_table *table) {
    const struct case_result *one = plan->shown->list[c];
    table_number(table, (double)one->case_number);
    varied_cells(table, plan->shown, c);
    if (plan->uneven)
        table_number(table, (double)one->realisations);
    for (size_t s = 0; s < plan->scalar_count; s++)
        scalar_cells(table, result_scalar(one, plan->scalars[s]), plan->totals[s],
                     plan->compared[s]);
    for (enum error_source e = 0; e < ERROR_SOURCES; e++)
        if (plan->sources[e])
            percent_cell(table, largest_error(one, plan->scalar_count, plan->scalars, e));
    if (plan->law)
        percent_cell(table, largest_law(one, plan->scalar_count, plan->scalars));
    if (plan->report != NULL) {
        const struct case_report *cost = report_of(plan->report, one);
        duration_cell(table, cost != NULL ? cost->time.cpu_seconds : (double)NAN);
    }
}

/* Returns whether a scalar has a total other than its standard error says in some case, or theory
 * to compare it with. */
static bool has_total(const struct scalar_table *plan, size_t s) {
    bool compared = plan->compared[s][WITH_THEORY] || plan->compared[s][WITH_GRID];
    for (size_t c = 0; c < plan->shown->count; c++) {
        const struct scalar *scalar = result_scalar(plan->shown->list[c], plan->scalars[s]);
        bool borne = compared;
        for (size_t e = 0; scalar != NULL && e < ERROR_SOURCES; e++)
            borne = borne || scalar->errors[e].applies;
        if (scalar == NULL || !borne)
            continue;
        const struct total total = scalar_total(scalar);
        if (total_half_width(scalar->value, &total) > 1e-9 * fabs(scalar->value)) /* rounding */
            return true;
    }
    return false;
}

/* Names the sources that are not known of some scalar in some case. */
static void print_scalars_unknown(const struct scalar_table *plan, FILE *file) {
    struct unknown_of list[COLUMNS_MOST] = {{.name = NULL}};
    size_t count = 0;
    for (size_t s = 0; s < plan->scalar_count; s++) {
        if (!plan->totals[s])
            continue;
        struct unknown_of *to = &list[count++];
        to->name = plan->scalars[s];
        for (size_t c = 0; c < plan->shown->count; c++) {
            const struct scalar *scalar = result_scalar(plan->shown->list[c], to->name);
            if (scalar == NULL || isnan(scalar->value))
                continue;
            const struct total total = scalar_total(scalar);
            for (size_t e = 0; e < UNKNOWN_SOURCES; e++)
                to->unknown[e] = to->unknown[e] || total.unknown[e];
        }
    }
    print_unknown_of(count, list, NULL, file);
}

static void find_sources(struct scalar_table *plan) {
    for (enum error_source e = 0; e < ERROR_SOURCES; e++)
        for (size_t c = 0; c < plan->shown->count && !plan->sources[e]; c++)
            plan->sources[e] =
                !isnan(largest_error(plan->shown->list[c], plan->scalar_count, plan->scalars, e));
    for (size_t c = 0; c < plan->shown->count; c++)
        plan->law = plan->law ||
                    !isnan(largest_law(plan->shown->list[c], plan->scalar_count, plan->scalars));
}

static void scalar_table_print(const struct scalar_table *plan, FILE *file) {
    struct text_table table = {.columns = column_count(plan), .room = TABLE_ROOM};
    scalar_table_heading(plan, &table);
    for (size_t c = 0; c < plan->shown->count; c++)
        scalar_table_row(plan, c, &table);
    fputc('\n', file);
    table_print(&table, file);
    table_clear(&table);
}

/* --- a study --- */

enum { TARGETS_SHOWN = 20, LIKE_SHOWN = 5 };

static void print_title(const struct study_result *study, const struct study_report *report,
                        FILE *file) {
    text_print_plain(file, study->name);
    fprintf(file, " (%s), study %s", study->state, study->id);
    if (is_even(study))
        fprintf(file, ", %llu realisations a case",
                (unsigned long long)study->cases[0].realisations);
    if (report != NULL) {
        char time[112];
        work_time_text(&report->time, time, sizeof time);
        fprintf(file, ", %s", time);
    }
    fputc('\n', file);
    if (report != NULL)
        print_without_cpu(&report->time, file);
    print_random(study->random, study->case_count, file);
}

void summary_of_curves(const struct study_result *study, const struct study_report *report,
                       FILE *file) {
    const struct result_view *view = view_of(study->kind);
    struct shown_cases shown;
    if (study->case_count == 0)
        return;
    print_title(study, report, file);
    if (!shown_of_results(study, &shown)) {
        fputs("(no memory for a table)\n", file);
        return;
    }
    if (view->table != NULL) {
        summary_of_quantity(view->table, &shown, report, file);
    } else {
        struct scalar_table plan = {.shown = &shown, .report = report, .uneven = !is_even(study)};
        plan.scalar_count = shown_scalars(&shown, view->headlines, plan.scalars);
        for (size_t s = 0; s < plan.scalar_count; s++)
            for (enum comparison with = WITH_THEORY; with <= WITH_GRID; with++)
                plan.compared[s][with] = has_scalar(&shown, plan.scalars[s], with);
        bool total = false;
        for (size_t s = 0; s < plan.scalar_count; s++) {
            plan.totals[s] = has_total(&plan, s);
            total = total || plan.totals[s];
        }
        find_sources(&plan);
        scalar_table_print(&plan, file);
        if (total)
            print_total_legend(file);
        print_scalars_unknown(&plan, file);
        if (plan.law)
            print_law_legend(file);
        print_patch_legend(&shown, file);
        print_heights(&shown, file);
        for (size_t c = 0; c < shown.count && c < TARGETS_SHOWN; c++)
            summary_of_target(shown.list[c], file);
    }
    print_units(&shown, file);
    for (size_t c = 0; c < shown.count && c < LIKE_SHOWN; c++)
        summary_of_like(shown.list[c], file);
    print_missing(&shown, file);
    shown_clear(&shown);
}
