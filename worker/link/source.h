/* The source of a worker's jobs: a local store or a server, behind the same functions. One thread
 * at a time may use a source. */
#ifndef RUGO_WORKER_LINK_SOURCE_H
#define RUGO_WORKER_LINK_SOURCE_H

#include "jobs/kind.h"
#include "schema/store/store.h"
#include "worker/link/report.h"
#include "worker/link/source_options.h"

struct source;

int source_create(struct source **out, const struct source_options *options, struct error *err);
void source_destroy(struct source **source);

/* Claims jobs. Failures have the codes of store.h; ERROR_SYSTEM when there is no answer or the
 * store is busy, so that a later try may succeed. *due becomes true where cases of the local store
 * are to be published, and is left alone otherwise. */
int source_claim(struct source *source, const struct wish *wish, struct claimed_job *jobs,
                 size_t *count, bool *due, struct error *err);
/* Sends reports, each of which then has a status of its own: ERROR_STATE when its lease is lost or
 * the study cancelled. A returned failure is that of the request as a whole. */
int source_report(struct source *source, struct report *reports, size_t count, bool *due,
                  struct error *err);
/* Returns the kinds whose jobs the source keeps from this program, whose results of them have
 * another form, as of the last claim, with commas between; "" for none. The source owns it. */
const char *source_other_forms(const struct source *source);
/* Sets *left to whether a job waits or runs anywhere, so that one may still have to be claimed. Of
 * a server, only studies that this token may list count, and of which this program may have jobs;
 * *left is 0 when it may list none. */
int source_left(struct source *source, int *left, bool *due, struct error *err);

#endif
