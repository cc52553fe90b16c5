/* Protects: Rugo in Python: the client, alone and against a real service (client.py), the package
 * with librugo and the program, and what its page and its notebook claim (package.py). */
#include "core/rugo.h"
#include "tests/support/check.h"
#include "tests/support/process.h"
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

static const char FIRST[] =
    "{\"name\":\"first\",\"kind\":\"statistics\",\"seed\":1,\"realisations\":8,\"surface\":{"
    "\"hurst\":[0.2,0.8],\"wavelength_ratio\":4,\"length_ratio\":4},"
    "\"statistics\":{\"bins\":{\"height\":[-4,8,120],\"curvature\":[-16,0,16]}}}";

static const char *source(void) {
    const char *folder = getenv("RUGO_SOURCE");
    return folder != NULL ? folder : ".";
}

static void need_python(void) {
    if (system("python3 -c 'import sys; sys.exit(sys.version_info < (3, 8))' 2>/dev/null") != 0) {
        print_message("SKIP: there is no python3 of version 3.8 or later\n");
        skip();
    }
}

/* Runs a script of this folder; it must end well, with the sentence. */
static void run_script(const char *environment, const char *script, const char *arguments,
                       const char *sentence) {
    char line[4000];
    snprintf(line, sizeof line,
             "env -u RUGO_TOKEN PYTHONDONTWRITEBYTECODE=1 %s timeout 400 python3 "
             "'%s/tests/system/server/%s' %s >script.out 2>&1",
             environment, source(), script, arguments);
    int status = system(line);
    char *printed = slurp("script.out");
    print_message("%s", printed);
    assert_non_null(strstr(printed, sentence));
    free(printed);
    assert_int_equal(status, 0);
}

/* The file that a service gives away needs nothing of the package. */
static void the_client_works_alone(void **state) {
    (void)state;
    struct process server = {0};
    char path[1000], arguments[100];
    need_python();
    unsigned port = serve_start(&server, (const char *[]){"--workers", "1", NULL});
    snprintf(path, sizeof path, "%s/server/python/rugo/client.py", source());
    char *file = slurp(path);
    assert_int_equal(mkdir("alone", 0777), 0);
    spit("alone/rugo.py", file);
    free(file);
    snprintf(arguments, sizeof arguments, "http://127.0.0.1:%u .", port);
    run_script("PYTHONPATH=\"$PWD/alone:$PYTHONPATH\"", "client.py", arguments,
               "client: all as it should be");
    process_kill(&server, SIGTERM);
    assert_int_equal(process_wait(&server, 15), 0);
}

/* librugo lies beside the program. */
static void the_package_and_its_page(void **state) {
    (void)state;
    struct process server = {0};
    char environment[3000], arguments[1200];
    need_python();
    unsigned port = serve_start(&server, (const char *[]){"--workers", "1", NULL});
    spit("first.json", FIRST);
    assert_int_equal(run_rugo("run", (const char *[]){"run", "--db", "own.db", "first.json",
                                                      "--out", "results", NULL}),
                     0);
    snprintf(environment, sizeof environment,
             "PYTHONPATH=\"%s/server/python:$PYTHONPATH\" RUGO_PROGRAM='%s' "
             "RUGO_LIBRARY=\"$(dirname '%s')/librugo.so." RUGO_VERSION "\"",
             source(), rugo(), rugo());
    snprintf(arguments, sizeof arguments, "'%s' . http://127.0.0.1:%u", source(), port);
    run_script(environment, "package.py", arguments, "package: all as it should be");
    process_kill(&server, SIGTERM);
    assert_int_equal(process_wait(&server, 15), 0);
}

/* Over TLS by fingerprint and by authority; a wrong one, or none, is refused. */
static void the_client_speaks_tls(void **state) {
    (void)state;
    struct process server = {0};
    char line[1600], fingerprint[80] = "";
    unsigned port = 0;
    need_python();
    assert_int_equal(run_rugo("new", (const char *[]){"certificate", "new", "tls", NULL}), 0);
    process_start(&server, "tls",
                  (const char *[]){"serve", "--db", "tls.db", "--listen", "127.0.0.1:0",
                                   "--tls-cert", "tls/certificate.pem", "--tls-key", "tls/key.pem",
                                   NULL});
    wait_for_text(server.err, "listening on https");
    char *told = slurp(server.out);
    assert_int_equal(
        sscanf(told, "listening on https://127.0.0.1:%u\nfingerprint %79s", &port, fingerprint), 2);
    free(told);
    snprintf(line, sizeof line,
             "env -u RUGO_TOKEN PYTHONDONTWRITEBYTECODE=1 PYTHONPATH=%s/server/python timeout 300 "
             "python3 -c 'import rugo\n"
             "url = \"https://localhost:%u\"\n"
             "for trust in ({\"fingerprint\": \"%s\"}, {\"ca_file\": \"tls/certificate.pem\"}):\n"
             "    assert rugo.Server(url, **trust).studies() == []\n"
             "for trust in ({}, {\"fingerprint\": \"sha256:\" + 64 * \"0\"}):\n"
             "    try:\n"
             "        rugo.Server(url, **trust).studies()\n"
             "        raise AssertionError(trust)\n"
             "    except rugo.RugoError as error:\n"
             "        assert error.status is None and not error.lost, error\n"
             "        assert \"(\" not in str(error) or not trust, error\n"
             "print(\"TLS: all as it should be\")' >tls.told 2>&1",
             source(), port, fingerprint);
    int status = system(line);
    told = slurp("tls.told");
    if (status != 0)
        print_error("%s", told);
    assert_int_equal(status, 0);
    assert_non_null(strstr(told, "TLS: all as it should be"));
    free(told);
    process_kill(&server, SIGTERM);
    assert_int_equal(process_wait(&server, 15), 0);
}

/* The service gives away the file that is in the tree. */
static void the_service_gives_it_away(void **state) {
    (void)state;
    struct process server = {0};
    char path[600], *answer;
    snprintf(path, sizeof path, "%s/server/python/rugo/client.py", source());
    char *file = slurp(path);
    unsigned port = serve_start(&server, NULL);
    assert_int_equal(http_exchange(port, "GET", "/rugo.py", NULL, NULL, &answer), 200);
    assert_string_equal(answer, file);
    free(answer);
    free(file);
    process_kill(&server, SIGTERM);
    assert_int_equal(process_wait(&server, 15), 0);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_client_works_alone),
        cmocka_unit_test(the_package_and_its_page),
        cmocka_unit_test(the_client_speaks_tls),
        cmocka_unit_test(the_service_gives_it_away),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
