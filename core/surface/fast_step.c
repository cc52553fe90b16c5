#include "core/surface/fast_step.h"
#include "core/surface/impose.h"
#include "core/surface/rank_table.h"
#include <math.h>
#include <stdlib.h>

enum { ROWS = 8 }; /* handled together: they fit into the second-level cache up to 16384 points */
/* The range of one step's keys is that of the step before, and so much of it wider on both sides.
 */
static const double WIDER = 1.0 / 16;

struct fast_step {
    const struct modes *modes;
    struct rank_table *table;
    double *block;    /* ROWS x nx: placed heights, then the next iterate */
    double low, high; /* range of the last keys */
};

int fast_step_create(struct fast_step **out, const struct modes *modes, struct error *err) {
    struct fast_step *step = array_create(1, sizeof *step);
    if (step == NULL)
        return error_memory(err, sizeof *step, "a step of generation");
    size_t block = ROWS * modes->grid.nx;
    step->modes = modes;
    step->block = array_create(block, sizeof *step->block);
    int status = step->block != NULL
                     ? rank_table_create(&step->table, grid_points(&modes->grid), err)
                     : error_memory(err, block * sizeof *step->block, "rows");
    if (status != 0)
        fast_step_destroy(&step);
    *out = step;
    return status;
}

void fast_step_destroy(struct fast_step **step) {
    if (*step == NULL)
        return;
    rank_table_destroy(&(*step)->table);
    free((*step)->block);
    free(*step);
    *step = NULL;
}

double fast_step_bytes(const struct grid *grid) {
    return sizeof(struct fast_step) + ROWS * sizeof(double) * (double)grid->nx +
           rank_table_bytes(grid_points(grid));
}

void fast_step_start(struct fast_step *step, const double *z) {
    step->low = step->high = z[0];
    for (size_t i = 0; i < grid_points(&step->modes->grid); i++) {
        step->low = z[i] < step->low ? z[i] : step->low;
        step->high = z[i] > step->high ? z[i] : step->high;
    }
}

/* y from s, in place; x becomes s where there is none yet. */
static void reflect(size_t n, double *z, double *x, bool first) {
    for (size_t i = 0; i < n && first; i++)
        x[i] = z[i];
    for (size_t i = 0; i < n; i++)
        z[i] = 2 * z[i] - x[i];
}

/* Makes all keys y and counts them; of the surfaces s, too, where errors are given. */
static void keys_count(struct fast_step *step, struct transform *transform, struct fast_move move,
                       double *z, double *x, struct height_error *errors) {
    size_t nx = step->modes->grid.nx, ny = step->modes->grid.ny;
    double wider = WIDER * (step->high - step->low);
    rank_table_start(step->table, step->low - wider, step->high + wider);
    for (size_t j = 0; j < ny; j += ROWS) {
        size_t rows = ny - j < ROWS ? ny - j : ROWS;
        transform_inverse_rows(transform, j, rows, z + j * nx);
        if (errors != NULL)
            height_error_heights_add(errors, rows * nx, z + j * nx);
        if (move.kind == FAST_REFLECTION)
            reflect(rows * nx, z + j * nx, x + j * nx, move.first);
        rank_table_count(step->table, rows * nx, z + j * nx);
    }
}

/* The next iterate of n points in the place of their heights h; x as it is kept. s is the mean of x
 * and y. */
static void move_rows(struct fast_move move, size_t n, const double *y, double *h, double *x) {
    double b = move.factor;
    if (move.kind == FAST_REFLECTION)
        for (size_t i = 0; i < n; i++)
            h[i] = x[i] = b * (x[i] + h[i]) + (0.5 - b) * (x[i] + y[i]);
    else
        for (size_t i = 0; i < n; i++) {
            double here = h[i];
            h[i] += move.first ? 0 : b * (here - x[i]);
            x[i] = here;
        }
}

double fast_step_run(struct fast_step *step, struct transform *transform, const double *amplitude,
                     const double *sorted, struct fast_move move, double *z, double *x,
                     struct height_error *errors) {
    size_t nx = step->modes->grid.nx, ny = step->modes->grid.ny;
    amplitudes_impose(step->modes, amplitude, transform_spectrum(transform));
    transform_inverse_columns(transform);
    if (errors != NULL)
        height_error_heights_start(errors);
    keys_count(step, transform, move, z, x, errors);
    rank_table_finish(step->table, sorted, &step->low, &step->high);
    for (size_t j = 0; j < ny; j += ROWS) {
        size_t rows = ny - j < ROWS ? ny - j : ROWS;
        rank_table_place(step->table, rows * nx, z + j * nx, step->block);
        move_rows(move, rows * nx, z + j * nx, step->block, x + j * nx);
        transform_forward_rows(transform, j, rows, step->block);
    }
    transform_forward_columns(transform);
    return errors != NULL ? height_error_heights(errors) : (double)NAN;
}
