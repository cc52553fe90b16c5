/* Values with names and units, as `generate` and `characterise` print them. */
#ifndef RUGO_SERVER_SHOW_MAP_NAMED_VALUES_H
#define RUGO_SERVER_SHOW_MAP_NAMED_VALUES_H

#include "core/error.h"
#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

enum { NAMED_VALUES_MOST = 448, NAMED_COLUMNS_MOST = 64 };

/* This holds numbers and words by name, in groups that follow each other, and behind them columns
 * of numbers, likewise. Initialise with {0}. */
struct named_values {
    bool in_metres; /* values have metres to their powers as units; otherwise these are not known */
    size_t count;
    struct named_value {
        const char *group, *name; /* static */
        double value;             /* NaN: none */
        int power;                /* of its unit: 1 of a length or height, -1 of a curvature, ... */
        const char *text;         /* borrowed; in place of a value where it is not NULL */
    } list[NAMED_VALUES_MOST];
    size_t column_count;
    struct named_column {
        const char *group, *name; /* static; the columns of a group have as many values each */
        double *values;           /* owned */
        size_t count;
        int power; /* as above */
    } columns[NAMED_COLUMNS_MOST];
};
void named_values_clear(struct named_values *values);

/* What is there by this name: NaN, or NULL, where it is not. Borrowed. */
double named_number(const struct named_values *values, const char *group, const char *name);
const char *named_text(const struct named_values *values, const char *group, const char *name);
const struct named_column *named_column_find(const struct named_values *values, const char *group,
                                             const char *name);

void named_values_add(struct named_values *out, const char *group, const char *name, double value);
void named_values_add_length(struct named_values *out, const char *group, const char *name,
                             double value, int power);
void named_values_add_text(struct named_values *out, const char *group, const char *name,
                           const char *text);
/* Adds a column of zeros, for the caller to fill; NULL when out of memory. */
double *named_values_column_length(struct named_values *out, const char *group, const char *name,
                                   size_t count, int power);

/* Writes the names of the groups that there are, with commas between. */
void named_values_groups(const struct named_values *values, char *text, size_t size);
/* Leaves the groups of a list, "heights,areal", alone. On false, *unknown is the first name of the
 * list that is none, and its length. */
bool named_values_keep(struct named_values *values, const char *groups, const char **unknown,
                       size_t *length);

/* Prints one value a line, its name before it and where there is one its unit behind it, and of
 * long columns some rows. Lengths in metres are printed in the unit in which they are best read.
 * Values with a standard error or an interval are rounded to two digits of these; one that is
 * rounding beside the others of its group with its unit, such as a mean that was taken out, is
 * 0. */
void named_values_print(FILE *file, const struct named_values *values);
/* Prints {group: {name: value}}, and arrays of values for columns, null for NaN. Returns false when
 * out of memory. */
bool named_values_print_json(FILE *file, const struct named_values *values);
/* Writes the same into a picture, for programs that read it: <metadata>. ERROR_MEMORY. */
int named_values_draw_metadata(FILE *file, const struct named_values *values, struct error *err);

#endif
