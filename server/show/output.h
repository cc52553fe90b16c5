/* The files of `rugo run --out`: curves.json, a CSV a curve, an SVG a quantity, and one for each
 * density of a case. */
#ifndef RUGO_SERVER_SHOW_OUTPUT_H
#define RUGO_SERVER_SHOW_OUTPUT_H

#include "schema/result/result.h"

/* Makes the folder if it is missing; replaces files of an earlier run. */
int output_write(const struct study_result *study, const char *folder, struct error *err);

#endif
