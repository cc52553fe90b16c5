/* Claims: jobs to a worker, at once or as soon as there is one, and back from one that has gone
 * before they reached it. */
#include "server/http/route/route.h"
#include "server/http/waiting_room.h"
#include "worker/clock.h"
#include "worker/link/header_names.h"
#include "worker/link/wire.h"
#include "worker/log.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

enum { WAIT_MOST_S = 30 };

/* Jobs whose answer is being sent. */
struct handed_out {
    size_t count;
    struct {
        int64_t id;
        char token[TOKEN_SIZE];
    } jobs[];
};

struct claiming {
    struct exchange *exchange;
    struct wire_claim wire;
    struct claimed_job jobs[WIRE_JOBS_MOST];
    size_t count;
};

/* A worker may go while its claim queues for the writer. */
static int claim_change(struct store *store, void *context, struct error *err) {
    struct claiming *claiming = context;
    if (exchange_is_lost(claiming->exchange) != 0)
        return 0;
    return store_claim(store, &claiming->wire.claim, claiming->jobs, &claiming->count, err);
}

/* Seconds of "Prefer: wait=N" (RFC 7240), as far as they are granted; -1 without. */
static int wait_wanted(const struct exchange *exchange) {
    const char *at = exchange_header(exchange, "Prefer");
    while (at != NULL && *at != '\0') {
        char *end;
        at += strspn(at, " \t,");
        if (strncasecmp(at, "wait=", 5) == 0 && at[5] >= '0' && at[5] <= '9') {
            unsigned long seconds = strtoul(at + 5, &end, 10);
            return seconds < WAIT_MOST_S ? (int)seconds : WAIT_MOST_S;
        }
        at = strchr(at, ',');
    }
    return -1;
}

/* Claims until there is a job, at most for as long as the worker would wait. */
static int claim_jobs(struct claiming *claiming, int wait_s, struct error *err) {
    struct exchange *exchange = claiming->exchange;
    struct service *service = exchange->service;
    int64_t until_ms = clock_ms() + 1000 * (int64_t)wait_s;
    uint64_t seen = 0;
    int status;
    do
        status = writer_do(service->writer, claim_change, claiming, err);
    while (status == 0 && claiming->count == 0 && wait_s > 0 &&
           waiting_room_wait(service->room, exchange_socket(exchange), until_ms, &seen));
    return status;
}

/* --- jobs that do not arrive --- */

static int take_back_change(struct store *store, void *context, struct error *err) {
    const struct handed_out *handed = context;
    for (size_t j = 0; j < handed->count; j++) {
        struct error ignored = {0}; /* a job of which more is known by now */
        (void)store_release(store, handed->jobs[j].id, handed->jobs[j].token, &ignored);
    }
    (void)err;
    return 0;
}

void claim_settle(struct exchange *exchange, bool arrived) {
    struct handed_out *handed = exchange->handed_out;
    struct error err = {0};
    if (handed == NULL)
        return;
    if (!arrived) {
        struct log_about about = {.request = exchange->path};
        int status = writer_do(exchange->service->writer, take_back_change, handed, &err);
        log_line(status == 0 ? LEVEL_INFO : LEVEL_WARNING, &about,
                 "%zu jobs of a worker that has gone: %s", handed->count,
                 status == 0 ? "taken back" : err.text);
    }
    free(handed);
    exchange->handed_out = NULL;
}

/* Remembers what is handed out; without memory for that, leases run out by themselves. */
static void remember(struct exchange *exchange, const struct claiming *claiming) {
    struct handed_out *handed = malloc(sizeof *handed + claiming->count * sizeof handed->jobs[0]);
    exchange->handed_out = handed;
    if (handed == NULL)
        return;
    handed->count = claiming->count;
    for (size_t j = 0; j < claiming->count; j++) {
        handed->jobs[j].id = claiming->jobs[j].id;
        memcpy(handed->jobs[j].token, claiming->jobs[j].token, TOKEN_SIZE);
    }
}

/* --- the answer --- */

static void answer_claim(struct claiming *claiming, int wait_s) {
    struct exchange *exchange = claiming->exchange;
    char applied[16];
    bool lost = claiming->count > 0 && exchange_is_lost(exchange) != 0;
    if (claiming->count > 0)
        remember(exchange, claiming);
    if (lost)
        claim_settle(exchange, false);
    if (claiming->count > 0 && !lost) {
        answer_json(exchange, 200, wire_jobs(claiming->jobs, claiming->count));
    } else {
        answer_empty(exchange, 204);
    }
    if (claiming->wire.other_forms[0] != '\0')
        answer_header(exchange, OTHER_FORMS_HEADER, claiming->wire.other_forms);
    if (wait_s < 0)
        return;
    snprintf(applied, sizeof applied, "wait=%d", wait_s);
    answer_header(exchange, "Preference-Applied", applied);
}

void handle_claim(struct exchange *exchange, const char *id) {
    (void)id;
    struct claiming claiming = {.exchange = exchange};
    struct error err = {0};
    int wait_s = wait_wanted(exchange);
    cJSON *body = body_json(exchange);
    if (body == NULL)
        return;
    if (wire_claim_read(body, &claiming.wire, &err) != 0)
        refuse_message(exchange, &err);
    else if (claim_jobs(&claiming, wait_s, &err) != 0)
        answer_error(exchange, &err);
    else
        answer_claim(&claiming, wait_s);
    for (size_t j = 0; j < claiming.count; j++)
        claimed_job_clear(&claiming.jobs[j]);
    cJSON_Delete(body);
}
