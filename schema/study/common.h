/* What every study has, whatever its kind: name, kind, seed, random, realisations. */
#ifndef RUGO_SCHEMA_STUDY_COMMON_H
#define RUGO_SCHEMA_STUDY_COMMON_H

#include "schema/study/study.h"

/* The row of /kind has no choices: kind_choices makes them. The default of /realisations is that of
 * the kind. */
extern const struct parameter_table COMMON_PARAMETERS;

/* Returns the names of kinds as choices, whose values are their positions. The caller frees them;
 * NULL when out of memory. */
struct choice *kind_choices(const struct study_kind *const *kinds);

/* Reads into the study what every study has, and adds faults. Fails with ERROR_MEMORY alone. */
int common_read(struct study *study, const cJSON *document, const struct study_kind *const *kinds,
                struct fault_list *faults, struct error *err);

#endif
