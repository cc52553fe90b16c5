/* The query of a request is checked for what it may hold, and numbers are read from it; its body is
 * read as JSON. */
#include "schema/near_name.h"
#include "server/http/route/route.h"
#include <errno.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct query {
    const char *const *names;
    bool seen[QUERY_NAMES_MOST];
    struct fault_list faults;
};

/* Says which name was likely meant, or which there may be. */
static void refuse_name(struct query *query, const char *pointer, const char *name) {
    struct near_name near = {.typed = name};
    char hint[NEAR_HINT_SIZE], allowed[400] = "";
    for (size_t n = 0; n < QUERY_NAMES_MOST && query->names[n] != NULL; n++) {
        size_t used = strlen(allowed);
        snprintf(allowed + used, sizeof allowed - used, "%s%s",
                 n > 0 ? ", " : "; allowed: ", query->names[n]);
        near_name_see(&near, query->names[n]);
    }
    fault_add(&query->faults, pointer, "unknown name%s",
              near.name != NULL  ? near_name_hint(&near, hint)
              : *allowed != '\0' ? allowed
                                 : "; none is allowed here");
}

static enum MHD_Result check_parameter(void *context, enum MHD_ValueKind kind, const char *name,
                                       const char *value) {
    struct query *query = context;
    char pointer[48];
    size_t n = 0;
    (void)kind;
    snprintf(pointer, sizeof pointer, "?%.40s", name);
    while (n < QUERY_NAMES_MOST && query->names[n] != NULL && strcmp(query->names[n], name) != 0)
        n++;
    if (n == QUERY_NAMES_MOST || query->names[n] == NULL)
        refuse_name(query, pointer, name);
    else if (query->seen[n])
        fault_add(&query->faults, pointer, "given twice");
    else if (value == NULL)
        fault_add(&query->faults, pointer, "no value");
    else
        query->seen[n] = true;
    return MHD_YES;
}

static bool answered(struct exchange *exchange, struct fault_list *faults) {
    if (faults->count != 0)
        answer_problem(exchange, 422, "the query is not valid", faults);
    fault_list_clear(faults);
    return exchange->status != 0;
}

bool query_check(struct exchange *exchange, const char *const names[QUERY_NAMES_MOST]) {
    struct query query = {.names = names};
    MHD_get_connection_values(exchange->connection, MHD_GET_ARGUMENT_KIND, check_parameter, &query);
    return !answered(exchange, &query.faults);
}

void query_refuse(struct exchange *exchange, const char *name, const char *format, ...) {
    struct fault_list faults = {0};
    char pointer[32], detail[160];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(detail, sizeof detail, format, arguments);
    va_end(arguments);
    snprintf(pointer, sizeof pointer, "?%.20s", name);
    fault_add(&faults, pointer, "%s", detail);
    (void)answered(exchange, &faults);
}

bool query_choice(struct exchange *exchange, const char *name, const char *const *choices,
                  int count, const char *words, int *out) {
    const char *text = exchange_query(exchange, name);
    int n = 0;
    if (text == NULL)
        return true;
    while (n < count && strcmp(choices[n], text) != 0)
        n++;
    if (n < count)
        *out = n;
    else
        query_refuse(exchange, name, "%.40s is none of %s", text, words);
    return n < count;
}

bool query_number(struct exchange *exchange, const char *name, int64_t least, int64_t most,
                  int64_t *value) {
    const char *text = exchange_query(exchange, name);
    char *end;
    if (text == NULL)
        return true;
    errno = 0;
    long long number = strtoll(text, &end, 10);
    bool digits = strspn(text, "-0123456789") == strlen(text);
    if (errno == 0 && end != text && *end == '\0' && digits && number >= least && number <= most) {
        *value = number;
        return true;
    }
    query_refuse(exchange, name, "%.40s is not in [%lld, %lld]", text, (long long)least,
                 (long long)most);
    return false;
}

bool query_true(struct exchange *exchange, const char *name, const char *purpose) {
    const char *text = exchange_query(exchange, name);
    if (text == NULL || strcmp(text, "true") == 0)
        return true;
    query_refuse(exchange, name, "?%s is true, %s, or left out", name, purpose);
    return false;
}

bool check_body(struct exchange *exchange) {
    if (exchange->body == NULL)
        answer_problem(exchange, 400, "a JSON body is needed", NULL);
    return exchange->body != NULL;
}

cJSON *body_json(struct exchange *exchange) {
    struct error err = {0};
    cJSON *document = NULL;
    if (!check_body(exchange))
        return NULL;
    if (json_parse(exchange->body, exchange->body_size, NULL, &document, &err) != 0) {
        unsigned status = err.code == ERROR_INPUT ? 400 : 503;
        answer_problem(exchange, status, err.text, NULL);
        return NULL;
    }
    return document;
}
