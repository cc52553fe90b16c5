#include "core/statistics/summits/hills.h"
#include "core/sum.h"
#include "core/vectors.h"
#include <stdint.h>
#include <stdlib.h>

/* Points are numbered by 32 bits, as the largest maps that are read have 2^31 of them. */
static const uint32_t NONE = UINT32_MAX;

enum { WHOLE = 1, REACHED = 2, SEEN = 4 }; /* marks: reached now, from an earlier peak */
enum { TOGETHER = 64 };                    /* points of a row that are looked at at once */

struct peak {
    double z;
    uint32_t at;
};

struct search {
    const struct measured_map *map;
    double least;
    unsigned char *mark; /* owned: of each point */
    uint32_t *reached;   /* owned: points reached from a peak, in the order in which they were */
    struct peak *peaks;  /* owned: all, grown as they are found */
    size_t count, room;
};

/* Of equal points the first one is above. A hole is above nothing, and nothing is above it. */
static inline bool is_above(const double *z, uint32_t s, uint32_t t) {
    return z[s] > z[t] || (z[s] == z[t] && s < t);
}

static int highest_first(const void *a, const void *b) {
    const struct peak *s = a, *t = b;
    if (s->z != t->z)
        return s->z > t->z ? -1 : 1;
    return s->at < t->at ? -1 : 1;
}

static void search_clear(struct search *s) {
    free(s->mark);
    free(s->reached);
    free(s->peaks);
}

static int search_create(struct search *s, const struct measured_map *map, double least,
                         struct error *err) {
    size_t points = grid_points(map->grid);
    if (points >= NONE)
        return error_set(err, ERROR_INPUT, "hills of %zu points; allowed: fewer than 2^32 - 1",
                         points);
    *s = (struct search){.map = map,
                         .least = least,
                         .mark = array_create(points, 1),
                         .reached = array_create(points, sizeof *s->reached)};
    if (s->mark == NULL || s->reached == NULL) {
        search_clear(s);
        return error_memory(err, points * (sizeof *s->reached + 1), "hills");
    }
    return 0;
}

/* Returns the number of a neighbour; NONE beside an open map. */
static uint32_t neighbour(const struct measured_map *map, long i, long j) {
    long nx = (long)map->grid->nx, ny = (long)map->grid->ny;
    if (map->boundary == BOUNDARY_OPEN && (i < 0 || i >= nx || j < 0 || j >= ny))
        return NONE;
    return (uint32_t)((j + ny) % ny * nx + (i + nx) % nx);
}

/* Fills the numbers of the 8 points around one; NONE beside an open map. */
static void neighbours_of(const struct measured_map *map, uint32_t at, uint32_t beside[8]) {
    const uint32_t nx = (uint32_t)map->grid->nx, ny = (uint32_t)map->grid->ny;
    const uint32_t i = at % nx, j = at / nx;
    bool inside = i > 0 && i + 1 < nx && j > 0 && j + 1 < ny;
    for (int step = 0, n = 0; step < 9; step++) {
        int x = step % 3 - 1, y = step / 3 - 1;
        if (step == 4)
            continue;
        beside[n++] = inside ? (uint32_t)(at + y * (int64_t)nx + x)
                             : neighbour(map, (long)i + x, (long)j + y);
    }
}

/* --- peaks --- */

static inline double higher(double a, double b) {
    return a > b ? a : b;
}

/* Of n points inside of a row, fills 0 for peaks and holes alone. A plain loop, so that the
 * compiler makes vectors of it. */
WIDE_VECTORS static void slopes_fill(const double *restrict row, size_t nx, size_t n,
                                     double *restrict slope) {
    const double *up = row - nx, *down = row + nx;
    for (size_t i = 0; i < n; i++) {
        double before = higher(higher((up - 1)[i], up[i]), higher(up[i + 1], (row - 1)[i]));
        double after = higher(higher(row[i + 1], (down - 1)[i]), higher(down[i], down[i + 1]));
        slope[i] = (before >= row[i] ? 1. : 0.) + (after > row[i] ? 1. : 0.);
    }
}

static int peak_add(struct search *s, uint32_t at, struct error *err) {
    if (s->count == s->room) {
        size_t room = s->room > 0 ? 2 * s->room : 1024;
        struct peak *peaks = realloc(s->peaks, room * sizeof *peaks);
        if (peaks == NULL)
            return error_memory(err, room * sizeof *peaks, "peaks of hills");
        s->peaks = peaks;
        s->room = room;
    }
    s->peaks[s->count++] = (struct peak){s->map->z[at], at};
    return 0;
}

static bool is_peak(const struct measured_map *map, uint32_t at) {
    uint32_t beside[8];
    neighbours_of(map, at, beside);
    for (int n = 0; n < 8; n++)
        if (beside[n] != NONE && is_above(map->z, beside[n], at))
            return false;
    return true;
}

/* Lists the peaks of a row that have all neighbours. */
static int row_search(struct search *s, size_t j, struct error *err) {
    const size_t nx = s->map->grid->nx, ny = s->map->grid->ny;
    bool inside = j > 0 && j + 1 < ny;
    int status = 0;
    for (size_t i = 0; i < nx && status == 0;) {
        double slope[TOGETHER] = {0};
        bool some = inside && i > 0 && i + 1 < nx;
        size_t n = some ? nx - 1 - i < TOGETHER ? nx - 1 - i : TOGETHER : 1;
        if (some)
            slopes_fill(s->map->z + j * nx + i, nx, n, slope);
        for (size_t k = 0; k < n && status == 0; k++) {
            const size_t at = j * nx + i + k;
            if (slope[k] == 0 && s->mark[at] != 0 && is_peak(s->map, (uint32_t)at))
                status = peak_add(s, (uint32_t)at, err);
        }
        i += n;
    }
    return status;
}

/* --- hills --- */

/* Reaches what lies around a point and less than `least` below the peak; returns whether any of it
 * is above the peak, or was reached from a higher one, from which one of a height above this bound
 * can be reached in turn. */
static bool spread(struct search *s, const struct peak *peak, uint32_t at, size_t *count) {
    const double *z = s->map->z;
    uint32_t beside[8];
    neighbours_of(s->map, at, beside);
    for (int n = 0; n < 8; n++) {
        const uint32_t next = beside[n];
        if (next == NONE || !(peak->z - z[next] < s->least) || (s->mark[next] & REACHED) != 0)
            continue;
        if (is_above(z, next, peak->at) || (s->mark[next] & SEEN) != 0)
            return true;
        s->mark[next] |= REACHED;
        s->reached[(*count)++] = next;
    }
    return false;
}

/* Whether a hill stands out. Peaks come highest first. A point reached from an earlier one lies
 * less than `least` below that one, which is higher than this: so no point is reached twice. */
static bool stands_out(struct search *s, const struct peak *peak) {
    size_t count = 1;
    bool ends = (s->mark[peak->at] & SEEN) != 0;
    if (ends)
        return false;
    s->reached[0] = peak->at;
    s->mark[peak->at] |= REACHED;
    for (size_t n = 0; n < count && !ends; n++)
        ends = spread(s, peak, s->reached[n], &count);
    for (size_t n = 0; n < count; n++)
        s->mark[s->reached[n]] = SEEN;
    return !ends;
}

static struct summit summit_at(const struct measured_map *map, uint32_t at) {
    const struct grid *grid = map->grid;
    long i = (long)(at % grid->nx), j = (long)(at / grid->nx);
    double dx = grid_dx(grid), dy = grid_dy(grid), z = map->z[at];
    double xx = map_height(map, i - 1, j) - 2 * z + map_height(map, i + 1, j);
    double yy = map_height(map, i, j - 1) - 2 * z + map_height(map, i, j + 1);
    return (struct summit){(double)i * dx, (double)j * dy, z,
                           -(xx / (dx * dx) + yy / (dy * dy)) / 2};
}

int hills_find(const struct measured_map *map, double least, struct summit_list *peaks,
               struct hills *out, struct error *err) {
    struct search s;
    struct average bends = {0};
    int status = search_create(&s, map, least, err);
    if (status != 0)
        return status;
    size_t searched = map_mark_whole(map, 1, 1, s.mark);
    const size_t rows = least > 0 ? map->grid->ny : 0; /* a flat map has no hill */
    for (size_t j = 0; j < rows && status == 0; j++)
        status = row_search(&s, j, err);
    if (s.count > 0)
        qsort(s.peaks, s.count, sizeof *s.peaks, highest_first);
    for (size_t n = 0; n < s.count && status == 0; n++)
        if (stands_out(&s, &s.peaks[n])) {
            const struct summit summit = summit_at(map, s.peaks[n].at);
            average_add(&bends, summit.curvature);
            status = peaks != NULL ? summit_list_add(peaks, &summit, err) : 0;
        }
    *out = (struct hills){.count = bends.count,
                          .density = (double)bends.count / (double)searched /
                                     (grid_dx(map->grid) * grid_dy(map->grid)),
                          .curvature = average_value(&bends)};
    search_clear(&s);
    return status;
}
