/* What the benches of growth share: exponents that are fitted to values over sizes, and tables in
 * the form of the documents, so that a row can be copied into its page. */
#ifndef RUGO_TESTS_SUPPORT_GROWTH_H
#define RUGO_TESTS_SUPPORT_GROWTH_H

#include <gsl/gsl_fit.h>
#include <math.h>
#include <stddef.h>
#include <stdio.h>

enum { GROWTH_SIZES_MOST = 8, GROWTH_TEXT_SIZE = 32 };

/* Returns the slope of log value over log size, by least squares, of the positive values: others
 * were not measured. NAN where they are fewer than two. */
static inline double growth_exponent(const double *sizes, const double *values, size_t count) {
    double x[GROWTH_SIZES_MOST], y[GROWTH_SIZES_MOST], front, slope, covariance[3], squares;
    size_t measured = 0;
    for (size_t n = 0; n < count; n++)
        if (values[n] > 0) {
            x[measured] = log(sizes[n]);
            y[measured++] = log(values[n]);
        }
    if (measured < 2)
        return NAN;
    gsl_fit_linear(x, 1, y, 1, measured, &front, &slope, &covariance[0], &covariance[1],
                   &covariance[2], &squares);
    return slope;
}

/* Writes a positive value with three digits or more, from 10 000 on with spaces, and any other as
 * "-"; returns out. */
static inline const char *growth_text(char out[GROWTH_TEXT_SIZE], double value) {
    if (!(value > 0))
        snprintf(out, GROWTH_TEXT_SIZE, "-");
    else if (value < 99.95)
        snprintf(out, GROWTH_TEXT_SIZE, "%.3g", value);
    else if (value < 9999.5)
        snprintf(out, GROWTH_TEXT_SIZE, "%.0f", value);
    else if (value < 999999.5)
        snprintf(out, GROWTH_TEXT_SIZE, "%.0f %03.0f", floor(round(value) / 1e3),
                 fmod(round(value), 1e3));
    else
        snprintf(out, GROWTH_TEXT_SIZE, "%.0f %03.0f %03.0f", floor(round(value) / 1e6),
                 floor(fmod(round(value), 1e6) / 1e3), fmod(round(value), 1e3));
    return out;
}

/* Prints the head of a table of so many columns behind the exponent: `more`, such as " limit |". */
static inline void growth_print_head(const char *heading, const double *sizes, size_t count,
                                     const char *more) {
    char text[GROWTH_TEXT_SIZE];
    printf("\n| %s |", heading);
    for (size_t n = 0; n < count; n++)
        printf(" %s |", growth_text(text, sizes[n]));
    printf(" exponent |%s\n|", more);
    for (size_t n = 0; n < count + 2; n++)
        printf(" --- |");
    for (; *more != '\0'; more++)
        printf("%s", *more == '|' ? " --- |" : "");
    printf("\n");
}

/* Prints a row, without its end: what stands behind the exponent follows. */
static inline void growth_print_row(const char *name, const double *sizes, const double *values,
                                    size_t count) {
    char text[GROWTH_TEXT_SIZE];
    printf("| %s |", name);
    for (size_t n = 0; n < count; n++)
        printf(" %s |", growth_text(text, values[n]));
    printf(" %.2f |", growth_exponent(sizes, values, count));
}

#endif
