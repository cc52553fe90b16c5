#include "core/statistics/uncertainty/cell_heights.h"
#include "core/vectors.h"
#include <math.h>
#include <stdint.h>
#include <stdlib.h>

enum { POINTS_A_LAG = 4 };

/* The lag in points, the distances that it is, and how far apart the points are that are taken. */
struct lag {
    long x, y, every_x, every_y;
    double length_x, length_y;
};

static struct lag lag_make(const struct grid *grid, size_t points) {
    bool profile = grid_is_profile(grid);
    double ratio = profile ? 0 : grid_dx(grid) / grid_dy(grid);
    struct lag lag = {.x = (long)points, .y = lround((double)points * ratio)};
    lag.y = profile ? 0 : lag.y > 1 ? lag.y : 1;
    lag.every_x = lag.x > POINTS_A_LAG ? lag.x / POINTS_A_LAG : 1;
    lag.every_y = lag.y > POINTS_A_LAG ? lag.y / POINTS_A_LAG : 1;
    lag.length_x = (double)lag.x * grid_dx(grid);
    lag.length_y = profile ? 1 : (double)lag.y * grid_dy(grid);
    return lag;
}

/* Rows of heights, NULL beside an open map. */
struct rows {
    const double *middle, *up, *down;
};

static const double *row_at(const struct measured_map *map, long j) {
    long ny = (long)map->grid->ny;
    bool inside = j >= 0 && j < ny;
    if (!inside && map->boundary == BOUNDARY_OPEN)
        return NULL;
    return map->z + (size_t)((j % ny + ny) % ny) * map->grid->nx;
}

/* left, right: columns a lag before and behind column i. */
static void difference_add(const struct rows *rows, size_t i, size_t left, size_t right,
                           const struct lag *lag, size_t cell, struct cell_differences *out) {
    double z = rows->middle[i], ahead = rows->middle[right];
    double slope_x = (ahead - z) / lag->length_x;
    double bend_x = (ahead - 2 * z + rows->middle[left]) / (lag->length_x * lag->length_x);
    double slope_y = 0, bend_y = 0;
    if (lag->y > 0) {
        double down = rows->down[i];
        slope_y = (down - z) / lag->length_y;
        bend_y = (down - 2 * z + rows->up[i]) / (lag->length_y * lag->length_y);
    }
    if (isnan(bend_x + bend_y))
        return;
    double slope = slope_x * slope_x + slope_y * slope_y;
    double curvature = lag->y > 0 ? (bend_x + bend_y) / 2 : bend_x;
    out->count[cell]++;
    out->slope[cell] += slope;
    out->bend[cell] += bend_x * bend_x + bend_y * bend_y;
    out->curvature[cell] += curvature * curvature;
    out->area[cell] += sqrt(1 + slope);
}

enum { TOGETHER = 64 };

/* What some points add to the sums of their cell; 0 where a height is missing. */
struct parts {
    double count[TOGETHER], slope[TOGETHER], bend[TOGETHER], curvature[TOGETHER], area[TOGETHER];
};

/* What difference_add adds, of n points of a surface from column i on, at most TOGETHER. */
WIDE_VECTORS static void parts_fill(struct rows rows, size_t i, size_t n, struct lag lag,
                                    struct parts *restrict parts) {
    const double *middle = rows.middle + i, *left = middle - lag.x, *right = middle + lag.x;
    const double *above = rows.up + i, *below = rows.down + i;
    double lx = lag.length_x, ly = lag.length_y;
    for (size_t l = 0; l < n; l++) {
        double z = middle[l], ahead = right[l], down = below[l];
        double slope_x = (ahead - z) / lx, bend_x = (ahead - 2 * z + left[l]) / (lx * lx);
        double slope_y = (down - z) / ly, bend_y = (down - 2 * z + above[l]) / (ly * ly);
        double all = bend_x + bend_y;
        bool there = all == all;
        double slope = slope_x * slope_x + slope_y * slope_y, curvature = (bend_x + bend_y) / 2;
        parts->count[l] = there ? 1 : 0;
        parts->slope[l] = there ? slope : 0;
        parts->bend[l] = there ? bend_x * bend_x + bend_y * bend_y : 0;
        parts->curvature[l] = there ? curvature * curvature : 0;
        parts->area[l] = there ? sqrt(1 + slope) : 0;
    }
}

/* Adds, in their order, columns first .. end - 1 of a surface, every one of which is taken and has
 * its neighbours inside of the row. */
static void columns_add(const struct rows *rows, size_t first, size_t end, const struct lag *lag,
                        size_t cell, struct cell_differences *out) {
    double count = 0, area = out->area[cell], slope = out->slope[cell], bend = out->bend[cell];
    double curvature = out->curvature[cell];
    for (size_t i = first; i < end; i += TOGETHER) {
        struct parts parts;
        size_t n = end - i < TOGETHER ? end - i : TOGETHER;
        parts_fill(*rows, i, n, *lag, &parts);
        for (size_t l = 0; l < n; l++) {
            count += parts.count[l];
            slope += parts.slope[l];
            bend += parts.bend[l];
            curvature += parts.curvature[l];
            area += parts.area[l];
        }
    }
    out->count[cell] += count;
    out->slope[cell] = slope;
    out->bend[cell] = bend;
    out->curvature[cell] = curvature;
    out->area[cell] = area;
}

static void row_add(const struct measured_map *map, const struct low_modes *modes,
                    const struct rows *rows, size_t first_cell, const struct lag *lag,
                    struct cell_differences *out) {
    bool open = map->boundary == BOUNDARY_OPEN, together = lag->every_x == 1 && lag->y > 0;
    long nx = (long)map->grid->nx;
    long begin = open ? lag->x : 0, end = open ? nx - lag->x : nx;
    begin = (begin + lag->every_x - 1) / lag->every_x * lag->every_x;
    size_t cell = 0, next = cell_begin(1, modes->cells_x, (size_t)nx);
    for (long i = begin; i < end;) {
        while ((size_t)i >= next)
            next = cell_begin(++cell + 1, modes->cells_x, (size_t)nx);
        long left = i - lag->x, right = i + lag->x;
        if (together && left >= 0 && right < nx) {
            long last = nx - lag->x < (long)next ? nx - lag->x : (long)next;
            columns_add(rows, (size_t)i, (size_t)last, lag, first_cell + cell, out);
            i = last;
            continue;
        }
        difference_add(rows, (size_t)i, (size_t)(left < 0 ? left + nx : left),
                       (size_t)(right >= nx ? right - nx : right), lag, first_cell + cell, out);
        i += lag->every_x;
    }
}

/* --- squares --- */

/* What some squares add to the sums of their cell; 0 where a height is missing. */
struct square_parts {
    double count[TOGETHER], gradient[TOGETHER], along[TOGETHER], across[TOGETHER];
};

/* Of n squares, at most TOGETHER, whose corners are z and ahead above down and corner. */
WIDE_VECTORS static void squares_fill(size_t n, const double *z, const double *ahead,
                                      const double *down, const double *corner, struct lag lag,
                                      struct square_parts *restrict parts) {
    for (size_t l = 0; l < n; l++) {
        double x = (ahead[l] - z[l] + corner[l] - down[l]) / (2 * lag.length_x);
        double y = (down[l] - z[l] + corner[l] - ahead[l]) / (2 * lag.length_y);
        bool there = x + y == x + y;
        parts->count[l] = there ? 1 : 0;
        parts->gradient[l] = there ? x * x + y * y : 0;
        parts->along[l] = there ? x * x - y * y : 0;
        parts->across[l] = there ? 2 * x * y : 0;
    }
}

/* Adds, in their order, n squares of one cell, the first corner of which is column i, and the one
 * ahead of that column `ahead`. */
static void squares_add(const struct rows *rows, size_t i, size_t ahead, size_t n,
                        const struct lag *lag, size_t cell, struct cell_differences *out) {
    for (size_t done = 0; done < n; done += TOGETHER) {
        struct square_parts parts;
        const size_t at = i + done, beside = ahead + done;
        const size_t some = n - done < TOGETHER ? n - done : TOGETHER;
        squares_fill(some, rows->middle + at, rows->middle + beside, rows->down + at,
                     rows->down + beside, *lag, &parts);
        for (size_t l = 0; l < some; l++) {
            out->squares[cell] += parts.count[l];
            out->gradient[cell] += parts.gradient[l];
            out->along[cell] += parts.along[l];
            out->across[cell] += parts.across[l];
        }
    }
}

/* Adds the squares between two rows, of which the cells are those from first_cell on. */
static void squares_between(const struct measured_map *map, const struct low_modes *modes,
                            const struct rows *rows, size_t first_cell, const struct lag *lag,
                            struct cell_differences *out) {
    const size_t nx = map->grid->nx, wide = (size_t)lag->x, whole = nx - wide;
    const size_t end = map->boundary == BOUNDARY_OPEN ? whole : nx;
    for (size_t i = 0; i < end;) {
        const size_t middle = (i + wide / 2) % nx, cell = cell_of(middle, modes->cells_x, nx);
        const size_t in_cell = cell_begin(cell + 1, modes->cells_x, nx) - middle;
        const size_t in_row = (i < whole ? whole : nx) - i;
        const size_t n = in_cell < in_row ? in_cell : in_row;
        squares_add(rows, i, (i + wide) % nx, n, lag, first_cell + cell, out);
        i += n;
    }
}

void cell_differences_measure(const struct measured_map *map, const struct low_modes *modes,
                              size_t lag, struct cell_differences *out) {
    const struct lag steps = lag_make(map->grid, lag);
    *out = (struct cell_differences){0};
    if (lag >= map->grid->nx)
        return;
    for (long j = 0; j < (long)map->grid->ny; j += steps.every_y) {
        struct rows rows = {row_at(map, j), row_at(map, j - steps.y), row_at(map, j + steps.y)};
        size_t cell = cell_of((size_t)j, modes->cells_y, map->grid->ny) * modes->cells_x;
        if (rows.up != NULL && rows.down != NULL)
            row_add(map, modes, &rows, cell, &steps, out);
    }
    for (long j = 0; j < (long)map->grid->ny; j++) {
        const struct rows rows = {.middle = row_at(map, j), .down = row_at(map, j + steps.y)};
        const size_t middle = (size_t)(j + steps.y / 2) % map->grid->ny;
        if (rows.down != NULL)
            squares_between(map, modes, &rows,
                            cell_of(middle, modes->cells_y, map->grid->ny) * modes->cells_x, &steps,
                            out);
    }
}

/* Heights are first counted in many equal bins, REACH standard deviations to either side of their
 * mean, of which levels then are some of the borders. */
enum { FINE = 65536, REACH = 10 };

struct fine {
    double low, scale; /* of bin 0, and bins a unit of height */
    uint32_t *count;   /* owned, FINE */
    uint16_t *bin;     /* owned, FINE: how many levels lie below */
};

static size_t fine_of(const struct fine *fine, double z) {
    double at = (z - fine->low) * fine->scale;
    return !(at > 0) ? 0 : at >= FINE - 1 ? FINE - 1 : (size_t)at;
}

static void moments_fill(struct cell_heights *h, const struct measured_map *map) {
    struct average mean = {0}, square = {0};
    size_t points = grid_points(map->grid);
    for (size_t point = 0; point < points; point++)
        average_add(&mean, map->z[point]);
    h->mean = average_value(&mean);
    for (size_t point = 0; point < points; point++)
        average_add(&square, (map->z[point] - h->mean) * (map->z[point] - h->mean));
    h->rms = sqrt(average_value(&square));
    h->count = (double)mean.count;
}

/* Looks whether heights are at right angles to both coordinates. */
static void tilt_find(struct cell_heights *h, const struct measured_map *map) {
    static const double ROUNDING = 1e-6;
    double nx = (double)map->grid->nx, ny = (double)map->grid->ny;
    struct sum along_x = {0}, along_y = {0};
    for (size_t j = 0; j < map->grid->ny; j++)
        for (size_t i = 0; i < map->grid->nx; i++) {
            double y = map->z[j * map->grid->nx + i] - h->mean;
            if (isnan(y))
                continue;
            sum_add(&along_x, y * ((double)i / nx));
            sum_add(&along_y, y * ((double)j / ny));
        }
    double limit = ROUNDING * h->rms * h->count;
    h->untilted = fabs(sum_value(&along_x)) <= limit && fabs(sum_value(&along_y)) <= limit;
}

/* Chooses levels midway between the last height of a bin and the first of the next one that has
 * any, where the count first is a multiple of an equal share. */
static void levels_choose(struct cell_heights *h, struct fine *fine) {
    double below = 0;
    size_t wanted = 1;
    for (size_t b = 0; b < FINE; b++) {
        fine->bin[b] = (uint16_t)h->levels;
        below += fine->count[b];
        if (fine->count[b] == 0 || below * (HEIGHT_LEVELS + 1) < (double)wanted * h->count ||
            below >= h->count)
            continue;
        size_t next = b + 1;
        while (fine->count[next] == 0)
            next++;
        h->level[h->levels] = fine->low + (double)(b + 1 + next) / 2 / fine->scale;
        h->share[h->levels++] = below / h->count;
        wanted = (size_t)(below * (HEIGHT_LEVELS + 1) / h->count) + 1;
    }
}

static void height_add(struct cell_heights *h, const struct fine *fine, size_t cell, double z) {
    if (isnan(z))
        return;
    double y = z - h->mean, y2 = y * y;
    h->power[0][cell]++;
    h->power[1][cell] += y;
    h->power[2][cell] += y2;
    h->power[3][cell] += y2 * y;
    h->power[4][cell] += y2 * y2;
    h->size[cell] += fabs(y);
    size_t bin = fine->bin[fine_of(fine, z)];
    if (bin < h->levels)
        h->below[cell * h->levels + bin]++;
}

static void points_add(struct cell_heights *h, const struct measured_map *map,
                       const struct low_modes *modes, const struct fine *fine) {
    const struct grid *grid = map->grid;
    for (size_t j = 0; j < grid->ny; j++)
        for (size_t cx = 0; cx < modes->cells_x; cx++) {
            size_t cell = cell_of(j, modes->cells_y, grid->ny) * modes->cells_x + cx;
            size_t end = cell_begin(cx + 1, modes->cells_x, grid->nx);
            for (size_t i = cell_begin(cx, modes->cells_x, grid->nx); i < end; i++)
                height_add(h, fine, cell, map->z[j * grid->nx + i]);
        }
    for (size_t cell = 0; cell < h->cells; cell++)
        for (size_t l = 1; l < h->levels; l++)
            h->below[cell * h->levels + l] += h->below[cell * h->levels + l - 1];
}

static int arrays_fill(struct cell_heights *h, const struct measured_map *map,
                       const struct low_modes *modes, struct fine *fine, struct error *err) {
    if (h->rms > 0) {
        fine->low = h->mean - REACH * h->rms;
        fine->scale = FINE / (2 * REACH * h->rms);
        for (size_t point = 0; point < grid_points(map->grid); point++)
            if (!isnan(map->z[point]))
                fine->count[fine_of(fine, map->z[point])]++;
        levels_choose(h, fine);
    }
    size_t most = h->levels > 0 ? h->levels : 1;
    h->below = array_create(h->cells * most, sizeof *h->below);
    double *sums = array_create(6 * h->cells, sizeof *sums);
    h->power[0] = sums;
    if (h->below == NULL || sums == NULL)
        return error_memory(err, h->cells * most * sizeof *h->below, "heights by cell");
    for (size_t p = 1; p < 5; p++)
        h->power[p] = sums + p * h->cells;
    h->size = sums + 5 * h->cells;
    points_add(h, map, modes, fine);
    return 0;
}

int cell_heights_create(struct cell_heights **out, const struct measured_map *map,
                        const struct low_modes *modes, struct error *err) {
    struct cell_heights *h = array_create(1, sizeof *h);
    struct fine fine = {.count = array_create(FINE, sizeof *fine.count),
                        .bin = array_create(FINE, sizeof *fine.bin)};
    int status = 0;
    if (h == NULL || fine.count == NULL || fine.bin == NULL)
        status = error_memory(err, FINE * sizeof *fine.count, "counts of heights");
    if (status == 0) {
        h->cells = modes->cells_x * modes->cells_y;
        moments_fill(h, map);
        tilt_find(h, map);
        status = h->count > 0 ? arrays_fill(h, map, modes, &fine, err)
                              : error_set(err, ERROR_INPUT, "the map has no heights, only holes");
    }
    free(fine.count);
    free(fine.bin);
    if (status == 0)
        *out = h;
    else
        cell_heights_destroy(&h);
    return status;
}

void cell_heights_destroy(struct cell_heights **heights) {
    if (*heights == NULL)
        return;
    free((*heights)->below);
    free((*heights)->power[0]);
    free(*heights);
    *heights = NULL;
}
