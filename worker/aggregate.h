/* From partial results to curves: merges a case's blocks, publishes what came out, and builds the
 * documents of interface.md (curves, report). */
#ifndef RUGO_WORKER_AGGREGATE_H
#define RUGO_WORKER_AGGREGATE_H

#include "schema/store/store.h"

struct job_kind;

/* A study that is read case by case: by whoever sends it as it reads, or may be stopped in between.
 * The store may be another handle each time. */
struct aggregate {
    struct study_status about; /* owned: at its beginning */
    const struct job_kind *kind;
};
int aggregate_begin(struct store *store, const char *study, struct aggregate *out,
                    struct error *err);
void aggregate_end(struct aggregate *aggregate);
/* What both documents begin with: {"study", "name", "kind", "state", "cases": []}, that of `report`
 * with the seconds spent before the cases. *cases borrows the list. NULL: out of memory. */
cJSON *aggregate_head(const struct aggregate *aggregate, bool seconds, cJSON **cases);
/* One member of "cases" of either document; a case that has not begun has no scalars and no curves.
 * quantity: NULL for all. */
int aggregate_curves_case(struct store *store, const struct aggregate *aggregate,
                          uint64_t case_number, const char *quantity, cJSON **out,
                          struct error *err);
int aggregate_report_case(struct store *store, const struct aggregate *aggregate,
                          uint64_t case_number, cJSON **out, struct error *err);
/* Curves of a case as they come from its kind, and its info (case_info_clear). */
int aggregate_open(struct store *store, const struct aggregate *aggregate, uint64_t case_number,
                   struct case_info *info, cJSON **out, struct error *err);

struct curve_filter {
    int64_t case_number;  /* -1: all */
    const char *quantity; /* NULL: all */
};
/* Curves of a case at its present state, merged anew unless published at this revision. Caller
 * deletes *out. */
int aggregate_case(struct store *store, const char *study, uint64_t case_number, cJSON **out,
                   struct error *err);
/* Merges what a case has and publishes it. ERROR_INPUT, ERROR_NUMERIC: its results cannot be
 * merged; ERROR_STATE: its kind is unknown to this program. */
int aggregate_publish(struct store *store, const char *study, uint64_t case_number,
                      struct error *err);
/* The document of `curves`; ERROR_ABSENT for an unknown study or case, ERROR_INPUT for a quantity
 * that the study does not have. */
int aggregate_curves(struct store *store, const char *study, const struct curve_filter *filter,
                     cJSON **out, struct error *err);
/* The same as CSV text: one table, a line a point. Caller frees. */
int aggregate_csv(const cJSON *curves, char **out, struct error *err);
/* The document of `report`: speed against error, by case. */
int aggregate_report(struct store *store, const char *study, cJSON **out, struct error *err);

#endif
