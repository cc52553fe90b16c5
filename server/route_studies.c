/* Studies over HTTP: submission, progress, curves, reports. */
#include "server/api.h"
#include "server/route.h"
#include "worker/aggregate.h"
#include "worker/kinds.h"
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* --- changes, through the writer --- */

struct submission {
    const struct study *study;
    const char *key;
    cJSON *document;
    bool existing;
};

static int submit_change(struct store *store, void *context, struct error *err) {
    struct submission *submission = context;
    return api_submit(store, submission->study, submission->key, &submission->document,
                      &submission->existing, err);
}

static void submit(struct exchange *exchange, const struct study *study) {
    struct submission submission = {.study = study,
                                    .key = exchange_header(exchange, "Idempotency-Key")};
    struct error err = {0};
    if (writer_do(exchange->service->writer, submit_change, &submission, &err)) {
        cJSON_Delete(submission.document); /* made, but its commit failed */
        answer_error(exchange, &err);
        return;
    }
    char location[64];
    const cJSON *id = cJSON_GetObjectItemCaseSensitive(submission.document, "id");
    snprintf(location, sizeof location, "/v1/studies/%s", cJSON_GetStringValue(id));
    answer_json(exchange, submission.existing ? 200 : 201, submission.document);
    answer_header(exchange, "Location", location);
}

/* Checks on the connection's thread: ten thousand cases must not hold up the writer. */
void handle_study_create(struct exchange *exchange, const char *id) {
    (void)id;
    struct fault_list faults = {0};
    struct study *study = NULL;
    struct error err = {0};
    cJSON *parsed = body_json(exchange); /* 400 for what is no JSON, 422 for what is no study */
    if (!parsed)
        return;
    cJSON_Delete(parsed);
    if (!kinds_read_study(&study, exchange->body, exchange->body_size, NULL, &faults, &err))
        submit(exchange, study);
    else if (faults.count)
        answer_problem(exchange, 422, "the study is not valid", &faults);
    else
        answer_error(exchange, &err);
    study_destroy(&study);
    fault_list_clear(&faults);
}

struct study_change {
    const char *id;
    cJSON *document;
    int (*api)(struct store *store, const char *id, cJSON **out, struct error *err);
};

static int change_study(struct store *store, void *context, struct error *err) {
    struct study_change *change = context;
    return change->api(store, change->id, &change->document, err);
}

static void answer_change(struct exchange *exchange, struct study_change change) {
    struct error err = {0};
    if (writer_do(exchange->service->writer, change_study, &change, &err)) {
        cJSON_Delete(change.document); /* made, but its commit failed */
        answer_error(exchange, &err);
    } else {
        answer_json(exchange, 200, change.document);
    }
}

void handle_study_cancel(struct exchange *exchange, const char *id) {
    answer_change(exchange, (struct study_change){.id = id, .api = api_cancel});
}

void handle_study_retry(struct exchange *exchange, const char *id) {
    answer_change(exchange, (struct study_change){.id = id, .api = api_retry});
}

/* --- questions, to a reader --- */

/* A whole number in the query: its value, or fallback when it is not there. False after a 422. */
static bool query_number(struct exchange *exchange, const char *name, int64_t least, int64_t most,
                         int64_t *value) {
    const char *text = exchange_query(exchange, name);
    char *end;
    if (!text)
        return true;
    errno = 0;
    long long number = strtoll(text, &end, 10);
    if (!errno && end != text && !*end && number >= least && number <= most) {
        *value = number;
        return true;
    }
    struct fault_list faults = {0};
    char pointer[32];
    snprintf(pointer, sizeof pointer, "?%.20s", name);
    fault_add(&faults, pointer, "%.40s is not in [%lld, %lld]", text, (long long)least,
              (long long)most);
    answer_problem(exchange, 422, "the query is not valid", &faults);
    fault_list_clear(&faults);
    return false;
}

void handle_study_list(struct exchange *exchange, const char *id) {
    (void)id;
    struct store *reader;
    struct error err = {0};
    cJSON *document = NULL;
    int64_t limit = 100;
    if (!query_number(exchange, "limit", 1, 1000, &limit))
        return;
    int status = service_reader(exchange->service, &reader, &err);
    if (!status)
        status =
            api_list(reader, exchange_query(exchange, "after"), (size_t)limit, &document, &err);
    service_give_back(exchange->service, reader);
    if (status)
        answer_error(exchange, &err);
    else
        answer_json(exchange, 200, document);
}

void handle_study(struct exchange *exchange, const char *id) {
    struct store *reader;
    struct error err = {0};
    cJSON *document = NULL;
    int status = service_reader(exchange->service, &reader, &err);
    if (!status)
        status = api_status(reader, id, &document, &err);
    service_give_back(exchange->service, reader);
    if (status)
        answer_error(exchange, &err);
    else
        answer_json(exchange, 200, document);
}

void handle_report(struct exchange *exchange, const char *id) {
    struct store *reader;
    struct error err = {0};
    cJSON *document = NULL;
    int status = service_reader(exchange->service, &reader, &err);
    if (!status)
        status = aggregate_report(reader, id, &document, &err);
    service_give_back(exchange->service, reader);
    if (status)
        answer_error(exchange, &err);
    else
        answer_json(exchange, 200, document);
}

/* --- curves --- */

static bool wants_csv(const struct exchange *exchange) {
    const char *accept = exchange_header(exchange, "Accept");
    return accept && strstr(accept, "text/csv");
}

/* Every change of a study's results raises its revision: that, and the form, is the answer's
 * identity. */
static int curves_etag(struct exchange *exchange, struct store *reader, const char *id, char *etag,
                       size_t size, struct error *err) {
    struct study_status status;
    int code = store_status(reader, id, &status, err);
    if (code)
        return code;
    snprintf(etag, size, "\"%s-%llu-%s\"", id, (unsigned long long)status.revision,
             wants_csv(exchange) ? "csv" : "json");
    study_status_clear(&status);
    return 0;
}

static bool matches(const struct exchange *exchange, const char *etag) {
    const char *known = exchange_header(exchange, "If-None-Match");
    return known && (strcmp(known, "*") == 0 || strstr(known, etag));
}

static int read_curves(struct exchange *exchange, struct store *reader, const char *id,
                       const struct curve_filter *filter, struct error *err) {
    cJSON *document = NULL;
    char *csv = NULL;
    int status = aggregate_curves(reader, id, filter, &document, err);
    if (!status && !wants_csv(exchange)) {
        answer_json(exchange, 200, document);
        return 0;
    }
    if (!status)
        status = aggregate_csv(document, &csv, err);
    cJSON_Delete(document);
    if (!status)
        answer_text(exchange, 200, "text/csv; charset=utf-8", csv);
    return status;
}

void handle_curves(struct exchange *exchange, const char *id) {
    struct store *reader;
    struct error err = {0};
    struct curve_filter filter = {.case_number = -1,
                                  .quantity = exchange_query(exchange, "quantity")};
    char etag[80] = "";
    if (!query_number(exchange, "case", 0, INT64_MAX, &filter.case_number))
        return;
    int status = service_reader(exchange->service, &reader, &err);
    if (!status)
        status = curves_etag(exchange, reader, id, etag, sizeof etag, &err);
    if (!status && matches(exchange, etag))
        answer_empty(exchange, 304);
    else if (!status)
        status = read_curves(exchange, reader, id, &filter, &err);
    service_give_back(exchange->service, reader);
    if (status) {
        answer_error(exchange, &err);
        return;
    }
    answer_header(exchange, "ETag", etag);
    answer_header(exchange, "Vary", "Accept");
}
