/* Statistics studies that ask for an error: one component, the case itself, with as many surfaces
 * as it takes. Chance is the only source: all that is measured is of the surface as it is
 * generated.
 */
#ifndef RUGO_JOBS_STATISTICS_STATISTICS_TARGET_H
#define RUGO_JOBS_STATISTICS_STATISTICS_TARGET_H

#include "jobs/kind.h"

/* As study_kind has it. */
int statistics_target_expand(const cJSON *document, struct study_case *one,
                             struct fault_list *faults, struct error *err);
/* As job_kind has it: the result of the case, with the scalars of the target. */
int statistics_target_answer(const cJSON *parameters, size_t count,
                             const struct target_component *components, uint64_t *wanted,
                             struct case_result *out, struct error *err);

#endif
