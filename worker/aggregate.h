/* From partial results to curves: merges a case's blocks, publishes what came out, and builds the
 * documents of interface.md (curves, report). */
#ifndef RUGO_WORKER_AGGREGATE_H
#define RUGO_WORKER_AGGREGATE_H

#include "schema/store.h"

struct curve_filter {
    int64_t case_number;  /* -1: all */
    const char *quantity; /* NULL: all */
};
/* Curves of a case at its present state, merged anew unless published at this revision; publishes
 * when the store is writable and every block of the case is there (a failure to publish is no
 * failure). Caller deletes *out. */
int aggregate_case(struct store *store, const char *study, uint64_t case_number, cJSON **out,
                   struct error *err);
/* The same, for its effect alone: an error also where only the publishing fails. */
int aggregate_publish(struct store *store, const char *study, uint64_t case_number,
                      struct error *err);
/* The document of `curves`; ERROR_ABSENT for an unknown study or case, ERROR_INPUT for a quantity
 * that the study does not have. */
int aggregate_curves(struct store *store, const char *study, const struct curve_filter *filter,
                     cJSON **out, struct error *err);
/* The same as CSV text (one table: case, quantity, series, x, y, standard_error, theory...). Caller
 * frees. */
int aggregate_csv(const cJSON *curves, char **out, struct error *err);
/* The document of `report`: speed against error, by case. */
int aggregate_report(struct store *store, const char *study, cJSON **out, struct error *err);

#endif
