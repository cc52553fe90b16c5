/* Changes of a store, local or of a server. */
#include "jobs/kind.h"
#include "schema/study/override.h"
#include "server/command/access.h"
#include "server/command/access_internal.h"
#include "server/command/api.h"
#include <stdio.h>
#include <stdlib.h>

/* Sends a study with a key, so that it is queued once however often it is sent. */
static int send_study(struct access *access, const struct submission *submission, const char *body,
                      cJSON **out, struct fault_list *faults, struct error *err) {
    char key[KEY_SIZE], doubt[320];
    int status = submission->key == NULL ? key_make(key, err) : 0;
    const struct request request = {.method = "POST",
                                    .path = "/v1/studies",
                                    .body = body,
                                    .faults = faults,
                                    .idempotency_key =
                                        submission->key != NULL ? submission->key : key,
                                    .timeout_ms = 1000 * (long)submission->timeout_s};
    if (status != 0)
        return status;
    snprintf(doubt, sizeof doubt,
             "the study may have been queued; rugo status --server %.100s tells, and the same "
             "command with --key %.60s queues it once",
             access->server, request.idempotency_key);
    return client_change(access->client, &request, doubt, out, err);
}

/* A server has no --set: the changes are made before the study is sent. */
static int submit_remote(struct access *access, const struct submission *submission, cJSON **out,
                         struct fault_list *faults, struct error *err) {
    const char *const *change = submission->overrides;
    cJSON *document = NULL;
    int status = json_parse(submission->text, submission->size, NULL, &document, err);
    for (; status == 0 && change != NULL && *change != NULL; change++)
        status = override_apply(document, *change, err);
    char *body = status != 0 ? NULL : json_print(document);
    cJSON_Delete(document);
    if (status == 0 && body == NULL)
        status = error_memory(err, submission->size, "a study");
    if (status == 0)
        status = send_study(access, submission, body, out, faults, err);
    free(body);
    return status;
}

int access_submit(struct access *access, const struct submission *submission, cJSON **out,
                  struct fault_list *faults, struct error *err) {
    bool existing;
    struct study *study = NULL;
    if (access->client != NULL)
        return submit_remote(access, submission, out, faults, err);
    int status = kind_read_study(&study, submission->text, submission->size, submission->overrides,
                                 faults, err);
    if (status == 0)
        status = api_submit(access->store, study, submission->key, out, &existing, err);
    study_destroy(&study);
    return status;
}

/* Asks for a change of a study; `done` says what may have become of it where no answer comes. */
static int ask_change(struct access *access, const struct request *request, const char *id,
                      const char *done, cJSON **out, struct error *err) {
    char doubt[320];
    snprintf(
        doubt, sizeof doubt,
        "study %s may have been %s; rugo status --server %.120s %s tells, and the same command "
        "may be repeated",
        id, done, access->server, id);
    return client_change(access->client, request, doubt, out, err);
}

static int change_study(struct access *access, const char *method, const char *id, const char *rest,
                        const char *done, cJSON **out, struct error *err) {
    char path[320];
    const struct request request = {.method = method, .path = path};
    int status = access_study_path(path, sizeof path, id, rest, err);
    return status != 0 ? status : ask_change(access, &request, id, done, out, err);
}

int access_cancel(struct access *access, const char *id, cJSON **out, struct error *err) {
    return access->client != NULL ? change_study(access, "DELETE", id, "", "cancelled", out, err)
                                  : api_cancel(access->store, id, out, err);
}

int access_retry(struct access *access, const char *id, cJSON **out, struct error *err) {
    return access->client != NULL ? change_study(access, "POST", id, "/retry", "retried", out, err)
                                  : api_retry(access->store, id, out, err);
}

int access_delete(struct access *access, const char *id, cJSON **out, struct error *err) {
    if (access->client != NULL)
        return change_study(access, "DELETE", id, "?results=true", "deleted", out, err);
    int status = api_delete(access->store, id, out, err);
    if (status == 0 && (status = store_purge(access->store, NULL, NULL, err)) != 0) {
        cJSON_Delete(*out);
        *out = NULL;
    }
    return status;
}

int access_extend(struct access *access, const char *id, uint64_t realisations, cJSON **out,
                  struct error *err) {
    char path[320], body[64];
    if (access->client == NULL)
        return api_extend(access->store, id, realisations, out, err);
    snprintf(body, sizeof body, "{\"realisations\":%llu}", (unsigned long long)realisations);
    const struct request request = {.method = "POST", .path = path, .body = body};
    int status = access_study_path(path, sizeof path, id, "/extend", err);
    return status != 0 ? status : ask_change(access, &request, id, "extended", out, err);
}
