#include "tests/support/fuzz/draw_request.h"
#include "core/file/memory_file.h"
#include "jobs/kind.h"
#include "tests/support/fuzz/draw_message.h"
#include "tests/support/fuzz/draw_query.h"
#include "tests/support/fuzz/draw_study.h"
#include "tests/support/fuzz/fuzz.h"

/* A request as far as it is drawn. */
struct drawing {
    struct choices *choices;
    struct served *served;
    struct drawn_request *request;
    bool odd;                         /* may be what nobody means to send */
    const struct served_study *study; /* of the path; NULL: none */
    const struct claimed_job *job;    /* likewise */
    FILE *file;
};

static bool is_odd(const struct drawing *drawing, unsigned times) {
    return drawing->odd && choose_rarely(drawing->choices, times);
}

/* --- path --- */

static bool begins(const char *text, const char *with) {
    return strncmp(text, with, strlen(with)) == 0;
}

static const char *odd_segment(struct choices *choices) {
    static const char *const SEGMENTS[] = {
        "%00",    "..", "%2e%2e", "0", "%ff%0a", "a%2fb", "-1", "1e3", "99999999999999999999",
        "%C3%A9", "%"};
    return SEGMENTS[choose(choices, sizeof SEGMENTS / sizeof *SEGMENTS)];
}

/* The whole id of a study, the beginning of it, or its name: more often of one with results. What
 * is cancelled or deleted is mostly the last: the others are not had again soon. */
static void draw_study_id(struct drawing *drawing, char id[SEGMENT_SIZE]) {
    struct choices *choices = drawing->choices;
    const struct served *served = drawing->served;
    size_t n = choose(choices, served->studies);
    bool deletes = strcmp(drawing->request->route->method, "DELETE") == 0;
    if (deletes && !choose_rarely(choices, 16))
        n = served->studies - 1;
    else if (served->study[n].contents == NULL && choose_rarely(choices, 2))
        n /= 2;
    const struct served_study *study = &served->study[n];
    drawing->study = study;
    if (is_odd(drawing, 8))
        snprintf(id, SEGMENT_SIZE, "%s", odd_segment(choices));
    else if (is_odd(drawing, 8))
        snprintf(id, SEGMENT_SIZE, "%.*s", 1 + (int)choose(choices, 8), study->id);
    else
        snprintf(id, SEGMENT_SIZE, "%s", choose_rarely(choices, 4) ? study->name : study->id);
}

static void draw_job_id(struct drawing *drawing, char id[SEGMENT_SIZE]) {
    struct choices *choices = drawing->choices;
    drawing->job = served_job(drawing->served, choices);
    if (is_odd(drawing, 8))
        snprintf(id, SEGMENT_SIZE, "%s", odd_segment(choices));
    else if (drawing->job != NULL && !is_odd(drawing, 8))
        snprintf(id, SEGMENT_SIZE, "%lld", (long long)drawing->job->id);
    else
        snprintf(id, SEGMENT_SIZE, "%u", (unsigned)choose(choices, 40));
}

static void draw_segment(struct drawing *drawing, const char *before, char id[SEGMENT_SIZE]) {
    static const char *const FILES[] = {"app.js", "index.html", "uplot.css", "none.js"};
    struct choices *choices = drawing->choices;
    if (begins(before, "/studies/"))
        draw_study_id(drawing, id);
    else if (begins(before, "/jobs/"))
        draw_job_id(drawing, id);
    else if (begins(before, "/web/"))
        snprintf(id, SEGMENT_SIZE, "%s", FILES[choose(choices, 4)]);
    else if (is_odd(drawing, 8))
        snprintf(id, SEGMENT_SIZE, "%s", odd_segment(choices));
    else
        snprintf(id, SEGMENT_SIZE, "%u", (unsigned)choose(choices, drawing->odd ? 3 : 2));
}

/* Prints the pattern with segments in the place of its stars. */
static void put_path(struct drawing *drawing) {
    const char *pattern = drawing->request->route->pattern, *before = pattern;
    for (const char *at = pattern; *at != '\0'; at++) {
        char id[SEGMENT_SIZE] = "";
        if (*at != '*') {
            before = *at == '/' && at[1] != '*' ? at : before;
            fputc(*at, drawing->file);
            continue;
        }
        draw_segment(drawing, before, id);
        fputs(id, drawing->file);
    }
    if (is_odd(drawing, 32))
        fputc('/', drawing->file);
}

/* --- headers --- */

static void put_header(struct drawing *drawing, const char *name, const char *value) {
    fprintf(drawing->file, "%s: %s\r\n", name, value);
}

static void put_headers(struct drawing *drawing) {
    static const char *const TYPES[] = {"text/csv",  "image/svg+xml",
                                        "image/png", "application/json",
                                        "*/*;q=0.1", "image/svg+xml;q=0.5, text/csv;q=0.7",
                                        ";q=,",      "text/html"};
    static const char *const KEYS[] = {"one", "two", "~", "a b"};
    static const char *const ORIGINS[] = {"http://127.0.0.1", "http://elsewhere.example", "null"};
    struct choices *choices = drawing->choices;
    const char *etag = drawing->served->etag;
    put_header(drawing, "Host", is_odd(drawing, 64) ? "elsewhere.example" : "127.0.0.1");
    put_header(drawing, "Connection", "close");
    if (choose_rarely(choices, 3))
        put_header(drawing, "Accept", TYPES[choose(choices, 8)]);
    if (choose_rarely(choices, 4))
        put_header(drawing, "Accept-Encoding", is_odd(drawing, 4) ? "gzip;q=0, *" : "gzip");
    if (choose_rarely(choices, 6))
        put_header(drawing, "If-None-Match", *etag != '\0' && !is_odd(drawing, 4) ? etag : "*");
    if (choose_rarely(choices, 16))
        put_header(drawing, "Idempotency-Key", KEYS[choose(choices, drawing->odd ? 4 : 2)]);
    if (is_odd(drawing, 32))
        put_header(drawing, "Origin", ORIGINS[choose(choices, 3)]);
    if (choose_rarely(choices, 32))
        put_header(drawing, "Prefer", "wait=0");
}

/* --- body --- */

/* A small map with values of the sort that readers stumble over. */
static char *drawn_map(struct choices *choices) {
    struct memory_file memory;
    MUST(memory_file_open(&memory));
    for (uint64_t row = 2 + choose(choices, 8), columns = row; row > 0; row--)
        for (uint64_t left = columns; left > 0; left--)
            fprintf(memory.file, "%.17g%c",
                    choose_rarely(choices, 32) ? choose_odd_number(choices, true)
                                               : (double)choose(choices, 256),
                    left > 1 ? ',' : '\n');
    char *text = memory_file_close(&memory, NULL);
    MUST(text != NULL);
    return text;
}

static char *drawn_extension(const struct drawing *drawing) {
    char *text = NULL;
    double count = is_odd(drawing, 3) ? choose_odd_number(drawing->choices, false)
                                      : 1 + (double)choose(drawing->choices, 12);
    const char *name = is_odd(drawing, 8) ? "realisation" : "realisations";
    MUST(asprintf(&text, "{\"%s\": %.17g}", name, count) > 0);
    return text;
}

/* NULL: no body. The caller frees. */
static char *drawn_body(struct drawing *drawing) {
    const struct route *route = drawing->request->route;
    struct choices *choices = drawing->choices;
    if (is_odd(drawing, 16))
        return choose_rarely(choices, 2) ? NULL : strdup("{\"a\": [1, {}]");
    if (route->handler == handle_study_create || route->handler == handle_check)
        return draw_study(choices, JOB_KINDS);
    if (route->handler == handle_study_extend)
        return drawn_extension(drawing);
    if (route->handler == handle_characterise)
        return drawn_map(choices);
    if (begins(route->pattern, "/v1/jobs/"))
        return draw_message(choices, drawing->served,
                            &(struct message_drawing){.verb = strrchr(route->pattern, '/') + 1,
                                                      .job = drawing->job,
                                                      .odd = drawing->odd});
    return NULL;
}

/* A form of one or two files with these bytes, or of what is no form; frees the body. */
static char *make_form(struct choices *choices, char *body) {
    static const char PART[] =
        "--b0\r\nContent-Disposition: form-data; name=\"map\"; filename=\"%s\"\r\n\r\n%s\r\n";
    static const char *const SECOND[] = {"b.csv", "a.csv", ""};
    struct memory_file memory;
    MUST(memory_file_open(&memory));
    fprintf(memory.file, PART, "a.csv", body);
    if (choose_rarely(choices, 2))
        fprintf(memory.file, PART, SECOND[choose(choices, 3)], body);
    if (choose_rarely(choices, 4))
        fputs("--b0\r\nContent-Disposition: form-data; name=\"study\"\r\n\r\n"
              "{\"surface\":{\"like\":[\"a.csv\",\"b.csv\"]}}\r\n",
              memory.file);
    fputs(choose_rarely(choices, 8) ? "" : "--b0--\r\n", memory.file);
    free(body);
    char *text = memory_file_close(&memory, NULL);
    MUST(text != NULL);
    return text;
}

static void put_body(struct drawing *drawing) {
    struct choices *choices = drawing->choices;
    bool file = drawing->request->route->handler == handle_characterise;
    char *body = drawn_body(drawing);
    bool wrong = is_odd(drawing, 32);
    const bool form = file && body != NULL && choose_rarely(choices, 4);
    if (form)
        body = make_form(choices, body);
    if (body != NULL)
        put_header(drawing, "Content-Type",
                   form && !wrong  ? "multipart/form-data; boundary=b0"
                   : file != wrong ? "application/octet-stream"
                                   : "application/json");
    if (body == NULL)
        fputs("Content-Length: 0\r\n\r\n", drawing->file);
    else if (choose_rarely(choices, 16))
        fprintf(drawing->file, "Transfer-Encoding: chunked\r\n\r\n%zx\r\n%s\r\n0\r\n\r\n",
                strlen(body), body);
    else
        fprintf(drawing->file, "Content-Length: %zu\r\n\r\n%s", strlen(body), body);
    free(body);
}

/* --- the whole --- */

static const char *drawn_method(struct drawing *drawing) {
    static const char *const OTHERS[] = {"PUT", "GET", "DELETE", "POST", "OPTIONS"};
    const char *method = drawing->request->route->method;
    if (is_odd(drawing, 32))
        return OTHERS[choose(drawing->choices, 5)];
    drawing->request->head = strcmp(method, "GET") == 0 && choose_rarely(drawing->choices, 16);
    return drawing->request->head ? "HEAD" : method;
}

void draw_request(struct choices *choices, struct served *served, struct drawn_request *out) {
    struct memory_file memory;
    size_t routes = 0;
    while (route_at(routes) != NULL)
        routes++;
    *out = (struct drawn_request){.route = route_at(choose(choices, routes))};
    MUST(memory_file_open(&memory));
    struct drawing drawing = {.choices = choices,
                              .served = served,
                              .request = out,
                              .odd = choose(choices, 3) == 2,
                              .file = memory.file};
    fprintf(memory.file, "%s ", drawn_method(&drawing));
    put_path(&drawing);
    draw_query(choices,
               &(struct query_drawing){served, drawing.study, out->route->queries, drawing.odd},
               memory.file);
    fputs(" HTTP/1.1\r\n", memory.file);
    put_headers(&drawing);
    put_body(&drawing);
    out->job = drawing.job != NULL ? drawing.job->id : 0;
    out->bytes = memory_file_close(&memory, &out->size);
    MUST(out->bytes != NULL);
}

void drawn_request_clear(struct drawn_request *request) {
    free(request->bytes);
    request->bytes = NULL;
}
