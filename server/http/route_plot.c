/* Pictures of results over HTTP. */
#include "core/memory_file.h"
#include "server/http/origin.h"
#include "server/http/route.h"
#include "server/show/picture.h"
#include <stdlib.h>
#include <string.h>

/* Draws into memory; the text is the caller's to free, NULL after a failure. */
static int draw(const struct origin *origin, const struct picture_request *request, char **text,
                struct error *err) {
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

static void refuse_without_quantity(struct exchange *exchange) {
    struct fault_list faults = {0};
    fault_add(&faults, "?quantity", "missing: the name of curves or of a scalar");
    answer_problem(exchange, 422, "the query is not valid", &faults);
    fault_list_clear(&faults);
}

/* Reads ?log=; false after a 422. */
static bool read_axes(struct exchange *exchange, int *axes) {
    static const char *const NAMES[] = {[AXES_AUTOMATIC] = "auto",
                                        [AXES_LINEAR] = "none",
                                        [AXES_X] = "x",
                                        [AXES_Y] = "y",
                                        [AXES_XY] = "xy"};
    const char *asked = exchange_query(exchange, "log");
    struct fault_list faults = {0};
    for (int a = AXES_AUTOMATIC; asked != NULL && a <= AXES_XY; a++)
        if (strcmp(NAMES[a], asked) == 0) {
            *axes = a;
            return true;
        }
    if (asked == NULL)
        return true;
    fault_add(&faults, "?log", "%.40s is none of " AXES_WORDS, asked);
    answer_problem(exchange, 422, "the query is not valid", &faults);
    fault_list_clear(&faults);
    return false;
}

void handle_plot(struct exchange *exchange, const char *id) {
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
    char *text;
    if (request.quantity == NULL) {
        refuse_without_quantity(exchange);
        return;
    }
    if (!read_axes(exchange, &request.axes))
        return;
    if (query_difference(exchange, &comparison, &differs) != 0 ||
        !query_number(exchange, "case", 0, INT64_MAX - 1, &request.case_number))
        return;
    request.difference = differs ? &comparison : NULL;
    if (draw(&origin, &request, &text, &err) == 0)
        answer_text(exchange, 200, "image/svg+xml", text);
    else
        answer_error(exchange, &err);
}
