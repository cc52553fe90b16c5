/* Curves as one table for spreadsheets and plotting programs (RFC 4180, but lines end with LF): a
 * line a point, of a matrix a line an occupied cell. Lines in front that begin with # tell the
 * study and its provenance, where that is known. Columns: case, a column for each parameter that
 * the study sweeps (swept_name), quantity, the attributes of CURVE_ATTRIBUTES that stand in tables,
 * x, x2, y, standard_error, a column a source of ERROR_SOURCE_ROWS, valueless, of differences less
 * (the case taken off), minuend, subtrahend and paired, and theory_NAME for each theory of the
 * curves printed. Numbers read back to the same doubles; what cannot be had is empty. */
#ifndef RUGO_SCHEMA_RESULT_CSV_H
#define RUGO_SCHEMA_RESULT_CSV_H

#include "schema/result/result.h"
#include <stdio.h>

/* Prints all curves of the cases. False and nothing printed when out of memory; write errors are
 * left to the file's own flag. */
bool csv_print(FILE *file, const struct study_result *study);

#endif
