#include "core/statistics/heights/areal.h"
#include "core/statistics/lanes.h"
#include "core/vectors.h"
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

/* Points are numbered by 32 bits, as the largest maps that are read have 2^31 of them. */
static const uint32_t NONE = UINT32_MAX;

enum { WHOLE = 1, SADDLE = 2 }; /* marks of points */
enum { TOGETHER = 64 };         /* points of a row that are looked at at once */

/* A point that has neighbours of other hills above it. */
struct saddle {
    double z;
    uint32_t at;
    uint32_t others; /* a bit each of these neighbours, in the order of neighbours_of() */
};

struct search {
    const struct measured_map *map;
    uint32_t *parent;          /* owned: the highest neighbour; a peak is its own parent */
    struct saddle *saddles;    /* owned, highest first */
    size_t count;              /* of them */
    unsigned char *whole;      /* owned: WHOLE of points with all neighbours, SADDLE */
    struct summit_list *peaks; /* borrowed; NULL: not wanted */
    struct average bends;      /* of the peaks that count */
};

/* Of equal points the first one is above. A hole is above nothing, and nothing is above it. */
static inline bool is_above(const double *z, uint32_t s, uint32_t t) {
    return z[s] > z[t] || (z[s] == z[t] && s < t);
}

/* Returns a number that falls as the height rises, and is the same for equal heights. */
static uint64_t falling_key(double z) {
    static const uint64_t SIGN = (uint64_t)1 << 63;
    uint64_t bits;
    z += 0.0; /* -0 becomes 0 */
    memcpy(&bits, &z, sizeof bits);
    return (bits & SIGN) != 0 ? bits : ~bits & ~SIGN;
}

/* Sorts saddles by height, highest first; those of one height keep their order. By digits of the
 * height, the least first: each pass keeps the order of the one before. spare: as many saddles. */
static void saddles_sort(struct saddle *saddles, struct saddle *spare, size_t count) {
    enum { BITS = 8, DIGITS = 1 << BITS, PASSES = 64 / BITS };
    size_t first[PASSES][DIGITS] = {{0}};
    for (size_t n = 0; n < count; n++)
        for (size_t p = 0; p < PASSES; p++)
            first[p][falling_key(saddles[n].z) >> (BITS * p) & (DIGITS - 1)]++;
    for (size_t p = 0; p < PASSES; p++) {
        size_t total = 0;
        for (size_t d = 0; d < DIGITS; d++) {
            size_t here = first[p][d];
            first[p][d] = total;
            total += here;
        }
        for (size_t n = 0; n < count; n++)
            spare[first[p][falling_key(saddles[n].z) >> (BITS * p) & (DIGITS - 1)]++] = saddles[n];
        struct saddle *sorted = spare;
        spare = saddles;
        saddles = sorted;
    }
}

static void search_clear(struct search *s) {
    free(s->saddles);
    free(s->parent);
    free(s->whole);
}

static int search_create(struct search *s, const struct measured_map *map, struct error *err) {
    size_t points = grid_points(map->grid);
    if (points >= NONE)
        return error_set(err, ERROR_INPUT, "hills of %zu points; allowed: fewer than 2^32 - 1",
                         points);
    *s = (struct search){.map = map,
                         .parent = array_create(points, sizeof *s->parent),
                         .whole = array_create(points, 1)};
    if (s->parent == NULL || s->whole == NULL) {
        search_clear(s);
        return error_memory(err, points * (sizeof *s->parent + 1), "hills");
    }
    return 0;
}

/* Returns the peak of the hill that a point belongs to (Tarjan 1975). */
static uint32_t peak_of(uint32_t *parent, uint32_t at) {
    while (parent[at] != at) {
        parent[at] = parent[parent[at]];
        at = parent[at];
    }
    return at;
}

static int peak_count(struct search *s, uint32_t peak, struct error *err) {
    const struct grid *grid = s->map->grid;
    long i = (long)(peak % grid->nx), j = (long)(peak / grid->nx);
    double dx = grid_dx(grid), dy = grid_dy(grid), z = s->map->z[peak];
    if ((s->whole[peak] & WHOLE) == 0)
        return 0;
    double xx = map_height(s->map, i - 1, j) - 2 * z + map_height(s->map, i + 1, j);
    double yy = map_height(s->map, i, j - 1) - 2 * z + map_height(s->map, i, j + 1);
    double bend = -(xx / (dx * dx) + yy / (dy * dy)) / 2;
    const struct summit summit = {(double)i * dx, (double)j * dy, z, bend};
    average_add(&s->bends, bend);
    return s->peaks != NULL ? summit_list_add(s->peaks, &summit, err) : 0;
}

/* Returns the number of a neighbour; NONE beside an open map. */
static uint32_t neighbour(const struct measured_map *map, long i, long j) {
    long nx = (long)map->grid->nx, ny = (long)map->grid->ny;
    if (map->boundary == BOUNDARY_OPEN && (i < 0 || i >= nx || j < 0 || j >= ny))
        return NONE;
    return (uint32_t)((j + ny) % ny * nx + (i + nx) % nx);
}

/* Fills the numbers of the 8 points around one; NONE beside an open map. */
static void neighbours_of(const struct measured_map *map, uint32_t at, uint32_t *beside) {
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

/* The highest point so far, and how far it is in numbers. */
struct highest {
    double z, step;
};
static inline void highest_take(struct highest *highest, double z, double step) {
    highest->step = z > highest->z ? step : highest->step;
    highest->z = z > highest->z ? z : highest->z;
}

/* Of n points inside of a row, fills how far the highest neighbour is, in numbers; 0 of peaks. Of
 * equal points it is the first one. A plain loop, so that the compiler makes vectors of it. */
WIDE_VECTORS static void steps_fill(const double *restrict row, size_t nx, size_t n,
                                    double *restrict step) {
    const double *up = row - nx, *down = row + nx;
    const double width = (double)nx;
    for (size_t i = 0; i < n; i++) {
        struct highest highest = {-INFINITY, 0};
        highest_take(&highest, (up - 1)[i], -width - 1);
        highest_take(&highest, up[i], -width);
        highest_take(&highest, up[i + 1], 1 - width);
        highest_take(&highest, (row - 1)[i], -1);
        bool above = highest.z >= row[i];
        highest.step = above ? highest.step : 0;
        highest.z = above ? highest.z : row[i];
        highest_take(&highest, row[i + 1], 1);
        highest_take(&highest, (down - 1)[i], width - 1);
        highest_take(&highest, down[i], width);
        highest_take(&highest, down[i + 1], width + 1);
        step[i] = highest.step;
    }
}

static uint32_t highest_neighbour(const struct measured_map *map, uint32_t at) {
    uint32_t beside[8], highest = at;
    neighbours_of(map, at, beside);
    for (int n = 0; n < 8; n++)
        if (beside[n] != NONE && is_above(map->z, beside[n], highest))
            highest = beside[n];
    return highest;
}

/* Every point climbs to its highest neighbour, ... */
static void row_climb(struct search *s, size_t j) {
    const size_t nx = s->map->grid->nx, ny = s->map->grid->ny, at = j * nx;
    bool inside = j > 0 && j + 1 < ny;
    for (size_t i = 0; i < nx; i++)
        if (!inside || i == 0 || i + 1 == nx)
            s->parent[at + i] = highest_neighbour(s->map, (uint32_t)(at + i));
    for (size_t i = 1; inside && i + 1 < nx; i += TOGETHER) {
        double step[TOGETHER];
        size_t n = nx - 1 - i < TOGETHER ? nx - 1 - i : TOGETHER;
        steps_fill(s->map->z + at + i, nx, n, step);
        for (size_t k = 0; k < n; k++)
            s->parent[at + i + k] = (uint32_t)((int64_t)(at + i + k) + (int64_t)step[k]);
    }
}

/* Fills, of n points inside of a row, non-zero where any of the 8 around one belongs to another
 * hill; parents are peaks. */
WIDE_VECTORS static void others_fill(const uint32_t *restrict row, size_t nx, size_t n,
                                     uint32_t *restrict others) {
    const uint32_t *up = row - nx, *down = row + nx;
    for (size_t i = 0; i < n; i++)
        others[i] = ((up - 1)[i] ^ row[i]) | (up[i] ^ row[i]) | (up[i + 1] ^ row[i]) |
                    ((row - 1)[i] ^ row[i]) | (row[i + 1] ^ row[i]) | ((down - 1)[i] ^ row[i]) |
                    (down[i] ^ row[i]) | (down[i + 1] ^ row[i]);
}

/* ... and so to a peak. Where neighbours above it climb to other peaks, it is a saddle. Returns a
 * bit for each of them, in the order of neighbours_of(). */
static uint32_t others_above(const struct search *s, uint32_t at) {
    uint32_t beside[8], others = 0;
    neighbours_of(s->map, at, beside);
    for (int n = 0; n < 8; n++)
        if (beside[n] != NONE && s->parent[beside[n]] != s->parent[at] &&
            is_above(s->map->z, beside[n], at))
            others |= (uint32_t)1 << n;
    return others;
}

/* Marks the saddles of a row; returns how many. */
static size_t saddles_mark(struct search *s, size_t j) {
    const size_t nx = s->map->grid->nx, ny = s->map->grid->ny;
    bool inside = j > 0 && j + 1 < ny;
    size_t count = 0;
    for (size_t i = 0; i < nx;) {
        uint32_t others[TOGETHER];
        bool some = inside && i > 0 && i + 1 < nx;
        size_t n = some ? nx - 1 - i < TOGETHER ? nx - 1 - i : TOGETHER : 1;
        others[0] = 1;
        if (some)
            others_fill(s->parent + j * nx + i, nx, n, others);
        for (size_t k = 0; k < n; k++)
            if (others[k] != 0 && others_above(s, (uint32_t)(j * nx + i + k)) != 0) {
                s->whole[j * nx + i + k] |= SADDLE;
                count++;
            }
        i += n;
    }
    return count;
}

static int saddles_list(struct search *s, struct error *err) {
    const uint32_t points = (uint32_t)grid_points(s->map->grid);
    size_t count = 0;
    for (size_t j = 0; j < s->map->grid->ny; j++)
        count += saddles_mark(s, j);
    s->saddles = array_create(count > 0 ? count : 1, 2 * sizeof *s->saddles);
    if (s->saddles == NULL)
        return error_memory(err, 2 * count * sizeof *s->saddles, "saddles between hills");
    for (uint32_t at = 0; at < points; at++)
        if ((s->whole[at] & SADDLE) != 0)
            s->saddles[s->count++] = (struct saddle){s->map->z[at], at, others_above(s, at)};
    saddles_sort(s->saddles, s->saddles + s->count, s->count);
    return 0;
}

static int climb(struct search *s, struct error *err) {
    const uint32_t points = (uint32_t)grid_points(s->map->grid);
    for (size_t j = 0; j < s->map->grid->ny; j++)
        row_climb(s, j);
    for (uint32_t at = 0; at < points; at++)
        s->parent[at] = peak_of(s->parent, at);
    return saddles_list(s, err);
}

/* Joins the hills that meet in a saddle, of which the highest goes on. Neighbours that began on the
 * saddle's own hill are still on it. */
static int saddle_flood(struct search *s, const struct saddle *saddle, double least,
                        struct error *err) {
    const double *z = s->map->z;
    uint32_t beside[8];
    int status = 0;
    neighbours_of(s->map, saddle->at, beside);
    for (int n = 0; n < 8 && status == 0; n++) {
        if ((saddle->others >> n & 1) == 0)
            continue;
        uint32_t here = peak_of(s->parent, saddle->at), there = peak_of(s->parent, beside[n]);
        if (here == there)
            continue;
        bool higher = is_above(z, there, here);
        uint32_t stays = higher ? there : here, ends = higher ? here : there;
        if (z[ends] - saddle->z >= least)
            status = peak_count(s, ends, err);
        s->parent[ends] = stays;
    }
    return status;
}

int hills_find(const struct measured_map *map, double least, struct summit_list *peaks,
               struct hills *out, struct error *err) {
    struct search s;
    int status = search_create(&s, map, err);
    if (status != 0)
        return status;
    size_t searched = map_mark_whole(map, 1, 1, s.whole);
    s.peaks = peaks;
    status = climb(&s, err);
    for (size_t n = 0; n < s.count && status == 0; n++)
        status = saddle_flood(&s, &s.saddles[n], least, err);
    for (uint32_t at = 0; at < grid_points(map->grid) && status == 0; at++)
        if (s.parent[at] == at && !isnan(map->z[at]))
            status =
                peak_count(&s, at, err); /* the highest, and one in each part cut off by holes */
    *out = (struct hills){.count = s.bends.count,
                          .density = (double)s.bends.count / (double)searched /
                                     (grid_dx(map->grid) * grid_dy(map->grid)),
                          .curvature = average_value(&s.bends)};
    search_clear(&s);
    return status;
}

static const double CORRELATION_LEVEL = 0.2, PRUNED_SHARE = 0.05; /* the standard's defaults */

static double mean_size(const struct measured_map *map, double mean) {
    struct average size = {0};
    for (size_t point = 0; point < grid_points(map->grid); point++)
        average_add(&size, fabs(map->z[point] - mean));
    return average_value(&size);
}

/* Returns sqrt(1 + x^2 + y^2) - 1. */
static inline double stretch(double x, double y) {
    double square = x * x + y * y;
    return square / (sqrt(1 + square) + 1);
}

/* Adds n cells of four points, a and b = a + 1 above c and d, whose triangles have these slopes: of
 * each the mean over its corners. */
WIDE_VECTORS static void areas_add(size_t n, const double *a, const double *b, const double *c,
                                   const double *d, double dx, double dy,
                                   struct lanes *restrict lanes) {
    for (size_t l = 0; l < n; l++) {
        double x0 = (b[l] - a[l]) / dx, x1 = (d[l] - c[l]) / dx;
        double y0 = (c[l] - a[l]) / dy, y1 = (d[l] - b[l]) / dy;
        lane_add(lanes, l,
                 (stretch(x0, y0) + stretch(x0, y1) + stretch(x1, y0) + stretch(x1, y1)) / 4);
    }
}

static double developed_area(const struct measured_map *map) {
    const size_t nx = map->grid->nx, ny = map->grid->ny;
    const bool open = map->boundary == BOUNDARY_OPEN;
    double dx = grid_dx(map->grid), dy = grid_dy(map->grid);
    struct lanes lanes = {0};
    struct lane_mean area = {0};
    for (size_t j = 0; j < (open ? ny - 1 : ny); j++) {
        const double *row = map->z + j * nx, *down = map->z + (j + 1 < ny ? j + 1 : 0) * nx;
        for (size_t i = 0; i + 1 < nx; i += LANES)
            areas_add(nx - 1 - i < LANES ? nx - 1 - i : LANES, row + i, row + i + 1, down + i,
                      down + i + 1, dx, dy, &lanes);
        if (!open)
            areas_add(1, row + nx - 1, row, down + nx - 1, down, dx, dy, &lanes);
        lane_mean_add(&area, &lanes);
    }
    return lane_mean_value(&area);
}

int areal_measure(const struct measured_map *map, const struct roughness *roughness,
                  const struct correlation *correlation, struct summit_list *list,
                  struct areal *out, struct error *err) {
    struct hills hills;
    double shortest, longest;
    double highest = roughness->highest - roughness->mean;
    double lowest = roughness->mean - roughness->lowest;
    int status = hills_find(map, PRUNED_SHARE * (highest + lowest), list, &hills, err);
    if (status != 0)
        return status;
    correlation_lengths(correlation, CORRELATION_LEVEL, &shortest, &longest);
    *out = (struct areal){.sa = mean_size(map, roughness->mean),
                          .sq = roughness->rms_height,
                          .ssk = roughness->skewness,
                          .sku = roughness->kurtosis,
                          .sp = highest,
                          .sv = lowest,
                          .sz = highest + lowest,
                          .sdq = roughness->rms_slope,
                          .sdr = developed_area(map),
                          .sal = shortest,
                          .str = shortest / longest,
                          .spd = hills.density,
                          .spc = hills.curvature};
    return 0;
}
