/* Protects the compliance of a coated block: against the elasticity equations of both layers solved
 * directly, wave by wave; its limits; the mesh whose layers fit the interface; what is refused;
 * that thin stiff layers are pressed. */
#include "core/contact/coating.h"
#include "core/contact/compliance.h"
#include "core/contact/edge/edge.h"
#include "core/full/full.h"
#include "tests/support/check.h"
#include "tests/support/coated_elasticity.h"
#include "tests/support/contact_scene.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const struct block COATED = {.model = MODEL_HALFSPACE,
                                    .poisson = 0.3,
                                    .height = INFINITY,
                                    .layer_growth = 1,
                                    .coating = {.thickness = 0.1, .modulus = 4, .poisson = 0.2}};

static const double MODULI[] = {0.01, 0.2, 0.5, 1, 2, 10, 100};
enum { MODULI_COUNT = sizeof MODULI / sizeof *MODULI };

static struct block coated(double thickness, double modulus, double nu1, double nu2,
                           double height) {
    struct block block = COATED;
    block.poisson = nu2;
    block.height = height;
    block.coating = (struct coating){thickness, modulus, nu1};
    return block;
}

static void solves_the_equations_of_both_layers(void **state) {
    (void)state;
    static const double THICKNESS[] = {1e-3, 0.05, 0.5, 1, 3, 12},
                        BELOW[] = {0.01, 0.3, 2, 10, INFINITY}, POISSON[] = {0, 0.3, 0.49};
    double most = 0;
    for (size_t m = 0; m < MODULI_COUNT; m++)
        for (size_t t = 0; t < 6; t++)
            for (size_t b = 0; b < 5; b++)
                for (size_t p = 0; p < 9; p++) {
                    struct block block = coated(THICKNESS[t], MODULI[m], POISSON[p / 3],
                                                POISSON[p % 3], THICKNESS[t] + BELOW[b]);
                    double error = coating_compliance(1, &block) / coated_elasticity(&block) - 1;
                    most = fmax(most, fabs(error));
                    assert_true(fabs(error) <= 1e-11);
                    if (MODULI[m] <= 10 && block.height > 0.1)
                        assert_true(fabs(error) <= 1e-12);
                }
    printf("direct solution: %.1e at most\n", most);
}

/* The closed form of F22.1. */
static double closed(double k, const struct block *block) {
    double nu1 = block->coating.poisson, nu2 = block->poisson, x = k * block->coating.thickness;
    double g = block->coating.modulus * (1 + nu2) / (1 + nu1), q = exp(-2 * x);
    double m = (g - 1) / (g + 3 - 4 * nu1), n = 1 - 4 * (1 - nu1) / (1 + g * (3 - 4 * nu2));
    return 2 / (k * block_coating_stiffness(block)) * (1 + 4 * m * x * q - m * n * q * q) /
           (1 - (m + n + 4 * m * x * x) * q + m * n * q * q);
}

static void is_the_closed_form_on_a_half_space(void **state) {
    (void)state;
    for (size_t m = 0; m < MODULI_COUNT; m++)
        for (double k = 1e-3; k < 1e4; k *= 1.7) {
            struct block block = coated(0.1, MODULI[m], 0.2, 0.45, INFINITY);
            check_relative(coating_compliance(k, &block), closed(k, &block), 1e-11);
        }
}

static void has_its_limits(void **state) {
    (void)state;
    for (size_t m = 0; m < MODULI_COUNT; m++) {
        struct block block = coated(1, MODULI[m], 0.2, 0.4, INFINITY);
        double stiffness = block_coating_stiffness(&block);
        check_relative(stiffness, MODULI[m] * (1 - 0.16) / (1 - 0.04), 1e-14);
        check_relative(coating_compliance(20, &block), 2 / (20 * stiffness), 1e-12);
        double thin = 1e-4 * coating_compliance(1e-4, &block) / 2 - 1;
        double half = 0.5e-4 * coating_compliance(0.5e-4, &block) / 2 - 1;
        check_relative(thin / half, 2, 0.1); /* linear */
        check_relative(coating_excess(0, &block), coating_excess(1e-5, &block), 0.02);
        check_relative(coating_excess(0.3, &block), coating_compliance(0.3, &block) - 2 / 0.3,
                       1e-13);
    }
}

static void equal_constants_are_no_coating(void **state) {
    (void)state;
    static const double HEIGHTS[] = {0.02, 0.3, 5, INFINITY}, POISSON[] = {0, 0.3, 0.4999};
    for (size_t h = 0; h < 4; h++)
        for (size_t p = 0; p < 3; p++)
            for (double k = 1e-2; k < 1e4; k *= 3) {
                struct block block = coated(0.01, 1, POISSON[p], POISSON[p], HEIGHTS[h]);
                struct block bare = {.model = MODEL_HALFSPACE, .height = HEIGHTS[h]};
                check_relative(block_compliance_exact(k, &block), block_compliance_exact(k, &bare),
                               1e-12);
            }
}

/* A block that is thin to a wave: two formulas meet. */
static void thin_blocks_are_continuous(void **state) {
    (void)state;
    struct block block = coated(0.4, 3, 0.1, 0.45, 1);
    check_relative(coating_compliance(0.999e-5, &block), coating_compliance(1.001e-5, &block),
                   1e-9);
}

/* --- meshes --- */

static struct block meshed(double thickness, double modulus, double nu, double growth) {
    struct block block = coated(thickness, modulus, nu, 0.3, 1);
    block.model = MODEL_LAYERED;
    block.layer_growth = growth;
    return block;
}

static void layers_fit_the_interface(void **state) {
    (void)state;
    static const double THICKNESS[] = {0.01, 0.1, 0.3333, 0.999};
    double layers[LAYERS_MOST];
    const struct grid grid = {16, 16, 1, 1};
    for (size_t a = 0; a < 4; a++)
        for (double growth = 1; growth < 1.5; growth += 0.2) {
            struct block block = meshed(THICKNESS[a], 2, 0.3, growth);
            size_t count = block_layers(&grid, &block, layers);
            double depth = 0, nearest = 1;
            assert_true(count >= 2);
            for (size_t k = 0; k < count; k++) {
                depth += layers[k];
                nearest = fmin(nearest, fabs(depth - THICKNESS[a]));
                assert_true(layers[k] > 0);
            }
            check_close(nearest, 0, 1e-12);
            check_close(depth, 1, 1e-12);
        }
}

static double mesh_error_of(const struct block *block, size_t n, size_t wave) {
    struct compliance *compliance = NULL;
    struct error err = {0};
    if (compliance_create(&compliance, &(struct grid){n, 1, 1, 1}, block, &err) != 0)
        fail_msg("%s", err.text);
    double error =
        compliance->length[wave] / block_compliance_exact(2 * M_PI * (double)wave, block) - 1;
    compliance_destroy(&compliance);
    return error;
}

/* With layers that do not grow the mesh has the coated block's compliance in the limit, to second
 * order. */
static void meshes_converge(void **state) {
    (void)state;
    for (size_t m = 0; m < MODULI_COUNT; m++)
        for (size_t wave = 1; wave <= 3; wave++) {
            struct block block = meshed(0.125, MODULI[m], 0.45, 1);
            double coarse = mesh_error_of(&block, 64, wave),
                   fine = mesh_error_of(&block, 128, wave);
            printf("E1/E2 %g, wave %zu: %.2e %.2e\n", MODULI[m], wave, coarse, fine);
            assert_true(fabs(fine) < 4e-3 && fabs(fine) < 0.3 * fabs(coarse) + 2e-4);
        }
}

static void equal_meshes_are_no_coating(void **state) {
    (void)state;
    struct block block = meshed(0.25, 1, 0.3, 1), bare = block;
    struct compliance *one = NULL, *other = NULL;
    const struct grid grid = {8, 8, 1, 1};
    bare.coating.thickness = 0;
    assert_int_equal(compliance_create(&one, &grid, &block, NULL), 0);
    assert_int_equal(compliance_create(&other, &grid, &bare, NULL), 0);
    for (size_t k = 1; k < one->waves; k++)
        check_relative(one->length[k], other->length[k], 1e-12);
    compliance_destroy(&one);
    compliance_destroy(&other);
}

/* --- refusals --- */

static void check_refused(struct block block, const char *text) {
    struct error err = {0};
    assert_int_equal(block_check(&block, &err), ERROR_INPUT);
    if (strstr(err.text, text) == NULL)
        fail_msg("\"%s\" does not contain \"%s\"", err.text, text);
}

static void refuses_what_is_out_of_range(void **state) {
    (void)state;
    static const double BAD[] = {-1, NAN};
    for (size_t a = 0; a < 2; a++) {
        check_refused(coated(BAD[a], 2, 0.3, 0.3, 1), "coating thickness");
        check_refused(coated(0.1, BAD[a], 0.3, 0.3, 1), "modulus of the coating");
        check_refused(coated(0.1, 2, BAD[a], 0.3, 1), "Poisson's ratio of the coating");
    }
    check_refused(coated(1, 2, 0.3, 0.3, 1), "coating thickness = 1; allowed: below the block");
    check_refused(coated(0.1, 1001, 0.3, 0.3, 1), "= 1001; allowed: 0.001 to 1000");
    check_refused(coated(0.1, 2, 0.5, 0.3, 1), "ratio of the coating = 0.5");
    assert_int_equal(block_check(&(struct block){.height = 1, .coating = {0, NAN, NAN}}, NULL), 0);
}

static void full_has_no_coatings(void **state) {
    (void)state;
    struct full *full = NULL;
    struct error err = {0};
    struct block block = meshed(0.1, 2, 0.3, 1);
    assert_int_equal(full_create(&full, &(struct grid){16, 1, 1, 1}, &block, &FULL_DEFAULTS, &err),
                     ERROR_INPUT);
    assert_non_null(strstr(err.text, "the model full has no coatings"));
    assert_null(full);
}

/* --- areas by edges --- */

/* Near edges a layer that is thick to the spacing is a half-space, and one that is thin is none. */
static void edge_laws_have_their_limits(void **state) {
    (void)state;
    static const double MODULUS[] = {0.2, 5};
    for (size_t m = 0; m < 2; m++) {
        struct block thick = coated(1000, MODULUS[m], 0.1, 0.4, INFINITY);
        struct block thin = coated(1e-5, MODULUS[m], 0.1, 0.4, INFINITY);
        const struct grid grid = {32, 1, 32, 32};
        struct edge_law law;
        assert_int_equal(edge_law_make(&grid, &thick, &law, NULL), 0);
        check_relative(law.stiffness, block_coating_stiffness(&thick), 0.01);
        assert_int_equal(edge_law_make(&grid, &thin, &law, NULL), 0);
        check_relative(law.stiffness, 1, 0.01);
    }
}

enum { PLACES = 16 };

/* Mean over positions of the area of a wave of so many points, pressed to 0.3 of full contact. */
static double wave_area(const struct block *block, size_t points, size_t places) {
    struct scene scene;
    double sum = 0, full = 1 / block_compliance_exact(2 * M_PI, block);
    scene_open(&scene, (struct grid){points, 1, 1, 1}, *block, 1e-10);
    for (size_t place = 0; place < places; place++) {
        scene_begin_wave(&scene, (double)place / (double)places);
        scene_press(&scene, 0.3 * full);
        sum += scene_area(&scene).edges / (double)places;
    }
    scene_close(&scene);
    return sum;
}

/* Edges on 24 points a wave are those on 3072, whatever the thickness over the spacing. With
 * the law of uncoated edges they would be up to 9 % off. */
static void edges_know_the_coating(void **state) {
    (void)state;
    static const double SPACINGS[] = {0.1, 0.5, 1, 2, 6};
    for (size_t m = 1; m < MODULI_COUNT - 1; m++)
        for (size_t a = 0; a < 5; a++) {
            struct block block = coated(SPACINGS[a] / 24, MODULI[m], 0.3, 0.3, INFINITY);
            double fine = wave_area(&block, 3072, 1), coarse = wave_area(&block, 24, PLACES);
            printf("E1/E2 %g, t %g spacings: %.4f, %+.3f %%\n", MODULI[m], SPACINGS[a], fine,
                   100 * (coarse / fine - 1));
            check_relative(coarse, fine, 5e-3);
        }
}

/* --- thin layers that are hundreds of times as stiff bend as plates do --- */

/* Fills a profile of 16 wavelengths of 1 with 15 waves, whose RMS slope is about 1. */
static void begin_waves(struct scene *scene, int seed) {
    const double points = (double)scene->grid.nx;
    for (size_t i = 0; i < scene->grid.nx; i++) {
        scene->z[i] = 0;
        for (int wave = 2; wave <= 16; wave++) {
            double phase = 2 * M_PI * fmod(0.618034 * (double)(wave * wave * (seed + 1)), 1);
            scene->z[i] +=
                0.67 * pow(wave, -1.3) * cos(2 * M_PI * (double)wave * (double)i / points + phase);
        }
    }
    scene_begin(scene);
}

/* Sets of nodes that are solved roughly, and whole ones that leave and join at once, come back here
 * for ever; so did steps that cut pressures. */
static void stiff_layers_are_pressed(void **state) {
    (void)state;
    static const double MODULUS[] = {200, 500, 1000}, THICKNESS[] = {0.0625, 0.25};
    static const double LOADS[] = {0.1, 0.2, 0.5, 1, 2};
    for (size_t m = 0; m < 3; m++)
        for (size_t t = 0; t < 2; t++) {
            struct scene scene;
            struct block block = coated(THICKNESS[t], MODULUS[m], 0.3, 0.3, INFINITY);
            scene_open(&scene, (struct grid){256, 1, 16, 1}, block, 1e-5);
            for (int seed = 0; seed < 4; seed++) {
                begin_waves(&scene, seed);
                for (size_t a = 0; a < 5; a++) {
                    scene_press(&scene, LOADS[a]);
                    check_contact(&scene);
                }
            }
            scene_close(&scene);
        }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(solves_the_equations_of_both_layers),
        cmocka_unit_test(is_the_closed_form_on_a_half_space),
        cmocka_unit_test(has_its_limits),
        cmocka_unit_test(equal_constants_are_no_coating),
        cmocka_unit_test(thin_blocks_are_continuous),
        cmocka_unit_test(layers_fit_the_interface),
        cmocka_unit_test(meshes_converge),
        cmocka_unit_test(equal_meshes_are_no_coating),
        cmocka_unit_test(refuses_what_is_out_of_range),
        cmocka_unit_test(full_has_no_coatings),
        cmocka_unit_test(edge_laws_have_their_limits),
        cmocka_unit_test(edges_know_the_coating),
        cmocka_unit_test(stiff_layers_are_pressed),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
