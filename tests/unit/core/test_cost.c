/* What surfaces are said to cost before they run, beside what they take. */
#include "core/contact/contact.h"
#include "core/cost.h"
#include "core/full/friction/friction.h"
#include "tests/support/check.h"
#include <stdlib.h>

/* Returns the iterations that an estimate is for, by what one iteration more adds to it. */
static double expected_iterations(const struct surface_options *options, const struct grid *grid) {
    struct surface_options few = *options;
    few.max_iterations = 1;
    double one = cost_generation(&few, grid);
    few.max_iterations = 4; /* of these 1 or 3 are exact ones at the end */
    double four = cost_generation(&few, grid), all = cost_generation(options, grid);
    few.max_iterations = 5;
    double each = cost_generation(&few, grid) - four;
    assert_true(each > 0 && four > one && all >= four);
    return 4 + (all - four) / each;
}

/* A tolerance that ends an iteration early is seen by the estimate: within 2 of what surfaces take,
 * which is what estimates promise. Fitted to the same kinds of surface, here of another seed. */
static void tolerances_cost_what_they_take(void **state) {
    (void)state;
    static const struct heights HEIGHTS[] = {{.type = HEIGHTS_WEIBULL_MIN, .shape = 1},
                                             {.type = HEIGHTS_WEIBULL_MAX, .shape = 2},
                                             {.type = HEIGHTS_WEIBULL_MIN, .shape = 3.602},
                                             {.type = HEIGHTS_LOGNORMAL, .shape = 0.25}};
    static const double TOLERANCES[] = {0, 0.01, 0.03};
    const struct spectrum spectrum = {.type = SPECTRUM_SELF_AFFINE,
                                      .hurst = 0.8,
                                      .wavelength_long = 4,
                                      .wavelength_rolloff = 4,
                                      .wavelength_short = 1};
    const struct grid grid = {256, 256, 32, 32};
    double *z = malloc(grid_points(&grid) * sizeof *z);
    assert_non_null(z);
    for (size_t h = 0; h < sizeof HEIGHTS / sizeof *HEIGHTS; h++) {
        struct surface_options options = SURFACE_DEFAULTS;
        struct generator *generator = NULL;
        options.heights = HEIGHTS[h];
        assert_int_equal(generator_create(&generator, &spectrum, &grid, &options, NULL), 0);
        for (size_t t = 0; t < sizeof TOLERANCES / sizeof *TOLERANCES; t++) {
            struct surface_report report;
            options.tolerance = TOLERANCES[t];
            const struct surface_aim aim = {options.iteration, options.tolerance,
                                            options.stall_iterations, options.max_iterations};
            generator_aim(generator, &aim);
            assert_int_equal(
                generator_run(generator, (struct random_key){7, 0, 0}, z, &report, NULL), 0);
            double ratio = expected_iterations(&options, &grid) / (double)report.iterations;
            if (!(ratio > 0.5 && ratio < 2))
                fail_msg("heights %zu, tolerance %g: expected %g times the %zu iterations taken", h,
                         TOLERANCES[t], ratio, report.iterations);
        }
        generator_destroy(&generator);
    }
    free(z);
}

/* Choices of contact are made for whatever tolerance: without one the size does not matter. */
static void sizes_do_not_matter_without_a_tolerance(void **state) {
    (void)state;
    struct surface_options options = SURFACE_DEFAULTS;
    const struct grid small = {64, 64, 8, 8}, large = {4096, 4096, 512, 512};
    options.heights = (struct heights){.type = HEIGHTS_WEIBULL_MIN, .shape = 1};
    options.tolerance = 0;
    double cost = cost_generation(&options, &small);
    assert_true(cost > 0 && cost == cost_generation(&options, &large));
    options.tolerance = 0.01;
    assert_true(cost_generation(&options, &large) < cost / 2);
    assert_true(cost_generation(&options, NULL) == cost);
}

/* value is within a factor of what is expected. */
static void check_factor(double value, double expected, double factor) {
    assert_true(value < factor * expected && value > expected / factor);
}

/* Linear equations of surfaces that are dragged take 1.4 times as many iterations as those of
 * loads, where blocks are nearly incompressible, too: measured 2.5 and 6.0, said to be 2.7 and 6.7.
 */
static void surfaces_with_friction_iterate_as_estimated(void **state) {
    (void)state;
    enum { N = 16 };
    static const double POISSON[] = {0.3, 0.4999}, SLOPE = 0.05, MU = 0.3;
    const struct grid grid = {N, N, 1, 1};
    double z[N * N], square = 0;
    for (size_t i = 0; i < N * N; i++) {
        const size_t row = i / N;
        double x = 2 * M_PI * (double)(i % N) / N, y = 2 * M_PI * (double)row / N;
        z[i] = cos(x + 1) + 0.7 * cos(y) + 0.4 * cos(2 * x + y + 2) + 0.3 * cos(x - 2 * y);
    }
    square = (1 + 0.49 + 5 * 0.16 + 5 * 0.09) * 2 * M_PI * M_PI;
    for (size_t i = 0; i < N * N; i++)
        z[i] *= SLOPE / sqrt(square);
    for (size_t a = 0; a < 2; a++) {
        const struct block block = {.model = MODEL_LAYERED,
                                    .poisson = POISSON[a],
                                    .height = 1.5,
                                    .layer_growth = 1.1,
                                    .weighting = GAP_DUAL};
        const struct friction_options with = {.coefficient = MU};
        struct full_options options = FULL_DEFAULTS;
        struct friction *friction;
        struct friction_state dragged;
        struct error err = {0};
        double newton = 0, linear = 0;
        options.tolerance = 1e-4;
        if (friction_create(&friction, &grid, &block, &options, &with, &err) != 0 ||
            friction_begin(friction, z, &err) != 0 ||
            friction_press(friction, 0.1 * SLOPE, &dragged, &err) != 0)
            fail_msg("%s", err.text);
        const double shear = MU * 0.1 * SLOPE * 1.5 * 2 / (1 - POISSON[a]);
        for (int step = 1; step <= 4; step++) {
            if (friction_drag(friction, shear * step / 16, &dragged, &err) != 0)
                fail_msg("%s", err.text);
            newton += (double)dragged.newton;
            linear += (double)dragged.linear;
        }
        const struct full_size load = cost_full_size(&grid, &block, &options, SLOPE);
        const struct friction_work work = {.grid = &grid,
                                           .load = &load,
                                           .coefficient = MU,
                                           .rms_slope = SLOPE,
                                           .poisson = POISSON[a],
                                           .pressure = 0.1,
                                           .wave = 4,
                                           .leg = 16};
        check_factor(linear / newton, cost_friction_size(&work).linear, 1.5);
        friction_destroy(&friction);
    }
}

/* Steps of profiles that are dragged take the iterations, solutions and factorisations that are
 * estimated, over slope, Poisson's ratio and coefficient: 1.08 to 1.25, 1.04 to 1.13 and 0.77
 * to 1.15 of them are seen. There are few factorisations, so that a factor of 2 is allowed with one
 * more. */
static void profiles_with_friction_iterate_as_estimated(void **state) {
    (void)state;
    enum { N = 64, STEPS = 16 };
    static const struct {
        double slope, poisson, friction;
    } CASES[] = {{0.05, 0.3, 0.3}, {0.2, 0, 0.6}, {0.2, 0.4999, 0.3}, {0.5, 0.45, 0.3}};
    const struct grid grid = {N, 1, 1, 1};
    for (size_t c = 0; c < sizeof CASES / sizeof *CASES; c++) {
        const double slope = CASES[c].slope, nu = CASES[c].poisson, mu = CASES[c].friction;
        const struct block block = {.model = MODEL_LAYERED,
                                    .poisson = nu,
                                    .height = 1.5,
                                    .layer_growth = 1.1,
                                    .weighting = GAP_DUAL};
        const struct friction_options with = {.coefficient = mu};
        struct full_options options = FULL_DEFAULTS;
        struct friction *friction;
        struct friction_state dragged;
        struct error err = {0};
        double z[N] = {0}, square = 0, newton = 0, linear = 0, factored = 0;
        for (int k = 2; k <= 16; k++)
            square += pow(k, -2.6) * 2 * M_PI * M_PI * k * k;
        for (int i = 0; i < N; i++)
            for (int k = 2; k <= 16; k++)
                z[i] += slope * pow(k, -1.3) * cos(2 * M_PI * k * i / N + k * k) / sqrt(square);
        options.tolerance = 1e-4;
        if (friction_create(&friction, &grid, &block, &options, &with, &err) != 0 ||
            friction_begin(friction, z, &err) != 0 ||
            friction_press(friction, 0.1 * slope, &dragged, &err) != 0)
            fail_msg("%s", err.text);
        const double shear = mu * 0.1 * slope * 1.5 * 2 / (1 - nu);
        for (int step = 1; step <= STEPS; step++) {
            if (friction_drag(friction, 1.2 * shear * step / STEPS, &dragged, &err) != 0)
                fail_msg("%s", err.text);
            newton += (double)dragged.newton;
            linear += (double)dragged.linear;
            factored += (double)dragged.factored;
        }
        const struct full_size load = cost_full_size(&grid, &block, &options, slope);
        const struct friction_size step =
            cost_friction_size(&(struct friction_work){.grid = &grid,
                                                       .load = &load,
                                                       .coefficient = mu,
                                                       .rms_slope = slope,
                                                       .poisson = nu,
                                                       .pressure = 0.1,
                                                       .wave = 4,
                                                       .leg = 30});
        check_factor(newton, STEPS * step.newton, 1.5);
        check_factor(linear / newton, step.linear, 1.5);
        check_factor(1 + factored, 1 + STEPS * step.factored, 2);
        friction_destroy(&friction);
    }
}

/* Returns the points x transforms of ten loads on a surface. */
static double work_of(const struct grid *grid, const struct contact_options *options) {
    enum { LOADS = 10 };
    const struct block block = {.model = MODEL_HALFSPACE, .height = INFINITY, .layer_growth = 1};
    const struct spectrum spectrum = {.type = SPECTRUM_SELF_AFFINE,
                                      .hurst = 0.8,
                                      .wavelength_long = grid->lx / 8,
                                      .wavelength_rolloff = grid->lx / 8,
                                      .wavelength_short = 1,
                                      .scale = SCALE_RMS_SLOPE,
                                      .scale_value = 1};
    struct generator *generator;
    struct compliance *compliance;
    struct contact *contact;
    struct contact_state state;
    double *z = array_create(grid_points(grid), sizeof *z), work = 0;
    assert_non_null(z);
    assert_int_equal(generator_create(&generator, &spectrum, grid, &SURFACE_DEFAULTS, NULL), 0);
    assert_int_equal(generator_run(generator, (struct random_key){7, 0, 0}, z, NULL, NULL), 0);
    assert_int_equal(compliance_create(&compliance, grid, &block, NULL), 0);
    assert_int_equal(contact_create(&contact, compliance, options, NULL), 0);
    assert_int_equal(contact_begin(contact, z, NULL), 0);
    for (int k = 1; k <= LOADS; k++) {
        assert_int_equal(contact_press(contact, 0.03 * k, &state, NULL), 0);
        work += state.work;
    }
    contact_destroy(&contact);
    compliance_destroy(&compliance);
    generator_destroy(&generator);
    free(z);
    return work;
}

/* The estimate of contact falls with the tolerance, and without stiffness, as the transforms do:
 * within 1.4, as a surface is one of many, and areas take the same time at any tolerance. */
static void contact_costs_what_it_takes(void **state) {
    (void)state;
    static const struct grid GRIDS[] = {{2048, 1, 256, 256}, {128, 128, 16, 16}};
    for (size_t g = 0; g < sizeof GRIDS / sizeof *GRIDS; g++) {
        struct contact_options options = CONTACT_DEFAULTS;
        struct linear_work linear = {
            .grid = &GRIDS[g], .tangent = true, .tolerance = 1e-8, .loads = 10};
        double work = work_of(&GRIDS[g], &options), cost = cost_linear_loads(&linear);
        options.tolerance = linear.tolerance = 1e-4;
        double loose = work_of(&GRIDS[g], &options) / work;
        check_factor(cost_linear_loads(&linear) / cost, loose, 1.4);
        options.without_tangent = true;
        linear.tangent = false;
        double secant = work_of(&GRIDS[g], &options) / work;
        assert_true(secant < 0.9 * loose);
        check_factor(cost_linear_loads(&linear) / cost, secant, 1.4);
    }
}

/* Presses one rough block at six loads up to 0.3 E* h', and adds up the iterations. */
static struct full_report iterations_of(const struct grid *grid, double slope, double poisson,
                                        struct full_size *expected) {
    enum { LOADS = 6 };
    const struct block block = {.poisson = poisson,
                                .height = 1.5 * grid->lx,
                                .layer_growth = 1.1,
                                .weighting = GAP_STANDARD};
    const struct spectrum spectrum = {.type = SPECTRUM_SELF_AFFINE,
                                      .hurst = 0.8,
                                      .wavelength_long = fmin(8, grid->lx),
                                      .wavelength_rolloff = fmin(8, grid->lx),
                                      .wavelength_short = 1,
                                      .scale = SCALE_RMS_SLOPE,
                                      .scale_value = slope};
    struct full_options options = FULL_DEFAULTS;
    struct generator *generator;
    struct full *full;
    struct contact_state state;
    struct full_report report, sum = {0};
    double *z = array_create(grid_points(grid), sizeof *z);
    options.tolerance = 3e-5;
    assert_non_null(z);
    assert_int_equal(generator_create(&generator, &spectrum, grid, &SURFACE_DEFAULTS, NULL), 0);
    assert_int_equal(generator_run(generator, (struct random_key){7, 0, 0}, z, NULL, NULL), 0);
    assert_int_equal(full_create(&full, grid, &block, &options, NULL), 0);
    assert_int_equal(full_begin(full, z, NULL), 0);
    for (int k = 1; k <= LOADS; k++) {
        assert_int_equal(full_press(full, 0.05 * k * slope, &state, &report, NULL), 0);
        sum.newton += report.newton;
        sum.linear += report.linear;
        sum.factored += report.factored;
    }
    *expected = cost_full_size(grid, &block, &options, slope);
    expected->linear *= LOADS * expected->newton;
    expected->newton *= LOADS;
    full_destroy(&full);
    generator_destroy(&generator);
    free(z);
    return sum;
}

/* Iterations of finite elements over slope, Poisson's ratio and dimension, within 1.5 of what is
 * expected; 0.69 to 1.12 of that are seen. */
static void elements_take_the_iterations_expected(void **state) {
    (void)state;
    static const struct grid GRIDS[] = {{256, 1, 32, 32}, {16, 16, 2, 2}};
    static const double SLOPES[] = {0.05, 0.2, 0.5}, POISSON[] = {0.3, 0.4999};
    for (size_t c = 0; c < 12; c++) {
        struct full_size expected;
        double slope = SLOPES[c / 2 % 3], poisson = POISSON[c / 6];
        struct full_report sum = iterations_of(&GRIDS[c % 2], slope, poisson, &expected);
        assert_int_equal(sum.factored, 0);
        assert_false(expected.factored);
        check_factor((double)sum.newton, expected.newton, 1.5);
        check_factor((double)sum.linear, expected.linear, 1.5);
    }
}

/* Gentle faces and small strains expect no jumps; steep faces more with the slope, a longer cell
 * and a longer path, each within a limit, and some realisations far more than the mean. */
static void steep_faces_expect_jumps(void **state) {
    (void)state;
    static const struct grid SHORT = {128, 1, 16, 1}, LONG = {512, 1, 64, 1};
    const struct block block = {.poisson = 0.3, .height = 24, .layer_growth = 1.1};
    struct full_options options = FULL_DEFAULTS;
    double before = 0;
    for (double slope = 0.1; slope < 1.3; slope += 0.1) {
        const struct full_size size = cost_full_size(&SHORT, &block, &options, slope);
        const struct cost_jumps jumps = cost_full_jumps(&SHORT, &size, 8, slope, 0.1, INFINITY);
        assert_true(slope > 0.6 || jumps.seconds == 0);
        assert_true(slope < 0.7 || (jumps.seconds > before && jumps.variance > 0));
        before = jumps.seconds;
    }
    const struct full_size size = cost_full_size(&SHORT, &block, &options, 1);
    const struct full_size more = cost_full_size(&LONG, &block, &options, 1);
    const struct cost_jumps all = cost_full_jumps(&SHORT, &size, 8, 1, 0.1, INFINITY);
    const struct cost_jumps limited = cost_full_jumps(&SHORT, &size, 8, 1, 0.1, all.seconds / 10);
    assert_true(all.variance > all.seconds * all.seconds);
    assert_true(cost_full_jumps(&LONG, &more, 8, 1, 0.1, INFINITY).seconds > 4 * all.seconds);
    assert_true(limited.seconds < all.seconds / 10 && limited.variance < all.variance / 100);
    struct friction_work work = {.grid = &SHORT,
                                 .load = &size,
                                 .coefficient = 0.2,
                                 .rms_slope = 1,
                                 .poisson = 0.3,
                                 .pressure = 0.1,
                                 .wave = 8,
                                 .leg = 16};
    assert_true(cost_friction_jumps(&work, 4, INFINITY).seconds == 0);
    work.coefficient = 1;
    assert_true(cost_friction_jumps(&work, 0, INFINITY).seconds == 0);
    const double once = cost_friction_jumps(&work, 1, INFINITY).seconds;
    static const struct grid IN_METRES = {128, 1, 16e-6, 1e-6}; /* of maps */
    struct friction_work map = work;
    map.grid = &IN_METRES;
    assert_true(cost_friction_jumps(&map, 1, INFINITY).seconds == once);
    assert_true(cost_full_jumps(&IN_METRES, &size, 8, 1, 0.1, INFINITY).seconds == all.seconds);
    assert_true(once > 0 && cost_friction_jumps(&work, 3, INFINITY).seconds > 2.9 * once);
    options.kinematics = KINEMATICS_SMALL;
    const struct full_size small = cost_full_size(&SHORT, &block, &options, 1);
    assert_true(cost_full_jumps(&SHORT, &small, 8, 1, 0.1, INFINITY).seconds == 0);
}

/* Surfaces that may overhang have room for 120 directions in place of 24. */
static void overhangs_take_memory(void **state) {
    (void)state;
    static const struct grid GRID = {32, 32, 4, 4};
    static const double SLOPES[] = {0.5, 1};
    const struct block block = {.poisson = 0.3, .height = 6, .layer_growth = 1.1};
    const struct full_options options = FULL_DEFAULTS;
    double bytes[2] = {0}, directions = 0;
    for (size_t a = 0; a < 2; a++) {
        const struct full_size size = cost_full_size(&GRID, &block, &options, SLOPES[a]);
        bytes[a] = cost_full_bytes(&GRID, &block, &options, &size);
        directions = 2 * (120 - 24) * sizeof(double) * size.degrees_of_freedom;
        assert_true(size.overhangs == (a == 1));
    }
    assert_true(bytes[0] > 0 && bytes[1] > bytes[0] + directions);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(surfaces_with_friction_iterate_as_estimated),
        cmocka_unit_test(profiles_with_friction_iterate_as_estimated),
        cmocka_unit_test(tolerances_cost_what_they_take),
        cmocka_unit_test(sizes_do_not_matter_without_a_tolerance),
        cmocka_unit_test(contact_costs_what_it_takes),
        cmocka_unit_test(elements_take_the_iterations_expected),
        cmocka_unit_test(steep_faces_expect_jumps),
        cmocka_unit_test(overhangs_take_memory),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
