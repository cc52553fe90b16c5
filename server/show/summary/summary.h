/* What people read of a study: tables in plain text. What cannot be had is "-". */
#ifndef RUGO_SERVER_SHOW_SUMMARY_SUMMARY_H
#define RUGO_SERVER_SHOW_SUMMARY_SUMMARY_H

#include "schema/result/report.h"
#include "schema/result/view.h"
#include <stdio.h>

struct shown_cases;

/* The results of a study, as its kind's view shows them (schema/result/view.h): a table of one
 * quantity over its x, or a row a case with what was swept and scalars beside their theory. With
 * the report, which may be NULL, also the time that each case took. */
void summary_of_curves(const struct study_result *study, const struct study_report *report,
                       FILE *file);
/* Prints the tables of a quantity: for a few cases, one each of its values at up to ten points x,
 * by model, with their statistical errors and those of every other source in percent of the value,
 * and the theories; for many cases, a row each with the values at three points. */
void summary_of_quantity(const struct quantity_table *words, const struct shown_cases *shown,
                         const struct study_report *report, FILE *file);
/* One case less another: for each curve a table of both, the difference and its errors, and one of
 * the scalars. Differences that are not those of pairs are marked. */
void summary_of_difference(const struct study_result *study, FILE *file);
/* What theory expects (jobs/statistics/statistics_expectation.h): for a few cases a table of all
 * scalars each, for many a row each. */
void summary_of_theory(const struct study_result *study, FILE *file);
/* Speed against error: a row a case, and, where there are models and levels, what each of them and
 * each estimator cost and err: by case for a few cases, over all of them for many. */
void summary_of_report(const struct study_report *report, FILE *file);

#endif
