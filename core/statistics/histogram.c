#include "core/statistics/histogram.h"

void histogram_add(const struct bins *bins, size_t n, const double *values, double scale,
                   uint64_t *counts) {
    for (size_t i = 0; i < n; i++)
        counts[bins_find(bins, scale * values[i])]++;
}

static const double UNIT = 0x1p-60;
static const double LARGEST = 0x1p60;

static void add_units(struct exact_sum *sum, fixed_point units) {
    fixed_point total;
    if (__builtin_add_overflow(sum->total, units, &total))
        sum->lost++;
    else
        sum->total = total;
}

void exact_sum_add(struct exact_sum *sum, double value) {
    if (fabs(value) < LARGEST)
        add_units(sum, (fixed_point)rint(value / UNIT));
    else
        sum->lost++;
}

void exact_sum_merge(struct exact_sum *sum, const struct exact_sum *other) {
    add_units(sum, other->total);
    sum->lost += other->lost;
}

double exact_sum_value(const struct exact_sum *sum) {
    return (double)sum->total * UNIT;
}
