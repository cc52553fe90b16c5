/* One table describes the parameters of a kind of study: it drives reading, errors, the effective
 * values that `rugo check` prints, the JSON Schema and the OpenAPI schema. Plain data. */
#ifndef RUGO_SCHEMA_STUDY_PARAMETER_H
#define RUGO_SCHEMA_STUDY_PARAMETER_H

#include <stdbool.h>
#include <stddef.h>

enum parameter_type {
    PARAMETER_NUMBER,
    PARAMETER_INTEGER,
    PARAMETER_CHOICE,  /* a string out of choices */
    PARAMETER_NUMBERS, /* an array of items_low..items_high numbers: one value, e.g. bins */
    PARAMETER_CHOICES, /* an array of different strings out of choices, or one alone: one value */
    PARAMETER_MEASURE  /* a string out of choices, or a number with its unit: {"lengths": 1.5} */
};

struct parameter {
    const char *path;             /* JSON pointer in the study: "/surface/hurst" */
    const char *help;             /* one line; unit or normalisation in it */
    const char *default_json;     /* NULL: absent unless given */
    const char *const *choices;   /* NULL-terminated */
    const char *const *units;     /* PARAMETER_MEASURE; NULL-terminated */
    double minimum, maximum;      /* of each number; ignored for choices */
    size_t items_low, items_high; /* PARAMETER_NUMBERS */
    enum parameter_type type;
    bool above_minimum; /* minimum itself excluded: "(0, 1]" */
    bool below_maximum; /* maximum itself excluded */
    bool required;      /* in every study of this kind */
    bool sweep;         /* a list of values makes cases */
};

#endif
