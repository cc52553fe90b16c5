/* What tables show of all cases, be it of a study's curves or of its report: what was swept, notes,
 * and whether all realisations have values. */
#ifndef RUGO_SERVER_SHOW_TABLE_SHOWN_CASES_H
#define RUGO_SERVER_SHOW_TABLE_SHOWN_CASES_H

#include "schema/result/report.h"
#include <stdio.h>

enum { COLUMNS_MOST = 24 };

struct shown_cases {
    size_t count;
    const struct case_result **list; /* owned; the results are borrowed */
    /* Pointers whose values differ between cases, in the order of the first case; then those that
     * the first case does not have. Borrowed. */
    /* Pointers of what differs between cases: numbers and words. Lists are left out, which are as
     * long as a line and go with a number, such as the loads with the highest one. */
    size_t varied_count;
    const char *varied[COLUMNS_MOST];
    bool partial; /* some curve has points without the values of all realisations */
};

/* These return false when out of memory. The results must outlive what is made of them. */
bool shown_of_results(const struct study_result *study, struct shown_cases *out);
bool shown_of_report(const struct study_report *report, struct shown_cases *out);
void shown_clear(struct shown_cases *shown);

/* The parameter that stands at a pointer, or NULL. The last argument is its index in the list of a
 * like case, which is looked at first. */
const struct result_parameter *parameter_at(const struct case_result *one, const char *pointer,
                                            size_t place);
/* Compares two values; NULL stands for a case without the parameter. */
bool parameter_same(const struct result_parameter *a, const struct result_parameter *b);
/* Returns "hurst" of "/surface/hurst". */
const char *last_name(const char *pointer);

/* Prints "hurst 0.8, weibull_min, ": the values of case c of what was swept. */
void print_swept(const struct shown_cases *shown, size_t c, FILE *file);
/* Prints notes of all cases, at most so many of them; nothing where there are none. */
void print_notes(const struct shown_cases *shown, size_t most, FILE *file);
/* Prints why cases have no results, a line each; nothing where all have. */
void print_missing(const struct shown_cases *shown, FILE *file);
/* What "(n of N)" means, where some case is partial. x: what the values are at, "load". */
void print_partial(const struct shown_cases *shown, const char *x, FILE *file);

#endif
