/* Requests that change something, sent until they are answered. */
#include "schema/hex.h"
#include "worker/client.h"
#include "worker/client_internal.h"
#include "worker/clock.h"
#include <stdio.h>
#include <string.h>
#include <time.h>

enum {
    CHANGE_MS = 30000,
    FIRST_PAUSE_MS = 200,
    PAUSE_MOST_MS = 2000,
    LEFT_LEAST_MS = 50, /* less than this is no time for another request */
};

int key_make(char key[KEY_SIZE], struct error *err) {
    return hex_random(key, KEY_SIZE - 1, err);
}

static void pause_ms(int64_t milliseconds) {
    const struct timespec pause = {milliseconds / 1000, milliseconds % 1000 * 1000000};
    nanosleep(&pause, NULL);
}

/* What a request whose answer was lost has done is refused the next time: a study that it deleted
 * is not there, one that it cancelled has ended so. Any other refusal stays one. */
static int read_refusal(struct client *client, const struct request *request, cJSON **out,
                        struct error *err) {
    bool deletes = strcmp(request->method, "DELETE") == 0;
    const struct request question = {.method = "GET", .path = request->path};
    struct error ignored;
    int refusal = err->code;
    if (deletes && refusal == ERROR_ABSENT && strchr(request->path, '?') != NULL)
        return 0;
    if (!deletes || refusal != ERROR_STATE || client_json(client, &question, out, &ignored) != 0)
        return refusal;
    const char *state = cJSON_GetStringValue(cJSON_GetObjectItemCaseSensitive(*out, "state"));
    if (state != NULL && strcmp(state, "cancelled") == 0)
        return 0;
    cJSON_Delete(*out);
    *out = NULL;
    return refusal;
}

/* The reason of the last failure comes first. */
static int tell_doubt(struct error *err, long total_ms, const char *doubt) {
    char reason[160];
    snprintf(reason, sizeof reason, "%.159s", err->text);
    return error_set(err, ERROR_SYSTEM, "%s; no answer within %g s: %s", reason,
                     1e-3 * (double)total_ms, doubt);
}

int client_change(struct client *client, const struct request *request, const char *doubt,
                  cJSON **out, struct error *err) {
    char key[KEY_SIZE];
    struct request again = *request;
    long total_ms = request->timeout_ms != 0 ? request->timeout_ms : CHANGE_MS;
    int64_t pause = FIRST_PAUSE_MS, until_ms = clock_ms() + total_ms;
    bool lost = false;
    *out = NULL;
    if (again.idempotency_key == NULL) {
        int status = key_make(key, err);
        if (status != 0)
            return status;
        again.idempotency_key = key;
    }
    for (;;) {
        again.timeout_ms = (long)(until_ms - clock_ms());
        int status = client_json(client, &again, out, err);
        if (lost && (status == ERROR_ABSENT || status == ERROR_STATE))
            return read_refusal(client, &again, out, err);
        /* once it may have been taken, even a server that is away is asked again */
        lost = lost || (status != 0 && client_lost_answer(client));
        if (status == 0 || !lost || status != ERROR_SYSTEM)
            return status;
        if (until_ms - clock_ms() < pause + LEFT_LEAST_MS)
            return tell_doubt(err, total_ms, doubt);
        pause_ms(pause);
        pause = 2 * pause < PAUSE_MOST_MS ? 2 * pause : PAUSE_MOST_MS;
    }
}
