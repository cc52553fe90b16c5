#include "core/statistics/grooves/groove_sums.h"
#include "core/statistics/spectra/windowed_psd.h"
#include <math.h>

struct groove_sums groove_sums_at(const struct groove_map *map, double mx, double my) {
    const struct grid *grid = map->grid;
    const double nx = (double)grid->nx, ny = (double)grid->ny;
    const double step = -2 * M_PI * mx / nx;
    const double complex turn = cos(step) + sin(step) * I;
    const double start = -2 * M_PI * mx * (0.5 / nx - 0.5);
    struct groove_sums out = {0};
    for (size_t j = 0; j < grid->ny; j++) {
        const double *row = map->z + j * grid->nx;
        const double y = ((double)j + 0.5) / ny - 0.5, phase = -2 * M_PI * my * y;
        double complex wave = cos(start) + sin(start) * I, plain = 0, first = 0;
        for (size_t i = 0; i < grid->nx; i++) {
            const double complex term = row[i] * wave;
            plain += term;
            first += (((double)i + 0.5) / nx - 0.5) * term;
            wave *= turn;
        }
        const double complex row_wave = cos(phase) + sin(phase) * I;
        out.plain += plain * row_wave;
        out.x += first * row_wave;
        out.y += y * plain * row_wave;
    }
    return out;
}

double groove_power(const struct groove_map *map, double mx, double my) {
    const double n = (double)grid_points(map->grid);
    return complex_square(groove_sums_at(map, mx, my).plain) / (n * n);
}

struct groove_window groove_window_of(size_t n) {
    struct groove_window out = {0};
    for (size_t i = 0; i < n; i++) {
        const double w = hann_window(i, n), x = ((double)i + 0.5) / (double)n - 0.5;
        out.mean += w;
        out.square += w * w;
        out.moment += w * x * x;
        out.square_moment += w * w * x * x;
    }
    out.moment /= out.mean;
    out.square_moment /= out.square;
    out.mean /= (double)n;
    out.square /= (double)n;
    return out;
}
