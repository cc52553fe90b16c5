#include "worker/link/wire_report.h"
#include "schema/json/field.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const char *const VERBS[] = {"heartbeat", "complete", "fail", "release"};
enum { VERB_COUNT = sizeof VERBS / sizeof *VERBS };

/* --- reports --- */

const char *wire_verb(enum report_verb verb) {
    return VERBS[verb];
}

cJSON *wire_report_body(const struct report *report) {
    const char *token = report->job->token;
    switch (report->verb) {
    case REPORT_HEARTBEAT:
        return wire_heartbeat(token, report->done);
    case REPORT_COMPLETE:
        return wire_result(token, report->result);
    case REPORT_FAIL:
        return wire_fail(token, report->reason, report->permanent);
    default:
        return wire_release(token);
    }
}

cJSON *wire_reports(const struct report *reports, size_t count) {
    cJSON *value = cJSON_CreateObject(), *array = cJSON_CreateArray();
    bool complete = field_put(value, "reports", array);
    for (size_t n = 0; complete && n < count; n++) {
        cJSON *item = wire_report_body(&reports[n]);
        complete = list_put(array, item) &&
                   field_put_text(item, "verb", wire_verb(reports[n].verb)) &&
                   field_put(item, "job", cJSON_CreateNumber((double)reports[n].job->id));
    }
    return fields_finish(value, complete);
}

static int verb_read(const cJSON *value, enum report_verb *out, struct error *err) {
    const char *text = cJSON_GetStringValue(field_at(value, "verb"));
    for (size_t v = 0; text != NULL && v < VERB_COUNT; v++) {
        if (strcmp(text, VERBS[v]) == 0) {
            *out = (enum report_verb)v;
            return 0;
        }
    }
    return field_fault(field_at(value, "verb"), "verb", "heartbeat, complete, fail or release",
                       err);
}

static int item_read(const cJSON *value, struct wire_item *item, struct error *err) {
    uint64_t job = 0;
    int status = cJSON_IsObject(value) ? verb_read(value, &item->verb, err)
                                       : error_set(err, ERROR_INPUT, "a report must be an object");
    status = status != 0 ? status : field_count(value, "job", &job, err);
    if (status != 0)
        return status;
    item->job = (int64_t)job;
    if (item->verb == REPORT_COMPLETE)
        item->status = wire_result_read(value, item->report.token, &item->block, &item->err);
    else
        item->status = wire_report_read(value, &item->report, &item->err);
    if (item->report.reason[0] == '\0')
        strcpy(item->report.reason, "no reason was given");
    return 0;
}

int wire_reports_read(const cJSON *value, struct wire_item **out, size_t *count,
                      struct error *err) {
    const cJSON *array = field_at(value, "reports"), *one;
    int most = cJSON_IsArray(array) ? cJSON_GetArraySize(array) : 0;
    if (most < 1 || most > WIRE_REPORTS_MOST)
        return field_fault(array, "reports", "an array of 1 to 1000", err);
    struct wire_item *items = array_create((size_t)most, sizeof *items);
    if (items == NULL)
        return error_memory(err, (size_t)most * sizeof *items, "reports");
    size_t n = 0;
    int status = 0;
    cJSON_ArrayForEach(one, array) {
        if (status == 0)
            status = item_read(one, &items[n++], err);
    }
    if (status != 0) {
        wire_items_free(items, n);
        return error_context(err, "/reports/%zu", n - 1);
    }
    *out = items;
    *count = n;
    return 0;
}

void wire_items_free(struct wire_item *items, size_t count) {
    for (size_t n = 0; items != NULL && n < count; n++)
        block_result_clear(&items[n].block);
    free(items);
}

/* --- answers --- */

static const struct {
    int code, status;
} STATUSES[] = {{0, 200},           {ERROR_INPUT, 422},  {ERROR_ABSENT, 404},
                {ERROR_STATE, 409}, {ERROR_SYSTEM, 503}, {ERROR_MEMORY, 503},
                {ERROR_LIMIT, 503}};
enum { STATUS_COUNT = sizeof STATUSES / sizeof *STATUSES };

static int status_of(int code) {
    for (size_t s = 0; s < STATUS_COUNT; s++)
        if (STATUSES[s].code == code)
            return STATUSES[s].status;
    return 500;
}

/* Any other status is an error that may pass. */
static int code_of(double status) {
    for (size_t s = 0; s < STATUS_COUNT; s++)
        if (STATUSES[s].status == status)
            return STATUSES[s].code;
    return ERROR_SYSTEM;
}

cJSON *wire_answers(const struct wire_item *items, size_t count) {
    cJSON *value = cJSON_CreateObject(), *array = cJSON_CreateArray();
    bool complete = field_put(value, "reports", array);
    for (size_t n = 0; complete && n < count; n++) {
        const struct wire_item *item = &items[n];
        cJSON *answer = list_put_object(array);
        complete = answer != NULL &&
                   field_put(answer, "job", cJSON_CreateNumber((double)item->job)) &&
                   field_put(answer, "status", cJSON_CreateNumber(status_of(item->status))) &&
                   (item->status == 0 || field_put_text(answer, "detail", item->err.text)) &&
                   (item->status != 0 || item->verb != REPORT_COMPLETE ||
                    field_put(answer, "case_done", cJSON_CreateBool(item->case_done)));
    }
    return fields_finish(value, complete);
}

int wire_answers_read(const cJSON *value, struct report *reports, size_t count, struct error *err) {
    const cJSON *array = field_at(value, "reports"), *one;
    if (!cJSON_IsArray(array) || (size_t)cJSON_GetArraySize(array) != count)
        return field_fault(array, "reports", "an array of an answer to each report", err);
    size_t n = 0;
    cJSON_ArrayForEach(one, array) {
        struct report *report = &reports[n++];
        const char *detail = cJSON_GetStringValue(field_at(one, "detail"));
        double status = field_number(one, "status");
        if (!(field_number(one, "job") == (double)report->job->id) || isnan(status))
            return field_fault(array, "reports", "answers to the reports, in their order", err);
        report->status = code_of(status);
        if (report->status != 0)
            error_set(&report->err, ERROR_SYSTEM, "%s",
                      detail != NULL ? detail : "no reason given");
        report->err.code = report->status;
    }
    return 0;
}
