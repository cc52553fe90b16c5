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

#endif
