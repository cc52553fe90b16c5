/* What conjugate gradients work on: their arrays, and the symbols of the compliance. */
#include "core/contact/conjugate_step.h"
#include <fftw3.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Padding nodes lie so deep that they never come into contact. */
static const double FAR = 1e30;
static const double PI = 3.14159265358979323846;

static size_t padded(size_t n) {
    return (n + CONJUGATE_GRADIENT_LANES - 1) / CONJUGATE_GRADIENT_LANES * CONJUGATE_GRADIENT_LANES;
}

enum { ARRAYS = 10 };

double conjugate_gradient_bytes(const struct grid *grid) {
    double waves = ((double)grid->nx / 2 + 1) * (double)grid->ny;
    return sizeof(double) * (ARRAYS * (double)padded(grid_points(grid)) + 4 * waves);
}

static int arrays_create(struct conjugate_gradient *solver, struct error *err) {
    double **const arrays[ARRAYS] = {&solver->z,      &solver->p,     &solver->u, &solver->q,
                                     &solver->r,      &solver->old,   &solver->t, &solver->w,
                                     &solver->kept_p, &solver->kept_u};
    for (size_t a = 0; a < ARRAYS; a++) {
        *arrays[a] = fftw_alloc_real(solver->padded);
        if (*arrays[a] == NULL)
            return error_memory(err, solver->padded * sizeof(double), "a contact");
        memset(*arrays[a], 0, solver->padded * sizeof(double));
    }
    for (size_t i = solver->n; i < solver->padded; i++)
        solver->z[i] = -FAR;
    return 0;
}

/* Inverse compliance of the periodic half-space. */
static void fill_periodic_inverse(struct conjugate_gradient *solver) {
    const struct grid *grid = &solver->grid;
    for (size_t mx = 0; mx <= grid->nx / 2; mx++)
        for (size_t row = 0; row < grid->ny; row++) {
            size_t my = row <= grid->ny / 2 ? row : grid->ny - row;
            double qx = (double)mx / grid->lx, qy = my > 0 ? (double)my / grid->ly : 0;
            solver->stiff[mx * grid->ny + row] = PI * hypot(qx, qy) * solver->largest;
        }
}

static int symbols_create(struct conjugate_gradient *solver, const struct compliance *compliance,
                          struct error *err) {
    size_t waves = (solver->grid.nx / 2 + 1) * solver->grid.ny;
    solver->soft = array_create(compliance->waves, sizeof *solver->soft);
    solver->stiff = array_create(waves, sizeof *solver->stiff);
    if (solver->soft == NULL || solver->stiff == NULL)
        return error_memory(err, compliance->waves * sizeof(double), "a contact");
    for (size_t k = 0; k < compliance->waves; k++)
        solver->largest = fmax(solver->largest, fabs(compliance->length[k]));
    for (size_t k = 0; k < compliance->waves; k++) {
        double weight = compliance->weight != NULL ? compliance->weight[k] : 1;
        solver->soft[k] = compliance->length[k] / solver->largest * weight;
    }
    if (compliance->open) {
        fill_periodic_inverse(solver);
        return 0;
    }
    for (size_t k = 0; k < waves; k++)
        solver->stiff[k] = solver->soft[k] > 0 ? 1 / solver->soft[k] : 0;
    return 0;
}

int conjugate_gradient_create(struct conjugate_gradient *out, const struct compliance *compliance,
                              struct error *err) {
    const struct grid *grid = &compliance->grid;
    const struct grid *waved = &compliance->waved;
    *out = (struct conjugate_gradient){
        .grid = *grid, .n = grid_points(grid), .padded = padded(grid_points(grid))};
    int status = transform_create(&out->transform, grid, grid->nx / 2, grid->ny / 2, err);
    if (status == 0 && compliance->open)
        status = transform_create(&out->wide, waved, waved->nx / 2, waved->ny / 2, err);
    if (status == 0)
        status = arrays_create(out, err);
    if (status == 0)
        status = symbols_create(out, compliance, err);
    if (status != 0)
        conjugate_gradient_clear(out);
    return status;
}

void conjugate_gradient_clear(struct conjugate_gradient *solver) {
    double *const arrays[ARRAYS] = {solver->z,      solver->p,     solver->u, solver->q,
                                    solver->r,      solver->old,   solver->t, solver->w,
                                    solver->kept_p, solver->kept_u};
    for (size_t a = 0; a < ARRAYS; a++)
        fftw_free(arrays[a]);
    free(solver->soft);
    free(solver->stiff);
    transform_destroy(&solver->transform);
    transform_destroy(&solver->wide);
    *solver = (struct conjugate_gradient){0};
}
