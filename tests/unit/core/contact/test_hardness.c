/* Protects contact under a hardness: what is refused; digits without a hardness where no node
 * reaches it; faces so soft that their heights alone decide; conditions of every solution in all
 * models; unloading, which is elastic but under stiff coatings, and loads that rise again; both
 * stiffnesses. */
#include "tests/support/check.h"

#include "core/contact/pressures.h"
#include "tests/support/effort.h"
#include "tests/support/hard_scene.h"
#include <stdio.h>

static const struct block LAYERED = {
    .model = MODEL_LAYERED, .poisson = 0.3, .height = 1.5, .layer_growth = 1.2};

static double next_uniform(void *context) {
    size_t *i = context;
    double x = sin(12.9898 * (double)++*i) * 43758.5453;
    return x - floor(x);
}

/* A face whose hardness is so many RMS slopes. Returns that hardness. */
static double hard_scene(struct scene *scene, struct grid grid, struct block block, double hardness,
                         size_t seed) {
    scene_open(scene, grid, block, 1e-11);
    double slope = fill_waves(&grid, 0.5, 0.05, next_uniform, &seed, scene->z);
    scene_harden(scene, hardness * slope);
    return hardness * slope;
}

static struct block block_of(size_t kind) {
    struct block block = kind == 0 ? DEEP : LAYERED;
    block.weighting = kind == 1 ? GAP_STANDARD : GAP_DUAL;
    return block;
}

static const struct grid GRIDS[] = {{20, 17, 1, 1}, {40, 1, 1, 1}, {9, 12, 1, 1}, {65, 1, 1, 1}};

/* A grid and a block: each kind of block with a surface and a profile. */
static const size_t CASES[] = {0, 1, 6, 5, 8, 11};
enum { CASE_COUNT = sizeof CASES / sizeof *CASES };

static void what_is_refused(void **state) {
    (void)state;
    struct scene scene;
    struct error err = {0};
    struct contact *contact = NULL;
    double hardness = hard_scene(&scene, GRIDS[0], DEEP, 0.3, 1);
    static const double BAD[] = {0, -1, NAN, -INFINITY};
    for (size_t a = 0; a < sizeof BAD / sizeof *BAD; a++) {
        struct contact_options options = CONTACT_DEFAULTS;
        options.hardness = BAD[a];
        assert_int_equal(contact_create(&contact, scene.compliance, &options, &err), ERROR_INPUT);
        assert_null(contact);
        assert_non_null(strstr(err.text, "hardness = "));
        assert_non_null(strstr(err.text, "allowed: above 0, or infinite"));
    }
    scene_press(&scene, 0.5 * hardness);
    struct contact_state before = scene.state, after = before;
    static const double LOADS[] = {1, 1 + 1e-15, 7};
    for (size_t a = 0; a < sizeof LOADS / sizeof *LOADS; a++) {
        char text[80];
        assert_int_equal(contact_press(scene.contact, LOADS[a] * hardness, &after, &err),
                         ERROR_INPUT);
        snprintf(text, sizeof text, "mean pressure = %g E* on a face of hardness %g E*",
                 LOADS[a] * hardness, hardness);
        assert_non_null(strstr(err.text, text));
        assert_non_null(strstr(err.text, "allowed: below the hardness"));
        assert_memory_equal(&after, &before, sizeof after);
    }
    scene_press(&scene, 0.999 * hardness);
    check_hard_contact(&scene, hardness, true);
    scene_close(&scene);
}

/* A hardness above all pressures changes no digit, even by a rounding error. */
static void no_node_yields(void **state) {
    (void)state;
    static const double LOADS[] = {1e-4, 0.01, 0.05, 0.2, 0.1, 0.6, 1.2},
                        ABOVE[] = {1e-9, 0.1, 1e9};
    enum { COUNT = sizeof LOADS / sizeof *LOADS };
    for (size_t b = 0; b < CASE_COUNT; b++) {
        const size_t a = CASES[b];
        struct scene plain, hard;
        struct grid grid = GRIDS[a % 4];
        size_t n = grid_points(&grid);
        hard_scene(&plain, grid, block_of(a / 4), INFINITY, a);
        hard_scene(&hard, grid, block_of(a / 4), INFINITY, a);
        double full = contact_full_pressure(plain.contact), peak = 0;
        for (size_t l = 0; l < COUNT; l++) {
            scene_press(&plain, LOADS[l] * full);
            peak = fmax(peak, largest(n, plain.state.p));
        }
        scene_begin(&plain);
        scene_harden(&hard, peak * (1 + ABOVE[a % 3]));
        for (size_t l = 0; l < COUNT; l++) {
            scene_press(&plain, LOADS[l] * full);
            scene_press(&hard, LOADS[l] * full);
            assert_memory_equal(hard.state.p, plain.state.p, n * sizeof(double));
            assert_memory_equal(hard.state.gap, plain.state.gap, n * sizeof(double));
            assert_memory_equal(hard.state.opening, plain.state.opening, n * sizeof(double));
            assert_true((hard.state.tangent == NULL) == (plain.state.tangent == NULL));
            if (plain.state.tangent != NULL)
                assert_memory_equal(hard.state.tangent, plain.state.tangent, n * sizeof(double));
            assert_true(hard.state.stiffness == plain.state.stiffness);
            assert_true(hard.state.unload_stiffness == plain.state.stiffness);
            assert_true(isnan(plain.state.unload_stiffness) && plain.state.depth == NULL);
            assert_true(hard.state.mean_gap == plain.state.mean_gap);
            assert_true(hard.state.approach == plain.state.approach);
            assert_true(hard.state.yielded == 0 && hard.state.plastic_volume == 0);
        }
        scene_close(&plain);
        scene_close(&hard);
    }
}

/* The softer the face, the more its heights alone decide: the highest nodes bear the hardness, and
 * one what is left. */
static void soft_faces(void **state) {
    (void)state;
    static const double PARTS[] = {0.003, 0.1, 0.25, 0.5, 0.9, 0.99};
    for (size_t b = 0; b < CASE_COUNT; b++) {
        const size_t a = CASES[b];
        struct scene scene;
        struct grid grid = GRIDS[a % 4];
        double hardness = hard_scene(&scene, grid, block_of(a / 4), 1e-7, a);
        for (size_t l = 0; l < sizeof PARTS / sizeof *PARTS; l++) {
            scene_press(&scene, PARTS[l] * hardness);
            double expected = PARTS[l] * (double)grid_points(&grid);
            assert_true(fabs((double)scene.state.nodes - expected) < 1);
            assert_true(scene.state.nodes - scene.state.yielded <= 1);
            check_hard_state(&scene, hardness, 1e-7);
        }
        scene_close(&scene);
    }
}

static void every_solution_meets_its_conditions(void **state) {
    (void)state;
    static const double HARDNESS[] = {0.01, 0.03, 0.1, 0.3, 1, 3, 10};
    static const double PARTS[] = {0.003, 0.03, 0.2, 0.5, 0.9};
    for (size_t b = 0; b < CASE_COUNT; b += case_step()) {
        const size_t a = CASES[b];
        struct scene scene;
        double slope = hard_scene(&scene, GRIDS[a % 4], block_of(a / 4), 1, a);
        for (size_t h = 0; h < sizeof HARDNESS / sizeof *HARDNESS; h++) {
            scene_harden(&scene, HARDNESS[h] * slope);
            for (size_t l = 0; l < sizeof PARTS / sizeof *PARTS; l++) {
                scene_press(&scene, PARTS[l] * HARDNESS[h] * slope);
                check_hard_contact(&scene, HARDNESS[h] * slope, true);
            }
        }
        scene_close(&scene);
    }
}

/* --- loads that fall and rise again --- */

static double *copy(size_t n, const double *x) {
    double *y = zeros(n);
    memcpy(y, x, n * sizeof *y);
    return y;
}

/* Unloading is elastic: pressures fall everywhere, the face keeps its depths, and the same loads
 * make the same states again, whatever was between. */
/* A crest between nodes and a face that was cut off, as an instrument at its limit leaves it, have
 * highest nodes that are equally high: none stands out of the others, from which a first guess of
 * pressures would follow. */
static void highest_nodes_are_equally_high(void **state) {
    (void)state;
    static const double CUT[] = {INFINITY, 0.01, 0.001};
    static const double LOADS[] = {1e-6, 1e-4, 1e-3, 5e-3};
    const struct grid grid = {32, 32, 1, 1};
    const double hardness = 0.01;
    for (size_t cut = 0; cut < sizeof CUT / sizeof *CUT; cut++) {
        struct scene scene;
        scene_open(&scene, grid, DEEP, 1e-9);
        for (size_t i = 0; i < grid_points(&grid); i++) {
            const size_t row = i / grid.nx, column = i % grid.nx;
            scene.z[i] = fmin(0.01 * (cos(2 * M_PI * ((double)column + 0.5) / (double)grid.nx) +
                                      cos(2 * M_PI * ((double)row + 0.5) / (double)grid.ny)),
                              CUT[cut]);
        }
        scene_harden(&scene, hardness);
        for (size_t l = 0; l < sizeof LOADS / sizeof *LOADS; l++) {
            scene_begin(&scene);
            scene_press(&scene, LOADS[l]);
            check_hard_contact(&scene, hardness, true);
        }
        scene_close(&scene);
    }
}

static void loads_fall_and_rise(void **state) {
    (void)state;
    static const double DOWN[] = {0.4, 0.1, 1e-3, 0.2, 0, 0.45};
    for (size_t b = 0; b < CASE_COUNT; b += case_step()) {
        const size_t a = CASES[b];
        struct scene scene, fresh;
        size_t n = grid_points(&GRIDS[a % 4]);
        double hardness = hard_scene(&scene, GRIDS[a % 4], block_of(a / 4), 0.3, a);
        hard_scene(&fresh, GRIDS[a % 4], block_of(a / 4), 0.3, a);
        scene_press(&scene, 0.2 * hardness);
        scene_press(&scene, 0.5 * hardness);
        const struct contact_state highest = scene.state;
        double *p = copy(n, highest.p), *depth = copy(n, highest.depth);
        assert_true(highest.yielded > 0 && highest.plastic_volume > 0);
        for (size_t l = 0; l < sizeof DOWN / sizeof *DOWN; l++) {
            scene_press(&scene, DOWN[l] * hardness);
            assert_memory_equal(scene.state.depth, depth, n * sizeof *depth);
            assert_true(scene.state.plastic_volume == highest.plastic_volume);
            assert_true(scene.state.yielded == 0 && scene.state.plastic_load == 0);
            assert_true(scene.state.approach < highest.approach);
            for (size_t i = 0; i < n; i++)
                assert_true(scene.state.p[i] <= p[i] * (1 + 1e-9) + 1e-9 * hardness);
            if (DOWN[l] > 0)
                check_hard_contact(&scene, hardness, false);
        }
        scene_press(&scene, 0.5 * hardness);
        assert_int_equal(scene.state.yielded, highest.yielded);
        check_relative(scene.state.approach, highest.approach, 1e-9);
        check_relative(scene.state.mean_gap, highest.mean_gap, 1e-8);
        for (size_t i = 0; i < n; i++)
            check_close(scene.state.p[i], p[i], 1e-7 * hardness);
        scene_press(&scene, 0.7 * hardness); /* as if it had never been unloaded */
        scene_press(&fresh, 0.7 * hardness);
        check_hard_contact(&scene, hardness, true);
        assert_int_equal(scene.state.yielded, fresh.state.yielded);
        check_relative(scene.state.plastic_volume, fresh.state.plastic_volume, 1e-8);
        scene_begin(&scene); /* forgets */
        scene_press(&scene, 0.7 * hardness);
        assert_memory_equal(scene.state.p, fresh.state.p, n * sizeof *p);
        assert_true(scene.state.stiffness == fresh.state.stiffness);
        assert_true(scene.state.unload_stiffness == fresh.state.unload_stiffness);
        free(p);
        free(depth);
        scene_close(&scene);
        scene_close(&fresh);
    }
}

/* Under a stiff coating the lowered face may bear more than the hardness as the load falls: that is
 * refused, and the solver goes on. Under a soft one it is elastic. */
static void stiff_coatings_may_yield_again(void **state) {
    (void)state;
    static const double MODULI[] = {2, 20};
    enum { LOADS = 8 };
    for (size_t m = 0; m < 2; m++) {
        struct block block = DEEP;
        struct scene scene;
        struct error err = {0};
        size_t refused = 0;
        block.coating = (struct coating){0.03, MODULI[m], 0.3};
        const double hardness = hard_scene(&scene, (struct grid){40, 40, 1, 1}, block, 0.3, 1);
        for (size_t l = 1; l <= LOADS; l++) {
            const double load = 0.1 * (double)l * hardness;
            scene_press(&scene, load);
            check_hard_contact(&scene, hardness, true);
            int status = contact_press(scene.contact, 0.95 * load, &scene.state, &err);
            if (status != 0) {
                refused++;
                assert_int_equal(status, ERROR_NUMERIC);
                assert_non_null(strstr(err.text, "times the hardness, "));
                assert_non_null(strstr(err.text, "under a coating of 20 times the modulus"));
            } else
                assert_true(largest(1600, scene.state.p) <= 1.001 * hardness);
        }
        printf("E1/E2 %g: %zu of %d falling loads refused\n", MODULI[m], refused, LOADS);
        assert_true(m == 0 ? refused == 0 : refused > 0);
        scene_close(&scene);
    }
}

/* The depth of a node never falls as the load rises, so that a face flattened by one load leads to
 * the same next one. */
static void depths_rise(void **state) {
    (void)state;
    for (size_t b = 0; b < CASE_COUNT; b += case_step()) {
        const size_t a = CASES[b];
        struct scene scene;
        size_t n = grid_points(&GRIDS[a % 4]);
        double hardness = hard_scene(&scene, GRIDS[a % 4], block_of(a / 4), 0.2, 7 * a), worst = 0;
        double *depth = zeros(n);
        for (double part = 0.05; part < 1; part += 0.05) {
            scene_press(&scene, part * hardness);
            double highest = largest(n, scene.state.depth);
            for (size_t i = 0; i < n; i++)
                worst = fmax(worst, (depth[i] - scene.state.depth[i]) / highest);
            memcpy(depth, scene.state.depth, n * sizeof *depth);
        }
        assert_true(worst <= 1e-9); /* the solution from the flattened face is the same */
        free(depth);
        scene_close(&scene);
    }
}

/* Both stiffnesses are differences of solutions, at loads so near that no node changes. */
static void stiffnesses_are_differences(void **state) {
    (void)state;
    for (size_t b = 0; b < CASE_COUNT; b += case_step()) {
        const size_t a = CASES[b];
        struct scene scene;
        size_t n = grid_points(&GRIDS[a % 4]);
        double hardness = hard_scene(&scene, GRIDS[a % 4], block_of(a / 4), 0.3, a);
        double load = 0.4 * hardness, change = 1e-5 * load;
        scene_press(&scene, load);
        const struct contact_state at = scene.state;
        double *p = copy(n, at.p), *tangent = copy(n, at.tangent);
        assert_true(at.unload_stiffness > at.stiffness);
        scene_press(&scene, load - change);
        check_relative(change / (at.approach - scene.state.approach), at.unload_stiffness, 1e-4);
        scene_press(&scene, load + change);
        check_relative(change / (scene.state.approach - at.approach), at.stiffness, 1e-4);
        for (size_t i = 0; i < n; i++)
            check_close((scene.state.p[i] - p[i]) / change, tangent[i], 1e-2);
        free(p);
        free(tangent);
        scene_close(&scene);
    }
}

/* --- areas --- */

/* Edges beside yielded nodes are those of node counting, half a step off at most: on a soft face
 * all are, on an elastic one those few that look like sides (F12.4). */
static void areas_beside_yielded_nodes(void **state) {
    (void)state;
    for (size_t a = 0; a < 4; a++) {
        struct scene soft, plain;
        double hardness = hard_scene(&soft, GRIDS[a], DEEP, 1e-7, a),
               n = (double)scene_points(&soft);
        hard_scene(&plain, GRIDS[a], DEEP, 1e9, a);
        scene_press(&soft, 0.3 * hardness);
        struct contact_area area = scene_area(&soft);
        assert_true(area.edges_unknown > 0);
        check_close(area.nodes, (double)soft.state.nodes / n, 1e-15);
        check_close(area.edges, area.nodes, 2 / n); /* but for the one elastic node */
        if (GRIDS[a].ny > 1)
            check_close(area.perimeter, area.nodes, 2 / n);
        assert_true(area.edges_unknown <= 0.5 * (area.upper - area.lower) + 2 / n);
        check_relative(area.mean_gap, soft.state.mean_gap, 1e-14);
        scene_press(&plain, 0.3 * contact_full_pressure(plain.contact));
        area = scene_area(&plain);
        assert_true(area.edges_unknown <= 0.01 * (area.upper - area.lower));
        scene_close(&soft);
        scene_close(&plain);
    }
}

/* Areas by pressure have no law of edges there, until the load falls. */
static void areas_by_pressure_are_refused(void **state) {
    (void)state;
    struct scene scene;
    struct pressures *pressures = NULL;
    struct bins bins = {.low = 0, .high = 1, .count = 4};
    struct error err = {0};
    double shares[6], hardness = hard_scene(&scene, GRIDS[0], DEEP, 0.3, 1);
    assert_int_equal(pressures_create(&pressures, scene.areas, &err), 0);
    scene_press(&scene, 0.3 * hardness);
    assert_int_equal(pressures_share(pressures, &scene.state, 0.4, &bins, 1, shares, &err),
                     ERROR_INPUT);
    assert_non_null(strstr(err.text, "nodes have yielded; allowed: none"));
    scene_press(&scene, 0.1 * hardness);
    double area = scene_area(&scene).edges;
    assert_int_equal(pressures_share(pressures, &scene.state, area, &bins, 1, shares, &err), 0);
    pressures_destroy(&pressures);
    scene_close(&scene);
}

/* Faces of nearly white noise, in which a first guess has yielded nodes, opens others, and makes
 * none yield anew. An elastic step then left 1 of 300 loads with pressures at open gaps, these
 * among them. */
static void guesses_that_yield(void **state) {
    (void)state;
    static const struct grid NOISE = {12, 12, 1, 1};
    static const size_t FACES[] = {77, 107, 328, 447, 492, 610, 617, 781, 921, 964};
    for (size_t face = 0; face < sizeof FACES / sizeof *FACES; face++) {
        struct scene scene;
        size_t seed = 40 * FACES[face];
        scene_open(&scene, NOISE, DEEP, 1e-8);
        double slope = fill_waves(&NOISE, 0.5, 30, next_uniform, &seed, scene.z);
        double hardness = slope * pow(10, 1.5 * next_uniform(&seed) - 1), load = 0;
        scene_harden(&scene, hardness);
        for (size_t l = 0; l < 4; l++) {
            load += (hardness - load) * next_uniform(&seed) * (l == 0 ? next_uniform(&seed) : 0.5);
            scene_press(&scene, load);
            check_hard_contact(&scene, hardness, true);
        }
        scene_close(&scene);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_is_refused),
        cmocka_unit_test(no_node_yields),
        cmocka_unit_test(soft_faces),
        cmocka_unit_test(every_solution_meets_its_conditions),
        cmocka_unit_test(guesses_that_yield),
        cmocka_unit_test(highest_nodes_are_equally_high),
        cmocka_unit_test(loads_fall_and_rise),
        cmocka_unit_test(stiff_coatings_may_yield_again),
        cmocka_unit_test(depths_rise),
        cmocka_unit_test(stiffnesses_are_differences),
        cmocka_unit_test(areas_beside_yielded_nodes),
        cmocka_unit_test(areas_by_pressure_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
