/* Keeps the leases of running jobs alive: one thread of its own, with a source of its own, that
 * sends heartbeats, so that a realisation may take longer than a lease.
 *
 * Each worker thread owns one slot: keeper_hold, keeper_progress while the job runs, keeper_let_go.
 * A heartbeat goes out after a third of the lease, and after 5 s at the latest: it also tells
 * progress, and brings the word that a study was cancelled. */
#ifndef RUGO_WORKER_KEEPER_H
#define RUGO_WORKER_KEEPER_H

#include "worker/source.h"
#include <stdbool.h>

struct keeper;
/* options are those of the source; both strings and options must outlive the keeper. */
int keeper_create(struct keeper **out, const struct source_options *options, unsigned slots,
                  struct error *err);
void keeper_destroy(struct keeper **keeper);

/* From here on the lease of job is renewed, until keeper_let_go. Copies what it needs of job. */
void keeper_hold(struct keeper *keeper, unsigned slot, const struct claimed_job *job);
void keeper_let_go(struct keeper *keeper, unsigned slot);
/* Tells how many realisations are done. */
void keeper_progress(struct keeper *keeper, unsigned slot, uint64_t done);
/* The lease of what the slot holds is lost, given back, or the study cancelled: its result is
 * unwanted. */
bool keeper_is_lost(struct keeper *keeper, unsigned slot);
/* Gives back the leases of all jobs held now, while they still run: others need not wait for the
 * end of a long realisation. */
void keeper_give_back(struct keeper *keeper);

#endif
