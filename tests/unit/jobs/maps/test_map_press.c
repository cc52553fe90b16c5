/* Protects: the contact of one map by the models of studies: against Hertz, mirrored and open; its
 * error by the points; what is refused; its curves; that what a model asks for is as in studies. */
#include "core/full/full.h"
#include "core/rugo.h"
#include "jobs/contact/case/contact_loads.h"
#include "jobs/maps/press/map_press_curves.h"
#include "jobs/maps/press/map_press_error.h"
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

static void press_summit(const struct press_block *block, enum press_boundary boundary, double x0,
                         double y0, struct press_row *row, double *slope, double *height) {
    struct error err = {0};
    struct map_press press = {0};
    struct height_map map = summit(x0, y0);
    /* Hertz's radius is 2. */
    if (map_press_begin(&press, &map, boundary, &err) != 0 ||
        map_press_lift(&press, map.z, block, &err) != 0 ||
        map_press_load(&press, 4.0 / 3 * 8 / 50 / 36, row, &err) != 0)
        fail_msg("%s", err.text);
    *slope = press.slope;
    *height = press.height;
    map_press_clear(&press);
    height_map_clear(&map);
}

static void open_map_is_pressed(void **state) {
    (void)state;
    const struct press_block block = {.model = model_named("halfspace"), .poisson = 0.3};
    struct press_row row = {0};
    double slope = 0, height = 0;
    press_summit(&block, PRESS_OPEN, 3.02, 2.93, &row, &slope, &height);
    check_relative(row.value[MEASURE_EDGES] * 36, 4 * M_PI, 0.005);
    check_relative(row.value[PRESS_PEAK] * slope, 2 * 2 / (M_PI * 50), 0.005);
    check_relative(row.value[PRESS_APPROACH] * height, 4.0 / 50, 0.005);
    check_relative(row.value[MEASURE_STIFFNESS] * slope / height * 36, 2 * 2, 0.01);
    check_close(row.value[MEASURE_PATCHES], 1, 0);
    /* Johnson's strain of the face under its pressures, nothing around: FORMULAS.md, F14.5. */
    check_close(row.value[MEASURE_EDGES_STRETCHED],
                row.value[MEASURE_EDGES] - 0.4 / 0.7 * 4.0 / 3 * 8 / 50 / 36, 1e-15);
}

/* A sphere on a flat sticks within c/a = (1 - s)^(1/3), and its displacement and the work of a
 * cycle are Mindlin's (F26.4): mesh errors of 60 points, 18 across the contact at the lightest
 * load. */
static void a_sphere_slips(void **state) {
    (void)state;
    enum { LOADS = 13 };
    const double mu = 0.25, nu = 0.3, full = 4.0 / 3 * 8 / 50 / 36;
    struct press_series series = {
        .block = {.model = model_named("halfspace"), .poisson = nu, .friction = mu},
        .rows = array_create(LOADS, sizeof *series.rows)};
    struct error err = {0};
    struct map_press press = {0};
    struct height_map map = summit(3.02, 2.93);
    double pressures[LOADS + 1] = {full};
    size_t loads = 1;
    assert_non_null(series.rows);
    contact_loads_add(pressures, &loads, full);
    assert_int_equal(loads, LOADS);
    if (map_press_begin(&press, &map, PRESS_OPEN, &err) != 0 ||
        map_press_loads(&press, map.z, loads, pressures, &series, &err) != 0)
        fail_msg("%s", err.text);
    for (size_t l = 3; l + 1 < loads; l++) {
        const double *value = series.rows[l].value;
        double share = 1 - pressures[l] / full, apart = 1 - pow(1 - share, 2.0 / 3);
        double moved = mu * (1 - nu / 2) / (1 - nu) * 4.0 / 50 * apart;
        double under = share - 0.6 * (1 - pow(1 - share, 5.0 / 3));
        double work =
            mu * full * mu * (1 - nu / 2) / (1 - nu) * 4.0 / 50 * (4 * share * apart - 8 * under);
        check_close(value[SLIP_STICK_EDGES], pow(1 - share, 2.0 / 3), 0.005);
        check_relative(value[SLIP_DISPLACEMENT] * press.height, moved, 0.01);
        if (share > 0.4)
            check_relative(value[SLIP_WORK] * press.slope * press.height, work, 0.02);
    }
    free(series.rows);
    map_press_clear(&press);
    height_map_clear(&map);
}

/* After yielding the loads fall again, on every grid that is pressed: what slips is stiffer than an
 * elastic face, and the approach that is left is that of the highest load. */
static void a_face_slips_after_yielding(void **state) {
    (void)state;
    enum { LOADS = 3 };
    const double pressures[LOADS] = {0.002, 0.004, 0.006};
    struct press_row rows[2][LOADS] = {0};
    for (int hard = 0; hard < 2; hard++) {
        struct press_series series = {.block = {.model = model_named("halfspace"),
                                                .poisson = 0.3,
                                                .friction = 0.2,
                                                .hardness = hard ? 0.02 : 0},
                                      .rows = rows[hard]};
        struct error err = {0};
        struct map_press press = {0};
        struct height_map map = summit(3.02, 2.93);
        if (map_press_begin(&press, &map, PRESS_PERIODIC, &err) != 0 ||
            map_press_loads(&press, map.z, LOADS, pressures, &series, &err) != 0)
            fail_msg("%s", err.text);
        map_press_clear(&press);
        height_map_clear(&map);
    }
    for (size_t l = 0; l + 1 < LOADS; l++) {
        const double *soft = rows[1][l].value, *elastic = rows[0][l].value;
        assert_true(soft[SLIP_DISPLACEMENT] > 0 &&
                    soft[SLIP_DISPLACEMENT] < elastic[SLIP_DISPLACEMENT]);
        assert_true(soft[UNLOAD_AREA] > soft[MEASURE_NODES]);
        assert_true(soft[UNLOAD_APPROACH] < rows[1][l + 1].value[UNLOAD_APPROACH]);
        assert_true(isnan(elastic[UNLOAD_APPROACH]));
    }
}

/* A quarter of a summit in a corner, mirrored, is a summit, whose neighbours are twelve units off:
 * Hertz's area, and the map's one patch is what of it lies in the map. */
static void mirrored_map_is_pressed(void **state) {
    (void)state;
    const struct press_block block = {.model = model_named("halfspace"), .poisson = 0.3};
    struct press_block layered = block;
    struct press_row row = {0}, meshed = {0};
    double slope = 0, height = 0;
    press_summit(&block, PRESS_MIRRORED, -0.05, -0.05, &row, &slope, &height);
    /* The force of the map is that of a quarter: the radius grows by the cube root of four. */
    check_relative(row.value[MEASURE_EDGES] * 36, M_PI * pow(4, 2.0 / 3), 0.08);
    check_close(row.value[MEASURE_PATCHES], 1, 0);
    check_relative(row.value[MEASURE_PATCH_MEAN], row.value[MEASURE_NODES], 1e-12);
    check_relative(row.value[MEASURE_PATCH_LARGEST], row.value[MEASURE_NODES], 1e-12);
    layered.model = model_named("layered");
    press_summit(&layered, PRESS_MIRRORED, -0.05, -0.05, &meshed, &slope, &height);
    check_relative(meshed.value[MEASURE_EDGES], row.value[MEASURE_EDGES], 0.03);
}

/* Four hills: in a corner, at two sides, inside. */
static struct height_map hills(void) {
    static const double AT[4][3] = {{0, 0, 0.9}, {11, 30, 1}, {44, 39, 0.95}, {26, 14, 1}};
    struct height_map map = {.grid = {48, 40, 48, 40}, .z = array_create(1920, sizeof *map.z)};
    assert_non_null(map.z);
    for (size_t p = 0; p < 1920; p++)
        for (size_t h = 0; h < 4; h++) {
            const size_t i = p % 48, j = p / 48;
            double x = (double)i - AT[h][0], y = (double)j - AT[h][1];
            map.z[p] += AT[h][2] * exp(-(x * x + y * y) / 40);
        }
    return map;
}

/* Takes the nodes of a patch out of `touching`, which has one side of 48. Returns their number. */
static size_t flood(bool *touching, size_t i, size_t j) {
    if (i >= 48 || j >= 40 || !touching[j * 48 + i])
        return 0;
    touching[j * 48 + i] = false;
    return 1 + flood(touching, i + 1, j) + flood(touching, i - 1, j) + flood(touching, i, j + 1) +
           flood(touching, i, j - 1);
}

/* Patches of a mirrored map are those of the map, over its area, as are contact areas: what meets
 * its own image at a side has the area within the map. Here they are counted by flooding. */
static void patches_are_those_of_the_map(void **state) {
    (void)state;
    const struct press_block block = {.model = model_named("halfspace"), .poisson = 0.3};
    static const double PRESSURES[] = {0.002, 0.01, 1};
    for (size_t load = 0; load < 3; load++) {
        struct error err = {0};
        struct map_press press = {0};
        struct height_map map = hills();
        struct press_row row = {0};
        bool touching[1920];
        size_t count = 0, most = 0, nodes = 0;
        if (map_press_begin(&press, &map, PRESS_MIRRORED, &err) != 0 ||
            map_press_lift(&press, map.z, &block, &err) != 0 ||
            map_press_load(&press, PRESSURES[load], &row, &err) != 0)
            fail_msg("%s", err.text);
        for (size_t p = 0; p < 1920; p++)
            touching[p] = press.state.p[p / 48 * 96 + p % 48] > 0;
        for (size_t p = 0; p < 1920; p++) {
            size_t size = flood(touching, p % 48, p / 48);
            count += size > 0 ? 1 : 0;
            most = size > most ? size : most;
            nodes += size;
        }
        assert_int_equal(count, load == 2 ? 1 : 4); /* at last all is in contact */
        check_close(row.value[MEASURE_PATCHES], (double)count, 0);
        check_relative(row.value[MEASURE_PATCH_LARGEST], (double)most / 1920, 1e-12);
        check_relative(row.value[MEASURE_PATCH_MEAN] * (double)count, (double)nodes / 1920, 1e-12);
        check_relative(row.value[MEASURE_NODES], (double)nodes / 1920, 1e-12);
        map_press_clear(&press);
        height_map_clear(&map);
    }
}

/* The error of a sphere's contact lies within what every second point changes; maps that cannot be
 * thinned have none. */
static void points_make_an_error(void **state) {
    (void)state;
    for (size_t odd = 0; odd < 3; odd++) {
        struct error err = {0};
        struct map_press press = {0};
        struct height_map map = summit(3.02, 2.93);
        struct press_row row;
        struct press_series series = {.block = {.model = model_named("halfspace"), .poisson = 0.3},
                                      .rows = &row};
        double load = 4.0 / 3 * 8 / 50 / 36;
        map.grid.ny -= odd; /* the last row away */
        map.grid.ly -= 0.1 * (double)odd;
        load *= 6 / map.grid.ly;
        if (map_press_begin(&press, &map, odd == 2 ? PRESS_MIRRORED : PRESS_OPEN, &err) != 0 ||
            map_press_loads(&press, map.z, 1, &load, &series, &err) != 0)
            fail_msg("%s", err.text);
        map_press_release(&press);
        assert_int_equal(map_press_error(&press, &map, 1, &series, 1, &load, &err), 0);
        const struct press_error *points = row.error[ERROR_DISCRETISATION];
        double area = row.value[MEASURE_EDGES] * 6 * map.grid.ly;
        assert_true(points[MEASURE_EDGES].bound > 0 && points[MEASURE_EDGES].bound < 0.01);
        assert_true(points[PRESS_PEAK].bound < 0.01 * row.value[PRESS_PEAK]);
        assert_true(points[MEASURE_GAP].bound < 0.1 * row.value[MEASURE_GAP]);
        assert_true(isnan(points[MEASURE_ITERATIONS].bound));
        if (odd < 2)
            assert_true(fabs(area / (4 * M_PI) - 1) <= 2 * points[MEASURE_EDGES].bound * 36 / area);
        row.error[ERROR_DISCRETISATION][MEASURE_EDGES].bound = NAN;
        press.boundary = PRESS_PERIODIC;
        press.map.nx = 59;
        assert_int_equal(map_press_error(&press, &map, 1, &series, 1, &load, &err), 0);
        assert_true(isnan(points[MEASURE_EDGES].bound));
        map_press_clear(&press);
        height_map_clear(&map);
    }
}

static void full_model_is_pressed(void **state) {
    (void)state;
    struct press_block block = {.poisson = 0.3};
    struct map_press press = {0};
    struct error err = {0};
    struct press_row rows[2];
    for (size_t model = 0; model < 2; model++) {
        struct height_map map = {.grid = {40, 1, 10, 1}, .z = array_create(40, sizeof *map.z)};
        assert_non_null(map.z);
        for (size_t i = 0; i < 40; i++)
            map.z[i] = 0.05 * cos(2 * M_PI * ((double)i + 0.5) / 40);
        block.model = model_named(model == 0 ? "full" : "layered");
        if (map_press_begin(&press, &map, PRESS_MIRRORED, &err) != 0 ||
            map_press_lift(&press, map.z, &block, &err) != 0 ||
            map_press_load(&press, 0.005, &rows[model], &err) != 0)
            fail_msg("%s", err.text);
        map_press_clear(&press);
        height_map_clear(&map);
    }
    check_relative(rows[0].value[MEASURE_EDGES], rows[1].value[MEASURE_EDGES], 0.05);
    assert_true(isnan(rows[0].value[PRESS_APPROACH]));
}

/* The same block, and the same areas under load, which a ratio of Poisson of 0 stretches most. */
static void librugo_has_the_areas_of_press(void **state) {
    (void)state;
    static const double LOADS[] = {0.02, 0.2};
    const struct rugo_grid grid = {40, 1, 10, 1};
    const struct press_block model = {.model = model_named("full")};
    struct height_map map = {.grid = {40, 1, 10, 1}, .z = array_create(40, sizeof *map.z)};
    struct rugo_block block = rugo_block_defaults(RUGO_FULL, &grid);
    struct rugo_contact *contact = NULL;
    struct rugo_contact_state state_of;
    struct map_press press = {0};
    struct press_row row;
    struct error err = {0};
    assert_non_null(map.z);
    for (size_t i = 0; i < 40; i++)
        map.z[i] = 0.5 * cos(2 * M_PI * ((double)i + 0.5) / 40);
    block.poisson = 0;
    assert_int_equal(rugo_contact_create(&contact, &grid, &block, NULL), 0);
    assert_int_equal(rugo_contact_begin(contact, map.z, NULL), 0);
    if (map_press_begin(&press, &map, PRESS_PERIODIC, &err) != 0 ||
        map_press_lift(&press, map.z, &model, &err) != 0)
        fail_msg("%s", err.text);
    for (size_t l = 0; l < 2; l++) {
        if (map_press_load(&press, LOADS[l] * press.slope, &row, &err) != 0)
            fail_msg("%s", err.text);
        assert_int_equal(rugo_contact_press(contact, LOADS[l] * press.slope, &state_of, NULL), 0);
        check_relative(state_of.area, row.value[MEASURE_EDGES], 1e-5);
        check_relative(state_of.area_nodes, row.value[MEASURE_NODES], 1e-5);
        check_relative(state_of.area_lower, row.value[MEASURE_NODES_LOWER], 1e-5);
        check_relative(state_of.area_upper, row.value[MEASURE_NODES_UPPER], 1e-5);
        check_relative(state_of.mean_gap, row.value[MEASURE_GAP] * press.height, 1e-5);
    }
    rugo_contact_destroy(&contact);
    map_press_clear(&press);
    height_map_clear(&map);
}

/* The usual height of a block is that of studies, by the longer side, whichever that is. */
static void a_transposed_map_has_the_same_contact(void **state) {
    (void)state;
    enum { LONG = 32, SHORT = 8 };
    const struct press_block block = {.model = model_named("layered"), .poisson = 0.3};
    double gap[2];
    for (size_t turned = 0; turned < 2; turned++) {
        const struct grid lying = {LONG, SHORT, 4, 1}, standing = {SHORT, LONG, 1, 4};
        struct height_map map = {.grid = turned > 0 ? standing : lying,
                                 .z = array_create(LONG * SHORT, sizeof *map.z)};
        struct map_press press = {0};
        struct press_row row;
        struct error err = {0};
        assert_non_null(map.z);
        for (size_t n = 0; n < LONG * SHORT; n++) {
            size_t along = turned > 0 ? n / SHORT : n % LONG;
            size_t across = turned > 0 ? n % SHORT : n / LONG;
            map.z[n] = 0.1 * cos(2 * M_PI * (double)along / LONG) +
                       0.02 * cos(2 * M_PI * (double)across / SHORT);
        }
        if (map_press_begin(&press, &map, PRESS_PERIODIC, &err) != 0 ||
            map_press_lift(&press, map.z, &block, &err) != 0 ||
            map_press_load(&press, 0.1 * press.slope, &row, &err) != 0)
            fail_msg("%s", err.text);
        assert_true(press.one_case.blocks[0].height == 6);
        gap[turned] = row.value[MEASURE_GAP];
        map_press_clear(&press);
        height_map_clear(&map);
    }
    check_relative(gap[1], gap[0], 1e-6);
}

static void meshes_of_open_maps_are_refused(void **state) {
    (void)state;
    struct map_press press = {0};
    struct error err = {0};
    struct height_map map = summit(3, 3);
    const struct press_block block = {.model = model_named("full"), .poisson = 0.3};
    const struct press_block deep = {.model = model_named("halfspace"), .lengths = 2};
    assert_int_equal(map_press_begin(&press, &map, PRESS_OPEN, &err), 0);
    assert_int_equal(map_press_lift(&press, map.z, &block, &err), ERROR_INPUT);
    assert_non_null(strstr(err.text, "--model full needs a block that does: --boundary mirrored"));
    assert_int_equal(map_press_lift(&press, map.z, &deep, &err), ERROR_INPUT);
    assert_non_null(strstr(err.text, "allowed: infinite"));
    map_press_clear(&press);
    memset(map.z, 0, 3600 * sizeof *map.z);
    assert_int_equal(map_press_begin(&press, &map, PRESS_OPEN, &err), ERROR_INPUT);
    map_press_clear(&press);
    height_map_clear(&map);
}

/* The columns are the first curves, with their errors by source as in studies; other measures of
 * studies follow, and the curves of the model alone. */
static void loads_are_curves(void **state) {
    (void)state;
    struct press_row rows[2];
    struct press_series series = {.block = {.model = model_named("full"), .poisson = 0.3},
                                  .rows = rows};
    struct map_press press = {0};
    struct error err = {0};
    struct case_result result = {0};
    struct height_map map = {.grid = {32, 1, 8, 1}, .z = array_create(32, sizeof *map.z)};
    const double loads[] = {0.005, 0.01};
    assert_non_null(map.z);
    for (size_t i = 0; i < 32; i++)
        map.z[i] = 0.05 * cos(2 * M_PI * (double)i / 32);
    if (map_press_begin(&press, &map, PRESS_PERIODIC, &err) != 0 ||
        map_press_loads(&press, map.z, 2, loads, &series, &err) != 0)
        fail_msg("%s", err.text);
    map_press_release(&press);
    assert_int_equal(map_press_error(&press, &map, 1, &series, 2, loads, &err), 0);
    assert_int_equal(map_press_result(&result, &press, 1, &series, 2, &err), 0);
    for (size_t c = 0, shown = 0; c < PRESS_COLUMN_COUNT; c++) {
        const struct press_column *column = &PRESS_COLUMNS[c];
        const struct curve *curve = map_press_curve(&result, column, "full");
        bool unasked =
            column->value < MEASURE_COUNT && !measure_is_of(&press.one_case, column->value);
        assert_true((curve == NULL) == (column->value == MEASURE_EDGES_STRETCHED || unasked));
        if (curve == NULL)
            continue;
        const struct curve_error *error = &curve->errors[ERROR_DISCRETISATION];
        const struct press_error *points = rows[0].error[ERROR_DISCRETISATION];
        assert_ptr_equal(curve, &result.curves[shown++]);
        assert_true(same_number(curve->y[1], rows[1].value[column->value]));
        assert_true(curve->x[1] == rows[1].value[PRESS_LOAD]);
        assert_string_equal(curve->model, "full");
        assert_string_equal(curve->kinematics, "hencky");
        assert_true(error->applies || !column->uncertain);
        if (error->value != NULL)
            assert_true(same_number(error->bound[0], points[column->value].bound));
        assert_false(curve->errors[ERROR_MODEL].applies); /* it is the most complete */
        assert_false(curve->errors[ERROR_CELL].applies || curve->law_difference != NULL);
    }
    assert_string_equal(result.curves[1].quantity, "contact_area");
    assert_string_equal(result.curves[1].series, "edges");
    assert_string_equal(result_curve(&result, "patch_count")->y_label, "patches in the cell");
    assert_string_equal(result_curve(&result, "patch_mean_area")->y_label, "mean patch/cell");
    const struct curve *stretch = result_curve(&result, "stretch");
    const struct curve *largest = result_curve(&result, "patch_largest_area");
    assert_true(stretch != NULL && stretch->y[0] > 0.9);
    assert_true(largest != NULL && largest->y[0] == rows[0].value[MEASURE_NODES]); /* of one wave */
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
        cmocka_unit_test(a_sphere_slips),
        cmocka_unit_test(a_face_slips_after_yielding),
        cmocka_unit_test(mirrored_map_is_pressed),
        cmocka_unit_test(patches_are_those_of_the_map),
        cmocka_unit_test(points_make_an_error),
        cmocka_unit_test(full_model_is_pressed),
        cmocka_unit_test(librugo_has_the_areas_of_press),
        cmocka_unit_test(a_transposed_map_has_the_same_contact),
        cmocka_unit_test(meshes_of_open_maps_are_refused),
        cmocka_unit_test(loads_are_curves),
        cmocka_unit_test(tolerances_are_those_of_the_solvers),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
