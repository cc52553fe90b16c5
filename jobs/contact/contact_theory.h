/* The theories beside contact curves. */
#ifndef RUGO_JOBS_CONTACT_CONTACT_THEORY_H
#define RUGO_JOBS_CONTACT_CONTACT_THEORY_H

#include "jobs/contact/contact_case.h"
#include "jobs/curve.h"

/* Values at the loads of the case. Fractions above 1, which light-load theories reach, are left out
 * (NaN). Unused entries have no name. */
struct contact_theories {
    struct curve_theory area[CURVE_THEORIES_MOST], gap[CURVE_THEORIES_MOST];
    double *values; /* owned: behind them */
};
/* modes, moments: of the prescribed spectrum. A profile of one wave has Westergaard's solution,
 * everything else Persson's theory and those of asperities that apply. */
int contact_theories_create(struct contact_theories *out, const struct contact_case *study,
                            const struct modes *modes, const struct moments *moments,
                            struct error *err);
void contact_theories_clear(struct contact_theories *theories);

/* Mean density of the pressures in each bin; false where there is no theory. */
bool contact_theory_pressures(const struct contact_case *study, const struct modes *modes,
                              double load, double *pdf);

#endif
