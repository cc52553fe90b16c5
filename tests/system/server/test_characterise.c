/* Protects: a file that is sent to a service, or a form of several, is characterised as the command
 * does it, and drawn; a study that is sent with files is fitted to these alone;
 * what is wrong with it, or with the query, is reported as a problem; no file, however it is made,
 * harms the service; and a client that goes ends the work. */
#include "tests/support/check.h"
#include "tests/support/process.h"
#include <cjson/cJSON.h>
#include <dirent.h>
#include <math.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <unistd.h>

static const char BYTES[] = "Content-Type: application/octet-stream\r\n";
static struct process server;
static unsigned port;
static char *csv; /* a map, as text */

/* Heights without order, as waves would be grooves, of which no studies are made; with a hole. The
 * caller frees. */
static char *make_csv(size_t ny, size_t nx) {
    char *text = calloc(ny * nx + 1, 12);
    size_t used = 0;
    assert_non_null(text);
    for (size_t j = 0; j < ny; j++)
        for (size_t i = 0; i < nx; i++) {
            double z = cos(43758.5 * sin(12.9898 * (double)i + 78.233 * (double)j));
            const char *after = i + 1 < nx ? "," : "\n";
            if (i == 5 && j == 7)
                used += (size_t)sprintf(text + used, "nan%s", after);
            else
                used += (size_t)sprintf(text + used, "%.4f%s", z, after);
        }
    return text;
}

static int start(void **state) {
    (void)state;
    spit_secret("tokens", "read:reader-token-0123456789\n");
    csv = make_csv(48, 64);
    port = serve_start(&server, (const char *[]){"--map-size", "1", NULL});
    return 0;
}

static int stop(void **state) {
    (void)state;
    free(csv);
    process_kill(&server, SIGTERM);
    return process_wait(&server, 15);
}

static int post(const char *query, const char *headers, const char *body, char **answer) {
    char path[512];
    snprintf(path, sizeof path, "/v1/characterise?%s", query);
    return http_exchange(port, "POST", path, headers, body, answer);
}

static void refused(const char *query, const char *headers, const char *body, int status,
                    const char *word) {
    char *answer = NULL;
    int found = post(query, headers, body, &answer);
    if (found != status || strstr(answer, word) == NULL)
        print_error("%s: %d, %s\n", query, found, answer);
    assert_int_equal(found, status);
    assert_non_null(strstr(answer, word));
    cJSON *problem = cJSON_Parse(answer);
    assert_true(cJSON_GetObjectItem(problem, "status")->valuedouble == status);
    cJSON_Delete(problem);
    free(answer);
}

static void the_service_says_what_the_command_says(void **state) {
    (void)state;
    char *answer = NULL;
    spit("map.csv", csv);
    const char *const command[] = {"characterise", "map.csv", "--dx",      "0.5um",
                                   "--z-unit",     "nm",      "--detrend", "quadratic",
                                   "--format",     "json",    NULL};
    assert_int_equal(run_rugo("near", command), 0);
    char *near = slurp("near.out");
    assert_int_equal(post("name=map.csv&dx=0.5um&z_unit=nm&detrend=quadratic", BYTES, csv, &answer),
                     200);
    assert_string_equal(answer, near);
    free(near);
    free(answer);
    const char *const drawing[] = {"characterise", "map.csv",  "--format", "svg",
                                   "--report",     "page.svg", NULL};
    assert_int_equal(run_rugo("near", drawing), 0);
    near = slurp("near.out");
    char *report = slurp("page.svg");
    assert_string_equal(report, near);
    char headers[120];
    snprintf(headers, sizeof headers, "%sAccept: image/svg+xml\r\n", BYTES);
    assert_int_equal(post("name=map.csv", headers, csv, &answer), 200);
    assert_string_equal(answer, near);
    free(near);
    free(report);
    free(answer);
}

/* What the answer is can be sent on as a study. */
static void a_study_of_surfaces_like_it_is_made(void **state) {
    (void)state;
    char *answer = NULL, *plan = NULL;
    assert_int_equal(post("name=a/map.csv&format=study&fill=true", BYTES, csv, &answer), 200);
    assert_non_null(strstr(answer, "\"name\":\"like map.csv\""));
    assert_non_null(strstr(answer, "\"sha256\":"));
    assert_int_equal(http_exchange(port, "POST", "/v1/check", "Content-Type: application/json\r\n",
                                   answer, &plan),
                     200);
    free(plan);
    free(answer);
    assert_int_equal(post("name=map.csv&format=study&hold=true", BYTES, csv, &answer), 200);
    assert_non_null(strstr(answer, "\"hold\":true"));
    free(answer);
}

/* Returns a form of these files, and of a study unless it is NULL; the caller frees. */
static char *make_form(const char *const *names, const char *study) {
    char *text = NULL;
    size_t size;
    FILE *file = open_memstream(&text, &size);
    assert_non_null(file);
    for (; *names != NULL; names++)
        fprintf(
            file,
            "--b0\r\nContent-Disposition: form-data; name=\"map\"; filename=\"%s\"\r\n\r\n%s\r\n",
            *names, csv);
    if (study != NULL)
        fprintf(file, "--b0\r\nContent-Disposition: form-data; name=\"study\"\r\n\r\n%s\r\n",
                study);
    fputs("--b0--\r\n", file);
    assert_int_equal(fclose(file), 0);
    return text;
}

static const char FORM[] = "Content-Type: multipart/form-data; boundary=b0\r\n";
static const char *const TWO[] = {"a.csv", "b.csv", NULL};

/* Files of one surface together, as the command has them. */
static void several_maps_are_sent_as_a_form(void **state) {
    (void)state;
    static const char *const FORMATS[] = {"json", "svg", "study"};
    char *form = make_form(TWO, NULL);
    spit("a.csv", csv);
    spit("b.csv", csv);
    for (size_t f = 0; f < sizeof FORMATS / sizeof *FORMATS; f++) {
        const char *const command[] = {"characterise", "a.csv", "b.csv",    "--together", "--fill",
                                       "--dx",         "1",     "--format", FORMATS[f],   NULL};
        char query[80], *answer = NULL;
        snprintf(query, sizeof query, "together=true&fill=true&dx=1&format=%s", FORMATS[f]);
        assert_int_equal(run_rugo("near", command), 0);
        char *near = slurp("near.out");
        assert_int_equal(post(query, FORM, form, &answer), 200);
        assert_string_equal(answer, near);
        free(near);
        free(answer);
    }
    refused("format=json", FORM, form, 422, "several files");
    refused("together=true&name=a.csv", FORM, form, 422, "names of their own");
    refused("together=true&hold=true&format=study&fill=true", FORM, form, 422, "hold one map");
    refused("together=true&hold=true&fill=true", FORM, form, 422,
            "--hold goes with --format study");
    refused("trust_from=5&format=study&name=a.csv", "Content-Type: application/octet-stream\r\n",
            csv, 422, "--trust-from and --trust-to do not go with --format study");
    refused("together=true", "Content-Type: multipart/form-data\r\n", form, 422, "boundary");
    refused("together=true", "Content-Type: multipart/form-data; boundary=b1\r\n", form, 422,
            "without files by the boundary");
    free(form);
    static const char *const TWICE[] = {"a.csv", "a.csv", NULL};
    form = make_form(TWICE, NULL);
    refused("together=true", FORM, form, 422, "two files named a.csv");
    free(form);
}

/* What is wrong with a form itself. */
static void forms_that_are_none_are_refused(void **state) {
    (void)state;
#define PART(said, bytes) "--b0\r\nContent-Disposition: form-data; " said "\r\n\r\n" bytes "\r\n"
#define END "--b0--\r\n"
    static const struct {
        const char *text, *words;
    } FAULTS[] = {
        {"1,2", "without files"},
        {END, "without files"},
        {PART("name=\"study\"", "{}") END, "without files"},
        {PART("name=\"map\"", "1") END, "neither a file nor"},
        {PART("name=\"map\"; filename=\"a\"", "1") PART("name=\"x\"", "1") END, "neither a file"},
        {PART("name=\"map\"; filename=\"\"", "1") END, "a file of a form has a name"},
        {PART("name=\"study\"", "1") PART("name=\"study\"", "2") END, "a second study"},
        {PART("name=\"map\"; filename=\"a\"", "1"), "the form is cut"},
        {"--b0\r\nContent-Disposition: form-data", "the form is cut"},
        {PART("name=\"map\"; filename=\"--all\"", "") END, "--all"},
    };
    for (size_t f = 0; f < sizeof FAULTS / sizeof *FAULTS; f++)
        refused("format=json", FORM, FAULTS[f].text, 422, FAULTS[f].words);
}

/* A study that is sent with files is fitted to these, and to none of the server's own. */
static void a_study_is_fitted_to_what_was_sent(void **state) {
    (void)state;
#define ALIKE(like)                                                                                \
    "{\"name\":\"mine\",\"kind\":\"statistics\",\"realisations\":2,\"surface\":{\"like\":" like "}}"
    char *form = make_form(
        TWO, ALIKE("{\"file\":[\"a.csv\",\"b.csv\"],\"dx\":1,\"fill\":true,\"off\":\"stated\"}"));
    char *answer = NULL;
    assert_int_equal(post("format=study", FORM, form, &answer), 200);
    assert_non_null(strstr(answer, "\"name\":\"mine\""));
    assert_non_null(strstr(answer, "\"maps\":["));
    refused("format=json", FORM, form, 422, "goes with the format study");
    free(answer);
    free(form);
    static const struct {
        const char *study, *words;
    } FAULTS[] = {
        {ALIKE("\"near.out\""), "near.out: no file of this name was sent"},
        {ALIKE("[\"a.csv\",\"/etc/passwd\"]"), "/etc/passwd: no file of this name was sent"},
        {ALIKE("7"), "neither the name of a file"},
        {"{\"surface\":{}}", "no name of a file that was sent"},
        {"[1", "the study: "},
    };
    for (size_t f = 0; f < sizeof FAULTS / sizeof *FAULTS; f++) {
        form = make_form(TWO, FAULTS[f].study);
        refused("format=study&fill=true", FORM, form, 422, FAULTS[f].words);
        free(form);
    }
}

static void faults_are_problems(void **state) {
    (void)state;
    refused("name=map.csv&colour=red", BYTES, csv, 422, "?colour");
    refused("layer=1", BYTES, csv, 422, "?name");
    refused("name=map.csv&boundary=round", BYTES, csv, 422, "round");
    refused("name=map.csv&fill=yes", BYTES, csv, 422, "yes is not true or false");
    refused("name=map.csv&format=text", BYTES, csv, 422, "json, svg or study");
    refused("name=map.csv&dx=--help", BYTES, csv, 422, "--help");
    refused("name=map.csv&dx=0.5um", BYTES, csv, 422, "z-unit");
    refused("name=map.npy", BYTES, csv, 422, "map.npy");
    refused("name=-o", BYTES, "1,2\n3\n", 422, "-o: ");
    refused("name=map.csv", BYTES, "", 400, "bytes of the file");
    refused("name=map.csv", "Content-Type: application/json\r\n", csv, 415, "octet-stream");
    char *large = calloc((1 << 20) + 2, 1);
    assert_non_null(large);
    memset(large, '1', (1 << 20) + 1);
    refused("name=map.csv", BYTES, large, 413, "1 MiB");
    free(large);
    char long_name[400];
    snprintf(long_name, sizeof long_name, "name=%0380d", 1);
    refused(long_name, BYTES, csv, 422, "longer than 300 bytes");
}

/* The name is a text, whatever stands in it: in JSON, on the page, and never an option. */
static void names_are_texts(void **state) {
    (void)state;
    char *answer = NULL, headers[120];
    snprintf(headers, sizeof headers, "%sAccept: image/svg+xml\r\n", BYTES);
    assert_int_equal(post("name=%22%3Cscript%3E%01%ff--report=x.csv", headers, csv, &answer), 200);
    assert_null(strstr(answer, "<script"));
    assert_null(strchr(answer, 1));
    free(answer);
    assert_int_equal(access("x.csv", F_OK), -1);
    assert_int_equal(post("name=%22%3Cscript%3E%01%ff--report=x.csv", BYTES, csv, &answer), 200);
    cJSON *document = cJSON_Parse(answer);
    assert_non_null(document);
    cJSON_Delete(document);
    free(answer);
}

/* Files cut and changed at random, of every name: refused or not, the service answers on. */
static void damaged_files_harm_nobody(void **state) {
    (void)state;
    static const char *const NAMES[] = {"a.npy", "a.npz", "a.x3p", "a.sdf", "a.gwy", "a.csv",
                                        "a.xyz", "a.txt", "a.asc", "a",     "a.zip"};
    unsigned seed = 20251122;
    for (size_t n = 0; n < sizeof NAMES / sizeof *NAMES; n++) {
        char query[32], *answer = NULL, body[400];
        for (size_t b = 0; b + 1 < sizeof body; b++) {
            seed = seed * 1664525 + 1013904223;
            body[b] = (char)(seed >> 24 != 0 ? seed >> 24 : 1);
        }
        body[sizeof body - 1] = '\0';
        snprintf(query, sizeof query, "name=%s", NAMES[n]);
        assert_int_equal(post(query, BYTES, body, &answer), 422);
        assert_non_null(strstr(answer, NAMES[n]));
        free(answer);
    }
    assert_int_equal(http_exchange(port, "GET", "/healthz", "", NULL, NULL), 200);
}

static void tokens_are_those_of_readers(void **state) {
    (void)state;
    struct process closed;
    char headers[160];
    process_kill(&server, SIGTERM);
    assert_int_equal(process_wait(&server, 15), 0);
    port =
        serve_start(&closed, (const char *[]){"--token-file", "tokens", "--map-size", "0", NULL});
    refused("name=map.csv", BYTES, csv, 401, "token");
    snprintf(headers, sizeof headers, "%sAuthorization: Bearer reader-token-0123456789\r\n", BYTES);
    refused("name=map.csv", headers, csv, 403, "--map-size"); /* it may, but none are taken here */
    process_kill(&closed, SIGTERM);
    assert_int_equal(process_wait(&closed, 15), 0);
    port = serve_start(&server, (const char *[]){"--map-size", "1", NULL});
}

/* Returns how many processes the service has started that have not ended. */
static size_t children_of(pid_t parent) {
    size_t count = 0;
    DIR *folder = opendir("/proc");
    assert_non_null(folder);
    for (struct dirent *entry; (entry = readdir(folder)) != NULL;) {
        char path[300];
        int above = 0;
        snprintf(path, sizeof path, "/proc/%.200s/stat", entry->d_name);
        FILE *file = fopen(path, "r");
        if (file == NULL)
            continue;
        if (fscanf(file, "%*d (%*[^)]) %*c %d", &above) == 1)
            count += above == parent;
        (void)fclose(file);
    }
    (void)closedir(folder);
    return count;
}

/* Two are looked at, the third is asked to come again; and none is when their clients have gone.
 * The maps are so large that the work on them, of seconds, is seen. */
static void clients_that_go_end_the_work(void **state) {
    (void)state;
    enum { SIDE = 1000 };
    struct process own;
    unsigned other = port;
    char *map = make_csv(SIDE, SIDE), request[300];
    int sockets[2];
    size_t size = strlen(map), seen = 0;
    assert_true(size < 15 << 20);
    port = serve_start(&own, (const char *[]){"--db", "own.db", "--map-size", "15", NULL});
    int length = snprintf(request, sizeof request,
                          "POST /v1/characterise?name=a.csv HTTP/1.1\r\nHost: localhost\r\n"
                          "%sExpect: 100-continue\r\nContent-Length: %zu\r\n\r\n",
                          BYTES, size);
    for (size_t n = 0; n < 2; n++) { /* they have entered when they are asked to go on */
        char told[64] = "";
        sockets[n] = http_connect(port);
        assert_int_equal(send(sockets[n], request, (size_t)length, MSG_NOSIGNAL), length);
        assert_true(recv(sockets[n], told, sizeof told - 1, 0) > 0);
        assert_non_null(strstr(told, " 100 "));
    }
    refused("name=map.csv", BYTES, csv, 503, "other files");
    for (size_t n = 0; n < 2; n++)
        for (size_t sent = 0; sent < size;) {
            ssize_t count = send(sockets[n], map + sent, size - sent, MSG_NOSIGNAL);
            assert_true(count > 0);
            sent += (size_t)count;
        }
    for (int tries = 0; tries < 4000 && seen == 0; tries++, sleep_ms(5))
        seen = children_of(own.pid);
    assert_true(seen > 0);
    for (size_t n = 0; n < 2; n++)
        (void)close(sockets[n]);
    for (int tries = 0; children_of(own.pid) > 0; tries++, sleep_ms(10))
        assert_true(tries < 3000);
    char *answer = NULL;
    int status = 503;
    for (int tries = 0; tries < 1500 && status == 503; tries++, sleep_ms(20)) {
        status = post("name=map.csv", BYTES, csv, &answer);
        free(answer);
    }
    assert_int_equal(status, 200);
    free(map);
    process_kill(&own, SIGTERM);
    assert_int_equal(process_wait(&own, 20), 0);
    port = other;
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_service_says_what_the_command_says),
        cmocka_unit_test(a_study_of_surfaces_like_it_is_made),
        cmocka_unit_test(several_maps_are_sent_as_a_form),
        cmocka_unit_test(forms_that_are_none_are_refused),
        cmocka_unit_test(a_study_is_fitted_to_what_was_sent),
        cmocka_unit_test(faults_are_problems),
        cmocka_unit_test(names_are_texts),
        cmocka_unit_test(damaged_files_harm_nobody),
        cmocka_unit_test(tokens_are_those_of_readers),
        cmocka_unit_test(clients_that_go_end_the_work),
    };
    return cmocka_run_group_tests(tests, start, stop);
}
