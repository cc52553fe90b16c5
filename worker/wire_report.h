/* Several reports of a worker in one request, as they cross the network.
 *
 *     POST /v1/jobs/report   {"reports": [{verb: "heartbeat", job, token, done},
 *                                         {verb: "complete", job, token, seconds, ...},
 *                                         {verb: "fail", job, token, reason, permanent},
 *                                         {verb: "release", job, token}]}
 *       200 {"reports": [{job, status: 200, case_done: bool}, {job, status: 409, detail}]}
 *
 * Each report has the fields of the request of its verb (wire.h), and its answer, at the same
 * place, the status that this would have. Encoders and readers are as those of wire.h. */
#ifndef RUGO_WORKER_WIRE_REPORT_H
#define RUGO_WORKER_WIRE_REPORT_H

#include "worker/report.h"
#include "worker/wire.h"

enum { WIRE_REPORTS_MOST = 1000 };

cJSON *wire_reports(const struct report *reports, size_t count);
/* Of the request for one report alone: the last part of its path, and its body (wire.h). */
const char *wire_verb(enum report_verb verb);
cJSON *wire_report_body(const struct report *report);

/* A report as it came in. */
struct wire_item {
    enum report_verb verb;
    int64_t job;
    struct wire_report report; /* with its token; reason is never "" */
    struct block_result block; /* of REPORT_COMPLETE; owned, but for the names (wire.h) */
    bool case_done;
    /* Of reading it, and then of doing it. */
    int status;
    struct error err;
};
/* Reads them all into *out, to be freed by wire_items_free before `value` is deleted. One that
 * cannot be read has the status ERROR_INPUT; without verb or job the whole is ERROR_INPUT. */
int wire_reports_read(const cJSON *value, struct wire_item **out, size_t *count, struct error *err);
void wire_items_free(struct wire_item *items, size_t count);

/* The answers, from the items' status. */
cJSON *wire_answers(const struct wire_item *items, size_t count);
/* Sets status and err of each report. ERROR_INPUT where these are no answers to these reports. */
int wire_answers_read(const cJSON *value, struct report *reports, size_t count, struct error *err);

#endif
