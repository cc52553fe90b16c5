/* Tables of parameters. All that is known of a parameter stands in its row: from it studies are
 * read and faults reported, and the JSON Schema, the help and the reference are written. Plain
 * data. */
#ifndef RUGO_SCHEMA_STUDY_PARAMETER_H
#define RUGO_SCHEMA_STUDY_PARAMETER_H

#include <stdbool.h>
#include <stddef.h>

enum parameter_type {
    PARAMETER_NUMBER,
    PARAMETER_INTEGER,
    PARAMETER_TEXT,    /* a string of minimum..maximum characters, none of control */
    PARAMETER_SEED,    /* an integer of minimum..maximum, or any of 64 bits as a decimal string */
    PARAMETER_CHOICE,  /* a string out of choices */
    PARAMETER_FLAG,    /* true or false; absent and without a default it is false */
    PARAMETER_NUMBERS, /* an array of items_low..items_high numbers: one value, e.g. bins; or, where
                          there are choices, a string out of them */
    PARAMETER_CHOICES, /* an array of different strings out of choices, or one alone: one value */
    PARAMETER_MEASURE  /* a string out of choices, or a number with its unit: {"lengths": 1.5} */
};

/* A name that a study may give, and what it stands for: a value of the enumeration that the job's
 * struct takes. Arrays of them end with a NULL name. */
struct choice {
    const char *name;
    int value;
};

struct parameter {
    const char *path;             /* JSON pointer in the study: "/surface/hurst" */
    const char *help;             /* what it means, one line, without unit and range */
    const char *symbol;           /* as people write it, "lambda_l/lambda_s"; NULL: its name */
    const char *title;            /* in words, "Hurst exponent"; NULL: its name */
    const char *unit;             /* NULL: a pure number, or none at all */
    const char *default_json;     /* NULL: absent unless given */
    const char *default_text;     /* in words what the kind writes out in place of default_json in
                                     studies that do not give it (study_kind.fill); NULL: it does
                                     not */
    const char *example_json;     /* a value, or a list of values that makes cases */
    const struct choice *choices; /* NULL for types without them */
    const struct choice *units;   /* PARAMETER_MEASURE */
    /* A study that asks for an error may not give this parameter, for this reason, unless its value
     * is target_choice (NULL: no value may). NULL: such a study answers the parameter as any other
     * study, or chooses it where it is left out. */
    const char *target_refusal, *target_choice;
    double minimum, maximum;      /* of each number; ignored for choices and flags */
    size_t items_low, items_high; /* PARAMETER_NUMBERS */
    enum parameter_type type;
    bool above_minimum; /* minimum itself excluded: "(0, 1]" */
    bool below_maximum; /* maximum itself excluded */
    bool required;      /* in every study of this kind */
    bool sweep;         /* a list of values makes cases */
    /* The parameter was added after results were stored: the fingerprint of a case counts it only
     * where it is not at its default (jobs/kind.h). */
    bool later;
};

/* The rows of one member of the study, such as "surface". Kinds list the tables that they take,
 * ended by NULL. */
struct parameter_table {
    const char *name;
    const struct parameter *rows;
    size_t count;
};

/* Returns row number `index` of all tables one after the other; NULL behind the last. */
const struct parameter *parameter_row(const struct parameter_table *const *tables, size_t index);
/* Returns the row of a path, and its index where index is not NULL; NULL for an unknown path. */
const struct parameter *parameter_find(const struct parameter_table *const *tables,
                                       const char *path, size_t *index);
size_t parameter_count(const struct parameter_table *const *tables);

/* Returns the choice of a name, or NULL; name may be NULL. */
const struct choice *choice_find(const struct choice *choices, const char *name);
/* Returns the name of a value, or NULL. */
const char *choice_name(const struct choice *choices, int value);

#endif
