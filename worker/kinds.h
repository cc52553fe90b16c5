/* The job kinds as the study reader wants them. */
#ifndef RUGO_WORKER_KINDS_H
#define RUGO_WORKER_KINDS_H

#include "jobs/kind.h"
#include "schema/study/fault.h"
#include "schema/study/study.h"

/* Static table of kinds_count() entries made from JOB_KINDS. */
const struct study_kind *kinds_table(void);
size_t kinds_count(void);
/* Reads a study with these kinds; memory limit: the machine's memory (cgroup and free RAM). */
int kinds_read_study(struct study **out, const char *text, size_t size,
                     const char *const *overrides, struct fault_list *faults, struct error *err);

#endif
