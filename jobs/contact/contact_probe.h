/* The cheap model on a coarse mesh, on some realisations: what tells errors that are too dear to be
 * told on every one. The same surface is pressed on a half-space and, where blocks of the case are
 * low, on exact layers of their heights: the pairs see the same surface, and so differ by the
 * height alone. Beside the half-space stand surfaces of a longer cell (contact_cell.h), and those
 * that are found in other ways (contact_generation.h).
 *
 * Some realisations are enough, since the differences scatter less than the values. */
#ifndef RUGO_JOBS_CONTACT_CONTACT_PROBE_H
#define RUGO_JOBS_CONTACT_CONTACT_PROBE_H

#include "jobs/contact/contact_coarse.h"

/* The mesh of the probe of a case that has its levels: half as fine as the coarsest one where that
 * leaves 4 points a shortest wave, else that one. */
struct contact_level contact_probe_level(const struct contact_case *one_case);
/* How seldom what takes so many seconds may be done to take no more than is allowed a realisation:
 * a power of two, `least` or more. */
uint64_t contact_probe_interval(double seconds, double allowed, uint64_t least);
/* Returns the position of the model by which the half-space of the probe is solved already, on the
 * coarsest level; model_count without one. */
size_t contact_probe_twin(const struct contact_case *one_case);
/* Whether a realisation is probed: where blocks are low, the first sixteen, and then each fourth;
 * else as seldom as the error of the cell takes; never where neither is told. */
bool contact_probe_due(const struct contact_case *one_case, uint64_t realisation);
/* Whether a realisation is one of those that come once in `interval`, a power of two; among the
 * first ones at least each eighth is, so that small studies have some. */
bool contact_probe_turn(uint64_t interval, uint64_t realisation);

struct contact_probe;
/* Borrows the case. *out is NULL where no realisation is probed. moments: of the prescribed
 * spectrum. */
int contact_probe_create(struct contact_probe **out, const struct contact_case *one_case,
                         const struct moments *moments, struct error *err);
void contact_probe_destroy(struct contact_probe **probe);
/* Presses z, heights on the own grid of the case, to all loads, into the probe's cells of the
 * tally, which holds the values of the levels. */
int contact_probe_solve(struct contact_probe *probe, const double *z, struct contact_tally *tally,
                        const struct contact_stopper *stopper, struct error *err);

/* Of the probe; and CPU seconds a realisation in the mean, on a 3 GHz core. */
double contact_probe_bytes(const struct contact_case *one_case);
double contact_probe_seconds(const struct contact_case *one_case);

#endif
