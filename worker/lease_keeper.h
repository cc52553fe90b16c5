/* Renews the leases of running jobs, so that a realisation may take longer than a lease: one thread
 * with a source of its own sends heartbeats.
 *
 * Each worker thread owns one slot: it calls lease_keeper_hold, then lease_keeper_progress while
 * the job runs, then lease_keeper_let_go. A heartbeat goes out after a third of the lease, and
 * after options->report_ms at the latest: it also reports progress, and its answer says whether the
 * study was cancelled.
 */
#ifndef RUGO_WORKER_LEASE_KEEPER_H
#define RUGO_WORKER_LEASE_KEEPER_H

#include "worker/source.h"
#include <stdbool.h>

struct lease_keeper;
/* Makes a keeper; options are those of the source, and options->worker must outlive the keeper. */
int lease_keeper_create(struct lease_keeper **out, const struct source_options *options,
                        unsigned slots, struct error *err);
/* Accepts NULL. */
void lease_keeper_destroy(struct lease_keeper **keeper);

/* Renews the lease of job from now on until lease_keeper_let_go. Copies what it needs of job. */
void lease_keeper_hold(struct lease_keeper *keeper, unsigned slot, const struct claimed_job *job);
void lease_keeper_let_go(struct lease_keeper *keeper, unsigned slot);
/* Sets the number of finished realisations that the next heartbeat reports. */
void lease_keeper_progress(struct lease_keeper *keeper, unsigned slot, uint64_t done);
/* Returns whether nobody wants the result of the slot's job: its lease is lost or given back, or
 * its study is cancelled. */
bool lease_keeper_is_lost(struct lease_keeper *keeper, unsigned slot);
/* Gives back the leases of all jobs held now, while they still run, so that other workers can claim
 * them before a long realisation ends. */
void lease_keeper_give_back(struct lease_keeper *keeper);

#endif
