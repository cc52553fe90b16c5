/* The contact of a measured surface among that of pieces of random ones like it (FORMULAS.md,
 * F18.28): each is mirrored at its sides, so that it repeats without a step, and pressed on a
 * half-space to the loads of the case, on its own points. */
#ifndef RUGO_JOBS_CONTACT_CONTACT_LIKE_H
#define RUGO_JOBS_CONTACT_CONTACT_LIKE_H

#include "jobs/contact/contact_coarse.h"
#include "schema/result/result.h"

struct contact_like;
/* Borrows the case. *out is NULL where no pieces are pressed. moments: of the prescribed spectrum.
 */
int contact_like_create(struct contact_like **out, const struct contact_case *one_case,
                        const struct moments *moments, struct error *err);
void contact_like_destroy(struct contact_like **like);
/* Presses the piece of z, heights on the own grid of the case, into the cells of the tally that are
 * kept for it. */
int contact_like_solve(struct contact_like *like, const double *z, struct contact_tally *tally,
                       const struct contact_stopper *stopper, struct error *err);

/* Presses a measured map, heights in lambda_s without its trend, in the same way: area by edges and
 * mean gap/sqrt(m0) at each load of a case that is like it. NaN where no answer is found. */
int contact_like_measure(const struct contact_case *one_case, const double *z, double *areas,
                         double *gaps, struct error *err);

/* Appends, of area and gap, the mean over the pieces beside that of the map, as "piece_QUANTITY",
 * and "percentile_QUANTITY", and as scalars what stands at the highest load. */
int contact_like_curves(const struct contact_tally *tally, struct case_result *out,
                        struct error *err);

/* Of this object; and CPU seconds of a realisation, on a 3 GHz core. */
double contact_like_bytes(const struct contact_case *one_case);
double contact_like_seconds(const struct contact_case *one_case);

#endif
