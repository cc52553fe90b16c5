/* Curves over HTTP. A study of ten thousand cases has gigabytes of them: as JSON they are read and
 * sent case by case. */
#include "server/accept.h"
#include "server/route.h"
#include "worker/aggregate.h"
#include "worker/log.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { CSV_CASES_MOST = 64 }; /* a table is made as a whole: its columns depend on all cases */

/* An answer on its way. */
struct curves {
    struct exchange *exchange; /* lives as long as the library calls next_part */
    char id[SEGMENT_SIZE];
    struct curve_filter filter; /* of the next case */
    int64_t first, end;         /* cases */
    char *text;                 /* owned: not yet taken; NULL where nothing waits */
    size_t sent;
};

static void curves_free(void *context) {
    struct curves *curves = context;
    free(curves->text);
    free(curves);
}

/* The document of the first case opens the whole one, those behind it add their case. */
static char *print_case(const struct curves *curves, const cJSON *document) {
    bool opens = curves->filter.case_number == curves->first;
    bool closes = curves->filter.case_number + 1 == curves->end;
    char *all = NULL, *text = json_print(opens ? document : json_at(document, "/cases/0"));
    size_t size = text ? strlen(text) - (opens ? strlen("]}") : 0) : 0;
    if (!text ||
        asprintf(&all, "%s%.*s%s", opens ? "" : ",", (int)size, text, closes ? "]}" : "") < 0)
        all = NULL;
    free(text);
    return all;
}

static int read_case(struct curves *curves, struct error *err) {
    struct service *service = curves->exchange->service;
    struct store *reader;
    cJSON *document = NULL;
    int status = service_reader(service, &reader, err);
    if (!status)
        status = aggregate_curves(reader, curves->id, &curves->filter, &document, err);
    service_give_back(service, reader);
    if (!status && !(curves->text = print_case(curves, document)))
        status = error_memory(err, 0, "curves");
    cJSON_Delete(document);
    curves->filter.case_number++;
    curves->sent = 0;
    return status;
}

static ssize_t next_part(void *context, uint64_t position, char *buffer, size_t room) {
    struct curves *curves = context;
    struct error err = {0};
    (void)position;
    exchange_renew(curves->exchange); /* who takes nothing for a whole deadline is cut */
    if (!curves->text && curves->filter.case_number == curves->end)
        return MHD_CONTENT_READER_END_OF_STREAM;
    if (!curves->text && atomic_load(&curves->exchange->service->stopping))
        return MHD_CONTENT_READER_END_WITH_ERROR;
    if (!curves->text && read_case(curves, &err)) {
        struct log_about about = {.study = curves->id};
        log_line(LEVEL_ERROR, &about, "curves: %s", err.text);
        return MHD_CONTENT_READER_END_WITH_ERROR;
    }
    size_t left = strlen(curves->text + curves->sent), part = left < room ? left : room;
    memcpy(buffer, curves->text + curves->sent, part);
    curves->sent += part;
    if (part == left) {
        free(curves->text);
        curves->text = NULL;
    }
    return (ssize_t)part;
}

/* The first case is read before the answer begins: what is wrong is mostly wrong with it. */
static int send_json(struct exchange *exchange, const char *id, const struct curve_filter *filter,
                     uint64_t cases, struct error *err) {
    struct curves *curves = array_create(1, sizeof *curves);
    if (!curves)
        return error_memory(err, sizeof *curves, "curves");
    bool one = filter->case_number >= 0;
    curves->exchange = exchange;
    curves->first = one ? filter->case_number : 0;
    curves->end = one ? curves->first + 1 : (int64_t)cases;
    curves->filter = (struct curve_filter){curves->first, filter->quantity};
    snprintf(curves->id, sizeof curves->id, "%s", id);
    int status = read_case(curves, err);
    if (status)
        curves_free(curves);
    else
        answer_stream(exchange, "application/json", MHD_SIZE_UNKNOWN, next_part, curves,
                      curves_free);
    return status;
}

static int send_csv(struct exchange *exchange, const char *id, const struct curve_filter *filter,
                    uint64_t cases, struct error *err) {
    struct store *reader;
    cJSON *document = NULL;
    char *csv = NULL;
    if (filter->case_number < 0 && cases > CSV_CASES_MOST)
        return error_set(err, ERROR_INPUT,
                         "%llu cases are too many for one table; ask for each with ?case=",
                         (unsigned long long)cases);
    int status = service_reader(exchange->service, &reader, err);
    if (!status)
        status = aggregate_curves(reader, id, filter, &document, err);
    service_give_back(exchange->service, reader);
    if (!status)
        status = aggregate_csv(document, &csv, err);
    cJSON_Delete(document);
    if (!status)
        answer_text(exchange, 200, "text/csv; charset=utf-8", csv);
    return status;
}

static bool wants_csv(const struct exchange *exchange) {
    const char *accept = exchange_header(exchange, "Accept");
    return accept_quality(accept, "text/csv") > accept_quality(accept, "application/json");
}

static bool matches(const struct exchange *exchange, const char *etag) {
    const char *known = exchange_header(exchange, "If-None-Match");
    return known && (strcmp(known, "*") == 0 || strstr(known, etag));
}

static int find_study(struct exchange *exchange, const char *id, struct study_status *out,
                      struct error *err) {
    struct store *reader;
    int status = service_reader(exchange->service, &reader, err);
    if (!status)
        status = store_status(reader, id, out, err);
    service_give_back(exchange->service, reader);
    return status;
}

void handle_curves(struct exchange *exchange, const char *id) {
    struct error err = {0};
    struct study_status study = {0};
    struct curve_filter filter = {.case_number = -1,
                                  .quantity = exchange_query(exchange, "quantity")};
    char etag[80] = "";
    if (!query_number(exchange, "case", 0, INT64_MAX - 1, &filter.case_number))
        return;
    bool csv = wants_csv(exchange);
    int status = find_study(exchange, id, &study, &err);
    /* Every change of a study's results raises its revision: that, and the form, is the answer's
     * identity. */
    snprintf(etag, sizeof etag, "\"%s-%llu-%s\"", id, (unsigned long long)study.revision,
             csv ? "csv" : "json");
    if (!status && matches(exchange, etag))
        answer_empty(exchange, 304);
    else if (!status)
        status = (csv ? send_csv : send_json)(exchange, id, &filter, study.cases, &err);
    study_status_clear(&study);
    if (status) {
        answer_error(exchange, &err);
        return;
    }
    answer_header(exchange, "ETag", etag);
    answer_header(exchange, "Vary", "Accept");
}
