/* The worker: threads that claim a job, run it, report it, until told to stop or the queue is
 * empty.
 *
 * Each thread has its own source and runner; one more thread sends heartbeats, so that a long
 * realisation does not lose its lease. A server or store that is away is waited for with growing,
 * jittered pauses (at most 30 s); a finished result is kept and sent again until taken or refused.
 */
#ifndef RUGO_WORKER_WORKER_H
#define RUGO_WORKER_WORKER_H

#include "core/error.h"
#include "worker/worker_options.h"

/* Returns when drained or stopped: 0, or ERROR_STOPPED; or the first error that cannot be waited
 * out. */
int workers_run(const struct worker_options *options, struct error *err);

#endif
