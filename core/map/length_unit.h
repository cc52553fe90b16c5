/* Units of length by their names in files. */
#ifndef RUGO_CORE_MAP_LENGTH_UNIT_H
#define RUGO_CORE_MAP_LENGTH_UNIT_H

#include <stdbool.h>
#include <stddef.h>

/* Finds metres in one unit of this name ("m", "mm", "um", "\xc2\xb5m" in either code point and in
 * Latin-1, "nm", "pm", "A" or "\xc3\x85", "inch", ...; blanks around it do not count). Returns
 * false where it is no length. */
bool length_unit_metres(const char *name, size_t size, double *metres);

/* Returns the unit in which a length of this many metres is easiest to read ("mm", "\xc2\xb5m",
 * ...); static. */
const char *length_unit_readable(double metres, double *metres_in_one);

/* Returns the unit of so many metres whose name can be typed ("um", "A"), or NULL; static. */
const char *length_unit_typed(double metres);

/* Returns whether it is the unit "m", that of maps whose unit of length is known. */
bool length_unit_is_metre(const char *unit);

#endif
