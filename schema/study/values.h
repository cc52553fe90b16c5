/* The values of one case, checked against the tables of its kind and read by path as what the job's
 * struct takes. A value that is not given is the default of its row.
 *
 * A reader may only ask for paths that are in the tables, with the function of the row's type:
 * anything else is an error of the program, which values_status tells as ERROR_STATE. */
#ifndef RUGO_SCHEMA_STUDY_VALUES_H
#define RUGO_SCHEMA_STUDY_VALUES_H

#include "core/error.h"
#include "core/statistics/histogram.h"
#include "schema/study/fault.h"
#include "schema/study/parameter.h"
#include <cjson/cJSON.h>

struct values;

/* Checks every value that is in one of the tables; names that are in none are left alone.
 * parameters, tables and faults are borrowed as long as the values live; faults may be NULL: the
 * first fault is the error in any case. ERROR_INPUT when a value does not fit its row, with all of
 * them in faults; ERROR_MEMORY. */
int values_create(struct values **out, const cJSON *parameters,
                  const struct parameter_table *const *tables, struct fault_list *faults,
                  struct error *err);
void values_destroy(struct values **values);

/* Returns a number or an integer; NaN where the value is absent and has no default. */
double values_number(struct values *values, const char *path);
/* Returns what the choice stands for; 0 where it is absent and has no default. */
int values_choice(struct values *values, const char *path);
/* Returns the text, which lives as long as the values; NULL where it is absent. */
const char *values_text(struct values *values, const char *path);
/* What the choices stand for, in the order given, into out (room for all of the row's choices); how
 * many, 0 where absent. */
size_t values_choices(struct values *values, const char *path, int *out);
/* A measure's number, and in *unit what its unit stands for; INFINITY for one of the choices, in
 * *unit what that stands for; NaN where absent. */
double values_measure(struct values *values, const char *path, int *unit);
/* The array's numbers into *out (owned by the caller; NULL where absent) and *n. Fails only with
 * ERROR_MEMORY. */
int values_numbers(struct values *values, const char *path, double **out, size_t *n,
                   struct error *err);
/* [low, high, count] of a histogram of at most `most` bins; a fault, and *out left alone, where
 * they make none. */
void values_bins(struct values *values, const char *path, size_t most, struct bins *out);
/* Returns whether the value of row number `index`, one that came later, is its default, or absent.
 */
bool values_is_default(const struct values *values, size_t index);
/* Returns the value of row number `index` as JSON, given or default; NULL where it is absent. */
const cJSON *values_json(const struct values *values, size_t index);

/* Adds a fault that no single range shows. */
__attribute__((format(printf, 3, 4))) void values_fault(struct values *values, const char *path,
                                                        const char *format, ...);
/* 0, or ERROR_INPUT with the first fault told through these values; ERROR_STATE where a reader
 * asked for what is in no table. */
int values_status(const struct values *values, struct error *err);

#endif
