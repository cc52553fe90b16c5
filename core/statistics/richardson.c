#include "core/statistics/richardson.h"
#include <math.h>

static const double ORDER_LOW = 1, ORDER_HIGH = 3;

enum { BISECTIONS = 60 }; /* leave 2/2^60 of an order, less than rounding */

void richardson_fit_add(struct richardson_fit *fit, double fine, double coarse) {
    if (isfinite(fine * coarse)) {
        fit->product += fine * coarse;
        fit->square += fine * fine;
    }
}

double richardson_fit_ratio(const struct richardson_fit *fit) {
    return fit->product / fit->square;
}

/* Returns the change between the two coarser of three levels over that between the two finer ones,
 * at an order: fine^q (coarse^q - 1)/(fine^q - 1), rising in q. */
static double change_ratio(double order, double fine, double coarse) {
    return pow(fine, order) * expm1(order * log(coarse)) / expm1(order * log(fine));
}

double richardson_order(double ratio, double fine, double coarse) {
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

double richardson_factor(double order, double fine) {
    return 1 / expm1(order * log(fine));
}
