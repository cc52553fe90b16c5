/* Reports of workers, single ones and many in one request; worker/link/wire.h says what crosses. */
#include "server/http/route/route.h"
#include "worker/checker.h"
#include "worker/link/wire.h"
#include "worker/link/wire_report.h"
#include <errno.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

void refuse_message(struct exchange *exchange, const struct error *err) {
    struct fault_list faults = {0};
    char pointer[64] = "";
    const char *detail = err->text, *end = strstr(err->text, ": ");
    if (*detail == '/' && end != NULL && end - detail < (ptrdiff_t)sizeof pointer) {
        snprintf(pointer, sizeof pointer, "%.*s", (int)(end - detail), detail);
        detail = end + strlen(": ");
    }
    fault_add(&faults, pointer, "%s", detail);
    answer_problem(exchange, err->code == ERROR_MEMORY ? 503 : 422, err->text, &faults);
    fault_list_clear(&faults);
}

static bool job_number(struct exchange *exchange, const char *id, int64_t *job) {
    char *end;
    errno = 0;
    *job = strtoll(id, &end, 10);
    bool good = *id >= '0' && *id <= '9' && errno == 0 && end != id && *end == '\0' && *job > 0;
    if (!good)
        answer_problem(exchange, 404, "there is no such job", NULL);
    return good;
}

/* --- heartbeat, fail, release --- */

struct reporting {
    struct wire_report report;
    int64_t job;
};

static int heartbeat_change(struct store *store, void *context, struct error *err) {
    struct reporting *r = context;
    return store_heartbeat(store, r->job, r->report.token, r->report.done, err);
}

static int fail_change(struct store *store, void *context, struct error *err) {
    struct reporting *r = context;
    const char *reason = *r->report.reason != '\0' ? r->report.reason : "no reason was given";
    return store_fail(store, r->job, r->report.token, reason, r->report.permanent, err);
}

static int release_change(struct store *store, void *context, struct error *err) {
    struct reporting *r = context;
    return store_release(store, r->job, r->report.token, err);
}

static void handle_report_of(struct exchange *exchange, const char *id, store_change *change) {
    struct reporting reporting;
    struct error err = {0};
    if (!job_number(exchange, id, &reporting.job))
        return;
    cJSON *body = body_json(exchange);
    if (body == NULL)
        return;
    if (wire_report_read(body, &reporting.report, &err) != 0)
        refuse_message(exchange, &err);
    else if (writer_do(exchange->service->writer, change, &reporting, &err) != 0)
        answer_error(exchange, &err);
    else
        answer_json(exchange, 200, cJSON_CreateObject());
    cJSON_Delete(body);
}

void handle_heartbeat(struct exchange *exchange, const char *id) {
    handle_report_of(exchange, id, heartbeat_change);
}

void handle_fail(struct exchange *exchange, const char *id) {
    handle_report_of(exchange, id, fail_change);
}

void handle_release(struct exchange *exchange, const char *id) {
    handle_report_of(exchange, id, release_change);
}

/* --- complete --- */

struct completing {
    struct block_result block;
    char token[TOKEN_SIZE];
    int64_t job;
    bool first_time, case_done;
};

static int complete_change(struct store *store, void *context, struct error *err) {
    struct completing *c = context;
    return store_complete(store, c->job, c->token, &c->block, &c->first_time, &c->case_done, err);
}

/* Checks a result against the job that its worker has under this token. */
static int check_result(struct exchange *exchange, int64_t number, const char *token,
                        const struct block_result *result, struct error *err) {
    struct store *reader;
    struct claimed_job job = {0};
    /* Not one that stops when the server ends: its own workers hand in what they have by then. */
    int status = service_reader(exchange->service, &reader, err);
    if (status == 0)
        status = store_job(reader, number, token, &job, err);
    service_give_back(exchange->service, reader);
    if (status == 0)
        status = checker_check(exchange->service->checker, &job, result, err);
    claimed_job_clear(&job);
    return status;
}

static void complete(struct exchange *exchange, struct completing *completing) {
    struct block_text text = {0};
    struct error err = {0};
    int status =
        check_result(exchange, completing->job, completing->token, &completing->block, &err);
    if (status == 0)
        status = block_text_create(&text, &completing->block, &err);
    completing->block.text = &text;
    if (status == 0)
        status = writer_do(exchange->service->writer, complete_change, completing, &err);
    block_text_clear(&text);
    completing->block.text = NULL;
    if (status == ERROR_INPUT) {
        refuse_message(exchange, &err);
        return;
    }
    if (status != 0) {
        answer_error(exchange, &err);
        return;
    }
    cJSON *document = cJSON_CreateObject();
    if (document != NULL &&
        cJSON_AddBoolToObject(document, "case_done", completing->case_done) == NULL) {
        cJSON_Delete(document);
        document = NULL;
    }
    answer_json(exchange, 200, document);
}

void handle_complete(struct exchange *exchange, const char *id) {
    struct completing completing = {.job = 0};
    struct error err = {0};
    if (!job_number(exchange, id, &completing.job))
        return;
    cJSON *body = body_json(exchange);
    if (body == NULL)
        return;
    if (wire_result_read(body, completing.token, &completing.block, &err) != 0)
        refuse_message(exchange, &err);
    else
        complete(exchange, &completing);
    block_result_clear(&completing.block);
    cJSON_Delete(body);
}

/* --- many in one request --- */

struct report_list {
    struct wire_item *items;
    struct block_text *texts; /* of the results, made before the writer is asked */
    size_t count;
};

/* One change of the store for all of them: each is all or nothing, and has its own status. */
static int report_change(struct store *store, void *context, struct error *err) {
    struct report_list *list = context;
    (void)err;
    for (size_t n = 0; n < list->count; n++) {
        struct wire_item *item = &list->items[n];
        const struct wire_report *report = &item->report;
        bool first_time = false;
        if (item->status != 0)
            continue;
        if (item->verb == REPORT_HEARTBEAT)
            item->status =
                store_heartbeat(store, item->job, report->token, report->done, &item->err);
        else if (item->verb == REPORT_COMPLETE)
            item->status = store_complete(store, item->job, report->token, &item->block,
                                          &first_time, &item->case_done, &item->err);
        else if (item->verb == REPORT_FAIL)
            item->status = store_fail(store, item->job, report->token, report->reason,
                                      report->permanent, &item->err);
        else
            item->status = store_release(store, item->job, report->token, &item->err);
    }
    return 0;
}

/* Results are checked beforehand. */
static void prepare(struct exchange *exchange, struct report_list *list) {
    for (size_t n = 0; n < list->count; n++) {
        struct wire_item *item = &list->items[n];
        if (item->verb != REPORT_COMPLETE || item->status != 0)
            continue;
        item->status =
            check_result(exchange, item->job, item->report.token, &item->block, &item->err);
        if (item->status == 0)
            item->status = block_text_create(&list->texts[n], &item->block, &item->err);
        if (item->status == 0)
            item->block.text = &list->texts[n];
    }
}

static void report_all(struct exchange *exchange, struct report_list *list) {
    struct error err = {0};
    list->texts = array_create(list->count, sizeof *list->texts);
    if (list->texts == NULL) {
        error_memory(&err, list->count * sizeof *list->texts, "texts of results");
        answer_error(exchange, &err);
        return;
    }
    prepare(exchange, list);
    if (writer_do(exchange->service->writer, report_change, list, &err) != 0)
        answer_error(exchange, &err);
    else
        answer_json(exchange, 200, wire_answers(list->items, list->count));
    for (size_t n = 0; n < list->count; n++) {
        list->items[n].block.text = NULL;
        block_text_clear(&list->texts[n]);
    }
    free(list->texts);
}

void handle_report_many(struct exchange *exchange, const char *id) {
    (void)id;
    struct report_list list = {.count = 0};
    struct error err = {0};
    cJSON *body = body_json(exchange);
    if (body == NULL)
        return;
    if (wire_reports_read(body, &list.items, &list.count, &err) != 0)
        refuse_message(exchange, &err);
    else
        report_all(exchange, &list);
    wire_items_free(list.items, list.count);
    cJSON_Delete(body);
}
