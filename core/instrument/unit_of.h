/* Units of values in a file, in the form of a height map. */
#ifndef RUGO_CORE_INSTRUMENT_UNIT_OF_H
#define RUGO_CORE_INSTRUMENT_UNIT_OF_H

#include <stdbool.h>
#include <stddef.h>

enum { UNIT_ROOM = 16 }; /* bytes of xy_unit and z_unit of a height map */

/* Finds metres in one unit of this name. Instruments write A for the ampere of a current's layer,
 * so that it is no length here. */
bool unit_is_length(const char *name, double *metres);

/* Where the name is a length, sets kept to "m" and *metres to the factor of values. Otherwise sets
 * kept to the name, shortened to its room, and *metres to 1. */
void unit_keep(char kept[UNIT_ROOM], const char *name, double *metres);

#endif
