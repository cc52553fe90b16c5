#include "core/statistics/measured_map.h"
#include "core/vectors.h"
#include <string.h>

/* Turns marks along a row of n into marks of the points whose neighbours from -before to after are
 * marked; meanwhile the new mark is the second bit. */
static void row_erode(unsigned char *mark, size_t n, size_t before, size_t after, bool periodic) {
    const size_t reach = before + after + 1;
    size_t run = 0, at = 0, middle = n - after % n;
    /* `run` marks in a row end at the point that is looked at; of a periodic row as many points
     * more are looked at, first, as a run needs. */
    for (size_t visit = 0; visit < (periodic ? reach + n : n); visit++, at++, middle++) {
        at = at < n ? at : 0;
        middle = middle < n ? middle : 0;
        run = (mark[at] & 1) != 0 ? run + 1 : 0;
        if (run >= reach && (!periodic || visit >= reach))
            mark[middle] |= 2;
    }
    for (at = 0; at < n; at++)
        mark[at] = mark[at] >> 1;
}

/* Keeps the second bit where the first one of the other row is set. */
WIDE_VECTORS static void keep_beside(size_t nx, const unsigned char *other, unsigned char *row) {
    for (size_t i = 0; i < nx; i++)
        row[i] &= (unsigned char)((other[i] & 1) << 1 | 1);
}

/* The same along all columns. */
static void columns_erode(unsigned char *mark, size_t nx, size_t ny, size_t before, size_t after,
                          bool periodic) {
    for (size_t j = 0; j < ny; j++) {
        if (!periodic && (j < before || j + after >= ny))
            continue;
        unsigned char *row = mark + j * nx;
        for (size_t i = 0; i < nx; i++)
            row[i] |= (unsigned char)(row[i] << 1);
        for (size_t k = 0; k <= before + after; k++)
            keep_beside(nx, mark + (j + ny - before % ny + k) % ny * nx, row);
    }
    for (size_t point = 0; point < nx * ny; point++)
        mark[point] = mark[point] >> 1;
}

/* Returns whether any height is missing: a sum of values times 0 is NaN where one of them is. */
WIDE_VECTORS static bool has_holes(size_t n, const double *z) {
    enum { LANES = 16 };
    size_t whole = n - n % LANES;
    double faults[LANES] = {0};
    for (size_t i = 0; i < whole; i += LANES)
        for (size_t l = 0; l < LANES; l++)
            faults[l] += 0 * z[i + l];
    for (size_t i = whole; i < n; i++)
        faults[0] += 0 * z[i];
    for (size_t l = 1; l < LANES; l++)
        faults[0] += faults[l];
    return isnan(faults[0]);
}

/* Of a map without holes all points are marked but those near the sides of an open one. */
static size_t inside_mark(const struct measured_map *map, size_t before, size_t after,
                          unsigned char *whole) {
    size_t nx = map->grid->nx, ny = map->grid->ny, reach = before + after;
    bool open = map->boundary == BOUNDARY_OPEN, profile = grid_is_profile(map->grid);
    if (!open) {
        memset(whole, 1, nx * ny);
        return nx * ny;
    }
    size_t columns = nx > reach ? nx - reach : 0, rows = profile ? ny : ny > reach ? ny - reach : 0;
    memset(whole, 0, nx * ny);
    for (size_t j = 0; j < rows && columns > 0; j++)
        memset(whole + (j + (profile ? 0 : before)) * nx + before, 1, columns);
    return rows * columns;
}

size_t map_mark_whole(const struct measured_map *map, size_t before, size_t after,
                      unsigned char *whole) {
    size_t nx = map->grid->nx, ny = map->grid->ny, count = 0;
    bool periodic = map->boundary == BOUNDARY_PERIODIC;
    if (!has_holes(nx * ny, map->z))
        return inside_mark(map, before, after, whole);
    for (size_t point = 0; point < nx * ny; point++)
        whole[point] = (unsigned char)(isnan(map->z[point]) ? 0 : 1);
    for (size_t j = 0; j < ny; j++)
        row_erode(whole + j * nx, nx, before, after, periodic);
    if (!grid_is_profile(map->grid))
        columns_erode(whole, nx, ny, before, after, periodic);
    for (size_t point = 0; point < nx * ny; point++)
        count += whole[point];
    return count;
}
