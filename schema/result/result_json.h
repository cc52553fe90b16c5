/* Results as JSON, the documents of `rugo curves` and GET /v1/studies/{id}/curves. There is one
 * writer, which prints case after case without a tree, and one reader, for results from a server.
 * What is printed reads back to the same numbers, and prints again the same.
 *
 *     {"study", "name", "kind", "state", "random"?, "swept"?, "provenance"?, "cases": [
 *       {"case", "parameters": {pointer: value}, "realisations",
 *        "scalars": {name: {"value", "standard_error", "theory"?, errors, totals}},
 *        "curves": [{"quantity", attributes, "x", "y", "standard_error", errors, totals, "theory",
 * ...}], "notes": {"count", "kept": [{"realisation", "text"}]}?, "error"?}]}
 *
 * Totals (total.h) are "total_low", "total_high" and "unknown_errors". They follow from the errors,
 * and are not read: documents of older programs have none.
 *
 * A matrix is printed whole, as an array of rows; empty cells are those without counts. */
#ifndef RUGO_SCHEMA_RESULT_RESULT_JSON_H
#define RUGO_SCHEMA_RESULT_RESULT_JSON_H

#include "schema/json/json.h"
#include "schema/result/result.h"
#include "schema/result/work_time.h"

/* The effective realisations of a curve or a scalar, which has this member where it has them. */
#define EFFECTIVE_KEY "effective_realisations"

/* Prints {"study": ..., "provenance": ... ; the caller goes on with more members, or "}". False
 * when out of memory. */
bool study_print_about(FILE *file, const struct study_result *study);
/* Prints {"study": ..., "cases":[ ; the caller goes on with case after case, commas between them,
 * and "]}". time: NULL where the document has none. False when out of memory. The caller checks the
 * file for write errors, here and below. */
bool study_print_head(FILE *file, const struct study_result *study, const struct work_time *time);
bool result_print(FILE *file, const struct case_result *result);
/* Prints all of the study. */
bool study_print(FILE *file, const struct study_result *study);

/* Print parts of other documents: `, "series": ...`, all attributes or those that stand in tables;
 * {pointer: value}; the notes. */
bool curve_print_attributes(FILE *file, const struct curve *curve, bool all);
bool result_print_parameters(FILE *file, size_t count, const struct result_parameter *parameters);
bool result_print_notes(FILE *file, uint64_t all, size_t count, const struct result_note *notes);
/* Prints `, "error": ...` where the case has one. */
bool result_print_error(FILE *file, const struct case_result *result);

/* Reads the attributes of a curve; texts are copied into the result's arena. */
int curve_read_attributes(struct case_result *result, const cJSON *object, struct curve *curve,
                          struct error *err);
/* Read the parameters, notes and error of a case, which may be missing. */
int result_read_parameters(struct case_result *result, const cJSON *parameters, struct error *err);
int result_read_notes(struct case_result *result, const cJSON *notes, struct error *err);
int result_read_error(struct case_result *result, const cJSON *error, struct error *err);
/* *out is untouched on failure: ERROR_INPUT names what is missing or of another type. */
int result_read(const cJSON *document, struct case_result *out, struct error *err);
/* Fills id, name, kind and state alone. The caller clears *out also on failure. */
int study_head_read(const cJSON *document, struct study_result *out, struct error *err);
int study_result_read(const cJSON *document, struct study_result *out, struct error *err);
/* Fills the parameters of a result from a case's effective values. Each number, string and list
 * gets its RFC 6901 pointer, in the order of the object. */
int result_set_parameters(struct case_result *result, const cJSON *parameters, struct error *err);
/* Adds one parameter, for which the list has room; skips values of other types. False when out of
 * memory. */
bool result_add_parameter(struct case_result *result, const char *pointer, const cJSON *value);

#endif
