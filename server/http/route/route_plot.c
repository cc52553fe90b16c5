/* Pictures and tables of a study of the store over HTTP. */
#include "core/file/memory_file.h"
#include "server/http/accept.h"
#include "server/http/route/route.h"
#include "server/show/plot/picture.h"
#include "server/show/plot/picture_source.h"
#include "server/show/table/case_table.h"
#include <stdlib.h>
#include <string.h>

/* --- what both are made of --- */

struct origin {
    struct exchange *exchange; /* which asks */
    const char *id;
};

static int results(const void *context, const struct result_filter *filter,
                   struct study_result *out, struct error *err) {
    const struct origin *origin = context;
    struct store *reader;
    int status = exchange_reader(origin->exchange, &reader, err);
    if (status == 0)
        status = aggregate_study(reader, origin->id, filter, out, err);
    service_give_back(origin->exchange->service, reader);
    return status;
}

static int difference(const void *context, const struct comparison *comparison,
                      struct study_result *out, struct error *err) {
    const struct origin *origin = context;
    struct store *reader;
    int status = exchange_reader(origin->exchange, &reader, err);
    if (status == 0)
        status = comparison_make(reader, origin->id, comparison, out, err);
    service_give_back(origin->exchange->service, reader);
    return status;
}

/* Borrows the origin. A reader of the store is lent for each question, until the exchange is lost.
 */
static struct picture_source origin_source(const struct origin *origin) {
    return (struct picture_source){origin, results, difference};
}

/* Draws into memory; the text is the caller's to free, NULL after a failure. */
static int draw_plot(const struct origin *origin, const struct picture_request *request,
                     char **text, struct error *err) {
    const struct picture_source source = origin_source(origin);
    struct memory_file picture;
    *text = NULL;
    if (!memory_file_open(&picture))
        return error_memory(err, 0, "a picture");
    int status = picture_draw(&source, request, picture.file, err);
    *text = memory_file_close(&picture, NULL);
    if (status == 0)
        return *text != NULL ? 0 : error_memory(err, 0, "a picture");
    free(*text);
    *text = NULL;
    return status;
}

void handle_plot(struct exchange *exchange, const char *id) {
    static const char *const TOTAL[] = {"yes", "no"};
    struct error err = {0};
    struct origin origin = {exchange, id};
    struct comparison comparison = {.quantity = exchange_query(exchange, "quantity")};
    const char *const where[] = {exchange_query(exchange, "where"), NULL};
    struct picture_request request = {.quantity = comparison.quantity,
                                      .x = exchange_query(exchange, "x"),
                                      .where = where[0] != NULL ? where : NULL,
                                      .colour = exchange_query(exchange, "colour"),
                                      .dash = exchange_query(exchange, "dash"),
                                      .panel = exchange_query(exchange, "panel"),
                                      .model = exchange_query(exchange, "model"),
                                      .series = exchange_query(exchange, "series"),
                                      .level = exchange_query(exchange, "level"),
                                      .width = exchange_query(exchange, "width"),
                                      .case_number = -1};
    bool differs = false;
    int total = 0;
    char *text;
    if (request.quantity == NULL) {
        query_refuse(exchange, "quantity", "missing: the name of curves or of a scalar");
        return;
    }
    if (!query_choice(exchange, "log", AXES_NAMES, AXES_COUNT, AXES_WORDS, &request.axes) ||
        !query_choice(exchange, "total", TOTAL, 2, "yes|no", &total))
        return;
    if (query_difference(exchange, &comparison, &differs) != 0 ||
        !query_number(exchange, "case", 0, INT64_MAX - 1, &request.case_number))
        return;
    request.without_total = total != 0;
    request.difference = differs ? &comparison : NULL;
    if (draw_plot(&origin, &request, &text, &err) == 0)
        answer_text(exchange, 200, "image/svg+xml", text);
    else
        answer_error(exchange, &err);
}

/* The table's format where the query has none: what the request likes best, JSON unless it says so.
 */
static int liked_format(const struct exchange *exchange) {
    const char *accept = exchange_header(exchange, "Accept");
    return accept_quality(accept, "text/csv") > accept_quality(accept, "application/json")
               ? TABLE_CSV
               : TABLE_JSON;
}

/* Makes the table as a text, which is the caller's to free. */
static int print_table(const struct origin *origin, const struct table_request *request, int format,
                       char **text, struct error *err) {
    const struct picture_source source = origin_source(origin);
    struct case_table table = {0};
    struct memory_file memory;
    int status = case_table_make(&table, &source, request, err);
    if (status == 0 && !memory_file_open(&memory))
        status = error_memory(err, 0, "a table");
    else if (status == 0) {
        status = case_table_print(&table, format, memory.file, err);
        *text = memory_file_close(&memory, NULL);
        if (status == 0 && *text == NULL)
            status = error_memory(err, 0, "a table");
    }
    case_table_clear(&table);
    return status;
}

void handle_table(struct exchange *exchange, const char *id) {
    static const char *const TYPES[] = {[TABLE_TEXT] = "text/plain; charset=utf-8",
                                        [TABLE_CSV] = "text/csv; charset=utf-8",
                                        [TABLE_JSON] = "application/json",
                                        [TABLE_MARKDOWN] = "text/markdown; charset=utf-8"};
    struct error err = {0};
    const struct origin origin = {exchange, id};
    const char *const where[] = {exchange_query(exchange, "where"), NULL};
    const struct table_request request = {exchange_query(exchange, "columns"), where};
    char *text = NULL;
    int format = liked_format(exchange);
    if (!query_choice(exchange, "format", TABLE_FORMAT_NAMES, TABLE_FORMAT_COUNT, TABLE_FORMATS,
                      &format))
        return;
    if (print_table(&origin, &request, format, &text, &err) != 0) {
        free(text);
        answer_error(exchange, &err);
        return;
    }
    answer_text(exchange, 200, TYPES[format], text);
    answer_header(exchange, "Vary", "Accept");
}
