/* One case less another over HTTP. It is made and sent as a whole: two cases are never many. */
#include "server/http/route.h"
#include "worker/comparison.h"
#include <errno.h>
#include <stdlib.h>
#include <string.h>

/* Reads a whole number of 0 or more; *end is what follows. */
static bool read_case(const char *text, uint64_t *out, const char **end) {
    char *stop;
    errno = 0;
    unsigned long long number = strtoull(text, &stop, 10);
    *out = number;
    *end = stop;
    return *text >= '0' && *text <= '9' && errno == 0 && number < INT64_MAX;
}

int query_difference(struct exchange *exchange, struct comparison *out, bool *asked) {
    const char *text = exchange_query(exchange, "difference"), *end;
    struct fault_list faults = {0};
    *asked = text != NULL;
    if (text == NULL)
        return 0;
    if (exchange_query(exchange, "case") != NULL)
        fault_add(&faults, "?case", "not together with difference");
    else if (!read_case(text, &out->minuend, &end) || *end != ',' ||
             !read_case(end + 1, &out->subtrahend, &end) || *end != '\0')
        fault_add(&faults, "?difference", "%.40s is not two cases, as 1,0", text);
    bool faulty = faults.count > 0;
    if (faulty)
        answer_problem(exchange, 422, "the query is not valid", &faults);
    fault_list_clear(&faults);
    return faulty ? ERROR_INPUT : 0;
}

int send_difference(struct exchange *exchange, const char *id, const struct comparison *comparison,
                    bool csv, struct error *err) {
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
