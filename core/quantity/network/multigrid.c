#include "core/quantity/network/multigrid.h"
#include "core/quantity/network/coarsening.h"
#include "core/quantity/network/coarsest.h"
#include "core/quantity/network/relaxation.h"
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

/* A grid of so many nodes, or of so few in a direction, is not made coarser. */
enum { COARSEST_NODES = 5000, SIDE_LEAST = 4 };
enum { FINEST_ARRAYS = 7, COARSER_ARRAYS = 9 + 8 };

static bool is_coarsest(const struct level *level) {
    return level->nx * level->ny <= COARSEST_NODES || level->nx <= SIDE_LEAST ||
           level->ny <= SIDE_LEAST;
}

/* Dimensions of the levels, without arrays. Returns their number. */
static size_t lay_out(struct level *levels, size_t nx, size_t ny) {
    size_t count = 1;
    levels[0] = (struct level){.nx = nx, .ny = ny, .rows = ny, .stride = nx + 2};
    while (!is_coarsest(&levels[count - 1]) && count < MULTIGRID_LEVELS_MOST) {
        const struct level *fine = &levels[count - 1];
        size_t rows = fine->ny / 2, columns = (fine->nx + 1) / 2;
        levels[count++] = (struct level){
            .nx = columns, .ny = rows + rows % 2, .rows = rows, .stride = columns + 2};
    }
    return count;
}

static size_t arrays_of(size_t l) {
    return l == 0 ? FINEST_ARRAYS : COARSER_ARRAYS;
}

static size_t values_of(const struct level *levels, size_t count) {
    size_t values = 0;
    for (size_t l = 0; l < count; l++)
        values += arrays_of(l) * level_size(&levels[l]);
    return values;
}

size_t multigrid_values(size_t nx, size_t ny) {
    struct level levels[MULTIGRID_LEVELS_MOST];
    size_t count = lay_out(levels, nx, ny);
    return values_of(levels, count);
}

double multigrid_coarsest_bytes(size_t nx, size_t ny) {
    struct level levels[MULTIGRID_LEVELS_MOST];
    size_t count = lay_out(levels, nx, ny);
    return coarsest_bytes(levels[count - 1].nx * levels[count - 1].ny);
}

/* Hands out the memory from `next` on; returns what is left. */
static double *share_memory(struct level *level, bool finest, double *next) {
    double **const arrays[] = {&level->e,      &level->n,      &level->s,        &level->inverse,
                               &level->u,      &level->r,      &level->residual, &level->ne,
                               &level->nw,     &level->to.x_a, &level->to.x_b,   &level->to.y_a,
                               &level->to.y_c, &level->to.z_a, &level->to.z_b,   &level->to.z_c,
                               &level->to.z_d};
    for (size_t a = 0; a < arrays_of(finest ? 0 : 1); a++, next += level_size(level))
        *arrays[a] = next;
    return next;
}

int multigrid_create(struct multigrid *out, size_t values, struct error *err) {
    *out = (struct multigrid){.values = values};
    out->memory = array_create(values, sizeof *out->memory);
    return out->memory != NULL ? 0 : error_memory(err, values * sizeof(double), "a leak");
}

int multigrid_shape(struct multigrid *multigrid, size_t nx, size_t ny, struct error *err) {
    struct level *levels = multigrid->levels;
    if (multigrid->coarsest != NULL && levels[0].nx == nx && levels[0].ny == ny)
        return 0;
    coarsest_destroy(&multigrid->coarsest);
    multigrid->count = lay_out(levels, nx, ny);
    memset(multigrid->memory, 0, multigrid->values * sizeof *multigrid->memory);
    double *next = multigrid->memory;
    for (size_t l = 0; l < multigrid->count; l++)
        next = share_memory(&levels[l], l == 0, next);
    return coarsest_create(&multigrid->coarsest, &levels[multigrid->count - 1], err);
}

void multigrid_clear(struct multigrid *multigrid) {
    coarsest_destroy(&multigrid->coarsest);
    free(multigrid->memory);
    *multigrid = (struct multigrid){0};
}

int multigrid_prepare(struct multigrid *multigrid, struct error *err) {
    struct level *levels = multigrid->levels;
    relaxation_prepare(&levels[0]);
    for (size_t l = 1; l < multigrid->count; l++) {
        coarsening_make(&levels[l - 1], &levels[l]);
        relaxation_prepare(&levels[l]);
    }
    return coarsest_factorise(multigrid->coarsest, err);
}

int multigrid_cycle(struct multigrid *multigrid, struct error *err) {
    struct level *levels = multigrid->levels;
    size_t last = multigrid->count - 1;
    for (size_t l = 0; l < last; l++) {
        if (l == 0) {
            relaxation_first_finest(&levels[0]);
            coarsening_restrict_finest(&levels[0], &levels[1]);
        } else {
            relaxation_first(&levels[l]);
            relaxation_residual(&levels[l]);
            coarsening_restrict(&levels[l], &levels[l + 1]);
        }
    }
    int status = coarsest_solve(multigrid->coarsest, err);
    for (size_t l = last; l > 0 && status == 0; l--) {
        if (l == 1) {
            coarsening_prolong_finest(&levels[1], &levels[0]);
            relaxation_second_finest(&levels[0]);
        } else {
            coarsening_prolong(&levels[l], &levels[l - 1]);
            relaxation_second(&levels[l - 1]);
        }
    }
    return status;
}
