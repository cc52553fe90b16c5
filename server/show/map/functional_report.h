/* The functional parameters of a map by name: the group `functional` and the table
 * `material_ratio`. */
#ifndef RUGO_SERVER_SHOW_MAP_FUNCTIONAL_REPORT_H
#define RUGO_SERVER_SHOW_MAP_FUNCTIONAL_REPORT_H

#include "jobs/maps/map_functional.h"
#include "server/show/map/named_values.h"

void functional_report_values(struct named_values *out, const struct map_functional *found,
                              bool profile);
/* Adds to the same group the two laws of a stratified face. */
void functional_report_plateau(struct named_values *out, const struct map_functional *found,
                               bool profile);
/* ERROR_MEMORY. */
int functional_report_table(struct named_values *out, const struct map_functional *found,
                            struct error *err);

#endif
