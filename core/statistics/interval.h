/* A value with its 95 % interval. */
#ifndef RUGO_CORE_STATISTICS_INTERVAL_H
#define RUGO_CORE_STATISTICS_INTERVAL_H

/* NaN for a value that was not seen, and for an end of its 95 % interval that is open; what lies
 * beyond an end is left out at 2.5 %, also of an end that is alone. */
struct interval {
    double value, low, high;
};

#endif
