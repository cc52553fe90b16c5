/* Protects the solutions of the linear contact models, and the areas read from them: against the
 * conditions that only a solution meets, Westergaard's wave, the computed wave in two directions,
 * Hertz, full contact, thin layers; and of rough profiles and surfaces, the error of each estimator
 * on the grids that studies use. */
#include "tests/support/check.h"

#include "core/surface/surface.h"
#include "core/theory/contact.h"
#include "tests/support/contact_scene.h"
#include "tests/support/effort.h"
#include "tests/support/hertz.h"

static const struct block LAYERED = {
    .model = MODEL_LAYERED, .poisson = 0.3, .height = 1.5, .layer_growth = 1.1};
static const struct block LAYERED_DUAL = {.model = MODEL_LAYERED,
                                          .poisson = 0.3,
                                          .height = 1.5,
                                          .layer_growth = 1.1,
                                          .weighting = GAP_DUAL};

static struct grid line(size_t n) {
    return (struct grid){.nx = n, .ny = 1, .lx = 1, .ly = 1};
}

static struct grid square(size_t n) {
    return (struct grid){.nx = n, .ny = n, .lx = 1, .ly = 1};
}

/* A rough profile or surface of RMS slope 1: the mean pressure is p/(E* h'). */
struct rough_surface {
    double hurst, ratio, long_waves; /* lambda_l/lambda_s, L/lambda_l */
};

static void fill_rough(const struct grid *grid, const struct rough_surface *roughness, uint64_t run,
                       double *z) {
    struct spectrum spectrum = {.type = SPECTRUM_SELF_AFFINE,
                                .hurst = roughness->hurst,
                                .wavelength_long = 1 / roughness->long_waves,
                                .wavelength_rolloff = 1 / roughness->long_waves,
                                .wavelength_short = 1 / roughness->long_waves / roughness->ratio,
                                .scale = SCALE_RMS_SLOPE,
                                .scale_value = 1};
    struct generator *generator = NULL;
    struct error err = {0};
    struct random_key key = {.seed = 20260101, .realisation = run};
    if (generator_create(&generator, &spectrum, grid, &SURFACE_DEFAULTS, &err) != 0 ||
        generator_run(generator, key, z, NULL, &err) != 0)
        fail_msg("%s", err.text);
    generator_destroy(&generator);
}

/* --- the conditions of contact --- */

static void solutions_meet_the_conditions(void **state) {
    (void)state;
    static const struct grid grids[] = {{256, 1, 1, 1}, {24, 24, 1, 1}, {30, 20, 1, 0.5}};
    static const struct rough_surface rough = {.hurst = 0.5, .ratio = 4, .long_waves = 2};
    const struct block *const blocks[] = {&DEEP, &LAYERED, &LAYERED_DUAL};
    for (size_t a = 0; a < 3; a++)
        for (size_t b = 0; b < 3; b++) {
            struct scene scene;
            scene_open(&scene, grids[a], *blocks[b], 1e-10);
            fill_rough(&grids[a], &rough, 3 * a + b, scene.z);
            scene_begin(&scene);
            for (double load = 1e-4; load < 2; load *= 4) {
                scene_press(&scene, load);
                check_contact(&scene);
            }
            scene_close(&scene);
        }
}

/* Iterations of three faces of so many longest waves a side, at two loads each. */
static size_t iterations_of(size_t long_waves, int dimension) {
    const struct rough_surface rough = {.hurst = 0.8, .ratio = 8, .long_waves = (double)long_waves};
    const struct grid grid = {64 * long_waves, dimension == 2 ? 64 * long_waves : 1, 1, 1};
    struct scene scene;
    size_t iterations = 0;
    scene_open(&scene, grid, DEEP, 1e-5);
    for (uint64_t run = 0; run < 3; run++) {
        fill_rough(&grid, &rough, run, scene.z);
        scene_begin(&scene);
        for (double load = 0.03; load < 0.07; load += 0.03) {
            scene_press(&scene, load);
            iterations += scene.state.iterations;
        }
    }
    scene_close(&scene);
    return iterations;
}

/* Long waves on a cell of 512 take no more steps than twice those of 8: these steps took thousands
 * when each cut pressures at 0, and some hundreds when they were shortened there. */
static void steps_do_not_grow_with_the_cell(void **state) {
    (void)state;
    size_t few = iterations_of(8, 1), many = iterations_of(512, 1);
    print_message("iterations: %zu on 8 longest waves, %zu on 512\n", few, many);
    assert_true(many <= 2 * few);
}

/* Three surfaces of 256 x 256 take 39 steps at two loads each. With residuals that are continued by
 * zeros they take 75, and more on larger cells. */
static void surfaces_take_few_steps(void **state) {
    (void)state;
    size_t iterations = iterations_of(4, 2);
    print_message("iterations: %zu\n", iterations);
    assert_true(iterations <= 54);
}

/* --- Westergaard's wave --- */

static void wave(struct scene *scene, size_t n, const struct block *block, double phase) {
    scene_open(scene, line(n), *block, 1e-10);
    for (size_t i = 0; i < n; i++)
        scene->z[i] = cos(2 * M_PI * ((double)i - phase) / (double)n);
    scene_begin(scene);
}

enum { PHASES = 6, PRESSURES = 20 };

/* Largest and mean relative errors of a wave's area over phases, from 0.1 p* to 0.95 p*. */
static void wave_errors(size_t n, const struct block *block, double *most, double *mean) {
    double count = 0;
    *most = *mean = 0;
    for (size_t a = 0; a < PHASES; a++) {
        struct scene scene;
        wave(&scene, n, block, (double)a / PHASES);
        for (size_t b = 2; b < PRESSURES; b++) {
            double ratio = (double)b / PRESSURES;
            scene_press(&scene, M_PI * ratio);
            double error = fabs(scene_area(&scene).edges / westergaard_area(ratio) - 1);
            *most = fmax(*most, error);
            *mean += error;
            count++;
        }
        scene_press(&scene, 1.01 * M_PI); /* full contact: a finite-element wave is 1 % stiffer */
        assert_true(scene_area(&scene).edges == 1);
        scene_close(&scene);
    }
    *mean /= count;
}

static void areas_of_a_wave(void **state) {
    (void)state;
    const struct block *const blocks[] = {&DEEP, &LAYERED, &LAYERED_DUAL};
    for (size_t b = 0; b < 3; b++) {
        double most[3], mean[3], unused, graded;
        struct block equal = *blocks[b];
        equal.layer_growth = 1; /* growing layers have an error of their own, about 0.1 % */
        for (size_t level = 0; level < 3; level++)
            wave_errors((size_t)32 << level, &equal, &most[level], &mean[level]);
        wave_errors(64, blocks[b], &graded, &unused);
        check_close(most[1], 0, 0.01); /* the target; measured 0.2 to 0.9 % */
        check_close(graded, 0, 0.01);
        /* Measured 0.07, 0.28 and 0.09 %; 0.03, 0.10 and 0.03 %; 0.01, 0.04 and 0.02 %. */
        check_close(mean[0], 0, 0.004);
        check_close(mean[1], 0, 0.0015);
        check_close(mean[2], 0, 0.0007);
    }
}

/* Root mean square error of the pressures over the mean pressure. */
static double pressure_error(const struct scene *scene, double phase, double ratio) {
    size_t n = scene->grid.nx;
    double sum = 0;
    for (size_t i = 0; i < n; i++) {
        double x = ((double)i - phase) / (double)n;
        double error = scene->state.p[i] / scene->state.pressure - westergaard_pressure(x, ratio);
        sum += error * error;
    }
    return sqrt(sum / (double)n);
}

static void pressures_of_a_wave(void **state) {
    (void)state;
    const struct block *const blocks[] = {&DEEP, &LAYERED, &LAYERED_DUAL};
    enum { N = 128 };
    for (size_t b = 0; b < 3; b++)
        for (size_t a = 0; a < 3; a++) {
            double phase = (double)a / 3;
            struct scene scene;
            wave(&scene, N, blocks[b], phase);
            for (size_t c = 1; c < 10; c++) {
                double ratio = (double)c / 10;
                scene_press(&scene, M_PI * ratio);
                /* A node at the edge is off by the square root of a step: measured 0.06 where 13
                 * to 26 nodes touch. */
                check_close(pressure_error(&scene, phase, ratio), 0, 0.08);
                check_close(scene.state.mean_gap, westergaard_gap(ratio), 5e-4); /* half of that */
                /* d gap/d p = ln(ratio)/pi. The discrete contact is as stiff as a punch of whole
                 * steps, so the tangent errs by the first order in them: measured 7 %. */
                check_relative(scene.state.stiffness, M_PI / -log(ratio), 0.1);
            }
            scene_close(&scene);
        }
}

/* --- one wave in two directions --- */

static void wave_in_two_directions(void **state) {
    (void)state;
    static const double ratio[] = {.01, .02, .05, .1, .2, .3, .4, .5, .6, .7, .8, .9, .95};
    static const double area[] = {.0364, .0588, .1130, .1906, .3452, .5141, .6198,
                                  .7041, .7762, .8400, .8976, .9506, .9757};
    static const double peak[] = {.4207,  .5276,  .7094,  .8839,  1.0955, 1.2392, 1.3638,
                                  1.4793, 1.5891, 1.6951, 1.7983, 1.8997, 1.9499};
    static const double gap[] = {.8183, .7288, .5564, .3848, .2046, .1249, .0769,
                                 .0451, .0242, .0111, .0039, .0007, .0001};
    enum { N = 256 };
    struct scene scene;
    scene_open(&scene, square(N), DEEP, 1e-8);
    for (size_t j = 0; j < N; j++)
        for (size_t i = 0; i < N; i++)
            scene.z[j * N + i] = cos(2 * M_PI * (double)i / N) * cos(2 * M_PI * ((double)j) / N);
    scene_begin(&scene);
    double full = M_SQRT2 * M_PI;
    check_relative(contact_full_pressure(scene.contact), full, 1e-12); /* rounding */
    for (size_t a = 0; a < sizeof ratio / sizeof *ratio; a++) {
        scene_press(&scene, ratio[a] * full);
        struct contact_area got = scene_area(&scene);
        check_relative(got.edges, area[a], 5e-3); /* the target; measured 0.3 % at most */
        check_relative(got.perimeter, area[a], 1e-2);
        check_relative(largest((size_t)N * N, scene.state.p) / full, peak[a], 1e-3);
        check_close(scene.state.mean_gap, gap[a], 1e-4); /* digits of the table */
    }
    scene_close(&scene);
}

/* --- Hertz --- */

static void hertz_line(void **state) {
    (void)state;
    enum { N = 1024 };
    const struct block *const blocks[] = {&DEEP, &LAYERED, &LAYERED_DUAL};
    for (size_t b = 0; b < 3; b++) {
        struct scene scene;
        scene_open(&scene, line(N), *blocks[b], 1e-10);
        for (size_t i = 0; i < N; i++) {
            double x = ((double)i - 500.3) / N;
            scene.z[i] = -x * x / 2;
        }
        scene_begin(&scene);
        for (double a = 8.2 / N; a < 40.0 / N; a *= 1.3) {
            double force = M_PI * a * a / 4; /* of radius 1 */
            scene_press(&scene, force);
            /* Images of the cell: (a/L)^2, 0.15 % at most; the rest is the grid's. */
            check_relative(scene_area(&scene).edges, 2 * hertz_line_half_width(force, 1), 5e-3);
            check_relative(largest(N, scene.state.p), 2 * force / (M_PI * a), 5e-3);
        }
        scene_close(&scene);
    }
}

static void hertz_sphere(void **state) {
    (void)state;
    enum { N = 256 };
    const struct block *const blocks[] = {&DEEP, &LAYERED};
    for (size_t b = 0; b < 2; b++) {
        struct scene scene;
        scene_open(&scene, square(N), *blocks[b], 1e-8);
        for (size_t j = 0; j < N; j++)
            for (size_t i = 0; i < N; i++) {
                double x = ((double)i - 120.3) / N, y = ((double)j - 125.6) / N;
                scene.z[j * N + i] = -(x * x + y * y) / 2;
            }
        scene_begin(&scene);
        for (double a = 8.0 / N; a < 20.0 / N; a *= 1.25) {
            double force = 4 * a * a * a / 3; /* of radius 1 */
            double radius = hertz_sphere_radius(force, 1), area = M_PI * radius * radius;
            scene_press(&scene, force);
            check_relative(scene_area(&scene).edges, area, 1e-2); /* measured 0.4, layered 0.6 % */
            check_relative(largest((size_t)N * N, scene.state.p), 1.5 * force / area, 1e-2);
        }
        scene_close(&scene);
    }
}

/* --- full contact, thin layers, stiffness --- */

/* Two waves pressed flat: p = p0 + sum of E* k/2 times each, pointwise; a little before, the same
 * but next to the point that opens. */
static void full_contact(void **state) {
    (void)state;
    enum { N = 48, POINTS = N * N };
    struct scene scene;
    scene_open(&scene, square(N), DEEP, 1e-12);
    for (size_t i = 0; i < POINTS; i++) {
        size_t row = i / N;
        double x = 2 * M_PI * (double)(i % N) / N, y = 2 * M_PI * (double)row / N;
        scene.z[i] = cos(x) + 0.1 * sin(3 * x + 4 * y);
    }
    scene_begin(&scene);
    double full = contact_full_pressure(scene.contact);
    for (size_t before = 0; before < 2; before++) {
        scene_press(&scene, full * (before ? 1 - 1e-9 : 1));
        double least = INFINITY;
        for (size_t i = 0; i < POINTS; i++) {
            size_t row = i / N;
            double x = 2 * M_PI * (double)(i % N) / N, y = 2 * M_PI * (double)row / N;
            double exact = full + M_PI * cos(x) + 0.1 * M_PI * 5 * sin(3 * x + 4 * y);
            check_close(scene.state.p[i], exact, 1e-8 * full); /* the target; the step is 1e-9 */
            least = fmin(least, exact);
        }
        check_close(least, 0, 1e-12 * full); /* rounding */
        /* Four points are the lowest alike. */
        assert_true(before ? scene.state.nodes < POINTS && scene.state.nodes >= POINTS - 4
                           : scene.state.nodes == POINTS);
        assert_true(isinf(scene.state.stiffness) == !before);
    }
    scene_close(&scene);
}

/* A layer much thinner than the wave on its flat far side is a row of springs, p = depth/height (in
 * E*: the oedometric modulus without friction at either face). So z = cos(psi) pressed to a
 * half-width psi_a has a mean pressure of (sin psi_a - psi_a cos psi_a)/(pi height). */
static void thin_layer(void **state) {
    (void)state;
    enum { N = 128 };
    struct block half = DEEP, elements = LAYERED_DUAL;
    half.height = elements.height = 1e-3;
    elements.layer_growth = 1;
    const struct block *const blocks[] = {&half, &elements};
    for (size_t b = 0; b < 2; b++) {
        struct scene scene;
        wave(&scene, N, blocks[b], 0.3);
        for (double a = 0.15; a < 0.9; a += 0.1) {
            double psi = M_PI * a;
            scene_press(&scene, (sin(psi) - psi * cos(psi)) / (M_PI * 1e-3));
            /* Edges are no square roots here: half a step each side, 2/128. */
            check_close(scene_area(&scene).nodes, a, 1.0 / N);
            check_close(scene.state.p[0], (cos(2 * M_PI * 0.3 / N) - cos(psi)) / 1e-3, 10);
            /* As the flat sinks by 1, springs in contact take 1/height each, and the open part of
             * the gap closes by 1. The shortest waves, 8 heights long, are not springs: 2 %. */
            double touching = scene_area(&scene).nodes;
            check_relative(scene.state.stiffness, touching / (1 - touching) / 1e-3, 0.03);
        }
        scene_close(&scene);
    }
}

static void stiffness_is_a_derivative(void **state) {
    (void)state;
    static const struct grid grids[] = {{512, 1, 1, 1}, {64, 64, 1, 1}};
    static const struct rough_surface rough = {.hurst = 0.8, .ratio = 4, .long_waves = 2};
    const struct block *const blocks[] = {&DEEP, &LAYERED, &LAYERED_DUAL};
    for (size_t a = 0; a < 2; a++)
        for (size_t b = 0; b < 3; b++) {
            struct scene scene;
            scene_open(&scene, grids[a], *blocks[b], 1e-12);
            fill_rough(&grids[a], &rough, b, scene.z);
            scene_begin(&scene);
            for (double load = 0.01; load < 0.6; load *= 3) {
                double step = 1e-6 * load;
                scene_press(&scene, load - step);
                double before = scene.state.mean_gap;
                scene_press(&scene, load + step);
                double after = scene.state.mean_gap;
                scene_press(&scene, load);
                /* Gaps of 1e-12 over steps of 1e-6; of the tangent 3e-4 was measured. */
                check_relative(scene.state.stiffness, 2 * step / (before - after), 1e-3);
            }
            scene_close(&scene);
        }
}

/* --- rough profiles --- */

enum { PROFILES = 20, LOADS = 8 };
static const double LOAD[LOADS] = {0.01, 0.02, 0.03, 0.05, 0.1, 0.2, 0.3, 0.5};

struct mean_areas {
    double nodes[LOADS], edges[LOADS], perimeter[LOADS], gap[LOADS], patches[LOADS];
};

static void add_areas(const struct grid *grid, const struct block *block, double tolerance,
                      const struct rough_surface *rough, uint64_t runs, struct mean_areas *out) {
    struct scene scene;
    struct patch_finder *finder = NULL;
    struct error err = {0};
    scene_open(&scene, *grid, *block, tolerance);
    assert_int_equal(patch_finder_create(&finder, grid, &err), 0);
    *out = (struct mean_areas){0};
    for (uint64_t run = 0; run < runs; run++) {
        fill_rough(grid, rough, run, scene.z);
        scene_begin(&scene);
        for (size_t a = 0; a < LOADS; a++) {
            struct patches patches;
            scene_press(&scene, LOAD[a]);
            struct contact_area area = scene_area(&scene);
            patches_find(finder, scene.state.p, &patches, NULL);
            out->nodes[a] += area.nodes / (double)runs;
            out->edges[a] += area.edges / (double)runs;
            out->perimeter[a] += area.perimeter / (double)runs;
            out->gap[a] += area.mean_gap / (double)runs;
            out->patches[a] += (double)patches.count / (double)runs;
        }
    }
    patch_finder_destroy(&finder);
    scene_close(&scene);
}

/* Areas at 8 points a shortest wave against those at 64. */
static void rough_profiles(void **state) {
    (void)state;
    static const struct {
        const struct block *block;
        /* Largest errors of `edges`: at a fraction of 3 %, above 10 %; steps too many that nodes
         * count a patch. Half-spaces: the targets. The standard weighting smooths the gap over
         * three nodes, which a shortest wave feels. Overcounts: measured 0.34 to 0.44, 0.12 to
         * 0.22, 0.44 to 0.53. */
        double light, heavy, overcount;
    } cases[] = {{&DEEP, 0.025, 0.012, 0.38},
                 {&LAYERED, 0.04, 0.04, 0.17},
                 {&LAYERED_DUAL, 0.025, 0.02, 0.49}};
    for (size_t b = 0; b < 3; b++)
        for (size_t h = b % 2; h < 2; h += case_step()) {
            struct rough_surface rough = {.hurst = h ? 0.8 : 0.2, .ratio = 8, .long_waves = 8};
            struct grid coarse = line(512), fine = line(4096);
            struct mean_areas few, many;
            double nodes = 0, edges = 0;
            add_areas(&coarse, cases[b].block, 1e-8, &rough, PROFILES, &few);
            add_areas(&fine, cases[b].block, 1e-6, &rough, PROFILES, &many);
            for (size_t a = 0; a < LOADS; a++) {
                bool heavy = many.edges[a] > 0.1;
                check_relative(few.edges[a], many.edges[a], heavy ? cases[b].heavy : 0.045);
                check_close((few.nodes[a] - many.edges[a]) * 512 / few.patches[a],
                            cases[b].overcount, 0.07);
                nodes += heavy ? fabs(few.nodes[a] / many.edges[a] - 1) : 0;
                edges += heavy ? fabs(few.edges[a] / many.edges[a] - 1) : 0;
            }
            check_relative(few.edges[0], many.edges[0], cases[b].light); /* fraction 3.4 % */
            /* The target, on average over fractions above 10 %: measured 11 and 12. */
            assert_true(b > 0 || edges * 8 <= nodes);
        }
}

/* The same of one surface each, against 32 points. */
static void rough_surfaces(void **state) {
    (void)state;
    for (size_t h = 0; h < 2; h += case_step()) {
        struct rough_surface rough = {.hurst = h ? 0.8 : 0.2, .ratio = 4, .long_waves = 4};
        struct grid coarse = square(128), fine = square(512);
        struct mean_areas few, many;
        add_areas(&coarse, &DEEP, 1e-8, &rough, 1, &few);
        add_areas(&fine, &DEEP, 1e-5, &rough, 1, &many);
        for (size_t a = 0; a < LOADS; a++) {
            /* The target above 5 %; measured 0.9 % at most at any fraction. */
            check_relative(few.edges[a], many.edges[a], 0.015);
            /* Half of the error is left: measured 3.4 %, where nodes are 9 to 16 % off; at 32
             * points 1.05 %. */
            check_relative(few.perimeter[a], many.edges[a], 0.045);
            check_relative(many.perimeter[a], many.edges[a], 0.015);
        }
    }
}

/* Finite elements at 8 points a shortest wave against the exact layer at 32, on surfaces that no
 * law was learnt on. The mean gap's error is taken off to first order, the area's to second. */
static void rough_surfaces_of_elements(void **state) {
    (void)state;
    static const struct {
        double poisson, growth;
        enum gap_weighting weighting;
    } cases[] = {{0.3, 1.1, GAP_STANDARD},
                 {0, 1.3, GAP_STANDARD},
                 {0.4999, 1, GAP_STANDARD},
                 {0.3, 1, GAP_DUAL},
                 {0.4999, 1.3, GAP_DUAL}};
    struct rough_surface rough = {.hurst = 0.8, .ratio = 4, .long_waves = 2};
    struct block layer = {.model = MODEL_HALFSPACE, .height = 1.5};
    struct grid coarse = square(64), fine = square(256);
    struct mean_areas few, many;
    add_areas(&fine, &layer, 1e-6, &rough, 6, &many);
    for (size_t b = 0; b < sizeof cases / sizeof *cases; b++) {
        struct block block = {.model = MODEL_LAYERED,
                              .poisson = cases[b].poisson,
                              .height = 1.5,
                              .layer_growth = cases[b].growth,
                              .weighting = cases[b].weighting};
        add_areas(&coarse, &block, 1e-8, &rough, 6, &few);
        for (size_t a = 0; a < LOADS; a++) { /* fractions from 0.024 */
            bool light = many.edges[a] < 0.04;
            check_relative(few.edges[a], many.edges[a], light ? 0.02 : 0.012);
            check_relative(few.perimeter[a], many.edges[a], light ? 0.06 : 0.03);
            check_relative(few.gap[a], many.gap[a], 0.002);
        }
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(solutions_meet_the_conditions),
        cmocka_unit_test(steps_do_not_grow_with_the_cell),
        cmocka_unit_test(surfaces_take_few_steps),
        cmocka_unit_test(areas_of_a_wave),
        cmocka_unit_test(pressures_of_a_wave),
        cmocka_unit_test(wave_in_two_directions),
        cmocka_unit_test(hertz_line),
        cmocka_unit_test(hertz_sphere),
        cmocka_unit_test(full_contact),
        cmocka_unit_test(thin_layer),
        cmocka_unit_test(stiffness_is_a_derivative),
        cmocka_unit_test(rough_profiles),
        cmocka_unit_test(rough_surfaces),
        cmocka_unit_test(rough_surfaces_of_elements),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
