/* Cost and errors of the cases of a study.
 *
 * The errors of a curve are sizes over all its points. The statistical one is |standard error|/|y|,
 * the deviation from a theory |y - theory|/|theory|, where |.| is the root of the sum of squares
 * over the points where both are known. That of a source is of |value| + bound. The discretisation
 * error is the distance of every mesh level from the limit; the others are those of the finest
 * level. The total is a size of one standard error and of the others at most, in quadrature,
 * without their signs; an interval of 95 % is another matter (total.h). A case's errors are those
 * of its main curve: the first one that has a statistical error and a theory, or else the first one
 * with an error. */
#ifndef RUGO_SCHEMA_RESULT_REPORT_H
#define RUGO_SCHEMA_RESULT_REPORT_H

#include "schema/json/json.h"
#include "schema/result/result.h"
#include "schema/result/work_time.h"

/* All errors are relative; NaN means that one is not known. */
struct curve_report {
    struct curve place;          /* quantity and attributes alone, without points */
    double seconds, cpu_seconds; /* of the solves behind the curve: shares of the case's time */
    double statistical, errors[ERROR_SOURCES];
    bool applies[ERROR_SOURCES]; /* the source bears on the curve */
    double total;     /* statistical error and sum of the others, in quadrature; NaN where one that
                       * bears on the curve is not known */
    double law;       /* size of law_difference, no error and in no total; NaN: not known */
    double valueless; /* most realisations without a value at a point; NaN: not reported */
    size_t theory_count;
    struct {
        const char *name;
        double deviation;
    } theories[THEORIES_MOST];
};
struct scalar_report {
    const char *name;
    double value, statistical;
    double deviation, grid_deviation; /* from theory, from that of the grid */
    bool has_theory, has_grid;
};
struct case_report {
    struct case_result about; /* number, realisations, parameters, notes, error, and the arena of
                                 all texts: no curves and no scalars */
    uint64_t realisations_total, jobs, attempts;
    struct work_time time; /* of completed jobs */
    size_t curve_count, scalar_count;
    struct curve_report *curves; /* in the arena, as the scalars */
    struct scalar_report *scalars;
    const struct curve_report *main; /* one of the curves, or NULL */
};
struct study_report {
    char *id, *name, *kind, *state, *random; /* these and the next two as in study_result */
    cJSON *swept, *provenance;
    struct work_time time;
    size_t case_count;
    struct case_report *cases; /* owned */
};
void case_report_clear(struct case_report *report);
void study_report_clear(struct study_report *report);
/* Moves what a study's result and its report have in common; the cases of the result stay. */
void study_report_take_head(struct study_report *report, const struct study_result *head);

/* Measures the curves and scalars of a result as if its case had taken one second; copies
 * parameters, notes and error too. The caller fills in the realisations in all, jobs and
 * attempts. */
int case_report_make(struct case_report *out, const struct case_result *result, struct error *err);
/* Sets the time of a case, and multiplies the shares of its curves by it. */
void case_report_spend(struct case_report *report, const struct work_time *time);
/* Returns the total of the errors of a curve: those that are the same in every realisation add up,
 * the statistical one is added in quadrature. NaN where one that bears on the curve is not known.
 */
double curve_report_total(const struct curve_report *report);
/* Returns the processor time to halve the error. Statistical errors fall with the square root of
 * the realisations, so that it is three times what was spent. NaN without a main curve. */
double case_report_seconds_to_halve(const struct case_report *report);

/* These print the document of `rugo report` as study_print_head and result_print do theirs. */
bool case_report_print(FILE *file, const struct case_report *report);
bool study_report_print(FILE *file, const struct study_report *report);
/* *out is untouched on failure. */
int case_report_read(const cJSON *document, struct case_report *out, struct error *err);
int study_report_read(const cJSON *document, struct study_report *out, struct error *err);

#endif
