/* Protects: the HTTP contract, request by request, against the real server. */
#include "schema/json/json.h"
#include "schema/result/bytes/bytes.h"
#include "tests/support/check.h"
#include "tests/support/process.h"
#include "tests/support/small_studies.h"
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define JSON "Content-Type: application/json\r\n"

static struct process server;
static unsigned port;

static int start(void **state) {
    (void)state;
    port = serve_start(&server, NULL);
    return 0;
}

static int stop(void **state) {
    (void)state;
    process_kill(&server, SIGTERM);
    assert_int_equal(process_wait(&server, 15), 0);
    assert_true(contains(server.err, "msg=ended"));
    return 0;
}

static int ask(const char *method, const char *path, const char *body, char **answer) {
    return http_exchange(port, method, path, body ? JSON : NULL, body, answer);
}

static void check_answer(const char *method, const char *path, const char *body, int status,
                         const char *text) {
    char *answer;
    int got = ask(method, path, body, &answer);
    if (got != status || !strstr(answer, text)) {
        print_error("%s %s %.100s: %d %.300s\n   expected %d with %s\n", method, path,
                    body ? body : "", got, answer, status, text);
        fail();
    }
    free(answer);
}

/* The id in a submission's answer. */
static void submit(const char *study, char id[17]) {
    char *answer;
    assert_int_equal(ask("POST", "/v1/studies", study, &answer), 201);
    assert_int_equal(sscanf(answer, "{\"id\":\"%16[0-9a-f]\"", id), 1);
    free(answer);
}

/* The server publishes on its own time, after the worker has ended. */
static void wait_until_done(const char *path) {
    bool done = false;
    for (int tries = 0; !done && tries < 3000; tries++) {
        char *answer;
        assert_int_equal(ask("GET", path, NULL, &answer), 200);
        done = strstr(answer, "\"state\":\"done\"") != NULL;
        free(answer);
        if (!done)
            sleep_ms(10);
    }
    assert_true(done);
}

static void path_of(char *path, size_t size, const char *id, const char *rest) {
    snprintf(path, size, "/v1/studies/%s%s", id, rest);
}

/* Works until the study is done. */
static void work(const char *id) {
    char url[64], path[96];
    snprintf(url, sizeof url, "http://127.0.0.1:%u", port);
    path_of(path, sizeof path, id, "");
    assert_int_equal(run_rugo("work", (const char *[]){"work", "--server", url, "--drain",
                                                       "--workers", "1", NULL}),
                     0);
    wait_until_done(path);
}

/* --- a study's life --- */

static void a_study_from_submission_to_curves(void **state) {
    (void)state;
    char id[17], path[96], url[64], rest[48], *answer;
    submit(ONE_CASE, id);
    path_of(path, sizeof path, id, "");
    check_answer("GET", path, NULL, 200, "\"state\":\"queued\"");
    check_answer("GET", "/v1/studies", NULL, 200, id);
    snprintf(url, sizeof url, "http://127.0.0.1:%u", port);
    work(id);
    path_of(path, sizeof path, id, "/study");
    check_answer("GET", path, NULL, 200, ONE_CASE);
    check_answer("GET", "/v1/studies/0123456789abcdef/study", NULL, 404, "there is no study");
    path_of(path, sizeof path, id, "/curves?quantity=summit_height_pdf");
    check_answer("GET", path, NULL, 200, "\"quantity\":\"summit_height_pdf\"");
    path_of(path, sizeof path, id, "/curves?case=1");
    check_answer("GET", path, NULL, 404, "has no case 1");
    path_of(path, sizeof path, id, "/curves?quantity=colour");
    check_answer("GET", path, NULL, 422, "colour");
    path_of(path, sizeof path, id, "/curves?case=x");
    check_answer("GET", path, NULL, 422, "?case");
    path_of(path, sizeof path, id, "/table");
    check_answer("GET", path, NULL, 200, "{\"name\":\"summit_density\",\"type\":\"scalar\"");
    check_answer("GET", path, NULL, 200, "\"provenance\":{\"seed\":\"3\",\"program\":\"");
    path_of(path, sizeof path, id, "/table?columns=kurtosis,psd@1&where=hurst=0.7");
    check_answer("GET", path, NULL, 422, "where: no case has /surface/hurst = 0.7; there is 0.8");
    path_of(path, sizeof path, id, "/table?columns=kurtosis&where=hurst=0.8&format=text");
    check_answer("GET", path, NULL, 200, "\ncase  n ");
    path_of(path, sizeof path, id, "/table?format=pdf");
    check_answer("GET", path, NULL, 422, "pdf is none of text|csv|json");
    snprintf(rest, sizeof rest, "/table?columns=psd@%%31");
    path_of(path, sizeof path, id, rest);
    check_answer("GET", path, NULL, 422, "psd has no value at 1; it is known at ");
    assert_int_equal(run_rugo("table", (const char *[]){"table", "--server", url, "--columns",
                                                        "summit_density,skewness", "--where",
                                                        "hurst=0.8", id, NULL}),
                     0);
    assert_true(contains("table.out", "summit_density") && contains("table.out", "skewness"));
    assert_int_equal(run_rugo("table", (const char *[]){"table", "--server", url, "--columns",
                                                        "a b&c=d", id, NULL}),
                     2);
    assert_true(contains("table.err", "no case has a scalar \"a b&c=d\""));
    static const struct {
        const char *format, *has;
    } FORMATS[] = {
        {"text", "case  n "}, {"csv", "case,"}, {"json", "],\"rows\":["}, {"markdown", "| ---: |"}};
    for (size_t f = 0; f < sizeof FORMATS / sizeof *FORMATS; f++) {
        assert_int_equal(run_rugo("table", (const char *[]){"table", "--server", url, "--format",
                                                            FORMATS[f].format, id, NULL}),
                         0);
        assert_true(contains("table.out", FORMATS[f].has));
    }
    path_of(path, sizeof path, id, "/report");
    check_answer("GET", path, NULL, 200, "\"statistical_error\"");
    assert_int_equal(http_exchange(port, "GET", path, "Accept: image/svg+xml\r\n", NULL, &answer),
                     404);
    assert_non_null(strstr(answer, "has no model whose cost and error are known"));
    free(answer);
    path_of(path, sizeof path, id, "/events");
    check_answer("GET", path, NULL, 200, "event: progress");
    path_of(path, sizeof path, id, "/curves");
    assert_int_equal(http_exchange(port, "GET", path, "Accept: text/csv\r\n", NULL, &answer), 200);
    assert_non_null(strstr(answer, "\n# computed: 1 jobs on "));
    assert_non_null(strstr(answer, "\ncase,quantity,"));
    free(answer);
    assert_int_equal(http_exchange(port, "GET", path,
                                   "Accept: application/json, text/csv;q=0.5\r\n", NULL, &answer),
                     200);
    assert_non_null(strstr(answer, "{\"study\":"));
    free(answer);
    path_of(path, sizeof path, id, "");
    check_answer("DELETE", path, NULL, 409, "already ended");
    path_of(path, sizeof path, id, "/retry");
    check_answer("POST", path, NULL, 200, "\"retried\":0");
}

/* Near and far, as JSON, CSV and table. */
static void a_case_less_another(void **state) {
    (void)state;
    static const char STUDY[] =
        "{\"name\":\"two\",\"kind\":\"statistics\",\"seed\":7,\"realisations\":8,\"surface\":"
        "{\"dimension\":1,\"hurst\":[0.2,0.8],\"wavelength_ratio\":4,\"length_ratio\":4}}";
    char id[17], path[120], url[64], *answer;
    submit(STUDY, id);
    path_of(path, sizeof path, id, "/curves?difference=1,0");
    check_answer("GET", path, NULL, 409, "case 1 has no realisations yet");
    snprintf(url, sizeof url, "http://127.0.0.1:%u", port);
    work(id);
    path_of(path, sizeof path, id, "/curves?difference=1,0");
    check_answer("GET", path, NULL, 200, "{\"case\":1,\"less\":0,");
    check_answer("GET", path, NULL, 200, "\"paired\":true");
    assert_int_equal(http_exchange(port, "GET", path, "Accept: text/csv\r\n", NULL, &answer), 200);
    assert_non_null(strstr(answer, ",less,minuend,subtrahend,paired"));
    free(answer);
    static const struct {
        const char *query;
        int status;
        const char *text;
    } WRONG[] = {{"?difference=1", 422, "?difference"},
                 {"?difference=1,x", 422, "1,x is not two cases"},
                 {"?difference=1,0&case=1", 422, "not together with difference"},
                 {"?difference=1,1", 422, "less itself is nothing"},
                 {"?difference=0,2", 404, "has no case 2"},
                 {"?difference=1,0&quantity=colour", 422, "colour"}};
    for (size_t w = 0; w < sizeof WRONG / sizeof *WRONG; w++) {
        char rest[64];
        snprintf(rest, sizeof rest, "/curves%s", WRONG[w].query);
        path_of(path, sizeof path, id, rest);
        check_answer("GET", path, NULL, WRONG[w].status, WRONG[w].text);
    }
    assert_int_equal(run_rugo("far", (const char *[]){"curves", "--server", url, id, "--difference",
                                                      "1", "0", NULL}),
                     0);
    assert_int_equal(run_rugo("near", (const char *[]){"curves", "--db", "rugo.db", id,
                                                       "--difference", "1", "0", NULL}),
                     0);
    char *far = slurp("far.out"), *near = slurp("near.out");
    assert_string_equal(far, near);
    free(far);
    free(near);
    assert_int_equal(run_rugo("table", (const char *[]){"curves", "--server", url, id, "--format",
                                                        "table", "--difference", "1", "0", NULL}),
                     0);
    char *table = slurp("table.out");
    assert_non_null(strstr(table, "case 1 less case 0, 8 realisations"));
    assert_non_null(strstr(table, "/surface/hurst: 0.8 less 0.2"));
    free(table);
    assert_int_equal(
        run_rugo("out", (const char *[]){"curves", "--server", url, id, "--out", "difference",
                                         "--difference", "1", "0", NULL}),
        0);
    char *picture = slurp("difference/summit_height_pdf.svg");
    assert_non_null(strstr(picture, "case 1 less case 0"));
    assert_non_null(strstr(picture, "fill-opacity"));
    free(picture);
}

/* Curves are sent case by case, and are the same document as of the file; a table has its limit. */
static void curves_of_many_cases_are_sent_whole(void **state) {
    (void)state;
    char study[2000], id[17], path[96], url[64], *near, *far;
    size_t used =
        (size_t)snprintf(study, sizeof study, "%s",
                         "{\"name\":\"many\",\"kind\":\"statistics\",\"realisations\":5,"
                         "\"statistics\":{\"bins\":{\"height\":[-4,4,8],\"curvature\":"
                         "[-8,0,8]}},\"surface\":{\"wavelength_ratio\":4,\"length_ratio\":"
                         "2,\"points_per_wavelength\":2,\"hurst\":[0.1");
    for (int c = 1; c < 65; c++)
        used += (size_t)snprintf(study + used, sizeof study - used, ",0.%d", 100 + c);
    snprintf(study + used, sizeof study - used, "]}}");
    submit(study, id);
    snprintf(url, sizeof url, "http://127.0.0.1:%u", port);
    assert_int_equal(run_rugo("far", (const char *[]){"curves", "--server", url, id, NULL}), 0);
    assert_int_equal(run_rugo("near", (const char *[]){"curves", "--db", "rugo.db", id, NULL}), 0);
    near = slurp("near.out");
    far = slurp("far.out");
    assert_non_null(strstr(near, "\"case\":64,"));
    assert_string_equal(near, far);
    free(near);
    free(far);
    path_of(path, sizeof path, id, "/curves");
    assert_int_equal(http_exchange(port, "GET", path, "Accept: text/csv\r\n", NULL, NULL), 422);
    path_of(path, sizeof path, id, "/curves?case=64");
    assert_int_equal(http_exchange(port, "GET", path, "Accept: text/csv\r\n", NULL, NULL), 200);
    path_of(path, sizeof path, id, "");
    check_answer("DELETE", path, NULL, 200, "cancelled");
}

/* The part of a text between two others. */
static char *part_between(const char *text, const char *begin, const char *end) {
    const char *from = strstr(text, begin);
    assert_non_null(from);
    const char *to = strstr(from, end);
    assert_non_null(to);
    char *part = strndup(from, (size_t)(to - from));
    assert_non_null(part);
    return part;
}

/* The line that begins with a member's name; NULL: none. */
static const char *line_of(const char *description, const char *name) {
    size_t length = strlen(name);
    for (const char *line = description; line != NULL; line = strchr(line, '\n')) {
        line += strspn(line, "\n ");
        if (strncmp(line, name, length) == 0 && line[length] == ':')
            return line;
    }
    return NULL;
}

/* Each member is described by a line of its own, as one that may be null where it is. */
static void check_described(const cJSON *object, const char *description) {
    const cJSON *member;
    assert_true(cJSON_IsObject(object) && object->child != NULL);
    cJSON_ArrayForEach(member, object) {
        const char *line = line_of(description, member->string);
        bool described = line != NULL, null = cJSON_IsNull(member);
        if (!described || (null && memmem(line, strcspn(line, "\n"), "\"null\"", 6) == NULL))
            fail_msg("%s is not described%s", member->string, described ? " as null" : "");
    }
}

/* A study whose curves, scalars and tables have as many members as there are. */
static void members_of_results_are_described(void **state) {
    (void)state;
    static const char STUDY[] =
        "{\"name\":\"described\",\"kind\":\"contact\",\"seed\":5,\"realisations\":6,\"surface\":{"
        "\"dimension\":1,\"hurst\":0.8,\"wavelength_ratio\":4,\"length_ratio\":2,\"rms_slope\":0.1,"
        "\"points_per_wavelength\":8,\"amplitudes\":\"random\",\"unit\":1e-6,\"heights\":{"
        "\"distribution\":\"weibull_min\",\"shape\":1.5}},\"contact\":{\"cell_error\":\"probed\","
        "\"model\":[\"halfspace\",\"layered\"],\"levels\":[4,8],\"pressures\":{\"to\":0.3,"
        "\"steps\":4},\"pressure_pdf\":{\"at\":[0.3]}}}";
    char id[17], path[96], *answer, *part;
    const cJSON *one;
    submit(STUDY, id);
    work(id);
    assert_int_equal(ask("GET", "/v1/openapi.yaml", NULL, &answer), 200);
    char *description = answer;
    const char *all = strstr(description, "\n    Curves:");
    assert_non_null(all);
    path_of(path, sizeof path, id, "/curves");
    assert_int_equal(ask("GET", path, NULL, &answer), 200);
    cJSON *document = cJSON_Parse(answer);
    const cJSON *first = cJSON_GetArrayItem(cJSON_GetObjectItem(document, "cases"), 0);
    free(answer);
    const cJSON *area = cJSON_GetArrayItem(cJSON_GetObjectItem(first, "curves"), 0);
    assert_non_null(cJSON_GetObjectItem(area, "law_difference"));
    part = part_between(all, "\n              scalars:", "\n              curves:");
    cJSON_ArrayForEach(one, cJSON_GetObjectItem(first, "scalars")) check_described(one, part);
    free(part);
    part = strstr(all, "\n              curves:");
    cJSON_ArrayForEach(one, cJSON_GetObjectItem(first, "curves")) check_described(one, part);
    cJSON_Delete(document);
    path_of(path, sizeof path, id, "/table?columns=contact_area@0.3,mean_gap_last");
    assert_int_equal(ask("GET", path, NULL, &answer), 200);
    document = cJSON_Parse(answer);
    free(answer);
    first = cJSON_GetArrayItem(cJSON_GetObjectItem(document, "rows"), 0);
    assert_non_null(cJSON_GetObjectItem(first, "law_differences"));
    const char *table = strstr(description, "\n    Table:");
    part = part_between(table, "\n        rows:", "\n    UnknownErrors:");
    check_described(first, part);
    free(part);
    part = part_between(table, "\n        columns:", "\n        rows:");
    cJSON_ArrayForEach(one, cJSON_GetObjectItem(document, "columns")) check_described(one, part);
    free(part);
    cJSON_Delete(document);
    free(description);
}

/* The whole answer to a request with these lines behind its Host. */
static char *whole_answer(const char *method, const char *target, const char *lines) {
    char request[600];
    snprintf(request, sizeof request,
             "%s %s HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n%s\r\n", method, target,
             lines);
    return http_raw(port, request, strlen(request));
}

/* The ETag of an answer; NULL where it has none. Cuts the answer behind it. */
static const char *tag_of(char *answer) {
    char *tag = strstr(answer, "ETag: ");
    if (tag == NULL)
        return NULL;
    tag[strcspn(tag, "\r")] = '\0';
    return tag + strlen("ETag: ");
}

/* 304 has the fields that the answer would have, and no length, which would be that of nothing; an
 * answer of another program is another one. */
static void an_unchanged_answer_has_the_fields_of_the_answer(void **state) {
    (void)state;
    char id[17], path[96], hash[24], line[200], *answer, *program;
    submit(ONE_CASE, id);
    work(id);
    path_of(path, sizeof path, id, "/curves");
    assert_int_equal(ask("GET", path, NULL, &answer), 200);
    program = part_between(answer, "\"program\":\"", "\",");
    free(answer);
    const char *written = program + strlen("\"program\":\"");
    snprintf(hash, sizeof hash, "-%016llx-",
             (unsigned long long)hash_bytes(HASH_START, strlen(written) + 1, written));
    free(program);
    answer = whole_answer("HEAD", path, "");
    const char *tag = tag_of(answer);
    assert_non_null(tag);
    assert_non_null(strstr(tag, hash));
    snprintf(line, sizeof line, "If-None-Match: %s\r\n", tag);
    free(answer);
    answer = whole_answer("GET", path, line);
    assert_non_null(strstr(answer, "HTTP/1.1 304 "));
    assert_null(strcasestr(answer, "Content-Length"));
    assert_null(strcasestr(answer, "Transfer-Encoding"));
    assert_non_null(strstr(answer, "Vary: Accept\r\n"));
    assert_non_null(strstr(answer, "Vary: Accept-Encoding\r\n"));
    assert_string_equal(strstr(answer, "\r\n\r\n"), "\r\n\r\n");
    free(answer);
}

/* Several lines of a list are one (RFC 9110, 5.3). */
static void lists_may_have_several_lines(void **state) {
    (void)state;
    static const struct {
        const char *rest, *lines, *has;
    } ASKED[] = {
        {"/curves", "Accept: image/png\r\nAccept: text/csv\r\n", "Content-Type: text/csv"},
        {"/curves", "Accept: text/csv;q=0.5\r\naccept: text/html\r\nAccept: application/json\r\n",
         "Content-Type: application/json"},
        {"/curves", "Accept-Encoding: br\r\nAccept-Encoding: gzip\r\n", "Content-Encoding: gzip"},
        {"/curves", "If-None-Match: \"other\"\r\nIf-None-Match: TAG\r\n", "HTTP/1.1 304 "}};
    char id[17], path[96], lines[300];
    submit(ONE_CASE, id);
    work(id);
    path_of(path, sizeof path, id, "/curves");
    char *known = whole_answer("HEAD", path, "");
    const char *tag = tag_of(known);
    assert_non_null(tag);
    for (size_t a = 0; a < sizeof ASKED / sizeof *ASKED; a++) {
        const char *place = strstr(ASKED[a].lines, "TAG");
        size_t before = place != NULL ? (size_t)(place - ASKED[a].lines) : strlen(ASKED[a].lines);
        snprintf(lines, sizeof lines, "%.*s%s%s", (int)before, ASKED[a].lines,
                 place != NULL ? tag : "", place != NULL ? "\r\n" : "");
        path_of(path, sizeof path, id, ASKED[a].rest);
        char *answer = whole_answer("GET", path, lines);
        if (strstr(answer, ASKED[a].has) == NULL)
            fail_msg("%s: %.600s", lines, answer);
        free(answer);
    }
    free(known);
}

/* A target may have scheme and host before its path, which go before the Host of the header. */
static void a_target_may_be_in_absolute_form(void **state) {
    (void)state;
    static const struct {
        const char *target, *answer;
    } ASKED[] = {{"http://127.0.0.1:8080/healthz", "HTTP/1.1 200 "},
                 {"HTTP://localhost/v1/studies?limit=1", "HTTP/1.1 200 "},
                 {"http://localhost", "HTTP/1.1 200 "},
                 {"http://localhost/v1/studies?limit=0", "HTTP/1.1 422 "},
                 {"http://localhost/nowhere", "there is nothing at /nowhere"},
                 {"http://evil.example/healthz", "HTTP/1.1 403 "},
                 {"http://somebody@localhost/healthz", "HTTP/1.1 403 "},
                 {"http:///healthz", "HTTP/1.1 404 "},
                 {"ftp://localhost/healthz", "HTTP/1.1 404 "},
                 {"/http://localhost/healthz", "HTTP/1.1 404 "}};
    for (size_t a = 0; a < sizeof ASKED / sizeof *ASKED; a++) {
        char *answer = whole_answer("GET", ASKED[a].target, "");
        if (strstr(answer, ASKED[a].answer) == NULL)
            fail_msg("%s: %.600s", ASKED[a].target, answer);
        free(answer);
    }
}

static void unchanged_curves_are_not_sent_again(void **state) {
    (void)state;
    char id[17], path[96], request[300], *reply, *tag;
    submit(ONE_CASE, id);
    path_of(path, sizeof path, id, "/curves");
    snprintf(request, sizeof request,
             "GET %s HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n", path);
    reply = http_raw(port, request, strlen(request));
    assert_non_null(tag = strstr(reply, "ETag: "));
    tag[strcspn(tag, "\r")] = 0;
    char header[128];
    snprintf(header, sizeof header, "If-None-Match: %s\r\n", tag + 6);
    assert_int_equal(http_exchange(port, "GET", path, header, NULL, NULL), 304);
    char list[192];
    snprintf(list, sizeof list, "If-None-Match: \"other\", W/%s\r\n", tag + 6);
    assert_int_equal(http_exchange(port, "GET", path, list, NULL, NULL), 304);
    snprintf(list, sizeof list, "Accept: text/csv\r\n%s", header); /* another form, another tag */
    assert_int_equal(http_exchange(port, "GET", path, list, NULL, NULL), 200);
    free(reply);
    path_of(path, sizeof path, id, "");
    check_answer("DELETE", path, NULL, 200, "\"state\":\"cancelled\"");
    path_of(path, sizeof path, id, "/curves");
    assert_int_equal(http_exchange(port, "GET", path, header, NULL, NULL), 200);
    path_of(path, sizeof path, id, "/retry");
    check_answer("POST", path, NULL, 200, "\"retried\":1");
    path_of(path, sizeof path, id, "");
    check_answer("DELETE", path, NULL, 200, "cancelled");
}

/* A tag is that of one question: what has no answer has none that is known. */
static void what_is_wrong_is_not_unchanged(void **state) {
    (void)state;
    static const struct {
        const char *query;
        int status;
        bool whole; /* the tag is that of curves without a query, too */
    } ASKED[] = {{"", 304, true},
                 {"?case=0", 304, false},
                 {"?quantity=summit_height_pdf", 304, false},
                 {"?quantity=nope", 422, false},
                 {"?case=77", 404, false},
                 {"?difference=0,9", 404, false},
                 {"?difference=0,0", 422, false},
                 {"?quantity=", 422, false}};
    static const char *const FORMS[] = {"", "Accept: text/csv\r\n"};
    char id[17], path[96], request[300], header[160];
    submit(ONE_CASE, id);
    work(id);
    for (size_t f = 0; f < 2; f++) {
        path_of(path, sizeof path, id, "/curves");
        snprintf(request, sizeof request,
                 "HEAD %s HTTP/1.1\r\nHost: localhost\r\n%sConnection: close\r\n\r\n", path,
                 FORMS[f]);
        char *reply = http_raw(port, request, strlen(request)), *tag = strstr(reply, "ETag: ");
        assert_non_null(tag);
        tag[strcspn(tag, "\r")] = '\0';
        for (size_t a = 0; a < sizeof ASKED / sizeof *ASKED; a++) {
            char rest[64];
            snprintf(rest, sizeof rest, "/curves%s", ASKED[a].query);
            path_of(path, sizeof path, id, rest);
            snprintf(header, sizeof header, "%sIf-None-Match: *\r\n", FORMS[f]);
            assert_int_equal(http_exchange(port, "GET", path, header, NULL, NULL), ASKED[a].status);
            snprintf(header, sizeof header, "%sIf-None-Match: %s\r\n", FORMS[f], tag + 6);
            int status = ASKED[a].status == 304 && !ASKED[a].whole ? 200 : ASKED[a].status;
            assert_int_equal(http_exchange(port, "GET", path, header, NULL, NULL), status);
        }
        free(reply);
    }
}

static void a_key_makes_submission_safe_to_repeat(void **state) {
    (void)state;
    char *first, *second;
    const char *key = JSON "Idempotency-Key: monday\r\n";
    assert_int_equal(http_exchange(port, "POST", "/v1/studies", key, ONE_CASE, &first), 201);
    assert_int_equal(http_exchange(port, "POST", "/v1/studies", key, ONE_CASE, &second), 200);
    assert_string_equal(first, second);
    assert_int_equal(http_exchange(port, "POST", "/v1/studies", key, SEVERAL_BLOCKS, NULL), 409);
    char id[17], path[96];
    sscanf(first, "{\"id\":\"%16[0-9a-f]", id);
    path_of(path, sizeof path, id, "");
    check_answer("DELETE", path, NULL, 200, "cancelled");
    free(first);
    free(second);
}

/* --- the queue --- */

static void a_lease_is_needed_to_report(void **state) {
    (void)state;
    char id[17], path[96], *answer, token[40], body[200];
    long job;
    submit(ONE_CASE, id);
    assert_int_equal(ask("POST", "/v1/jobs/claim",
                         "{\"worker\":\"w\",\"host\":\"h\",\"kinds\":[\"statistics\"],\"count\":1}",
                         &answer),
                     200);
    assert_int_equal(sscanf(strstr(answer, "\"id\":"), "\"id\":%ld", &job), 1);
    assert_int_equal(sscanf(strstr(answer, "\"token\":"), "\"token\":\"%32[0-9a-f]", token), 1);
    free(answer);
    snprintf(path, sizeof path, "/v1/jobs/%ld/heartbeat", job);
    snprintf(body, sizeof body, "{\"token\":\"%s\",\"done\":2}", token);
    check_answer("POST", path, body, 200, "{}");
    check_answer("POST", path, "{\"token\":\"0123456789abcdef0123456789abcdef\",\"done\":2}", 409,
                 "lost");
    snprintf(path, sizeof path, "/v1/jobs/%ld/complete", job);
    snprintf(body, sizeof body,
             "{\"token\":\"%s\",\"seconds\":1,\"first\":0,\"count\":5,\"scalars\":{\"names\":["
             "\"a\"],\"rows\":[[1],[1],[1],[1],[1]]},\"data\":\"AAAA\"}",
             token);
    check_answer("POST", path, body, 422, "scalars");
    snprintf(path, sizeof path, "/v1/jobs/%ld/fail", job);
    snprintf(body, sizeof body, "{\"token\":\"%s\",\"reason\":\"no luck\",\"permanent\":true}",
             token);
    check_answer("POST", path, body, 200, "{}");
    check_answer("POST", path, body, 409, "lost");
    path_of(path, sizeof path, id, "");
    check_answer("GET", path, NULL, 200, "\"reason\":\"no luck\"");
    check_answer("POST", "/v1/jobs/claim", "{\"worker\":\"w\",\"kinds\":[\"other\"]}", 204, "");
}

static void descriptions_and_page(void **state) {
    (void)state;
    check_answer("GET", "/", NULL, 200, "<title>Rugo</title>");
    check_answer("GET", "/web/app.js", NULL, 200, "import");
    check_answer("GET", "/web/style.css", NULL, 200, "body");
    check_answer("GET", "/v1/openapi.yaml", NULL, 200, "openapi: 3.1");
    check_answer("GET", "/v1/study.schema.json", NULL, 200, "\"hurst\": {\n");
    check_answer("GET", "/v1/study.schema.json", NULL, 200, "\"maximum\": 9007199254740992\n");
    check_answer("GET", "/metrics", NULL, 200, "rugo_jobs{state=\"waiting\"}");
    char *answer;
    int status = http_exchange(port, "GET", "/v1/snapshot", NULL, NULL, &answer);
    assert_int_equal(status, 200);
    assert_memory_equal(answer, "SQLite format 3", 15);
    free(answer);
}

/* Every path of the description has just the methods that it describes: 405 lists them. */
static void description_and_routes_agree(void **state) {
    (void)state;
    char *text, *allowed, *rest = NULL, path[80] = "", methods[80] = "";
    size_t paths = 0;
    assert_int_equal(ask("GET", "/v1/openapi.yaml", NULL, &text), 200);
    for (char *line = strtok_r(text, "\n", &rest); line; line = strtok_r(NULL, "\n", &rest)) {
        bool next = strncmp(line, "  /", 3) == 0 || strncmp(line, "components:", 11) == 0;
        if (next && *path) {
            assert_int_equal(ask("BREW", path, NULL, &allowed), 405);
            char *listed = strstr(allowed, "allowed: ");
            assert_non_null(listed);
            listed[strcspn(listed, "\"")] = 0;
            assert_string_equal(listed + 9, methods);
            free(allowed);
            paths++;
        }
        if (next) {
            snprintf(path, sizeof path, "%.*s", (int)strcspn(line + 2, ":"), line + 2);
            *methods = 0;
        }
        const char *method = strncmp(line, "    get:", 8) == 0       ? "GET, HEAD"
                             : strncmp(line, "    post:", 9) == 0    ? "POST"
                             : strncmp(line, "    delete:", 11) == 0 ? "DELETE"
                                                                     : NULL;
        size_t used = strlen(methods);
        if (method)
            snprintf(methods + used, sizeof methods - used, "%s%s", used ? ", " : "", method);
    }
    assert_true(paths > 10);
    free(text);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_study_from_submission_to_curves),
        cmocka_unit_test(a_case_less_another),
        cmocka_unit_test(curves_of_many_cases_are_sent_whole),
        cmocka_unit_test(members_of_results_are_described),
        cmocka_unit_test(an_unchanged_answer_has_the_fields_of_the_answer),
        cmocka_unit_test(lists_may_have_several_lines),
        cmocka_unit_test(a_target_may_be_in_absolute_form),
        cmocka_unit_test(unchanged_curves_are_not_sent_again),
        cmocka_unit_test(what_is_wrong_is_not_unchanged),
        cmocka_unit_test(a_key_makes_submission_safe_to_repeat),
        cmocka_unit_test(a_lease_is_needed_to_report),
        cmocka_unit_test(descriptions_and_page),
        cmocka_unit_test(description_and_routes_agree),
    };
    return cmocka_run_group_tests(tests, start, stop);
}
