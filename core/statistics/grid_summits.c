#include "core/statistics/grid_summits.h"
#include "core/vectors.h"
#include <stdint.h>

enum { BLOCK = 64 }; /* points compared at once before looking for a hit */

/* above[i] = all ones where m[i] beats its neighbours; returns non-zero when any does. Plain loops
 * of one width, so that the compiler makes vectors of them. */
WIDE_VECTORS static int64_t compare_block(const double *u, const double *m, const double *d,
                                          bool corners, size_t n, int64_t *above) {
    int64_t any = 0;
    for (size_t i = 0; i < n; i++)
        above[i] = -(int64_t)(m[i] > m[i - 1]) & -(int64_t)(m[i] > m[i + 1]);
    if (u != NULL && d != NULL)
        for (size_t i = 0; i < n; i++)
            above[i] &= -(int64_t)(m[i] > u[i]) & -(int64_t)(m[i] > d[i]);
    if (u != NULL && d != NULL && corners)
        for (size_t i = 0; i < n; i++)
            above[i] &= -(int64_t)(m[i] > u[i - 1]) & -(int64_t)(m[i] > u[i + 1]) &
                        -(int64_t)(m[i] > d[i - 1]) & -(int64_t)(m[i] > d[i + 1]);
    for (size_t i = 0; i < n; i++)
        any |= above[i];
    return any;
}

/* Does the same for one point of any column, the ends included. */
static bool is_summit(const double *u, const double *m, const double *d, size_t nx, bool corners,
                      size_t i) {
    size_t left = i != 0 ? i - 1 : nx - 1, right = i + 1 < nx ? i + 1 : 0;
    double z = m[i];
    if (!(z > m[left] && z > m[right]))
        return false;
    if (u == NULL)
        return true;
    if (!(z > u[i] && z > d[i]))
        return false;
    return !corners || (z > u[left] && z > u[right] && z > d[left] && z > d[right]);
}

size_t row_summits(const double *up, const double *middle, const double *down, size_t nx,
                   bool corners, size_t *columns) {
    size_t found = 0;
    int64_t above[BLOCK];
    if (is_summit(up, middle, down, nx, corners, 0))
        columns[found++] = 0;
    for (size_t i = 1; i + 1 < nx; i += BLOCK) {
        size_t n = nx - 1 - i < BLOCK ? nx - 1 - i : BLOCK;
        if (compare_block(up != NULL ? up + i : NULL, middle + i, down != NULL ? down + i : NULL,
                          corners, n, above) == 0)
            continue;
        for (size_t k = 0; k < n; k++)
            if (above[k] != 0)
                columns[found++] = i + k;
    }
    if (is_summit(up, middle, down, nx, corners, nx - 1))
        columns[found++] = nx - 1;
    return found;
}
