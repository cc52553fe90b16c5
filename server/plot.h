/* An SVG of one quantity: the curves of all cases with their error bands, and the theories. */
#ifndef RUGO_SERVER_PLOT_H
#define RUGO_SERVER_PLOT_H

#include "core/error.h"
#include <cjson/cJSON.h>
#include <stdio.h>

/* curves: the document of interface.md. Up to PLOT_CASES cases are drawn, the legend says if there
 * are more. Write errors are left to the file's own flag. ERROR_ABSENT when no case has the
 * quantity. */
enum { PLOT_CASES = 12 };
int plot_quantity(const cJSON *curves, const char *quantity, FILE *file, struct error *err);

#endif
