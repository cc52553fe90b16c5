/* Contact: the real contact area against load, with its three errors, beside the theories. */
#include "server/show/document.h"
#include "server/show/summary.h"
#include "server/show/summary_cells.h"
#include <string.h>

enum { TABLES_MOST = 4, LOADS_SHOWN = 10, MODELS_MOST = 4, THEORIES_MOST = 8, NOTES_SHOWN = 3 };

/* The finest curve of each model, of the first estimator of the case. */
struct areas {
    size_t model_count, theory_count;
    const cJSON *curves[MODELS_MOST];
    const char *theories[THEORIES_MOST];
};

/* Lines that hold at light loads alone have no place beside all loads. */
static bool is_line(const char *theory) {
    return strstr(theory, "_light_load") != NULL;
}

static void areas_add(struct areas *areas, const cJSON *curve) {
    size_t m = 0;
    while (m < areas->model_count &&
           strcmp(text_of(areas->curves[m], "model", ""), text_of(curve, "model", "")) != 0)
        m++;
    if (m == MODELS_MOST)
        return;
    if (m == areas->model_count)
        areas->curves[areas->model_count++] = curve;
    else if (number_of(curve, "level") > number_of(areas->curves[m], "level"))
        areas->curves[m] = curve;
}

static void areas_find(struct areas *areas, const cJSON *one) {
    *areas = (struct areas){0};
    for (const cJSON *curve = first_of(one, "curves"); curve; curve = curve->next) {
        if (strcmp(text_of(curve, "quantity", ""), "contact_area") != 0)
            continue;
        const char *series = areas->model_count ? text_of(areas->curves[0], "series", "") : NULL;
        if (!series || strcmp(series, text_of(curve, "series", "")) == 0)
            areas_add(areas, curve);
    }
    const cJSON *theory = first_of(areas->curves[0], "theory");
    for (; theory && areas->theory_count < THEORIES_MOST; theory = theory->next)
        if (!is_line(theory->string))
            areas->theories[areas->theory_count++] = theory->string;
}

/* NaN for what is no number, or not there. */
static double item_of(const cJSON *curve, const char *name, int index) {
    const cJSON *list = member(curve, name);
    const cJSON *item = cJSON_IsArray(list) ? cJSON_GetArrayItem(list, index) : NULL;
    return item && cJSON_IsNumber(item) ? item->valuedouble : (double)NAN;
}

static int load_count(const struct areas *areas) {
    return areas->model_count ? cJSON_GetArraySize(member(areas->curves[0], "x")) : 0;
}

/* --- a table a case --- */

/* With its sign: above or below what it is counted from. */
static void error_cell(struct text_table *table, double error, double value) {
    if (isnan(error / value))
        table_cell(table, "-");
    else
        table_cell(table, "%+.2g", 100 * error / value);
}

static void area_cell(struct text_table *table, const cJSON *one, const cJSON *curve, int k) {
    char text[64], partial[48];
    measured_text(item_of(curve, "y", k), item_of(curve, "standard_error", k), text, sizeof text);
    partial_text(number_of(one, "realisations"), item_of(curve, "valueless", k), partial,
                 sizeof partial);
    table_cell(table, "%s%s", text, partial);
}

static void area_heading(const struct areas *areas, struct text_table *table) {
    char model[64];
    table_cell(table, "load");
    for (size_t m = 0; m < areas->model_count; m++) {
        table_fold(table);
        table_cell(table, "%s", model_text(areas->curves[m], model, sizeof model));
        table_cell(table, "mesh %%");
        if (areas->model_count > 1)
            table_cell(table, "model %%");
    }
    if (areas->theory_count)
        table_fold(table);
    for (size_t t = 0; t < areas->theory_count; t++)
        table_cell(table, "%s", areas->theories[t]);
}

static void area_row(const cJSON *one, const struct areas *areas, int k, struct text_table *table) {
    table_number(table, item_of(areas->curves[0], "x", k));
    for (size_t m = 0; m < areas->model_count; m++) {
        const cJSON *curve = areas->curves[m];
        double y = item_of(curve, "y", k);
        area_cell(table, one, curve, k);
        error_cell(table, item_of(curve, "discretisation_error", k), y);
        if (areas->model_count > 1)
            error_cell(table, item_of(curve, "model_error", k), y);
    }
    for (size_t t = 0; t < areas->theory_count; t++) {
        double theory = item_of(member(areas->curves[0], "theory"), areas->theories[t], k);
        table_cell(table, isnan(theory) ? "-" : "%.4f", theory);
    }
}

/* "kappa 2.80 +- 0.08 (theory 1.5958)" */
static void print_scalar(const cJSON *one, const char *name, FILE *file) {
    const cJSON *scalar = member(member(one, "scalars"), name);
    double theory = number_of(scalar, "theory");
    char text[64];
    measured_text(number_of(scalar, "value"), number_of(scalar, "standard_error"), text,
                  sizeof text);
    fprintf(file, "%s %s", name, text);
    if (!isnan(theory))
        fprintf(file, " (theory %.4f)", theory);
}

/* At most LOADS_SHOWN of the loads, with the lowest and the highest. */
static void case_table(const cJSON *one, const struct areas *areas, FILE *file) {
    size_t columns = 1 + (areas->model_count > 1 ? 3 : 2) * areas->model_count;
    struct text_table table = {.columns = columns + areas->theory_count};
    int loads = load_count(areas), shown = loads < LOADS_SHOWN ? loads : LOADS_SHOWN;
    char model[64];
    area_heading(areas, &table);
    for (int n = 0; n < shown; n++)
        area_row(one, areas, shown > 1 ? n * (loads - 1) / (shown - 1) : 0, &table);
    table_print(&table, file);
    table_clear(&table);
    fprintf(file, "%s: ", model_text(areas->curves[0], model, sizeof model));
    print_scalar(one, "kappa", file);
    fputs(", ", file);
    print_scalar(one, "erf_kappa", file);
    fputc('\n', file);
}

static void print_case(const cJSON *one, const cJSON *cost, const char *const *varied,
                       size_t varied_count, FILE *file) {
    struct areas areas;
    char time[48];
    areas_find(&areas, one);
    duration_text(number_of(cost, "seconds"), time, sizeof time);
    fprintf(file, "\ncase %.0f: ", number_of(one, "case"));
    print_swept(one, varied, varied_count, file);
    fprintf(file, "%.0f realisations", number_of(one, "realisations"));
    if (cost)
        fprintf(file, ", %s", time);
    if (areas.model_count) {
        fprintf(file, "; contact area by %s at %.4g points a shortest wave\n",
                text_of(areas.curves[0], "series", "-"), number_of(areas.curves[0], "level"));
        case_table(one, &areas, file);
    } else {
        fputc('\n', file);
    }
}

/* --- a row a case --- */

enum { SAMPLES = 3 }; /* lowest, middle and highest load */

static int sample_of(const struct areas *areas, int n) {
    return n * (load_count(areas) - 1) / (SAMPLES - 1);
}

/* The load of each sample, NaN where cases differ in it. */
static void sample_loads(const cJSON *cases, double loads[SAMPLES]) {
    bool begun = false;
    for (const cJSON *one = cases->child; one; one = one->next) {
        struct areas areas;
        areas_find(&areas, one);
        for (int n = 0; n < SAMPLES && areas.model_count; n++) {
            double load = item_of(areas.curves[0], "x", sample_of(&areas, n));
            loads[n] = !begun || load == loads[n] ? load : (double)NAN;
        }
        begun = begun || areas.model_count;
    }
}

static void row_heading(const cJSON *cases, const char *const *varied, size_t varied_count,
                        struct text_table *table) {
    static const char *const SAMPLE_NAMES[SAMPLES] = {"lowest", "middle", "highest"};
    double loads[SAMPLES] = {NAN, NAN, NAN};
    sample_loads(cases, loads);
    table_cell(table, "case");
    for (size_t p = 0; p < varied_count; p++)
        table_cell(table, "%s", last_name(varied[p]));
    table_cell(table, "realisations");
    table_fold(table);
    for (int n = 0; n < SAMPLES; n++)
        if (isnan(loads[n]))
            table_cell(table, "area at %s load", SAMPLE_NAMES[n]);
        else
            table_cell(table, "area at %.4g", loads[n]);
    table_cell(table, "mesh %%");
    table_cell(table, "model %%");
    table_fold(table);
    table_cell(table, "kappa");
    table_cell(table, "erf_kappa");
    table_cell(table, "time");
}

static void scalar_cell(struct text_table *table, const cJSON *one, const char *name) {
    const cJSON *scalar = member(member(one, "scalars"), name);
    measured_cell(table, number_of(scalar, "value"), number_of(scalar, "standard_error"));
}

static void case_row(const cJSON *one, const cJSON *cost, const char *const *varied,
                     size_t varied_count, struct text_table *table) {
    struct areas areas;
    char time[48];
    areas_find(&areas, one);
    table_number(table, number_of(one, "case"));
    for (size_t p = 0; p < varied_count; p++)
        value_cell(table, member(member(one, "parameters"), varied[p]));
    table_number(table, number_of(one, "realisations"));
    for (int n = 0; n < SAMPLES; n++)
        area_cell(table, one, areas.curves[0], sample_of(&areas, n));
    percent_cell(table, number_of(cost, "discretisation_error"));
    percent_cell(table, number_of(cost, "model_error"));
    scalar_cell(table, one, "kappa");
    scalar_cell(table, one, "erf_kappa");
    duration_text(number_of(cost, "seconds"), time, sizeof time);
    table_cell(table, "%s", time);
}

void summary_of_contact(const cJSON *cases, const cJSON *costs, FILE *file) {
    const char *varied[COLUMNS_MOST];
    size_t varied_count = varied_parameters(cases, varied);
    const cJSON *cost = costs ? costs->child : NULL;
    bool tables = cJSON_GetArraySize(cases) <= TABLES_MOST;
    struct text_table table = {.columns = varied_count + 2 + SAMPLES + 2 + 3};
    if (!tables)
        row_heading(cases, varied, varied_count, &table);
    for (const cJSON *one = cases->child; one; one = one->next) {
        if (tables)
            print_case(one, cost, varied, varied_count, file);
        else
            case_row(one, cost, varied, varied_count, &table);
        cost = cost ? cost->next : NULL;
    }
    if (!tables) {
        fputc('\n', file);
        table_print(&table, file);
    }
    table_clear(&table);
    fputs(
        "\nload: p/(E* h'_rms); area: A/A0, +- one standard error; mesh %: error from the limit of "
        "the levels, model %: of the limit from that of the most complete model\n",
        file);
    print_partial(cases, file);
    print_notes(cases, NOTES_SHOWN, file);
}
