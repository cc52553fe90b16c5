#include "server/show/map/press_print.h"
#include "core/file/plain_text.h"
#include "core/map/length_unit.h"
#include "jobs/maps/press/map_press_curves.h"
#include "jobs/units.h"
#include "schema/json/json.h"
#include "schema/result/csv.h"
#include "schema/result/result_json.h"
#include "server/show/map/press_slip.h"
#include "server/show/quantity.h"
#include "server/show/table/text_table.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* What is printed of one model. */
struct part {
    const struct press_report *report;
    const struct press_series *series;
    const char *model;
};

static struct part part_of(const struct press_report *report, size_t m) {
    return (struct part){report, &report->series[m],
                         contact_model_name(report->series[m].block.model)};
}

/* Returns NaN where the model has no such curve. */
static double value_of(const struct part *part, size_t load, const struct press_column *column) {
    const struct curve *curve = map_press_curve(part->report->result, column, part->model);
    return curve != NULL ? curve->y[load] : (double)NAN;
}

/* Returns the error of a column from a source; one that does not apply where the model has no such
 * curve. */
static struct curve_error error_of(const struct part *part, const struct press_column *column,
                                   enum error_source source) {
    const struct curve *curve = map_press_curve(part->report->result, column, part->model);
    return curve != NULL ? curve->errors[source] : (struct curve_error){.applies = false};
}

static double number_at(const double *numbers, size_t load) {
    return numbers != NULL ? numbers[load] : (double)NAN;
}

/* Returns whether a column is of this contact: those of quantities are where they are asked for. */
static bool has_column(const struct press_report *report, const struct press_column *column) {
    return column->value >= MEASURE_COUNT || measure_is_of(&report->press->one_case, column->value);
}

/* Returns whether its errors stand in tables. */
static bool is_uncertain(const struct press_report *report, const struct press_column *column) {
    return column->uncertain && has_column(report, column);
}

/* Return whether tables for people show a column of this model, and its errors: where some load has
 * a value, or none has any. */
static bool is_printed(const struct part *part, const struct press_column *column) {
    const struct press_row *rows = part->series->rows;
    bool some = false, solved = false;
    for (size_t l = 0; l < part->report->loads; l++) {
        some = some || !isnan(value_of(part, l, column));
        solved = solved || !isnan(rows[l].value[PRESS_CONTACT_NODES]);
    }
    return has_column(part->report, column) && (some || !solved);
}

static bool is_error_printed(const struct part *part, const struct press_column *column) {
    return column->uncertain && is_printed(part, column);
}

static const struct press_column *column_of(size_t value) {
    size_t c = 0;
    while (PRESS_COLUMNS[c].value != value)
        c++;
    return &PRESS_COLUMNS[c];
}

/* --- physical units --- */

enum kind {
    KIND_PRESSURE,
    KIND_FORCE,
    KIND_AREA,
    KIND_LENGTH,
    KIND_STIFFNESS,
    KIND_CURRENT,
    KIND_HEAT
};

/* A column of the table in physical units: a value times a scale. */
struct physical_column {
    const char *name, *key;
    enum kind kind;
    size_t value;
    double scale; /* to SI units; 0: not known */
};
enum { PHYSICAL_COLUMNS = 8 };

static void fill_physical(const struct press_report *report,
                          struct physical_column columns[PHYSICAL_COLUMNS]) {
    const struct map_press *press = report->press;
    double pressure = press->slope * report->modulus, length = report->metres ? press->height : 0;
    double area = report->metres ? report->map_area : 0;
    double stiffness = length > 0 ? pressure / length * area : 0;
    double conducted = length > 0 && report->resistivity > 0
                           ? 2 * press->slope / press->height * area / report->resistivity
                           : 0;
    enum kind conduction = report->heat ? KIND_HEAT : KIND_CURRENT;
    const struct physical_column all[PHYSICAL_COLUMNS] = {
        {"pressure", "pressure", KIND_PRESSURE, PRESS_LOAD, pressure},
        {"force", "force", KIND_FORCE, PRESS_LOAD, pressure * area},
        {"contact area", "contact_area", KIND_AREA, MEASURE_EDGES, area},
        {"peak pressure", "peak_pressure", KIND_PRESSURE, PRESS_PEAK, pressure},
        {"approach", "approach", KIND_LENGTH, PRESS_APPROACH, length},
        {"mean gap", "mean_gap", KIND_LENGTH, MEASURE_GAP, length},
        {"stiffness", "stiffness", KIND_STIFFNESS, MEASURE_STIFFNESS, stiffness},
        {"conductance", "conductance", conduction, CONDUCTANCE_MEASURE, conducted}};
    memcpy(columns, all, sizeof all);
}

/* Returns the unit in SI, as in JSON. */
static const char *si_unit(enum kind kind, bool profile) {
    static const char *const UNITS[] = {"Pa", "N", "m^2", "m", "N/m", "S", "W/K"};
    static const char *const PROFILE_UNITS[] = {"Pa", "N/m", "m", "m", "N/m^2", "S/m", "W/(m K)"};
    return profile ? PROFILE_UNITS[kind] : UNITS[kind];
}

/* Says what pressures of an elastic block mean where they have a unit. */
static void print_elastic(FILE *file, const struct part *part, double most) {
    double scale;
    if (!(part->report->modulus > 0) || part->series->block.hardness > 0 || !(most > 0))
        return;
    const char *prefix = quantity_prefix(most, &scale);
    fprintf(file,
            "elastic pressures reach %.3g %sPa; --hardness, such as 2GPa, makes the block yield\n",
            most / scale, prefix);
}

static double largest(const struct part *part, const struct press_column *column) {
    double most = 0;
    for (size_t l = 0; l < part->report->loads; l++)
        most = fmax(most, fabs(value_of(part, l, column))); /* NaN is passed over */
    return most;
}

static void print_physical(FILE *file, const struct part *part) {
    const struct press_report *report = part->report;
    struct physical_column columns[PHYSICAL_COLUMNS];
    double scales[PHYSICAL_COLUMNS] = {0};
    bool profile = grid_is_profile(&report->press->map);
    struct text_table table = {0};
    fill_physical(report, columns);
    for (size_t c = 0; c < PHYSICAL_COLUMNS; c++)
        if (!is_printed(part, column_of(columns[c].value)))
            columns[c].scale = 0;
    for (size_t c = 0; c < PHYSICAL_COLUMNS; c++)
        table.columns += columns[c].scale > 0;
    if (table.columns == 0)
        return;
    for (size_t c = 0; c < PHYSICAL_COLUMNS; c++) {
        char unit[24];
        if (!(columns[c].scale > 0))
            continue;
        scales[c] = columns[c].scale /
                    unit_readable(si_unit(columns[c].kind, profile),
                                  columns[c].scale * largest(part, column_of(columns[c].value)),
                                  unit, sizeof unit);
        table_cell(&table, "%s, %s", columns[c].name, unit);
    }
    for (size_t l = 0; l < report->loads; l++)
        for (size_t c = 0; c < PHYSICAL_COLUMNS; c++)
            if (columns[c].scale > 0)
                table_number(&table, value_of(part, l, column_of(columns[c].value)) * scales[c]);
    fprintf(file, "\n");
    table_print(&table, file);
    table_clear(&table);
    print_elastic(file, part,
                  largest(part, column_of(PRESS_PEAK)) * report->press->slope * report->modulus);
}

/* --- text --- */

static void print_length(FILE *file, const char *name, double length, bool metres) {
    double scale = 1;
    const char *unit = metres ? length_unit_readable(length, &scale) : "";
    fprintf(file, "%s %.4g%s%s", name, length / scale, metres ? " " : "", unit);
}

static void print_preparation(FILE *file, const struct press_report *report) {
    const struct preparation_record *record = report->record;
    for (size_t step = 0; step < record->count; step++)
        fprintf(file, "%s: %s\n", record->steps[step].name, record->steps[step].text);
    if (report->unit_note != NULL)
        fprintf(file, "%s\n", report->unit_note);
}

/* Returns NULL of models that have no choice of strains. */
static const char *kinematics_of(const struct part *part) {
    const struct contact_model *model = part->series->block.model;
    return model->kinematics != NULL ? model->kinematics(&part->report->press->one_case) : NULL;
}

static void print_mesh(FILE *file, const struct part *part) {
    const struct press_mesh *mesh = &part->series->mesh;
    const struct grid *grid = &part->report->press->grid;
    if (mesh->nodes == 0)
        return;
    print_length(file, "block: height", part->series->height, part->report->metres);
    fprintf(file,
            ", %zu by %zu columns, %zu layers, %zu nodes; steepest slope %.3g, worst element "
            "%.2g\n",
            grid->nx, grid->ny, mesh->layers, mesh->nodes, mesh->slope, mesh->quality);
}

static void print_heading(FILE *file, const struct part *part) {
    const struct press_report *report = part->report;
    const struct map_press *press = report->press;
    double full_contact = part->series->full_contact;
    fprintf(file, "boundary: %s (by %s)\nmodel: %s", report->boundary, report->boundary_by,
            part->model);
    if (kinematics_of(part) != NULL)
        fprintf(file, " (%s)", kinematics_of(part));
    fprintf(file, "\n");
    print_mesh(file, part);
    fprintf(file, "RMS slope %.4g, ", press->slope);
    print_length(file, "RMS height", press->height, report->metres);
    if (!isnan(full_contact))
        fprintf(file, "; full contact at p/(E* h') = %.4g", full_contact / press->slope);
    if (report->modulus > 0) {
        double scale;
        const char *prefix = quantity_prefix(report->modulus, &scale);
        fprintf(file, "; E* = %.4g %sPa", report->modulus / scale, prefix);
    }
    const struct coating *coating = &part->series->block.coating;
    if (coating->thickness > 0) {
        fprintf(file, "\n");
        print_length(file, "coating: thickness", coating->thickness, report->metres);
        fprintf(file, ", modulus %.4g of the block's, Poisson's ratio %.4g", coating->modulus,
                coating->poisson);
    }
    fprintf(file, "\n");
    if (part->series->note[0] != '\0')
        fprintf(file, "note: %s\n", part->series->note);
    fprintf(file, "\n");
}

/* Prints what the model alone has, by load. */
static void print_own(FILE *file, const struct part *part) {
    const struct contact_model *model = part->series->block.model;
    struct text_table table = {.columns = 1 + model->curve_count};
    if (model->curve_count == 0)
        return;
    table_cell(&table, "%s", column_of(PRESS_LOAD)->heading);
    for (size_t c = 0; c < model->curve_count; c++)
        table_cell(&table, "%s", model->curves[c].quantity);
    for (size_t l = 0; l < part->report->loads; l++) {
        const double *value = part->series->rows[l].value;
        table_number(&table, value[PRESS_LOAD]);
        for (size_t c = 0; c < model->curve_count; c++)
            table_number(&table, value[MEASURE_OWN + model->curves[c].measure]);
    }
    fprintf(file, "\nof this model alone\n\n");
    table_print(&table, file);
    table_clear(&table);
}

/* What tables for people say of a source; the others do not exist for one map. */
static const char *const SOURCE_WORDS[ERROR_SOURCES] = {
    [ERROR_DISCRETISATION] = "errors by the points: what every second point alone changes",
    [ERROR_BLOCK] = "errors by the height of the block: this less an infinite one",
    [ERROR_MODEL] = "errors by the model: this less the most complete one",
    [ERROR_SOLVER] = "errors by the solver: by its tolerance and the nodes in contact"};

static void put_error(struct text_table *table, const struct curve_error *error, size_t load) {
    double value = number_at(error->value, load), bound = number_at(error->bound, load);
    if (value != 0 && !isnan(value) && !isnan(bound))
        table_cell(table, "%+.3g +- %.2g", value, bound);
    else
        table_number(table, bound);
}

/* Prints the errors from one source, unless it bears on no column or nothing is known of it. */
static void print_errors(FILE *file, const struct part *part, enum error_source source) {
    struct text_table table = {.columns = 1};
    bool known = source == ERROR_DISCRETISATION;
    for (size_t c = 0; c < PRESS_COLUMN_COUNT; c++) {
        bool shown = is_error_printed(part, &PRESS_COLUMNS[c]);
        table.columns += shown;
        known = known || (shown && error_of(part, &PRESS_COLUMNS[c], source).value != NULL);
    }
    if (!known || SOURCE_WORDS[source] == NULL)
        return;
    table_cell(&table, "%s", column_of(PRESS_LOAD)->heading);
    for (size_t c = 0; c < PRESS_COLUMN_COUNT; c++)
        if (is_error_printed(part, &PRESS_COLUMNS[c]))
            table_cell(&table, "%s", PRESS_COLUMNS[c].heading);
    for (size_t l = 0; l < part->report->loads; l++) {
        table_number(&table, value_of(part, l, column_of(PRESS_LOAD)));
        for (size_t c = 0; c < PRESS_COLUMN_COUNT; c++)
            if (is_error_printed(part, &PRESS_COLUMNS[c])) {
                struct curve_error error = error_of(part, &PRESS_COLUMNS[c], source);
                put_error(&table, &error, l);
            }
    }
    fprintf(file, "\n%s\n\n", SOURCE_WORDS[source]);
    table_print(&table, file);
    table_clear(&table);
}

static void print_part(FILE *file, const struct part *part) {
    struct text_table table = {0};
    print_heading(file, part);
    for (size_t c = 0; c < PRESS_COLUMN_COUNT; c++)
        table.columns += is_printed(part, &PRESS_COLUMNS[c]);
    for (size_t c = 0; c < PRESS_COLUMN_COUNT; c++) {
        if (!is_printed(part, &PRESS_COLUMNS[c]))
            continue;
        if (PRESS_COLUMNS[c].fold)
            table_fold(&table);
        table_cell(&table, "%s", PRESS_COLUMNS[c].heading);
    }
    for (size_t l = 0; l < part->report->loads; l++)
        for (size_t c = 0; c < PRESS_COLUMN_COUNT; c++)
            if (is_printed(part, &PRESS_COLUMNS[c]))
                table_number(&table, value_of(part, l, &PRESS_COLUMNS[c]));
    table_print(&table, file);
    table_clear(&table);
    print_physical(file, part);
    print_own(file, part);
    press_slip_print(file, part->report, part->series);
    for (size_t s = 0; s < ERROR_SOURCES && part->report->with_errors; s++)
        print_errors(file, part, (enum error_source)s);
}

void press_print_table(FILE *file, const struct press_report *report) {
    print_preparation(file, report);
    fprintf(file, "cost: %.3g s of CPU time, %.3g MB of memory at most\n", report->cpu_seconds,
            1e-6 * report->peak_bytes);
    for (size_t m = 0; m < report->model_count; m++) {
        const struct part part = part_of(report, m);
        if (m > 0)
            fputc('\n', file);
        print_part(file, &part);
    }
}

/* --- JSON --- */

static bool add_column(cJSON *object, const char *key, const struct part *part,
                       const struct press_column *from, double scale, double *column) {
    for (size_t l = 0; l < part->report->loads; l++)
        column[l] = scale * value_of(part, l, from);
    return cJSON_AddItemToObject(object, key, json_numbers(column, part->report->loads));
}

/* Adds the bounds by the points of the columns that tables show. */
static bool add_bounds(cJSON *document, const struct part *part, double *column) {
    bool complete = true;
    for (size_t c = 0; c < PRESS_COLUMN_COUNT && complete; c++) {
        struct curve_error error = error_of(part, &PRESS_COLUMNS[c], ERROR_DISCRETISATION);
        char key[40];
        if (!is_uncertain(part->report, &PRESS_COLUMNS[c]))
            continue;
        snprintf(key, sizeof key, "%s_error", PRESS_COLUMNS[c].key);
        for (size_t l = 0; l < part->report->loads; l++)
            column[l] = number_at(error.bound, l);
        complete = cJSON_AddItemToObject(document, key, json_numbers(column, part->report->loads));
    }
    return complete;
}

/* Adds the errors of a column by source, with the members of a study's curve. */
static bool add_sources(cJSON *object, const struct part *part, const struct press_column *column) {
    size_t loads = part->report->loads;
    bool complete = object != NULL;
    for (size_t s = 0; s < ERROR_SOURCES && complete; s++) {
        const struct error_source_row *row = &ERROR_SOURCE_ROWS[s];
        struct curve_error error = error_of(part, column, (enum error_source)s);
        if (error.applies && error.value == NULL)
            complete = cJSON_AddNullToObject(object, row->key) != NULL;
        else if (error.applies)
            complete =
                cJSON_AddItemToObject(object, row->key, json_numbers(error.value, loads)) &&
                cJSON_AddItemToObject(object, row->bound_key, json_numbers(error.bound, loads));
    }
    return complete;
}

static bool add_errors(cJSON *document, const struct part *part, double *room) {
    if (!part->report->with_errors)
        return true;
    bool complete = add_bounds(document, part, room);
    cJSON *errors = cJSON_AddObjectToObject(document, "errors");
    for (size_t c = 0; c < PRESS_COLUMN_COUNT && complete; c++) {
        const struct press_column *column = &PRESS_COLUMNS[c];
        if (error_of(part, column, ERROR_SOLVER).applies)
            complete = add_sources(cJSON_AddObjectToObject(errors, column->key), part, column);
    }
    return complete && errors != NULL;
}

static bool add_physical(cJSON *document, const struct part *part, double *column) {
    const struct press_report *report = part->report;
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
                add_column(physical, columns[c].key, part, column_of(columns[c].value),
                           columns[c].scale, column);
    return complete;
}

static bool add_heading(cJSON *document, const struct press_report *report) {
    const struct preparation_record *record = report->record;
    cJSON *preparation = cJSON_AddObjectToObject(document, "preparation");
    bool complete = preparation != NULL;
    for (size_t step = 0; step < record->count && complete; step++)
        complete = cJSON_AddStringToObject(preparation, record->steps[step].name,
                                           record->steps[step].text) != NULL;
    return complete && cJSON_AddStringToObject(document, "boundary", report->boundary) &&
           cJSON_AddStringToObject(document, "boundary_by", report->boundary_by);
}

/* Adds the coating that the blocks have, if they have one. */
static bool add_coating(cJSON *document, const struct coating *coating) {
    if (!(coating->thickness > 0))
        return true;
    cJSON *out = cJSON_AddObjectToObject(document, "coating");
    return out != NULL &&
           cJSON_AddItemToObject(out, "thickness", json_number(coating->thickness)) &&
           cJSON_AddItemToObject(out, "modulus", json_number(coating->modulus)) &&
           cJSON_AddItemToObject(out, "poisson", json_number(coating->poisson));
}

static bool add_scales(cJSON *document, const struct press_report *report) {
    const struct map_press *press = report->press;
    return add_coating(document, &report->series[0].block.coating) &&
           cJSON_AddStringToObject(document, "unit", report->metres ? "m" : "") &&
           cJSON_AddItemToObject(document, "rms_slope", json_number(press->slope)) &&
           cJSON_AddItemToObject(document, "rms_height", json_number(press->height));
}

/* Adds what a mesh is like; nothing of models without one. */
static bool add_mesh(cJSON *document, const struct part *part) {
    const struct press_mesh *mesh = &part->series->mesh;
    const char *kinematics = kinematics_of(part);
    if (kinematics != NULL && cJSON_AddStringToObject(document, "kinematics", kinematics) == NULL)
        return false;
    if (mesh->nodes == 0)
        return true;
    cJSON *out = cJSON_AddObjectToObject(document, "mesh");
    return out != NULL && cJSON_AddItemToObject(out, "height", json_number(part->series->height)) &&
           cJSON_AddNumberToObject(out, "layers", (double)mesh->layers) != NULL &&
           cJSON_AddNumberToObject(out, "nodes", (double)mesh->nodes) != NULL &&
           cJSON_AddNumberToObject(out, "elements", (double)mesh->elements) != NULL &&
           cJSON_AddItemToObject(out, "steepest_slope", json_number(mesh->slope)) &&
           cJSON_AddItemToObject(out, "quality", json_number(mesh->quality));
}

/* Adds why loads have no values, where some have none. */
static bool add_note(cJSON *document, const struct part *part) {
    const char *note = part->series->note;
    return note[0] == '\0' || cJSON_AddStringToObject(document, "note", note) != NULL;
}

static bool add_part(cJSON *document, const struct part *part, double *column) {
    double full_contact = part->series->full_contact / part->report->press->slope;
    bool complete = cJSON_AddItemToObject(document, "full_contact", json_number(full_contact)) &&
                    add_mesh(document, part) && add_note(document, part);
    for (size_t c = 0; c < PRESS_COLUMN_COUNT && complete; c++)
        if (has_column(part->report, &PRESS_COLUMNS[c]))
            complete =
                add_column(document, PRESS_COLUMNS[c].key, part, &PRESS_COLUMNS[c], 1, column);
    return complete && add_errors(document, part, column) && add_physical(document, part, column) &&
           press_slip_add(document, part->report, part->series);
}

static bool add_model(cJSON *document, const struct part *part) {
    return cJSON_AddStringToObject(document, "model", part->model) != NULL;
}

/* Adds the parts of several models, each an element of a list. */
static bool add_parts(cJSON *document, const struct press_report *report, double *column) {
    cJSON *models = cJSON_AddArrayToObject(document, "models");
    bool complete = models != NULL;
    for (size_t m = 0; m < report->model_count && complete; m++) {
        const struct part part = part_of(report, m);
        cJSON *one = cJSON_CreateObject();
        complete = one != NULL && add_model(one, &part) && add_part(one, &part, column) &&
                   cJSON_AddItemToArray(models, one);
        if (!complete)
            cJSON_Delete(one);
    }
    return complete;
}

static bool add_cost(cJSON *document, const struct press_report *report) {
    return cJSON_AddNumberToObject(document, "cpu_seconds", report->cpu_seconds) != NULL &&
           cJSON_AddNumberToObject(document, "peak_bytes", report->peak_bytes) != NULL;
}

static bool fill_document(cJSON *document, const struct press_report *report, double *column) {
    const struct part first = part_of(report, 0);
    bool one = report->model_count == 1;
    return add_heading(document, report) && (!one || add_model(document, &first)) &&
           add_scales(document, report) && add_cost(document, report) &&
           (one ? add_part(document, &first, column) : add_parts(document, report, column));
}

cJSON *press_document(const struct press_report *report) {
    double *column = array_create(report->loads, sizeof *column);
    cJSON *document = column != NULL ? cJSON_CreateObject() : NULL;
    bool complete = document != NULL && fill_document(document, report, column);
    free(column);
    if (complete)
        return document;
    cJSON_Delete(document);
    return NULL;
}

/* --- curves --- */

/* Says in front of a table which map was pressed, and by which program. */
static void print_origin(FILE *file, const struct preparation_record *record) {
    static const char *const NOTES[][2] = {
        {"# map: ", "file"}, {", SHA-256 ", "sha256"}, {"; by ", "program"}};
    char steps[PREPARATION_STEPS_TEXT];
    bool any = false;
    for (size_t n = 0; n < sizeof NOTES / sizeof *NOTES; n++) {
        const char *text = preparation_text(record, NOTES[n][1]);
        if (text == NULL || (n > 0 && !any))
            continue;
        fputs(NOTES[n][0], file);
        text_print_plain(file, text);
        any = true;
    }
    preparation_steps_text(record, steps, sizeof steps);
    if (any)
        fputc('\n', file);
    if (*steps == '\0')
        return;
    fputs("# prepared: ", file);
    text_print_plain(file, steps);
    fputc('\n', file);
}

bool press_print_curves(FILE *file, const struct press_report *report, bool csv) {
    const struct study_result study = {.case_count = 1, .cases = report->result};
    const struct map_scales known = {.profile = grid_is_profile(&report->press->map),
                                     .metres = report->metres ? 1 : (double)NAN,
                                     .modulus = report->modulus > 0 ? report->modulus : (double)NAN,
                                     .resistivity = report->resistivity > 0 ? report->resistivity
                                                                            : (double)NAN,
                                     .heat = report->heat};
    units_set_of_map(report->result, &known);
    if (csv) {
        print_origin(file, report->record);
        return csv_print(file, &study);
    }
    return result_print(file, report->result) && fputc('\n', file) != EOF;
}
