/* Jobs and results as they cross the network between worker and server. One encoder and one decoder
 * serve both ends, so that they cannot disagree.
 *
 *     POST /v1/jobs/claim            {worker, host, program, kinds: […], forms: {kind: number, …},
 *                                     count, seconds, threads, sequence: true}
 *       200 {"jobs": [{id, study, kind, case, seed: "decimal", sequence, first, count,
 *                      attempt, token, lease_seconds, parameters: {…}}]},
 *       or 204 when there is none
 *     POST /v1/jobs/{id}/heartbeat   {token, done, part}                200 {}
 *     POST /v1/jobs/{id}/complete    {token, seconds, cpu_seconds, first, count,
 *                                     scalars: {names: […], rows: [[…]]}, data: base64}
 *                                                                       200 {"case_done": bool}
 *     POST /v1/jobs/{id}/fail        {token, reason, permanent}         200 {}
 *     POST /v1/jobs/{id}/release     {token}                            200 {}
 *
 * Numbers read back as the same doubles; NaN crosses as null. Unknown fields are ignored, so that a
 * newer end can work with an older one: a heartbeat has whole realisations and the part of one
 * apart, of which older servers take the former. A claim without "sequence" is from a worker that
 * draws by the number of the case, and a job without it is of a study that wants that. A claim
 * whose "forms" lack a kind is from a worker that does not say in which form it makes results of it
 * (format_version of kind.h). Encoders return NULL when out of memory. Readers return ERROR_INPUT
 * with the field at fault and leave *out untouched. */
#ifndef RUGO_WORKER_LINK_WIRE_H
#define RUGO_WORKER_LINK_WIRE_H

#include "jobs/kind.h"
#include "schema/store/store.h"
#include <stdbool.h>

/* Names of workers and their hosts, which lists and logs show. */

/* Returns whether a UTF-8 text has no control characters, which a terminal would obey. */
bool worker_name_is_plain(const char *name);

enum {
    WIRE_JOBS_MOST = 100,
    WIRE_KINDS_MOST = 32,
    WIRE_REASON_MOST = 2000,
    WIRE_FORMS_SIZE = 200, /* of a list of kinds */
};

/* --- claim --- */
/* Forms are those of this program; study does not cross. */
cJSON *wire_claim(const struct claim *claim);
struct wire_claim {
    struct claim claim;                     /* borrows its strings from the document read */
    const char *kinds[WIRE_KINDS_MOST + 1]; /* where claim.kinds points: do not copy the struct */
    /* Kinds whose results this program reads in another form than the worker makes, with commas
     * between; "" for none. claim.kinds does not have them. */
    char other_forms[WIRE_FORMS_SIZE];
};
/* Without kinds any is meant; without count one, and never more than WIRE_JOBS_MOST. */
int wire_claim_read(const cJSON *value, struct wire_claim *out, struct error *err);

/* --- jobs --- */
/* Refers to the jobs' parameters: print and delete it before they are cleared. */
cJSON *wire_jobs(const struct claimed_job *jobs, size_t count);
/* Fills at most `most` jobs; more are ERROR_INPUT. The caller clears each of the *count by
 * claimed_job_clear. Their parameters are taken out of value, also on failure. */
int wire_jobs_read(cJSON *value, struct claimed_job *jobs, size_t most, size_t *count,
                   struct error *err);

/* --- results --- */
cJSON *wire_result(const char *token, const struct block_result *result);
/* The names are texts of `value`, which must outlive them; block_result_clear frees the rest. On
 * failure token may have been written. */
int wire_result_read(const cJSON *value, char token[TOKEN_SIZE], struct block_result *out,
                     struct error *err);

/* --- heartbeat, fail, release --- */
struct wire_report {
    char token[TOKEN_SIZE];
    double done;                       /* heartbeat: whole ones, and the part of the next */
    char reason[WIRE_REASON_MOST + 1]; /* fail; a longer one is cut, "" if absent */
    bool permanent;                    /* fail; false if absent */
};
cJSON *wire_heartbeat(const char *token, double done);
cJSON *wire_fail(const char *token, const char *reason, bool permanent);
cJSON *wire_release(const char *token);
int wire_report_read(const cJSON *value, struct wire_report *out, struct error *err);

#endif
