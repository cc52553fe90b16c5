/* From partial results to results: merges a case's blocks, publishes what came out, and gives
 * results and reports of cases and of whole studies. */
#ifndef RUGO_WORKER_AGGREGATE_H
#define RUGO_WORKER_AGGREGATE_H

#include "schema/store/store.h"

struct job_kind;
struct job_merger;

/* A study that is read case by case: by whoever sends it as it reads, or may be stopped in between.
 * The store may be another handle each time. */
struct aggregate {
    struct study_status about; /* owned: at its beginning */
    const struct job_kind *kind;
};
int aggregate_begin(struct store *store, const char *study, struct aggregate *out,
                    struct error *err);
void aggregate_end(struct aggregate *aggregate);
/* Fills what a document of the study begins with (study_print_head) into an empty one, which the
 * caller clears, also after a failure. */
int aggregate_head(struct store *store, const struct aggregate *aggregate, struct study_result *out,
                   struct error *err);

/* A filter says which cases are asked for, and what of them. */
struct result_filter {
    int64_t case_number; /* -1: all */
    struct published_part part;
    bool complete; /* with the theories that are made on demand */
};
/* The result of a case at its present state, with its parameters: what is published, or merged
 * anew. A case that has not begun has no scalars and no curves; neither has one whose stored
 * results cannot be read or merged, whose `error` says why. ERROR_INPUT for a quantity that a case
 * which has begun does not have. */
int aggregate_case(struct store *store, const struct aggregate *aggregate, uint64_t case_number,
                   const struct result_filter *filter, struct case_result *out, struct error *err);
/* Merges all stored blocks of a case in the order of their realisations; fills an empty result from
 * the merger, which is the caller's to destroy. */
int aggregate_merge(struct store *store, const struct aggregate *aggregate, uint64_t case_number,
                    const struct case_info *info, struct job_merger **out,
                    struct case_result *result, struct error *err);
int aggregate_case_report(struct store *store, const struct aggregate *aggregate,
                          uint64_t case_number, struct case_report *out, struct error *err);
/* Merges what a case has and publishes it; or, of one that asks for an error and has not reached
 * it, queues its next round. ERROR_INPUT, ERROR_NUMERIC: its results cannot be merged; ERROR_STATE:
 * its kind is unknown to this program. */
int aggregate_publish(struct store *store, const char *study, uint64_t case_number,
                      struct error *err);

/* Fails with the error of a result that has one; the value is ERROR_INPUT. */
int aggregate_refuse(const struct case_result *result, struct error *err);

/* All cases asked for; ERROR_ABSENT for an unknown study or case. Where each of them has an error,
 * the first one's fails the whole. */
int aggregate_study(struct store *store, const char *study, const struct result_filter *filter,
                    struct study_result *out, struct error *err);
int aggregate_report(struct store *store, const char *study, struct study_report *out,
                     struct error *err);

#endif
