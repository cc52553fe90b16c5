/* Passes jobs between the worker threads of a process and the source of its jobs: one thread that
 * owns the source, and with a server the process's one connection.
 *
 * It claims jobs for all threads, as many small ones at once as fill a few seconds, and keeps those
 * not begun in a stock. It renews all leases, and hands in the ends of jobs, several at a time. It
 * waits with growing pauses for a source that is away, and keeps a result, and sends it again,
 * until it is taken or refused.
 *
 *     waiting --claim--> stock --take--> running --hand in--> ended --reported--> gone
 *                          |                |
 *                          +--------------->+-- at the end: given back */
#ifndef RUGO_WORKER_DISPATCHER_H
#define RUGO_WORKER_DISPATCHER_H

#include "worker/link/report.h"
#include "worker/link/source_options.h"
#include <stdbool.h>

/* How a process takes jobs. */

struct dispatcher_options {
    const struct source_options *source; /* borrowed, as its texts, until the end */
    unsigned threads;                    /* that take jobs */
    bool drain;                          /* nothing is offered once no job waits or runs anywhere */
    /* By clock_ms, when the process ends; 0: not known. A job of one realisation is not offered
     * that would last beyond, as jobs lasted so far, and nothing after it: its work would be lost.
     * One of several hands in those that are done. */
    int64_t until_ms;
};

struct dispatcher;
int dispatcher_create(struct dispatcher **out, const struct dispatcher_options *options,
                      struct error *err);
/* Hands in what is left, once, and ends the thread. The caller sees to it that no thread uses the
 * dispatcher any more. Accepts NULL. */
void dispatcher_destroy(struct dispatcher **dispatcher);

/* Offers nothing from here on, and releases the stock. What is handed in later is sent once. */
void dispatcher_end(struct dispatcher *dispatcher);
/* Releases the jobs that still run, so that other workers can have them at once. */
void dispatcher_give_back(struct dispatcher *dispatcher);
/* Ends likewise, with an error that a later try cannot cure; it is copied. */
void dispatcher_fail(struct dispatcher *dispatcher, const struct error *err);
/* Returns the first error that a later try cannot cure, 0 before; nothing is offered after it. */
int dispatcher_status(struct dispatcher *dispatcher, struct error *err);

/* --- for the worker threads --- */

struct lease; /* a job that the process has claimed */
enum offer {
    OFFER_JOB,
    OFFER_NOTHING, /* for now */
    OFFER_END,
};
/* Waits for a job. Unless patient, returns OFFER_NOTHING once a claim has found none. */
enum offer dispatcher_take(struct dispatcher *dispatcher, bool patient, struct lease **out);

/* For the thread that publishes: waits until cases are due in the local store. Returns false once
 * nothing more will be. dispatcher_published is due after each time. */
bool dispatcher_await_due(struct dispatcher *dispatcher);
/* postponed: some cases stay due, which cannot be published now. */
void dispatcher_published(struct dispatcher *dispatcher, bool postponed);

/* Valid until the job is handed in. */
const struct claimed_job *lease_job(const struct lease *lease);
/* Sets the number of finished realisations, and what is done of the next one, that the next
 * heartbeat reports. */
void lease_progress(struct lease *lease, double done);
/* Returns whether the result is not wanted: the lease is lost or given back, or the study
 * cancelled. */
bool lease_is_lost(const struct lease *lease);
/* Returns whether it is lost because it was given back, so that the job waits in the queue. */
bool lease_is_given_back(const struct lease *lease);

/* Hands in a job: takes the lease, which it nulls, and the result, which it empties, and sends them
 * soon. Waits while much is to be sent. */
void dispatcher_hand_in(struct dispatcher *dispatcher, struct lease **lease, struct job_end *end);

#endif
