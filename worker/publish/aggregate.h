/* Makes results from partial results: merges and publishes a case's blocks, and returns results and
 * reports of cases and of whole studies. */
#ifndef RUGO_WORKER_PUBLISH_AGGREGATE_H
#define RUGO_WORKER_PUBLISH_AGGREGATE_H

#include "schema/store/store.h"

struct job_kind;
struct job_merger;

/* A study that is read case by case, so that a caller can send results meanwhile, or stop in
 * between. The store may be another handle each time. */
struct aggregate {
    struct study_status about; /* owned: at its beginning */
    const struct job_kind *kind;
};
int aggregate_begin(struct store *store, const char *study, struct aggregate *out,
                    struct error *err);
void aggregate_end(struct aggregate *aggregate);
/* Fills the head of a study's document (study_print_head) into an empty result. The caller clears
 * it, also after a failure. */
int aggregate_head(struct store *store, const struct aggregate *aggregate, struct study_result *out,
                   struct error *err);

/* The cases that are asked for, and the parts of their results. */
struct result_filter {
    int64_t case_number; /* -1: all */
    struct published_part part;
    bool complete; /* with the theories that are made on demand */
};
/* Reads the present result of a case, with its parameters: what is published, or else merged now. A
 * case that has not begun has no scalars and no curves. Nor has one whose stored results cannot be
 * read or merged: its `error` says why. ERROR_INPUT for a quantity that a case which has begun does
 * not have. */
int aggregate_case(struct store *store, const struct aggregate *aggregate, uint64_t case_number,
                   const struct result_filter *filter, struct case_result *out, struct error *err);
/* Merges all stored blocks of a case in the order of their realisations, and fills an empty result
 * from the merger. The caller destroys the merger. */
int aggregate_merge(struct store *store, const struct aggregate *aggregate, uint64_t case_number,
                    const struct case_info *info, struct job_merger **out,
                    struct case_result *result, struct error *err);
int aggregate_case_report(struct store *store, const struct aggregate *aggregate,
                          uint64_t case_number, struct case_report *out, struct error *err);
/* A case that is merged, and not published yet. */
struct merged_case {
    char study[STUDY_ID_SIZE];
    uint64_t case_number, revision;
    struct case_result result; /* owned */
    struct job_merger *merger; /* owned; NULL: values of realisations are not published */
    bool nothing;              /* it got its next round instead: nothing is to be published */
};
/* Merges a case into *out, which the caller clears, also after a failure. A case that asks for an
 * error and has not reached it gets its next round instead. ERROR_INPUT, ERROR_NUMERIC: its results
 * cannot be merged; ERROR_STATE: its kind is unknown to this program. */
int aggregate_prepare(struct store *store, const char *study, uint64_t case_number,
                      struct merged_case *out, struct error *err);
int aggregate_write(struct store *store, const struct merged_case *merged, struct error *err);
void merged_case_clear(struct merged_case *merged);

/* Fails with ERROR_INPUT and the error of a result that has one. */
int aggregate_refuse(const struct case_result *result, struct error *err);

/* Reads all cases that are asked for; ERROR_ABSENT for an unknown study or case. If every one of
 * them has an error, fails with that of the first. */
int aggregate_study(struct store *store, const char *study, const struct result_filter *filter,
                    struct study_result *out, struct error *err);
int aggregate_report(struct store *store, const char *study, struct study_report *out,
                     struct error *err);

/* Returns what store_publish_points needs of a merged case: values of single realisations at the
 * points of published curves (the view realisation_points). Borrows the merger. */
struct point_texts realisation_values(const struct job_merger *merger);
/* ERROR_INPUT that names the quantities of a case, and the nearest of them; or of a scalar, where
 * it is to be had. */
int quantity_absent(const struct case_result *result, const char *quantity, struct error *err);

#endif
