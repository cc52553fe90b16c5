/* Reads a contact case from the parameters of a study. */
#ifndef RUGO_JOBS_CONTACT_CONTACT_CASE_READ_H
#define RUGO_JOBS_CONTACT_CONTACT_CASE_READ_H

#include "jobs/contact/case/contact_case.h"

/* Reads a case as surface_case_read does. memory_limit: as of struct job_kind. */
int contact_case_read(struct contact_case *out, const cJSON *parameters, double memory_limit,
                      struct fault_list *faults, struct error *err);

#endif
