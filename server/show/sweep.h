/* A scalar of a study over one of its parameters: a line for each setting of the others. */
#ifndef RUGO_SERVER_SHOW_SWEEP_H
#define RUGO_SERVER_SHOW_SWEEP_H

#include "schema/result/result.h"
#include "server/show/shown_cases.h"

/* Parameters are named as the study has them, "hurst" or "surface/hurst". */
struct sweep_request {
    const char *scalar;
    const char *x;      /* NULL: of the numbers that are swept, the one of most values */
    const char *colour; /* NULL: each line has a colour of its own */
};
struct sweep_point { /* borrows from the results */
    const struct case_result *one;
    const struct scalar *scalar;
    double x;
    size_t line;
};
/* Initialise with {0}. The results must outlive it. */
struct sweep {
    struct shown_cases shown;
    const char *x, *colour; /* pointers of the parameters; colour NULL where not asked for */
    size_t count, line_count;
    struct sweep_point *points; /* owned; line by line, each by rising x */
    size_t left_out;            /* cases without a value, or without this parameter */
};

/* ERROR_INPUT for a parameter that no case has as a number (x) or that is not swept (colour), or
 * where nothing is swept; ERROR_ABSENT where no case has the scalar. */
int sweep_make(struct sweep *out, const struct study_result *study,
               const struct sweep_request *request, struct error *err);
void sweep_clear(struct sweep *sweep);

/* Returns the points of a line, and how many they are. */
const struct sweep_point *sweep_line(const struct sweep *sweep, size_t line, size_t *count);
/* Writes what tells the line of a point from the others: "wavelength_ratio 8, weibull_min". */
void sweep_label(const struct sweep *sweep, const struct sweep_point *point, char *out,
                 size_t size);
/* Returns whether two cases have the same value of a parameter. */
bool sweep_same(const struct case_result *a, const struct case_result *b, const char *pointer);

#endif
