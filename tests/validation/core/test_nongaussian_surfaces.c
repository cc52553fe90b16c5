/* Non-Gaussian surfaces of the reference's shapes against their targets: Table 3.3, the exact
 * spectrum, and the limit of long plain alternation. */
#include "core/statistics/summits/summits.h"
#include "core/surface/surface.h"
#include "core/surface/transform.h"
#include "tests/support/check.h"
#include "tests/support/effort.h"
#include <complex.h>
#include <stdlib.h>

/* Square cell of 8 long waves, 8 points a shortest wave, H = 0.8. */
struct surface_scene {
    struct grid grid;
    struct generator *generator;
    double *z;
};

static void scene_create(struct surface_scene *scene, double ratio,
                         const struct surface_options *options) {
    size_t n = (size_t)(64 * ratio);
    struct spectrum spectrum = {.type = SPECTRUM_SELF_AFFINE,
                                .hurst = 0.8,
                                .wavelength_long = ratio,
                                .wavelength_rolloff = ratio,
                                .wavelength_short = 1};
    scene->grid = (struct grid){n, n, 8 * ratio, 8 * ratio};
    scene->generator = NULL;
    scene->z = malloc(n * n * sizeof *scene->z);
    assert_non_null(scene->z);
    assert_int_equal(generator_create(&scene->generator, &spectrum, &scene->grid, options, NULL),
                     0);
}

static void scene_destroy(struct surface_scene *scene) {
    generator_destroy(&scene->generator);
    free(scene->z);
}

static void height_shape(const double *z, size_t n, double *skewness, double *kurtosis) {
    double square = 0, cube = 0, fourth = 0;
    for (size_t i = 0; i < n; i++) {
        double z2 = z[i] * z[i];
        square += z2;
        cube += z2 * z[i];
        fourth += z2 * z2;
    }
    square /= (double)n;
    *skewness = cube / (double)n / pow(square, 1.5);
    *kurtosis = fourth / (double)n / (square * square);
}

static double spectrum_departure(const struct surface_scene *scene) {
    const struct modes *modes = generator_modes(scene->generator);
    struct transform *transform = NULL;
    assert_int_equal(transform_create(&transform, &scene->grid, modes->mode_x, modes->mode_y, NULL),
                     0);
    transform_forward(transform, scene->z);
    size_t ny = scene->grid.ny, compared = 0;
    double worst = 0;
    for (size_t mx = 0; mx <= modes->mode_x; mx++)
        for (long my = -(long)modes->mode_y; my <= (long)modes->mode_y; my++) {
            size_t row = my >= 0 ? (size_t)my : ny - (size_t)-my;
            double wanted = modes_power(modes, mx, my);
            double had = cabs(transform_spectrum(transform)[mx * ny + row]);
            if (!(wanted > 0))
                continue;
            assert_true(isfinite(had));
            worst = fmax(worst, fabs(had * had / wanted - 1));
            compared++;
        }
    assert_true(compared > 1000);
    transform_destroy(&transform);
    return worst;
}

static const double SHAPES[] = {1, 1.2, 1.5, 2, 3.602};
enum { SHAPE_COUNT = sizeof SHAPES / sizeof *SHAPES };

static void surface_meets_its_targets(enum heights_type type, double shape) {
    struct surface_options options = SURFACE_DEFAULTS;
    options.heights = (struct heights){.type = type, .shape = shape};
    options.draw = DRAW_QUANTILES; /* sampling alone moves the skewness of C = 1 by 0.03 here */
    struct height_moments moments;
    assert_int_equal(heights_moments(&options.heights, &moments, NULL), 0);
    struct surface_scene scene;
    scene_create(&scene, 8, &options);
    struct surface_report report;
    struct random_key key = {2021, 0, 1};
    assert_int_equal(generator_run(scene.generator, key, scene.z, &report, NULL), 0);
    double skewness, kurtosis;
    height_shape(scene.z, grid_points(&scene.grid), &skewness, &kurtosis);
    check_close(skewness, moments.skewness, 0.02); /* the project's target */
    check_close(kurtosis, moments.kurtosis, 0.02 * moments.kurtosis);
    check_close(spectrum_departure(&scene), 0, 1e-12); /* rounding of one transform pair */
    /* What was measured with this schedule, doubled. */
    check_close(report.eps_h, 0, 1e-2);
    check_close(report.eps_s, 0, 3e-3);
    check_close(report.eps_s0, 0, 3e-6);
    scene_destroy(&scene);
}

static void minima_meet_their_targets(void **state) {
    (void)state;
    for (size_t c = 0; c < SHAPE_COUNT; c++)
        surface_meets_its_targets(HEIGHTS_WEIBULL_MIN, SHAPES[c]);
}

static void maxima_meet_their_targets(void **state) {
    (void)state;
    for (size_t c = 0; c < SHAPE_COUNT; c++)
        surface_meets_its_targets(HEIGHTS_WEIBULL_MAX, SHAPES[c]);
}

static void lognormal_heights_meet_their_targets(void **state) {
    (void)state;
    static const double DEVIATIONS[] = {0.05, 0.25, 0.4};
    for (size_t s = 0; s < 3; s++)
        surface_meets_its_targets(HEIGHTS_LOGNORMAL, DEVIATIONS[s]);
}

static void gamma_and_beta_heights_meet_their_targets(void **state) {
    (void)state;
    surface_meets_its_targets(HEIGHTS_GAMMA, 2);
    surface_meets_its_targets(HEIGHTS_GAMMA, 20);
    surface_meets_its_targets(HEIGHTS_BETA, 2);
    surface_meets_its_targets(HEIGHTS_BETA, 20);
}

/* Too few modes for the heights asked: what is reached falls short, and the errors say so. */
static void profiles_with_few_modes_say_so(void **state) {
    (void)state;
    struct surface_options options = SURFACE_DEFAULTS;
    options.heights = (struct heights){.type = HEIGHTS_WEIBULL_MIN, .shape = 1};
    options.draw = DRAW_QUANTILES;
    struct spectrum spectrum = {.type = SPECTRUM_SELF_AFFINE,
                                .hurst = 0.8,
                                .wavelength_long = 8,
                                .wavelength_rolloff = 8,
                                .wavelength_short = 1};
    struct grid grid = {512, 1, 64, 1};
    struct generator *generator = NULL;
    double z[512], sum = 0;
    assert_int_equal(generator_create(&generator, &spectrum, &grid, &options, NULL), 0);
    for (uint64_t r = 0; r < 50; r++) {
        struct surface_report report;
        struct random_key key = {2021, 1, r};
        assert_int_equal(generator_run(generator, key, z, &report, NULL), 0);
        assert_true(report.eps_h > 1e-2);
        double skewness, kurtosis;
        height_shape(z, 512, &skewness, &kurtosis);
        sum += skewness / 50;
    }
    check_close(sum, 1.62, 0.1); /* theory's prototype by plain alternation, 57 modes */
    generator_destroy(&generator);
}

enum { COUNT, HEIGHT, CURVATURE, FIGURES };

static void summit_figures(const struct surface_options *options, size_t surfaces,
                           double *figures) {
    struct surface_scene scene;
    struct summit_finder *finder = NULL;
    struct summit_list list = {0};
    scene_create(&scene, 4, options);
    assert_int_equal(summit_finder_create(&finder, &scene.grid, SUMMITS_NINE_POINT,
                                          CURVATURE_FINITE_DIFFERENCE, 0, 0, NULL),
                     0);
    for (uint64_t r = 0; r < surfaces; r++) {
        struct random_key key = {1, 0, r};
        assert_int_equal(generator_run(scene.generator, key, scene.z, NULL, NULL), 0);
        assert_int_equal(summits_find(finder, scene.z, &list, NULL), 0);
        double *of = figures + r * FIGURES;
        of[COUNT] = (double)list.count;
        of[HEIGHT] = of[CURVATURE] = 0;
        for (size_t s = 0; s < list.count; s++) {
            of[HEIGHT] += list.summits[s].height / (double)list.count;
            of[CURVATURE] += list.summits[s].curvature / (double)list.count;
        }
    }
    summit_finder_destroy(&finder);
    summit_list_clear(&list);
    scene_destroy(&scene);
}

/* C = 1 maximum, the hardest: number, mean height and mean curvature of summits of the default
 * iteration against 600 plain ones, paired. 2 % (number), 0.5 % (height) and 1.5 % (curvature) is
 * the difference between generators (bench_nongaussian drift: 600 plain iterations are 0.5, 0.5 and
 * 1 % from 6000, the default 1.1, 0.5 and 0.7 %); the rest is 3 standard errors of the paired
 * mean. */
static void default_iteration_is_near_the_limit(void **state) {
    (void)state;
    const size_t surfaces = 5 * (size_t)effort();
    double *limit = calloc(2 * surfaces * FIGURES, sizeof *limit);
    assert_non_null(limit);
    double *found = limit + surfaces * FIGURES;
    struct surface_options options = SURFACE_DEFAULTS;
    options.heights = (struct heights){.type = HEIGHTS_WEIBULL_MAX, .shape = 1};
    summit_figures(&options, surfaces, found);
    options.iteration = ITERATION_PLAIN;
    options.max_iterations = options.stall_iterations = 600;
    options.tolerance = 0;
    summit_figures(&options, surfaces, limit);
    static const double BIAS[FIGURES] = {0.02, 0.005, 0.015};
    for (size_t f = 0; f < FIGURES; f++) {
        double sum = 0, square = 0;
        for (size_t r = 0; r < surfaces; r++) {
            double ratio = found[r * FIGURES + f] / limit[r * FIGURES + f] - 1;
            sum += ratio / (double)surfaces;
            square += ratio * ratio / (double)surfaces;
        }
        double error = sqrt((square - sum * sum) / (double)(surfaces - 1));
        check_close(sum, 0, BIAS[f] + 3 * error);
    }
    free(limit);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(minima_meet_their_targets),
        cmocka_unit_test(maxima_meet_their_targets),
        cmocka_unit_test(lognormal_heights_meet_their_targets),
        cmocka_unit_test(gamma_and_beta_heights_meet_their_targets),
        cmocka_unit_test(profiles_with_few_modes_say_so),
        cmocka_unit_test(default_iteration_is_near_the_limit),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
