/* Lists of numbers, and physical quantities, as people type them and as tables have them: with SI
 * prefixes and units. */
#ifndef RUGO_SERVER_SHOW_QUANTITY_H
#define RUGO_SERVER_SHOW_QUANTITY_H

#include "core/error.h"
#include <stdbool.h>
#include <stddef.h>

/* Reads a finite number above 0 with its unit ("Pa", "N", "N/m"), which may have a prefix from p to
 * T and blanks before it: "210GPa", "1 MPa". False where it is not that. */
bool quantity_parse(const char *text, size_t size, const char *unit, double *out);
/* Reads such quantities with commas between, rising, at most `most`. Returns ERROR_INPUT with the
 * first that is wrong, and why, for what is said of all of them to go before. */
int quantities_parse(const char *text, const char *unit, size_t most, double *out, size_t *count,
                     struct error *err);

/* A text of numbers with commas between, rising and above 0; false where it is not that, or more
 * than `most`. */
bool rising_numbers(const char *text, size_t most, double *out, size_t *count);

/* Returns the prefix with which a value is best read, and sets *scale to what it stands for: 1e6
 * and "M" of 3.2e6. "" and 1 of 0 and of what is not finite. */
const char *quantity_prefix(double value, double *scale);
/* Writes the unit in which numbers of an SI unit ("Pa", "m^2", "1/m", "N/m") up to `most` are best
 * read, such as "1/nm"; "" for "1". Returns what it stands for. */
double unit_readable(const char *unit, double most, char *out, size_t size);
/* Writes what one of an axis of that label is: "p/(E* h'_rms) of 1: p = 12 MPa". symbol: of what
 * the unit has `scale` of. */
void unit_note(const char *label, const char *symbol, const char *unit, double scale, char *out,
               size_t size);

#endif
