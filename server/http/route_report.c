/* Many reports of a worker in one request: one change of the store. */
#include "server/http/route.h"
#include "worker/checker.h"
#include "worker/wire_report.h"
#include <stdlib.h>

struct reporting {
    struct wire_item *items;
    struct block_text *texts; /* of the results, made before the writer is asked */
    size_t count;
};

/* Each is all or nothing, and has its own status. */
static int report_change(struct store *store, void *context, struct error *err) {
    struct reporting *reporting = context;
    (void)err;
    for (size_t n = 0; n < reporting->count; n++) {
        struct wire_item *item = &reporting->items[n];
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
static void prepare(struct exchange *exchange, struct reporting *reporting) {
    for (size_t n = 0; n < reporting->count; n++) {
        struct wire_item *item = &reporting->items[n];
        if (item->verb != REPORT_COMPLETE || item->status != 0)
            continue;
        item->status =
            check_result(exchange, item->job, item->report.token, &item->block, &item->err);
        if (item->status == 0)
            item->status = block_text_create(&reporting->texts[n], &item->block, &item->err);
        if (item->status == 0)
            item->block.text = &reporting->texts[n];
    }
}

static void report_all(struct exchange *exchange, struct reporting *reporting) {
    struct error err = {0};
    reporting->texts = array_create(reporting->count, sizeof *reporting->texts);
    if (reporting->texts == NULL) {
        error_memory(&err, reporting->count * sizeof *reporting->texts, "texts of results");
        answer_error(exchange, &err);
        return;
    }
    prepare(exchange, reporting);
    if (writer_do(exchange->service->writer, report_change, reporting, &err) != 0)
        answer_error(exchange, &err);
    else
        answer_json(exchange, 200, wire_answers(reporting->items, reporting->count));
    for (size_t n = 0; n < reporting->count; n++) {
        reporting->items[n].block.text = NULL;
        block_text_clear(&reporting->texts[n]);
    }
    free(reporting->texts);
}

void handle_report_many(struct exchange *exchange, const char *id) {
    (void)id;
    struct reporting reporting = {.count = 0};
    struct error err = {0};
    cJSON *body = body_json(exchange);
    if (body == NULL)
        return;
    if (wire_reports_read(body, &reporting.items, &reporting.count, &err) != 0)
        refuse_message(exchange, &err);
    else
        report_all(exchange, &reporting);
    wire_items_free(reporting.items, reporting.count);
    cJSON_Delete(body);
}
