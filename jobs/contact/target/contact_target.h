/* Contact studies that ask for an error: the components by which a case is answered, and their sum.
 *
 * The cheap model is the half-space; in "model" it is layers of the same elements, whose limit is
 * the half-space. With f_l(M) the curve of model M on mesh level l,
 *
 *     answer = f_0(cheap)                          "base": many realisations
 *            + [f_limit(cheap) - f_0(cheap)]       "mesh": the same surfaces on all levels
 *            + [f_limit(asked) - f_limit(cheap)]   "model": the same surfaces, few
 *
 * where limits are known within bounds (Giles 2008; Rey, Krumscheid & Nobile 2019). "cell" has
 * f_0(cheap) on cells a quarter as long: an error that falls at least as 1/L is at L at most a
 * third of the change from L/4. If the study names its mesh, its finest level replaces the limit;
 * if it names its length, there is no "cell". */
#ifndef RUGO_JOBS_CONTACT_TARGET_CONTACT_TARGET_H
#define RUGO_JOBS_CONTACT_TARGET_CONTACT_TARGET_H

#include "jobs/kind.h"

/* As study_kind has it. */
int contact_target_expand(const cJSON *document, struct study_case *one, struct fault_list *faults,
                          struct error *err);
/* As job_kind has it. */
int contact_target_answer(const cJSON *parameters, size_t count,
                          const struct target_component *components, uint64_t *wanted,
                          struct case_result *out, struct error *err);

#endif
