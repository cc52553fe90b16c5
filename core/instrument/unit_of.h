/* Units of what a file holds, as a height map keeps them. */
#ifndef RUGO_CORE_INSTRUMENT_UNIT_OF_H
#define RUGO_CORE_INSTRUMENT_UNIT_OF_H

#include <stdbool.h>
#include <stddef.h>

enum { UNIT_ROOM = 16 }; /* bytes of xy_unit and z_unit of a height map */

/* Metres in one unit of this name. Instruments write A for the ampere of a current's layer, so that
 * it is no length here. */
bool unit_is_length(const char *name, double *metres);

/* Sets kept to "m" where the name is a length, and then *metres to what values are multiplied by;
 * else to what of the name fits and is shown, and *metres to 1. */
void unit_keep(char kept[UNIT_ROOM], const char *name, double *metres);

#endif
