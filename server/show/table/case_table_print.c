#include "core/file/memory_file.h"
#include "core/file/plain_text.h"
#include "schema/json/json.h"
#include "schema/result/provenance.h"
#include "schema/result/result_json.h"
#include "server/show/quantity.h"
#include "server/show/summary/summary_cells.h"
#include "server/show/table/case_table.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { UNIT_SIZE = 32 };

/* Returns whether a column has a number of this kind in some row; at: its offset in a value. */
static bool has_any(const struct case_table *table, const struct table_column *column, size_t at) {
    for (size_t r = 0; r < table->row_count; r++)
        if (!isnan(*(const double *)((const char *)&column->values[r] + at)))
            return true;
    return false;
}
#define HAS_ANY(table, column, member) has_any(table, column, offsetof(struct table_value, member))

/* --- text --- */

static void text_cell(struct text_table *text, const struct table_column *column,
                      const struct table_value *value) {
    const struct result_parameter *parameter = value->parameter;
    if (parameter != NULL && parameter->text != NULL)
        table_cell(text, "%.60s", parameter->text);
    else if (column->type == COLUMN_PARAMETER)
        table_number(text, value->value);
    else
        measured_cell(text, value->value, value->standard_error);
}

/* Returns what one of the unit is in which the values of a column are best read; writes it. */
static double physical_unit(const struct case_table *table, const struct table_column *column,
                            char unit[UNIT_SIZE]) {
    double most = 0;
    for (size_t r = 0; r < table->row_count; r++)
        most = fmax(most, fabs(column->values[r].physical));
    return unit_readable(column->physical, most, unit, UNIT_SIZE);
}

/* Adds a cell with the value in its physical unit, where the column has one. */
static void physical_cell(const struct case_table *table, const struct table_column *column,
                          size_t r, struct text_table *text) {
    const struct table_value *value = &column->values[r];
    char unit[UNIT_SIZE];
    if (column->physical == NULL)
        return;
    double scale = value->physical / value->value / physical_unit(table, column, unit);
    measured_cell(text, value->value * scale, value->standard_error * scale);
}

static void text_rows(const struct case_table *table, struct text_table *text) {
    char unit[UNIT_SIZE];
    table_cell(text, "case");
    table_cell(text, "n");
    for (size_t n = 0; n < table->column_count; n++) {
        if (table->columns[n].type != COLUMN_PARAMETER)
            table_fold(text);
        table_cell(text, "%s", table->columns[n].name);
        if (table->columns[n].physical != NULL) {
            (void)physical_unit(table, &table->columns[n], unit);
            table_cell(text, "in %s", unit);
        }
        if (table->columns[n].has_total)
            table_cell(text, "total %%");
    }
    for (size_t r = 0; r < table->row_count; r++) {
        table_cell(text, "%llu", (unsigned long long)table->rows[r]->case_number);
        table_cell(text, "%llu", (unsigned long long)table->rows[r]->realisations);
        for (size_t n = 0; n < table->column_count; n++) {
            const struct table_column *column = &table->columns[n];
            text_cell(text, column, &column->values[r]);
            physical_cell(table, column, r, text);
            if (column->has_total)
                total_cell(text, column->values[r].value, &column->values[r].total);
        }
    }
}

/* What a column is: "mean_gap@0.1: mean gap/sqrt(m0) at p/(E* h'); errors other than statistical up
 * to 0.2
 * %".
 */
static void put_legend(const struct case_table *table, const struct table_column *column,
                       FILE *file) {
    double largest = NAN, law = NAN;
    for (size_t r = 0; r < table->row_count; r++) {
        const struct table_value *value = &column->values[r];
        largest = fmax(largest, value->error / fabs(value->value));
        law = fmax(law, fabs(value->law_difference / value->value));
    }
    bool told = largest > 0 && isfinite(largest), curve = column->quantity != NULL;
    if (!told && column->unit == NULL && !(law > 0))
        return;
    fprintf(file, "%s:", column->name);
    if (column->unit != NULL)
        fprintf(file, " %s", column->unit);
    if (curve)
        fprintf(file, "%s%s at %s", *column->series != '\0' ? ", " : "", column->series,
                column->x_label);
    if (told)
        fprintf(file, "%s errors other than statistical up to %.2g %%",
                column->unit != NULL ? ";" : "", 100 * largest);
    if (law > 0)
        fprintf(file, "%s the other law of heights up to %.2g %% off",
                told || column->unit != NULL ? ";" : "", 100 * law);
}

static void text_legend(const struct case_table *table, const struct table_column *column,
                        FILE *file) {
    struct memory_file memory;
    if (!memory_file_open(&memory)) {
        fputs("(no memory for what columns are)\n", file);
        return;
    }
    put_legend(table, column, memory.file);
    char *text = memory_file_close(&memory, NULL);
    if (text != NULL && *text != '\0')
        print_folded(file, text);
    free(text);
}

/* Names the sources that are not known of some value, by column. */
static void text_unknown(const struct case_table *table, FILE *file) {
    struct unknown_of *list = array_create(table->column_count + 1, sizeof *list);
    size_t count = 0;
    if (list == NULL) {
        fputs("(no memory for what is not known)\n", file);
        return;
    }
    for (size_t n = 0; n < table->column_count; n++) {
        const struct table_column *column = &table->columns[n];
        if (column->type == COLUMN_PARAMETER)
            continue;
        list[count].name = column->name;
        memcpy(list[count++].unknown, column->unknown, sizeof column->unknown);
    }
    print_unknown_of(count, list, NULL, file);
    free(list);
}

/* Prints the rows with a heading; returns whether a column has total errors. */
static bool print_rows(const struct case_table *table, bool markdown, FILE *file) {
    struct text_table text = {
        .columns = 2 + table->column_count, .room = TABLE_ROOM, .markdown = markdown};
    bool total = false;
    for (size_t n = 0; n < table->column_count; n++) {
        const struct table_column *column = &table->columns[n];
        text.columns += (size_t)(column->physical != NULL) + column->has_total;
        total = total || column->has_total;
    }
    text_rows(table, &text);
    table_print(&text, file);
    table_clear(&text);
    return total;
}

void case_table_markdown(const struct case_table *table, FILE *file) {
    (void)print_rows(table, true, file);
}

void case_table_text(const struct case_table *table, FILE *file) {
    text_print_plain(file, table->study.name);
    fprintf(file, " (%s), study %s\n\n", table->study.state, table->study.id);
    bool total = print_rows(table, false, file);
    fputs("\nn: realisations; +-: one standard error\n", file);
    if (total)
        print_total_legend(file);
    for (size_t n = 0; n < table->column_count; n++)
        text_legend(table, &table->columns[n], file);
    text_unknown(table, file);
    for (size_t r = 0; r < table->row_count; r++)
        if (table->rows[r]->error != NULL) {
            fputs("no results: ", file);
            text_print_plain(file, table->rows[r]->error);
            fputc('\n', file);
        }
}

/* --- CSV --- */

static void csv_text(FILE *file, const char *text) {
    fputc('"', file);
    for (; *text != '\0'; text++)
        fprintf(file, *text == '"' ? "\"\"" : "%c", *text);
    fputc('"', file);
}

static void csv_number(FILE *file, double number) {
    fputc(',', file);
    if (isfinite(number))
        json_print_number(file, number);
}

static void csv_heading(const struct case_table *table, FILE *file) {
    fputs("case,realisations", file);
    for (size_t n = 0; n < table->column_count; n++) {
        const struct table_column *column = &table->columns[n];
        fprintf(file, ",%s", column->name);
        if (column->type == COLUMN_PARAMETER)
            continue;
        fprintf(file, ",%s_standard_error,%s_error", column->name, column->name);
        if (HAS_ANY(table, column, theory))
            fprintf(file, ",%s_theory", column->name);
        if (HAS_ANY(table, column, law_difference))
            fprintf(file, ",%s_law_difference,%s_law_standard_error", column->name, column->name);
        if (column->physical != NULL)
            fprintf(file, ",%s in %s", column->name, column->physical);
        fprintf(file, ",%s_total_low,%s_total_high", column->name, column->name);
    }
    fputc('\n', file);
}

bool case_table_csv(const struct case_table *table, FILE *file) {
    provenance_comment(file, &table->study);
    csv_heading(table, file);
    for (size_t r = 0; r < table->row_count; r++) {
        fprintf(file, "%llu,%llu", (unsigned long long)table->rows[r]->case_number,
                (unsigned long long)table->rows[r]->realisations);
        for (size_t n = 0; n < table->column_count; n++) {
            const struct table_column *column = &table->columns[n];
            const struct table_value *value = &column->values[r];
            csv_number(file, value->value);
            if (value->parameter != NULL && value->parameter->text != NULL)
                csv_text(file, value->parameter->text);
            if (column->type == COLUMN_PARAMETER)
                continue;
            csv_number(file, value->standard_error);
            csv_number(file, value->error);
            if (HAS_ANY(table, column, theory))
                csv_number(file, value->theory);
            if (HAS_ANY(table, column, law_difference)) {
                csv_number(file, value->law_difference);
                csv_number(file, value->law_standard_error);
            }
            if (column->physical != NULL)
                csv_number(file, value->physical);
            csv_number(file, value->total.low);
            csv_number(file, value->total.high);
        }
        fputc('\n', file);
    }
    return true;
}

/* --- JSON --- */

static bool put_member(FILE *file, const char *key, const char *text) {
    if (text == NULL)
        return true;
    fprintf(file, ",\"%s\":", key);
    return json_print_text(file, text);
}

static bool print_column(const struct table_column *column, FILE *file) {
    static const char *const TYPES[] = {"parameter", "scalar", "curve"};
    fputs("{\"name\":", file);
    bool done =
        json_print_text(file, column->name) && put_member(file, "type", TYPES[column->type]) &&
        put_member(file, "pointer", column->pointer) &&
        put_member(file, "quantity", column->quantity) &&
        put_member(file, "series", column->series) && put_member(file, "model", column->model) &&
        put_member(file, "x_label", column->x_label);
    if (!isnan(column->x)) {
        fputs(",\"x\":", file);
        json_print_number(file, column->x);
    }
    fputs(",\"unit\":", file);
    if (column->unit == NULL)
        fputs("null", file);
    else
        done = done && json_print_text(file, column->unit);
    done = done && put_member(file, "physical_unit", column->physical);
    bool first = true;
    for (size_t s = 0; s < UNKNOWN_SOURCES && column->type != COLUMN_PARAMETER; s++)
        if (column->unknown[s]) {
            fprintf(file, "%s\"%s\"", first ? ",\"unknown\":[" : ",", unknown_source_name(s));
            first = false;
        }
    fputs(first ? "}" : "]}", file);
    return done;
}

/* Prints one number of every value of a row; parameters have a value alone. */
static bool print_members(const struct case_table *table, size_t r, size_t at, FILE *file) {
    bool done = true;
    for (size_t n = 0; n < table->column_count && done; n++) {
        const struct table_value *value = &table->columns[n].values[r];
        const struct result_parameter *parameter = value->parameter;
        bool text = parameter != NULL && parameter->text != NULL &&
                    at == offsetof(struct table_value, value);
        fputc(n > 0 ? ',' : '[', file);
        if (text && (parameter->list || parameter->flag))
            fputs(parameter->text, file);
        else if (text)
            done = json_print_text(file, parameter->text);
        else
            json_print_number(file, *(const double *)((const char *)value + at));
    }
    fputs(table->column_count > 0 ? "]" : "[]", file);
    return done;
}

enum { LAW_MEMBERS = 2 };

static bool has_law(const struct case_table *table) {
    bool any = false;
    for (size_t n = 0; n < table->column_count; n++)
        any = any || (table->columns[n].type != COLUMN_PARAMETER &&
                      HAS_ANY(table, &table->columns[n], law_difference));
    return any;
}

static bool has_physical(const struct case_table *table) {
    bool any = false;
    for (size_t n = 0; n < table->column_count; n++)
        any = any || table->columns[n].physical != NULL;
    return any;
}

static bool print_row(const struct case_table *table, size_t r, FILE *file) {
    static const struct {
        const char *key;
        size_t at;
    } MEMBERS[] = {{"values", offsetof(struct table_value, value)},
                   {"standard_errors", offsetof(struct table_value, standard_error)},
                   {"errors", offsetof(struct table_value, error)},
                   {"theory", offsetof(struct table_value, theory)},
                   {"total_low", offsetof(struct table_value, total.low)},
                   {"total_high", offsetof(struct table_value, total.high)},
                   /* where some case has one */
                   {"law_differences", offsetof(struct table_value, law_difference)},
                   {"law_standard_errors", offsetof(struct table_value, law_standard_error)}};
    bool done = true;
    fprintf(file, "{\"case\":%llu,\"realisations\":%llu",
            (unsigned long long)table->rows[r]->case_number,
            (unsigned long long)table->rows[r]->realisations);
    size_t members = sizeof MEMBERS / sizeof *MEMBERS - (has_law(table) ? 0 : LAW_MEMBERS);
    for (size_t m = 0; m < members && done; m++) {
        fprintf(file, ",\"%s\":", MEMBERS[m].key);
        done = print_members(table, r, MEMBERS[m].at, file);
    }
    if (done && has_physical(table)) {
        fputs(",\"physical\":", file);
        done = print_members(table, r, offsetof(struct table_value, physical), file);
    }
    done = done && result_print_error(file, table->rows[r]);
    fputc('}', file);
    return done;
}

bool case_table_json(const struct case_table *table, FILE *file) {
    bool done = study_print_about(file, &table->study);
    fputs(",\"columns\":[", file);
    for (size_t n = 0; n < table->column_count && done; n++) {
        fputs(n > 0 ? "," : "", file);
        done = print_column(&table->columns[n], file);
    }
    fputs("],\"rows\":[", file);
    for (size_t r = 0; r < table->row_count && done; r++) {
        fputs(r > 0 ? "," : "", file);
        done = print_row(table, r, file);
    }
    fputs("]}", file);
    return done;
}

const char *const TABLE_FORMAT_NAMES[TABLE_FORMAT_COUNT] = {[TABLE_TEXT] = "text",
                                                            [TABLE_CSV] = "csv",
                                                            [TABLE_JSON] = "json",
                                                            [TABLE_MARKDOWN] = "markdown"};

int case_table_print(const struct case_table *table, int format, FILE *file, struct error *err) {
    bool done = true;
    if (format == TABLE_JSON)
        done = case_table_json(table, file) && fputc('\n', file) != EOF;
    else if (format == TABLE_CSV)
        done = case_table_csv(table, file);
    else if (format == TABLE_MARKDOWN)
        case_table_markdown(table, file);
    else
        case_table_text(table, file);
    return done || ferror(file) != 0 ? 0 : error_memory(err, 0, "a table");
}
