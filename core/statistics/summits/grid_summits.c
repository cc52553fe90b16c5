#include "core/statistics/summits/grid_summits.h"
#include "core/vectors.h"
#include <stdint.h>

enum { BLOCK = 64 }; /* points compared at once before looking for a hit */

/* All ones where z is above the other point, of the mirrored surface where it is below. */
static inline int64_t beats(double z, double other, bool mirrored) {
    return -(int64_t)(mirrored ? z < other : z > other);
}

/* beaten[i] = all ones where m[i] beats its neighbours; returns non-zero when any does. m, u and d
 * are of the second point of a row or a later one. Plain loops of one width, so that the compiler
 * makes vectors of them. */
static inline int64_t compare(const double *u, const double *m, const double *d, bool corners,
                              bool mirrored, size_t n, int64_t *beaten) {
    int64_t any = 0;
    for (size_t i = 0; i < n; i++)
        beaten[i] = beats(m[i], (m - 1)[i], mirrored) & beats(m[i], m[i + 1], mirrored);
    if (u != NULL && d != NULL)
        for (size_t i = 0; i < n; i++)
            beaten[i] &= beats(m[i], u[i], mirrored) & beats(m[i], d[i], mirrored);
    if (u != NULL && d != NULL && corners)
        for (size_t i = 0; i < n; i++)
            beaten[i] &= beats(m[i], (u - 1)[i], mirrored) & beats(m[i], u[i + 1], mirrored) &
                         beats(m[i], (d - 1)[i], mirrored) & beats(m[i], d[i + 1], mirrored);
    for (size_t i = 0; i < n; i++)
        any |= beaten[i];
    return any;
}

WIDE_VECTORS static int64_t compare_block(const double *u, const double *m, const double *d,
                                          bool corners, bool mirrored, size_t n, int64_t *beaten) {
    return mirrored ? compare(u, m, d, corners, true, n, beaten)
                    : compare(u, m, d, corners, false, n, beaten);
}

/* Does the same for one point of any column, the ends included. */
static bool is_summit(const double *u, const double *m, const double *d, size_t nx, bool corners,
                      bool mirrored, size_t i) {
    const size_t left = i != 0 ? i - 1 : nx - 1, right = i + 1 < nx ? i + 1 : 0;
    int64_t beaten = beats(m[i], m[left], mirrored) & beats(m[i], m[right], mirrored);
    if (u != NULL)
        beaten &= beats(m[i], u[i], mirrored) & beats(m[i], d[i], mirrored);
    if (u != NULL && corners)
        beaten &= beats(m[i], u[left], mirrored) & beats(m[i], u[right], mirrored) &
                  beats(m[i], d[left], mirrored) & beats(m[i], d[right], mirrored);
    return beaten != 0;
}

static size_t search(const double *up, const double *middle, const double *down, size_t nx,
                     bool corners, bool mirrored, size_t *columns) {
    size_t found = 0;
    int64_t beaten[BLOCK];
    if (is_summit(up, middle, down, nx, corners, mirrored, 0))
        columns[found++] = 0;
    for (size_t i = 1; i + 1 < nx; i += BLOCK) {
        size_t n = nx - 1 - i < BLOCK ? nx - 1 - i : BLOCK;
        if (compare_block(up != NULL ? up + i : NULL, middle + i, down != NULL ? down + i : NULL,
                          corners, mirrored, n, beaten) == 0)
            continue;
        for (size_t k = 0; k < n; k++)
            if (beaten[k] != 0)
                columns[found++] = i + k;
    }
    if (is_summit(up, middle, down, nx, corners, mirrored, nx - 1))
        columns[found++] = nx - 1;
    return found;
}

size_t row_summits(const double *up, const double *middle, const double *down, size_t nx,
                   bool corners, size_t *columns) {
    return search(up, middle, down, nx, corners, false, columns);
}

size_t row_pits(const double *up, const double *middle, const double *down, size_t nx, bool corners,
                size_t *columns) {
    return search(up, middle, down, nx, corners, true, columns);
}

/* Highest and lowest of a point's neighbours beside, above and below. */
struct near {
    double high, low;
};
static inline double greater(double a, double b) {
    return a > b ? a : b;
}
static inline double lesser(double a, double b) {
    return a < b ? a : b;
}
/* i counts from the second point of a row, so that there is one before the first: m - 1. */
static inline struct near near_beside(const double *m, size_t i) {
    const double *left = m - 1, *right = m + 1;
    return (struct near){greater(left[i], right[i]), lesser(left[i], right[i])};
}
static inline struct near near_cross(const double *u, const double *m, const double *d, size_t i) {
    struct near beside = near_beside(m, i);
    return (struct near){greater(beside.high, greater(u[i], d[i])),
                         lesser(beside.low, lesser(u[i], d[i]))};
}
static inline int64_t is_beyond(double z, struct near near) {
    return beats(z, near.high, false) | beats(z, near.low, true);
}

/* Returns non-zero where any point is above or below all its neighbours but those across. */
WIDE_VECTORS static int64_t any_beyond(const double *u, const double *m, const double *d,
                                       size_t n) {
    int64_t any = 0;
    if (u == NULL || d == NULL)
        for (size_t i = 0; i < n; i++)
            any |= is_beyond(m[i], near_beside(m, i));
    else
        for (size_t i = 0; i < n; i++)
            any |= is_beyond(m[i], near_cross(u, m, d, i));
    return any;
}

/* beyond[i] = all ones where m[i] is above or below all its neighbours. */
WIDE_VECTORS static void find_beyond(const double *u, const double *m, const double *d,
                                     bool corners, size_t n, int64_t *beyond) {
    if (u == NULL || d == NULL)
        for (size_t i = 0; i < n; i++)
            beyond[i] = is_beyond(m[i], near_beside(m, i));
    else if (!corners)
        for (size_t i = 0; i < n; i++)
            beyond[i] = is_beyond(m[i], near_cross(u, m, d, i));
    else
        for (size_t i = 0; i < n; i++) {
            struct near near = near_cross(u, m, d, i), up = near_beside(u, i),
                        down = near_beside(d, i);
            beyond[i] =
                is_beyond(m[i], (struct near){greater(near.high, greater(up.high, down.high)),
                                              lesser(near.low, lesser(up.low, down.low))});
        }
}

static bool is_extreme(const double *u, const double *m, const double *d, size_t nx, bool corners,
                       size_t i) {
    return is_summit(u, m, d, nx, corners, false, i) || is_summit(u, m, d, nx, corners, true, i);
}

size_t row_extremes(const double *up, const double *middle, const double *down, size_t nx,
                    bool corners, size_t *columns) {
    enum { NEAR = 32 };
    size_t found = 0;
    int64_t beyond[NEAR];
    if (is_extreme(up, middle, down, nx, corners, 0))
        columns[found++] = 0;
    for (size_t i = 1; i + 1 < nx; i += NEAR) {
        const double *u = up != NULL ? up + i : NULL, *d = down != NULL ? down + i : NULL;
        size_t n = nx - 1 - i < NEAR ? nx - 1 - i : NEAR;
        if (any_beyond(u, middle + i, d, n) == 0)
            continue;
        find_beyond(u, middle + i, d, corners, n, beyond);
        for (size_t k = 0; k < n; k++)
            if (beyond[k] != 0)
                columns[found++] = i + k;
    }
    if (is_extreme(up, middle, down, nx, corners, nx - 1))
        columns[found++] = nx - 1;
    return found;
}
