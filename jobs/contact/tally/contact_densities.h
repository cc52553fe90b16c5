/* Moments of the areas by pressure over realisations, by bin: sums of the shares of every model and
 * level, and of their products in pairs. From these follow the means and the standard errors of
 * differences on the same surfaces, as of measures from contact_sums.h.
 *
 * Shares are in integer parts of the cell, so that any order of merging gives the same bits. They
 * are kept where a case asks for them (/contact/pressure_pdf/pairs). */
#ifndef RUGO_JOBS_CONTACT_CONTACT_DENSITIES_H
#define RUGO_JOBS_CONTACT_CONTACT_DENSITIES_H

#include "jobs/contact/case/contact_case.h"
#include "jobs/tally.h"

/* States are the models and levels of a case (density_state), pairs those of states s <= t, cells
 * the loads of pdf_loads and their bins, without those outside. */
enum { DENSITY_STATES_MOST = CONTACT_MODELS_MOST * CONTACT_LEVELS_MOST };
struct contact_densities { /* initialise with {0}: keeps nothing */
    size_t states, pairs, loads, bins;
    uint64_t *shares;       /* owned, as all: of the present realisation, by state and cell */
    bool *solved;           /* likewise, by state and load: it has shares */
    uint64_t *realisations; /* by load: those with shares of all states */
    uint64_t *some;         /* by cell: of these, those with things there in any state */
    uint64_t *sum;          /* by cell and state */
    fixed_point *product;   /* by cell and pair */
};
static inline size_t density_state(const struct contact_case *one_case, size_t model,
                                   size_t level) {
    return model * one_case->level_count + level;
}
/* Returns how many numbers the moments of a case have. */
double contact_densities_size(const struct contact_case *one_case);
/* Keeps nothing where the case does not ask for pairs. */
int contact_densities_create(struct contact_densities *out, const struct contact_case *one_case,
                             struct error *err);
void contact_densities_clear(struct contact_densities *densities);
double contact_densities_bytes(const struct contact_case *one_case);

/* Sets the present realisation's shares[contact_case_bins] of a state and load. */
void contact_densities_set(struct contact_densities *densities, size_t state, size_t at,
                           const double *shares);
/* Adds the present realisation at the loads that all states were solved at; the next one begins. */
void contact_densities_add(struct contact_densities *densities);
void contact_densities_merge(struct contact_densities *into, const struct contact_densities *from);

void contact_densities_put(struct bytes *bytes, const struct contact_densities *densities);
/* Fails the reader for sums that no realisations could have. */
void contact_densities_get(struct byte_reader *reader, struct contact_densities *densities);
/* Returns the sum over realisations of the shares of a state in a cell, over the cell's area. */
double contact_densities_total(const struct contact_densities *densities, size_t state, size_t at,
                               size_t bin);

/* Estimates the mean over realisations of sum weights[state] * share, of every bin at a load.
 *
 * Few realisations have things in a rare bin (TALLY_RARE), and do not show its variance. That is
 * taken as the dispersion of all rare bins, the variance over the mean share, times the share in
 * the bin. The share is that of the states or the expected one, if that is larger: a bin where
 * nothing was seen has an error, too. expected: by bin; NaN counts as 0. */
void contact_densities_difference(const struct contact_densities *densities, size_t at,
                                  const int *weights, const double *expected, struct estimate *out);

#endif
