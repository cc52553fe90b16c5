/* Sliding of an infinite half-space, with pressures and tractions coupled
 * (core/contact/slip/partial_slip.h): the linear limit of sliding_full.h. Private to
 * jobs/contact/quantity. */
#ifndef RUGO_JOBS_CONTACT_QUANTITY_SLIDING_LINEAR_H
#define RUGO_JOBS_CONTACT_QUANTITY_SLIDING_LINEAR_H

#include "jobs/contact/quantity/sliding_record.h"

struct sliding_linear;
/* Returns whether the linear model follows the path of a case: one without a turn. */
bool sliding_linear_follows(const struct contact_case *one_case);
int sliding_linear_create(struct sliding_linear **out, const struct quantity_scene *scene,
                          struct error *err);
void sliding_linear_destroy(struct sliding_linear **sliding);
/* Fills all values but, of a block that is pressed with friction, the gap and the areas by edges,
 * which stay NaN. ERROR_NUMERIC where no solution is found. */
int sliding_linear_solve(struct sliding_linear *sliding, const struct measure_context *context,
                         const double *z, struct sliding_record *record, struct error *err);
double sliding_linear_bytes(const struct quantity_scene *scene);
double sliding_linear_seconds(const struct quantity_scene *scene);

#endif
