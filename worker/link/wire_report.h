/* Several reports of a worker in one request, as they cross the network.
 *
 *     POST /v1/jobs/report   {"reports": [{verb: "heartbeat", job, token, done, part},
 *                                         {verb: "complete", job, token, seconds, ...},
 *                                         {verb: "fail", job, token, reason, permanent},
 *                                         {verb: "release", job, token}]}
 *       200 {"reports": [{job, status: 200, case_done: bool}, {job, status: 409, detail}]}
 *
 * Each report has the fields of the request of its verb (wire.h). Its answer, at the same index,
 * has the status that this request would have. Encoders and readers are as those of wire.h. */
#ifndef RUGO_WORKER_LINK_WIRE_REPORT_H
#define RUGO_WORKER_LINK_WIRE_REPORT_H

#include "worker/link/report.h"
#include "worker/link/wire.h"

enum { WIRE_REPORTS_MOST = 1000 };

cJSON *wire_reports(const struct report *reports, size_t count);
/* Return what a request for one report alone has: the last part of its path, and its body
 * (wire.h). */
const char *wire_verb(enum report_verb verb);
cJSON *wire_report_body(const struct report *report);

/* A report as it was received. */
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
/* Reads all into *out, to be freed by wire_items_free before `value` is deleted. One that cannot be
 * read has the status ERROR_INPUT; if it lacks verb or job the whole is ERROR_INPUT. */
int wire_reports_read(const cJSON *value, struct wire_item **out, size_t *count, struct error *err);
void wire_items_free(struct wire_item *items, size_t count);

/* Makes the answers, from the items' status. */
cJSON *wire_answers(const struct wire_item *items, size_t count);
/* Sets status and err of each report. ERROR_INPUT where the answers do not fit the reports. */
int wire_answers_read(const cJSON *value, struct report *reports, size_t count, struct error *err);

#endif
