/* What is told of one height map: roughness, moments, summits. Shared by `generate` and
 * `characterise`. */
#ifndef RUGO_SERVER_SHOW_CHARACTERISATION_H
#define RUGO_SERVER_SHOW_CHARACTERISATION_H

#include "core/statistics/measured_map.h"
#include <stdbool.h>
#include <stdio.h>

enum { CHARACTERISTICS_MOST = 96, CHARACTERISTIC_COLUMNS_MOST = 16 };

/* This holds numbers and words by name, in groups that follow each other, and behind them columns
 * of numbers, likewise. Initialise with {0}. */
struct characterisation {
    size_t count;
    struct characteristic {
        const char *group, *name; /* static */
        double value;             /* NaN: none */
        const char *text;         /* static; in place of a value where it is not NULL */
    } list[CHARACTERISTICS_MOST];
    size_t column_count;
    struct characteristic_column {
        const char *group, *name; /* static; the columns of a group have as many values each */
        double *values;           /* owned */
        size_t count;
    } columns[CHARACTERISTIC_COLUMNS_MOST];
};
void characterisation_clear(struct characterisation *characterisation);

void characterisation_add(struct characterisation *out, const char *group, const char *name,
                          double value);
void characterisation_add_text(struct characterisation *out, const char *group, const char *name,
                               const char *text);
/* Adds a column of zeros, for the caller to fill; NULL when out of memory. */
double *characterisation_column(struct characterisation *out, const char *group, const char *name,
                                size_t count);

/* Adds what is known of a periodic map; mode_x, mode_y bound the band of z (nx/2, ny/2 where
 * unknown). *out is undefined after a failure. */
int characterise_heights(struct characterisation *out, const struct grid *grid, const double *z,
                         size_t mode_x, size_t mode_y, struct error *err);
/* Adds what is known of an open map, which may have holes: all by what is inside. */
int characterise_open(struct characterisation *out, const struct measured_map *map,
                      struct error *err);
/* Prints one value a line, its name before it, and of long columns some rows. */
void characterisation_print(FILE *file, const struct characterisation *characterisation);
/* Prints {group: {name: value}}, and arrays of values for columns, null for NaN. Returns false when
 * out of memory. */
bool characterisation_print_json(FILE *file, const struct characterisation *characterisation);

#endif
