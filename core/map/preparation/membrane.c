#include "core/map/preparation/membrane.h"
#include "core/surface/grid.h"
#include <math.h>
#include <stdint.h>
#include <stdlib.h>

/* The equations of a membrane on successively coarser points. */

enum { MEMBRANE_SIDES = 4, MEMBRANE_LEVELS_MOST = 40 };
#define MEMBRANE_NONE UINT32_MAX

/* Point a has the equation diagonal[a] u[a] - sum over its sides of weight[d] u[neighbour[d]] =
 * right side. Points stand in rising order of their cells, row by row. */
struct membrane_level {
    size_t nx, ny, count;
    uint32_t *cell_x, *cell_y;             /* owned, count each: where the point lies */
    uint32_t (*neighbour)[MEMBRANE_SIDES]; /* owned: left, right, below, above, or NONE */
    double (*weight)[MEMBRANE_SIDES];      /* owned; 0 where there is no neighbour */
    double *diagonal, *solution, *right;   /* owned */
    uint32_t *parent;                      /* owned: point of the next level; NULL: the last */
};

static void membrane_level_clear(struct membrane_level *level) {
    free(level->cell_x);
    free(level->cell_y);
    free(level->neighbour);
    free(level->weight);
    free(level->diagonal);
    free(level->solution);
    free(level->right);
    free(level->parent);
    *level = (struct membrane_level){0};
}

/* Allocates the arrays of a level but `parent`. */
static int membrane_level_create(struct membrane_level *level, size_t nx, size_t ny, size_t count,
                                 struct error *err) {
    *level = (struct membrane_level){.nx = nx, .ny = ny, .count = count};
    level->cell_x = array_create(count, sizeof *level->cell_x);
    level->cell_y = array_create(count, sizeof *level->cell_y);
    level->neighbour = array_create(count, sizeof *level->neighbour);
    level->weight = array_create(count, sizeof *level->weight);
    level->diagonal = array_create(count, sizeof *level->diagonal);
    level->solution = array_create(count, sizeof *level->solution);
    level->right = array_create(count, sizeof *level->right);
    if (level->cell_x == NULL || level->cell_y == NULL || level->neighbour == NULL ||
        level->weight == NULL || level->diagonal == NULL || level->solution == NULL ||
        level->right == NULL) {
        membrane_level_clear(level);
        return error_memory(err, count * 80, "a membrane over holes");
    }
    for (size_t a = 0; a < count; a++)
        for (size_t d = 0; d < MEMBRANE_SIDES; d++)
            level->neighbour[a][d] = MEMBRANE_NONE;
    return 0;
}

/* Numbers the points of the next level in rising order of their cells; returns how many there are.
 * row: nx/2 + 1 values of scratch. */
static size_t number_parents(struct membrane_level *fine, uint32_t *row) {
    const size_t cells = fine->nx / 2 + 1;
    uint32_t count = 0;
    for (size_t first = 0, last; first < fine->count; first = last) {
        for (size_t c = 0; c < cells; c++)
            row[c] = MEMBRANE_NONE;
        for (last = first; last < fine->count && fine->cell_y[last] / 2 == fine->cell_y[first] / 2;
             last++)
            row[fine->cell_x[last] / 2] = 0;
        for (size_t c = 0; c < cells; c++)
            if (row[c] == 0)
                row[c] = count++;
        for (size_t a = first; a < last; a++)
            fine->parent[a] = row[fine->cell_x[a] / 2];
    }
    return count;
}

static void sum_equations(const struct membrane_level *fine, struct membrane_level *coarse) {
    for (size_t a = 0; a < fine->count; a++) {
        const uint32_t parent = fine->parent[a];
        coarse->cell_x[parent] = fine->cell_x[a] / 2;
        coarse->cell_y[parent] = fine->cell_y[a] / 2;
        coarse->diagonal[parent] += 0.5 * fine->diagonal[a];
        for (size_t d = 0; d < MEMBRANE_SIDES; d++) {
            const uint32_t other = fine->neighbour[a][d];
            if (other == MEMBRANE_NONE)
                continue;
            const double weight = 0.5 * fine->weight[a][d];
            if (fine->parent[other] == parent)
                coarse->diagonal[parent] -= weight;
            else {
                coarse->neighbour[parent][d] = fine->parent[other];
                coarse->weight[parent][d] += weight;
            }
        }
    }
}

/* Makes the next level: the points within two by two cells become one, whose equation is half the
 * sum of theirs. periodic: the first cell of a row or column is a neighbour of the last. */
static int membrane_level_coarsen(struct membrane_level *fine, struct membrane_level *coarse,
                                  struct error *err) {
    uint32_t *row = array_create(fine->nx / 2 + 1, sizeof *row);
    fine->parent = array_create(fine->count, sizeof *fine->parent);
    int status = row != NULL && fine->parent != NULL
                     ? 0
                     : error_memory(err, fine->count * sizeof *row, "a membrane over holes");
    if (status == 0) {
        size_t count = number_parents(fine, row);
        status = membrane_level_create(coarse, (fine->nx + 1) / 2, (fine->ny + 1) / 2, count, err);
    }
    if (status == 0)
        sum_equations(fine, coarse);
    free(row);
    return status;
}

/* Returns the part of a point's equation that is due to its neighbours. */
static double neighbours_sum(const struct membrane_level *level, size_t a) {
    double total = 0;
    for (size_t d = 0; d < MEMBRANE_SIDES; d++)
        if (level->neighbour[a][d] != MEMBRANE_NONE)
            total += level->weight[a][d] * level->solution[level->neighbour[a][d]];
    return total;
}

static void relax(struct membrane_level *level, size_t a) {
    level->solution[a] = (level->right[a] + neighbours_sum(level, a)) / level->diagonal[a];
}

static void descend(const struct membrane_level *fine, struct membrane_level *coarse) {
    for (size_t a = 0; a < coarse->count; a++)
        coarse->right[a] = 0;
    for (size_t a = 0; a < fine->count; a++)
        coarse->right[fine->parent[a]] +=
            fine->right[a] + neighbours_sum(fine, a) - fine->diagonal[a] * fine->solution[a];
}

/* Makes one multigrid cycle: solves levels[0] approximately, from 0, for its right side. It is
 * symmetric, so that it is a preconditioner of conjugate gradients. */
static void membrane_cycle(struct membrane_level *levels, size_t count) {
    for (size_t l = 0; l < count; l++) {
        struct membrane_level *level = &levels[l];
        for (size_t a = 0; a < level->count; a++)
            level->solution[a] = 0;
        for (size_t a = 0; a < level->count; a++)
            relax(level, a);
        if (l + 1 < count)
            descend(level, &levels[l + 1]);
    }
    for (size_t l = count; l-- > 0;) {
        struct membrane_level *level = &levels[l];
        for (size_t a = 0; a < level->count && l + 1 < count; a++)
            level->solution[a] += levels[l + 1].solution[level->parent[a]];
        for (size_t a = level->count; a-- > 0;)
            relax(level, a);
    }
}

/* Conjugate gradients end where the error has fallen to this factor, in the norm of the membrane's
 * energy and in the estimate of it by one multigrid cycle. */
static const double ACCURACY = 1e-12;
/* This accuracy is enough where rounding prevents a better one. */
static const double ACCURACY_LEAST = 1e-9;
enum { STEPS_MOST = 300 };

struct membrane {
    struct membrane_level levels[MEMBRANE_LEVELS_MOST];
    size_t level_count;
    double *height, *residual, *direction, *image; /* owned, one value a hole */
};

static void membrane_destroy(struct membrane **membrane) {
    struct membrane *m = *membrane;
    if (m == NULL)
        return;
    for (size_t l = 0; l < m->level_count; l++)
        membrane_level_clear(&m->levels[l]);
    free(m->height);
    free(m->residual);
    free(m->direction);
    free(m->image);
    free(m);
    *membrane = NULL;
}

/* Returns the point beside (i, j) on side d; SIZE_MAX beyond the side of an open map. */
static size_t beside(const struct grid *grid, enum boundary boundary, size_t i, size_t j,
                     size_t d) {
    const size_t n = d < 2 ? grid->nx : grid->ny;
    const size_t at = d < 2 ? i : j;
    const bool down = d % 2 == 0;
    if (n == 1 || (boundary == BOUNDARY_OPEN && at == (down ? 0 : n - 1)))
        return SIZE_MAX;
    const size_t next = down ? (at + n - 1) % n : (at + 1) % n;
    return d < 2 ? j * grid->nx + next : next * grid->nx + i;
}

/* Sets up the equations of the holes: number[point] is the number of a hole. base: a height that is
 * subtracted from all against rounding. */
static void equations_make(struct membrane *m, const struct grid *grid, const double *z,
                           enum boundary boundary, const uint32_t *number, double base) {
    struct membrane_level *level = &m->levels[0];
    const double ratio = grid_dx(grid) / grid_dy(grid);
    for (size_t point = 0; point < grid_points(grid); point++) {
        if (!isnan(z[point]))
            continue;
        const uint32_t a = number[point];
        const size_t i = point % grid->nx, j = point / grid->nx;
        level->cell_x[a] = (uint32_t)i;
        level->cell_y[a] = (uint32_t)j;
        for (size_t d = 0; d < MEMBRANE_SIDES; d++) {
            const size_t other = beside(grid, boundary, i, j, d);
            if (other == SIZE_MAX)
                continue;
            const double weight = d < 2 ? 1 : ratio * ratio;
            level->diagonal[a] += weight;
            if (isnan(z[other])) {
                level->neighbour[a][d] = number[other];
                level->weight[a][d] = weight;
            } else
                m->residual[a] += weight * (z[other] - base);
        }
    }
}

static int levels_make(struct membrane *m, struct error *err) {
    int status = 0;
    m->level_count = 1;
    while (status == 0 && m->levels[m->level_count - 1].count > 1 &&
           m->level_count < MEMBRANE_LEVELS_MOST) {
        struct membrane_level *fine = &m->levels[m->level_count - 1];
        status = membrane_level_coarsen(fine, fine + 1, err);
        m->level_count++;
    }
    return status;
}

static double dot(const double *a, const double *b, size_t n) {
    double total = 0;
    for (size_t i = 0; i < n; i++)
        total += a[i] * b[i];
    return total;
}

/* image = matrix times direction. */
static void multiply(const struct membrane_level *level, const double *direction, double *image) {
    for (size_t a = 0; a < level->count; a++) {
        double total = level->diagonal[a] * direction[a];
        for (size_t d = 0; d < MEMBRANE_SIDES; d++)
            if (level->neighbour[a][d] != MEMBRANE_NONE)
                total -= level->weight[a][d] * direction[level->neighbour[a][d]];
        image[a] = total;
    }
}

/* Applies a multigrid cycle to the residual; returns the product of result and residual. */
static double precondition(struct membrane *m) {
    struct membrane_level *level = &m->levels[0];
    for (size_t a = 0; a < level->count; a++)
        level->right[a] = m->residual[a];
    membrane_cycle(m->levels, m->level_count);
    return dot(m->residual, level->solution, level->count);
}

/* Solves for the heights by conjugate gradients from 0; the residual is the right side at first. */
static int solve(struct membrane *m, struct error *err) {
    const struct membrane_level *level = &m->levels[0];
    const size_t n = level->count;
    double product = precondition(m), first = product;
    for (size_t a = 0; a < n; a++)
        m->direction[a] = level->solution[a];
    for (int step = 0; step < STEPS_MOST && product > first * ACCURACY * ACCURACY; step++) {
        multiply(level, m->direction, m->image);
        const double length = product / dot(m->direction, m->image, n);
        for (size_t a = 0; a < n; a++) {
            m->height[a] += length * m->direction[a];
            m->residual[a] -= length * m->image[a];
        }
        const double before = product;
        product = precondition(m);
        for (size_t a = 0; a < n; a++)
            m->direction[a] = level->solution[a] + product / before * m->direction[a];
    }
    if (!(product <= first * ACCURACY_LEAST * ACCURACY_LEAST))
        return error_set(err, ERROR_NUMERIC,
                         "the membrane over %zu holes is not found within %d steps", n,
                         (int)STEPS_MOST);
    return 0;
}

static int membrane_create(struct membrane **out, const struct grid *grid, size_t holes,
                           struct error *err) {
    *out = NULL;
    struct membrane *m = array_create(1, sizeof *m);
    if (m == NULL)
        return error_memory(err, sizeof *m, "a membrane over holes");
    m->height = array_create(holes, sizeof *m->height);
    m->residual = array_create(holes, sizeof *m->residual);
    m->direction = array_create(holes, sizeof *m->direction);
    m->image = array_create(holes, sizeof *m->image);
    int status =
        m->height != NULL && m->residual != NULL && m->direction != NULL && m->image != NULL
            ? membrane_level_create(&m->levels[0], grid->nx, grid->ny, holes, err)
            : error_memory(err, holes * 4 * sizeof *m->height, "a membrane over holes");
    m->level_count = status == 0 ? 1 : 0;
    if (status != 0)
        membrane_destroy(&m);
    *out = m;
    return status;
}

int membrane_fill(const struct grid *grid, double *z, enum boundary boundary, struct error *err) {
    const size_t points = grid_points(grid);
    size_t holes = 0;
    double base = 0;
    uint32_t *number = array_create(points, sizeof *number);
    struct membrane *m = NULL;
    if (number == NULL)
        return error_memory(err, points * sizeof *number, "a membrane over holes");
    for (size_t point = 0; point < points; point++)
        if (isnan(z[point]))
            number[point] = (uint32_t)holes++;
        else
            base = z[point];
    int status = holes > 0 ? membrane_create(&m, grid, holes, err) : 0;
    if (status == 0 && holes > 0) {
        equations_make(m, grid, z, boundary, number, base);
        free(number);
        number = NULL;
        status = levels_make(m, err);
        if (status == 0)
            status = solve(m, err);
    }
    for (size_t point = 0, a = 0; point < points && holes > 0 && status == 0; point++)
        if (isnan(z[point]))
            z[point] = base + m->height[a++];
    membrane_destroy(&m);
    free(number);
    return status;
}
