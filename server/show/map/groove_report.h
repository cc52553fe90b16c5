/* The grooves of a map: named values, and a sentence for each family. */
#ifndef RUGO_SERVER_SHOW_MAP_GROOVE_REPORT_H
#define RUGO_SERVER_SHOW_MAP_GROOVE_REPORT_H

#include "jobs/maps/map_characterisation.h"
#include "server/show/map/named_values.h"

/* Adds the group "grooves", and of a second family "crossed_grooves"; nothing where there are none.
 */
void groove_report_values(struct named_values *out, const struct map_characterisation *found);
/* Adds their harmonics, tables of the same names with "_harmonics". ERROR_MEMORY. */
int groove_report_tables(struct named_values *out, const struct map_characterisation *found,
                         struct error *err);

/* Units of a sentence, and what one of them is of the map's. */
struct groove_units {
    double x, z;
    const char *x_name, *z_name;
};
/* Writes what a family is: "every 12.3 +- 0.1 um, ...". */
void groove_sentence(const struct map_groove *groove, const struct groove_units *units, char *out,
                     size_t size);

#endif
