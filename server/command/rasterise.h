/* SVG as pixels or for print, by the rsvg-convert of librsvg: a program beside this one, since the
 * library and what it links would be in every copy of it for the sake of one option. */
#ifndef RUGO_SERVER_COMMAND_RASTERISE_H
#define RUGO_SERVER_COMMAND_RASTERISE_H

#include "core/error.h"
#include <stdio.h>

/* Writes a PNG of the text of an SVG into a file that is open and empty: two pixels a unit, or 384
 * an inch where it has a size on paper. ERROR_SYSTEM with the reason, such as that there is no such
 * program. */
int rasterise(const char *svg, size_t size, FILE *out, struct error *err);
/* Does the same with a format for print, "pdf" or "eps". */
int print_as(const char *format, const char *svg, size_t size, FILE *out, struct error *err);

#endif
