#include "core/statistics/measured_map.h"

/* Turns marks along a line of n into marks of the points whose neighbours from -before to after are
 * marked; meanwhile the new mark is the second bit. */
static void line_erode(unsigned char *mark, size_t n, size_t step, size_t before, size_t after,
                       bool periodic) {
    size_t reach = before + after + 1, run = 0;
    if (n == 0)
        return;
    /* `run` marks in a row end at the point that is looked at; of a periodic line as many points
     * more are looked at, first, as a run needs. */
    for (size_t visit = 0; visit < (periodic ? reach + n : n); visit++) {
        size_t at = visit % n;
        run = (mark[at * step] & 1) != 0 ? run + 1 : 0;
        if (run < reach || (periodic && visit < reach))
            continue;
        size_t middle = (at + n - after % n) % n;
        mark[middle * step] |= 2;
    }
    for (size_t at = 0; at < n; at++)
        mark[at * step] = mark[at * step] >> 1;
}

size_t map_mark_whole(const struct measured_map *map, size_t before, size_t after,
                      unsigned char *whole) {
    size_t nx = map->grid->nx, ny = map->grid->ny, count = 0;
    bool periodic = map->boundary == BOUNDARY_PERIODIC;
    for (size_t point = 0; point < nx * ny; point++)
        whole[point] = (unsigned char)(isnan(map->z[point]) ? 0 : 1);
    for (size_t j = 0; j < ny; j++)
        line_erode(whole + j * nx, nx, 1, before, after, periodic);
    for (size_t i = 0; i < nx && !grid_is_profile(map->grid); i++)
        line_erode(whole + i, ny, nx, before, after, periodic);
    for (size_t point = 0; point < nx * ny; point++)
        count += whole[point];
    return count;
}
