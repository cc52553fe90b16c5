/* What is told of one height map: roughness, moments, summits. Shared by `generate` and
 * `characterise`. */
#ifndef RUGO_SERVER_SHOW_CHARACTERISATION_H
#define RUGO_SERVER_SHOW_CHARACTERISATION_H

#include "core/surface/grid.h"
#include <cjson/cJSON.h>
#include <stdio.h>

/* mode_x, mode_y bound the band of z (nx/2, ny/2 where unknown). Caller deletes *out. */
int characterisation_create(cJSON **out, const struct grid *grid, const double *z, size_t mode_x,
                            size_t mode_y, struct error *err);
/* One value a line, name before it. */
void characterisation_print(FILE *file, const cJSON *characterisation);

#endif
