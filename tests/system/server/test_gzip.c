/* Protects: an answer in gzip is the answer, whatever its length and however it is sent, and goes
 * to those alone who take it. */
#include "tests/support/check.h"
#include "tests/support/process.h"
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Curves of this one take several parts of a stream. */
static const char STUDY[] =
    "{\"name\":\"wide\",\"kind\":\"statistics\",\"seed\":7,\"realisations\":4,\"surface\":{"
    "\"dimension\":1,\"hurst\":[0.2,0.4,0.6,0.8],\"wavelength_ratio\":4,\"length_ratio\":4}}";

static struct process server;
static unsigned port;

static int start(void **state) {
    (void)state;
    port = serve_start(&server, (const char *[]){"--workers", "1", NULL});
    assert_int_equal(http_exchange(port, "POST", "/v1/studies",
                                   "Content-Type: application/json\r\n", STUDY, NULL),
                     201);
    char url[64];
    snprintf(url, sizeof url, "http://127.0.0.1:%u", port);
    assert_int_equal(run_rugo("wait", (const char *[]){"wait", "--server", url, "wide", NULL}), 0);
    return 0;
}

static int stop(void **state) {
    (void)state;
    process_kill(&server, SIGTERM);
    return process_wait(&server, 15);
}

/* What curl gets of the path with more arguments; head.txt has the headers. */
static char *fetch(const char *path, const char *more, const char *file, size_t *size) {
    char line[400];
    snprintf(line, sizeof line, "curl -sf --no-buffer -D head.txt -o %s %s 'http://127.0.0.1:%u%s'",
             file, more, port, path);
    int status = system(line);
    if (status != 0)
        print_error("%s: %d\n", line, status);
    assert_int_equal(status, 0);
    FILE *in = fopen(file, "rb");
    assert_non_null(in);
    char *text = malloc(1 << 24);
    assert_non_null(text);
    *size = fread(text, 1, (1 << 24) - 1, in);
    text[*size] = '\0';
    fclose(in);
    return text;
}

static void the_same_bytes(void **state) {
    (void)state;
    if (system("command -v curl >/dev/null") != 0) {
        print_message("SKIP: there is no curl\n");
        skip();
    }
    static const struct {
        const char *path, *more;
        bool large;
    } ASKED[] = {
        {"/v1/studies/wide/curves", "", true},
        {"/v1/studies/wide/curves", "-H 'Accept: text/csv'", true},
        {"/v1/studies/wide/report", "", true},
        {"/v1/studies/wide/plot?quantity=summit_height_pdf", "", true},
        {"/v1/study.schema.json", "", true},
        {"/v1/openapi.yaml", "", true},
        {"/v1/studies/wide", "", false},
        {"/healthz", "", false},
    };
    for (size_t a = 0; a < sizeof ASKED / sizeof *ASKED; a++) {
        size_t plain_size, size;
        char more[120];
        char *plain = fetch(ASKED[a].path, ASKED[a].more, "plain", &plain_size);
        assert_false(contains("head.txt", "Content-Encoding"));
        snprintf(more, sizeof more, "--compressed %s", ASKED[a].more);
        char *text = fetch(ASKED[a].path, more, "compressed", &size);
        if (contains("head.txt", "Content-Encoding: gzip") != ASKED[a].large)
            fail_msg("%s of %zu bytes", ASKED[a].path, plain_size);
        assert_int_equal(size, plain_size);
        assert_memory_equal(text, plain, size);
        free(text);
        snprintf(more, sizeof more, "-H 'Accept-Encoding: gzip' %s", ASKED[a].more);
        text = fetch(ASKED[a].path, more, "raw", &size);
        assert_true(ASKED[a].large ? size < plain_size / 2 : size == plain_size);
        if (ASKED[a].large)
            assert_true(contains("head.txt", "Vary: Accept-Encoding"));
        free(text);
        free(plain);
    }
}

/* What is the same in another coding has another strong validator. */
static void each_form_has_its_own_tag(void **state) {
    (void)state;
    char *answer, request[2][200], tags[2][120];
    for (int gzip = 0; gzip < 2; gzip++) {
        snprintf(request[gzip], sizeof request[gzip],
                 "HEAD /v1/studies/wide/curves HTTP/1.1\r\nHost: localhost\r\n%s"
                 "Connection: close\r\n\r\n",
                 gzip != 0 ? "Accept-Encoding: gzip\r\n" : "");
        answer = http_raw(port, request[gzip], strlen(request[gzip]));
        const char *tag = strstr(answer, "ETag: ");
        assert_non_null(tag);
        snprintf(tags[gzip], sizeof tags[gzip], "%.*s", (int)strcspn(tag + 6, "\r"), tag + 6);
        free(answer);
    }
    assert_string_not_equal(tags[0], tags[1]);
    for (int gzip = 0; gzip < 2; gzip++) {
        char headers[320];
        snprintf(headers, sizeof headers, "%sIf-None-Match: %s\r\n",
                 gzip != 0 ? "Accept-Encoding: gzip\r\n" : "", tags[gzip]);
        assert_int_equal(http_exchange(port, "GET", "/v1/studies/wide/curves", headers, NULL, NULL),
                         304);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_same_bytes),
        cmocka_unit_test(each_form_has_its_own_tag),
    };
    return cmocka_run_group_tests(tests, start, stop);
}
