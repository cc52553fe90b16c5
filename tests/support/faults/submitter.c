/* Who submits studies by keys until an answer comes, looks after them, and notes in a ledger what
 * was acknowledged. It runs in a process of its own, which may be killed at any moment, and cannot
 * fail a test. */
#include "tests/support/faults/world.h"
#include "tests/support/seed.h"
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { PATIENCE_MS = 20000, PATIENCE_OF_ONE_MS = 5000 };

struct submitter {
    struct world *world;
    uint64_t random;
};

void ledger_add(const char *what, const char *name, const char *id) {
    char line[3 * WORLD_NAME];
    int file = open("ledger", O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0600);
    int length = snprintf(line, sizeof line, "%s %s %s\n", what, name, id);
    if (file < 0 || write(file, line, (size_t)length) != length)
        perror("ledger");
    close(file);
}

static bool is_refusal(int status) {
    return status >= 400 && status < 500 && status != 408 && status != 429;
}

/* Asks until the answer is one of a sound server: neither none nor 5xx, 408 or 429. */
static int insist(struct submitter *submitter, const char *method, const char *path,
                  const char *body, char **answer) {
    for (int64_t end = world_now() + PATIENCE_MS;;) {
        int status = world_ask(submitter->world, method, path, body, answer);
        if ((status >= 200 && status < 500 && status != 408 && status != 429) || world_now() > end)
            return status;
        if (answer != NULL)
            free(*answer);
        sleep_ms((long)(20 + next_word(&submitter->random) % 100));
    }
}

int submission_send(struct world *world, unsigned model, const char *name, char id[17]) {
    char headers[256], *text = model_text(model, name), *answer = NULL;
    snprintf(headers, sizeof headers, "%sIdempotency-Key: %s\r\n", world->options.headers, name);
    atomic_fetch_add(&world->tally->requests, 1);
    int status = http_try(world->port, PATIENCE_OF_ONE_MS,
                          &(struct http_request){"POST", "/v1/studies", headers, text}, &answer);
    bool whole = status >= 300 || (sscanf(answer, "{\"id\":\"%16[0-9a-f]\"", id) == 1 &&
                                   strchr(answer, '}') != NULL);
    free(answer);
    free(text);
    return whole ? status : 0;
}

/* Sends the study until it is taken. Returns whether it is, and its id. */
static bool submit(struct submitter *submitter, unsigned model, const char *name, char id[17]) {
    struct world *world = submitter->world;
    ledger_add("tried", name, "-");
    atomic_fetch_add(&world->tally->submitted, 1);
    for (int64_t end = world_now() + PATIENCE_MS; world_now() < end;) {
        int status = submission_send(world, model, name, id);
        if (status == 200 || status == 201) {
            ledger_add("acked", name, id);
            atomic_fetch_add(&world->tally->acknowledged, 1);
            return true;
        }
        if (is_refusal(status))
            world_lose(&world->tally->lost, "%s was refused: %d", name, status);
        sleep_ms((long)(20 + next_word(&submitter->random) % 100));
    }
    return false;
}

/* What people do with a study of theirs besides waiting. */
static void meddle(struct submitter *submitter, unsigned model, const char *id) {
    char path[80], body[64];
    snprintf(path, sizeof path, "/v1/studies/%s", id);
    switch (next_word(&submitter->random) % 8) {
    case 0:
        insist(submitter, "DELETE", path, NULL, NULL); /* cancel, and think again */
        snprintf(path, sizeof path, "/v1/studies/%s/retry", id);
        insist(submitter, "POST", path, NULL, NULL);
        break;
    case 1:
    case 2:
        snprintf(path, sizeof path, "/v1/studies/%s/extend", id);
        snprintf(body, sizeof body, "{\"realisations\":%d}", (int)model_realisations(1));
        if (model == 0)
            insist(submitter, "POST", path, body, NULL);
        break;
    default:
        break;
    }
}

/* Whether it has ended; what was acknowledged must be found at once and always. */
static bool look(struct submitter *submitter, const char *name, const char *id) {
    static const char *const ALSO[] = {"/v1/studies", "/metrics", "/healthz", "/v1/workers"};
    char path[80], *answer = NULL;
    snprintf(path, sizeof path, "/v1/studies/%s", id);
    int status = insist(submitter, "GET", path, NULL, &answer);
    bool ended = strstr(answer, "\"state\":\"done\"") != NULL ||
                 strstr(answer, "\"state\":\"failed\"") != NULL;
    free(answer);
    if (status == 404)
        world_lose(&submitter->world->tally->lost, "%s (%s) was acknowledged and is not there",
                   name, id);
    uint64_t draw = next_word(&submitter->random);
    if (draw % 2 == 0)
        world_ask(submitter->world, "GET", ALSO[draw / 2 % 4], NULL, NULL);
    snprintf(path, sizeof path, "/v1/studies/%s/curves", id);
    if (draw % 5 == 0)
        world_ask(submitter->world, "GET", path, NULL, NULL);
    return ended || status == 404;
}

void submitter_run(struct world *world, const struct actor *actor) {
    unsigned first = atomic_fetch_add(&world->tally->next_key, 1);
    struct submitter submitter = {world, world->seed + 1000 * (uint64_t)first};
    for (;;) {
        char name[WORLD_NAME], id[17];
        unsigned model = (unsigned)(next_word(&submitter.random) % world_models(world));
        snprintf(name, sizeof name, "m%u-k%d-%u", model, actor->number,
                 atomic_fetch_add(&world->tally->next_key, 1));
        if (!submit(&submitter, model, name, id))
            continue;
        look(&submitter, name, id);
        meddle(&submitter, model, id);
        for (int64_t end = world_now() + PATIENCE_MS; world_now() < end;) {
            if (look(&submitter, name, id))
                break;
            sleep_ms((long)(50 + next_word(&submitter.random) % 200));
        }
    }
}
