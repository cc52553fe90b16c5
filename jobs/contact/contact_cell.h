/* What the finite length of the cell changes: surfaces of twice its length_ratio, and of a quarter
 * or half of it (both sides of a rectangle, whose shape stays), of random numbers of their own, are
 * pressed on a half-space on the coarse mesh of the probe (contact_probe.h), beside some of the
 * realisations. What the length changes bounds what is left (contact_cell_share): longer surfaces
 * see the lengths that matter, shorter ones are so cheap that many of them tell a change well.
 *
 * Such a surface is a function of the seed and its realisation, and cases that share their random
 * numbers share it. The other waves, the heights and the scale are those of the case. They are so
 * seldom that they take about a tenth of the case's time, and longer ones are never longer in all
 * than those of the case itself. */
#ifndef RUGO_JOBS_CONTACT_CONTACT_CELL_H
#define RUGO_JOBS_CONTACT_CONTACT_CELL_H

#include "jobs/contact/contact_coarse.h"
#include <math.h>

/* Of the change to a cell `length` times as long, longer or shorter: the most that is left of an
 * error of which doubling the length leaves at most the share `left` (1/2: as 1/L). */
static inline double contact_cell_share(double length, double left) {
    return fabs(1 / (1 - pow(left, log2(length))));
}

/* Chooses meshes and intervals of a case that is read, and the probe with them where it has none
 * yet. There are no longer surfaces where they would have too many points, or take much more memory
 * than the case, and no shorter ones where they would not hold the longest wave. */
void contact_cell_choose(struct contact_case *one_case);
/* Whether a realisation has such a surface beside it. */
bool contact_cell_due(const struct contact_case *one_case, enum contact_length length,
                      uint64_t realisation);

struct contact_cell;
/* Borrows the case. *out is NULL where there are no such surfaces. */
int contact_cell_create(struct contact_cell **out, const struct contact_case *one_case,
                        struct error *err);
void contact_cell_destroy(struct contact_cell **cell);
/* Generates and presses the surfaces beside the realisation of this key, into their cells of the
 * tally: patches are counted on the area of the case's own cell, and shares are of that. Where no
 * surface or no answer is found, there are no values. */
int contact_cell_solve(struct contact_cell *cell, struct random_key key,
                       struct contact_tally *tally, const struct contact_stopper *stopper,
                       struct error *err);

/* Of these surfaces; and CPU seconds a realisation in the mean, on a 3 GHz core. */
double contact_cell_bytes(const struct contact_case *one_case);
double contact_cell_seconds(const struct contact_case *one_case);

#endif
