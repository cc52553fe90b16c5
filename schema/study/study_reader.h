/* Reads a study from its text: checks names and values, opens sweeps, cuts cases into jobs. */
#ifndef RUGO_SCHEMA_STUDY_STUDY_READER_H
#define RUGO_SCHEMA_STUDY_STUDY_READER_H

#include "schema/study/study.h"

/* Reads and checks a study, all faults at once. overrides: PATH=VALUE strings of --set (PATH a
 * pointer, whose first slash may be missing, or dotted, VALUE JSON or a bare word), NULL-terminated
 * or NULL. memory_limit in bytes: a case that needs more is a fault (0: no limit). Returns
 * ERROR_INPUT with faults filled (or, where the text is no JSON, with err alone); *out is then
 * untouched. */
int study_read(struct study **out, const char *text, size_t size, const char *const *overrides,
               const struct study_kind *const *kinds, double memory_limit,
               struct fault_list *faults, struct error *err);

/* Realisations a job: blocks of equal size that take about a minute each. */
uint64_t study_block(uint64_t realisations, const struct study_cost *cost);
/* The same of a component, of which all workers are to have a share at once. */
uint64_t study_block_shared(uint64_t realisations, const struct study_cost *cost);

#endif
