/* Curves and reports over HTTP. A study of ten thousand cases has gigabytes of them: as JSON they
 * are read and sent case by case, and end early when the server does. */
#include "core/file/memory_file.h"
#include "schema/program.h"
#include "schema/result/bytes/bytes.h"
#include "schema/result/csv.h"
#include "schema/result/result_json.h"
#include "server/http/accept.h"
#include "server/http/compress.h"
#include "server/http/route/route.h"
#include "server/show/plot/plot_cost.h"
#include "worker/log.h"
#include "worker/publish/aggregate.h"
#include "worker/publish/comparison.h"
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { CSV_CASES_MOST = 64 }; /* a table is made as a whole: its columns depend on all cases */

/* An answer is sent from this, part by part. */
struct stream {
    struct exchange *exchange; /* lives as long as the library calls next_part */
    struct aggregate study;    /* owned */
    bool report;               /* rather than curves */
    char *quantity;            /* owned; NULL: all */
    uint64_t next, end;        /* cases */
    bool follows;              /* the next case stands behind another one */
    bool answered;             /* a case was read that has results, or has not begun */
    struct error missing;      /* of the first case read that has an error; code 0: none yet */
    char *text;                /* owned: not yet taken; NULL where nothing waits */
    size_t sent;
};

static void stream_free(void *context) {
    struct stream *stream = context;
    aggregate_end(&stream->study);
    free(stream->quantity);
    free(stream->text);
    free(stream);
}

/* What print writes to a file, as text behind what waits already; NULL there when out of memory. */
struct printing {
    struct stream *stream;
    struct memory_file memory;
    bool begun;
};
static bool printing_begin(struct printing *printing, struct stream *stream) {
    printing->stream = stream;
    printing->begun = memory_file_open(&printing->memory);
    if (printing->begun && stream->text != NULL)
        fputs(stream->text, printing->memory.file);
    return printing->begun;
}

static int printing_end(struct printing *printing, bool done, struct error *err) {
    struct stream *stream = printing->stream;
    char *text = printing->begun ? memory_file_close(&printing->memory, NULL) : NULL;
    free(stream->text);
    stream->text = NULL;
    stream->sent = 0;
    if (done && text != NULL) {
        stream->text = text;
        return 0;
    }
    free(text);
    return error_set(err, ERROR_MEMORY, "no memory left for an answer");
}

static int print_head(struct stream *stream, struct store *reader, struct error *err) {
    struct study_result head = {0};
    const struct work_time *time = stream->report ? &stream->study.about.time : NULL;
    struct printing printing;
    int status = aggregate_head(reader, &stream->study, &head, err);
    if (status == 0) {
        bool done = printing_begin(&printing, stream) &&
                    study_print_head(printing.memory.file, &head, time);
        status = printing_end(&printing, done, err);
    }
    study_result_clear(&head);
    return status;
}

/* The next case behind what waits, with the end of the document behind the last one. */
static int append_case(struct stream *stream, const struct case_result *result,
                       const struct case_report *report, struct error *err) {
    struct printing printing;
    bool done = printing_begin(&printing, stream);
    if (done && stream->follows)
        fputc(',', printing.memory.file);
    if (done)
        done = stream->report ? case_report_print(printing.memory.file, report)
                              : result_print(printing.memory.file, result);
    if (done && stream->next + 1 == stream->end)
        fputs("]}", printing.memory.file);
    stream->next++;
    stream->follows = true;
    return printing_end(&printing, done, err);
}

static int read_case(struct stream *stream, struct error *err) {
    struct service *service = stream->exchange->service;
    const struct result_filter filter = {.part = {.quantity = stream->quantity}, .complete = true};
    struct store *reader;
    struct case_result result = {0};
    struct case_report report = {0};
    int status = exchange_reader(stream->exchange, &reader, err);
    if (status == 0)
        status = stream->report
                     ? aggregate_case_report(reader, &stream->study, stream->next, &report, err)
                     : aggregate_case(reader, &stream->study, stream->next, &filter, &result, err);
    service_give_back(service, reader);
    if (status == 0) {
        const struct case_result *about = stream->report ? &report.about : &result;
        if (about->error == NULL)
            stream->answered = true;
        else if (stream->missing.code == 0)
            aggregate_refuse(about, &stream->missing);
        status = append_case(stream, &result, &report, err);
        if (about->error != NULL)
            answer_mend(stream->text);
    }
    result_clear(&result);
    case_report_clear(&report);
    return status;
}

static ssize_t next_part(void *context, uint64_t position, char *buffer, size_t room) {
    struct stream *stream = context;
    struct error err = {0};
    (void)position;
    exchange_renew(stream->exchange); /* who takes nothing for a whole deadline is cut */
    if (stream->text == NULL && stream->next == stream->end)
        return MHD_CONTENT_READER_END_OF_STREAM;
    if (stream->text == NULL && atomic_load(&stream->exchange->service->stopping))
        return MHD_CONTENT_READER_END_WITH_ERROR;
    if (stream->text == NULL && read_case(stream, &err) != 0) {
        struct log_about about = {.study = stream->study.about.id};
        if (err.code != ERROR_STOPPED)
            log_line(LEVEL_ERROR, &about, "%s: %s", stream->report ? "report" : "curves", err.text);
        return MHD_CONTENT_READER_END_WITH_ERROR;
    }
    size_t left = strlen(stream->text + stream->sent), part = left < room ? left : room;
    memcpy(buffer, stream->text + stream->sent, part);
    stream->sent += part;
    if (part == left) {
        free(stream->text);
        stream->text = NULL;
    }
    return (ssize_t)part;
}

/* Cases are read up to the first one that has no error before the answer begins: what is wrong is
 * mostly wrong with the first one, and an answer in which each case has an error is none. */
static int open_stream(struct stream *stream, const char *id, const struct result_filter *filter,
                       struct error *err) {
    struct service *service = stream->exchange->service;
    const char *quantity = filter->part.quantity;
    struct store *reader;
    int status = exchange_reader(stream->exchange, &reader, err);
    if (status == 0)
        status = aggregate_begin(reader, id, &stream->study, err);
    if (status == 0)
        status = print_head(stream, reader, err);
    service_give_back(service, reader);
    if (status != 0)
        return status;
    bool one = filter->case_number >= 0;
    stream->next = one ? (uint64_t)filter->case_number : 0;
    stream->end = one ? stream->next + 1 : stream->study.about.cases;
    stream->quantity = quantity != NULL ? strdup(quantity) : NULL;
    if (quantity != NULL && stream->quantity == NULL)
        return error_memory(err, strlen(quantity), "an answer");
    do {
        if (status == 0)
            status = read_case(stream, err);
    } while (status == 0 && !stream->answered && stream->next < stream->end);
    if (status == 0 && !stream->answered)
        status = error_set(err, ERROR_INPUT, "%s", stream->missing.text);
    return status;
}

static int send_json(struct exchange *exchange, const char *id, const struct result_filter *filter,
                     bool report, struct error *err) {
    struct stream *stream = array_create(1, sizeof *stream);
    if (stream == NULL)
        return error_memory(err, sizeof *stream, "an answer");
    stream->exchange = exchange;
    stream->report = report;
    int status = open_stream(stream, id, filter, err);
    bool is_short =
        status == 0 && stream->next == stream->end && strlen(stream->text) < COMPRESS_LEAST;
    if (status != 0)
        stream_free(stream);
    else if (is_short)
        answer_stream(exchange, "application/json", MHD_SIZE_UNKNOWN, next_part, stream,
                      stream_free);
    else
        answer_document_stream(exchange, "application/json", next_part, stream, stream_free);
    return status;
}

/* A table has no field for errors: a header lists the cases that have one. */
static void list_missing(struct exchange *exchange, const struct study_result *study) {
    char text[CSV_CASES_MOST * 6] = "";
    size_t used = 0;
    for (size_t c = 0; c < study->case_count && used < sizeof text; c++)
        if (study->cases[c].error != NULL)
            used +=
                (size_t)snprintf(text + used, sizeof text - used, "%s%llu", used > 0 ? ", " : "",
                                 (unsigned long long)study->cases[c].case_number);
    if (used > 0)
        answer_header(exchange, "Rugo-Missing-Cases", text);
}

/* Answers with curves as a whole, or fails without an answer. */
static int answer_study(struct exchange *exchange, const struct study_result *study, bool csv,
                        struct error *err) {
    struct memory_file file;
    char *text = NULL;
    bool printed = false;
    if (memory_file_open(&file)) {
        printed = csv ? csv_print(file.file, study) : study_print(file.file, study);
        text = memory_file_close(&file, NULL);
    }
    if (!printed || text == NULL) {
        free(text);
        return error_memory(err, 0, "a table of curves");
    }
    answer_text(exchange, 200, csv ? "text/csv; charset=utf-8" : "application/json", text);
    list_missing(exchange, study);
    return 0;
}

static int send_csv(struct exchange *exchange, const char *id, const struct result_filter *filter,
                    uint64_t cases, struct error *err) {
    struct store *reader;
    struct study_result study = {0};
    if (filter->case_number < 0 && cases > CSV_CASES_MOST)
        return error_set(err, ERROR_INPUT,
                         "%llu cases are too many for one table; ask for each with ?case=",
                         (unsigned long long)cases);
    int status = exchange_reader(exchange, &reader, err);
    if (status == 0)
        status = aggregate_study(reader, id, filter, &study, err);
    service_give_back(exchange->service, reader);
    if (status == 0)
        status = answer_study(exchange, &study, true, err);
    study_result_clear(&study);
    return status;
}

static bool wants_csv(const struct exchange *exchange) {
    const char *accept = exchange_header(exchange, "Accept");
    return accept_quality(accept, "text/csv") > accept_quality(accept, "application/json");
}

/* Every change of a study's results raises its revision: that, what of them is asked for, the form,
 * and the program that writes it, is the answer's identity. So the tag of an answer is that of no
 * query that has none. */
enum { TAG_SIZE = 96 };
static void make_tag(const struct exchange *exchange, const char *id, uint64_t revision, bool csv,
                     char tag[TAG_SIZE]) {
    static const char *const NAMES[] = {"case", "quantity", "difference"};
    char program[PROGRAM_SIZE];
    program_write(program);
    uint64_t asked = hash_bytes(HASH_START, strlen(program) + 1, program);
    for (size_t n = 0; n < sizeof NAMES / sizeof *NAMES; n++) {
        const char *value = exchange_query(exchange, NAMES[n]);
        if (value == NULL)
            continue;
        asked = hash_bytes(asked, strlen(NAMES[n]) + 1, NAMES[n]);
        asked = hash_bytes(asked, strlen(value) + 1, value);
    }
    snprintf(tag, TAG_SIZE, "\"%s-%llu-%016llx-%s%s\"", id, (unsigned long long)revision,
             (unsigned long long)asked, csv ? "csv" : "json",
             answer_is_compressed(exchange) ? "-gzip" : "");
}

/* What the request knows of the answer by If-None-Match: "*" is any that there is. */
static bool knows(const struct exchange *exchange, const char *tag) {
    const char *known = exchange_header(exchange, "If-None-Match");
    return known != NULL && strstr(known, tag) != NULL;
}

static bool knows_any(const struct exchange *exchange) {
    const char *known = exchange_header(exchange, "If-None-Match");
    return known != NULL && strcmp(known, "*") == 0;
}

/* One case less another over HTTP. It is made and sent as a whole: two cases are never many. */

/* Reads a whole number of 0 or more; *end is what follows. */
static bool read_case_number(const char *text, uint64_t *out, const char **end) {
    char *stop;
    errno = 0;
    unsigned long long number = strtoull(text, &stop, 10);
    *out = number;
    *end = stop;
    return *text >= '0' && *text <= '9' && errno == 0 && number < INT64_MAX;
}

int query_difference(struct exchange *exchange, struct comparison *out, bool *asked) {
    const char *text = exchange_query(exchange, "difference"), *end;
    *asked = text != NULL;
    if (text == NULL)
        return 0;
    if (exchange_query(exchange, "case") != NULL)
        query_refuse(exchange, "case", "not together with difference");
    else if (!read_case_number(text, &out->minuend, &end) || *end != ',' ||
             !read_case_number(end + 1, &out->subtrahend, &end) || *end != '\0')
        query_refuse(exchange, "difference", "%.40s is not two cases, as 1,0", text);
    else
        return 0;
    return ERROR_INPUT;
}

/* Likewise with a difference. */
static int send_difference(struct exchange *exchange, const char *id,
                           const struct comparison *comparison, bool csv, struct error *err) {
    struct store *reader;
    struct study_result study = {0};
    int status = exchange_reader(exchange, &reader, err);
    if (status == 0)
        status = comparison_make(reader, id, comparison, &study, err);
    service_give_back(exchange->service, reader);
    if (status == 0)
        status = answer_study(exchange, &study, csv, err);
    study_result_clear(&study);
    return status;
}

static int find_study(struct exchange *exchange, const char *id, struct study_status *out,
                      struct error *err) {
    struct store *reader;
    int status = exchange_reader(exchange, &reader, err);
    if (status == 0)
        status = store_status(reader, id, out, err);
    service_give_back(exchange->service, reader);
    return status;
}

void handle_curves(struct exchange *exchange, const char *id) {
    struct error err = {0};
    struct study_status study = {0};
    struct result_filter filter = {.case_number = -1,
                                   .part = {.quantity = exchange_query(exchange, "quantity")},
                                   .complete = true};
    struct comparison comparison = {.quantity = filter.part.quantity};
    char tag[TAG_SIZE];
    bool difference;
    if (query_difference(exchange, &comparison, &difference) != 0)
        return;
    if (!query_number(exchange, "case", 0, INT64_MAX - 1, &filter.case_number))
        return;
    bool csv = wants_csv(exchange);
    int status = find_study(exchange, id, &study, &err);
    make_tag(exchange, id, study.revision, csv, tag);
    if (status == 0 && knows(exchange, tag))
        answer_unchanged(exchange);
    else if (status == 0 && difference)
        status = send_difference(exchange, id, &comparison, csv, &err);
    else if (status == 0)
        status = csv ? send_csv(exchange, id, &filter, study.cases, &err)
                     : send_json(exchange, id, &filter, false, &err);
    study_status_clear(&study);
    if (status != 0) {
        answer_error(exchange, &err);
        return;
    }
    if (knows_any(exchange)) /* whether there is an answer is known by now (RFC 9110, 13.2.1) */
        answer_unchanged(exchange);
    answer_header(exchange, "ETag", tag);
    answer_header(exchange, "Vary", "Accept");
}

static int send_picture(struct exchange *exchange, const char *id, struct error *err) {
    struct store *reader;
    struct study_report report = {0};
    struct memory_file picture;
    char *text = NULL;
    int status = exchange_reader(exchange, &reader, err);
    if (status == 0)
        status = aggregate_report(reader, id, &report, err);
    service_give_back(exchange->service, reader);
    if (status == 0 && memory_file_open(&picture)) {
        status = plot_cost(&report, picture.file, err);
        text = memory_file_close(&picture, NULL);
    }
    if (status == 0 && text == NULL)
        status = error_memory(err, 0, "a picture");
    if (status == 0)
        answer_text(exchange, 200, "image/svg+xml", text);
    else
        free(text);
    study_report_clear(&report);
    return status;
}

void handle_report(struct exchange *exchange, const char *id) {
    struct error err = {0};
    struct result_filter all = {.case_number = -1};
    const char *accept = exchange_header(exchange, "Accept");
    bool drawn =
        accept_quality(accept, "image/svg+xml") > accept_quality(accept, "application/json");
    int status =
        drawn ? send_picture(exchange, id, &err) : send_json(exchange, id, &all, true, &err);
    if (status != 0) {
        answer_error(exchange, &err);
        return;
    }
    answer_header(exchange, "Vary", "Accept");
}
