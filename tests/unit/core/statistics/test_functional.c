/* Protects: functional parameters have the closed values of Gaussian and of exponential heights and
 * of a line, do not depend on the order of heights, and follow their definitions over all positions
 * of the secant. Ten-point heights are those of counted hills; widths of a profile's elements those
 * of waves, by both standards. */
#include "core/statistics/heights/areal.h"
#include "core/statistics/heights/functional.h"
#include "core/statistics/summits/hills.h"
#include "tests/support/check.h"
#include "tests/support/noise.h"
#include <gsl/gsl_cdf.h>
#include <stdlib.h>

enum { MANY = 1 << 20 };

/* Quantiles at (k + 1/2)/n, in an order of their own. */
static void fill_quantiles(double *z, size_t n, double (*quantile)(double ratio)) {
    for (size_t k = 0; k < n; k++)
        z[k * 5 % n] = 7 + quantile(((double)k + 0.5) / (double)n);
}
static double gaussian(double ratio) {
    return gsl_cdf_ugaussian_Qinv(ratio);
}
static double exponential(double ratio) {
    return -log(ratio);
}
static double line(double ratio) {
    return 3 - 2 * ratio;
}

static void measure(struct functional *out, const double *z, size_t n) {
    const struct grid grid = {n, 1, 1, 1};
    const struct measured_map map = {&grid, z, BOUNDARY_OPEN};
    struct material_curve curve;
    assert_int_equal(material_curve_create(&curve, &map, NULL), 0);
    functional_measure(&curve, out);
    material_curve_clear(&curve);
}

/* Values of a core: height, peaks, valleys, ratios. */
static void check_core(const struct material_core *core, const double expected[5],
                       double tolerance) {
    check_close(core->k, expected[0], tolerance);
    check_close(core->pk, expected[1], tolerance);
    check_close(core->vk, expected[2], tolerance);
    check_close(core->mr1, expected[3], tolerance);
    check_close(core->mr2, expected[4], tolerance);
}

/* Fills what a line of this slope through the middle cuts off standard Gaussian heights. */
static void gaussian_core(double k, double expected[5]) {
    const double top = k / 2, ratio = gsl_cdf_ugaussian_Q(top);
    const double area = exp(-top * top / 2) / sqrt(2 * M_PI) - top * ratio;
    const double values[] = {k, 2 * area / ratio, 2 * area / ratio, ratio, 1 - ratio};
    for (int n = 0; n < 5; n++)
        expected[n] = values[n];
}

/* The flattest secant goes from 30 to 70 %. The slope of least squares is 12/0.4^3 times the
 * integral of z (m - 1/2) over it. With scores t from -u to u that is the integral of t phi(t)
 * Q(t), by parts phi(u) (Q(-u) - Q(u)) less the integral of phi^2, erf(u)/(2 sqrt(pi)). */
static void gaussian_heights(void **state) {
    (void)state;
    double *z = malloc(MANY * sizeof *z), expected[5];
    struct functional found;
    assert_non_null(z);
    fill_quantiles(z, MANY, gaussian);
    measure(&found, z, MANY);
    const double u = gsl_cdf_ugaussian_Qinv(0.3), phi = exp(-u * u / 2) / sqrt(2 * M_PI);
    gaussian_core(2 * u / 0.4, expected);
    check_relative(expected[0], 2.62200, 1e-5);
    check_relative(expected[1], 0.93698, 1e-5);
    check_relative(expected[3], 0.09493, 1e-4);
    check_core(&found.secant, expected, 2e-5);
    const double integral = erf(u) / (2 * sqrt(M_PI)) - phi * (0.7 - 0.3);
    gaussian_core(12 / (0.4 * 0.4 * 0.4) * integral, expected);
    print_message("Gaussian heights: Sk %.6f, Spk %.6f, Smr1 %.6f\n", expected[0], expected[1],
                  expected[3]);
    check_core(&found.line, expected, 2e-5);
    check_relative(found.vmp, 0.04734, 1e-4);
    check_relative(found.vmc, 0.90592, 1e-4);
    check_relative(found.vvc, 1.21726, 1e-4);
    check_relative(found.vvv, 0.11164, 1e-4);
    check_relative(found.xp, 1.95996, 1e-5);
    free(z);
}

/* Heights -ln m are flattest at their lower end, from 60 to 100 %, where no valleys are left. */
static void exponential_heights(void **state) {
    (void)state;
    double *z = malloc(MANY * sizeof *z);
    struct functional found;
    assert_non_null(z);
    fill_quantiles(z, MANY, exponential);
    measure(&found, z, MANY);
    const double k = log(1 / 0.6) / 0.4;
    check_core(&found.secant, (const double[]){k, 2, 0, exp(-k), 1}, 1e-4);
    /* integral of -ln m over 0.6 .. 1 is 0.4 + 0.6 ln 0.6, of -m ln m (1 - 0.36)/4 + 0.18 ln 0.6 */
    const double zeroth = 0.4 + 0.6 * log(0.6), first = 0.16 + 0.18 * log(0.6) - 0.8 * zeroth;
    const double slope = -12 * first / 0.064, top = zeroth / 0.4 + 0.8 * slope;
    check_core(&found.line, (const double[]){slope, 2, 0, exp(-top), 1}, 1e-4);
    assert_true(found.line.mr2 == 1 && found.line.vk == 0);
    check_relative(found.xp, log(20), 1e-5);
    check_relative(found.vmp, 0.1, 1e-4); /* the mean height above the one of 10 %, which is 1 */
    check_relative(found.vmc, 0.7, 1e-4);
    free(z);
}

/* A straight curve is its own core; so is a level map, and one of two heights. */
static void straight_curves(void **state) {
    (void)state;
    double z[1000];
    struct functional found;
    fill_quantiles(z, 999, line);
    measure(&found, z, 999);
    check_core(&found.line, (const double[]){2, 0, 0, 0, 1}, 2e-3);
    check_core(&found.secant, (const double[]){2, 0, 0, 0, 1}, 2e-3);
    check_close(found.vmp, 0.01, 1e-5);
    check_close(found.vvv, 0.04, 1e-5);
    for (size_t k = 0; k < 1000; k++)
        z[k] = 4;
    measure(&found, z, 1000);
    assert_true(found.line.k == 0 && found.line.pk == 0 && found.line.vk == 0 && found.xp == 0);
    z[500] = 5;
    measure(&found, z, 1000);
    assert_true(fabs(found.line.k) < 1e-12 && found.line.pk > 0.4);
}

/* Against sums over a fine walk through all positions, on odd and skewed heights with equal ones.
 */
static void any_heights_follow_the_definition(void **state) {
    (void)state;
    uint64_t seed = 91;
    for (size_t n = 2; n < 400; n += 57) {
        double z[400], least = INFINITY, at = 0;
        struct functional found;
        struct material_curve curve;
        const struct grid grid = {n, 1, 1, 1};
        const struct measured_map map = {&grid, z, BOUNDARY_OPEN};
        noise_fill(&seed, 400, z);
        for (size_t k = 0; k < n; k++)
            z[k] = k % 3 == 0 ? exp(z[k]) : floor(3 * z[k]);
        assert_int_equal(material_curve_create(&curve, &map, NULL), 0);
        functional_measure(&curve, &found);
        const double end = 0.5 / (double)n; /* beyond which the curve is level */
        for (double from = end; from <= 0.6 - end; from += 1e-4) {
            const double fall = material_height(&curve, from) - material_height(&curve, from + 0.4);
            if (fall < least) {
                least = fall;
                at = from;
            }
        }
        assert_true(found.secant.k <= least / 0.4 * (1 + 1e-9) + 1e-12);
        assert_true(found.secant.k >= least / 0.4 - 2e-4 * 20 * (double)n);
        double area = 0, above = 0;
        for (double m = 5e-6; m < 1; m += 1e-5) {
            area += fmax(material_height(&curve, m) - material_height(&curve, 0.1), 0) * 1e-5;
            above += material_height(&curve, m) * 1e-5;
        }
        check_close(found.vmp, area, 1e-3);
        check_close(above, 0, 0.2); /* heights about their mean */
        for (double m = 0.01; m < 1; m += 0.01) {
            const double height = material_height(&curve, m);
            const double back = material_ratio(&curve, height);
            check_close(material_height(&curve, back), height, 1e-9);
        }
        assert_true(material_ratio(&curve, 1e9) == 0 && material_ratio(&curve, -1e9) == 1);
        assert_true(at >= 0);
        material_curve_clear(&curve);
    }
}

static void holes_are_left_out(void **state) {
    (void)state;
    double z[300], whole[200];
    struct functional found, without;
    uint64_t seed = 5;
    noise_fill(&seed, 200, whole);
    for (size_t k = 0; k < 300; k++)
        z[k] = k % 3 == 0 ? (double)NAN : whole[k - k / 3 - 1];
    measure(&found, z, 300);
    measure(&without, whole, 200);
    assert_true(found.line.k == without.line.k && found.vvv == without.vvv);
    const struct grid grid = {3, 1, 3, 1};
    const double none[] = {NAN, NAN, NAN};
    struct material_curve curve;
    struct error err = {0};
    assert_int_equal(
        material_curve_create(&curve, &(struct measured_map){&grid, none, BOUNDARY_OPEN}, &err),
        ERROR_INPUT);
}

enum { SIDE = 64 };
/* Bumps of 1 to 7 up and 2 to 4 down on a plane, and one too low to count. */
static void ten_points(void **state) {
    (void)state;
    static double z[SIDE * SIDE];
    const struct grid grid = {SIDE, SIDE, SIDE, SIDE};
    const struct measured_map map = {&grid, z, BOUNDARY_OPEN};
    static const double BUMPS[] = {1, 2, 3, 4, 5, 6, 7, -2, -3, -4, 0.4};
    for (size_t point = 0; point < SIDE * SIDE; point++) {
        z[point] = 100;
        for (size_t b = 0; b < sizeof BUMPS / sizeof *BUMPS; b++) {
            const size_t i = point % SIDE, j = point / SIDE, column = b % 4, row = b / 4;
            const double x = (double)i - 10 - 14 * (double)column;
            const double y = (double)j - 10 - 18 * (double)row;
            z[point] += BUMPS[b] * exp(-(x * x + y * y) / 4);
        }
    }
    for (int dales = 0; dales < 2; dales++) {
        struct summit_list hills = {0};
        struct hills unused;
        struct ten_points found;
        assert_int_equal(hills_find(&map, 0.05 * 11, &hills, &unused, NULL), 0);
        assert_int_equal(ten_points_measure(&map, &hills, 100, 11, &found, NULL), 0);
        assert_int_equal(found.hills, dales == 0 ? 7 : 3);
        assert_int_equal(found.dales, dales == 0 ? 3 : 7);
        check_relative(dales == 0 ? found.s5p : found.s5v, 5, 1e-3);
        check_relative(dales == 0 ? found.s5v : found.s5p, 3, 1e-3);
        check_relative(found.s10z, 8, 1e-3);
        summit_list_clear(&hills);
        for (size_t point = 0; point < SIDE * SIDE; point++)
            z[point] = 200 - z[point];
    }
}

/* A wave of 20 points with ripples of a fortieth that cross the line near its crossings: ripples
 * are no elements. Dales that are too low for the older standard count by the newer one. */
static void widths_of_elements(void **state) {
    (void)state;
    enum { N = 4000 };
    static double z[N];
    const struct grid grid = {N, 1, N * 0.5, 1};
    const struct measured_map profile = {&grid, z, BOUNDARY_OPEN};
    struct profile_spacing found;
    for (size_t i = 0; i < N; i++)
        z[i] = sin(2 * M_PI * (double)i / 200 + 0.1) + 0.05 * sin(2 * M_PI * (double)i / 7);
    profile_spacing_measure(&profile, 0, &found);
    check_relative(found.rsm, 100, 0.01);
    check_relative(found.rsm_old, 100, 0.01);
    assert_in_range(found.elements, 72, 78); /* both directions, beginning with hill or dale */
    assert_in_range(found.elements_old, 36, 39);
    /* Hills of 1, dales of 0.15: below a tenth of Rz = 1.15 no dale counts (1997: 0.115), and
     * above a tenth of Rv = 0.15 all do. */
    for (size_t i = 0; i < N; i++) {
        const double wave = sin(2 * M_PI * (double)i / 200 + 0.1);
        z[i] = wave > 0 ? wave : 0.1 * wave;
    }
    profile_spacing_measure(&profile, 0, &found);
    check_relative(found.rsm, 100, 1e-6);
    assert_int_equal(found.elements_old, 0);
    assert_true(isnan(found.rsm_old));
    /* waves of 30 points are narrower than a hundredth of the profile: hill and dale of 15 each */
    for (size_t i = 0; i < N; i++)
        z[i] = sin(2 * M_PI * (double)i / 30 + 0.1);
    profile_spacing_measure(&profile, 0, &found);
    check_relative(found.rsm, 15, 1e-6);
    assert_int_equal(found.elements_old, 0);
    /* no element across a hole, none without a crossing */
    for (size_t i = 0; i < N; i++)
        z[i] = i % 100 == 99 ? (double)NAN : sin(2 * M_PI * (double)i / 100);
    profile_spacing_measure(&profile, 0, &found);
    assert_true(isnan(found.rsm) && found.elements == 0);
    for (size_t i = 0; i < N; i++)
        z[i] = 1;
    profile_spacing_measure(&profile, 1, &found);
    assert_true(isnan(found.rsm) && isnan(found.rsm_old));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(gaussian_heights),   cmocka_unit_test(exponential_heights),
        cmocka_unit_test(straight_curves),    cmocka_unit_test(any_heights_follow_the_definition),
        cmocka_unit_test(holes_are_left_out), cmocka_unit_test(ten_points),
        cmocka_unit_test(widths_of_elements),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
