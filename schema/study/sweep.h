/* Sweeps: lists of values opened into cases, the cartesian product in the order of the file. */
#ifndef RUGO_SCHEMA_STUDY_SWEEP_H
#define RUGO_SCHEMA_STUDY_SWEEP_H

#include "schema/study/fault.h"
#include "schema/study/study.h"

/* Fills study->swept, case_count and each case's parameters from a document without faults. Too
 * many cases are a fault, found before anything is allocated. */
int sweep_open(struct study *study, const cJSON *document, struct fault_list *faults,
               struct error *err);

/* Makes the array of the pointers that a document sweeps, in its order; NULL when out of memory. */
cJSON *sweep_pointers(const struct study_kind *kind, const cJSON *document);

#endif
