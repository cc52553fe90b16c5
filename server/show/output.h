/* The files of `rugo run --out`: curves.json, curves.csv, an SVG a quantity, and one for each
 * density of a case. */
#ifndef RUGO_SERVER_SHOW_OUTPUT_H
#define RUGO_SERVER_SHOW_OUTPUT_H

#include "schema/result/result.h"

/* Makes the folder if it is missing, and checks that files can be made in it: what takes hours to
 * compute must not find that out at its end. */
int output_prepare(const char *folder, struct error *err);
/* Prepares the folder; replaces files of an earlier run. */
int output_write(const struct study_result *study, const char *folder, struct error *err);

#endif
