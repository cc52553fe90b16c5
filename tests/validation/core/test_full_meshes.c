/* Protects the graded mesh of the model full: layers that grow with depth must give the curve of
 * layers that are all as fine as the face, and columns that widen that of equal ones. A surface
 * must give the same curve in three dimensions as its profile in two. */
#include "tests/support/check.h"

#include "core/contact/area.h"
#include "core/full/full.h"
#include "core/surface/surface.h"

enum { POINTS = 128, FINER = 256, LOADS = 3, THICK = 16 };
static const double PRESSURES[LOADS] = {0.005, 0.015, 0.03}; /* of a slope of 0.1: to 0.3 of it */

struct mesh_curve {
    double area[LOADS], gap[LOADS];
};

static void fill(double *z, size_t points, size_t rows) {
    struct grid grid = {.nx = points, .ny = 1, .lx = 1, .ly = 1};
    struct spectrum spectrum = {.type = SPECTRUM_SELF_AFFINE,
                                .hurst = 0.8,
                                .wavelength_long = 0.5,
                                .wavelength_rolloff = 0.5,
                                .wavelength_short = 1.0 / 16,
                                .scale = SCALE_RMS_SLOPE,
                                .scale_value = 0.1};
    struct generator *generator = NULL;
    struct error err = {0};
    if (generator_create(&generator, &spectrum, &grid, &SURFACE_DEFAULTS, &err) != 0 ||
        generator_run(generator, (struct random_key){.seed = 7}, z, NULL, &err) != 0)
        fail_msg("%s", err.text);
    generator_destroy(&generator);
    for (size_t i = points; i < rows * points; i++)
        z[i] = z[i % points];
}

/* A profile, or its extrusion over THICK rows. */
static struct mesh_curve press(double growth, double transition, size_t points, size_t rows) {
    double z[THICK * POINTS > FINER ? THICK * POINTS : FINER] = {0};
    struct mesh_curve curve = {{0}, {0}};
    struct grid grid = {.nx = points, .ny = rows, .lx = 1, .ly = (double)rows / (double)points};
    struct block block = {.model = MODEL_LAYERED,
                          .poisson = 0.3,
                          .height = 0.3,
                          .layer_growth = growth,
                          .weighting = GAP_DUAL};
    struct compliance *compliance = NULL;
    struct area_workspace *areas = NULL;
    struct full *full = NULL;
    struct full_options options = FULL_DEFAULTS;
    struct error err = {0};
    options.transition = transition;
    fill(z, points, rows);
    int status = compliance_create(&compliance, &grid, &block, &err);
    if (status == 0)
        status = area_workspace_create(&areas, compliance, &err);
    if (status == 0)
        status = full_create(&full, &grid, &block, &options, &err);
    if (status == 0)
        status = full_begin(full, z, &err);
    for (size_t k = 0; status == 0 && k < LOADS; k++) {
        struct contact_state state;
        struct contact_area area;
        status = full_press(full, PRESSURES[k], &state, NULL, &err);
        if (status != 0)
            break;
        contact_area(areas, &state, &area);
        curve.area[k] = area.edges;
        curve.gap[k] = state.mean_gap;
    }
    full_destroy(&full);
    area_workspace_destroy(&areas);
    compliance_destroy(&compliance);
    if (status != 0)
        fail_msg("growth %g, %zu by %zu: %s", growth, points, rows, err.text);
    return curve;
}

static double largest_difference(const struct mesh_curve *a, const struct mesh_curve *b) {
    double most = 0;
    for (size_t k = 0; k < LOADS; k++)
        most = fmax(most, fmax(fabs(a->area[k] / b->area[k] - 1), fabs(a->gap[k] / b->gap[k] - 1)));
    return most;
}

/* At 8 points a shortest wave meshes err by 1 to 2 % of the area (test_contact.c), and differ by no
 * more; at 16 points both by a fourth of it, and what growth takes from the long waves, 0.1 %. */
static void graded_layers_give_the_curve_of_uniform_ones(void **state) {
    (void)state;
    struct mesh_curve uniform = press(1, INFINITY, POINTS, 1);
    struct mesh_curve graded = press(1.1, INFINITY, POINTS, 1);
    struct mesh_curve finer_uniform = press(1, INFINITY, FINER, 1);
    struct mesh_curve finer = press(1.1, INFINITY, FINER, 1);
    double coarse = largest_difference(&graded, &uniform);
    double fine = largest_difference(&finer, &finer_uniform);
    print_message("largest difference %.2g at 8 points, %.2g at 16\n", coarse, fine);
    assert_true(coarse < 0.015 && fine < 0.005);
}

/* Columns that begin to widen at a depth of so many of their widths see the waves that reach there
 * as stiffer than they are, by the square of width over wavelength; of shorter waves less reaches
 * there. The difference falls by 5 and more a doubling, most of it in the gap. */
static void wider_columns_give_the_curve_of_equal_ones(void **state) {
    (void)state;
    static const double DEPTH[] = {4, 8, 16}, BOUND[] = {0.015, 0.003, 0.0005};
    struct mesh_curve equal = press(1.1, INFINITY, FINER, 1);
    for (size_t c = 0; c < 3; c++) {
        struct mesh_curve wider = press(1.1, DEPTH[c], FINER, 1);
        double difference = largest_difference(&wider, &equal);
        print_message("widening from %g widths on: %.2g\n", DEPTH[c], difference);
        assert_true(difference > 0 && difference < BOUND[c]);
    }
}

/* Plane strain is what an extruded surface is in: the same elements, widening at the same depths,
 * to the solver's tolerance. */
static void extruded_profiles_are_profiles(void **state) {
    (void)state;
    struct mesh_curve profile = press(1.2, 6, POINTS, 1), surface = press(1.2, 6, POINTS, THICK);
    for (size_t k = 0; k < LOADS; k++) {
        check_relative(surface.gap[k], profile.gap[k], 1e-8);
        check_relative(surface.area[k], profile.area[k], 1e-8);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(graded_layers_give_the_curve_of_uniform_ones),
        cmocka_unit_test(wider_columns_give_the_curve_of_equal_ones),
        cmocka_unit_test(extruded_profiles_are_profiles),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
