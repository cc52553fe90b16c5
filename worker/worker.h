/* The worker: threads that claim a job, run it, report it, until told to stop or the queue is
 * empty.
 *
 * Each thread has its own runner; one more, the dispatcher (dispatcher.h), claims, keeps leases and
 * hands results in for all of them, so that a process has one connection to its server.
 */
#ifndef RUGO_WORKER_WORKER_H
#define RUGO_WORKER_WORKER_H

#include "core/error.h"
#include "worker/worker_options.h"

/* Returns when drained or stopped: 0, or ERROR_STOPPED; or the first error that cannot be waited
 * out. */
int workers_run(const struct worker_options *options, struct error *err);

#endif
