#include "server/output.h"
#include "schema/json.h"
#include "server/document.h"
#include "server/plot.h"
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

/* Columns x[, x2], y, standard_error and each theory; a matrix has a line a cell. */
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

enum { THEORIES_MOST = 8 };

static size_t curve_columns(const cJSON *curve, const cJSON **columns, FILE *file) {
    size_t count = 0;
    columns[count++] = member(curve, "y");
    columns[count++] = member(curve, "standard_error");
    fprintf(file, "x%s,y,standard_error", member(curve, "x2") ? ",x2" : "");
    const cJSON *theory = member(curve, "theory");
    for (const cJSON *t = theory ? theory->child : NULL; t && count < 2 + THEORIES_MOST;
         t = t->next) {
        columns[count++] = t;
        fprintf(file, ",%s", t->string);
    }
    fputc('\n', file);
    for (size_t c = 0; c < count; c++)
        columns[c] = columns[c] ? columns[c]->child : NULL;
    return count;
}

static void advance(const cJSON **columns, size_t count) {
    for (size_t c = 0; c < count; c++)
        columns[c] = columns[c] ? columns[c]->next : NULL;
}

static void write_matrix_row(FILE *file, const cJSON *x, const cJSON *curve,
                             const cJSON *const *columns, size_t count) {
    const cJSON *cells[2 + THEORIES_MOST];
    for (size_t c = 0; c < count; c++)
        cells[c] = columns[c] ? columns[c]->child : NULL;
    const cJSON *x2 = member(curve, "x2");
    for (x2 = x2 ? x2->child : NULL; x2; x2 = x2->next, advance(cells, count))
        write_row(file, x, x2, cells, count);
}

static void write_curve(FILE *file, const cJSON *curve) {
    const cJSON *columns[2 + THEORIES_MOST];
    size_t count = curve_columns(curve, columns, file);
    const cJSON *x = member(curve, "x");
    for (x = x ? x->child : NULL; x; x = x->next, advance(columns, count)) {
        if (cJSON_IsArray(columns[0]))
            write_matrix_row(file, x, curve, columns, count);
        else
            write_row(file, x, NULL, columns, count);
    }
}

/* "case-3-contact_area-edges-layered-8.csv" */
static void curve_name(const cJSON *one, const cJSON *curve, char *name, size_t size) {
    const cJSON *level = member(curve, "level");
    int used = snprintf(name, size, "case-%.0f-%.60s", member(one, "case")->valuedouble,
                        text_of(curve, "quantity", ""));
    static const char *const PARTS[] = {"series", "model"};
    for (size_t p = 0; p < 2; p++)
        if (*text_of(curve, PARTS[p], ""))
            used +=
                snprintf(name + used, size - (size_t)used, "-%.40s", text_of(curve, PARTS[p], ""));
    if (cJSON_IsNumber(level))
        used += snprintf(name + used, size - (size_t)used, "-%g", level->valuedouble);
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

/* One plot for each quantity of the first case that is no matrix. */
static int write_plots(const cJSON *curves, const char *folder, struct error *err) {
    const cJSON *first = member(curves, "cases");
    const cJSON *list = first && first->child ? member(first->child, "curves") : NULL;
    const char *last = "";
    int status = 0;
    for (const cJSON *curve = list ? list->child : NULL; !status && curve; curve = curve->next) {
        const char *quantity = text_of(curve, "quantity", "");
        char name[128];
        FILE *file;
        if (member(curve, "x2") || strcmp(quantity, last) == 0)
            continue;
        last = quantity;
        snprintf(name, sizeof name, "%.100s.svg", quantity);
        status = open_file(&file, folder, name, err);
        if (status)
            break;
        status = plot_quantity(curves, quantity, file, err);
        int closed = close_file(file, folder, name, err);
        status = status ? status : closed;
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
