/* What slips of a map that is pressed with friction, as `press` prints it: tables by the share of
 * full slip, or by how far the flat slides, and members of JSON. */
#ifndef RUGO_SERVER_SHOW_MAP_PRESS_SLIP_H
#define RUGO_SERVER_SHOW_MAP_PRESS_SLIP_H

#include "server/show/map/press_report.h"
#include <cjson/cJSON.h>
#include <stdio.h>

/* Prints what slips of a series, with the sums of the bounds of its errors; nothing where friction
 * is not asked for. */
void press_slip_print(FILE *file, const struct press_report *report,
                      const struct press_series *series);
/* Adds the same as "slip" or "sliding"; false when out of memory. */
bool press_slip_add(cJSON *document, const struct press_report *report,
                    const struct press_series *series);

#endif
