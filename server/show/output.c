#include "server/show/output.h"
#include "schema/json/json.h"
#include "server/show/document.h"
#include "server/show/plot.h"
#include <errno.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

enum { PATH_SIZE = 4096 };

/* A file of the folder, closed with a check: a full disk shows at the end. */
static int open_file(FILE **file, const char *folder, const char *name, struct error *err) {
    char path[PATH_SIZE];
    if (snprintf(path, sizeof path, "%s/%s", folder, name) >= (int)sizeof path)
        return error_set(err, ERROR_INPUT, "the path %.100s... is too long", folder);
    *file = fopen(path, "w");
    return *file ? 0 : error_set(err, ERROR_SYSTEM, "%s: %s", path, strerror(errno));
}

static int close_file(FILE *file, const char *folder, const char *name, struct error *err) {
    bool failed = ferror(file);
    if (fclose(file) || failed)
        return error_set(err, ERROR_SYSTEM, "%s/%s: %s", folder, name, strerror(errno));
    return 0;
}

static int write_json(const cJSON *curves, const char *folder, struct error *err) {
    FILE *file;
    char *text = json_print(curves);
    int status = text ? open_file(&file, folder, "curves.json", err)
                      : error_memory(err, 0, "a document of curves");
    if (!status) {
        fprintf(file, "%s\n", text);
        status = close_file(file, folder, "curves.json", err);
    }
    free(text);
    return status;
}

static void print_number(FILE *file, const cJSON *value) {
    if (value && cJSON_IsNumber(value))
        fprintf(file, "%.17g", value->valuedouble);
}

/* Columns x[, x2], the values, and each theory; a matrix has a line a cell. */
static void write_row(FILE *file, const cJSON *x, const cJSON *x2, const cJSON *const *columns,
                      size_t count) {
    print_number(file, x);
    if (x2) {
        fputc(',', file);
        print_number(file, x2);
    }
    for (size_t c = 0; c < count; c++) {
        fputc(',', file);
        print_number(file, columns[c]);
    }
    fputc('\n', file);
}

enum { VALUES_MOST = 5, THEORIES_MOST = 8, COLUMNS_MOST = VALUES_MOST + THEORIES_MOST };

/* All but the first two only where the curve has them. */
static size_t curve_columns(const cJSON *curve, const cJSON **columns, FILE *file) {
    static const char *const VALUES[VALUES_MOST] = {"y", "standard_error", "discretisation_error",
                                                    "model_error", "valueless"};
    size_t count = 0;
    fprintf(file, "x%s", member(curve, "x2") ? ",x2" : "");
    for (size_t v = 0; v < VALUES_MOST; v++)
        if (v < 2 || cJSON_IsArray(member(curve, VALUES[v]))) {
            columns[count++] = first_of(curve, VALUES[v]);
            fprintf(file, ",%s", VALUES[v]);
        }
    const cJSON *t = first_of(curve, "theory");
    for (; t && count < COLUMNS_MOST; t = t->next) {
        columns[count++] = t->child;
        fprintf(file, ",%s", t->string);
    }
    fputc('\n', file);
    return count;
}

static void advance(const cJSON **columns, size_t count) {
    for (size_t c = 0; c < count; c++)
        columns[c] = columns[c] ? columns[c]->next : NULL;
}

static void write_matrix_row(FILE *file, const cJSON *x, const cJSON *curve,
                             const cJSON *const *columns, size_t count) {
    const cJSON *cells[COLUMNS_MOST];
    for (size_t c = 0; c < count; c++)
        cells[c] = columns[c] ? columns[c]->child : NULL;
    for (const cJSON *x2 = first_of(curve, "x2"); x2; x2 = x2->next, advance(cells, count))
        write_row(file, x, x2, cells, count);
}

static void write_curve(FILE *file, const cJSON *curve) {
    const cJSON *columns[COLUMNS_MOST];
    size_t count = curve_columns(curve, columns, file);
    for (const cJSON *x = first_of(curve, "x"); x; x = x->next, advance(columns, count)) {
        if (cJSON_IsArray(columns[0]))
            write_matrix_row(file, x, curve, columns, count);
        else
            write_row(file, x, NULL, columns, count);
    }
}

/* "case-3-contact_area-edges-full-hencky-8.csv" */
static void curve_name(const cJSON *one, const cJSON *curve, char *name, size_t size) {
    const cJSON *level = member(curve, "level");
    int used = snprintf(name, size, "case-%.0f-%.60s", member(one, "case")->valuedouble,
                        text_of(curve, "quantity", ""));
    static const char *const PARTS[] = {"series", "model", "kinematics"};
    for (size_t p = 0; p < sizeof PARTS / sizeof *PARTS; p++)
        if (*text_of(curve, PARTS[p], ""))
            used +=
                snprintf(name + used, size - (size_t)used, "-%.40s", text_of(curve, PARTS[p], ""));
    if (cJSON_IsNumber(level))
        used += snprintf(name + used, size - (size_t)used, "-%g", level->valuedouble);
    if (cJSON_IsNumber(member(curve, "pressure")))
        used += snprintf(name + used, size - (size_t)used, "-at-%g", number_of(curve, "pressure"));
    snprintf(name + used, size - (size_t)used, ".csv");
}

static int write_case(const cJSON *one, const char *folder, struct error *err) {
    const cJSON *list = member(one, "curves");
    int status = 0;
    for (const cJSON *curve = list ? list->child : NULL; !status && curve; curve = curve->next) {
        char name[256];
        FILE *file;
        curve_name(one, curve, name, sizeof name);
        status = open_file(&file, folder, name, err);
        if (status)
            break;
        write_curve(file, curve);
        status = close_file(file, folder, name, err);
    }
    return status;
}

static int write_plot(const cJSON *curves, const struct plot_request *request, const char *folder,
                      const char *name, struct error *err) {
    FILE *file;
    int status = open_file(&file, folder, name, err);
    if (status)
        return status;
    status = plot_quantity(curves, request, file, err);
    int closed = close_file(file, folder, name, err);
    return status ? status : closed;
}

/* A quantity in several units (patches in the cell, patches per wave) takes a picture each, the
 * first one under the quantity's own name. The contact area has a second one that shows light
 * loads. */
static int write_plots_of(const cJSON *curves, const cJSON *curve, bool first_unit,
                          const char *folder, struct error *err) {
    struct plot_request request = {.quantity = text_of(curve, "quantity", ""),
                                   .y_label = text_of(curve, "y_label", "")};
    char name[192];
    snprintf(name, sizeof name, "%.100s%s%.60s.svg", request.quantity, first_unit ? "" : "-",
             first_unit ? "" : text_of(curve, "series", ""));
    int status = write_plot(curves, &request, folder, name, err);
    if (!status && strcmp(request.quantity, "contact_area") == 0) {
        request.logarithmic = true;
        status = write_plot(curves, &request, folder, "contact_area-light.svg", err);
    }
    return status;
}

static bool same_text(const cJSON *a, const cJSON *b, const char *name) {
    return strcmp(text_of(a, name, ""), text_of(b, name, "")) == 0;
}

/* The quantities of the first case that has begun; no matrices. */
static int write_plots(const cJSON *curves, const char *folder, struct error *err) {
    const cJSON *one = first_of(curves, "cases");
    while (one && one->next && !first_of(one, "curves"))
        one = one->next;
    const cJSON *list = first_of(one, "curves");
    int status = 0;
    for (const cJSON *curve = list; !status && curve; curve = curve->next) {
        bool first_unit = true, drawn = member(curve, "x2") != NULL;
        for (const cJSON *other = list; other != curve; other = other->next)
            if (same_text(other, curve, "quantity")) {
                first_unit = false;
                drawn = drawn || same_text(other, curve, "y_label");
            }
        if (!drawn)
            status = write_plots_of(curves, curve, first_unit, folder, err);
    }
    return status;
}

int output_write(const cJSON *curves, const char *folder, struct error *err) {
    if (mkdir(folder, 0777) && errno != EEXIST)
        return error_set(err, ERROR_SYSTEM, "folder %s: %s", folder, strerror(errno));
    const cJSON *cases = member(curves, "cases");
    int status = write_json(curves, folder, err);
    for (const cJSON *one = cases ? cases->child : NULL; !status && one; one = one->next)
        status = write_case(one, folder, err);
    return status ? status : write_plots(curves, folder, err);
}
