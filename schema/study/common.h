/* What every study has, whatever its kind: name, kind, seed, random, realisations. */
#ifndef RUGO_SCHEMA_STUDY_COMMON_H
#define RUGO_SCHEMA_STUDY_COMMON_H

#include "schema/study/study.h"

/* The choices of /kind are not in its row: kind_choices makes them. The default of /realisations is
 * the kind's. */
extern const struct parameter_table COMMON_PARAMETERS;

/* Names of kinds as choices, whose values are their positions; caller frees. NULL when out of
 * memory. */
struct choice *kind_choices(const struct study_kind *const *kinds);

/* Reads what every study has into study; adds faults. ERROR_MEMORY. */
int common_read(struct study *study, const cJSON *document, const struct study_kind *const *kinds,
                struct fault_list *faults, struct error *err);

#endif
