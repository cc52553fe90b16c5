/* What the tables of summary.h share: swept parameters and cells. */
#ifndef RUGO_SERVER_SHOW_SUMMARY_CELLS_H
#define RUGO_SERVER_SHOW_SUMMARY_CELLS_H

#include "server/show/text_table.h"
#include <cjson/cJSON.h>

enum { COLUMNS_MOST = 24 };

/* Pointers whose values differ between cases (an array of curves or of a report), in the order of
 * the first case; then those that it does not have. Borrowed; how many. */
size_t varied_parameters(const cJSON *cases, const char *names[COLUMNS_MOST]);
/* "hurst" of "/surface/hurst". */
const char *last_name(const char *pointer);
/* A parameter's value. */
void value_cell(struct text_table *table, const cJSON *value);
/* "0.25772 +- 0.00022": as many digits as the error has sense for. */
void measured_text(double value, double error, char *out, size_t size);
void measured_cell(struct text_table *table, double value, double error);
/* " (2 of 3)" where a mean is not over all realisations; "" otherwise. */
const char *partial_text(double realisations, double valueless, char *out, size_t size);
/* What that means, if a curve of some case (of curves or of a report) has valueless realisations.
 */
void print_partial(const cJSON *cases, FILE *file);
/* A share of one in percent, with two digits; "-" for NaN. */
void percent_cell(struct text_table *table, double share);
/* "hurst 0.8, dimension 2", each followed by a comma and a space. */
void print_swept(const cJSON *one, const char *const *names, size_t count, FILE *file);
/* "layered", or "full (hencky)" where the model has several kinematics; "-" without one. */
const char *model_text(const cJSON *curve, char *out, size_t size);
/* Whether a series is a bracket of another one, and no estimate: nodes_lower, nodes_upper. */
bool is_bracket(const cJSON *curve);

/* Notes of an array of cases, at most so many of them; nothing where there are none. */
void print_notes(const cJSON *cases, size_t most, FILE *file);

#endif
