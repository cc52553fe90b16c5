/* Protects: the contact of one map by the models of studies: against Hertz, mirrored and open; its
 * error by the points; what is refused; its curves; that what a model asks for is as in studies. */
#include "core/full/full.h"
#include "jobs/maps/map_press_error.h"
#include "tests/support/check.h"
#include <stdlib.h>
#include <string.h>

static const struct contact_model *model_named(const char *name) {
    const struct choice *choice = choice_find(CONTACT_MODEL_CHOICES, name);
    assert_non_null(choice);
    return CONTACT_MODELS[choice->value];
}

/* A paraboloid of radius 50 on 60 x 60 points, its summit between them. */
static struct height_map summit(double x0, double y0) {
    struct height_map map = {.grid = {60, 60, 6, 6}};
    map.z = array_create(3600, sizeof *map.z);
    assert_non_null(map.z);
    for (size_t j = 0; j < 60; j++)
        for (size_t i = 0; i < 60; i++)
            map.z[j * 60 + i] =
                -(pow((double)i / 10 - x0, 2) + pow((double)j / 10 - y0, 2)) / (2 * 50);
    return map;
}

static void press_summit(const struct press_block *block, double x0, double y0,
                         struct press_row *row, double *slope, double *height) {
    struct error err = {0};
    struct map_press press = {0};
    struct height_map map = summit(x0, y0);
    /* Hertz's radius is 2. */
    if (map_press_begin(&press, &map, block, &err) != 0 ||
        map_press_load(&press, 4.0 / 3 * 8 / 50 / 36, row, &err) != 0)
        fail_msg("%s", err.text);
    *slope = press.slope;
    *height = press.height;
    map_press_clear(&press);
    height_map_clear(&map);
}

static void open_map_is_pressed(void **state) {
    (void)state;
    const struct press_block open = {
        .model = model_named("halfspace"), .boundary = PRESS_OPEN, .poisson = 0.3};
    struct press_row row = {0};
    double slope = 0, height = 0;
    press_summit(&open, 3.02, 2.93, &row, &slope, &height);
    check_relative(row.value[PRESS_EDGES] * 36, 4 * M_PI, 0.005);
    check_relative(row.value[PRESS_PEAK] * slope, 2 * 2 / (M_PI * 50), 0.005);
    check_relative(row.value[PRESS_APPROACH] * height, 4.0 / 50, 0.005);
    check_relative(row.value[PRESS_STIFFNESS] * slope / height * 36, 2 * 2, 0.01);
    check_close(row.value[PRESS_PATCHES], 1, 0);
}

/* A quarter of a summit in a corner, mirrored, is a summit, whose neighbours are twelve units off:
 * Hertz's area, and a quarter of a patch to each map. */
static void mirrored_map_is_pressed(void **state) {
    (void)state;
    const struct press_block mirrored = {
        .model = model_named("halfspace"), .boundary = PRESS_MIRRORED, .poisson = 0.3};
    struct press_block layered = mirrored;
    struct press_row row = {0}, meshed = {0};
    double slope = 0, height = 0;
    press_summit(&mirrored, -0.05, -0.05, &row, &slope, &height);
    /* The force of the map is that of a quarter: the radius grows by the cube root of four. */
    check_relative(row.value[PRESS_EDGES] * 36, M_PI * pow(4, 2.0 / 3), 0.08);
    check_close(row.value[PRESS_PATCHES], 0.25, 0);
    check_relative(row.measured[MEASURE_PATCH_LARGEST], 4 * row.value[PRESS_NODES], 1e-12);
    layered.model = model_named("layered");
    press_summit(&layered, -0.05, -0.05, &meshed, &slope, &height);
    check_relative(meshed.value[PRESS_EDGES], row.value[PRESS_EDGES], 0.03);
}

/* The error of a sphere's contact lies within what every second point changes; maps that cannot be
 * thinned have none. */
static void points_make_an_error(void **state) {
    (void)state;
    struct press_block block = {
        .model = model_named("halfspace"), .boundary = PRESS_OPEN, .poisson = 0.3};
    for (size_t odd = 0; odd < 3; odd++) {
        struct error err = {0};
        struct map_press press = {0};
        struct height_map map = summit(3.02, 2.93);
        struct press_row row;
        double load = 4.0 / 3 * 8 / 50 / 36;
        map.grid.ny -= odd; /* the last row away */
        map.grid.ly -= 0.1 * (double)odd;
        block.boundary = odd == 2 ? PRESS_MIRRORED : PRESS_OPEN;
        load *= 6 / map.grid.ly;
        if (map_press_begin(&press, &map, &block, &err) != 0 ||
            map_press_load(&press, load, &row, &err) != 0)
            fail_msg("%s", err.text);
        map_press_release(&press);
        assert_int_equal(map_press_error(&press, &map, &block, 1, &load, &row, &err), 0);
        double area = row.value[PRESS_EDGES] * 6 * map.grid.ly;
        assert_true(row.error[PRESS_EDGES] > 0 && row.error[PRESS_EDGES] < 0.01);
        assert_true(row.error[PRESS_PEAK] < 0.01 * row.value[PRESS_PEAK]);
        assert_true(row.error[PRESS_MEAN_GAP] < 0.1 * row.value[PRESS_MEAN_GAP]);
        assert_true(isnan(row.error[PRESS_NODES]));
        if (odd < 2)
            assert_true(fabs(area / (4 * M_PI) - 1) <= 2 * row.error[PRESS_EDGES] * 36 / area);
        block.boundary = PRESS_PERIODIC;
        press.map.nx = 59;
        assert_int_equal(map_press_error(&press, &map, &block, 1, &load, &row, &err), 0);
        assert_true(isnan(row.error[PRESS_EDGES]));
        map_press_clear(&press);
        height_map_clear(&map);
    }
}

static void full_model_is_pressed(void **state) {
    (void)state;
    struct press_block block = {.boundary = PRESS_MIRRORED, .poisson = 0.3};
    struct map_press press = {0};
    struct error err = {0};
    struct press_row rows[2];
    for (size_t model = 0; model < 2; model++) {
        struct height_map map = {.grid = {40, 1, 10, 1}, .z = array_create(40, sizeof *map.z)};
        assert_non_null(map.z);
        for (size_t i = 0; i < 40; i++)
            map.z[i] = 0.05 * cos(2 * M_PI * ((double)i + 0.5) / 40);
        block.model = model_named(model == 0 ? "full" : "layered");
        if (map_press_begin(&press, &map, &block, &err) != 0 ||
            map_press_load(&press, 0.005, &rows[model], &err) != 0)
            fail_msg("%s", err.text);
        map_press_clear(&press);
        height_map_clear(&map);
    }
    check_relative(rows[0].value[PRESS_EDGES], rows[1].value[PRESS_EDGES], 0.05);
    assert_true(isnan(rows[0].value[PRESS_APPROACH]));
}

static void meshes_of_open_maps_are_refused(void **state) {
    (void)state;
    struct map_press press = {0};
    struct error err = {0};
    struct height_map map = summit(3, 3);
    const struct press_block block = {
        .model = model_named("full"), .boundary = PRESS_OPEN, .poisson = 0.3};
    assert_int_equal(map_press_begin(&press, &map, &block, &err), ERROR_INPUT);
    assert_non_null(strstr(err.text, "--model full needs a block that does: --boundary mirrored"));
    map_press_clear(&press);
    const struct press_block deep = {
        .model = model_named("halfspace"), .boundary = PRESS_OPEN, .lengths = 2};
    assert_int_equal(map_press_begin(&press, &map, &deep, &err), ERROR_INPUT);
    assert_non_null(strstr(err.text, "allowed: infinite"));
    map_press_clear(&press);
    memset(map.z, 0, 3600 * sizeof *map.z);
    assert_int_equal(map_press_begin(&press, &map, &block, &err), ERROR_INPUT);
    map_press_clear(&press);
    height_map_clear(&map);
}

/* The columns are the first curves, with their errors as bounds; other measures of studies follow,
 * and the curves of the model alone. */
static void loads_are_curves(void **state) {
    (void)state;
    const struct press_block block = {
        .model = model_named("full"), .boundary = PRESS_PERIODIC, .poisson = 0.3};
    struct map_press press = {0};
    struct error err = {0};
    struct press_row rows[2];
    struct case_result result = {0};
    struct height_map map = {.grid = {32, 1, 8, 1}, .z = array_create(32, sizeof *map.z)};
    const double loads[] = {0.005, 0.01};
    assert_non_null(map.z);
    for (size_t i = 0; i < 32; i++)
        map.z[i] = 0.05 * cos(2 * M_PI * (double)i / 32);
    if (map_press_begin(&press, &map, &block, &err) != 0 ||
        map_press_load(&press, loads[0], &rows[0], &err) != 0 ||
        map_press_load(&press, loads[1], &rows[1], &err) != 0)
        fail_msg("%s", err.text);
    map_press_release(&press);
    assert_int_equal(map_press_error(&press, &map, &block, 2, loads, rows, &err), 0);
    assert_int_equal(map_press_result(&result, &press, 2, rows, &err), 0);
    assert_true(result.curve_count > PRESS_VALUES + block.model->curve_count);
    for (size_t c = 0; c < PRESS_VALUES; c++) {
        const struct curve *curve = &result.curves[c];
        const struct curve_error *error = &curve->errors[ERROR_DISCRETISATION];
        assert_true(same_number(curve->y[1], rows[1].value[c]));
        assert_true(curve->x[1] == rows[1].value[PRESS_LOAD]);
        assert_string_equal(curve->model, "full");
        assert_true(error->applies == PRESS_COLUMNS[c].uncertain);
        if (error->applies)
            assert_true(same_number(error->bound[0], rows[0].error[c]));
    }
    assert_string_equal(result.curves[PRESS_EDGES].quantity, "contact_area");
    assert_string_equal(result.curves[PRESS_EDGES].series, "edges");
    assert_string_equal(result.curves[PRESS_PATCHES].y_label, "patches in the cell");
    assert_string_equal(result_curve(&result, "patch_mean_area")->y_label, "mean patch/cell");
    const struct curve *stretch = result_curve(&result, "stretch");
    const struct curve *largest = result_curve(&result, "patch_largest_area");
    assert_true(stretch != NULL && stretch->y[0] > 0.9);
    assert_true(largest != NULL && largest->y[0] == rows[0].value[PRESS_NODES]); /* of one wave */
    result_clear(&result);
    map_press_clear(&press);
    height_map_clear(&map);
}

/* Where no tolerance is prescribed, each model has that of its own solver. */
static void tolerances_are_those_of_the_solvers(void **state) {
    (void)state;
    assert_true(model_named("full")->tolerance == FULL_DEFAULTS.tolerance);
    assert_true(model_named("halfspace")->tolerance == 0);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(open_map_is_pressed),
        cmocka_unit_test(mirrored_map_is_pressed),
        cmocka_unit_test(points_make_an_error),
        cmocka_unit_test(full_model_is_pressed),
        cmocka_unit_test(meshes_of_open_maps_are_refused),
        cmocka_unit_test(loads_are_curves),
        cmocka_unit_test(tolerances_are_those_of_the_solvers),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
