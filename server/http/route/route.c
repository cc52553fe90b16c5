/* Who may ask for what, and who answers. */
#include "server/http/route/route.h"
#include "worker/link/header_names.h"
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

static const struct route ROUTES[] = {
    {"POST", "/v1/studies", ROLE_SUBMIT, handle_study_create, {NULL}},
    {"GET", "/v1/studies", ROLE_READ, handle_study_list, {"limit", "after"}},
    {"GET", "/v1/studies/*", ROLE_READ, handle_study, {"unique"}},
    {"DELETE", "/v1/studies/*", ROLE_SUBMIT, handle_study_cancel, {"results"}},
    {"GET", "/v1/studies/*/study", ROLE_READ, handle_document, {NULL}},
    {"POST", "/v1/studies/*/retry", ROLE_SUBMIT, handle_study_retry, {NULL}},
    {"POST", "/v1/studies/*/extend", ROLE_SUBMIT, handle_study_extend, {NULL}},
    {"GET", "/v1/studies/*/curves", ROLE_READ, handle_curves, {"case", "quantity", "difference"}},
    {"GET", "/v1/studies/*/report", ROLE_READ, handle_report, {NULL}},
    {"GET",
     "/v1/studies/*/plot",
     ROLE_READ,
     handle_plot,
     {"quantity", "where", "x", "colour", "dash", "panel", "model", "series", "level", "log",
      "total", "width", "case", "difference"}},
    {"GET", "/v1/studies/*/table", ROLE_READ, handle_table, {"columns", "where", "format"}},
    {"GET", "/v1/studies/*/events", ROLE_READ, handle_events, {NULL}},
    {"GET", "/v1/studies/*/contents", ROLE_READ, handle_contents, {NULL}},
    {"GET", "/v1/studies/*/cases/*/realisations/*/map", ROLE_READ, handle_map, {"field", "load"}},
    {"GET",
     "/v1/studies/*/cases/*/realisations/*/nodes",
     ROLE_READ,
     handle_nodes,
     {"model", "load", "format"}},
    {"POST",
     "/v1/characterise",
     ROLE_READ,
     handle_characterise,
     {"name",   "layer",    "columns",    "dx",          "unit",    "z_unit",     "missing",
      "crop",   "stride",   "lines",      "lines_along", "despike", "deconvolve", "transpose",
      "rotate", "detrend",  "degroove",   "fill",        "denoise", "filter",     "resample",
      "window", "boundary", "trust_from", "trust_to",    "hold",    "together",   "format"}},
    {"POST", "/v1/check", ROLE_SUBMIT, handle_check, {NULL}},
    {"GET", "/v1/templates", ROLE_NONE, handle_templates, {NULL}},
    {"GET", "/v1/workers", ROLE_READ, handle_workers, {NULL}},
    {"POST", "/v1/jobs/claim", ROLE_WORK, handle_claim, {NULL}},
    {"POST", "/v1/jobs/report", ROLE_WORK, handle_report_many, {NULL}},
    {"POST", "/v1/jobs/*/heartbeat", ROLE_WORK, handle_heartbeat, {NULL}},
    {"POST", "/v1/jobs/*/complete", ROLE_WORK, handle_complete, {NULL}},
    {"POST", "/v1/jobs/*/fail", ROLE_WORK, handle_fail, {NULL}},
    {"POST", "/v1/jobs/*/release", ROLE_WORK, handle_release, {NULL}},
    {"GET", "/v1/snapshot", ROLE_READ, handle_snapshot, {NULL}},
    {"GET", "/v1/openapi.yaml", ROLE_NONE, handle_openapi, {NULL}},
    {"GET", "/v1/study.schema.json", ROLE_NONE, handle_schema, {NULL}},
    {"GET", "/metrics", ROLE_READ, handle_metrics, {NULL}},
    {"GET", "/healthz", ROLE_NONE, handle_health, {NULL}},
    {"GET", "/", ROLE_NONE, handle_page, {NULL}},
    {"GET", "/web/*", ROLE_NONE, handle_asset, {NULL}},
    {"GET", "/rugo.py", ROLE_NONE, handle_client, {NULL}},
};
enum { ROUTE_COUNT = sizeof ROUTES / sizeof *ROUTES };

const struct route *route_at(size_t at) {
    return at < ROUTE_COUNT ? &ROUTES[at] : NULL;
}

/* Returns whether a path fits a pattern; the first starred segment goes to id. */
static bool fits(const char *pattern, const char *path, char id[SEGMENT_SIZE]) {
    bool first = true;
    for (; *pattern != '\0'; pattern++) {
        if (*pattern != '*') {
            if (*path++ != *pattern)
                return false;
            continue;
        }
        size_t length = strcspn(path, "/");
        if (length == 0 || length >= SEGMENT_SIZE)
            return false;
        if (first) {
            memcpy(id, path, length);
            id[length] = 0;
        }
        first = false;
        path += length;
    }
    return *path == 0;
}

/* HEAD is GET whose body the library leaves out. */
static bool same_method(const char *asked, const char *method) {
    return strcmp(asked, method) == 0 || (strcmp(asked, "HEAD") == 0 && strcmp(method, "GET") == 0);
}

static const struct route *find_route(const struct exchange *exchange, char id[SEGMENT_SIZE]) {
    for (size_t r = 0; r < ROUTE_COUNT; r++)
        if (same_method(exchange->method, ROUTES[r].method) &&
            fits(ROUTES[r].pattern, exchange->path, id))
            return &ROUTES[r];
    return NULL;
}

/* Writes the methods of a path: "" for a path that there is not. */
static void allowed_methods(const char *path, char *text, size_t size) {
    char id[SEGMENT_SIZE];
    size_t used = 0;
    *text = 0;
    for (size_t r = 0; r < ROUTE_COUNT; r++) {
        if (!fits(ROUTES[r].pattern, path, id))
            continue;
        bool get = strcmp(ROUTES[r].method, "GET") == 0;
        used += (size_t)snprintf(text + used, size - used, "%s%s%s", used != 0 ? ", " : "",
                                 ROUTES[r].method, get ? ", HEAD" : "");
    }
}

static void refuse_route(struct exchange *exchange) {
    char methods[96], detail[200];
    allowed_methods(exchange->path, methods, sizeof methods);
    if (*methods == '\0') {
        snprintf(detail, sizeof detail, "there is nothing at %.120s", exchange->path);
        answer_problem(exchange, 404, detail, NULL);
        return;
    }
    snprintf(detail, sizeof detail, "%.16s is not allowed here; allowed: %s", exchange->method,
             methods);
    answer_problem(exchange, 405, detail, NULL);
    answer_header(exchange, "Allow", methods);
}

/* --- what the headers must be --- */

#define LINE_END_FAULT "a line that does not end in CR LF, or a NUL, in the head"

struct headers {
    struct exchange *exchange; /* whose head it is */
    unsigned lengths, hosts, encodings, keys, authorizations;
    const char *next; /* where the line behind the last one seen begins; NULL before the first */
    bool unknown_encoding;
    const char *fault; /* the first one found; NULL: none */
};

/* Returns whether a name is a token (RFC 9110, 5.6.2): no space before the colon, for one. */
static bool is_token(const char *name) {
    static const char OTHERS[] = "!#$%&'*+-.^_`|~";
    const char *c = name;
    for (; *c != '\0'; c++)
        if (!((*c >= '0' && *c <= '9') || (*c >= 'A' && *c <= 'Z') || (*c >= 'a' && *c <= 'z') ||
              strchr(OTHERS, *c) != NULL))
            return false;
    return c != name;
}

/* Returns whether a value has no control characters but tabs: a bare CR, say, ends a line to some.
 */
static bool is_plain(const char *value) {
    for (const unsigned char *c = (const unsigned char *)value; *c != '\0'; c++)
        if ((*c < ' ' && *c != '\t') || *c == 0x7f)
            return false;
    return true;
}

/* The library leaves a line where it was read, with the value behind the name, a colon and blanks.
 * Where a folded line follows it copies the name elsewhere, and appends that line to it. */
static bool is_folded(const char *name, const char *value) {
    uintptr_t end = (uintptr_t)name + strlen(name) + 1, begin = (uintptr_t)value;
    if (begin < end)
        return true;
    enum { BLANKS_MOST = 1024 };
    return begin - end > BLANKS_MOST;
}

/* The library takes a bare LF for the end of a line, and a NUL for that of a value. It puts a NUL
 * for each byte of a line's end: so both of CR LF are NULs, and the next line begins behind them.
 */
static bool ends_as_it_should(const struct headers *headers, const char *name) {
    return headers->next != NULL ? name == headers->next : name[-2] == '\0';
}

/* Of the last line that shows by the empty line behind it, which ends likewise. */
static bool last_ends_as_it_should(const struct headers *headers) {
    return headers->next == NULL ||
           (headers->next[-1] == '\0' && headers->next[0] == '\0' && headers->next[1] == '\0');
}

/* value may be NULL. */
static const char *line_fault(const struct headers *headers, const char *name, const char *value) {
    if (!is_token(name))
        return "the name of a header is no token; there is no space before its colon";
    if (value != NULL && !is_plain(value))
        return "a control character in a header, such as a CR without LF";
    if (value != NULL && is_folded(name, value))
        return "a header on more than one line";
    if (!ends_as_it_should(headers, name))
        return LINE_END_FAULT;
    return NULL;
}

static enum MHD_Result see_header(void *context, enum MHD_ValueKind kind, const char *name,
                                  const char *value) {
    struct headers *headers = context;
    (void)kind;
    headers->lengths += strcasecmp(name, "Content-Length") == 0;
    headers->authorizations += strcasecmp(name, "Authorization") == 0;
    headers->keys += strcasecmp(name, "Idempotency-Key") == 0;
    headers->hosts += strcasecmp(name, "Host") == 0;
    if (strcasecmp(name, "Transfer-Encoding") == 0) {
        headers->encodings++;
        /* The library knows no other. */
        headers->unknown_encoding |= value == NULL || strcasecmp(value, "chunked") != 0;
    }
    if (headers->fault == NULL)
        headers->fault = line_fault(headers, name, value);
    exchange_join(headers->exchange, name, value);
    headers->next = value != NULL ? value + strlen(value) + 2 : NULL;
    return MHD_YES;
}

/* Returns what is wrong with the headers of a request, a static text; NULL where nothing is:
 * headers that let two readers, such as a proxy and this server, see different requests in the same
 * bytes (RFC 9112, 2.2, 5.1, 5.2 and 6.3). */
static const char *headers_fault(struct exchange *exchange) {
    struct headers headers = {.exchange = exchange};
    MHD_get_connection_values(exchange->connection, MHD_HEADER_KIND, see_header, &headers);
    if (headers.fault != NULL)
        return headers.fault;
    if (!last_ends_as_it_should(&headers))
        return LINE_END_FAULT;
    if (exchange->bad_target)
        return "a space or a NUL in what is asked for; a space is written %20";
    if (headers.hosts == 0 && exchange->needs_host)
        return "no Host";
    if (headers.authorizations > 1)
        return "more than one Authorization";
    if (headers.lengths > 1)
        return "more than one Content-Length";
    if (headers.lengths != 0 && headers.encodings != 0)
        return "Content-Length beside Transfer-Encoding";
    if (headers.hosts > 1)
        return "more than one Host";
    if (headers.keys > 1)
        return "more than one Idempotency-Key";
    if (headers.encodings > 1 || headers.unknown_encoding)
        return "a Transfer-Encoding other than chunked";
    return NULL;
}

static bool check_headers(struct exchange *exchange) {
    const char *detail = headers_fault(exchange);
    if (detail == NULL)
        return true;
    answer_problem(exchange, 400, detail, NULL);
    answer_header(exchange, "Connection", "close"); /* where the next request begins is not known */
    return false;
}

/* A page of another site, or a name that somebody pointed at this address, may not use this
 * service. */
static bool check_origin(struct exchange *exchange) {
    const char *host = *exchange->host != '\0' ? exchange->host : exchange_header(exchange, "Host");
    const char *origin = exchange_header(exchange, "Origin");
    if (host != NULL && !exchange_host_allowed(exchange, host)) {
        answer_problem(exchange, 403, "the Host is no name of this server; see serve --allow-host",
                       NULL);
        return false;
    }
    const char *scheme_end = origin != NULL ? strstr(origin, "://") : NULL;
    if (origin != NULL &&
        (host == NULL || scheme_end == NULL || strcmp(scheme_end + 3, host) != 0)) {
        answer_problem(exchange, 403, "requests of another origin are not answered", NULL);
        return false;
    }
    return true;
}

/* An escaped slash, as of a study's name, is one of the path once it is read: what follows would be
 * what another study is asked for. No other path has one. */
static bool check_segment(struct exchange *exchange) {
    if (exchange->slashed_target)
        answer_problem(exchange, 404,
                       "no study is found by a name with a /; name its id, or the first digits of "
                       "it",
                       NULL);
    return !exchange->slashed_target;
}

static bool check_token(struct exchange *exchange, unsigned wanted) {
    exchange->admin = exchange->service->tokens == NULL;
    if (wanted == ROLE_NONE)
        return true;
    if (exchange->service->tokens == NULL) {
        exchange_vouch(exchange);
        return true;
    }
    const char *authorization = exchange_header(exchange, "Authorization");
    bool bearer = authorization != NULL && strncasecmp(authorization, "Bearer ", 7) == 0;
    const struct token_holder holder =
        tokens_find(exchange->service->tokens, bearer ? authorization + 7 : NULL);
    unsigned roles = holder.roles;
    memcpy(exchange->owner, holder.name, sizeof exchange->owner);
    exchange->admin = (roles & ROLE_ADMIN) != 0;
    if ((roles & wanted) != 0) {
        exchange_vouch(exchange);
        return true;
    }
    char detail[120];
    roles_refuse(roles, wanted, detail, sizeof detail);
    if (roles != 0)
        answer_problem(exchange, 403, detail, NULL);
    else
        answer_problem(exchange, 401, bearer ? "the token is unknown" : "no Bearer token", NULL);
    return false;
}

/* In the reserve there is room for what a server at its limit must hear and say: workers, which
 * keep their jobs by it, and whoever watches it. Of all else, one request at a time; no streams,
 * which last. */
static bool check_reserve(struct exchange *exchange, const struct route *route) {
    bool vital = strncmp(exchange->path, "/v1/jobs/", 9) == 0 || route->handler == handle_health ||
                 route->handler == handle_metrics;
    if (!exchange_is_reserved(exchange) || vital ||
        (route->handler != handle_events && exchange_takes_turn(exchange)))
        return true;
    answer_problem(exchange, 503, "all connections of this server are in use; try again", NULL);
    answer_header(exchange, "Retry-After", "1");
    return false;
}

/* The body is a file, in place of JSON. */
static bool takes_file(const struct route *route) {
    return route->handler == handle_characterise;
}

static bool has_body(const struct exchange *exchange) {
    const char *length = exchange_header(exchange, "Content-Length");
    return (length != NULL && strcmp(length, "0") != 0) ||
           exchange_header(exchange, "Transfer-Encoding") != NULL;
}

static bool is_media(struct exchange *exchange, const char *wanted) {
    const char *type = exchange_header(exchange, "Content-Type");
    size_t length = type != NULL ? strcspn(type, "; \t") : 0;
    return length == strlen(wanted) && strncasecmp(type, wanted, length) == 0;
}

static bool check_media(struct exchange *exchange, const struct route *route) {
    const char *wanted = takes_file(route) ? "application/octet-stream" : "application/json";
    const char *other = takes_file(route) ? FORM_MEDIA : NULL; /* several of them */
    char detail[96];
    if (!has_body(exchange) || is_media(exchange, wanted) ||
        (other != NULL && is_media(exchange, other)))
        return true;
    snprintf(detail, sizeof detail, "a body must be %s%s%s", wanted, other != NULL ? " or " : "",
             other != NULL ? other : "");
    answer_problem(exchange, 415, detail, NULL);
    return false;
}

void route_refuse_early(struct exchange *exchange) {
    char id[SEGMENT_SIZE];
    if (!check_headers(exchange) || !check_origin(exchange) || !check_segment(exchange))
        return;
    const struct route *route = find_route(exchange, id);
    if (route == NULL)
        refuse_route(exchange);
    else if (check_token(exchange, route->roles) && check_reserve(exchange, route) &&
             check_media(exchange, route) && strncmp(exchange->path, "/v1/", 4) == 0 &&
             query_check(exchange, route->queries) && takes_file(route))
        (void)characterise_enter(exchange);
}

/* Whether several studies of one name are refused: what is lost must not be another's. */
static bool asks_for_one(const struct exchange *exchange) {
    return strcmp(exchange->method, "DELETE") == 0 || exchange_query(exchange, "unique") != NULL;
}

/* Finds the study that a path names; false after an answer that there is none, or several. *others
 * is the number of older ones that have its name, where the path names it by that. */
static bool find_study(struct exchange *exchange, const char *given, char id[STUDY_ID_SIZE],
                       uint64_t *others) {
    struct store *reader;
    struct error err = {0};
    int status = exchange_reader(exchange, &reader, &err);
    if (status == 0)
        status = store_find(reader, given, id, asks_for_one(exchange) ? NULL : others, &err);
    service_give_back(exchange->service, reader);
    if (status != 0)
        answer_error(exchange, &err);
    return status == 0;
}

void route_answer(struct exchange *exchange) {
    static const char STUDIES[] = "/v1/studies/*";
    char given[SEGMENT_SIZE] = "", id[STUDY_ID_SIZE] = "";
    const struct route *route = find_route(exchange, given);
    bool study = strncmp(route->pattern, STUDIES, sizeof STUDIES - 1) == 0;
    uint64_t others = 0;
    if (!study)
        route->handler(exchange, given);
    else if (find_study(exchange, given, id, &others))
        route->handler(exchange, id);
    if (others > 0) {
        char count[24];
        snprintf(count, sizeof count, "%llu", (unsigned long long)others);
        answer_header(exchange, SAME_NAME_HEADER, count);
    }
}
