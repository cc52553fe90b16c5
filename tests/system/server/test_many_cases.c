/* Protects: a study of ten thousand cases that wait is shown within seconds, near and over HTTP,
 * and a server that sends such a document ends when it is asked to. Merging what has not begun took
 * a minute. */
#include "tests/support/check.h"
#include "tests/support/process.h"
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <unistd.h>

/* Measured: 1 s of CPU each, which other work on the machine does not change. */
enum { SIDE = 100, CPU_S = 20, PATIENCE_S = 120, END_S = 20 };

static char id[17];

/* SIDE x SIDE cases. */
static int setup(void **state) {
    (void)state;
    char *text = NULL;
    size_t size = 0;
    FILE *file = open_memstream(&text, &size);
    assert_non_null(file);
    fputs("{\"name\":\"many\",\"kind\":\"contact\",\"surface\":{\"dimension\":1,\"wavelength_"
          "ratio\":8,"
          "\"hurst\":[",
          file);
    for (int n = 0; n < SIDE; n++)
        fprintf(file, "%s%g", n ? "," : "", 0.1 + 0.008 * n);
    fputs("]},\"contact\":{\"poisson\":[", file);
    for (int n = 0; n < SIDE; n++)
        fprintf(file, "%s%g", n ? "," : "", 0.004 * n);
    fputs("]}}", file);
    fclose(file);
    spit("many.json", text);
    free(text);
    assert_int_equal(
        run_rugo("submit", (const char *[]){"submit", "--db", "many.db", "many.json", NULL}), 0);
    text = slurp("submit.out");
    snprintf(id, sizeof id, "%s", text);
    free(text);
    return 0;
}

/* Of processes that were waited for. */
static double cpu_of_children(void) {
    struct rusage used;
    assert_int_equal(getrusage(RUSAGE_CHILDREN, &used), 0);
    return (double)(used.ru_utime.tv_sec + used.ru_stime.tv_sec) +
           1e-6 * (double)(used.ru_utime.tv_usec + used.ru_stime.tv_usec);
}

static void ask(const char *what, const char *option, const char *place) {
    struct process process;
    double before = cpu_of_children();
    process_start(&process, what, (const char *[]){what, option, place, id, NULL});
    assert_int_equal(process_wait(&process, PATIENCE_S), 0);
    assert_true(cpu_of_children() - before < CPU_S);
}

static void every_document_comes_soon(void **state) {
    (void)state;
    struct process server;
    char url[64];
    unsigned port = serve_start(&server, (const char *[]){"--db", "many.db", NULL});
    snprintf(url, sizeof url, "http://127.0.0.1:%u", port);
    static const char *const COMMANDS[] = {"status", "report", "curves"};
    for (int c = 0; c < 3; c++) {
        ask(COMMANDS[c], "--db", "many.db");
        char name[32];
        snprintf(name, sizeof name, "%s.out", COMMANDS[c]);
        char *near = slurp(name);
        ask(COMMANDS[c], "--server", url);
        char *far = slurp(name);
        assert_string_equal(far, near);
        if (c > 0)
            assert_non_null(strstr(near, c == 1 ? "\n9999 " : "\"case\":9999"));
        free(near);
        free(far);
    }
    double before = cpu_of_children();
    process_kill(&server, SIGTERM);
    assert_int_equal(process_wait(&server, END_S), 0);
    assert_true(cpu_of_children() - before < 3 * CPU_S); /* for three documents */
}

/* Who reads a document slowly does not keep the server from ending. */
static void a_server_ends_in_the_middle(void **state) {
    (void)state;
    static const char *const DOCUMENTS[] = {"report", "curves"};
    for (int d = 0; d < 2; d++) {
        struct process server;
        char request[128], first[1024];
        unsigned port = serve_start(&server, (const char *[]){"--db", "many.db", NULL});
        int peer = http_connect(port);
        int size =
            snprintf(request, sizeof request,
                     "GET /v1/studies/%s/%s HTTP/1.1\r\nHost: localhost\r\n\r\n", id, DOCUMENTS[d]);
        assert_int_equal(send(peer, request, (size_t)size, 0), size);
        assert_true(recv(peer, first, sizeof first, 0) > 0);
        process_kill(&server, SIGTERM);
        assert_int_equal(process_wait(&server, END_S), 0);
        close(peer);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_document_comes_soon),
        cmocka_unit_test(a_server_ends_in_the_middle),
    };
    return cmocka_run_group_tests(tests, setup, NULL);
}
