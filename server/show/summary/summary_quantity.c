/* One quantity over its x, with its errors by source, beside the theories. */
#include "server/show/quantity.h"
#include "server/show/summary/summary.h"
#include "server/show/summary/summary_cells.h"
#include "server/show/summary/summary_target.h"
#include <math.h>
#include <string.h>

enum { TABLES_MOST = 4, PLACES_SHOWN = 10, MODELS_MOST = 8, NOTES_SHOWN = 3, PHYSICAL_SIZE = 32 };

/* A case is shown by the finest curve of each model, of the first estimator. */
struct finest_curves {
    size_t model_count, theory_count;
    bool more_models; /* than there is room for: listed below the table */
    const struct curve *curves[MODELS_MOST];
    const struct theory *theories[THEORIES_MOST]; /* of the first model, those of the table */
};

static const char *text_or(const char *text, const char *otherwise) {
    return text != NULL ? text : otherwise;
}

static void add_curve(struct finest_curves *finest, const struct curve *curve) {
    size_t m = 0;
    while (m < finest->model_count &&
           strcmp(text_or(finest->curves[m]->model, ""), text_or(curve->model, "")) != 0)
        m++;
    if (m == MODELS_MOST)
        finest->more_models = true;
    else if (m == finest->model_count)
        finest->curves[finest->model_count++] = curve;
    else if (curve->level > finest->curves[m]->level)
        finest->curves[m] = curve;
}

static void find_finest(struct finest_curves *finest, const struct quantity_table *words,
                        const struct case_result *one) {
    *finest = (struct finest_curves){0};
    for (size_t a = 0; a < one->curve_count; a++) {
        const struct curve *curve = &one->curves[a];
        if (strcmp(curve->quantity, words->quantity) != 0 || curve->columns > 0)
            continue;
        const char *series = finest->model_count > 0 ? finest->curves[0]->series : curve->series;
        if (strcmp(text_or(series, ""), text_or(curve->series, "")) == 0)
            add_curve(finest, curve);
    }
    if (finest->model_count == 0)
        return;
    const struct curve *first = finest->curves[0];
    for (size_t t = 0; t < first->theory_count; t++)
        if (first->theories[t].y != NULL && !view_lists(words->left_out, first->theories[t].name))
            finest->theories[finest->theory_count++] = &first->theories[t];
}

static size_t place_count(const struct finest_curves *finest) {
    return finest->model_count > 0 ? finest->curves[0]->n : 0;
}

/* Returns NaN for what is not there. */
static double number_at(const double *numbers, const struct curve *curve, size_t k) {
    return numbers != NULL && k < curve->n ? numbers[k] : (double)NAN;
}

/* --- cells --- */

/* In percent of the value, with its sign: above or below what is true, and within which bound; or
 * below which size, where no more is known. */
static void error_cell(struct text_table *table, const struct curve *curve, size_t k,
                       enum error_source source) {
    const struct curve_error *of = &curve->errors[source];
    double value = number_at(curve->y, curve, k), error = number_at(of->value, curve, k);
    double bound = number_at(of->bound, curve, k);
    if (isnan(error / value))
        table_cell(table, "-");
    else if (error_is_unresolved(source, error, bound, number_at(of->standard_error, curve, k)))
        table_cell(table, "<%.2g", 100 * (fabs(error) + bound) / fabs(value));
    else if (error == 0 && bound > 0)
        table_cell(table, "+-%.2g", 100 * bound / value);
    else if (bound > 0)
        table_cell(table, "%+.2g+-%.2g", 100 * error / value, 100 * bound / value);
    else
        table_cell(table, "%+.2g", 100 * error / value);
}

/* In percent of the value, +- one standard error. */
static void law_cell(struct text_table *table, double difference, double standard_error,
                     double value) {
    if (isnan(difference / value))
        table_cell(table, "-");
    else
        table_cell(table, "%+.2g +- %.2g", 100 * difference / value,
                   100 * standard_error / fabs(value));
}

static void value_cell(struct text_table *table, const struct case_result *one,
                       const struct curve *curve, size_t k) {
    char text[64], partial[48];
    if (curve == NULL) {
        table_cell(table, "-");
        return;
    }
    measured_text(number_at(curve->y, curve, k), number_at(curve->standard_error, curve, k), text,
                  sizeof text);
    partial_text((double)one->realisations, number_at(curve->valueless, curve, k), partial,
                 sizeof partial);
    table_cell(table, "%s%s", text, partial);
}

static void curve_total_cell(struct text_table *table, const struct curve *curve, size_t k) {
    const struct total none = {.low = NAN, .high = NAN};
    const struct total total = k < curve->n ? curve_total(curve, k) : none;
    total_cell(table, number_at(curve->y, curve, k), &total);
}

/* Prints "kappa 2.80 +- 0.08 (total 9.1 %, theory 1.5958)". */
static void print_scalar(const struct case_result *one, const char *name, FILE *file) {
    const struct scalar *scalar = result_scalar(one, name);
    char text[64];
    measured_text(scalar != NULL ? scalar->value : (double)NAN,
                  scalar != NULL ? scalar->standard_error : (double)NAN, text, sizeof text);
    fprintf(file, "%s %s", name, text);
    if (scalar == NULL)
        return;
    const struct total total = scalar_total(scalar);
    double share = total_half_width(scalar->value, &total) / fabs(scalar->value);
    bool shown = share > 0 && isfinite(share);
    if (shown)
        fprintf(file, " (total %s%.2g %%", total_is_partial(&total) ? ">" : "", 100 * share);
    if (!isnan(scalar->theory))
        fprintf(file, "%s%.4f", shown ? ", theory " : " (theory ", scalar->theory);
    if (shown || !isnan(scalar->theory))
        fputc(')', file);
}

/* --- a table a case --- */

/* Returns what x is to be multiplied by to be in a unit that is easily read, and writes that. */
static double physical_x(const struct curve *curve, char unit[PHYSICAL_SIZE]) {
    double most = 0, scale = curve->x_unit.scale;
    for (size_t k = 0; k < curve->n; k++)
        most = fmax(most, fabs(curve->x[k]) * scale);
    return scale / unit_readable(curve->x_unit.unit, most, unit, PHYSICAL_SIZE);
}

/* The error of a point by a source, within its bound, over the value; NaN where nothing is known.
 */
static double error_size(const struct curve *curve, enum error_source source, size_t k) {
    const struct curve_error *error = &curve->errors[source];
    double bound = number_at(error->bound, curve, k);
    double size = fabs(number_at(error->value, curve, k)) + (isnan(bound) ? 0 : bound);
    return size / fabs(number_at(curve->y, curve, k));
}

static double largest_error(const struct curve *curve, enum error_source source) {
    double largest = NAN;
    for (size_t k = 0; k < curve->n; k++)
        largest = fmax(largest, error_size(curve, source, k));
    return largest;
}

static double largest_of_all(const struct finest_curves *finest, enum error_source source) {
    double largest = NAN;
    for (size_t m = 0; m < finest->model_count; m++)
        largest = fmax(largest, largest_error(finest->curves[m], source));
    return largest;
}

static bool has_column(const struct finest_curves *finest, enum error_source source) {
    return largest_of_all(finest, source) >= error_shown(source);
}

static void find_small(const struct finest_curves *finest, bool small[ERROR_SOURCES]) {
    for (enum error_source s = 0; s < ERROR_SOURCES; s++)
        small[s] = largest_of_all(finest, s) < error_shown(s);
}

/* Finds the sources that bear on a curve and are not known, at some point at least. */
static void find_unknown(const struct curve *curve, bool unknown[UNKNOWN_SOURCES]) {
    bool own[UNKNOWN_SOURCES];
    curve_unknown(curve, own);
    for (size_t s = 0; s < UNKNOWN_SOURCES; s++)
        unknown[s] = unknown[s] || own[s];
}

/* Names them by model. */
static void print_models_unknown(const struct finest_curves *finest, const char *const *words,
                                 FILE *file) {
    struct unknown_of list[MODELS_MOST] = {{.name = NULL}};
    for (size_t m = 0; m < finest->model_count; m++) {
        list[m].name = text_or(finest->curves[m]->model, "-");
        find_unknown(finest->curves[m], list[m].unknown);
    }
    print_unknown_of(finest->model_count, list, words, file);
}

static bool has_law(const struct finest_curves *finest) {
    bool any = false;
    for (size_t m = 0; m < finest->model_count; m++)
        any = any || finest->curves[m]->law_difference != NULL;
    return any;
}

static size_t column_count(const struct finest_curves *finest) {
    size_t columns = 1 + 2 * finest->model_count + finest->theory_count;
    columns += finest->curves[0]->x_unit.unit != NULL;
    columns += has_law(finest) ? finest->model_count : 0;
    for (int source = 0; source < ERROR_SOURCES; source++)
        columns += has_column(finest, (enum error_source)source) ? finest->model_count : 0;
    return columns;
}

static void put_heading(const struct quantity_table *words, const struct finest_curves *finest,
                        struct text_table *table) {
    char model[64];
    char unit[PHYSICAL_SIZE];
    table_cell(table, "%s", words->x);
    if (finest->curves[0]->x_unit.unit != NULL) {
        (void)physical_x(finest->curves[0], unit);
        table_cell(table, "%s, %s", finest->curves[0]->x_unit.symbol, unit);
    }
    for (size_t m = 0; m < finest->model_count; m++) {
        const struct curve *curve = finest->curves[m];
        table_fold(table);
        table_cell(table, "%s", model_text(curve->model, curve->kinematics, model, sizeof model));
        table_cell(table, "total %%");
        for (int source = 0; source < ERROR_SOURCES; source++)
            if (has_column(finest, (enum error_source)source))
                table_cell(table, "%s %%", source_word(words->error_words, (size_t)source));
        if (has_law(finest))
            table_cell(table, "law %%");
    }
    if (finest->theory_count > 0)
        table_fold(table);
    for (size_t t = 0; t < finest->theory_count; t++)
        table_cell(table, "%s", finest->theories[t]->name);
}

static void put_place(const struct case_result *one, const struct finest_curves *finest, size_t k,
                      struct text_table *table) {
    char unit[PHYSICAL_SIZE];
    table_number(table, finest->curves[0]->x[k]);
    if (finest->curves[0]->x_unit.unit != NULL)
        table_number(table, finest->curves[0]->x[k] * physical_x(finest->curves[0], unit));
    for (size_t m = 0; m < finest->model_count; m++) {
        const struct curve *curve = finest->curves[m];
        value_cell(table, one, curve, k);
        curve_total_cell(table, curve, k);
        for (int source = 0; source < ERROR_SOURCES; source++)
            if (has_column(finest, (enum error_source)source))
                error_cell(table, curve, k, (enum error_source)source);
        if (has_law(finest))
            law_cell(table, number_at(curve->law_difference, curve, k),
                     number_at(curve->law_standard_error, curve, k), number_at(curve->y, curve, k));
    }
    for (size_t t = 0; t < finest->theory_count; t++) {
        double theory = finest->theories[t]->y[k];
        table_cell(table, isnan(theory) ? "-" : "%.4f", theory);
    }
}

/* Prints at most PLACES_SHOWN of the points, with the first and the last. */
static void print_table(const struct quantity_table *words, const struct case_result *one,
                        const struct finest_curves *finest, FILE *file) {
    const struct curve *first = finest->curves[0];
    size_t places = first->n, shown = places < PLACES_SHOWN ? places : PLACES_SHOWN;
    struct text_table table = {.columns = column_count(finest), .room = TABLE_ROOM};
    char model[64];
    put_heading(words, finest, &table);
    for (size_t n = 0; n < shown; n++)
        put_place(one, finest, shown > 1 ? n * (places - 1) / (shown - 1) : 0, &table);
    table_print(&table, file);
    table_clear(&table);
    bool asked = result_scalar(one, "error_asked") != NULL;
    for (size_t s = 0; !asked && words->scalars != NULL && words->scalars[s] != NULL; s++) {
        if (s == 0)
            fprintf(file, "%s: ", model_text(first->model, first->kinematics, model, sizeof model));
        else
            fputs(", ", file);
        print_scalar(one, words->scalars[s], file);
    }
    if (asked)
        summary_of_target(one, file);
    else
        fputc('\n', file);
    print_models_unknown(finest, words->error_words, file);
    bool small[ERROR_SOURCES];
    find_small(finest, small);
    print_small(small, words->error_words, file);
}

static void print_case(const struct quantity_table *words, const struct shown_cases *shown,
                       size_t c, const struct study_report *report, FILE *file) {
    const struct case_result *one = shown->list[c];
    const struct case_report *cost = report_of(report, one);
    struct finest_curves finest;
    find_finest(&finest, words, one);
    fprintf(file, "\ncase %llu: ", (unsigned long long)one->case_number);
    print_swept(shown, c, file);
    fprintf(file, "%llu realisations", (unsigned long long)one->realisations);
    if (cost != NULL) {
        char time[48];
        duration_text(cost->time.cpu_seconds, time, sizeof time);
        fprintf(file, ", %s of CPU time", time);
    }
    if (finest.model_count > 0) {
        fprintf(file, "; %s by %s", words->title, text_or(finest.curves[0]->series, "-"));
        if (!isnan(finest.curves[0]->level))
            fprintf(file, " at %.4g points a shortest wave", finest.curves[0]->level);
        fputc('\n', file);
        print_table(words, one, &finest, file);
        if (finest.more_models)
            fprintf(file, "Only the first %d models are shown.\n", MODELS_MOST);
    } else {
        fputc('\n', file);
    }
}

/* --- a row a case --- */

enum { SAMPLES = 3 }; /* first, middle and last point */

static size_t sample_place(const struct finest_curves *finest, size_t n) {
    size_t places = place_count(finest);
    return places > 0 ? n * (places - 1) / (SAMPLES - 1) : 0;
}

/* Finds x of each sample, NaN where cases differ in it. */
static void find_samples(const struct quantity_table *words, const struct shown_cases *shown,
                         double x[SAMPLES]) {
    bool begun = false;
    for (size_t c = 0; c < shown->count; c++) {
        struct finest_curves finest;
        find_finest(&finest, words, shown->list[c]);
        for (size_t n = 0; n < SAMPLES && place_count(&finest) > 0; n++) {
            double place = finest.curves[0]->x[sample_place(&finest, n)];
            x[n] = !begun || place == x[n] ? place : (double)NAN;
        }
        begun = begun || place_count(&finest) > 0;
    }
}

/* A row has the largest size of each error at its samples: what it says holds of all of them. */

static double largest_sampled(const struct finest_curves *finest, enum error_source source) {
    double largest = NAN;
    for (size_t n = 0; n < SAMPLES && finest->model_count > 0; n++)
        largest = fmax(largest, error_size(finest->curves[0], source, sample_place(finest, n)));
    return largest;
}

static double largest_law(const struct finest_curves *finest) {
    double largest = NAN;
    for (size_t n = 0; n < SAMPLES && finest->model_count > 0; n++) {
        size_t k = sample_place(finest, n);
        double law = number_at(finest->curves[0]->law_difference, finest->curves[0], k);
        largest = fmax(largest, fabs(law / number_at(finest->curves[0]->y, finest->curves[0], k)));
    }
    return largest;
}

static void total_size_cell(struct text_table *table, const struct finest_curves *finest) {
    double largest = NAN;
    bool partial = false;
    for (size_t n = 0; n < SAMPLES && place_count(finest) > 0; n++) {
        const struct curve *curve = finest->curves[0];
        size_t k = sample_place(finest, n);
        const struct total total = curve_total(curve, k);
        largest = fmax(largest, total_half_width(curve->y[k], &total) / fabs(curve->y[k]));
        partial = partial || total_is_partial(&total);
    }
    total_share_cell(table, largest, partial);
}

/* Finds the sources that are known in some case: of size, or small in all of them. */
static void find_known(const struct quantity_table *words, const struct shown_cases *shown,
                       bool known[ERROR_SOURCES], bool small[ERROR_SOURCES]) {
    double largest[ERROR_SOURCES];
    for (size_t s = 0; s < ERROR_SOURCES; s++)
        largest[s] = NAN;
    for (size_t c = 0; c < shown->count; c++) {
        struct finest_curves finest;
        find_finest(&finest, words, shown->list[c]);
        for (size_t s = 0; s < ERROR_SOURCES; s++)
            largest[s] = fmax(largest[s], largest_sampled(&finest, (enum error_source)s));
    }
    for (size_t s = 0; s < ERROR_SOURCES; s++) {
        known[s] = largest[s] >= error_shown(s);
        small[s] = largest[s] < error_shown(s);
    }
}

/* Returns whether some case has a law difference in its table. */
static bool any_law(const struct quantity_table *words, const struct shown_cases *shown) {
    bool any = false;
    for (size_t c = 0; c < shown->count; c++) {
        struct finest_curves finest;
        find_finest(&finest, words, shown->list[c]);
        any = any || has_law(&finest);
    }
    return any;
}

static void put_row_heading(const struct quantity_table *words, const struct shown_cases *shown,
                            const bool known[ERROR_SOURCES], bool law, struct text_table *table) {
    static const char *const SAMPLE_NAMES[SAMPLES] = {"lowest", "middle", "highest"};
    double x[SAMPLES] = {NAN, NAN, NAN};
    find_samples(words, shown, x);
    table_cell(table, "case");
    varied_headings(table, shown);
    table_cell(table, "realisations");
    table_fold(table);
    for (size_t n = 0; n < SAMPLES; n++)
        if (isnan(x[n]))
            table_cell(table, "%s at %s %s", words->value, SAMPLE_NAMES[n], words->x);
        else
            table_cell(table, "%s at %.4g", words->value, x[n]);
    table_fold(table);
    table_cell(table, "total %%");
    for (int source = 0; source < ERROR_SOURCES; source++)
        if (known[source])
            table_cell(table, "%s %%", source_word(words->error_words, (size_t)source));
    if (law)
        table_cell(table, "law %%");
    table_fold(table);
    for (const char *const *name = words->scalars; name != NULL && *name != NULL; name++) {
        table_cell(table, "%s", *name);
        table_cell(table, "total %%");
    }
    table_cell(table, "CPU time");
}

static void put_row(const struct quantity_table *words, const struct shown_cases *shown, size_t c,
                    const struct case_report *cost, const bool known[ERROR_SOURCES], bool law,
                    struct text_table *table) {
    const struct case_result *one = shown->list[c];
    struct finest_curves finest;
    find_finest(&finest, words, one);
    table_number(table, (double)one->case_number);
    varied_cells(table, shown, c);
    table_number(table, (double)one->realisations);
    for (size_t n = 0; n < SAMPLES; n++)
        value_cell(table, one, finest.curves[0], sample_place(&finest, n));
    total_size_cell(table, &finest);
    for (int source = 0; source < ERROR_SOURCES; source++)
        if (known[source])
            percent_cell(table, largest_sampled(&finest, (enum error_source)source));
    if (law)
        percent_cell(table, largest_law(&finest));
    for (const char *const *name = words->scalars; name != NULL && *name != NULL; name++) {
        const struct scalar *scalar = result_scalar(one, *name);
        measured_cell(table, scalar != NULL ? scalar->value : (double)NAN,
                      scalar != NULL ? scalar->standard_error : (double)NAN);
        const struct total none = {.low = NAN, .high = NAN};
        const struct total total = scalar != NULL ? scalar_total(scalar) : none;
        total_cell(table, scalar != NULL ? scalar->value : (double)NAN, &total);
    }
    duration_cell(table, cost != NULL ? cost->time.cpu_seconds : (double)NAN);
}

/* Says of which curve the rows are, and at which points their errors: where cases have different
 * curves, of which kind. */
static void print_whose(const struct quantity_table *words, const struct shown_cases *shown,
                        bool law, FILE *file) {
    const struct curve *first = NULL;
    bool same_model = true, same_level = true;
    char model[64];
    for (size_t c = 0; c < shown->count; c++) {
        struct finest_curves finest;
        find_finest(&finest, words, shown->list[c]);
        const struct curve *own = finest.curves[0];
        if (own == NULL)
            continue;
        first = first != NULL ? first : own;
        same_model = same_model && strcmp(text_or(own->model, ""), text_or(first->model, "")) == 0;
        same_level = same_level && (own->level == first->level || isnan(first->level));
    }
    if (first == NULL)
        return;
    fprintf(file, "%s: of %s by %s", words->value,
            same_model ? model_text(first->model, first->kinematics, model, sizeof model)
                       : "the first model of each case",
            text_or(first->series, "-"));
    if (same_level && !isnan(first->level))
        fprintf(file, " at %.4g points a shortest wave", first->level);
    else
        fputs(same_level ? "" : " at the finest level of each case", file);
    fprintf(file, "; its total, its errors%s: the largest at the %ss of the row.\n",
            law ? " and law" : "", words->x);
}

static void print_rows(const struct quantity_table *words, const struct shown_cases *shown,
                       const struct study_report *report, FILE *file) {
    bool known[ERROR_SOURCES], small[ERROR_SOURCES], unknown[UNKNOWN_SOURCES] = {false};
    size_t scalars = 0, sources = 0;
    bool law = any_law(words, shown);
    find_known(words, shown, known, small);
    for (size_t s = 0; s < ERROR_SOURCES; s++)
        sources += known[s];
    while (words->scalars != NULL && words->scalars[scalars] != NULL)
        scalars++;
    struct text_table table = {.columns = 1 + shown->varied_count + 1 + SAMPLES + 1 + sources +
                                          law + 2 * scalars + 1,
                               .room = TABLE_ROOM};
    put_row_heading(words, shown, known, law, &table);
    for (size_t c = 0; c < shown->count; c++) {
        struct finest_curves finest;
        find_finest(&finest, words, shown->list[c]);
        if (finest.model_count > 0)
            find_unknown(finest.curves[0], unknown);
        put_row(words, shown, c, report_of(report, shown->list[c]), known, law, &table);
    }
    fputc('\n', file);
    table_print(&table, file);
    table_clear(&table);
    print_whose(words, shown, law, file);
    print_unknown(unknown, words->error_words, file);
    print_small(small, words->error_words, file);
}

void summary_of_quantity(const struct quantity_table *words, const struct shown_cases *shown,
                         const struct study_report *report, FILE *file) {
    if (shown->count <= TABLES_MOST)
        for (size_t c = 0; c < shown->count; c++)
            print_case(words, shown, c, report, file);
    else
        print_rows(words, shown, report, file);
    fputc('\n', file);
    print_folded(file, words->legend);
    print_total_legend(file);
    if (any_law(words, shown))
        print_law_legend(file);
    print_patch_legend(shown, file);
    print_heights(shown, file);
    print_partial(shown, words->x, file);
    print_notes(shown, NOTES_SHOWN, file);
}
