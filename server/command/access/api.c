#include "server/command/access/api.h"
#include "jobs/kind.h"
#include "schema/json/field.h"
#include "worker/publish/publish.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static int finish(cJSON *document, bool complete, cJSON **out, struct error *err) {
    if (document == NULL || !complete) {
        cJSON_Delete(document);
        return error_memory(err, 0, "a document");
    }
    *out = document;
    return 0;
}

/* --- submission --- */

static cJSON *submitted(const struct study_status *status, bool *complete) {
    cJSON *document = cJSON_CreateObject();
    *complete = document != NULL && field_put(document, "id", cJSON_CreateString(status->id)) &&
                field_put(document, "name", cJSON_CreateString(status->name)) &&
                field_put(document, "state", cJSON_CreateString(status->state)) &&
                field_put_count(document, "cases", status->cases) &&
                field_put_count(document, "jobs", status->jobs) &&
                field_put_count(document, "realisations_done", status->realisations_done);
    return document;
}

int api_submit(struct store *store, const struct study *study, const char *key, cJSON **out,
               bool *existing, struct error *err) {
    char id[STUDY_ID_SIZE];
    struct study_status now = {0};
    int status = store_submit(store, study, key, id, existing, err);
    if (status == 0)
        status = store_status_counted(store, id, &now, err);
    if (status != 0)
        return status;
    bool complete;
    cJSON *document = submitted(&now, &complete);
    study_status_clear(&now);
    return finish(document, complete, out, err);
}

/* --- progress --- */

static bool put_jobs(cJSON *object, const struct study_status *status) {
    cJSON *jobs = cJSON_AddObjectToObject(object, "jobs");
    return jobs != NULL && field_put_count(jobs, "total", status->jobs) &&
           field_put_count(jobs, "done", status->jobs_done) &&
           field_put_count(jobs, "failed", status->jobs_failed) &&
           field_put_count(jobs, "running", status->jobs_running) &&
           field_put_count(jobs, "waiting", status->jobs_waiting) &&
           field_put_count(jobs, "cancelled", status->jobs_cancelled);
}

static bool put_realisations(cJSON *object, const struct study_status *status) {
    cJSON *realisations = cJSON_AddObjectToObject(object, "realisations");
    return realisations != NULL &&
           field_put_count(realisations, "total", status->realisations_total) &&
           field_put_count(realisations, "done", status->realisations_done) &&
           field_put_count(realisations, "failed", status->realisations_failed);
}

static bool put_known(cJSON *object, const char *name, const char *text) {
    return field_put(object, name, *text != '\0' ? cJSON_CreateString(text) : cJSON_CreateNull());
}

/* Whether a round of a study that asks for an error has ended, and the next may follow. */
static bool is_planning(const struct study_status *status) {
    return status->realisations == 0 && strcmp(status->state, "running") == 0 &&
           status->jobs_waiting + status->jobs_running == 0;
}

/* Whose it is, and where it stands among those that wait. */
static bool put_line(cJSON *object, const struct study_status *status) {
    bool waits = status->place > 0;
    return put_known(object, "owner", status->owner) &&
           field_put(object, "priority", cJSON_CreateNumber((double)status->priority)) &&
           field_put(object, "place",
                     waits ? cJSON_CreateNumber((double)status->place) : cJSON_CreateNull()) &&
           field_put(object, "starts_in",
                     waits ? json_number(status->starts_in) : cJSON_CreateNull());
}

static cJSON *progress(const struct study_status *status, bool *complete) {
    char seed[24];
    snprintf(seed, sizeof seed, "%llu", (unsigned long long)status->seed);
    cJSON *document = cJSON_CreateObject();
    *complete = document != NULL && field_put(document, "id", cJSON_CreateString(status->id)) &&
                field_put(document, "name", cJSON_CreateString(status->name)) &&
                field_put(document, "kind", cJSON_CreateString(status->kind)) &&
                field_put(document, "state", cJSON_CreateString(status->state)) &&
                field_put(document, "seed", cJSON_CreateString(seed)) &&
                field_put(document, "random",
                          cJSON_CreateString(choice_name(STUDY_RANDOM, (int)status->random))) &&
                put_line(document, status) && field_put_count(document, "cases", status->cases) &&
                field_put_count(document, "cases_failed", status->cases_failed) &&
                field_put(document, "planning", cJSON_CreateBool(is_planning(status))) &&
                (isnan(status->error_reached) ||
                 field_put(document, "error_reached", json_number(status->error_reached))) &&
                put_jobs(document, status) && put_realisations(document, status) &&
                field_put(document, "part", json_number(status->part)) &&
                field_put_count(document, "workers", status->workers) &&
                field_put(document, "seconds", json_number(status->time.seconds)) &&
                field_put(document, "cpu_seconds", json_number(status->time.cpu_seconds)) &&
                field_put_count(document, "jobs_without_cpu", status->time.jobs_without_cpu) &&
                field_put(document, "share", json_number(status->share)) &&
                field_put(document, "seconds_left", json_number(status->seconds_left)) &&
                field_put_count(document, "revision", status->revision) &&
                put_known(document, "program", status->program) &&
                put_known(document, "created", status->created) &&
                put_known(document, "finished", status->finished);
    return document;
}

static bool put_failures(cJSON *document, const struct failure *failures, size_t count) {
    cJSON *list = cJSON_AddArrayToObject(document, "failures");
    bool complete = list != NULL;
    for (size_t i = 0; complete && i < count; i++) {
        const struct failure *failure = &failures[i];
        cJSON *entry = list_put_object(list);
        complete = entry != NULL &&
                   field_put(entry, "job",
                             failure->job != 0 ? cJSON_CreateNumber((double)failure->job)
                                               : cJSON_CreateNull()) &&
                   field_put_count(entry, "case", failure->case_number) &&
                   field_put_count(entry, "first", failure->first) &&
                   field_put_count(entry, "count", failure->count) &&
                   field_put_count(entry, "attempts", failure->attempts) &&
                   field_put_count(entry, "losses", failure->losses) &&
                   field_put(entry, "worker", cJSON_CreateString(failure->worker)) &&
                   field_put(entry, "reason", cJSON_CreateString(failure->reason));
    }
    return complete;
}

static bool put_valueless(cJSON *document, const struct valueless *valueless) {
    return field_put_count(document, "cases_valueless", valueless->cases) &&
           (valueless->cases == 0 || field_put_text(document, "valueless_note", valueless->note));
}

/* What is shown only of a study that has ended is asked for then alone: events look at others
 * often. */
static bool has_ended(const struct study_status *status) {
    return strcmp(status->state, "done") == 0 || strcmp(status->state, "failed") == 0;
}

int api_status(struct store *store, const char *id, cJSON **out, struct error *err) {
    struct study_status status = {0};
    struct valueless valueless = {0};
    struct failure *failures = NULL;
    size_t count = 0;
    int code = store_status(store, id, &status, err);
    if (code == 0 && status.jobs_failed + status.cases_failed > 0)
        code = store_failures(store, id, &failures, &count, err);
    if (code == 0 && has_ended(&status))
        code = store_valueless(store, id, &valueless, err);
    if (code == 0) {
        bool complete;
        cJSON *document = progress(&status, &complete);
        complete = complete && put_failures(document, failures, count) &&
                   put_valueless(document, &valueless);
        code = finish(document, complete, out, err);
    }
    valueless_clear(&valueless);
    failures_free(failures, count);
    study_status_clear(&status);
    return code;
}

/* Makes what the list has of a study: its progress, and how many cases of an ended one are without
 * values. */
static int list_entry(struct store *store, const struct study_status *study, cJSON *studies,
                      struct error *err) {
    struct valueless valueless = {0};
    int status = has_ended(study) ? store_valueless(store, study->id, &valueless, err) : 0;
    if (status == ERROR_ABSENT) /* it was deleted since it was listed */
        return 0;
    if (status != 0)
        return status;
    bool complete;
    cJSON *entry = progress(study, &complete);
    if (!list_put(studies, entry) || !complete || !put_valueless(entry, &valueless))
        status = error_memory(err, 0, "a list of studies");
    valueless_clear(&valueless);
    return status;
}

int api_list(struct store *store, const char *after, size_t limit, cJSON **out, struct error *err) {
    struct study_status *list = NULL;
    size_t count = 0;
    int status = store_list(store, after, limit, &list, &count, err);
    if (status != 0)
        return status;
    cJSON *document = cJSON_CreateObject();
    cJSON *studies = document != NULL ? cJSON_AddArrayToObject(document, "studies") : NULL;
    bool complete = studies != NULL;
    for (size_t i = 0; complete && status == 0 && i < count; i++)
        status = list_entry(store, &list[i], studies, err);
    /* A full page may have a next one. */
    if (complete && status == 0 && count == limit)
        complete = field_put(document, "next", cJSON_CreateString(list[count - 1].id));
    for (size_t i = 0; i < count; i++)
        study_status_clear(&list[i]);
    free(list);
    if (status != 0) {
        cJSON_Delete(document);
        return status;
    }
    return finish(document, complete, out, err);
}

int api_cancel(struct store *store, const char *id, cJSON **out, struct error *err) {
    int status = store_cancel(store, id, err);
    return status != 0 ? status : api_status(store, id, out, err);
}

/* Reads the form of this program's results of the study's kind; results of a kind that it does not
 * know would be of another form: 0. */
static int edition_of(struct store *store, const char *id, uint64_t *edition, struct error *err) {
    struct study_status now = {0};
    int status = store_status_counted(store, id, &now, err);
    const struct job_kind *kind = status == 0 ? kind_find(now.kind) : NULL;
    study_status_clear(&now);
    *edition = kind != NULL ? kind_edition(kind) : 0;
    return status;
}

/* Cases whose mark is gone are due: no worker may come to publish them. */
static int retry(struct store *store, const char *id, bool publishes, cJSON **out,
                 struct error *err) {
    uint64_t count, edition;
    int status = edition_of(store, id, &edition, err);
    if (status == 0)
        status = store_retry(store, id, edition, &count, err);
    if (status == 0 && publishes)
        status = publish_due(store, NULL, NULL, NULL, err);
    if (status == 0)
        status = api_status(store, id, out, err);
    if (status == 0 && !field_put_count(*out, "retried", count)) {
        cJSON_Delete(*out);
        *out = NULL;
        status = error_memory(err, 0, "a document");
    }
    return status;
}

int api_retry(struct store *store, const char *id, cJSON **out, struct error *err) {
    return retry(store, id, false, out, err);
}

int api_retry_publish(struct store *store, const char *id, cJSON **out, struct error *err) {
    return retry(store, id, true, out, err);
}

int api_extend(struct store *store, const char *id, uint64_t realisations, cJSON **out,
               struct error *err) {
    uint64_t jobs = 0, edition;
    int status = edition_of(store, id, &edition, err);
    if (status == 0)
        status = store_extend(store, id, realisations, edition, &jobs, err);
    if (status == 0)
        status = api_status(store, id, out, err);
    if (status == 0 && !field_put_count(*out, "queued", jobs)) {
        cJSON_Delete(*out);
        *out = NULL;
        status = error_memory(err, 0, "a document");
    }
    return status;
}

int api_delete(struct store *store, const char *id, cJSON **out, struct error *err) {
    struct study_status now = {0};
    int status = store_status_counted(store, id, &now, err);
    if (status == 0)
        status = store_delete(store, id, err);
    if (status == 0) {
        cJSON *document = cJSON_CreateObject();
        bool complete = document != NULL && field_put_text(document, "id", id) &&
                        field_put_text(document, "name", now.name) &&
                        field_put_text(document, "state", "deleted");
        status = finish(document, complete, out, err);
    }
    study_status_clear(&now);
    return status;
}

/* --- workers --- */

static bool put_job(cJSON *jobs, const struct worker_activity *worker) {
    cJSON *job = list_put_object(jobs);
    return job != NULL && field_put_text(job, "study", worker->study) &&
           field_put_text(job, "name", worker->study_name) &&
           field_put_count(job, "case", worker->case_number) &&
           field_put_count(job, "job", (uint64_t)worker->job) &&
           field_put_count(job, "count", worker->count) &&
           field_put_count(job, "done", worker->done) &&
           field_put(job, "part", json_number(worker->part)) &&
           field_put_text(job, "since", worker->claimed);
}

/* Rows of one worker stand together; the jobs of all go into one entry. */
static cJSON *worker_entry(cJSON *list, const struct worker_activity *worker, bool same) {
    if (same)
        return cJSON_GetArrayItem(list, cJSON_GetArraySize(list) - 1);
    cJSON *entry = list_put_object(list);
    const char *seen = worker->job > 0 ? worker->claimed : worker->last_ended;
    if (worker->job > 0 && strcmp(worker->last_ended, seen) > 0)
        seen = worker->last_ended;
    bool complete = entry != NULL && field_put_text(entry, "name", worker->name) &&
                    field_put_text(entry, "host", worker->host) &&
                    field_put(entry, "jobs", cJSON_CreateArray()) &&
                    field_put_count(entry, "jobs_last_hour", worker->recent_jobs) &&
                    field_put_text(entry, "last_seen", seen);
    return complete ? entry : NULL;
}

int api_workers(struct store *store, cJSON **out, struct error *err) {
    struct worker_activity *all = NULL;
    struct store_metrics metrics = {0};
    size_t count = 0;
    int status = store_workers(store, &all, &count, err);
    if (status == 0)
        status = store_metrics(store, &metrics, err);
    if (status != 0) {
        workers_free(all, count);
        return status;
    }
    cJSON *document = cJSON_CreateObject();
    cJSON *list = cJSON_AddArrayToObject(document, "workers");
    bool complete = list != NULL && field_put_count(document, "waiting", metrics.jobs_waiting);
    for (size_t w = 0; complete && w < count; w++) {
        bool same = w > 0 && strcmp(all[w].name, all[w - 1].name) == 0 &&
                    strcmp(all[w].host, all[w - 1].host) == 0;
        cJSON *entry = worker_entry(list, &all[w], same);
        complete = entry != NULL &&
                   (all[w].job == 0 || put_job(cJSON_GetObjectItem(entry, "jobs"), &all[w]));
    }
    workers_free(all, count);
    return finish(document, complete, out, err);
}
