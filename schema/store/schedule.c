#include "schema/store/schedule.h"
#include <stdlib.h>

static int compare(const void *a, const void *b) {
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* Raises the lowest loads to one level, so that they take in the bulk. Loads are then in rising
 * order. */
static void share_out(double *loads, size_t n, double bulk) {
    size_t low = 1; /* loads below the level */
    double level, sum;
    qsort(loads, n, sizeof *loads, compare);
    sum = loads[0];
    for (level = sum + bulk; low < n && level > loads[low]; level = (sum + bulk) / (double)low)
        sum += loads[low++];
    for (size_t w = 0; w < low; w++)
        loads[w] = level;
}

double schedule_end(double *loads, size_t n, double bulk, const double *last, size_t count) {
    if (bulk > 0)
        share_out(loads, n, bulk);
    for (size_t job = 0; job < count; job++) {
        size_t free_first = 0;
        for (size_t w = 1; w < n; w++)
            if (loads[w] < loads[free_first])
                free_first = w;
        loads[free_first] += last[job];
    }
    double end = 0;
    for (size_t w = 0; w < n; w++)
        end = loads[w] > end ? loads[w] : end;
    return end;
}
