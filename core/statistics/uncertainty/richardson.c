#include "core/statistics/uncertainty/richardson.h"
#include <math.h>

/* An order is looked for between these. */
static const double ORDER_LOW = 0.25, ORDER_HIGH = 8;
/* The order that is seen confirms the known one within this; a signed error is then trusted to this
 * share of it, beside what the two orders make of it. */
static const double ORDER_MARGIN = 0.5, ERROR_MARGIN = 1;
/* Without an order the change between the two finest levels counts so many times as if it shrank by
 * order one alone, and that between the next two as if it shrank by two. */
static const double FINE_SAFETY = 1.25, COARSE_SAFETY = 3;

enum { BISECTIONS = 60 }; /* leave 8/2^60 of an order, less than rounding */

/* Returns the change between the two coarser of three levels over that between the two finer ones,
 * at an order: fine^q (coarse^q - 1)/(fine^q - 1), rising in q. */
static double change_ratio(double order, double fine, double coarse) {
    return pow(fine, order) * expm1(order * log(coarse)) / expm1(order * log(fine));
}

/* The order whose changes have this ratio; the ends of the range where none has. */
static double order_of(double ratio, double fine, double coarse) {
    double low = ORDER_LOW, high = ORDER_HIGH;
    for (int step = 0; step < BISECTIONS; step++) {
        double middle = (low + high) / 2;
        if (change_ratio(middle, fine, coarse) < ratio)
            low = middle;
        else
            high = middle;
    }
    return (low + high) / 2;
}

static double factor_of(double order, double fine) {
    return 1 / expm1(order * log(fine));
}

struct mesh_error mesh_error(const struct mesh_changes *changes, double order) {
    double fine = changes->fine_ratio, coarse = changes->coarse_ratio;
    double ratio = changes->coarse / changes->fine;
    double seen = ratio > 0 && isfinite(ratio) ? order_of(ratio, fine, coarse) : (double)NAN;
    if (fabs(seen - order) <= ORDER_MARGIN) {
        double factor = factor_of(order, fine);
        double doubt = fabs(factor_of(seen, fine) - factor) + ERROR_MARGIN * factor;
        return (struct mesh_error){.error = -factor * changes->fine,
                                   .bound = doubt * fabs(changes->fine),
                                   .weight = factor + doubt,
                                   .order = seen};
    }
    double weight = FINE_SAFETY / (fine - 1);
    double bound = weight * fabs(changes->fine);
    if (!isnan(changes->coarse))
        bound = fmax(bound,
                     COARSE_SAFETY * fabs(changes->coarse) / (fine * fine * (coarse * coarse - 1)));
    return (struct mesh_error){
        .bound = isnan(changes->fine) ? (double)NAN : bound, .weight = weight, .order = NAN};
}
