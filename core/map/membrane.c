#include "core/map/membrane.h"
#include "core/map/membrane_levels.h"
#include <math.h>
#include <stdlib.h>

/* Conjugate gradients end where the error has fallen to this, in the norm of the membrane's energy
 * and of what one cycle of the levels takes for it. */
static const double ACCURACY = 1e-12;
/* Where rounding lets it fall no further, this is enough. */
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

/* Sets up the equations of the holes: number[point] is that of a hole. base: a height that is taken
 * from all, against rounding. */
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

/* The levels applied to the residual; returns their product. */
static double precondition(struct membrane *m) {
    struct membrane_level *level = &m->levels[0];
    for (size_t a = 0; a < level->count; a++)
        level->right[a] = m->residual[a];
    membrane_cycle(m->levels, m->level_count);
    return dot(m->residual, level->solution, level->count);
}

/* Conjugate gradients for the heights, from 0; the residual is the right side at first. */
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
