/* The results of a case: curves, scalars and notes, each number with its errors by source.
 *
 * Everything above the job kinds takes these structs. Merging fills them; tables, pictures, reports
 * and exports read them. Each format (JSON, CSV, the store's bytes and rows) has one writer and one
 * reader in this folder or the store. An attribute by which curves are distinguished is a row of
 * CURVE_ATTRIBUTES, a source of error a row of ERROR_SOURCES; a new one is one row more, and
 * changes no file above.
 *
 * A case_result owns all that it points to in one arena: texts and arrays are made by result_text
 * and result_numbers, live until result_clear, and are never freed one by one. */
#ifndef RUGO_SCHEMA_RESULT_RESULT_H
#define RUGO_SCHEMA_RESULT_RESULT_H

#include "core/error.h"
#include <stdbool.h>
#include <stdint.h>

/* --- errors by source --- */

/* The sources of systematic error; the statistical error is the standard error of each value. */
enum error_source {
    ERROR_DISCRETISATION, /* this mesh less the limit of the levels */
    ERROR_CELL,           /* this cell less one of very many long waves */
    ERROR_BLOCK,          /* this block less an infinitely high one */
    ERROR_MODEL,          /* this model less the most complete one */
    ERROR_SOLVER,         /* an answer to a tolerance less the exact one */
    ERROR_MISSING,        /* a mean over the realisations that have a value less one over all */
    ERROR_PATCH,          /* surfaces like a measured patch less that which it is a patch of */
    ERROR_SOURCES
};
struct error_source_row {
    const char *name;               /* "discretisation": in reports */
    const char *key;                /* in JSON, CSV and reports: "discretisation_error" */
    const char *bound_key;          /* in JSON and CSV */
    const char *standard_error_key; /* in JSON */
    const char *order_key;          /* in JSON; NULL: a source without an order */
    const char *order_from_key;     /* in JSON: "levels" or "assumed" */
    bool bound_has_interval;        /* bounds include the interval of 95 % of the values */
};
extern const struct error_source_row ERROR_SOURCE_ROWS[ERROR_SOURCES];
/* Returns whether the bound of an error, which includes its interval of 95 %, is mostly statistical
 * and leaves its sign open: all that is known of it is its size, |value| + bound at most. */
bool error_is_unresolved(enum error_source source, double value, double bound,
                         double standard_error);

/* The error of a curve from one source, in the units of y and as long as it (of a matrix, as its
 * occupied cells): (reported - true) lies within value +- bound, where value has the standard
 * error. A bound alone has values of 0. */
struct curve_error {
    bool applies;        /* the source bears on the curve; where it does not, the rest is empty */
    const double *value; /* NULL: not known */
    const double *bound; /* NULL: not known */
    const double *standard_error;
    double order;        /* of convergence; NaN: none */
    bool order_observed; /* on three levels; else assumed */
};
/* Realisations without a value are assumed to differ from the others by so many deviations. */
#define MISSING_DEVIATIONS 2.0

/* The error of a single number from one source. */
struct scalar_error {
    bool applies, known;
    double value, bound, standard_error;
};

/* --- physical units --- */

/* What the numbers of an axis or a scalar are in an SI unit: each times the scale. */
struct physical_unit {
    const char *unit;   /* "Pa"; NULL: not known, or there is none */
    const char *symbol; /* what is in that unit: "p" */
    double scale;
};

/* --- curves --- */

struct theory {
    const char *name;
    const double *y; /* as long as the curve's y; NULL: made on demand by the kind */
};
enum { THEORIES_MOST = 8 };

/* A curve: points over x, or, where columns > 0, a matrix over x and x2 of which only the occupied
 * cells are kept. NaN stands for an unknown number. */
struct curve {
    const char *quantity, *x_label, *y_label;
    /* The attributes that distinguish curves of one quantity (CURVE_ATTRIBUTES); NULL or NaN:
     * none. */
    const char *series; /* "" without */
    const char *model;
    const char *kinematics; /* of strain, in a model that has several */
    double level;           /* points a shortest wave */
    double points;          /* of the whole grid of the level */
    double pressure;        /* at which the curve was taken */

    size_t n; /* points, or rows of a matrix */
    const double *x;
    const double *y, *standard_error; /* n values, or cell_count of a matrix */
    size_t columns;                   /* 0, or of a matrix */
    const double *x2;                 /* columns */
    const char *x2_label;
    size_t cell_count;                    /* of a matrix: occupied cells */
    const uint32_t *cells;                /* row * columns + column, rising */
    double empty_y, empty_standard_error; /* of all other cells: 0, or NaN where nothing is known */

    size_t theory_count;
    struct theory theories[THEORIES_MOST]; /* of a matrix: dense, n x columns */
    struct curve_error errors[ERROR_SOURCES];
    /* Of heights that are not Gaussian, as long as an error: the curve under the other law of
     * heights less this one, and its standard error; NULL: not known. No error: the law is part of
     * the question. */
    const double *law_difference, *law_standard_error;
    const double *valueless; /* realisations without a value, or without a thing in the bin; NULL:
                              * not known */
    /* Of a difference of two cases: their values, n each; NULL: none. */
    const double *minuend, *subtrahend;
    bool paired;                /* of a difference: its standard error is that of pairs */
    bool counted;               /* from a histogram, or over its bins, with the counts outside */
    double underflow, overflow; /* counts below and above the bins */
    struct physical_unit x_unit, x2_unit, y_unit;
    uint64_t sampled;        /* realisations that the values are means of; 0: none, as of one map */
    const double *effective; /* as of scalars, as long as an error; NULL: of no value */
};

/* Makes a curve without points, attributes and errors. */
struct curve curve_named(const char *quantity, const char *x_label, const char *y_label);
/* Gives the curve n points; a matrix n rows, whose values are those of its cells. */
void curve_set_points(struct curve *curve, size_t n, const double *x, const double *y,
                      const double *standard_error);

/* Returns how many values it has: points, or the occupied cells of a matrix. */
static inline size_t curve_value_count(const struct curve *curve) {
    return curve->columns > 0 ? curve->cell_count : curve->n;
}

/* Returns whether some of the realisations that a value is the mean of may have none. An empty bin
 * of a histogram is no missing value. */
bool curve_is_partial(const struct curve *curve);

enum attribute_type { ATTRIBUTE_TEXT, ATTRIBUTE_NUMBER };
struct curve_attribute {
    const char *key; /* in JSON, CSV and views */
    size_t offset;   /* in struct curve */
    enum attribute_type type;
    bool separates_series; /* estimators, pressures and the like, not model and mesh */
    size_t column;         /* of CSV, reports and views, counted from 1; 0: none */
};
enum { CURVE_ATTRIBUTE_COUNT = 6 };
extern const struct curve_attribute CURVE_ATTRIBUTES[CURVE_ATTRIBUTE_COUNT];
/* Returns attribute n, from 0, of those with a column, in the order of the columns; NULL behind the
 * last. */
const struct curve_attribute *curve_column(size_t n);
/* Return the value of an attribute: NULL for the text of a number, NaN for the number of a text. */
const char *curve_attribute_text(const struct curve *curve, const struct curve_attribute *row);
double curve_attribute_number(const struct curve *curve, const struct curve_attribute *row);

/* Sets the text or the number, whichever the attribute is. */
void curve_set_attribute(struct curve *curve, const struct curve_attribute *row, const char *text,
                         double number);

/* --- scalars, notes, the case --- */

struct scalar {
    const char *name;
    double value, standard_error; /* NaN: none */
    double theory;                /* NaN: none */
    double grid;                /* theory of the same for the grid of the measurement; NaN: none */
    bool difference, paired;    /* as of curves */
    double minuend, subtrahend; /* of a difference */
    struct scalar_error errors[ERROR_SOURCES];
    double law_difference, law_standard_error; /* as of curves; NaN: not known */
    struct physical_unit unit;
    uint64_t sampled; /* as of curves */
    /* Realisations that the standard error has the degrees of freedom of, which are one less, where
     * these are not all that were sampled: some have no value, or the value is a sum of several
     * means (total_freedom). 0: all. */
    double effective;
};
/* Returns a scalar without sources of error, a theory of the grid and another law. */
struct scalar scalar_named(const char *name, double value, double standard_error, double theory);

struct result_note {
    uint64_t realisation;
    const char *text;
};

/* A parameter by which cases can be selected: "/surface/hurst". */
struct result_parameter {
    const char *pointer;
    const char *text; /* NULL: a number */
    double number;
    bool list; /* the text is a JSON array: one value of several, such as levels */
    bool flag; /* the text is true or false, as JSON has them */
};

struct arena; /* private */
struct cJSON;
struct case_result {
    uint64_t case_number, realisations;
    size_t parameter_count, scalar_count, curve_count, note_count; /* notes that are kept */
    struct result_parameter *parameters;
    struct scalar *scalars;
    struct curve *curves; /* those of one quantity together, in the order of the kind */
    struct result_note *notes;
    uint64_t notes_all; /* kept or not */
    bool difference;    /* of case_number less the case `less` (difference.h) */
    uint64_t less;
    const char *remark; /* of a difference: curves that it lacks; NULL: none */
    const char *error;  /* why there are no results though there are realisations; NULL: none */
    struct arena *arena;
};
/* Results of a study, of all cases or some. Owns its texts and cases. */
struct study_result {
    char *id, *name, *kind, *state;
    char *random;             /* "common": cases share random numbers, errors are correlated */
    struct cJSON *swept;      /* the swept pointers, an array; owned; NULL: not known */
    struct cJSON *provenance; /* provenance.h; owned; NULL: not known */
    size_t case_count;
    struct case_result *cases;
};

/* Initialise with {0}. Frees all that the result owns. */
void result_clear(struct case_result *result);
void study_result_clear(struct study_result *study);

/* Returns zeroed room from the arena; NULL when out of memory. */
void *result_room(struct case_result *result, size_t count, size_t size);
double *result_numbers(struct case_result *result, size_t n);
const char *result_text(struct case_result *result, const char *text); /* NULL for NULL */
/* Appends a copy of the struct, whose arrays and texts the arena owns or which are static. The
 * lists of curves and scalars may move. */
int result_add_curve(struct case_result *result, const struct curve *curve, struct error *err);
int result_add_scalar(struct case_result *result, const struct scalar *scalar, struct error *err);
/* Says of all curves and scalars that they are means of so many realisations. */
void result_sampled(struct case_result *result, uint64_t realisations);
/* Keeps the curves of a quantity (NULL: of all), or no curves at all. */
void result_keep(struct case_result *result, const char *quantity, bool scalars_only);

const struct scalar *result_scalar(const struct case_result *result,
                                   const char *name); /* or NULL */
/* Returns the first curve of a quantity, or NULL; the others of the quantity follow it. */
const struct curve *result_curve(const struct case_result *result, const char *quantity);
/* Returns the parameter at that pointer, or NULL. */
const struct result_parameter *result_parameter(const struct case_result *result,
                                                const char *pointer);

/* Return true also where both are NULL, or both NaN. */
bool same_text(const char *a, const char *b);
bool same_number(double a, double b);
/* Returns whether two curves have the same quantity and the same attributes but model and mesh. */
bool curve_same_series(const struct curve *a, const struct curve *b);

#endif
