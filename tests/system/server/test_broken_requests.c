/* Protects: the answers to a broken study or request. Each gets its status, a problem (RFC 9457)
 * with the same status, the pointer to the fault and a text that says what is wrong and what is
 * allowed; nothing is queued. */
#include "schema/json/json.h"
#include "tests/support/check.h"
#include "tests/support/process.h"
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static struct process server;
static unsigned port;

static int start(void **state) {
    (void)state;
    spit_secret("tokens",
                "read:read-token-000000\nsubmit:submit-token-000000\nwork:work-token-000000\n");
    port = serve_start(&server, (const char *[]){"--token-file", "tokens", NULL});
    return 0;
}

static int stop(void **state) {
    (void)state;
    process_kill(&server, SIGTERM);
    assert_int_equal(process_wait(&server, 15), 0);
    return 0;
}

/* Headers of a role. */
#define NONE ""
#define BEARER(role) "Authorization: Bearer " role "-token-000000\r\n"
#define READ BEARER("read")
#define SUBMIT BEARER("submit")
#define WORK BEARER("work")
#define WRONG BEARER("wrong")
#define TYPE(type) "Content-Type: " type "\r\n"
#define JSON TYPE("application/json")

struct broken_request {
    const char *method, *path, *role, *headers, *body;
    int status;
    const char *pointer; /* of the first fault; NULL: the problem has no list of faults */
    const char *detail;  /* how the fault's or the problem's text begins */
};

static const char *text_at(const cJSON *document, const char *pointer) {
    const char *text = cJSON_GetStringValue(json_at(document, pointer));
    return text ? text : "";
}

static bool is_answered(const struct broken_request *broken, const char *reply) {
    struct error err = {0};
    cJSON *problem = NULL;
    int status = 0;
    const char *body = strstr(reply, "\r\n\r\n");
    sscanf(reply, "HTTP/1.1 %d", &status);
    if (status != broken->status || !strstr(reply, "Content-Type: application/problem+json\r\n") ||
        !body || json_parse(body + 4, strlen(body + 4), NULL, &problem, &err))
        return false;
    bool listed = json_at(problem, "/errors/0") != NULL;
    const char *detail = text_at(problem, listed ? "/errors/0/detail" : "/detail");
    const char *pointer = text_at(problem, "/errors/0/pointer");
    bool good = json_at(problem, "/status") && json_at(problem, "/status")->valueint == status &&
                *text_at(problem, "/title") && *text_at(problem, "/type") &&
                listed == (broken->pointer != NULL) &&
                strcmp(pointer, broken->pointer ? broken->pointer : "") == 0 &&
                strncmp(detail, broken->detail, strlen(broken->detail)) == 0 &&
                (status != 405 || strstr(reply, "\r\nAllow: ")) &&
                (status != 401 || strstr(reply, "\r\nWWW-Authenticate: Bearer"));
    cJSON_Delete(problem);
    return good;
}

static void check_broken(const struct broken_request *broken) {
    const char *body = broken->body ? broken->body : "";
    char *request = NULL;
    bool host = strstr(broken->headers, "Host:") != NULL;
    assert_true(
        asprintf(&request,
                 "%s %s HTTP/1.1\r\nConnection: close\r\n%s%s%sContent-Length: %zu\r\n\r\n%s",
                 broken->method, broken->path, host ? "" : "Host: localhost\r\n", broken->role,
                 broken->headers, strlen(body), body) > 0);
    char *reply = http_raw(port, request, strlen(request));
    if (!is_answered(broken, reply)) {
        print_error("%s\ngot %s\nexpected %d, %s: %s\n", request, reply, broken->status,
                    broken->pointer ? broken->pointer : "no pointer", broken->detail);
        fail();
    }
    free(reply);
    free(request);
}

#define STUDY(rest) "{\"name\":\"n\",\"kind\":\"statistics\"," rest "}"
#define BESIDE(rest) STUDY("\"surface\":{\"hurst\":0.8,\"wavelength_ratio\":8}," rest)
#define SURFACE(rest) STUDY("\"surface\":{\"hurst\":0.8,\"wavelength_ratio\":8," rest "}")

static void broken_studies_are_told_what_is_wrong(void **state) {
    (void)state;
    static const struct {
        const char *body;
        int status;
        const char *pointer, *detail;
    } STUDIES[] = {
        {"[", 400, NULL, "line 1, column 2: the text ends where a value was expected"},
        {"{\"a\":1,\"a\":2}", 400, NULL, "the name \"a\" is given twice in one object"},
        {"{\"a\":01}", 400, NULL, "line 1, column 7: a malformed number"},
        {"{\"a\":1e999}", 400, NULL, "line 1, column 11: a number beyond the range of a double"},
        {"{\"a\":9007199254740993}", 400, NULL,
         "line 1, column 22: an integer beyond 2^53, which would be changed; write a larger seed "
         "as a decimal string"},
        {"{\"a\":\"\xff\"}", 400, NULL, "line 1, column 7: invalid UTF-8"},
        {"{\"a\":\"\t\"}", 400, NULL, "line 1, column 8: a control character in a string"},
        {"{} {}", 400, NULL, "line 1, column 4: text behind the end of the value"},
        {"\xef\xbb\xbf{}", 422, "/name", "missing: name of the study, shown with its results"},
        {"\xff\xfe{", 400, NULL, "the text is in UTF-16; JSON is in UTF-8"},
        {"{\"a\":NaN}", 400, NULL, "line 1, column 6: something that is no JSON value"},
        {"{'a':1}", 400, NULL, "line 1, column 2: a member name was expected"},
        {"[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[", 400, NULL,
         "line 1, column 33: nesting deeper than is allowed"},
        {"\"study\"", 422, "", "a study is a JSON object"},
        {"{}", 422, "/name", "missing: name of the study, shown with its results"},
        {"{\"name\":\"\",\"kind\":\"statistics\",\"surface\":{\"hurst\":0.8,\"wavelength_ratio\":8}"
         "}",
         422, "/name", "\"\" is not a text of 1 to 200 characters"},
        {"{\"name\":\"n\",\"kind\":\"weather\"}", 422, "/kind",
         "\"weather\" is not one of \"statistics\""},
        {STUDY("\"surface\":{\"hurst\":[0.2,1.4],\"wavelength_ratio\":8}"), 422, "/surface/hurst/1",
         "1.4 is not in (0, 1]"},
        {STUDY("\"surface\":{\"hurst\":\"high\",\"wavelength_ratio\":8}"), 422, "/surface/hurst",
         "\"high\" is not a number"},
        {STUDY("\"surface\":{\"hurst\":[],\"wavelength_ratio\":8}"), 422, "/surface/hurst",
         "an empty list; give at least one value"},
        {STUDY("\"surface\":{\"hurst\":null,\"wavelength_ratio\":8}"), 422, "/surface/hurst",
         "null is not a number"},
        {STUDY("\"surface\":{\"hurst\":0,\"wavelength_ratio\":8}"), 422, "/surface/hurst",
         "0 is not in (0, 1]"},
        {STUDY("\"surface\":{\"hurst\":0.8}"), 422, "/surface/wavelength_ratio",
         "give wavelength_ratio, or nayak_alpha in its place"},
        {SURFACE("\"nayak_alpha\":5"), 422, "/surface/nayak_alpha",
         "give two of hurst, wavelength_ratio and nayak_alpha, not all"},
        {STUDY("\"surface\":{\"hurst\":0.8,\"wavelength_ratio\":8000}"), 422,
         "/surface/points_per_wavelength",
         "a grid of 512000 points a side is too large: at most 46340"},
        {STUDY("\"surface\":{\"hurst\":0.8,\"wavelength_ratio\":0.5}"), 422,
         "/surface/wavelength_ratio", "0.5 is not in [1, 100000]"},
        {STUDY("\"surface\":7"), 422, "/surface", "7 is not an object"},
        {SURFACE("\"colour\":1"), 422, "/surface/colour", "unknown name"},
        {SURFACE("\"hursts\":1"), 422, "/surface/hursts", "unknown name; did you mean \"hurst\"?"},
        {SURFACE("\"dimension\":3"), 422, "/surface/dimension", "3 is not in [1, 2]"},
        {SURFACE("\"length_ratio\":-1"), 422, "/surface/length_ratio", "-1 is not in [1, 100000]"},
        {SURFACE("\"points_per_wavelength\":1"), 422, "/surface/points_per_wavelength",
         "1 is not in [2, 10000]"},
        {SURFACE("\"rms_slope\":1,\"rms_height\":1"), 422, "/surface/rms_height",
         "give rms_slope or rms_height, not both"},
        {SURFACE("\"heights\":{\"distribution\":\"cauchy\"}"), 422, "/surface/heights/distribution",
         "\"cauchy\" is not one of \"gaussian\", \"weibull_min\", \"weibull_max\""},
        {SURFACE("\"heights\":{\"distribution\":\"weibull_max\"}"), 422, "/surface/heights/shape",
         "the distribution needs its shape (shape C of a Weibull distribution), a number in [0.5, "
         "20]"},
        {SURFACE("\"heights\":{\"distribution\":\"weibull_max\",\"shape\":0}"), 422,
         "/surface/heights/shape", "0 is not in [0.01, 1000]"},
        {"{\"name\":\"x\",\"kind\":\"contact\",\"surface\":{\"hurst\":0.8,\"wavelength_ratio\":8,"
         "\"spectrum\":{\"type\":\"table\"}}}",
         422, "/surface/spectrum/density",
         "a table needs wave_number and density, as many of each"},
        {SURFACE("\"spectrum\":{\"type\":\"table\"}"), 422, "/surface/spectrum/density",
         "a table needs wave_number and density, as many of each"},
        {SURFACE("\"spectrum\":{\"type\":\"white\"}"), 422, "/surface/spectrum/type",
         "\"white\" is not one of \"self_affine\", \"exponential_acf\", \"table\""},
        {BESIDE("\"seed\":-1"), 422, "/seed", "-1 is not an integer of 0 or more"},
        {BESIDE("\"seed\":1.5"), 422, "/seed", "1.5 is not an integer of 0 or more"},
        {BESIDE("\"seed\":\"18446744073709551616\""), 422, "/seed",
         "\"18446744073709551616\" is not a decimal number up to 18446744073709551615"},
        {BESIDE("\"realisations\":0"), 422, "/realisations", "0 is not in [1, 10000000]"},
        {BESIDE("\"realisations\":2.5"), 422, "/realisations", "2.5 is not an integer"},
        {BESIDE("\"realisations\":{\"target_error\":0.01}"), 422, "/realisations",
         "give a number; an error is asked for by /target/error, in its place"},
        {BESIDE("\"statistics\":{\"summits\":\"seven_point\"}"), 422, "/statistics/summits",
         "\"seven_point\" is not one of \"nine_point\", \"five_point\", \"refined\""},
        {BESIDE("\"statistics\":{\"bins\":{\"height\":[1]}}"), 422, "/statistics/bins/height",
         "[1] is not an array of 3 numbers"},
        {BESIDE("\"statistics\":{\"bins\":{\"height\":[4,-4,20]}}"), 422, "/statistics/bins/height",
         "low, 4, must be below high, -4"},
        {BESIDE("\"statistics\":{\"curvature\":[]}"), 422, "/statistics/curvature",
         "an empty list; give at least one value"},
        {BESIDE("\"statistic\":{}"), 422, "/statistic",
         "unknown name; did you mean \"statistics\"?"},
        {BESIDE("\"contact\":{}"), 422, "/contact", "unknown name"},
        {"", 400, NULL, "a JSON body is needed"},
    };
    char *answer;
    for (size_t s = 0; s < sizeof STUDIES / sizeof *STUDIES; s++)
        check_broken(&(struct broken_request){"POST", "/v1/studies", SUBMIT, JSON, STUDIES[s].body,
                                              STUDIES[s].status, STUDIES[s].pointer,
                                              STUDIES[s].detail});
    assert_int_equal(http_exchange(port, "GET", "/v1/studies", READ, NULL, &answer), 200);
    assert_string_equal(answer, "{\"studies\":[]}");
    free(answer);
}

#define STRANGER "/v1/studies/0123456789abcdef"
#define TOKEN "\"token\":\"0123456789abcdef0123456789abcdef\""

static void broken_requests_are_told_what_is_wrong(void **state) {
    (void)state;
    static const struct broken_request REQUESTS[] = {
        {"POST", "/v1/studies", SUBMIT, TYPE("text/plain"), "{}", 415, NULL,
         "a body must be application/json"},
        {"POST", "/v1/studies", SUBMIT, TYPE("application/jsonlines"), "{}", 415, NULL,
         "a body must be application/json"},
        {"POST", "/v1/studies", SUBMIT, JSON "Idempotency-Key:\r\n", "{}", 400, NULL,
         "an Idempotency-Key has 1 to 200 visible ASCII characters"},
        {"POST", "/v1/studies", SUBMIT, JSON "Idempotency-Key: a b\r\n", "{}", 400, NULL,
         "an Idempotency-Key has 1 to 200 visible ASCII characters"},
        {"POST", "/v1/studies", SUBMIT, JSON "Idempotency-Key: a\r\nIdempotency-Key: b\r\n", "{}",
         400, NULL, "more than one Idempotency-Key"},
        {"POST", "/v1/studies", NONE, JSON, "{}", 401, NULL, "no Bearer token"},
        {"POST", "/v1/studies", WRONG, JSON, "{}", 401, NULL, "the token is unknown"},
        {"POST", "/v1/studies", READ, JSON, "{}", 403, NULL,
         "the token's role, read, does not allow this, which needs submit or admin"},
        {"POST", "/v1/studies", WORK, JSON, "{}", 403, NULL,
         "the token's role, work, does not allow this, which needs submit or admin"},
        {"POST", "/v1/jobs/claim", SUBMIT, JSON, "{}", 403, NULL,
         "the token's role, submit, does not allow this, which needs work"},
        {"GET", "/v1/studies", NONE, "", NULL, 401, NULL, "no Bearer token"},
        {"GET", "/v1/studies", READ, "Host: evil.example\r\n", NULL, 403, NULL,
         "the Host is no name of this server; see serve --allow-host"},
        {"GET", "/v1/studies", READ, "Origin: http://evil.example\r\n", NULL, 403, NULL,
         "requests of another origin are not answered"},
        {"PUT", "/v1/studies", SUBMIT, JSON, "{}", 405, NULL,
         "PUT is not allowed here; allowed: POST, GET, HEAD"},
        {"OPTIONS", "/v1/studies", READ, "", NULL, 405, NULL,
         "OPTIONS is not allowed here; allowed: POST, GET, HEAD"},
        {"DELETE", "/healthz", SUBMIT, "", NULL, 405, NULL,
         "DELETE is not allowed here; allowed: GET, HEAD"},
        {"GET", "/v1/jobs/claim", WORK, "", NULL, 405, NULL,
         "GET is not allowed here; allowed: POST"},
        {"get", "/healthz", READ, "", NULL, 405, NULL,
         "get is not allowed here; allowed: GET, HEAD"},
        {"GET", "/nowhere", READ, "", NULL, 404, NULL, "there is nothing at /nowhere"},
        {"GET", "/v1/studies/", READ, "", NULL, 404, NULL, "there is nothing at /v1/studies/"},
        {"GET", "/healthz%00", READ, "", NULL, 404, NULL, "there is nothing at /healthz%00"},
        {"GET", "/%ff%0a", READ, "", NULL, 404, NULL, "there is nothing at /?\n"},
        {"GET", "/v1/studies?limit=0", READ, "", NULL, 422, "?limit", "0 is not in [1, 1000]"},
        {"GET", "/v1/studies?limit=many", READ, "", NULL, 422, "?limit",
         "many is not in [1, 1000]"},
        {"GET", "/v1/studies?limit=%2B5", READ, "", NULL, 422, "?limit", "+5 is not in [1, 1000]"},
        {"GET", "/v1/studies?limit", READ, "", NULL, 422, "?limit", "no value"},
        {"GET", "/v1/studies?limit=1&limit=2", READ, "", NULL, 422, "?limit", "given twice"},
        {"GET", "/v1/studies?limt=1", READ, "", NULL, 422, "?limt",
         "unknown name (did you mean limit?)"},
        {"GET", STRANGER "/curves?cas=0", READ, "", NULL, 422, "?cas",
         "unknown name (did you mean case?)"},
        {"GET", "/v1/studies?after=0123456789abcdef", READ, "", NULL, 404, NULL,
         "there is no study \"0123456789abcdef\""},
        {"GET", "/v1/studies?limit=99999999999999999999", READ, "", NULL, 422, "?limit",
         "99999999999999999999 is not in [1, 1000]"},
        {"GET", STRANGER, READ, "", NULL, 404, NULL, "there is no study \"0123456789abcdef\""},
        {"DELETE", STRANGER, SUBMIT, "", NULL, 404, NULL, "there is no study \"0123456789abcdef\""},
        {"POST", STRANGER "/retry", SUBMIT, "", NULL, 404, NULL,
         "there is no study \"0123456789abcdef\""},
        {"GET", STRANGER "/curves", READ, "", NULL, 404, NULL,
         "there is no study \"0123456789abcdef\""},
        {"GET", STRANGER "/curves?colour=red", READ, "", NULL, 422, "?colour",
         "unknown name; allowed: "},
        {"GET", STRANGER "/report", READ, "", NULL, 404, NULL,
         "there is no study \"0123456789abcdef\""},
        {"GET", STRANGER "/report?case=1", READ, "", NULL, 422, "?case", "unknown name"},
        {"GET", STRANGER "/events", READ, "", NULL, 404, NULL,
         "there is no study \"0123456789abcdef\""},
        {"DELETE", STRANGER, READ, "", NULL, 403, NULL,
         "the token's role, read, does not allow this, which needs submit or admin"},
        {"POST", "/v1/jobs/%201/heartbeat", WORK, JSON, "{" TOKEN ",\"done\":1}", 404, NULL,
         "there is no such job"},
        {"POST", "/v1/jobs/claim", WORK, JSON, "[1]", 422, "", "a claim must be an object"},
        {"POST", "/v1/jobs/claim", WORK, JSON, "{}", 422, "/worker",
         "missing; it is a string of 1 to 255 bytes"},
        {"POST", "/v1/jobs/claim", WORK, JSON, "{\"worker\":7}", 422, "/worker",
         "7 is not a string of 1 to 255 bytes"},
        {"POST", "/v1/jobs/claim", WORK, JSON, "{\"worker\":\"w\",\"kinds\":3}", 422, "/kinds",
         "3 is not an array of at most 32 names"},
        {"POST", "/v1/jobs/claim", WORK, JSON, "{\"worker\":\"w\",\"count\":1.5}", 422, "/count",
         "1.5 is not an integer of 0 to 2^53"},
        {"POST", "/v1/jobs/claim", WORK, JSON, "{", 400, NULL,
         "line 1, column 2: a member name was expected"},
        {"POST", "/v1/jobs/1/heartbeat", WORK, JSON, "{}", 422, "/token",
         "missing; it is a string of 1 to 32 bytes"},
        {"POST", "/v1/jobs/1/heartbeat", WORK, JSON, "{\"token\":\"short\"}", 404, NULL,
         "there is no job 1"},
        {"POST", "/v1/jobs/1/heartbeat", WORK, JSON, "{" TOKEN ",\"done\":-1}", 422, "/done",
         "-1 is not an integer of 0 to 2^53"},
        {"POST", "/v1/jobs/1/heartbeat", WORK, JSON, "{" TOKEN ",\"done\":1}", 404, NULL,
         "there is no job 1"},
        {"POST", "/v1/jobs/abc/heartbeat", WORK, JSON, "{" TOKEN "}", 404, NULL,
         "there is no such job"},
        {"POST", "/v1/jobs/-1/release", WORK, JSON, "{" TOKEN "}", 404, NULL,
         "there is no such job"},
        {"POST", "/v1/jobs/99999999999999999999/release", WORK, JSON, "{" TOKEN "}", 404, NULL,
         "there is no such job"},
        {"POST", "/v1/jobs/1/release", WORK, JSON, "{" TOKEN "}", 404, NULL, "there is no job 1"},
        {"POST", "/v1/jobs/1/fail", WORK, JSON, "{" TOKEN ",\"reason\":7}", 422, "/reason",
         "7 is not a string"},
        {"POST", "/v1/jobs/1/complete", WORK, JSON, "{" TOKEN "}", 422, "/seconds",
         "missing; it is a number of seconds, 0 or more"},
        {"POST", "/v1/jobs/claim", WORK, JSON, "{\"worker\":\"w\",\"seconds\":-1}", 422, "/seconds",
         "-1 is not a number of seconds, 0 or more"},
        {"POST", "/v1/jobs/report", WORK, JSON, "{\"reports\":[{\"verb\":\"rest\"}]}", 422,
         "/reports/0", "/verb: \"rest\" is not heartbeat, complete, fail or release"},
        {"POST", "/v1/jobs/1/complete", WORK, JSON,
         "{" TOKEN ",\"seconds\":1,\"first\":0,\"count\":1,\"scalars\":{\"names\":[],\"rows\":[]},"
         "\"data\":\"!\"}",
         422, "/scalars/rows", "[] is not an array of as many rows as /count"},
    };
    for (size_t r = 0; r < sizeof REQUESTS / sizeof *REQUESTS; r++)
        check_broken(&REQUESTS[r]);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(broken_studies_are_told_what_is_wrong),
        cmocka_unit_test(broken_requests_are_told_what_is_wrong),
    };
    return cmocka_run_group_tests(tests, start, stop);
}
