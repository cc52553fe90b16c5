/* Protects: the erosion of an image by a paraboloid tip is the lowest envelope that its definition
 * says, on maps and profiles, beside holes and sides; parabolas and rough surfaces come back from
 * their images where the tip touched, and what it did not reach is counted and marked. */
#include "core/map/preparation/tip.h"
#include "core/surface/surface.h"
#include "tests/support/check.h"
#include <stdlib.h>

enum { NX = 24, NY = 17 };

static double height_at(size_t point) {
    return 0.7 * sin(0.8 * (double)point) + 0.4 * cos(1.9 * (double)(point * point % 97));
}

/* By all pairs of points. */
static double least_over(const struct grid *grid, const double *z, size_t at, double radius) {
    const size_t nx = grid->nx;
    double least = INFINITY;
    for (size_t point = 0; point < grid_points(grid); point++) {
        const size_t i = point % nx, j = point / nx, at_i = at % nx, at_j = at / nx;
        const double x = ((double)i - (double)at_i) * grid_dx(grid);
        const double y = ((double)j - (double)at_j) * grid_dy(grid);
        const double height = z[point] + (x * x + y * y) / (2 * radius);
        least = height < least ? height : least;
    }
    return least;
}

static void it_is_the_lowest_envelope(void **state) {
    (void)state;
    static const struct grid GRIDS[] = {{NX, NY, NX * 0.5, NY * 0.7}, {NX * NY, 1, 100, 1}};
    for (int g = 0; g < 2; g++)
        for (double radius = 0.02; radius < 100; radius *= 4)
            for (int holes = 0; holes < 2; holes++) {
                double z[NX * NY], eroded[NX * NY];
                unsigned char marks[NX * NY];
                struct tip_result done;
                size_t marked = 0;
                for (size_t point = 0; point < (size_t)NX * NY; point++)
                    eroded[point] = z[point] =
                        holes == 1 && point % 5 < 2 ? (double)NAN : height_at(point);
                assert_int_equal(tip_erode(&GRIDS[g], eroded, radius, marks, &done, NULL), 0);
                for (size_t point = 0; point < (size_t)NX * NY; point++) {
                    assert_true(isnan(eroded[point]) == isnan(z[point]));
                    marked += marks[point];
                    if (isnan(z[point]))
                        assert_int_equal(marks[point], 0);
                    else if (marks[point] == 1)
                        check_close(eroded[point], least_over(&GRIDS[g], z, point, radius), 1e-12);
                    else /* between the points of the image the least may be lower */
                        check_close(eroded[point] + 0.3, least_over(&GRIDS[g], z, point, radius),
                                    0.3 + 1e-12);
                }
                assert_int_equal(marked, done.untrusted);
            }
}

/* Over a plane of slope s the image is R s^2/2 higher, over a bump of curvature k it has the
 * curvature k/(1 + R k): exact parabolas, so that both come back to rounding, although the tip
 * touches between the points. */
static void check_parabola(const struct grid *grid, double radius, double slope, double bend) {
    static double z[60 * 50];
    const size_t nx = grid->nx;
    struct tip_result done;
    for (size_t point = 0; point < 60 * 50; point++) {
        const size_t i = point % nx, j = point / nx;
        const double x = (double)i - 30, y = (double)j - (grid_is_profile(grid) ? 0 : 25);
        z[point] = slope * x + radius * slope * slope / 2 -
                   bend / (1 + radius * bend) * (x * x + y * y) / 2;
    }
    assert_int_equal(tip_erode(grid, z, radius, NULL, &done, NULL), 0);
    for (size_t i = 20; i < 40; i++) {
        const double x = (double)i - 30;
        check_close(z[grid_is_profile(grid) ? i : 25 * nx + i], slope * x - bend * x * x / 2,
                    1e-10);
    }
}

static void planes_and_bumps_come_back(void **state) {
    (void)state;
    static const struct grid MAP = {60, 50, 60, 50}, LINE = {60 * 50, 1, 60 * 50, 1};
    for (double radius = 0.7; radius < 60; radius *= 3) {
        check_parabola(&MAP, radius, 0.3, 0);
        check_parabola(&MAP, radius, 0, 0.02);
        check_parabola(&LINE, radius, 0.3, 0);
        check_parabola(&LINE, radius, 0, 0.02);
    }
}

/* Between the rims of a deep groove, straight or oblique, the bound is the tip's own paraboloid:
 * these points are marked, and those well beside the groove are not. */
static void a_groove_is_not_reached(void **state) {
    (void)state;
    enum { SIDE = 80 };
    const struct grid grid = {SIDE, SIDE, SIDE, SIDE};
    const double radius = 40;
    for (double angle = 0; angle < 1.6; angle += 0.31) {
        double z[SIDE * SIDE];
        unsigned char marks[SIDE * SIDE];
        struct tip_result done;
        size_t in = 0, missed = 0, wrong = 0;
        for (size_t point = 0; point < SIDE * SIDE; point++) {
            const size_t i = point % SIDE, j = point / SIDE;
            const double across = cos(angle) * ((double)i - 39.5) + sin(angle) * ((double)j - 39.5);
            z[point] = fabs(across) < 6 ? -5 : 0;
        }
        assert_int_equal(tip_dilate(&grid, z, radius, NULL), 0);
        assert_int_equal(tip_erode(&grid, z, radius, marks, &done, NULL), 0);
        for (size_t point = 0; point < SIDE * SIDE; point++) {
            const size_t i = point % SIDE, j = point / SIDE;
            const double across =
                fabs(cos(angle) * ((double)i - 39.5) + sin(angle) * ((double)j - 39.5));
            if (i < 10 || i >= 70 || j < 10 || j >= 70)
                continue;
            check_close(z[point], across < 6 ? (across * across - 36) / (2 * radius) : 0, 0.2);
            in += across < 4 ? 1 : 0;
            missed += across < 4 && marks[point] == 0 ? 1 : 0;
            wrong += across > 8 && marks[point] == 1 ? 1 : 0;
        }
        assert_true(in > 400);
        assert_int_equal(missed, 0);
        assert_int_equal(wrong, 0);
    }
}

enum { FINE = 2048, COARSE = 8, ROUGH = FINE / COARSE };

/* Mean curvature at the points above their 8 neighbours. */
static double peak_curvature(const double *z) {
    double bends = 0, count = 0;
    for (size_t j = 1; j + 1 < ROUGH; j++)
        for (size_t i = 1; i + 1 < ROUGH; i++) {
            const double *at = z + j * ROUGH + i;
            bool highest = true;
            for (int step = 0; step < 9; step++)
                highest = highest && (step == 4 || at[(step / 3 - 1) * ROUGH + step % 3 - 1] < *at);
            count += highest ? 1 : 0;
            bends += highest ? 2 * *at - (at[-1] + at[1] + at[-ROUGH] + at[ROUGH]) / 2 : 0;
        }
    return bends / count;
}

/* A Gaussian surface with 8 points a shortest wave under tips of several radii (over the RMS
 * curvature). Its image is taken on points eight times as fine. Curvatures of peaks come back, and
 * heights where they are trusted. */
static void a_rough_surface_comes_back(void **state) {
    (void)state;
    const struct grid fine = {FINE, FINE, ROUGH, ROUGH}, grid = {ROUGH, ROUGH, ROUGH, ROUGH};
    const struct spectrum spectrum = {.type = SPECTRUM_SELF_AFFINE,
                                      .hurst = 0.8,
                                      .wavelength_long = ROUGH / 4.0,
                                      .wavelength_rolloff = ROUGH / 4.0,
                                      .wavelength_short = 8};
    struct generator *generator = NULL;
    static double whole[FINE * FINE], dilated[FINE * FINE], surface[ROUGH * ROUGH];
    static double image[ROUGH * ROUGH], z[ROUGH * ROUGH];
    static unsigned char marks[ROUGH * ROUGH];
    assert_int_equal(generator_create(&generator, &spectrum, &fine, &SURFACE_DEFAULTS, NULL), 0);
    assert_int_equal(generator_run(generator, (struct random_key){8, 0, 0}, whole, NULL, NULL), 0);
    generator_destroy(&generator);
    double bends = 0;
    for (size_t point = 0; point < ROUGH * ROUGH; point++)
        surface[point] = whole[point / ROUGH * COARSE * FINE + point % ROUGH * COARSE];
    for (size_t i = 1; i + 1 < ROUGH; i++)
        bends += pow(surface[i - 1] - 2 * surface[i] + surface[i + 1], 2) / (ROUGH - 2);
    for (double sharp = 10; sharp > 0.6; sharp /= 2) { /* curvature by that of the tip */
        const double radius = 1 / (sharp * sqrt(bends));
        struct tip_result done;
        double trusted = 0, untrusted = 0, before = 0, lowest = 0, not_reached = 0;
        for (size_t point = 0; point < FINE * FINE; point++)
            dilated[point] = whole[point];
        assert_int_equal(tip_dilate(&fine, dilated, radius, NULL), 0);
        for (size_t point = 0; point < ROUGH * ROUGH; point++)
            z[point] = image[point] =
                dilated[point / ROUGH * COARSE * FINE + point % ROUGH * COARSE];
        assert_int_equal(tip_erode(&grid, z, radius, marks, &done, NULL), 0);
        for (size_t point = 0; point < ROUGH * ROUGH; point++) {
            const double above = z[point] - surface[point];
            lowest = fmin(lowest, above);
            not_reached += marks[point];
            *(marks[point] == 1 ? &untrusted : &trusted) += above * above;
            before += marks[point] == 1 ? 0 : pow(image[point] - surface[point], 2);
        }
        const double reached = ROUGH * ROUGH - not_reached, peaks = peak_curvature(surface);
        print_message("radius by RMS curvature %.3g: %.3g %% not reached, RMS errors %.2g there "
                      "and %.2g elsewhere (image %.2g), lowest %.2g, curvature of peaks %.3f "
                      "(image %.3f)\n",
                      1 / sharp, 100 * not_reached / (ROUGH * ROUGH),
                      sqrt(untrusted / fmax(not_reached, 1)), sqrt(trusted / reached),
                      sqrt(before / reached), lowest, peak_curvature(z) / peaks,
                      peak_curvature(image) / peaks);
        assert_int_equal(done.untrusted, (size_t)not_reached);
        assert_true(trusted < 0.04 * before); /* a fifth of the RMS error */
        assert_true(not_reached < 1 || untrusted / not_reached > trusted / reached);
        check_relative(peak_curvature(z), peaks, 0.04);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(it_is_the_lowest_envelope),
        cmocka_unit_test(planes_and_bumps_come_back),
        cmocka_unit_test(a_groove_is_not_reached),
        cmocka_unit_test(a_rough_surface_comes_back),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
