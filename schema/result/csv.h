/* Curves as one table for spreadsheets and plotting programs (RFC 4180, but lines end with LF). A
 * point is a line; so is an occupied cell of a matrix. Lines in front that begin with # give the
 * study and its provenance, where these are known.
 *
 * Columns: case, a column for each parameter that the study sweeps (swept.h), quantity, the
 * attributes of CURVE_ATTRIBUTES that stand in tables, x, x2, y, standard_error, a column for each
 * source of ERROR_SOURCE_ROWS, valueless, law_difference, law_standard_error. Differences add less
 * (the case taken off), minuend, subtrahend and paired. Then comes theory_NAME for each theory of
 * the curves printed, then physical units, where there are any. Last come total_low and total_high
 * (total.h) and unknown_errors, names of sources with spaces between. Numbers read back to the same
 * doubles; an unknown value is empty. */
#ifndef RUGO_SCHEMA_RESULT_CSV_H
#define RUGO_SCHEMA_RESULT_CSV_H

#include "schema/result/result.h"
#include <stdio.h>

/* Prints all curves of the cases. Returns false and prints nothing when out of memory; the caller
 * checks the file for write errors. */
bool csv_print(FILE *file, const struct study_result *study);

#endif
