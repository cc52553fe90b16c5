/* The cases of a study as a table over HTTP. */
#include "core/memory_file.h"
#include "server/http/accept.h"
#include "server/http/origin.h"
#include "server/http/route.h"
#include "server/show/case_table.h"
#include <stdlib.h>
#include <string.h>

/* Reads ?format=, or else what the request likes best: JSON, unless it says so. -1 after a 422. */
static int read_format(struct exchange *exchange) {
    static const char *const NAMES[] = {
        [TABLE_TEXT] = "text", [TABLE_CSV] = "csv", [TABLE_JSON] = "json"};
    const char *asked = exchange_query(exchange, "format");
    const char *accept = exchange_header(exchange, "Accept");
    struct fault_list faults = {0};
    for (int f = 0; asked != NULL && f <= TABLE_JSON; f++)
        if (strcmp(NAMES[f], asked) == 0)
            return f;
    if (asked == NULL)
        return accept_quality(accept, "text/csv") > accept_quality(accept, "application/json")
                   ? TABLE_CSV
                   : TABLE_JSON;
    fault_add(&faults, "?format", "%.40s is none of " TABLE_FORMATS, asked);
    answer_problem(exchange, 422, "the query is not valid", &faults);
    fault_list_clear(&faults);
    return -1;
}

/* Makes the table as a text, which is the caller's to free. */
static int print(const struct origin *origin, const struct table_request *request, int format,
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
                                        [TABLE_JSON] = "application/json"};
    struct error err = {0};
    const struct origin origin = {exchange, id};
    const char *const where[] = {exchange_query(exchange, "where"), NULL};
    const struct table_request request = {exchange_query(exchange, "columns"), where};
    char *text = NULL;
    int format = read_format(exchange);
    if (format < 0)
        return;
    if (print(&origin, &request, format, &text, &err) != 0) {
        free(text);
        answer_error(exchange, &err);
        return;
    }
    answer_text(exchange, 200, TYPES[format], text);
    answer_header(exchange, "Vary", "Accept");
}
