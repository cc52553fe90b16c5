/* What `characterise` reports of a map in a file, as values with names: first what was done to it,
 * and why. */
#ifndef RUGO_SERVER_SHOW_MAP_MAP_REPORT_H
#define RUGO_SERVER_SHOW_MAP_MAP_REPORT_H

#include "jobs/maps/map_characterisation.h"
#include "server/show/map/named_values.h"

/* Fills *out, {0} at first, which the caller clears in any case. It borrows the texts of the record
 * and of the characterisation. ERROR_MEMORY. */
int map_report_fill(struct named_values *out, const struct map_characterisation *found,
                    const struct height_map *map, const struct preparation_record *record,
                    struct error *err);
/* Adds the parameters alone, without their errors. */
void map_report_parameters(struct named_values *out, const struct map_parameters *parameters);

#endif
