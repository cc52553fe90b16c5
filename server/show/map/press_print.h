/* What `press` prints of the contact of a map: a table for people, JSON, or curves. */
#ifndef RUGO_SERVER_SHOW_MAP_PRESS_PRINT_H
#define RUGO_SERVER_SHOW_MAP_PRESS_PRINT_H

#include "server/show/map/press_report.h"
#include <cjson/cJSON.h>
#include <stdio.h>

/* Prints how the map was prepared and what the command took; for each model heading, values, those
 * in physical units where these are known, and errors by source. */
void press_print_table(FILE *file, const struct press_report *report);
/* Returns the same as a document, for the caller to delete; NULL when out of memory. What several
 * models have of their own is an element of "models" for each. */
cJSON *press_document(const struct press_report *report);
/* Prints the curves as those of a study with one case: as a document, or as a table, with lines in
 * front that begin with # and say what was pressed. Sets their physical units, where these are
 * known. Returns false when out of memory. */
bool press_print_curves(FILE *file, const struct press_report *report, bool csv);

#endif
