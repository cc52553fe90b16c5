/* What crosses the network between worker and server, the message by the first byte: what is taken
 * is sent again, taken again, and the same text. */
#include "schema/json/json.h"
#include "tests/support/fuzz/fuzz.h"
#include "worker/link/wire.h"

enum { JOBS = 4 };

/* The message that the document holds, as this end would send it; NULL where it is refused. */
static cJSON *claim_again(cJSON *document) {
    struct wire_claim claim = {0};
    return wire_claim_read(document, &claim, &(struct error){0}) == 0 ? wire_claim(&claim.claim)
                                                                      : NULL;
}

static char *jobs_again(cJSON *document) {
    struct claimed_job jobs[JOBS] = {0};
    size_t count = 0;
    char *text = NULL;
    if (wire_jobs_read(document, jobs, JOBS, &count, &(struct error){0}) == 0) {
        MUST(count <= JOBS);
        cJSON *again = wire_jobs(jobs, count);
        text = json_print(again);
        MUST(text != NULL);
        cJSON_Delete(again);
    }
    for (size_t n = 0; n < count; n++)
        claimed_job_clear(&jobs[n]);
    return text;
}

static cJSON *result_again(cJSON *document) {
    struct block_result result = {0};
    char token[TOKEN_SIZE] = "";
    cJSON *again = NULL;
    if (wire_result_read(document, token, &result, &(struct error){0}) == 0) {
        MUST(result.count > 0);
        again = wire_result(token, &result);
        MUST(again != NULL);
    }
    block_result_clear(&result);
    return again;
}

static cJSON *report_again(cJSON *document) {
    struct wire_report report = {0};
    if (wire_report_read(document, &report, &(struct error){0}) != 0)
        return NULL;
    MUST(memchr(report.reason, 0, sizeof report.reason) != NULL);
    return wire_fail(report.token, report.reason, report.permanent);
}

/* NULL where the text is refused. The caller frees. */
static char *again(uint8_t message, const char *text) {
    static cJSON *(*const WAYS[])(cJSON *) = {claim_again, result_again, report_again};
    cJSON *document = NULL;
    char *printed = NULL;
    if (json_parse(text, strlen(text), NULL, &document, &(struct error){0}) != 0)
        return NULL;
    if (message % 4 == 3)
        printed = jobs_again(document);
    else {
        cJSON *sent = WAYS[message % 4](document);
        printed = sent != NULL ? json_print(sent) : NULL;
        MUST(sent == NULL || printed != NULL);
        cJSON_Delete(sent);
    }
    cJSON_Delete(document);
    return printed;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    if (size == 0)
        return 0;
    char *text = text_of(data + 1, size - 1), *once = again(*data, text);
    if (once != NULL) {
        char *twice = again(*data, once);
        MUST(twice != NULL && strcmp(once, twice) == 0);
        free(twice);
    }
    free(once);
    free(text);
    return 0;
}
