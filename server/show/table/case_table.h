/* Cases as a table: a row a case, first what the study sweeps, then scalars, or values of curves at
 * one point, with their errors.
 *
 * A scalar is named as it is, "summit_density"; a value of a curve as QUANTITY@X, "mean_gap@0.1",
 * where X is one of the x of the curve. Words after colons choose among the curves of the quantity:
 * a model, a series, kinematics, a level or a pressure, "contact_area:layered:nodes:8@0.1". Without
 * them it is the first series on the finest level, a column a model.
 *
 * What stands beside a value is a column of its own by a word behind a dot: ".theory", ".grid"
 * (theory of the grid, of scalars), ".law" (what the other law of heights gives less), or a source
 * of errors, ".model", ".cell" (what it leaves of the value, without its bound). */
#ifndef RUGO_SERVER_SHOW_TABLE_CASE_TABLE_H
#define RUGO_SERVER_SHOW_TABLE_CASE_TABLE_H

#include "schema/result/result.h"
#include "schema/result/total.h"
#include "server/show/plot/picture_source.h"

struct table_request {
    const char *columns; /* names with commas between; NULL: those that the kind's view shows */
    /* Rows of such cases alone: each a list of NAME=VALUE with commas between. Values of one name
     * are alternatives, different names are all to hold. NULL-terminated; NULL: all cases. */
    const char *const *where;
};

enum table_column_type { COLUMN_PARAMETER, COLUMN_SCALAR, COLUMN_CURVE };
/* Of one row; NaN for what is not there. */
struct table_value {
    const struct result_parameter *parameter; /* of COLUMN_PARAMETER alone; NULL: without it */
    double value, standard_error;
    double sampled; /* realisations that the value is of; 0: none */
    double error;   /* the sum of what other sources are known to leave: |value| + bound */
    double theory;
    double grid; /* theory on the grid, of a scalar alone */
    double law_difference, law_standard_error;
    double physical; /* the value in the column's physical unit */
    struct scalar_error errors[ERROR_SOURCES];
    struct total total; /* the interval of 95 % in which the truth lies */
};
struct table_column {
    enum table_column_type type;
    const char *name;
    const char *pointer;           /* of a parameter */
    const char *unit;              /* NULL: none known */
    const char *physical;          /* SI unit in which some row has its value too; NULL: none */
    const char *quantity, *series; /* of a curve, as the next three */
    const char *model;             /* NULL: without models */
    double x;
    const char *x_label;
    const char *theory;            /* of a curve: whose values stand beside it; NULL: none */
    bool has_total;                /* some value has a total interval, more than rounding */
    bool unknown[UNKNOWN_SOURCES]; /* sources that bear on some row and are not known there */
    struct table_value *values;    /* one a row */
};
/* Owns its texts and values. Initialise with {0}. */
struct case_table {
    struct study_result study; /* scalars of all cases, without curves; owned */
    struct case_result room;   /* empty but for the arena of all that the columns point to */
    size_t row_count, column_count;
    const struct case_result **rows; /* cases of the study; in the arena */
    struct table_column *columns;    /* owned */
};

/* Asks the source for what the columns need. On failure nothing is left to clear. ERROR_INPUT names
 * a column, point or parameter that no case has, and those that there are. */
int case_table_make(struct case_table *out, const struct picture_source *source,
                    const struct table_request *request, struct error *err);
/* The same by steps: rows without columns, then columns by their names, each at the end; messages
 * call these what they were asked as. */
int case_table_open(struct case_table *out, const struct picture_source *source,
                    const char *const *where, struct error *err);
int case_table_add(struct case_table *table, const struct picture_source *source,
                   const char *asked_as, const char *columns, struct error *err);
void case_table_clear(struct case_table *table);

/* Print the table; JSON and CSV are false when out of memory. Write errors are left to the file.
 * Markdown is the text's table alone, as documents have it. */
void case_table_text(const struct case_table *table, FILE *file);
void case_table_markdown(const struct case_table *table, FILE *file);
bool case_table_csv(const struct case_table *table, FILE *file);
bool case_table_json(const struct case_table *table, FILE *file);
enum { TABLE_TEXT, TABLE_CSV, TABLE_JSON, TABLE_MARKDOWN, TABLE_FORMAT_COUNT };
#define TABLE_FORMATS "text|csv|json|markdown"
extern const char *const TABLE_FORMAT_NAMES[TABLE_FORMAT_COUNT];
/* Prints it in one of these; ERROR_MEMORY. */
int case_table_print(const struct case_table *table, int format, FILE *file, struct error *err);

#endif
