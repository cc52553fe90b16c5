/* What is told of one height map: roughness, moments, summits. Shared by `generate` and
 * `characterise`. */
#ifndef RUGO_SERVER_SHOW_CHARACTERISATION_H
#define RUGO_SERVER_SHOW_CHARACTERISATION_H

#include "core/surface/grid.h"
#include <stdbool.h>
#include <stdio.h>

enum { CHARACTERISTICS_MOST = 48 };

/* This holds numbers by name, in groups that follow each other. */
struct characterisation {
    size_t count;
    struct characteristic {
        const char *group, *name; /* static */
        double value;             /* NaN: none */
    } list[CHARACTERISTICS_MOST];
};

/* mode_x, mode_y bound the band of z (nx/2, ny/2 where unknown). *out is undefined after a failure.
 */
int characterise_heights(struct characterisation *out, const struct grid *grid, const double *z,
                         size_t mode_x, size_t mode_y, struct error *err);
/* Prints one value a line, its name before it. */
void characterisation_print(FILE *file, const struct characterisation *characterisation);
/* Prints {group: {name: value}}, null for NaN. Returns false when out of memory. */
bool characterisation_print_json(FILE *file, const struct characterisation *characterisation);

#endif
