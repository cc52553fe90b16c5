#include "core/statistics/heights/histogram.h"
#include "core/vectors.h"
#include <string.h>

/* Values are sorted into cells a block at a time, by loops that make vectors. Neighbours, which
 * tend to be in one cell, are counted in tables of their own, so that none waits for the other. */
enum { BLOCK = 256, TABLES = 4, CELLS_MOST = 1024 };

/* cell[i] = bins_find(bins, scale * values[i]) */
WIDE_VECTORS static void find_cells(const struct bins *bins, double scale, size_t n,
                                    const double *values, int32_t *cell) {
    const double low = bins->low, high = bins->high, last = (double)(bins->count - 1);
    const double rate = (double)bins->count / (high - low);
    const int32_t overflow = (int32_t)bins->count + 1;
    for (size_t i = 0; i < n; i++) {
        double x = scale * values[i], t = (x - low) * rate;
        t = t > 0 ? t : 0; /* also NaN */
        t = t < last ? t : last;
        int32_t inside = (int32_t)t + 1;
        inside = x < low ? 0 : inside;
        cell[i] = x <= high ? inside : overflow;
    }
}

void histogram_add(const struct bins *bins, size_t n, const double *values, double scale,
                   uint64_t *counts) {
    if (bins->count + 2 > CELLS_MOST) {
        for (size_t i = 0; i < n; i++)
            counts[bins_find(bins, scale * values[i])]++;
        return;
    }
    uint64_t tables[TABLES][CELLS_MOST];
    int32_t cell[BLOCK];
    size_t cells = bins->count + 2;
    for (size_t t = 0; t < TABLES; t++)
        memset(tables[t], 0, cells * sizeof **tables);
    for (size_t first = 0; first < n; first += BLOCK) {
        size_t m = n - first < BLOCK ? n - first : BLOCK, i = 0;
        find_cells(bins, scale, m, values + first, cell);
        for (; i + TABLES <= m; i += TABLES)
            for (size_t t = 0; t < TABLES; t++)
                tables[t][cell[i + t]]++;
        for (; i < m; i++)
            tables[0][cell[i]]++;
    }
    for (size_t c = 0; c < cells; c++)
        for (size_t t = 0; t < TABLES; t++)
            counts[c] += tables[t][c];
}

static const double UNIT = 0x1p-60;
static const double LARGEST = 0x1p60, SMALL = 4; /* below which 64 bits hold the units */

static void add_units(struct exact_sum *sum, fixed_point units) {
    fixed_point total;
    if (__builtin_add_overflow(sum->total, units, &total))
        sum->lost++;
    else
        sum->total = total;
}

void exact_sum_add(struct exact_sum *sum, double value) {
    if (fabs(value) < SMALL)
        add_units(sum, llrint(value / UNIT));
    else if (fabs(value) < LARGEST)
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
