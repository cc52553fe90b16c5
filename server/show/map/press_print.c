#include "server/show/map/press_print.h"
#include "core/map/length_unit.h"
#include "schema/json/json.h"
#include "server/show/quantity.h"
#include "server/show/table/text_table.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

static double value_of(const struct press_report *report, size_t load, enum press_value value) {
    return report->result->curves[value].y[load];
}

static double error_of(const struct press_report *report, size_t load, enum press_value value) {
    return report->result->curves[value].errors[ERROR_DISCRETISATION].bound[load];
}

/* --- physical units --- */

enum kind { KIND_PRESSURE, KIND_FORCE, KIND_AREA, KIND_LENGTH, KIND_STIFFNESS };

/* A column of the table in physical units: a value times a scale. */
struct physical_column {
    const char *name, *key;
    enum kind kind;
    enum press_value value;
    double scale; /* to SI units; 0: not known */
};
enum { PHYSICAL_COLUMNS = 7 };

static void fill_physical(const struct press_report *report,
                          struct physical_column columns[PHYSICAL_COLUMNS]) {
    const struct map_press *press = report->press;
    double pressure = press->slope * report->modulus, length = report->metres ? press->height : 0;
    double area = report->metres ? report->map_area : 0;
    double stiffness = length > 0 ? pressure / length * area : 0;
    const struct physical_column all[PHYSICAL_COLUMNS] = {
        {"pressure", "pressure", KIND_PRESSURE, PRESS_LOAD, pressure},
        {"force", "force", KIND_FORCE, PRESS_LOAD, pressure * area},
        {"contact area", "contact_area", KIND_AREA, PRESS_EDGES, area},
        {"peak pressure", "peak_pressure", KIND_PRESSURE, PRESS_PEAK, pressure},
        {"approach", "approach", KIND_LENGTH, PRESS_APPROACH, length},
        {"mean gap", "mean_gap", KIND_LENGTH, PRESS_MEAN_GAP, length},
        {"stiffness", "stiffness", KIND_STIFFNESS, PRESS_STIFFNESS, stiffness}};
    memcpy(columns, all, sizeof all);
}

/* Returns the unit in SI, as in JSON. */
static const char *si_unit(enum kind kind, bool profile) {
    static const char *const UNITS[] = {"Pa", "N", "m^2", "m", "N/m"};
    static const char *const PROFILE_UNITS[] = {"Pa", "N/m", "m", "m", "N/m^2"};
    return profile ? PROFILE_UNITS[kind] : UNITS[kind];
}

/* Writes the unit in which the largest value of a column is best read; returns what it stands for.
 */
static double readable_unit(enum kind kind, bool profile, double most, char *unit, size_t size) {
    double scale = 1;
    most = most > 0 ? most : 1; /* nothing to read */
    if (kind == KIND_AREA && !profile) {
        const char *length = length_unit_readable(sqrt(most), &scale);
        snprintf(unit, size, "%s^2", length);
        return scale * scale;
    }
    if (kind == KIND_LENGTH || kind == KIND_AREA) {
        snprintf(unit, size, "%s", length_unit_readable(most, &scale));
        return scale;
    }
    const char *prefix = quantity_prefix(most, &scale);
    snprintf(unit, size, "%s%s", prefix, si_unit(kind, profile));
    return scale;
}

static double largest(const struct press_report *report, enum press_value value) {
    double most = 0;
    for (size_t l = 0; l < report->loads; l++)
        most = fmax(most, fabs(value_of(report, l, value))); /* NaN is passed over */
    return most;
}

static void print_physical(FILE *file, const struct press_report *report) {
    struct physical_column columns[PHYSICAL_COLUMNS];
    double scales[PHYSICAL_COLUMNS] = {0};
    bool profile = grid_is_profile(&report->press->map);
    struct text_table table = {0};
    fill_physical(report, columns);
    for (size_t c = 0; c < PHYSICAL_COLUMNS; c++)
        table.columns += columns[c].scale > 0;
    if (table.columns == 0)
        return;
    for (size_t c = 0; c < PHYSICAL_COLUMNS; c++) {
        char unit[24];
        if (!(columns[c].scale > 0))
            continue;
        scales[c] =
            columns[c].scale / readable_unit(columns[c].kind, profile,
                                             columns[c].scale * largest(report, columns[c].value),
                                             unit, sizeof unit);
        table_cell(&table, "%s, %s", columns[c].name, unit);
    }
    for (size_t l = 0; l < report->loads; l++)
        for (size_t c = 0; c < PHYSICAL_COLUMNS; c++)
            if (columns[c].scale > 0)
                table_number(&table, value_of(report, l, columns[c].value) * scales[c]);
    fprintf(file, "\n");
    table_print(&table, file);
    table_clear(&table);
}

/* --- text --- */

static void print_length(FILE *file, const char *name, double length, bool metres) {
    double scale = 1;
    const char *unit = metres ? length_unit_readable(length, &scale) : "";
    fprintf(file, "%s %.4g%s%s", name, length / scale, metres ? " " : "", unit);
}

static void print_heading(FILE *file, const struct press_report *report) {
    const struct map_press *press = report->press;
    const struct preparation_record *record = report->record;
    for (size_t step = 0; step < record->count; step++)
        fprintf(file, "%s: %s\n", record->steps[step].name, record->steps[step].text);
    fprintf(file, "boundary: %s (by %s)\nmodel: %s\nRMS slope %.4g, ", report->boundary,
            report->boundary_by, report->model, press->slope);
    print_length(file, "RMS height", press->height, report->metres);
    if (!isnan(press->full_contact))
        fprintf(file, "; full contact at p/(E* h') = %.4g", press->full_contact / press->slope);
    if (report->modulus > 0) {
        double scale;
        const char *prefix = quantity_prefix(report->modulus, &scale);
        fprintf(file, "; E* = %.4g %sPa", report->modulus / scale, prefix);
    }
    fprintf(file, "\n\n");
}

static void print_errors(FILE *file, const struct press_report *report) {
    struct text_table table = {.columns = 1};
    if (!report->with_errors)
        return;
    for (size_t c = 0; c < PRESS_VALUES; c++)
        table.columns += PRESS_COLUMNS[c].uncertain;
    table_cell(&table, "%s", PRESS_COLUMNS[PRESS_LOAD].heading);
    for (size_t c = 0; c < PRESS_VALUES; c++)
        if (PRESS_COLUMNS[c].uncertain)
            table_cell(&table, "%s", PRESS_COLUMNS[c].heading);
    for (size_t l = 0; l < report->loads; l++) {
        table_number(&table, value_of(report, l, PRESS_LOAD));
        for (size_t c = 0; c < PRESS_VALUES; c++)
            if (PRESS_COLUMNS[c].uncertain)
                table_number(&table, error_of(report, l, (enum press_value)c));
    }
    fprintf(file, "\nerrors by the points: what every second point alone changes\n\n");
    table_print(&table, file);
    table_clear(&table);
}

void press_print_table(FILE *file, const struct press_report *report) {
    struct text_table table = {.columns = PRESS_VALUES};
    print_heading(file, report);
    for (size_t c = 0; c < PRESS_VALUES; c++) {
        if (c == PRESS_EDGES || c == PRESS_PEAK || c == PRESS_PATCHES)
            table_fold(&table);
        table_cell(&table, "%s", PRESS_COLUMNS[c].heading);
    }
    for (size_t l = 0; l < report->loads; l++)
        for (size_t c = 0; c < PRESS_VALUES; c++)
            table_number(&table, value_of(report, l, (enum press_value)c));
    table_print(&table, file);
    table_clear(&table);
    print_physical(file, report);
    print_errors(file, report);
}

/* --- JSON --- */

static bool add_column(cJSON *object, const char *key, const struct press_report *report,
                       enum press_value value, double scale, double *column) {
    for (size_t l = 0; l < report->loads; l++)
        column[l] = scale * value_of(report, l, value);
    return cJSON_AddItemToObject(object, key, json_numbers(column, report->loads));
}

static bool add_errors(cJSON *document, const struct press_report *report, double *column) {
    bool complete = true;
    for (size_t c = 0; report->with_errors && c < PRESS_VALUES && complete; c++) {
        char key[40];
        if (!PRESS_COLUMNS[c].uncertain)
            continue;
        snprintf(key, sizeof key, "%s_error", PRESS_COLUMNS[c].key);
        for (size_t l = 0; l < report->loads; l++)
            column[l] = error_of(report, l, (enum press_value)c);
        complete = cJSON_AddItemToObject(document, key, json_numbers(column, report->loads));
    }
    return complete;
}

static bool add_physical(cJSON *document, const struct press_report *report, double *column) {
    struct physical_column columns[PHYSICAL_COLUMNS];
    bool profile = grid_is_profile(&report->press->map), complete = true;
    fill_physical(report, columns);
    if (!(report->modulus > 0) && !report->metres)
        return true;
    cJSON *physical = cJSON_AddObjectToObject(document, "physical");
    cJSON *units = cJSON_AddObjectToObject(physical, "units");
    if (report->modulus > 0)
        complete = cJSON_AddNumberToObject(physical, "effective_modulus", report->modulus) &&
                   cJSON_AddStringToObject(units, "effective_modulus", "Pa");
    if (report->metres)
        complete = complete &&
                   cJSON_AddNumberToObject(physical, "nominal_area", report->map_area) &&
                   cJSON_AddStringToObject(units, "nominal_area", profile ? "m" : "m^2");
    for (size_t c = 0; c < PHYSICAL_COLUMNS && complete; c++)
        if (columns[c].scale > 0)
            complete =
                cJSON_AddStringToObject(units, columns[c].key, si_unit(columns[c].kind, profile)) &&
                add_column(physical, columns[c].key, report, columns[c].value, columns[c].scale,
                           column);
    return complete;
}

static bool add_heading(cJSON *document, const struct press_report *report) {
    const struct map_press *press = report->press;
    const struct preparation_record *record = report->record;
    cJSON *preparation = cJSON_AddObjectToObject(document, "preparation");
    bool complete = preparation != NULL;
    for (size_t step = 0; step < record->count && complete; step++)
        complete = cJSON_AddStringToObject(preparation, record->steps[step].name,
                                           record->steps[step].text) != NULL;
    return complete && cJSON_AddStringToObject(document, "boundary", report->boundary) &&
           cJSON_AddStringToObject(document, "boundary_by", report->boundary_by) &&
           cJSON_AddStringToObject(document, "model", report->model) &&
           cJSON_AddStringToObject(document, "unit", report->metres ? "m" : "") &&
           cJSON_AddItemToObject(document, "rms_slope", json_number(press->slope)) &&
           cJSON_AddItemToObject(document, "rms_height", json_number(press->height)) &&
           cJSON_AddItemToObject(document, "full_contact",
                                 json_number(press->full_contact / press->slope));
}

cJSON *press_document(const struct press_report *report) {
    double *column = array_create(report->loads, sizeof *column);
    cJSON *document = column != NULL ? cJSON_CreateObject() : NULL;
    bool complete = document != NULL && add_heading(document, report);
    for (size_t c = 0; c < PRESS_VALUES && complete; c++)
        complete =
            add_column(document, PRESS_COLUMNS[c].key, report, (enum press_value)c, 1, column);
    complete =
        complete && add_errors(document, report, column) && add_physical(document, report, column);
    free(column);
    if (complete)
        return document;
    cJSON_Delete(document);
    return NULL;
}
