/* Protects: the spectral density of an open map is that of its heights under Hann's window, with
 * the window's power taken off, so that the integral is the mean square; steep spectra do not leak;
 * holes change little. And heights, slopes and curvatures by scale against what they are of one
 * wave. */
#include "core/statistics/heights/roughness.h"
#include "core/statistics/heights/scales.h"
#include "core/statistics/spectra/windowed_psd.h"
#include "tests/support/check.h"
#include "tests/support/cut.h"
#include <complex.h>

static double integral(const struct grid *grid, const double *wave_number, const double *density) {
    double total = 0, width = 2 * M_PI / fmin(grid->lx, grid->ly);
    for (size_t r = 1; r < radial_bins(grid); r++)
        total += 2 * M_PI * wave_number[r] * width * density[r];
    return total;
}

/* The transform written out, for a profile: its rings are single waves. */
static void a_profile_by_its_definition(void **state) {
    (void)state;
    enum { N = 24 };
    const struct grid grid = {N, 1, 3, 1};
    double z[N], weights = 0, mean = 0, power = 0, wave_number[N], density[N];
    for (size_t i = 0; i < N; i++) {
        double w = pow(sin(M_PI * ((double)i + 0.5) / N), 2);
        z[i] = 7 + sin(0.7 * (double)i) + 0.3 * (double)(i * i % 5);
        weights += w;
        mean += w * z[i];
        power += w * w / N;
    }
    const struct measured_map map = {&grid, z, BOUNDARY_OPEN};
    assert_int_equal(windowed_psd_measure(&map, wave_number, density, NULL), 0);
    for (size_t r = 0; r <= N / 2; r++) {
        double complex sum = 0;
        for (size_t i = 0; i < N; i++)
            sum += pow(sin(M_PI * ((double)i + 0.5) / N), 2) * (z[i] - mean / weights) *
                   cexp(-2 * M_PI * (double)(r * i) / N * I) / N;
        check_relative(wave_number[r], 2 * M_PI * (double)r / 3, 1e-14);
        check_close(density[r], creal(sum * conj(sum)) / power * 3 / (2 * M_PI), 1e-14);
    }
}

/* Returns the mean square of heights under the squared window, about the mean under the window. */
static double power_under_window(const struct grid *grid, const double *z) {
    double weights = 0, mean = 0, squares = 0, power = 0;
    for (int pass = 0; pass < 2; pass++)
        for (size_t point = 0; point < grid_points(grid); point++) {
            size_t i = point % grid->nx, j = point / grid->nx;
            double w = pow(sin(M_PI * ((double)i + 0.5) / (double)grid->nx) *
                               sin(M_PI * ((double)j + 0.5) / (double)grid->ny),
                           2);
            if (isnan(z[point]))
                continue;
            if (pass == 0) {
                weights += w;
                mean += w * z[point];
                continue;
            }
            squares += w * w;
            power += w * w * pow(z[point] - mean / weights, 2);
        }
    return power / squares;
}

/* Sub-maps of a surface against the surface: the integral within 5 % of the mean square under the
 * window, for rings are no circles at long waves; the density in the middle of the band within 25
 * %, and beyond the band, where there is no wave, at most 1e-6 of that: without the window it is
 * 1e-3. */
static void pieces_of_a_surface(void **state) {
    (void)state;
    const struct grid grid = {256, 256, 32, 32};
    double window_power = 0, piece_power = 0, whole_middle = 0, piece_middle = 0;
    for (int holes = 0; holes < 2; holes++)
        for (uint64_t r = 0; r < 8; r++) {
            struct grid piece;
            double *z = whole_surface(&grid, 0.8, r),
                   *part = cut(&grid, z, 30, 30, 160, 150, &piece);
            double wave_number[400], density[400];
            if (holes == 1)
                for (size_t hole = 0; hole < 20; hole++)
                    part[(hole * 1201 + 17) % (160 * 150)] = NAN;
            assert_int_equal(psd_measure(&grid, z, wave_number, density, NULL), 0);
            whole_middle += density[16]; /* wave number 2 pi/2 */
            const struct measured_map map = {&piece, part, BOUNDARY_OPEN};
            assert_true(radial_bins(&piece) < 400);
            assert_int_equal(windowed_psd_measure(&map, wave_number, density, NULL), 0);
            window_power += power_under_window(&piece, part);
            piece_power += integral(&piece, wave_number, density);
            size_t middle = (size_t)(fmin(piece.lx, piece.ly) / 2 + 0.5);
            piece_middle += density[middle];
            assert_true(density[3 * middle] <= (holes == 0 ? 1e-6 : 1e-3) * density[middle]);
            free(z);
            free(part);
        }
    check_relative(piece_power, window_power, 0.05);
    check_relative(piece_middle, whole_middle, 0.25);
}

/* Two rows of holes are filled from their rims; a plane with them has the density of the plane. */
static void holes_are_filled(void **state) {
    (void)state;
    const struct grid grid = {32, 32, 32, 32};
    double z[32 * 32], wave_number[40], density[40];
    const struct measured_map map = {&grid, z, BOUNDARY_OPEN};
    for (size_t point = 0; point < 32 * 32; point++)
        z[point] = point / 32 == 9 || point / 32 == 10 ? (double)NAN : 4;
    assert_int_equal(windowed_psd_measure(&map, wave_number, density, NULL), 0);
    for (size_t r = 0; r < radial_bins(&grid); r++)
        check_close(density[r], 0, 1e-25);
    for (size_t point = 0; point < 32 * 32; point++)
        z[point] = NAN;
    struct error err = {0};
    assert_int_equal(windowed_psd_measure(&map, wave_number, density, &err), ERROR_INPUT);
}

/* cos(k x + q y): a difference over a lag has the mean square 1 - cos(k lag), a second one
 * (1 - cos(k lag))^2 * 2. Whole waves, so that the means are exact on periodic maps. */
static void scales_of_a_wave(void **state) {
    (void)state;
    const struct grid grid = {64, 48, 16, 24}; /* spacings 1/4 and 1/2 */
    const double k = 2 * M_PI * 3 / 16, q = 2 * M_PI * 5 / 24;
    double z[64 * 48];
    struct scale scales[SCALES_MOST];
    const struct measured_map map = {&grid, z, BOUNDARY_PERIODIC};
    for (size_t point = 0; point < 64 * 48; point++) {
        size_t i = point % 64, j = point / 64;
        z[point] = cos(k * (double)i / 4 + q * (double)j / 2);
    }
    assert_int_equal(scales_measure(&map, scales), 4); /* lags of 1, 2, 4, 8 points */
    for (size_t n = 0; n < 4; n++) {
        double lag_x = 0.25 * (double)(1 << n), lag_y = 0.5 * (double)(1 << n);
        double x = 1 - cos(k * lag_x), y = 1 - cos(q * lag_y);
        check_relative(scales[n].length, lag_x, 1e-14);
        check_relative(scales[n].height, sqrt((x + y) / 4), 1e-12);
        check_relative(scales[n].slope, sqrt(x / (lag_x * lag_x) + y / (lag_y * lag_y)), 1e-12);
        check_relative(scales[n].curvature, sqrt(0.5) * (x / (lag_x * lag_x) + y / (lag_y * lag_y)),
                       1e-12);
    }
}

/* Open maps, with a hole: z = x^2 has the same curvature at every scale, z = x the same slope. */
static void scales_of_open_maps(void **state) {
    (void)state;
    const struct grid grid = {40, 1, 20, 1};
    double z[40];
    struct scale scales[SCALES_MOST];
    const struct measured_map map = {&grid, z, BOUNDARY_OPEN};
    for (size_t i = 0; i < 40; i++)
        z[i] = i == 11 ? (double)NAN : pow((double)i / 2, 2);
    assert_int_equal(scales_measure(&map, scales), 4);
    for (size_t n = 0; n < 4; n++)
        check_relative(scales[n].curvature, 2, 1e-12);
    for (size_t i = 0; i < 40; i++)
        z[i] = (double)i / 2;
    assert_int_equal(scales_measure(&map, scales), 4);
    for (size_t n = 0; n < 4; n++)
        check_relative(scales[n].slope, 1, 1e-12);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_profile_by_its_definition),
        cmocka_unit_test(pieces_of_a_surface),
        cmocka_unit_test(holes_are_filled),
        cmocka_unit_test(scales_of_a_wave),
        cmocka_unit_test(scales_of_open_maps),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
