/* Protects: what the page is made of: its files, what a study holds, a study's plan before it runs,
 * the ready studies, workers, and maps of single realisations. The page itself: tests/browser. */
#include "schema/json/json.h"
#include "tests/support/check.h"
#include "tests/support/process.h"
#include <math.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <unistd.h>

static const char STUDY[] =
    "{\"name\":\"looked at\",\"kind\":\"contact\",\"seed\":7,\"realisations\":3,\"surface\":{"
    "\"dimension\":1,\"hurst\":[0.3,0.7],\"wavelength_ratio\":4,\"length_ratio\":4},\"contact\":{"
    "\"cell_error\":\"none\",\"tolerance\":1e-8,"
    "\"model\":[\"halfspace\",\"layered\"],\"pressures\":{\"to\":0.1,\"steps\":2}}}";
static const char MAP[] = "/v1/studies/looked%20at/cases/1/realisations/2/map";

static struct process server;
static unsigned port;

static int start(void **state) {
    (void)state;
    char url[64];
    port = serve_start(&server, (const char *[]){"--workers", "1", NULL});
    assert_int_equal(http_exchange(port, "POST", "/v1/studies",
                                   "Content-Type: application/json\r\n", STUDY, NULL),
                     201);
    snprintf(url, sizeof url, "http://127.0.0.1:%u", port);
    assert_int_equal(run_rugo("wait", (const char *[]){"wait", "--server", url, "looked at", NULL}),
                     0);
    return 0;
}

static int stop(void **state) {
    (void)state;
    process_kill(&server, SIGTERM);
    return process_wait(&server, 15);
}

static cJSON *get(const char *path) {
    char *answer = NULL;
    assert_int_equal(http_exchange(port, "GET", path, "", NULL, &answer), 200);
    cJSON *document = cJSON_Parse(answer);
    assert_non_null(document);
    free(answer);
    return document;
}

static void contents_name_cases_curves_and_scalars(void **state) {
    (void)state;
    cJSON *document = get("/v1/studies/looked%20at/contents");
    const cJSON *cases = cJSON_GetObjectItem(document, "cases");
    assert_int_equal(cJSON_GetArraySize(cases), 2);
    const cJSON *swept = cJSON_GetObjectItem(cJSON_GetArrayItem(cases, 1), "swept");
    assert_int_equal(cJSON_GetArraySize(swept), 1); /* what all cases share is not listed */
    assert_true(cJSON_GetObjectItem(swept, "/surface/hurst")->valuedouble == 0.7);
    const cJSON *area = cJSON_GetArrayItem(cJSON_GetObjectItem(document, "curves"), 0);
    assert_string_equal(cJSON_GetObjectItem(area, "quantity")->valuestring, "contact_area");
    assert_int_equal(cJSON_GetArraySize(cJSON_GetObjectItem(area, "models")), 2);
    assert_true(cJSON_GetArraySize(cJSON_GetObjectItem(area, "series")) > 1);
    assert_null(cJSON_GetObjectItem(area, "y"));
    assert_true(cJSON_GetArraySize(cJSON_GetObjectItem(document, "scalars")) > 3);
    cJSON_Delete(document);
}

static void a_plan_is_told_and_nothing_kept(void **state) {
    (void)state;
    char *answer = NULL;
    static const char JSON[] = "Content-Type: application/json\r\n";
    assert_int_equal(http_exchange(port, "POST", "/v1/check", JSON, STUDY, &answer), 200);
    cJSON *plan = cJSON_Parse(answer);
    assert_true(cJSON_GetObjectItem(plan, "seconds")->valuedouble > 0);
    assert_int_equal(cJSON_GetArraySize(cJSON_GetObjectItem(plan, "cases")), 2);
    cJSON_Delete(plan);
    free(answer);
    assert_int_equal(http_exchange(port, "POST", "/v1/check", JSON,
                                   "{\"name\":\"n\",\"kind\":\"statistics\",\"surface\":{\"hurst\":"
                                   "1.4,\"wavelength_ratio\":4}}",
                                   &answer),
                     422);
    assert_non_null(strstr(answer, "/surface/hurst"));
    free(answer);
    cJSON *list = get("/v1/studies");
    assert_int_equal(cJSON_GetArraySize(cJSON_GetObjectItem(list, "studies")), 1);
    cJSON_Delete(list);
}

static void ready_studies_can_run(void **state) {
    (void)state;
    cJSON *list = get("/v1/templates");
    const cJSON *one;
    assert_true(cJSON_GetArraySize(list) > 10);
    cJSON_ArrayForEach(one, list) {
        char *text = cJSON_PrintUnformatted(one);
        assert_int_equal(http_exchange(port, "POST", "/v1/check",
                                       "Content-Type: application/json\r\n", text, NULL),
                         200);
        free(text);
    }
    cJSON_Delete(list);
}

static void the_worker_is_listed(void **state) {
    (void)state;
    cJSON *document = get("/v1/workers");
    const cJSON *workers = cJSON_GetObjectItem(document, "workers");
    assert_int_equal(cJSON_GetArraySize(workers), 1);
    assert_true(
        cJSON_GetObjectItem(cJSON_GetArrayItem(workers, 0), "jobs_last_hour")->valuedouble >= 2);
    assert_int_equal(cJSON_GetObjectItem(document, "waiting")->valueint, 0);
    cJSON_Delete(document);
}

/* Fetches the map at a query into a file and reads the doubles behind its head. */
static size_t fetch_map(const char *query, double *values, size_t most) {
    char line[300], head[10];
    snprintf(line, sizeof line, "curl -sf -o map.npy 'http://127.0.0.1:%u%s%s'", port, MAP, query);
    assert_int_equal(system(line), 0);
    FILE *file = fopen("map.npy", "rb");
    assert_non_null(file);
    assert_int_equal(fread(head, 1, sizeof head, file), sizeof head);
    assert_int_equal(
        fseek(file, 10 + (unsigned char)head[8] + 256 * (unsigned char)head[9], SEEK_SET), 0);
    size_t count = fread(values, sizeof *values, most, file);
    fclose(file);
    return count;
}

static void maps_are_those_of_the_realisation(void **state) {
    (void)state;
    enum { MOST = 4096 };
    static double z[MOST], gap[MOST], pressure[MOST];
    if (system("command -v curl >/dev/null") != 0)
        skip();
    size_t n = fetch_map("", z, MOST);
    assert_int_equal(n, 4 * 4 * 8);
    assert_int_equal(fetch_map("?field=gap&load=0.1", gap, MOST), n);
    assert_int_equal(fetch_map("?field=pressure&load=0.1", pressure, MOST), n);
    double mean = 0;
    size_t touching = 0;
    for (size_t i = 0; i < n; i++) {
        mean += pressure[i] / (double)n;
        touching += pressure[i] > 0;
        assert_true(pressure[i] == 0 || fabs(gap[i]) < 1e-6); /* the solver's tolerance: 1e-8 */
    }
    assert_true(fabs(mean - 0.1) < 1e-12); /* the load, but for rounding */
    assert_true(touching > n / 20 && touching < n);
}

/* Every node of the study's two loads has a row; the pressures of a load have it as their mean. */
static void nodes_are_those_of_the_realisation(void **state) {
    (void)state;
    char *answer = NULL, path[120], request[240];
    const char *at;
    double load, pressure, sum[2] = {0};
    size_t rows[2] = {0};
    snprintf(path, sizeof path, "/v1/studies/looked%%20at/cases/1/realisations/2/nodes");
    snprintf(path + strlen(path), sizeof path - strlen(path), "?load=0.05,0.1");
    assert_int_equal(http_exchange(port, "GET", path, "", NULL, &answer), 200);
    at = strstr(answer, "load,node,x,y,z,gap,pressure,status\n");
    assert_non_null(at);
    while ((at = strchr(at, '\n') + 1) != NULL && *at != '\0') {
        assert_int_equal(
            sscanf(at, "%lf,%*[^,],%*[^,],%*[^,],%*[^,],%*[^,],%lf,", &load, &pressure), 2);
        rows[load > 0.07]++;
        sum[load > 0.07] += pressure;
    }
    assert_int_equal(rows[0], 4 * 4 * 8);
    assert_int_equal(rows[1], rows[0]);
    assert_true(fabs(sum[0] / (double)rows[0] - 0.05) < 1e-8); /* 9 digits are written */
    assert_true(fabs(sum[1] / (double)rows[1] - 0.1) < 1e-8);
    free(answer);
    snprintf(request, sizeof request,
             "HEAD %s HTTP/1.1\r\nHost: localhost\r\nAccept-Encoding: gzip\r\n"
             "Connection: close\r\n\r\n",
             path);
    answer = http_raw(port, request, strlen(request));
    assert_non_null(strstr(answer, "Content-Encoding: gzip")); /* a text of more than 4 KiB */
    free(answer);
    assert_int_equal(
        http_exchange(port, "GET",
                      "/v1/studies/looked%20at/cases/1/realisations/2/nodes?load=0.1&format=vtu",
                      "", NULL, &answer),
        200);
    assert_non_null(strstr(answer, "Name=\"pressure\""));
    free(answer);
}

/* What is asked for by a name may be of another study the next time. Words of the path may be names
 * of studies. */
static void maps_of_names_are_not_kept(void **state) {
    (void)state;
    static const char *const NAMES[] = {"cases", "realisations"};
    static const char *const ENDS[] = {"map", "nodes?load=0.1"};
    char study[sizeof STUDY + 8], request[200], name[40], id[20];
    cJSON *known = get("/v1/studies/looked%20at");
    snprintf(id, sizeof id, "%s", cJSON_GetObjectItem(known, "id")->valuestring);
    cJSON_Delete(known);
    snprintf(name, sizeof name, "%.8s", id);
    const char *const asked[] = {id, "looked%20at", name, NAMES[0], NAMES[1]};
    for (size_t n = 0; n < sizeof NAMES / sizeof *NAMES; n++) {
        snprintf(study, sizeof study, "{\"name\":\"%s\"%s", NAMES[n], strchr(STUDY, ','));
        assert_int_equal(http_exchange(port, "POST", "/v1/studies",
                                       "Content-Type: application/json\r\n", study, NULL),
                         201);
    }
    for (size_t a = 0; a < sizeof asked / sizeof *asked; a++)
        for (size_t e = 0; e < sizeof ENDS / sizeof *ENDS; e++) {
            snprintf(request, sizeof request,
                     "GET /v1/studies/%s/cases/0/realisations/0/%s HTTP/1.1\r\n"
                     "Host: localhost\r\nConnection: close\r\n\r\n",
                     asked[a], ENDS[e]);
            char *answer = http_raw(port, request, strlen(request));
            assert_non_null(strstr(answer, " 200 "));
            assert_int_equal(strstr(answer, "immutable") != NULL, a == 0);
            assert_int_equal(strstr(answer, "no-cache") != NULL, a != 0);
            free(answer);
        }
}

static void maps_that_there_are_not(void **state) {
    (void)state;
    static const struct {
        const char *path;
        unsigned status;
        const char *said;
    } WRONG[] = {
        {"/v1/studies/looked%20at/cases/1/realisations/3/map", 404, "cases have 3"},
        {"/v1/studies/looked%20at/cases/2/realisations/0/map", 404, "case"},
        {"/v1/studies/looked%20at/cases/1x/realisations/0/map", 404, "whole numbers"},
        {"/v1/studies/looked%20at/cases/0/realisations/0/map?field=slope", 422,
         "slope is none of height|gap|pressure"},
        {"/v1/studies/looked%20at/cases/0/realisations/0/map?field=gap", 422, "load"},
        {"/v1/studies/looked%20at/cases/0/realisations/0/map?field=gap&load=nan", 422, "load"},
        {"/v1/studies/nothing/cases/0/realisations/0/map", 404, "nothing"},
        {"/v1/studies/looked%20at/cases/1/realisations/3/nodes", 404, "cases have 3"},
        {"/v1/studies/looked%20at/cases/0/realisations/0/nodes?load=0.2,0.1", 422, "rising loads"},
        {"/v1/studies/looked%20at/cases/0/realisations/0/nodes?load=inf", 422, "rising loads"},
        {"/v1/studies/looked%20at/cases/0/realisations/0/nodes?format=xml", 422,
         "xml is none of csv|vtu"},
        {"/v1/studies/looked%20at/cases/0/realisations/0/nodes?format=vtu", 422, "one load"},
        {"/v1/studies/looked%20at/cases/0/realisations/0/nodes?model=full", 422, "no model full"}};
    for (size_t w = 0; w < sizeof WRONG / sizeof *WRONG; w++) {
        char *answer = NULL;
        assert_int_equal(http_exchange(port, "GET", WRONG[w].path, "", NULL, &answer),
                         WRONG[w].status);
        assert_non_null(strstr(answer, WRONG[w].said));
        free(answer);
    }
}

enum { SOCKETS = 16 };

/* Asks for maps that take long until no more are computed at a time, without waiting for any. */
static size_t ask_long(unsigned at, int sockets[SOCKETS]) {
    static const char LONG[] =
        "GET /v1/studies/long/cases/0/realisations/0/map?field=gap&load=0.01 HTTP/1.1\r\n"
        "Host: localhost\r\nConnection: close\r\n\r\n";
    for (size_t n = 0; n < SOCKETS;) {
        sockets[n] = http_connect(at);
        assert_int_equal(write(sockets[n++], LONG, sizeof LONG - 1), sizeof LONG - 1);
        sleep_ms(200);
        if (http_exchange(at, "GET", MAP, "", NULL, NULL) == 503)
            return n;
    }
    fail_msg("%d long maps at a time", SOCKETS);
    return 0;
}

/* Neither a peer that has left nor a server that is to end waits for a contact that takes long: one
 * that is looked at, or one of its workers'. */
static void maps_that_nobody_waits_for_are_given_up(void **state) {
    (void)state;
    static const char JSON[] = "Content-Type: application/json\r\n";
    static const char LONG[] =
        "{\"name\":\"long\",\"kind\":\"contact\",\"seed\":1,\"realisations\":1,\"surface\":{"
        "\"dimension\":1,\"hurst\":0.8,\"wavelength_ratio\":8192,\"length_ratio\":8,"
        "\"points_per_wavelength\":8},\"contact\":{\"model\":\"halfspace\",\"pressures\":{\"to\":0."
        "1,"
        "\"steps\":2}}}"; /* half a million points */
    struct process other;
    int sockets[SOCKETS];
    char answer[2048];
    unsigned at = serve_start(&other, (const char *[]){"--db", "long.db", "--workers", "1", NULL});
    assert_int_equal(http_exchange(at, "POST", "/v1/studies", JSON, STUDY, NULL), 201);
    assert_int_equal(http_exchange(at, "POST", "/v1/studies", JSON, LONG, NULL), 201);
    size_t count = ask_long(at, sockets);
    for (size_t n = 0; n < count; n++)
        close(sockets[n]);
    int waited = 0;
    while (http_exchange(at, "GET", MAP, "", NULL, NULL) != 200 && ++waited < 1200)
        sleep_ms(100);
    assert_true(waited < 1200); /* a map goes on for a few iterations */
    count = ask_long(at, sockets);
    process_kill(&other, SIGTERM);
    assert_int_equal(process_wait(&other, 20), 0);
    for (size_t n = 0; n < count; n++) { /* those who can be reached in time are */
        ssize_t got = recv(sockets[n], answer, sizeof answer - 1, MSG_WAITALL);
        answer[got > 0 ? got : 0] = '\0';
        assert_true(got <= 0 || strstr(answer, "HTTP/1.1 503") != NULL);
        close(sockets[n]);
    }
}

static void a_picture_is_a_png(void **state) {
    (void)state;
    char line[300];
    if (system("command -v curl >/dev/null") != 0)
        skip();
    snprintf(line, sizeof line,
             "curl -sf -H 'Accept: image/png' -o map.png 'http://127.0.0.1:%u%s'", port, MAP);
    assert_int_equal(system(line), 0);
    FILE *file = fopen("map.png", "rb");
    unsigned char head[24];
    assert_non_null(file);
    assert_int_equal(fread(head, 1, sizeof head, file), sizeof head);
    fclose(file);
    assert_memory_equal(head, "\x89PNG\r\n\x1a\n", 8);
    assert_int_equal(head[19], 4 * 4 * 8); /* pixels a row */
    assert_int_equal(head[23], 1);
}

static void files_of_the_page(void **state) {
    (void)state;
    static const char *const FILES[] = {"/", "/web/app.js", "/web/style.css", "/web/uplot.js",
                                        "/web/uplot.css"};
    for (size_t f = 0; f < sizeof FILES / sizeof *FILES; f++)
        assert_int_equal(http_exchange(port, "GET", FILES[f], "", NULL, NULL), 200);
    assert_int_equal(http_exchange(port, "GET", "/web/nothing.js", "", NULL, NULL), 404);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(contents_name_cases_curves_and_scalars),
        cmocka_unit_test(a_plan_is_told_and_nothing_kept),
        cmocka_unit_test(ready_studies_can_run),
        cmocka_unit_test(the_worker_is_listed),
        cmocka_unit_test(maps_are_those_of_the_realisation),
        cmocka_unit_test(nodes_are_those_of_the_realisation),
        cmocka_unit_test(maps_of_names_are_not_kept),
        cmocka_unit_test(maps_that_there_are_not),
        cmocka_unit_test(maps_that_nobody_waits_for_are_given_up),
        cmocka_unit_test(a_picture_is_a_png),
        cmocka_unit_test(files_of_the_page),
    };
    return cmocka_run_group_tests(tests, start, stop);
}
