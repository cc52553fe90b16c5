/* Jobs from a server, over HTTP; wire.h says what crosses. */
#include "schema/json/field.h"
#include "worker/client.h"
#include "worker/source_backend.h"
#include "worker/wire.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum {
    HEARTBEAT_MS = 10000, /* one that is not answered must not hold up those of other threads */
    RESULT_MS = 60000,
};

struct remote {
    struct client *client;
};

static void remote_destroy(void *self) {
    struct remote *remote = self;
    if (remote != NULL) {
        client_destroy(&remote->client);
        free(remote);
    }
}

static int remote_create(void **self, const struct source_options *options, struct error *err) {
    struct remote *remote = calloc(1, sizeof *remote);
    if (remote == NULL)
        return error_memory(err, sizeof *remote, "a source of jobs");
    int status = client_create(&remote->client, options->url, options->token, err);
    if (status != 0) {
        remote_destroy(remote);
        return status;
    }
    *self = remote;
    return 0;
}

/* Takes body (NULL: out of memory) and posts it; *answer may be NULL for an empty one. */
static int remote_post(struct remote *remote, const char *path, cJSON *body, long timeout_ms,
                       cJSON **answer, struct error *err) {
    char *text = body != NULL ? json_print(body) : NULL;
    cJSON_Delete(body);
    if (text == NULL)
        return error_set(err, ERROR_MEMORY, "no memory left for a request");
    struct request request = {
        .method = "POST", .path = path, .body = text, .timeout_ms = timeout_ms};
    int status = client_json(remote->client, &request, answer, err);
    free(text);
    return status;
}

static int remote_claim(void *self, const struct claim *claim, struct claimed_job *job, int *found,
                        struct error *err) {
    cJSON *answer = NULL;
    int status = remote_post(self, "/v1/jobs/claim", wire_claim(claim), 0, &answer, err);
    if (status == ERROR_STATE) /* of no job of ours: the server cannot do it just now */
        return err->code = ERROR_SYSTEM;
    if (status != 0)
        return status;
    size_t count = 0;
    if (answer != NULL)
        status = wire_jobs_read(answer, job, 1, &count, err);
    cJSON_Delete(answer);
    if (status == ERROR_INPUT) { /* what came is wrong, not what was asked */
        err->code = ERROR_SYSTEM;
        status = error_context(err, "the server's answer to a claim");
    }
    if (status == 0)
        *found = count > 0;
    return status;
}

/* One request about a job. A server that does not know the job has lost it for us: its database is
 * another one by now. */
static int remote_report(struct remote *remote, const struct claimed_job *job, const char *verb,
                         cJSON *body, long timeout_ms, struct error *err) {
    char path[64];
    cJSON *answer = NULL;
    snprintf(path, sizeof path, "/v1/jobs/%lld/%s", (long long)job->id, verb);
    int status = remote_post(remote, path, body, timeout_ms, &answer, err);
    cJSON_Delete(answer);
    if (status == ERROR_ABSENT)
        status = err->code = ERROR_STATE;
    return status;
}

static int remote_heartbeat(void *self, const struct claimed_job *job, uint64_t done,
                            struct error *err) {
    return remote_report(self, job, "heartbeat", wire_heartbeat(job->token, done), HEARTBEAT_MS,
                         err);
}

static int remote_complete(void *self, const struct claimed_job *job,
                           const struct block_result *result, struct error *err) {
    return remote_report(self, job, "complete", wire_result(job->token, result), RESULT_MS, err);
}

static int remote_fail(void *self, const struct claimed_job *job, const char *reason, int permanent,
                       struct error *err) {
    return remote_report(self, job, "fail", wire_fail(job->token, reason, permanent != 0), 0, err);
}

static int remote_release(void *self, const struct claimed_job *job, struct error *err) {
    return remote_report(self, job, "release", wire_release(job->token), HEARTBEAT_MS, err);
}

/* By its jobs, for its state is "running" until the server has published it, which no worker waits
 * for, unless that may queue more jobs. */
static bool study_goes_on(const cJSON *study) {
    const cJSON *jobs = field_at(study, "jobs");
    return cJSON_GetNumberValue(field_at(jobs, "waiting")) > 0 ||
           cJSON_GetNumberValue(field_at(jobs, "running")) > 0 ||
           cJSON_IsTrue(field_at(study, "planning"));
}

/* Pages through the server's list of studies until one goes on. */
static int remote_left(void *self, int *left, struct error *err) {
    struct remote *remote = self;
    char after[STUDY_ID_SIZE] = "";
    bool more = true, found = false;
    int status = 0;
    while (more && !found && status == 0) {
        char path[96];
        cJSON *page = NULL;
        const cJSON *study;
        snprintf(path, sizeof path, "/v1/studies?limit=100&after=%s", after);
        struct request request = {.method = "GET", .path = path};
        status = client_json(remote->client, &request, &page, err);
        more = false;
        cJSON_ArrayForEach(study, cJSON_GetObjectItemCaseSensitive(page, "studies")) {
            const char *id = cJSON_GetStringValue(cJSON_GetObjectItemCaseSensitive(study, "id"));
            found = found || study_goes_on(study);
            more = id != NULL && strlen(id) < sizeof after && strcmp(id, after) != 0;
            if (more)
                memcpy(after, id, strlen(id) + 1);
        }
        cJSON_Delete(page);
    }
    if (status == ERROR_INPUT) /* not for this token to see */
        status = 0;
    if (status == 0)
        *left = found;
    return status;
}

const struct source_backend SOURCE_SERVER = {
    .create = remote_create,
    .destroy = remote_destroy,
    .claim = remote_claim,
    .heartbeat = remote_heartbeat,
    .complete = remote_complete,
    .fail = remote_fail,
    .release = remote_release,
    .left = remote_left,
};
