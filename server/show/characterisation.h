/* What is told of one height map: roughness, moments, summits. Shared by `generate` and
 * `characterise`. */
#ifndef RUGO_SERVER_SHOW_CHARACTERISATION_H
#define RUGO_SERVER_SHOW_CHARACTERISATION_H

#include "core/statistics/map_chance.h"
#include <stdbool.h>
#include <stdio.h>

enum { CHARACTERISTICS_MOST = 384, CHARACTERISTIC_COLUMNS_MOST = 64 };

/* This holds numbers and words by name, in groups that follow each other, and behind them columns
 * of numbers, likewise. Initialise with {0}. */
struct characterisation {
    bool in_metres; /* values have metres to their powers as units; otherwise these are not known */
    size_t count;
    struct characteristic {
        const char *group, *name; /* static */
        double value;             /* NaN: none */
        int power;                /* of its unit: 1 of a length or height, -1 of a curvature, ... */
        const char *text;         /* borrowed; in place of a value where it is not NULL */
    } list[CHARACTERISTICS_MOST];
    size_t column_count;
    struct characteristic_column {
        const char *group, *name; /* static; the columns of a group have as many values each */
        double *values;           /* owned */
        size_t count;
        int power; /* as above */
    } columns[CHARACTERISTIC_COLUMNS_MOST];
};
void characterisation_clear(struct characterisation *characterisation);

/* What is there by this name: NaN, or NULL, where it is not. Borrowed. */
double characterisation_value(const struct characterisation *characterisation, const char *group,
                              const char *name);
const char *characterisation_text(const struct characterisation *characterisation,
                                  const char *group, const char *name);
const struct characteristic_column *
characterisation_find_column(const struct characterisation *characterisation, const char *group,
                             const char *name);

void characterisation_add(struct characterisation *out, const char *group, const char *name,
                          double value);
void characterisation_add_length(struct characterisation *out, const char *group, const char *name,
                                 double value, int power);
void characterisation_add_text(struct characterisation *out, const char *group, const char *name,
                               const char *text);
/* Puts an error behind the value that it is of, with the unit of that; nothing where the value is
 * not there. */
void characterisation_add_error(struct characterisation *out, const char *group, const char *name,
                                const char *error_name, double error);
/* Adds a column of zeros, for the caller to fill; NULL when out of memory. */
double *characterisation_column(struct characterisation *out, const char *group, const char *name,
                                size_t count);
double *characterisation_column_length(struct characterisation *out, const char *group,
                                       const char *name, size_t count, int power);

/* Adds what is known of a periodic map; mode_x, mode_y bound the band of z (nx/2, ny/2 where
 * unknown). chance: NULL where summits shall have no errors. *out is undefined after a failure. */
int characterise_heights(struct characterisation *out, const struct grid *grid, const double *z,
                         size_t mode_x, size_t mode_y, const struct map_chance *chance,
                         struct error *err);
/* Adds what is known of an open map, which may have holes: all by what is inside. */
int characterise_open(struct characterisation *out, const struct measured_map *map,
                      const struct map_chance *chance, struct error *err);
/* Prints one value a line, its name before it and where there is one its unit behind it, and of
 * long columns some rows. Lengths in metres are printed in the unit in which they are best read. */
void characterisation_print(FILE *file, const struct characterisation *characterisation);
/* Prints {group: {name: value}}, and arrays of values for columns, null for NaN. Returns false when
 * out of memory. */
bool characterisation_print_json(FILE *file, const struct characterisation *characterisation);

#endif
