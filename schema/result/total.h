/* The total error of a value: the interval in which the truth lies by all that is known of it.
 *
 * A result states of each source that (reported - true) lies within value +- bound,
 * and its standard error s. With H the sum of (value + bound) and L that of (value - bound) over
 * the known sources that bear on the value y,
 *
 *     low  = y - (t s + max(0, H)),
 *     high = y + (t s + max(0, -L)).
 *
 * The interval holds y, and the truth with a probability of 95 % at least, wherever the errors of
 * the sources lie within their bounds: t s is half the width of Student's interval of 95 % of n
 * realisations (t is 2.09 of 20, 1.96 of very many, as of errors that are not of realisations), n
 * being those that have a value, or, of sums and differences, the effective ones, and H and L are
 * the largest and the least that the sources come to. They add up plainly, as the sources' errors
 * are the same in every realisation. The root of the sum of squares, as of errors that are
 * independent, would hold a truth at the end of the bounds of 2 +- 0.25, beside a standard error of
 * 0.25, in 58 % of studies; this one does in 97 %.
 *
 * A source that bears on the value but is not known adds nothing: the interval is that of the
 * others, and the source is named. So is the statistical error of one realisation, which shows no
 * scatter. A standard error that is not known, or of a single map, adds nothing either. */
#ifndef RUGO_SCHEMA_RESULT_TOTAL_H
#define RUGO_SCHEMA_RESULT_TOTAL_H

#include "schema/result/result.h"

/* What may not be known of a value: a source of error, or, behind them, the statistical error, as
 * one realisation shows no scatter. */
enum { UNKNOWN_STATISTICAL = ERROR_SOURCES, UNKNOWN_SOURCES };
const char *unknown_source_name(size_t source);
/* Of the names of all sources with spaces between. */
enum { TOTAL_NAMES_SIZE = 160 };

/* In the units of the value. NaN: the value is not known, or neither is its standard error nor any
 * source. */
struct total {
    double low, high;
    /* Sources that bear on the value, and are not in the interval; of a source that has a value
     * without a bound the value is. */
    bool unknown[UNKNOWN_SOURCES];
};

/* Returns half the width of the statistical interval of 95 % of so many realisations, in standard
 * errors: Student's (1908), of 0 the normal distribution's. */
double total_deviations(double sampled);
/* Returns the degrees of freedom of the standard error of a sum of independent means, by the
 * variance of each and the realisations that it is of (Welch 1947). Means that are exact are left
 * out; NaN where none is left. */
double total_freedom(size_t count, const double *variances, const double *realisations);
/* Returns the total of a value with its errors by source; sampled: realisations with a value, or
 * effective ones. */
struct total total_of(double value, double standard_error, double sampled,
                      const struct scalar_error errors[ERROR_SOURCES]);
struct total scalar_total(const struct scalar *scalar);
/* Returns the error of a source at a point, or of a matrix in an occupied cell. */
struct scalar_error curve_error_at(const struct curve *curve, enum error_source source, size_t at);
/* Return of how many realisations a value is: the effective ones where they are known, else all but
 * those without a value. */
double scalar_sampled(const struct scalar *scalar);
double curve_sampled_at(const struct curve *curve, size_t at);
/* Returns the total of a point, or of a matrix of an occupied cell: at < curve_value_count. */
struct total curve_total(const struct curve *curve, size_t at);
/* Returns the larger distance of the ends of a total from its value; NaN without ends. */
double total_half_width(double value, const struct total *total);
/* Returns whether some source that bears on the value is not in the interval. */
bool total_is_partial(const struct total *total);
/* Writes the names of the sources that are not in the interval, with spaces between. */
void total_unknown_names(const struct total *total, char names[TOTAL_NAMES_SIZE]);
/* Finds the sources that are not known at some point that has a value, or nowhere. */
void curve_unknown(const struct curve *curve, bool unknown[UNKNOWN_SOURCES]);

#endif
