#include "core/statistics/summits/open_refined.h"
#include "core/statistics/summits/local_wave.h"
#include "core/statistics/summits/summit_climb.h"
#include "core/vectors.h"
#include <assert.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

/* The shortest wave that points can show has two of them. */
enum { FINE = 8, FINE_PROFILE = 32, FIRST = LOCAL_HALF - 1 };
enum { TOGETHER = 256 }; /* cells whose fine points are computed at once */

/* Fine points lie off the points, so that no symmetric map has a tie among them. In fine cells. */
static const double SHIFT_X = 0.2371, SHIFT_Y = 0.3119;

struct search {
    const struct measured_map *map;
    const unsigned char *whole;
    size_t fine;               /* fine points a cell */
    size_t cells_x, cells_y;   /* that can be interpolated, from point FIRST on */
    struct local_basis *bases; /* owned, of the fine points of a cell along x, then along y */
    double *across;            /* owned, nx: one row of points moved to a fine row */
    double *memory;            /* owned: three fine rows, fine x cells_x each, ... */
    double *rows[3];           /* ... those before, at and behind the present one */
    size_t *columns;           /* owned, a fine row */
};

static size_t fine_columns(const struct search *s) {
    return s->cells_x * s->fine;
}

static void search_clear(struct search *s) {
    free(s->bases);
    free(s->across);
    free(s->memory);
    free(s->columns);
}

static int search_create(struct search *s, const struct measured_map *map,
                         const unsigned char *whole, struct error *err) {
    const struct grid *grid = map->grid;
    bool profile = grid_is_profile(grid);
    *s = (struct search){.map = map,
                         .whole = whole,
                         .fine = profile ? FINE_PROFILE : FINE,
                         .cells_x = grid->nx - LOCAL_POINTS + 1,
                         .cells_y = profile ? 1 : grid->ny - LOCAL_POINTS + 1};
    size_t row = fine_columns(s);
    s->bases = array_create(2 * s->fine, sizeof *s->bases);
    s->across = array_create(grid->nx, sizeof *s->across);
    s->memory = array_create(row, 3 * sizeof *s->memory);
    s->columns = array_create(row, sizeof *s->columns);
    if (s->bases == NULL || s->across == NULL || s->memory == NULL || s->columns == NULL) {
        search_clear(s);
        return error_memory(err, row * 4 * sizeof *s->memory, "a summit search");
    }
    for (size_t a = 0; a < 3; a++)
        s->rows[a] = s->memory + a * row;
    for (size_t phase = 0; phase < s->fine; phase++) {
        local_basis_at(((double)phase + SHIFT_X) / (double)s->fine, &s->bases[phase]);
        local_basis_at(((double)phase + SHIFT_Y) / (double)s->fine, &s->bases[s->fine + phase]);
    }
    return 0;
}

/* Adds four rows of points with their weights to a row. Plain loops over points, here and below, so
 * that the compiler makes vectors of them. */
WIDE_VECTORS static void rows_weigh(const double *weight, const double *restrict z, size_t nx,
                                    double *restrict across) {
    const double *second = z + nx, *third = second + nx, *fourth = third + nx;
    for (size_t i = 0; i < nx; i++)
        across[i] = across[i] + weight[0] * z[i] + weight[1] * second[i] + weight[2] * third[i] +
                    weight[3] * fourth[i];
}

/* Two sums of four points with their weights. */
struct weighed {
    double first, second;
};
static inline struct weighed eight_weigh(const double *weight, const double *z) {
    return (struct weighed){
        (weight[0] * z[0] + weight[1] * z[1]) + (weight[2] * z[2] + weight[3] * z[3]),
        (weight[4] * z[4] + weight[5] * z[5]) + (weight[6] * z[6] + weight[7] * z[7])};
}

/* Fills out with the fine points at one position in each cell, half of the weights after the other.
 */
WIDE_VECTORS static void phase_fill(const double *restrict weight, const double *restrict points,
                                    size_t cells, double *restrict out) {
    static_assert(LOCAL_POINTS == 16, "two halves of eight points");
    for (size_t cell = 0; cell < cells; cell++) {
        struct weighed some = eight_weigh(weight, points + cell);
        out[cell] = some.first + some.second;
    }
    for (size_t cell = 0; cell < cells; cell++) {
        struct weighed some = eight_weigh(weight + 8, points + 8 + cell);
        out[cell] = out[cell] + some.first + some.second;
    }
}

/* Fills the fine points of some cells of a row, which stay in the first cache. */
static void cells_fill(const struct search *s, size_t first, size_t cells, double *out) {
    for (size_t phase = 0; phase < s->fine; phase++)
        phase_fill(s->bases[phase].value, s->across + first, cells,
                   out + phase * s->cells_x + first);
}

/* Fills a fine row. */
static void row_fill(const struct search *s, size_t fine_row, double *out) {
    size_t nx = s->map->grid->nx, first = fine_row / s->fine;
    const double *z = s->map->z;
    if (grid_is_profile(s->map->grid))
        memcpy(s->across, z, nx * sizeof *z);
    else {
        const double *weight = s->bases[s->fine + fine_row % s->fine].value;
        memset(s->across, 0, nx * sizeof *z);
        for (size_t a = 0; a < LOCAL_POINTS; a += 4)
            rows_weigh(weight + a, z + (first + a) * nx, nx, s->across);
    }
    for (size_t cell = 0; cell < s->cells_x; cell += TOGETHER)
        cells_fill(s, cell, s->cells_x - cell < TOGETHER ? s->cells_x - cell : TOGETHER, out);
}

/* Interpolates at a position in fine cells; NaN outside of the cells that can be interpolated. */
static void jet_at(const void *surface, double x, double y, struct climb_cell *cell,
                   struct jet *jet) {
    const struct search *s = surface;
    const struct grid *grid = s->map->grid;
    const double fine = (double)s->fine, shorter = 1 / fine; /* a power of two: exact */
    bool profile = grid_is_profile(grid);
    double px = (x + SHIFT_X) / fine, py = profile ? 0 : (y + SHIFT_Y) / fine;
    *jet = (struct jet){NAN, NAN, NAN, NAN, NAN, NAN};
    cell_follow(px, &cell->x);
    cell_follow(py, &cell->y);
    if (cell->x < 0 || (size_t)cell->x >= s->cells_x || cell->y < 0 ||
        (size_t)cell->y >= s->cells_y)
        return;
    struct local_basis bx, by = {.value = {1}};
    local_basis_at(px - (double)cell->x, &bx);
    if (!profile)
        local_basis_at(py - (double)cell->y, &by);
    *jet = (struct jet){0};
    for (int b = 0; b < (profile ? 1 : LOCAL_POINTS); b++) {
        const double *row = s->map->z + (size_t)(cell->y + b) * grid->nx + (size_t)cell->x;
        double z = 0, slope = 0, bend = 0;
        for (int a = 0; a < LOCAL_POINTS; a++) {
            z += bx.value[a] * row[a];
            slope += bx.slope[a] * row[a];
            bend += bx.bend[a] * row[a];
        }
        slope *= shorter;
        bend *= shorter * shorter;
        jet->z += by.value[b] * z;
        jet->x += by.value[b] * slope;
        jet->xx += by.value[b] * bend;
        jet->y += by.slope[b] * z * shorter;
        jet->xy += by.slope[b] * slope * shorter;
        jet->yy += by.bend[b] * z * (shorter * shorter);
    }
}

/* Adds the maximum at a position in fine cells where its cell is marked. */
static int summit_add(const struct search *s, double x, double y, const struct jet *jet,
                      struct summit_list *list, struct error *err) {
    const struct grid *grid = s->map->grid;
    bool profile = grid_is_profile(grid);
    double fine = (double)s->fine, dx = grid_dx(grid), dy = profile ? 1 : grid_dy(grid);
    double px = (x + SHIFT_X) / fine + FIRST, py = profile ? 0 : (y + SHIFT_Y) / fine + FIRST;
    if (s->whole[(size_t)py * grid->nx + (size_t)px] == 0)
        return 0;
    double bend = profile ? jet->xx / (dx * dx) : (jet->xx / (dx * dx) + jet->yy / (dy * dy)) / 2;
    struct summit summit = {.x = px * dx,
                            .y = profile ? 0 : py * dy,
                            .height = jet->z,
                            .curvature = -bend * fine * fine};
    return summit_list_add(list, &summit, err);
}

/* Fine points and those beside them; up and down of a profile are those to the left and right. */
struct beside {
    const double *z, *left, *right, *up, *down;
};

static inline double greater(double a, double b) {
    return a > b ? a : b;
}

/* Returns non-zero where any point may be above those beside it: it never misses one, and a hole
 * beside a point does not count. */
WIDE_VECTORS static int64_t any_above(size_t n, struct beside at) {
    int64_t any = 0;
    for (size_t i = 0; i < n; i++) {
        double beside = greater(at.left[i], at.right[i]), across = greater(at.up[i], at.down[i]);
        any |= -(int64_t)(at.z[i] > greater(beside, across));
    }
    return any;
}

static bool is_above(struct beside at, size_t i) {
    return at.z[i] > at.left[i] && at.z[i] > at.right[i] && at.z[i] > at.up[i] &&
           at.z[i] > at.down[i];
}

/* Appends the columns of the maxima among the fine points at one position in n cells, at most
 * TOGETHER. left, right: the points beside the first one. */
static size_t cells_search(const struct search *s, size_t phase, size_t cell, size_t n,
                           const double *left, const double *right, size_t found) {
    const bool profile = grid_is_profile(s->map->grid);
    const size_t at = phase * s->cells_x + cell;
    const struct beside beside = {s->rows[1] + at, left, right, profile ? left : s->rows[0] + at,
                                  profile ? right : s->rows[2] + at};
    if (any_above(n, beside) == 0)
        return found;
    for (size_t i = 0; i < n; i++)
        if (is_above(beside, i))
            s->columns[found++] = (cell + i) * s->fine + phase;
    return found;
}

/* Likewise in all cells. The first position of a cell follows the last one of the cell before; the
 * row counts as periodic. */
static size_t phase_search(const struct search *s, size_t phase, size_t found) {
    const size_t cells = s->cells_x, last = s->fine - 1;
    const double *row = s->rows[1] + phase * cells, *first_row = s->rows[1];
    const double *last_row = s->rows[1] + last * cells;
    const double *left = phase > 0 ? row - cells : last_row - 1;
    const double *right = phase < last ? row + cells : first_row + 1;
    const size_t begin = phase == 0 ? 1 : 0, end = phase == last ? cells - 1 : cells;
    if (begin > 0)
        found = cells_search(s, phase, 0, 1, last_row + cells - 1, right, found);
    for (size_t cell = begin; cell < end; cell += TOGETHER)
        found = cells_search(s, phase, cell, end - cell < TOGETHER ? end - cell : TOGETHER,
                             left + cell, right + cell, found);
    if (end < cells)
        found = cells_search(s, phase, end, 1, left + end, first_row, found);
    return found;
}

/* Searches from the maxima of the middle one of the three rows. */
static int row_search(struct search *s, size_t fine_row, struct summit_list *list,
                      struct error *err) {
    bool profile = grid_is_profile(s->map->grid);
    const struct climb climb = {s, jet_at, profile};
    size_t found = 0;
    for (size_t phase = 0; phase < s->fine; phase++)
        found = phase_search(s, phase, found);
    for (size_t a = 0; a < found; a++) {
        double x, y;
        struct jet jet;
        if (!summit_climb(&climb, (double)s->columns[a], (double)fine_row, &x, &y, &jet))
            continue;
        int status = summit_add(s, x, y, &jet, list, err);
        if (status != 0)
            return status;
    }
    return 0;
}

static int rows_search(struct search *s, struct summit_list *list, struct error *err) {
    size_t rows = s->cells_y * s->fine;
    if (grid_is_profile(s->map->grid)) {
        row_fill(s, 0, s->rows[1]);
        return row_search(s, 0, list, err);
    }
    for (size_t row = 0; row < rows; row++) {
        double *oldest = s->rows[0];
        s->rows[0] = s->rows[1];
        s->rows[1] = s->rows[2];
        s->rows[2] = oldest;
        row_fill(s, row, s->rows[2]);
        int status = row >= 2 ? row_search(s, row - 1, list, err) : 0;
        if (status != 0)
            return status;
    }
    return 0;
}

int open_refined_find(const struct measured_map *map, const unsigned char *whole,
                      struct summit_list *list, struct error *err) {
    const struct grid *grid = map->grid;
    struct search search;
    if (grid->nx < LOCAL_POINTS || (!grid_is_profile(grid) && grid->ny < LOCAL_POINTS))
        return 0;
    int status = search_create(&search, map, whole, err);
    if (status != 0)
        return status;
    status = rows_search(&search, list, err);
    const struct grid fine = {grid->nx * search.fine,
                              grid_is_profile(grid) ? 1 : grid->ny * search.fine, grid->lx,
                              grid->ly};
    if (status == 0)
        summits_merge(&fine, list);
    search_clear(&search);
    return status;
}
