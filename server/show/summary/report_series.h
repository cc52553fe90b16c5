/* What the series of a report cost and err: a series is a model, a level and an estimator, over the
 * cases that have it. */
#ifndef RUGO_SERVER_SHOW_SUMMARY_REPORT_SERIES_H
#define RUGO_SERVER_SHOW_SUMMARY_REPORT_SERIES_H

#include "schema/result/report.h"

/* Sizes stand in this order: the statistical error, one a source, the total, the law difference. */
enum { TOTAL_COLUMN = ERROR_SOURCES + 1, LAW_COLUMN, ERROR_COLUMNS, SERIES_MOST = 64 };
/* Fills in NaN without a curve. */
void errors_of(const struct curve_report *curve, double errors[ERROR_COLUMNS]);

/* Sums over the cases that have the series. */
struct report_series {
    const struct curve *place; /* of the first case; borrowed */
    double cpu_seconds, realisations, valueless, squares[ERROR_COLUMNS];
    size_t known[ERROR_COLUMNS], cases;
};
struct series_list { /* initialise with {0} */
    size_t count;
    struct report_series rows[SERIES_MOST];
};
/* Adds the series of the case's main quantity that have a model; estimates alone. */
void series_add_case(struct series_list *list, const struct case_report *one);
/* Returns an error as root mean square over the cases; NaN where none knows it. */
double series_error(const struct report_series *series, size_t column);

#endif
