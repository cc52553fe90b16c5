/* Jobs from a server, over HTTP in the encoding of wire.h. */
#include "schema/json/field.h"
#include "worker/link/client.h"
#include "worker/link/header_names.h"
#include "worker/link/source_backend.h"
#include "worker/link/wire_report.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum {
    HEARTBEAT_MS = 10000, /* a heartbeat without an answer must not delay what follows */
    CLAIM_MS = 20000,
    RESULT_MS = 60000,
};

struct remote {
    struct client *client;
    bool older; /* the server takes only single reports */
    char other_forms[WIRE_FORMS_SIZE];
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
    int status = client_create(&remote->client, options->url, options->token, &options->trust, err);
    if (status != 0) {
        remote_destroy(remote);
        return status;
    }
    *self = remote;
    return 0;
}

/* Posts a body, which it takes (NULL: out of memory); *answer may be NULL for an empty one. */
static int remote_post(struct remote *remote, struct request *request, cJSON *body, cJSON **answer,
                       struct error *err) {
    char *text = body != NULL ? json_print(body) : NULL;
    cJSON_Delete(body);
    if (text == NULL)
        return error_set(err, ERROR_MEMORY, "no memory left for a request");
    request->method = "POST";
    request->body = text;
    int status = client_json(remote->client, request, answer, err);
    free(text);
    return status;
}

static int remote_claim(void *self, const struct claim *claim, const struct wish *wish,
                        struct claimed_job *jobs, size_t *count, bool *due, struct error *err) {
    struct remote *remote = self;
    cJSON *answer = NULL;
    struct request request = {
        .path = "/v1/jobs/claim",
        .timeout_ms = CLAIM_MS + 1000 * (long)wish->wait_s,
        .wait_s = wish->wait_s,
        .stop = wish->stop,
        .context = wish->context,
    };
    (void)due;
    int status = remote_post(remote, &request, wire_claim(claim), &answer, err);
    if (status == ERROR_STATE) /* concerns no job: the server cannot do it now */
        return err->code = ERROR_SYSTEM;
    if (status != 0)
        return status;
    client_header_text(remote->client, OTHER_FORMS_HEADER, remote->other_forms,
                       sizeof remote->other_forms);
    if (!worker_name_is_plain(remote->other_forms)) /* it is logged */
        remote->other_forms[0] = '\0';
    *count = 0;
    if (answer != NULL)
        status = wire_jobs_read(answer, jobs, wish->count, count, err);
    cJSON_Delete(answer);
    if (status == ERROR_INPUT) { /* the reply is wrong, not the request */
        err->code = ERROR_SYSTEM;
        status = error_context(err, "the server's answer to a claim");
    }
    return status;
}

static bool has_results(const struct report *reports, size_t count) {
    for (size_t n = 0; n < count; n++)
        if (reports[n].verb == REPORT_COMPLETE)
            return true;
    return false;
}

/* A job that the server does not know is lost: the server has another database by now. */
static void lose_absent(struct report *report) {
    if (report->status == ERROR_ABSENT)
        report->status = report->err.code = ERROR_STATE;
}

/* Reports one by one to an older server. If one has no answer the batch fails as a whole: those
 * before it may be reported again. */
static int report_alone(struct remote *remote, struct report *reports, size_t count,
                        struct error *err) {
    for (size_t n = 0; n < count; n++) {
        struct report *report = &reports[n];
        cJSON *answer = NULL;
        char path[64];
        struct request request = {
            .path = path,
            .timeout_ms = has_results(report, 1) ? RESULT_MS : HEARTBEAT_MS,
        };
        snprintf(path, sizeof path, "/v1/jobs/%lld/%s", (long long)report->job->id,
                 wire_verb(report->verb));
        report->status =
            remote_post(remote, &request, wire_report_body(report), &answer, &report->err);
        cJSON_Delete(answer);
        lose_absent(report);
        if (report->status == ERROR_SYSTEM || report->status == ERROR_MEMORY) {
            *err = report->err;
            return report->status;
        }
    }
    return 0;
}

static int remote_report(void *self, struct report *reports, size_t count, bool *due,
                         struct error *err) {
    struct remote *remote = self;
    cJSON *answer = NULL;
    struct request request = {
        .path = "/v1/jobs/report",
        .timeout_ms = has_results(reports, count) ? RESULT_MS : HEARTBEAT_MS,
    };
    (void)due;
    if (remote->older)
        return report_alone(remote, reports, count, err);
    int status = remote_post(remote, &request, wire_reports(reports, count), &answer, err);
    if (status == ERROR_ABSENT) {
        remote->older = true;
        return report_alone(remote, reports, count, err);
    }
    if (status == 0)
        status = wire_answers_read(answer, reports, count, err);
    cJSON_Delete(answer);
    if (status == ERROR_INPUT && answer != NULL) {
        err->code = ERROR_SYSTEM;
        status = error_context(err, "the server's answer to reports");
    }
    for (size_t n = 0; n < count && status == 0; n++)
        lose_absent(&reports[n]);
    return status;
}

static const char *remote_other_forms(const void *self) {
    return ((const struct remote *)self)->other_forms;
}

static bool is_of_other_form(const struct remote *remote, const char *kind) {
    const char *at = kind != NULL ? strstr(remote->other_forms, kind) : NULL;
    while (at != NULL &&
           ((at > remote->other_forms && at[-1] != ' ') || strchr(",", at[strlen(kind)]) == NULL))
        at = strstr(at + 1, kind);
    return at != NULL;
}

/* Judges a study by its jobs. Its state is "running" until the server has published it, for which
 * no worker waits, unless that may queue more jobs. */
static bool study_goes_on(const struct remote *remote, const cJSON *study) {
    const cJSON *jobs = field_at(study, "jobs");
    if (is_of_other_form(remote, cJSON_GetStringValue(field_at(study, "kind"))))
        return false;
    return cJSON_GetNumberValue(field_at(jobs, "waiting")) > 0 ||
           cJSON_GetNumberValue(field_at(jobs, "running")) > 0 ||
           cJSON_IsTrue(field_at(study, "planning"));
}

/* Pages through the server's list of studies until one goes on. */
static int remote_left(void *self, int *left, bool *due, struct error *err) {
    (void)due;
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
            found = found || study_goes_on(remote, study);
            more = id != NULL && strlen(id) < sizeof after && strcmp(id, after) != 0;
            if (more)
                memcpy(after, id, strlen(id) + 1);
        }
        cJSON_Delete(page);
    }
    if (status == ERROR_INPUT) /* the token may not list studies */
        status = 0;
    if (status == 0)
        *left = found;
    return status;
}

const struct source_backend SOURCE_SERVER = {
    .create = remote_create,
    .destroy = remote_destroy,
    .claim = remote_claim,
    .report = remote_report,
    .other_forms = remote_other_forms,
    .left = remote_left,
};
