/* What is told of one height map: roughness, moments, summits. Shared by `generate` and
 * `characterise`. */
#ifndef RUGO_SERVER_SHOW_CHARACTERISATION_H
#define RUGO_SERVER_SHOW_CHARACTERISATION_H

#include "core/statistics/measured_map.h"
#include <stdbool.h>
#include <stdio.h>

enum { CHARACTERISTICS_MOST = 96 };

/* This holds numbers and words by name, in groups that follow each other. */
struct characterisation {
    size_t count;
    struct characteristic {
        const char *group, *name; /* static */
        double value;             /* NaN: none */
        const char *text;         /* static; in place of a value where it is not NULL */
    } list[CHARACTERISTICS_MOST];
};

void characterisation_add(struct characterisation *out, const char *group, const char *name,
                          double value);
void characterisation_add_text(struct characterisation *out, const char *group, const char *name,
                               const char *text);

/* Adds what is known of a periodic map; mode_x, mode_y bound the band of z (nx/2, ny/2 where
 * unknown). *out is undefined after a failure. */
int characterise_heights(struct characterisation *out, const struct grid *grid, const double *z,
                         size_t mode_x, size_t mode_y, struct error *err);
/* Adds what is known of an open map, which may have holes: all by what is inside. */
int characterise_open(struct characterisation *out, const struct measured_map *map,
                      struct error *err);
/* Prints one value a line, its name before it. */
void characterisation_print(FILE *file, const struct characterisation *characterisation);
/* Prints {group: {name: value}}, null for NaN. Returns false when out of memory. */
bool characterisation_print_json(FILE *file, const struct characterisation *characterisation);

#endif
