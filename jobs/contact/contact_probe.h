/* What a block of finite height changes, told by a cheap model: the same surface on a coarse mesh,
 * pressed on a half-space and on exact layers of the heights of the case's blocks. The pairs see
 * the same surface, and so differ by the height alone.
 *
 * Some realisations are enough, since the differences scatter less than the values. */
#ifndef RUGO_JOBS_CONTACT_CONTACT_PROBE_H
#define RUGO_JOBS_CONTACT_CONTACT_PROBE_H

#include "jobs/contact/contact_case.h"
#include "jobs/contact/contact_tally.h"

/* Whether a realisation is probed: the first sixteen, and then each fourth; never where all blocks
 * of the case are as good as infinitely high. */
bool contact_probe_due(const struct contact_case *one_case, uint64_t realisation);

struct contact_probe;
/* Borrows the case. *out is NULL where no realisation is probed. moments: of the prescribed
 * spectrum. */
int contact_probe_create(struct contact_probe **out, const struct contact_case *one_case,
                         const struct moments *moments, struct error *err);
void contact_probe_destroy(struct contact_probe **probe);
/* Presses z, heights on the own grid of the case, to all loads, into the probe's cells of the
 * tally. stop is asked before each load; non-zero ends it with ERROR_STOPPED. */
int contact_probe_solve(struct contact_probe *probe, const double *z, struct contact_tally *tally,
                        int (*stop)(void *context), void *context, struct error *err);

/* Of the probe; and CPU seconds a realisation in the mean, on a 3 GHz core. */
double contact_probe_bytes(const struct contact_case *one_case);
double contact_probe_seconds(const struct contact_case *one_case);

#endif
