/* Protects: a worker that lies, guesses tokens and reaches for the jobs of others, and a reader
 * that tries everything, change nothing and learn no secret. */
#include "jobs/kind.h"
#include "jobs/runner.h"
#include "tests/support/check.h"
#include "tests/support/faults/world.h"
#include "tests/support/seed.h"
#include "worker/link/wire.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#define ADMIN_TOKEN "token-of-the-admin-0"
#define WORK_TOKEN "token-of-a-worker-00"
#define READ_TOKEN "token-of-a-reader-00"
#define JSON "Content-Type: application/json\r\n"
#define AS(token) JSON "Authorization: Bearer " token "\r\n"

enum { HELD_MOST = 2, HUGE_BODY = 17 << 20 };

/* Whoever asks, an answer of this row refuses. */
static void refused(struct world *world, const char *headers, const char *method, const char *path,
                    const char *body) {
    char *answer = NULL;
    atomic_fetch_add(&world->tally->requests, 1);
    int status =
        http_try(world->port, 10000, &(struct http_request){method, path, headers, body}, &answer);
    world_count_fault(world);
    if (status < 400 || status == 500)
        world_lose(&world->tally->lost, "%s %s of %.60s got %d %.200s", method, path,
                   body != NULL ? body : "nothing", status, answer);
    free(answer);
}

/* One of several reports of a request has a status of its own. */
static void refused_report(struct world *world, int64_t job, const char *what, cJSON *document) {
    cJSON *whole = cJSON_CreateObject(), *reports = cJSON_AddArrayToObject(whole, "reports");
    char *answer = NULL;
    assert_true(cJSON_AddItemToArray(reports, document));
    cJSON_AddStringToObject(document, "verb", what);
    cJSON_AddNumberToObject(document, "job", (double)job);
    char *body = cJSON_PrintUnformatted(whole);
    assert_non_null(body);
    atomic_fetch_add(&world->tally->requests, 1);
    int status =
        http_try(world->port, 10000,
                 &(struct http_request){"POST", "/v1/jobs/report", AS(WORK_TOKEN), body}, &answer);
    world_count_fault(world);
    if (status < 400 && strstr(answer, "\"status\":4") == NULL)
        world_lose(&world->tally->lost, "a report of %.60s got %d %.200s", body, status, answer);
    free(answer);
    free(body);
    cJSON_Delete(whole);
}

/* Takes the document. */
static void refused_document(struct world *world, int64_t job, const char *what, cJSON *document) {
    if (world_draw(world, 2) == 0) {
        refused_report(world, job, what, document);
        return;
    }
    char path[64], *body = cJSON_PrintUnformatted(document);
    assert_non_null(body);
    snprintf(path, sizeof path, "/v1/jobs/%lld/%s", (long long)job, what);
    refused(world, AS(WORK_TOKEN), "POST", path, body);
    free(body);
    cJSON_Delete(document);
}

/* --- a worker --- */

/* Jobs that the malicious worker holds for a moment. */
struct held {
    struct claimed_job jobs[HELD_MOST];
    size_t count;
};

static bool hold(struct world *world, struct held *held) {
    struct error err = {0};
    char *answer = NULL;
    *held = (struct held){.count = 0};
    int status = http_try(world->port, 3000,
                          &(struct http_request){"POST", "/v1/jobs/claim", AS(WORK_TOKEN),
                                                 "{\"worker\":\"mallory\",\"count\":2,"
                                                 "\"sequence\":true}"},
                          &answer);
    cJSON *document = status == 200 ? cJSON_Parse(answer) : NULL;
    if (document != NULL &&
        wire_jobs_read(document, held->jobs, HELD_MOST, &held->count, &err) != 0)
        world_lose(&world->tally->lost, "a claim cannot be read: %s", err.text);
    cJSON_Delete(document);
    free(answer);
    return held->count > 0;
}

static void give_back(struct world *world, struct held *held) {
    for (size_t j = 0; j < held->count; j++) {
        char path[64], *body = NULL;
        snprintf(path, sizeof path, "/v1/jobs/%lld/release", (long long)held->jobs[j].id);
        assert_true(asprintf(&body, "{\"token\":\"%s\"}", held->jobs[j].token) > 0);
        http_try(world->port, 3000, &(struct http_request){"POST", path, AS(WORK_TOKEN), body},
                 NULL);
        free(body);
        claimed_job_clear(&held->jobs[j]);
    }
}

/* A true result of the first realisation of a job, for lies to begin with; NULL: none. */
static cJSON *true_result(const struct claimed_job *job) {
    struct job_runner *runner = NULL;
    struct block_result block = {0};
    struct error err = {0};
    cJSON *document = NULL;
    const struct job_kind *kind = kind_find(job->kind);
    assert_non_null(kind);
    if (runner_create(&runner, kind, job->parameters, NULL, job->seed, job->sequence, &err) == 0 &&
        runner_run(runner, job->first, 1, NULL, &block, &err) == 0)
        document = wire_result(job->token, &block);
    block_result_clear(&block);
    runner_destroy(&runner);
    return document;
}

static void set_number(cJSON *document, const char *key, double value) {
    assert_true(cJSON_ReplaceItemInObject(document, key, cJSON_CreateNumber(value)));
}

/* One lie of several, each of which can be seen from the job. */
static void lie(struct world *world, const struct claimed_job *job, cJSON *document) {
    cJSON *scalars = cJSON_GetObjectItem(document, "scalars");
    cJSON *data = cJSON_GetObjectItem(document, "data");
    switch (world_draw(world, 7)) {
    case 0:
        set_number(document, "count", (double)(job->count + 1));
        break;
    case 1:
        set_number(document, "count", 2); /* of data and rows of one */
        break;
    case 2:
        set_number(document, "first", (double)(job->first + 1));
        break;
    case 3:
        cJSON_DeleteItemFromArray(cJSON_GetObjectItem(scalars, "rows"), 0);
        break;
    case 4:
        cJSON_DeleteItemFromArray(cJSON_GetObjectItem(scalars, "names"), 0);
        break;
    case 5: /* cut off, at the end of a word of base64 */
        data->valuestring[strlen(data->valuestring) / 8 * 4] = '\0';
        break;
    default:
        set_number(document, "seconds", -1e300);
        break;
    }
    refused_document(world, job->id, "complete", document);
}

/* What a true result is sent as: for a job of another, or under a token that was made up. */
static void reach_out(struct world *world, const struct held *held, cJSON *document) {
    char token[TOKEN_SIZE];
    int64_t other = 1 + world_draw(world, 60);
    snprintf(token, sizeof token, "%016llx%016llx", (unsigned long long)next_word(&world->random),
             (unsigned long long)next_word(&world->random));
    for (size_t j = 0; j < held->count; j++)
        if (held->jobs[j].id == other)
            other = 1000000;
    switch (world_draw(world, 5)) {
    case 0: /* with a token of one's own */
        refused_document(world, other, "complete", document);
        return;
    case 1:
        cJSON_ReplaceItemInObject(document, "token", cJSON_CreateString(token));
        refused_document(world, held->jobs[0].id, "complete", document);
        return;
    case 2:
        refused_document(world, other, "fail", wire_fail(held->jobs[0].token, "malice", true));
        break;
    case 3:
        refused_document(world, other, "release", wire_release(token));
        break;
    default:
        refused_document(world, other, "heartbeat", wire_heartbeat(token, 1e19));
        break;
    }
    cJSON_Delete(document);
}

static void send_too_much(struct world *world) {
    char *body = malloc(HUGE_BODY + 1);
    assert_non_null(body);
    memset(body, '[', HUGE_BODY);
    body[HUGE_BODY] = '\0';
    refused(world, AS(WORK_TOKEN), "POST", "/v1/jobs/1/complete", body);
    body[world_draw(world, 100000)] = '\0'; /* deep, not long */
    refused(world, AS(WORK_TOKEN), "POST", "/v1/jobs/claim", body);
    free(body);
}

/* --- a reader --- */

static void try_everything(struct world *world) {
    static const char *const PATHS[] = {"/v1/studies",
                                        "/v1/check",
                                        "/v1/jobs/claim",
                                        "/v1/jobs/1/complete",
                                        "/v1/jobs/1/fail",
                                        "/v1/jobs/1/release",
                                        "/v1/jobs/1/heartbeat",
                                        "/v1/studies/m/retry",
                                        "/v1/studies/m/extend",
                                        "/v1/jobs/report",
                                        "/v1/../tokens",
                                        "/%2e%2e/tokens",
                                        "/tokens",
                                        "//v1/snapshot",
                                        "/v1/snapshot/",
                                        "/v1/studies/%00"};
    static const char *const METHODS[] = {"POST", "DELETE", "PUT", "PATCH", "TRACE", "CONNECT"};
    refused(world, AS(READ_TOKEN), METHODS[world_draw(world, 6)],
            PATHS[world_draw(world, sizeof PATHS / sizeof *PATHS)], "{}");
    refused(world, JSON, "GET", "/v1/snapshot", NULL);
    refused(world, AS("token-of-a-reader-0"), "GET", "/v1/snapshot", NULL);
}

/* Neither the tokens of the service nor of leases are in what a reader may have. */
static void look_for_secrets(struct world *world, const struct held *held) {
    static const char *const PATHS[] = {"/v1/snapshot", "/v1/workers", "/v1/studies", "/metrics"};
    const char *path = PATHS[world_draw(world, 4)];
    const char *secrets[3 + HELD_MOST] = {ADMIN_TOKEN, WORK_TOKEN, READ_TOKEN};
    char *request = NULL;
    size_t count = 3, size = 0;
    for (size_t j = 0; j < held->count; j++)
        secrets[count++] = held->jobs[j].token;
    assert_true(asprintf(&request,
                         "GET %s HTTP/1.1\r\nHost: 127.0.0.1\r\nConnection: close\r\n%s\r\n", path,
                         AS(READ_TOKEN)) > 0);
    char *reply = http_bytes(world->port, request, strlen(request), &size);
    world_count_fault(world);
    for (size_t s = 0; s < count; s++)
        if (memmem(reply, size, secrets[s], strlen(secrets[s])) != NULL)
            world_lose(&world->tally->lost, "%s tells the token %s", path,
                       s < 3 ? secrets[s] : "of a lease");
    free(reply);
    free(request);
}

static void strike(struct world *world) {
    struct held held;
    cJSON *document = NULL;
    if (world_ask(world, "GET", "/healthz", NULL, NULL) != 200)
        return; /* the server has yet to start */
    try_everything(world);
    if (world_draw(world, 20) == 0)
        send_too_much(world);
    if (world_draw(world, 3) != 0 || !hold(world, &held))
        return;
    look_for_secrets(world, &held);
    document = true_result(&held.jobs[0]);
    if (document != NULL && world_draw(world, 2) == 0)
        lie(world, &held.jobs[0], document);
    else if (document != NULL)
        reach_out(world, &held, document);
    give_back(world, &held);
}

static void malice_changes_nothing(void **state) {
    (void)state;
    spit("tokens", "admin:" ADMIN_TOKEN "\nwork:" WORK_TOKEN "\nread:" READ_TOKEN "\n");
    assert_int_equal(chmod("tokens", 0600), 0);
    world_test(&(struct world_options){.program = "malice",
                                       .workers = 2,
                                       .submitters = 2,
                                       .commands = 1,
                                       .snapshots = 1,
                                       .headers = AS(ADMIN_TOKEN),
                                       .token_file = "tokens",
                                       .strike = strike,
                                       .pause_ms = 50},
               20);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(malice_changes_nothing)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
