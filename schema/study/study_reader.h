/* Reads a study from its text: checks names and values, opens sweeps, bounds the size of jobs. */
#ifndef RUGO_SCHEMA_STUDY_STUDY_READER_H
#define RUGO_SCHEMA_STUDY_STUDY_READER_H

#include "schema/study/study.h"

/* Reads and checks a study, and reports all faults at once. overrides: PATH=VALUE strings of --set,
 * NULL-terminated or NULL. PATH is a pointer, whose first slash may be missing, or dotted; VALUE is
 * JSON or a bare word. memory_limit in bytes (0: none): a case that needs more is a fault. Returns
 * ERROR_INPUT with faults filled, or, where the text is no JSON, with err alone; *out is then
 * untouched. */
int study_read(struct study **out, const char *text, size_t size, const char *const *overrides,
               const struct study_kind *const *kinds, double memory_limit,
               struct fault_list *faults, struct error *err);

/* Arguments of study_read_ext, whose reading can be stopped. */
struct study_reading {
    const char *const *overrides;
    const struct study_kind *const *kinds;
    double memory_limit;
    /* Called before each case is checked; non-zero ends the reading with ERROR_STOPPED. NULL: never
     * stops. */
    int (*stop)(void *context);
    void *stop_context;
};
int study_read_ext(struct study **out, const char *text, size_t size,
                   const struct study_reading *reading, struct fault_list *faults,
                   struct error *err);

/* Returns the most realisations of a job of a case: at most those of its kind, and a result of a
 * few MB. */
uint64_t study_block_most(const struct study_cost *cost);
/* Returns the size of the next job where `realisations` wait. They are divided into equal blocks of
 * at most `most` that take about 5 s each. seconds: of a realisation; 0: not known. */
uint64_t study_block(uint64_t realisations, double seconds, uint64_t most);
/* Returns the block, or less of it, so that each worker gets a share of the realisations that wait.
 * Realisations that take less than 0.1 s together are not divided. */
uint64_t study_share(uint64_t block, double seconds, uint64_t waiting, uint64_t workers);

#endif
