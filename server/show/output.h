/* The files of `rugo run --out`: curves.json, curves.csv, an SVG a quantity, and one for each
 * density of a case. */
#ifndef RUGO_SERVER_SHOW_OUTPUT_H
#define RUGO_SERVER_SHOW_OUTPUT_H

#include "schema/result/result.h"

/* Checks that files can be made in the folder, and that it can be made if it is missing: what takes
 * hours to compute must not find that out at its end. Leaves nothing: a command that is refused
 * makes no folder. */
int output_check(const char *folder, struct error *err);
/* Makes the folder if it is missing; replaces files of an earlier run. */
int output_write(const struct study_result *study, const char *folder, struct error *err);

#endif
