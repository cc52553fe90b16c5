/* Reads a study from its text: checks names and values, opens sweeps, bounds the jobs of cases. */
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

/* The same for those who may not wait. */
struct study_reading {
    const char *const *overrides;
    const struct study_kind *const *kinds;
    double memory_limit;
    /* Asked before each case is checked; non-zero ends the reading with ERROR_STOPPED. NULL: no
     * question. */
    int (*stop)(void *context);
    void *stop_context;
};
int study_read_ext(struct study **out, const char *text, size_t size,
                   const struct study_reading *reading, struct fault_list *faults,
                   struct error *err);

/* The most realisations of a job of a case: of its kind, and with a result of a few MB. */
uint64_t study_block_most(const struct study_cost *cost);
/* Realisations of the next job where so many wait: one of equal blocks of `most` at most, which
 * take about 5 s each. seconds: of a realisation; 0: not known. */
uint64_t study_block(uint64_t realisations, double seconds, uint64_t most);
/* The block, or fewer, so that each of so many workers gets one of the realisations that wait; what
 * takes less than 0.1 s stays together. */
uint64_t study_share(uint64_t block, double seconds, uint64_t waiting, uint64_t workers);

#endif
