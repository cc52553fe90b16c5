/* The values of one case, checked against the tables of its kind and read by path. A value that is
 * not given is the default of its row.
 *
 * A reader may ask only for paths that are in the tables, with the function of the row's type.
 * Anything else is an error of the program, for which values_status returns ERROR_STATE. */
#ifndef RUGO_SCHEMA_STUDY_VALUES_H
#define RUGO_SCHEMA_STUDY_VALUES_H

#include "core/error.h"
#include "core/statistics/heights/histogram.h"
#include "schema/study/fault.h"
#include "schema/study/parameter.h"
#include <cjson/cJSON.h>

struct values;

/* Checks every value that is in one of the tables, and ignores names that are in none. parameters,
 * tables and faults are borrowed for the life of the values. Without memory ERROR_MEMORY; where
 * values do not fit their rows ERROR_INPUT, with the first fault in err and all of them in faults,
 * which may be NULL. */
int values_create(struct values **out, const cJSON *parameters,
                  const struct parameter_table *const *tables, struct fault_list *faults,
                  struct error *err);
void values_destroy(struct values **values);

/* Returns a number or an integer; NaN where the value is absent and has no default. */
double values_number(struct values *values, const char *path);
/* Returns what the choice stands for; 0 where it is absent and has no default. */
int values_choice(struct values *values, const char *path);
/* Returns whether there is a value: given, or a default. */
bool values_is_given(struct values *values, const char *path);
/* Returns whether a flag is true. */
bool values_flag(struct values *values, const char *path);
/* Returns the text, which lives as long as the values; NULL where it is absent. */
const char *values_text(struct values *values, const char *path);
/* Writes what the choices stand for, in the order given, into out, which has room for all of the
 * row's choices. Returns their number, 0 where absent. */
size_t values_choices(struct values *values, const char *path, int *out);
/* Returns the number of a measure, and in *unit what its unit stands for. For one of the choices it
 * returns INFINITY, and in *unit what the choice stands for; NaN where absent. */
double values_measure(struct values *values, const char *path, int *unit);
/* Returns the numbers of an array in *out (owned by the caller; NULL where absent, or one of the
 * choices) and *n. Fails with ERROR_MEMORY alone. */
int values_numbers(struct values *values, const char *path, double **out, size_t *n,
                   struct error *err);
/* Reads [low, high, count] of a histogram of at most `most` bins. Where they do not form bins, adds
 * a fault and leaves *out as it is. */
void values_bins(struct values *values, const char *path, size_t most, struct bins *out);
/* Returns whether the value of row number `index`, whose parameter was added later, is absent or
 * its default. */
bool values_is_default(const struct values *values, size_t index);
/* Returns the value of row number `index` as JSON, given or default; NULL where it is absent. */
const cJSON *values_json(const struct values *values, size_t index);

/* Adds a fault that no single range shows, of the value at `path`. */
__attribute__((format(printf, 3, 4))) void values_fault(struct values *values, const char *path,
                                                        const char *format, ...);
/* Returns how many faults were added through these values so far. A reader skips what depends on
 * values with faults. */
size_t values_fault_count(const struct values *values);
/* Returns 0, or ERROR_INPUT with the first fault added through these values; ERROR_STATE where a
 * reader asked for a path that is in no table. */
int values_status(const struct values *values, struct error *err);

#endif
