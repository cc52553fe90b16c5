/* Protects: whatever study is sent to a server, it lives, and answers: it takes the study, or says
 * of each fault where it is and what is allowed. Studies are drawn from the tables of parameters,
 * and submitted, checked and extended; RUGO_DRAWN=N draws so many. */
#include "tests/support/check.h"

#include "jobs/kind.h"
#include "schema/json/json.h"
#include "tests/support/fuzz/answer.h"
#include "tests/support/fuzz/change_json.h"
#include "tests/support/fuzz/draw_study.h"
#include "tests/support/process.h"
#include "tests/support/seed.h"
#include "worker/clock.h"
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum {
    DRAWN = 1000,
    STORE_MOST = 5000, /* studies drawn for one store: no worker takes from its queue */
    BYTES = 256,       /* of choices for one study */
    IDS = 32,          /* of studies that were taken, to be extended */
    STATUS_MOST = 500,
};

static struct process server;
static unsigned port;
static char ids[IDS][STUDY_ID_SIZE];
static size_t taken; /* from the present store */

static const struct request_kind {
    const char *name;
    route_handler *handler;
} KINDS[] = {
    {"submit", handle_study_create}, {"check", handle_check}, {"extend", handle_study_extend}};
enum { SUBMIT, CHECK, EXTEND, KIND_COUNT };
static size_t counts[KIND_COUNT][STATUS_MOST];
static int64_t longest_ms[KIND_COUNT]; /* that an answer took */

static void stop_server(void) {
    static const char *const LEFT[] = {"drawn.db", "drawn.db-wal", "drawn.db-shm"};
    assert_int_equal(http_exchange(port, "GET", "/healthz", NULL, NULL, NULL), 200);
    process_kill(&server, SIGTERM);
    assert_int_equal(process_wait(&server, 30), 0);
    for (size_t n = 0; n < sizeof LEFT / sizeof *LEFT; n++)
        remove(LEFT[n]);
}

static void start_server(void) {
    port = serve_start(&server, (const char *[]){"--db", "drawn.db", "--log-level", "error", NULL});
    taken = 0;
}

static const struct route *route_of(route_handler *handler) {
    for (size_t r = 0; route_at(r) != NULL; r++)
        if (route_at(r)->handler == handler)
            return route_at(r);
    return NULL;
}

static void post(size_t kind, const char *path, const char *body, struct answer *out) {
    struct drawn_request request = {.route = route_of(KINDS[kind].handler)};
    assert_non_null(request.route);
    int size = asprintf(&request.bytes,
                        "POST %s HTTP/1.1\r\nHost: 127.0.0.1\r\nConnection: close\r\n"
                        "Content-Type: application/json\r\nContent-Length: %zu\r\n\r\n%s",
                        path, strlen(body), body);
    assert_true(size > 0);
    request.size = (size_t)size;
    int64_t begun_ms = clock_ms();
    answer_of(out, (uint16_t)port, &request);
    int64_t took_ms = clock_ms() - begun_ms;
    longest_ms[kind] = took_ms > longest_ms[kind] ? took_ms : longest_ms[kind];
    answer_judge(out, &request);
    counts[kind][out->status]++;
    drawn_request_clear(&request);
}

static void submit(const char *body) {
    struct answer answer;
    cJSON *document = NULL;
    post(SUBMIT, "/v1/studies", body, &answer);
    assert_true(answer.status == 201 || answer.status == 422 || answer.status == 400);
    if (answer.status == 201) {
        assert_int_equal(json_parse(answer.body, answer.size, NULL, &document, &(struct error){0}),
                         0);
        const char *id = cJSON_GetStringValue(json_at(document, "/id"));
        assert_non_null(id);
        snprintf(ids[taken++ % IDS], STUDY_ID_SIZE, "%s", id);
        cJSON_Delete(document);
    }
    answer_clear(&answer);
}

static void check(const char *body) {
    struct answer answer;
    post(CHECK, "/v1/check", body, &answer);
    assert_true(answer.status == 200 || answer.status == 422 || answer.status == 400);
    answer_clear(&answer);
}

/* 409: the study has more, or has ended. */
static void extend(struct choices *choices) {
    struct answer answer;
    char path[80];
    cJSON *document = cJSON_CreateObject();
    double number = choose_number(choices, 1, 1e7);
    double count = choose_rarely(choices, 4) ? number : floor(number);
    assert_non_null(cJSON_AddNumberToObject(document, "realisations", count));
    if (choose_rarely(choices, 3))
        change_json(choices, &document);
    char *body = json_print(document);
    assert_non_null(body);
    snprintf(path, sizeof path, "/v1/studies/%s/extend",
             ids[choose(choices, taken < IDS ? taken : IDS)]);
    post(EXTEND, path, body, &answer);
    assert_true(answer.status == 200 || answer.status == 409 || answer.status == 422 ||
                answer.status == 400);
    answer_clear(&answer);
    free(body);
    cJSON_Delete(document);
}

static void draw(size_t n, uint64_t *seed) {
    uint8_t bytes[BYTES];
    for (size_t b = 0; b < BYTES; b++)
        bytes[b] = (uint8_t)next_word(seed);
    struct choices choices = {bytes, BYTES};
    char *body = draw_study(&choices, JOB_KINDS);
    if (n % 2 == 0)
        submit(body);
    else
        check(body);
    if (n % 4 == 0 && taken > 0)
        extend(&choices);
    free(body);
}

static size_t show_counts(size_t kind) {
    size_t all = 0;
    printf("%s:", KINDS[kind].name);
    for (size_t status = 0; status < STATUS_MOST; status++) {
        if (counts[kind][status] > 0)
            printf(" %zu x %zu", status, counts[kind][status]);
        all += counts[kind][status];
    }
    printf(", %zu in all, %lld ms at most\n", all, (long long)longest_ms[kind]);
    return all;
}

static void every_study_is_answered(void **state) {
    const char *wish = getenv("RUGO_DRAWN");
    size_t drawn = wish != NULL ? strtoull(wish, NULL, 10) : DRAWN;
    uint64_t seed = seed_of_now();
    (void)state;
    for (size_t n = 0; n < drawn; n++) {
        if (n % STORE_MOST == 0 && n > 0)
            stop_server();
        if (n % STORE_MOST == 0)
            start_server();
        draw(n, &seed);
    }
    stop_server();
    assert_int_equal(show_counts(SUBMIT) + show_counts(CHECK), drawn);
    show_counts(EXTEND);
    /* Not all of them are refused, nor taken. */
    assert_true(counts[SUBMIT][201] > drawn / 20 && counts[SUBMIT][422] > drawn / 20);
    assert_true(counts[CHECK][200] > drawn / 20 && counts[CHECK][422] > drawn / 20);
    assert_true(counts[EXTEND][200] > 0);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(every_study_is_answered)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
