/* What the finite length of the cell changes: surfaces of twice the length_ratio, of random numbers
 * of their own, are pressed on a half-space on the coarse mesh of the probe (contact_probe.h),
 * beside some of the realisations. What doubling changes bounds what is left (contact_cell_share).
 *
 * A surface of twice the length is a function of the seed and its realisation, and cases that share
 * their random numbers share it. The other waves, the heights and the scale are those of the case.
 * Such surfaces are so seldom that they take about a tenth of the case's time, and never more in
 * all than those of the case itself. */
#ifndef RUGO_JOBS_CONTACT_CONTACT_CELL_H
#define RUGO_JOBS_CONTACT_CONTACT_CELL_H

#include "jobs/contact/contact_coarse.h"

/* Of a change from one length to `growth` times it: the most that is left of an error which falls
 * at least as 1/L, on the longer of the two cells, and on the shorter. */
static inline double contact_cell_share_longer(double growth) {
    return 1 / (growth - 1);
}
static inline double contact_cell_share_shorter(double growth) {
    return growth / (growth - 1);
}

/* By how much the probed surfaces are longer. */
#define CONTACT_LONGER 2

/* Chooses mesh and interval of a case that is read, and the probe with them where it has none yet;
 * there are none where these surfaces would have too many points, or take much more memory than the
 * case. */
void contact_cell_choose(struct contact_case *one_case);
/* Whether a realisation has such a surface beside it. */
bool contact_cell_due(const struct contact_case *one_case, uint64_t realisation);

struct contact_cell;
/* Borrows the case. *out is NULL where there are no such surfaces. */
int contact_cell_create(struct contact_cell **out, const struct contact_case *one_case,
                        struct error *err);
void contact_cell_destroy(struct contact_cell **cell);
/* Generates and presses the surface beside the realisation of this key, into its cells of the
 * tally: patches are counted on the area of the case's own cell, and shares are of that. Where no
 * surface or no answer is found, there are no values. */
int contact_cell_solve(struct contact_cell *cell, struct random_key key,
                       struct contact_tally *tally, const struct contact_stopper *stopper,
                       struct error *err);

/* Of these surfaces; and CPU seconds a realisation in the mean, on a 3 GHz core. */
double contact_cell_bytes(const struct contact_case *one_case);
double contact_cell_seconds(const struct contact_case *one_case);

#endif
