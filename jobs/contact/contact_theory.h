/* The theories beside contact curves. */
#ifndef RUGO_JOBS_CONTACT_CONTACT_THEORY_H
#define RUGO_JOBS_CONTACT_CONTACT_THEORY_H

#include "jobs/contact/contact_case.h"
#include "schema/result/result.h"

/* Values at the loads of the case, in a result's arena. Fractions above 1, which light-load
 * theories reach, are left out (NaN). */
struct contact_theories {
    size_t area_count, gap_count;
    struct theory area[THEORIES_MOST], gap[THEORIES_MOST];
};
/* modes, moments: of the prescribed spectrum. A profile of one wave has Westergaard's solution,
 * everything else Persson's theory and those of asperities that apply. */
int contact_theories_make(struct contact_theories *out, const struct contact_case *one_case,
                          const struct modes *modes, const struct moments *moments,
                          struct case_result *result, struct error *err);

/* Computes the mean density of the pressures in each bin; false where there is no theory. */
bool contact_theory_pressures(const struct contact_case *one_case, const struct modes *modes,
                              double load, double *pdf);

#endif
