/* Protects: the erosion of an image by a paraboloid tip is the lowest envelope that its definition
 * says, on maps and profiles, beside holes and sides; it lies nowhere below the surface, on it
 * where the tip touched, and what the tip did not reach is counted and marked. */
#include "core/map/tip.h"
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
        const double x = ((double)(point % nx) - (double)(at % nx)) * grid_dx(grid);
        const double y = ((double)(point / nx) - (double)(at / nx)) * grid_dy(grid);
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
                    else
                        check_close(eroded[point], least_over(&GRIDS[g], z, point, radius), 1e-12);
                }
                assert_int_equal(marked, done.untrusted);
            }
}

/* Over a plane of slope s the image is R s^2/2 higher; it comes back, to what points miss of it. */
static void a_tilted_plane_comes_back(void **state) {
    (void)state;
    const struct grid grid = {60, 50, 60, 50};
    const double radius = 30, slope = 0.3;
    double z[60 * 50];
    struct tip_result done;
    for (size_t point = 0; point < 60 * 50; point++)
        z[point] = slope * (double)(point % 60);
    assert_int_equal(tip_dilate(&grid, z, radius, NULL), 0);
    for (size_t i = 0; i < 50; i++)
        check_close(z[60 * 20 + i], slope * (double)i + radius * slope * slope / 2,
                    1.0 / (8 * radius));
    assert_int_equal(tip_erode(&grid, z, radius, NULL, &done, NULL), 0);
    for (size_t i = 10; i < 60; i++)
        check_close(z[60 * 20 + i], slope * (double)i, 1e-12);
    check_relative(done.rms, radius * slope * slope / 2, 0.15);
    /* beyond the lower side lie tips that are not known: R s columns of 50 */
    assert_true(done.untrusted >= 5 * 50 && done.untrusted <= 11 * 50);
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
            const double across = cos(angle) * ((double)(point % SIDE) - 39.5) +
                                  sin(angle) * ((double)(point / SIDE) - 39.5);
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

enum { ROUGH = 256 };
/* A Gaussian surface with 16 points a shortest wave under tips of several radii (over the RMS
 * curvature): nowhere below, and where trusted ten times as near as where not. */
static void a_rough_surface_is_bounded(void **state) {
    (void)state;
    const struct grid grid = {ROUGH, ROUGH, ROUGH, ROUGH};
    const struct spectrum spectrum = {.type = SPECTRUM_SELF_AFFINE,
                                      .hurst = 0.8,
                                      .wavelength_long = ROUGH / 4.0,
                                      .wavelength_rolloff = ROUGH / 4.0,
                                      .wavelength_short = 16};
    struct generator *generator = NULL;
    static double surface[ROUGH * ROUGH], z[ROUGH * ROUGH];
    static unsigned char marks[ROUGH * ROUGH];
    assert_int_equal(generator_create(&generator, &spectrum, &grid, &SURFACE_DEFAULTS, NULL), 0);
    assert_int_equal(generator_run(generator, (struct random_key){8, 0, 0}, surface, NULL, NULL),
                     0);
    generator_destroy(&generator);
    double bends = 0, before = 0.01;
    for (size_t i = 1; i + 1 < ROUGH; i++)
        bends += pow(surface[i - 1] - 2 * surface[i] + surface[i + 1], 2) / (ROUGH - 2);
    for (double sharp = 4; sharp > 0.2; sharp /= 2) { /* radius by curvature */
        const double radius = 1 / (sharp * sqrt(bends));
        struct tip_result done;
        double trusted = 0, untrusted = 0, most = 0;
        size_t inside = 0, not_reached = 0;
        for (size_t point = 0; point < ROUGH * ROUGH; point++)
            z[point] = surface[point];
        assert_int_equal(tip_dilate(&grid, z, radius, NULL), 0);
        assert_int_equal(tip_erode(&grid, z, radius, marks, &done, NULL), 0);
        for (size_t point = 0; point < ROUGH * ROUGH; point++) {
            const double above = z[point] - surface[point];
            assert_true(above >= -1e-12);
            inside++;
            if (marks[point] == 1) {
                not_reached++;
                untrusted += above * above;
            } else {
                most = fmax(most, above);
                trusted += above * above;
            }
        }
        const double share = (double)not_reached / (double)inside;
        trusted = sqrt(trusted / (double)(inside - not_reached));
        untrusted = sqrt(untrusted / fmax((double)not_reached, 1));
        print_message("radius by RMS curvature %g: %.3g %% not reached, RMS errors %.2g there and "
                      "%.2g elsewhere, most %.2g, of an RMS height of 1\n",
                      1 / sharp, 100 * share, untrusted, trusted, most);
        assert_true(share > before && share < 0.95);
        assert_true(trusted < 0.1 * untrusted);
        before = share;
    }
    assert_true(before > 0.2);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(it_is_the_lowest_envelope),
        cmocka_unit_test(a_tilted_plane_comes_back),
        cmocka_unit_test(a_groove_is_not_reached),
        cmocka_unit_test(a_rough_surface_is_bounded),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
