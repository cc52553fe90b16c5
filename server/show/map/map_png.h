/* A map as a picture of its points: a pixel a point, coloured from its least to its largest value.
 */
#ifndef RUGO_SERVER_SHOW_MAP_MAP_PNG_H
#define RUGO_SERVER_SHOW_MAP_MAP_PNG_H

#include "core/error.h"
#include "core/surface/grid.h"
#include <stdio.h>

/* Writes a PNG of nx by ny pixels, y upwards, dark where low (the colours of inferno); NaN is
 * transparent. z: x fastest. The text chunk "Range" holds both ends. ERROR_SYSTEM when it cannot be
 * written. */
int map_png(FILE *file, const struct grid *grid, const double *z, struct error *err);

/* Makes NaN of the pressures of a surface where there is no contact, so that pictures leave these
 * points blank and their scale begins at the least pressure of the contact. Profiles, which are
 * drawn as lines, and pressures without any contact stay as they are. */
void map_blank_open(const struct grid *grid, double *pressures);

#endif
