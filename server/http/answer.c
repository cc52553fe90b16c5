/* Answers of the routes: documents, texts, problems. */
#include "core/file/plain_text.h"
#include "core/rugo.h"
#include "schema/json/field.h"
#include "server/http/compress.h"
#include "server/http/exchange.h"
#include "worker/link/header_names.h"
#include "worker/log.h"
#include <stdlib.h>
#include <string.h>

void answer_header(struct exchange *exchange, const char *name, const char *value) {
    if (exchange->response != NULL)
        MHD_add_response_header(exchange->response, name, value);
}

static void finish(struct exchange *exchange, unsigned status, const char *type,
                   struct MHD_Response *response) {
    exchange->status = status;
    exchange->response = response;
    if (type != NULL)
        answer_header(exchange, "Content-Type", type);
    answer_header(exchange, VERSION_HEADER, RUGO_VERSION);
    answer_header(exchange, "X-Content-Type-Options", "nosniff");
    answer_header(exchange, "Referrer-Policy", "no-referrer");
    answer_header(
        exchange, "Content-Security-Policy",
        "default-src 'none'; script-src 'self'; style-src 'self'; connect-src 'self'; "
        "img-src 'self' data:; base-uri 'none'; form-action 'none'; frame-ancestors 'none'");
}

bool answer_is_compressed(const struct exchange *exchange) {
    return compress_is_accepted(exchange_header(exchange, "Accept-Encoding"));
}

/* Says that an answer is in gzip, or might be in another request. */
static void tell_coding(struct exchange *exchange, bool compressed) {
    if (compressed)
        answer_header(exchange, "Content-Encoding", "gzip");
    answer_header(exchange, "Vary", "Accept-Encoding");
}

/* Answers with the text in gzip; false where the peer does not take it, or for want of memory. */
static bool answer_compressed(struct exchange *exchange, unsigned status, const char *type,
                              const char *text, size_t size) {
    size_t compressed;
    char *bytes = answer_is_compressed(exchange) ? compress_text(text, size, &compressed) : NULL;
    if (bytes == NULL)
        return false;
    finish(exchange, status, type,
           MHD_create_response_from_buffer(compressed, bytes, MHD_RESPMEM_MUST_FREE));
    if (exchange->response == NULL)
        free(bytes);
    tell_coding(exchange, true);
    return true;
}

void answer_bytes(struct exchange *exchange, const char *type, char *bytes, size_t size) {
    finish(exchange, 200, type,
           MHD_create_response_from_buffer(size, bytes, MHD_RESPMEM_MUST_FREE));
    if (exchange->response == NULL)
        free(bytes);
}

void answer_text(struct exchange *exchange, unsigned status, const char *type, char *text) {
    if (text == NULL) {
        exchange->status = 500; /* no response: the connection is closed */
        return;
    }
    size_t size = strlen(text);
    if (size >= COMPRESS_LEAST && answer_compressed(exchange, status, type, text, size)) {
        free(text);
        return;
    }
    finish(exchange, status, type,
           MHD_create_response_from_buffer(size, text, MHD_RESPMEM_MUST_FREE));
    if (size >= COMPRESS_LEAST)
        tell_coding(exchange, false);
}

void answer_mend(char *text) {
    for (size_t length; text != NULL && *text != '\0'; text += length != 0 ? length : 1)
        if ((length = text_character(text)) == 0)
            *text = '?';
}

static void answer_document(struct exchange *exchange, unsigned status, const char *type,
                            cJSON *document) {
    char *text = document != NULL ? json_print(document) : NULL;
    cJSON_Delete(document);
    answer_mend(text);
    answer_text(exchange, status, type, text);
}

void answer_json(struct exchange *exchange, unsigned status, cJSON *document) {
    answer_document(exchange, status, "application/json", document);
}

void answer_static(struct exchange *exchange, const char *type, const char *data, size_t size) {
    if (size >= COMPRESS_LEAST && answer_compressed(exchange, 200, type, data, size))
        return;
    finish(exchange, 200, type,
           MHD_create_response_from_buffer(size, (void *)data, MHD_RESPMEM_PERSISTENT));
    if (size >= COMPRESS_LEAST)
        tell_coding(exchange, false);
}

static ssize_t end_at_once(void *context, uint64_t position, char *buffer, size_t room) {
    (void)context;
    (void)position;
    (void)buffer;
    (void)room;
    return MHD_CONTENT_READER_END_OF_STREAM;
}

/* Headers alone, without a length that is not known. Of chunks the library would send the end, and
 * so it is asked to send none. */
static void answer_head(struct exchange *exchange, unsigned status, const char *type) {
    enum { PART = 1024 };
    struct MHD_Response *response =
        MHD_create_response_from_callback(MHD_SIZE_UNKNOWN, PART, end_at_once, NULL, NULL);
    if (response != NULL)
        MHD_set_response_options(response, MHD_RF_HTTP_VERSION_1_0_ONLY, MHD_RO_END);
    finish(exchange, status, type, response);
}

void answer_unchanged(struct exchange *exchange) {
    if (exchange->response != NULL)
        MHD_destroy_response(exchange->response);
    answer_head(exchange, 304, NULL);
    tell_coding(exchange, false);
}

void answer_stream(struct exchange *exchange, const char *type, uint64_t size,
                   MHD_ContentReaderCallback read, void *context,
                   MHD_ContentReaderFreeCallback free_context) {
    enum { PART = 32768 };
    if (size == MHD_SIZE_UNKNOWN && strcmp(exchange->method, "HEAD") == 0) {
        free_context(context);
        answer_head(exchange, 200, type);
        return;
    }
    finish(exchange, 200, type,
           MHD_create_response_from_callback(size, PART, read, context, free_context));
    if (exchange->response == NULL)
        free_context(context);
}

void answer_document_stream(struct exchange *exchange, const char *type,
                            MHD_ContentReaderCallback read, void *context,
                            MHD_ContentReaderFreeCallback free_context) {
    struct compressor *compressor =
        answer_is_compressed(exchange) ? compressor_create(read, context, free_context) : NULL;
    if (compressor != NULL)
        answer_stream(exchange, type, MHD_SIZE_UNKNOWN, compressor_read, compressor,
                      compressor_free);
    else
        answer_stream(exchange, type, MHD_SIZE_UNKNOWN, read, context, free_context);
    tell_coding(exchange, compressor != NULL);
}

void answer_empty(struct exchange *exchange, unsigned status) {
    finish(exchange, status, NULL,
           MHD_create_response_from_buffer(0, NULL, MHD_RESPMEM_PERSISTENT));
}

static const char *problem_title(unsigned status) {
    switch (status) {
    case 400:
        return "Malformed request";
    case 401:
        return "A token is needed";
    case 403:
        return "Not allowed";
    case 404:
        return "Not found";
    case 405:
        return "Method not allowed";
    case 409:
        return "Conflict";
    case 413:
        return "Body too large";
    case 415:
        return "Unsupported media type";
    case 422:
        return "Invalid content";
    case 503:
        return "Not available now";
    default:
        return "Server error";
    }
}

static bool put_faults(cJSON *problem, const struct fault_list *faults) {
    cJSON *errors = cJSON_AddArrayToObject(problem, "errors");
    size_t kept = faults->count < FAULTS_KEPT ? faults->count : FAULTS_KEPT;
    bool complete = errors != NULL;
    for (size_t i = 0; complete && faults->faults != NULL && i < kept; i++) {
        const struct fault *fault = &faults->faults[i];
        cJSON *entry = list_put_object(errors);
        complete = entry != NULL &&
                   field_put_text(entry, "pointer", fault->pointer != NULL ? fault->pointer : "") &&
                   field_put_text(entry, "detail", fault->detail != NULL ? fault->detail : "");
    }
    return complete;
}

void answer_problem(struct exchange *exchange, unsigned status, const char *detail,
                    const struct fault_list *faults) {
    cJSON *problem = cJSON_CreateObject();
    bool complete = problem != NULL && field_put_text(problem, "type", "about:blank") &&
                    field_put_text(problem, "title", problem_title(status)) &&
                    cJSON_AddNumberToObject(problem, "status", status) != NULL &&
                    field_put_text(problem, "detail", detail) &&
                    (faults == NULL || faults->count == 0 || put_faults(problem, faults));
    if (!complete) {
        cJSON_Delete(problem);
        problem = NULL;
    }
    answer_document(exchange, status, "application/problem+json", problem);
    if (status == 401)
        answer_header(exchange, "WWW-Authenticate", "Bearer");
}

void answer_error(struct exchange *exchange, const struct error *err) {
    unsigned status = 500;
    if (err->code == ERROR_INPUT)
        status = 422;
    else if (err->code == ERROR_ABSENT)
        status = 404;
    else if (err->code == ERROR_STATE)
        status = 409;
    else if (err->code == ERROR_SYSTEM || err->code == ERROR_MEMORY || err->code == ERROR_STOPPED ||
             err->code == ERROR_LIMIT)
        status = 503;
    if (status >= 500 &&
        err->code != ERROR_STOPPED) { /* the server's trouble: whoever runs it must see why */
        struct log_about about = {.request = exchange->path, .status = (long)status};
        log_line(LEVEL_ERROR, &about, "%s", err->text);
    }
    answer_problem(exchange, status, err->text, NULL);
}
