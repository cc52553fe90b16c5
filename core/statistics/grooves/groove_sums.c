#include "core/statistics/grooves/groove_sums.h"
#include "core/statistics/spectra/windowed_psd.h"
#include "core/vectors.h"
#include <math.h>

/* Points of a row in interleaved lanes, each with its own wave, which turns by LANES points. */
enum { LANES = 8 };
struct waves {
    double re[LANES], im[LANES]; /* at the first points */
    double turn_re, turn_im;
};
struct row_sums {
    double re[LANES], im[LANES], x_re[LANES], x_im[LANES]; /* plain, and times i + 1/2 */
};

static struct waves waves_of(double start, double step) {
    struct waves out = {.turn_re = cos(LANES * step), .turn_im = sin(LANES * step)};
    for (size_t l = 0; l < LANES; l++) {
        out.re[l] = cos(start + step * (double)l);
        out.im[l] = sin(start + step * (double)l);
    }
    return out;
}

WIDE_VECTORS static void row_sum(struct row_sums *out, const double *row, size_t n,
                                 const struct waves *waves) {
    struct waves now = *waves;
    struct row_sums sums = {{0}, {0}, {0}, {0}};
    const size_t whole = n / LANES * LANES;
    for (size_t i = 0; i < whole; i += LANES)
        for (size_t l = 0; l < LANES; l++) {
            const double re = row[i + l] * now.re[l], im = row[i + l] * now.im[l];
            const double x = (double)i + ((double)l + 0.5);
            sums.re[l] += re;
            sums.im[l] += im;
            sums.x_re[l] += x * re;
            sums.x_im[l] += x * im;
            const double turned = now.re[l] * now.turn_re - now.im[l] * now.turn_im;
            now.im[l] = now.re[l] * now.turn_im + now.im[l] * now.turn_re;
            now.re[l] = turned;
        }
    for (size_t i = whole; i < n; i++) {
        const size_t l = i - whole;
        const double re = row[i] * now.re[l], im = row[i] * now.im[l], x = (double)i + 0.5;
        sums.re[l] += re;
        sums.im[l] += im;
        sums.x_re[l] += x * re;
        sums.x_im[l] += x * im;
    }
    *out = sums;
}

static double lanes_sum(const double lanes[LANES]) {
    double sum = 0;
    for (size_t l = 0; l < LANES; l++)
        sum += lanes[l];
    return sum;
}

struct groove_sums groove_sums_at(const struct groove_map *map, double mx, double my) {
    const struct grid *grid = map->grid;
    const double nx = (double)grid->nx, ny = (double)grid->ny;
    const struct waves waves = waves_of(-2 * M_PI * mx * (0.5 / nx - 0.5), -2 * M_PI * mx / nx);
    struct groove_sums out = {0};
    for (size_t j = 0; j < grid->ny; j++) {
        struct row_sums row;
        row_sum(&row, map->z + j * grid->nx, grid->nx, &waves);
        const double y = ((double)j + 0.5) / ny - 0.5, phase = -2 * M_PI * my * y;
        const double complex plain = lanes_sum(row.re) + lanes_sum(row.im) * I;
        const double complex x = lanes_sum(row.x_re) + lanes_sum(row.x_im) * I;
        const double complex row_wave = cos(phase) + sin(phase) * I;
        out.plain += plain * row_wave;
        out.x += (x / nx - 0.5 * plain) * row_wave;
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
