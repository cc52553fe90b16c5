/* What the two files of the model full share. */
#ifndef RUGO_JOBS_CONTACT_MODEL_FULL_H
#define RUGO_JOBS_CONTACT_MODEL_FULL_H

#include "core/full/full.h"
#include "jobs/contact/contact_case.h"

/* Returns what a study asks of the model. */
struct full_options full_model_options(const struct contact_case *one_case);
/* Implements write_mesh of struct contact_model. */
int full_write_mesh(const char *path, const struct contact_case *one_case, size_t model,
                    const double *z, double pressure, struct error *err);

#endif
