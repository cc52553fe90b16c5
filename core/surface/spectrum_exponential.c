#include "core/surface/spectrum_exponential.h"
#include "core/sum.h"
#include "core/surface/transform.h"
#include <fftw3.h>
#include <math.h>

/* Rounding of a transform is below this share of R(0); smaller powers, of either sign, are none. */
static const double ROUNDING = 1e-17;

static double shorter_way(size_t i, size_t points) {
    return (double)(2 * i <= points ? i : points - i);
}

double exponential_correlation(const struct spectrum *spectrum, const struct grid *grid, size_t i,
                               size_t j) {
    double x = shorter_way(i, grid->nx) * grid_dx(grid) / spectrum->correlation_x;
    if (grid_is_profile(grid))
        return exp(-x);
    return exp(-hypot(x, shorter_way(j, grid->ny) * grid_dy(grid) / spectrum->correlation_y));
}

static void powers_take(struct modes *modes, const double complex *mode) {
    const struct grid *grid = &modes->grid;
    size_t rows = 2 * modes->mode_y + 1;
    struct sum positive = {0, 0}, negative = {0, 0};
    for (size_t mx = 0; mx <= modes->mode_x; mx++)
        for (size_t row = 0; row < grid->ny; row++, mode++) {
            size_t at = row <= modes->mode_y ? row + modes->mode_y : row + modes->mode_y - grid->ny;
            double power = creal(*mode), weight = modes_weight(grid, mx);
            if ((mx == 0 && row == 0) || fabs(power) <= ROUNDING)
                continue;
            sum_add(power > 0 ? &positive : &negative, weight * fabs(power));
            if (power < 0)
                continue;
            modes->power[mx * rows + at] = power;
            modes->count += modes_weight(grid, mx);
        }
    double all = sum_value(&positive) + sum_value(&negative);
    modes->clipped = all > 0 ? sum_value(&negative) / all : 0;
}

int exponential_fill(struct modes *modes, const struct spectrum *spectrum, struct error *err) {
    const struct grid *grid = &modes->grid;
    struct transform *transform = NULL;
    double *field = fftw_alloc_real(grid_points(grid));
    if (field == NULL)
        return error_memory(err, grid_points(grid) * sizeof *field, "an autocorrelation");
    int status = transform_create(&transform, grid, modes->mode_x, modes->mode_y, err);
    if (status == 0) {
        for (size_t j = 0; j < grid->ny; j++)
            for (size_t i = 0; i < grid->nx; i++)
                field[j * grid->nx + i] = exponential_correlation(spectrum, grid, i, j);
        transform_forward(transform, field);
        powers_take(modes, transform_spectrum(transform));
    }
    transform_destroy(&transform);
    fftw_free(field);
    return status;
}
