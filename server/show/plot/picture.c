#include "server/show/plot/picture.h"
#include "core/file/memory_file.h"
#include "server/show/plot/plot_density.h"
#include "server/show/plot/plot_layout.h"
#include "server/show/table/case_table.h"
#include "server/show/table/sweep.h"
#include "server/show/view.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { CASES_MOST = 256 }; /* whose curves are read for one picture */

/* --- curves at hand --- */

static int draw_results(const struct study_result *study, const struct plot_request *request,
                        FILE *file, struct error *err) {
    for (size_t c = 0; c < study->case_count; c++) {
        const struct curve *density;
        int status = density_curve(&study->cases[c], request->lines.quantity, request->lines.series,
                                   &density, err);
        if (status != 0)
            return status;
        if (density != NULL)
            return plot_density(study, &study->cases[c], density, request->millimetres, file, err);
    }
    return plot_quantity(study, request, file, err);
}

int picture_of_results(const struct study_result *study, const char *quantity, FILE *file,
                       struct error *err) {
    return draw_results(study, &(struct plot_request){.lines = {.quantity = quantity}}, file, err);
}

/* --- what is drawn --- */

struct drawing {
    const struct picture_source *source;
    const struct picture_request *request;
    struct plot_request plot;
    struct case_table table; /* rows of the cases that are wanted, with their scalars; owned */
    FILE *file;
};

/* Differences have either sign, which only a linear y axis shows. */
static int check_difference(const struct picture_request *request, struct error *err) {
    if (request->case_number >= 0 || request->x != NULL || request->where != NULL)
        return error_set(err, ERROR_INPUT, "a difference takes no case, x or where");
    if (request->axes == AXES_Y || request->axes == AXES_XY || request->axes == AXES_ONE_PLUS)
        return error_set(err, ERROR_INPUT,
                         "log %s: a difference may be below 0, which a logarithmic y axis has not; "
                         "allowed: auto, none, x",
                         AXES_NAMES[request->axes]);
    return 0;
}

static int draw_difference(struct drawing *drawing, struct error *err) {
    const struct picture_request *request = drawing->request;
    const struct picture_source *source = drawing->source;
    struct study_result study = {0};
    int status = check_difference(request, err);
    if (status == 0)
        status = source->difference(source->context, request->difference, &study, err);
    if (status == 0)
        status = draw_results(&study, &drawing->plot, drawing->file, err);
    study_result_clear(&study);
    return status;
}

/* Returns the name of the table's columns, "contact_area:layered@0.1": the point with the model,
 * series and level of the request. The caller frees; NULL when out of memory. */
static char *columns_of(const struct picture_request *request) {
    const char *const words[] = {request->model, request->series, request->level};
    const char *at = strchr(request->quantity, '@');
    int length = at != NULL ? (int)(at - request->quantity) : (int)strlen(request->quantity);
    struct memory_file memory;
    if (!memory_file_open(&memory))
        return NULL;
    fprintf(memory.file, "%.*s", length, request->quantity);
    for (size_t w = 0; w < sizeof words / sizeof *words; w++)
        if (words[w] != NULL)
            fprintf(memory.file, ":%s", words[w]);
    fputs(request->quantity + length, memory.file);
    return memory_file_close(&memory, NULL);
}

static int draw_sweep(struct drawing *drawing, struct error *err) {
    const struct picture_request *request = drawing->request;
    bool place = strchr(request->quantity, '@') != NULL;
    if (request->case_number >= 0)
        return error_set(err, ERROR_INPUT,
                         "%.60s is a scalar: its picture is of all cases, or of those of where",
                         request->quantity);
    if (!place && (request->model != NULL || request->series != NULL || request->level != NULL))
        return error_set(err, ERROR_INPUT,
                         "model, series and level belong to curves, and %.60s is a scalar",
                         request->quantity);
    if (strchr(request->quantity, ',') != NULL)
        return error_set(err, ERROR_INPUT, "\"%.60s\" is more than one quantity",
                         request->quantity);
    char *columns = columns_of(request);
    if (columns == NULL)
        return error_memory(err, strlen(request->quantity), "a name");
    int status = case_table_add(&drawing->table, drawing->source, "quantity", columns, err);
    if (status == 0)
        status =
            sweep_draw(&drawing->table, columns, request->x, &drawing->plot, drawing->file, err);
    free(columns);
    return status;
}

/* --- curves --- */

/* Returns the case whose curves define what is drawn: the one asked for, or the first that has
 * begun. */
static int64_t first_case(const struct drawing *drawing) {
    const struct case_table *table = &drawing->table;
    if (drawing->request->case_number >= 0)
        return drawing->request->case_number;
    for (size_t r = 0; r < table->row_count; r++)
        if (table->rows[r]->realisations > 0 && table->rows[r]->error == NULL)
            return (int64_t)table->rows[r]->case_number;
    return table->row_count > 0 ? (int64_t)table->rows[0]->case_number : 0;
}

static int read_curves(const struct drawing *drawing, int64_t case_number,
                       struct study_result *study, struct error *err) {
    const struct result_filter filter = {.case_number = case_number,
                                         .part = {.quantity = drawing->request->quantity},
                                         .complete = true};
    return drawing->source->results(drawing->source->context, &filter, study, err);
}

/* A density has one look: what belongs to lines is refused, where it asks for another. */
static int check_density(const struct picture_request *request, struct error *err) {
    const char *const asked[][2] = {
        {"colour", request->colour},
        {"dash", request->dash},
        {"panel", request->panel},
        {"model", request->model},
        {"level", request->level},
        {"log", request->axes != AXES_AUTOMATIC ? AXES_NAMES[request->axes] : NULL},
        {"total", request->without_total ? "no" : NULL}};
    for (size_t a = 0; a < sizeof asked / sizeof *asked; a++)
        if (asked[a][1] != NULL)
            return error_set(err, ERROR_INPUT,
                             "%s %.40s belongs to lines, and %.60s is a density; allowed: case, "
                             "where, series and width",
                             asked[a][0], asked[a][1], request->quantity);
    return 0;
}

/* Draws a density, which is of one case, or of one case what was asked for; *done: it is drawn. */
static int draw_case(const struct drawing *drawing, bool *done, struct error *err) {
    struct study_result study = {0};
    int status = read_curves(drawing, first_case(drawing), &study, err);
    const struct case_result *one = study.case_count > 0 ? &study.cases[0] : NULL;
    const struct curve *density = NULL;
    if (status == 0 && one != NULL)
        status =
            density_curve(one, drawing->request->quantity, drawing->request->series, &density, err);
    if (status == 0 && density != NULL)
        status = check_density(drawing->request, err);
    *done = density != NULL || status != 0 || drawing->request->case_number >= 0;
    if (status == 0 && density != NULL)
        status = plot_density(&drawing->table.study, one, density, drawing->plot.millimetres,
                              drawing->file, err);
    else if (status == 0 && *done)
        status = plot_quantity(&study, &drawing->plot, drawing->file, err);
    study_result_clear(&study);
    return status;
}

/* Appends the cases of another result of the study, which it empties of them. */
static int take_cases(struct study_result *study, struct study_result *more, struct error *err) {
    if (study->id == NULL) {
        *study = *more;
        *more = (struct study_result){0};
        return 0;
    }
    size_t count = study->case_count + more->case_count;
    struct case_result *larger = realloc(study->cases, count * sizeof *larger);
    if (larger == NULL)
        return error_memory(err, count * sizeof *larger, "cases");
    study->cases = larger;
    memcpy(study->cases + study->case_count, more->cases, more->case_count * sizeof *larger);
    study->case_count = count;
    more->case_count = 0;
    return 0;
}

/* Reads the curves of the rows: of all cases at once where none is left out. */
static int read_rows(const struct drawing *drawing, struct study_result *study, struct error *err) {
    const struct case_table *table = &drawing->table;
    int status = 0;
    if (table->row_count > CASES_MOST)
        return error_set(
            err, ERROR_INPUT,
            "%zu cases are too many for one picture, which may have %d; name a case, or "
            "some by where",
            table->row_count, CASES_MOST);
    if (table->row_count == table->study.case_count)
        return read_curves(drawing, -1, study, err);
    for (size_t r = 0; r < table->row_count && status == 0; r++) {
        struct study_result one = {0};
        status = read_curves(drawing, (int64_t)table->rows[r]->case_number, &one, err);
        if (status == 0)
            status = take_cases(study, &one, err);
        study_result_clear(&one);
    }
    return status;
}

/* The curves' own x may be named, too. */
static int check_x(const struct drawing *drawing, struct error *err) {
    const struct quantity_table *words = view_of(drawing->table.study.kind)->table;
    const char *x = drawing->request->x;
    if (x == NULL || (words != NULL && strcmp(x, words->x) == 0))
        return 0;
    return error_set(err, ERROR_INPUT,
                     "x: curves are over their own x, and no case has a scalar \"%.60s\"; name "
                     "QUANTITY@X, a value of curves, to draw it over a parameter",
                     drawing->request->quantity);
}

static int draw_curves(struct drawing *drawing, struct error *err) {
    struct study_result study = {0};
    bool done = false;
    int status = check_x(drawing, err);
    if (status == 0)
        status = draw_case(drawing, &done, err);
    if (status != 0 || done)
        return status;
    status = read_rows(drawing, &study, err);
    if (status == 0)
        status = plot_quantity(&study, &drawing->plot, drawing->file, err);
    study_result_clear(&study);
    return status;
}

/* --- together --- */

static bool is_scalar(const struct case_table *table, const char *quantity) {
    for (size_t r = 0; r < table->row_count; r++)
        if (result_scalar(table->rows[r], quantity) != NULL)
            return true;
    return false;
}

static int draw_cases(struct drawing *drawing, struct error *err) {
    const struct picture_request *request = drawing->request;
    if (request->case_number >= 0 && request->where != NULL)
        return error_set(
            err, ERROR_INPUT,
            "case %lld and where %.60s: a picture is of one case, or of those of where",
            (long long)request->case_number, request->where[0]);
    int status = case_table_open(&drawing->table, drawing->source, request->where, err);
    if (status != 0)
        return status;
    bool sweep =
        strchr(request->quantity, '@') != NULL || is_scalar(&drawing->table, request->quantity);
    status = sweep ? draw_sweep(drawing, err) : draw_curves(drawing, err);
    case_table_clear(&drawing->table);
    return status;
}

int picture_draw(const struct picture_source *source, const struct picture_request *request,
                 FILE *file, struct error *err) {
    struct drawing drawing = {.source = source,
                              .request = request,
                              .plot = {.lines = {.quantity = request->quantity,
                                                 .model = request->model,
                                                 .series = request->series,
                                                 .level = request->level,
                                                 .names = {[CHANNEL_PANEL] = request->panel,
                                                           [CHANNEL_COLOUR] = request->colour,
                                                           [CHANNEL_DASH] = request->dash}},
                                       .axes = (enum plot_axes)request->axes,
                                       .without_total = request->without_total},
                              .file = file};
    char *end = NULL;
    if (request->level != NULL &&
        (!isfinite(strtod(request->level, &end)) || end == request->level || *end != '\0'))
        return error_set(err, ERROR_INPUT, "level: \"%.40s\" is no number", request->level);
    int status = plot_width_read(request->width, &drawing.plot.millimetres, err);
    if (status != 0)
        return status;
    return request->difference != NULL ? draw_difference(&drawing, err) : draw_cases(&drawing, err);
}
