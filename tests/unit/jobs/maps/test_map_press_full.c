/* Protects: measured maps under finite elements at finite strain: the loads that studies find on
 * the same heights, bit for bit; a mirrored map is the doubled map; the laws of strain and the
 * mesh that are asked for; loads without a solution leave those before; the flat slides, with
 * errors; what it takes is estimated, and the largest map that fits does. */
#include "core/full/full.h"
#include "jobs/contact/case/contact_case_read.h"
#include "jobs/contact/contact_steps.h"
#include "jobs/maps/press/map_press_cost.h"
#include "jobs/maps/press/map_press_curves.h"
#include "jobs/maps/press/map_press_error.h"
#include "jobs/surface/realisation_map.h"
#include "tests/support/check.h"
#include <stdlib.h>
#include <string.h>

static const struct contact_model *full_model(void) {
    const struct choice *choice = choice_find(CONTACT_MODEL_CHOICES, "full");
    assert_non_null(choice);
    return CONTACT_MODELS[choice->value];
}

/* A profile of two waves, steep enough that strains matter. */
static struct height_map waves(size_t n, size_t copies) {
    struct height_map map = {.grid = {n * copies, 1, 8 * (double)copies, 1}};
    map.z = array_create(n * copies, sizeof *map.z);
    assert_non_null(map.z);
    for (size_t i = 0; i < n * copies; i++) {
        size_t at = i < n ? i : 2 * n - 1 - i; /* a second copy is the mirror image */
        double x = 2 * M_PI * ((double)at + 0.5) / (double)n;
        map.z[i] = 0.3 * cos(x) + 0.1 * cos(3 * x + 1);
    }
    return map;
}

static void press_waves(struct map_press *press, struct height_map *map,
                        enum press_boundary boundary, size_t loads, const double *pressures,
                        struct press_series *series) {
    struct error err = {0};
    if (map_press_begin(press, map, boundary, &err) != 0 ||
        map_press_loads(press, map->z, loads, pressures, series, &err) != 0)
        fail_msg("%s", err.text);
}

/* --- studies --- */

#define STUDY                                                                                      \
    "{\"surface\": {\"dimension\": 1, \"hurst\": 0.8, \"wavelength_ratio\": 4, "                   \
    "\"length_ratio\": 2, \"rms_slope\": 0.2}, \"contact\": {\"model\": \"full\", "                \
    "\"kinematics\": \"%s\", \"gap_weighting\": \"%s\", \"transition_depth\": 4, \"levels\": "     \
    "[8], \"tolerance\": 1e-9, \"pressures\": {\"values\": [0.1, 0.4]}}}"

struct found {
    double *p, *gap; /* owned, of both loads */
    size_t count;
};

static int keep(void *context, const struct nodal_step *step, size_t number, size_t count,
                struct error *err) {
    struct found *found = context;
    size_t points = grid_points(&step->grid);
    (void)count, (void)err;
    memcpy(found->p + number * points, step->p, points * sizeof *step->p);
    memcpy(found->gap + number * points, step->gap, points * sizeof *step->gap);
    found->count++;
    return 0;
}

/* The loads of a map are over the slope that it has, those of the study over the prescribed one:
 * they are the same number, here made the same bits. */
static void compare_with_study(const char *kinematics, const char *weighting,
                               const struct press_block *block) {
    struct contact_case one_case = {.load_count = 0};
    struct surface_report report;
    struct error err = {0};
    const struct random_key key = {1, 0, 0};
    double *z = NULL;
    char text[500];
    snprintf(text, sizeof text, STUDY, kinematics, weighting);
    cJSON *parameters = cJSON_Parse(text);
    if (contact_case_read(&one_case, parameters, 0, NULL, &err) != 0 ||
        realisation_surface(&one_case.surface, key, &z, &report, &err) != 0)
        fail_msg("%s", err.text);
    cJSON_Delete(parameters);
    const struct grid grid = contact_case_finest(&one_case)->grid;
    const size_t points = grid_points(&grid);
    struct found found = {array_create(2 * points, sizeof(double)),
                          array_create(2 * points, sizeof(double)), 0};
    assert_true(found.p != NULL && found.gap != NULL);
    const struct steps_order order = {.z = z};
    const struct steps_sink sink = {keep, &found};
    if (contact_press_steps(&one_case, &order, &sink, &err) != 0)
        fail_msg("%s", err.text);
    assert_int_equal(found.count, 2);

    struct map_press press = {.copies = 0};
    struct contact_step step = {.values = NULL};
    struct height_map map = {.grid = grid, .z = z};
    double height, slope;
    assert_int_equal(contact_case_scale(&one_case, &height, &slope, &err), 0);
    if (map_press_begin(&press, &map, PRESS_PERIODIC, &err) != 0 ||
        map_press_lift(&press, z, block, &err) != 0)
        fail_msg("%s", err.text);
    check_relative(press.slope, slope, 1e-12);
    press.slope = slope;
    for (size_t l = 0; l < 2; l++) {
        struct press_row row;
        if (map_press_load(&press, one_case.loads[l] * slope, &row, &err) != 0 ||
            map_press_step(&press, z, one_case.loads[l], 0, "m", &step, &err) != 0)
            fail_msg("%s", err.text);
        const size_t bytes = points * sizeof(double);
        assert_non_null(step.values);
        assert_non_null(strstr(step.title, "lengths in m; "));
        assert_memory_equal(step.step.p, found.p + l * points, bytes);
        assert_memory_equal(step.step.gap, found.gap + l * points, bytes);
        assert_true(row.value[MEASURE_NODES] > 0 && row.value[MEASURE_NODES] < 1);
    }
    contact_step_clear(&step);
    map_press_clear(&press);
    contact_case_clear(&one_case);
    free(found.p);
    free(found.gap);
    free(z);
}

static void maps_are_pressed_as_studies_do(void **state) {
    (void)state;
    compare_with_study("hencky", "standard",
                       &(struct press_block){.model = full_model(),
                                             .poisson = 0.3,
                                             .lengths = 1.5,
                                             .tolerance = 1e-9,
                                             .transition = 4});
    compare_with_study("st_venant_kirchhoff", "dual",
                       &(struct press_block){.model = full_model(),
                                             .poisson = 0.3,
                                             .lengths = 1.5,
                                             .tolerance = 1e-9,
                                             .kinematics = KINEMATICS_ST_VENANT,
                                             .weighting = GAP_DUAL,
                                             .transition = 4});
    compare_with_study("neo_hooke", "dual",
                       &(struct press_block){.model = full_model(),
                                             .poisson = 0.3,
                                             .lengths = 1.5,
                                             .tolerance = 1e-9,
                                             .kinematics = KINEMATICS_NEO_HOOKE,
                                             .weighting = GAP_DUAL,
                                             .transition = 4});
}

/* --- boundaries --- */

/* Heights and slopes are those of the measured part, by which loads and lengths are reported. The
 * map touches at both ends, and the doubled one there too, where each patch has its image. */
static void a_mirrored_map_is_the_doubled_map(void **state) {
    (void)state;
    const double pressures[] = {0.01, 0.05};
    struct press_row rows[2][2] = {0};
    double height[2];
    for (size_t doubled = 0; doubled < 2; doubled++) {
        struct height_map map = waves(32, 1 + doubled);
        struct map_press press = {.copies = 0};
        struct press_series series = {.block = {.model = full_model(), .poisson = 0.3},
                                      .rows = rows[doubled]};
        press_waves(&press, &map, doubled ? PRESS_PERIODIC : PRESS_MIRRORED, 2, pressures, &series);
        height[doubled] = press.height;
        assert_true(series.mesh.layers > 0 && series.mesh.slope > 0);
        map_press_clear(&press);
        height_map_clear(&map);
    }
    for (size_t l = 0; l < 2; l++) {
        const double *mirrored = rows[0][l].value, *doubled = rows[1][l].value;
        assert_true(mirrored[MEASURE_EDGES] == doubled[MEASURE_EDGES]);
        assert_true(mirrored[MEASURE_NODES] == doubled[MEASURE_NODES]);
        assert_true(mirrored[MEASURE_PATCHES] == doubled[MEASURE_PATCHES]);
        check_relative(mirrored[MEASURE_GAP] * height[0], doubled[MEASURE_GAP] * height[1], 1e-12);
    }
}

/* --- loads without values --- */

/* A load that no block bears has a message, and the load before stays. */
static void loads_before_a_failure_stay(void **state) {
    (void)state;
    const double pressures[] = {0.05, 1e6, 2e6};
    struct press_row rows[3];
    struct height_map map = waves(32, 1);
    struct map_press press = {.copies = 0};
    struct error err = {0};
    struct press_series series = {.block = {.model = full_model(), .poisson = 0.3}, .rows = rows};
    assert_int_equal(map_press_begin(&press, &map, PRESS_PERIODIC, &err), 0);
    assert_int_equal(map_press_loads(&press, map.z, 3, pressures, &series, &err), ERROR_NUMERIC);
    assert_non_null(strstr(err.text, "was reached up to"));
    assert_true(rows[0].value[MEASURE_NODES] > 0);
    for (size_t l = 1; l < 3; l++) {
        assert_true(isnan(rows[l].value[MEASURE_NODES]));
        check_relative(rows[l].value[PRESS_LOAD], pressures[l] / press.slope, 1e-15);
    }
    map_press_clear(&press);
    height_map_clear(&map);
}

static void a_limit_of_time_ends_loads(void **state) {
    (void)state;
    const double pressure = 0.05;
    struct press_row row;
    struct height_map map = waves(32, 1);
    struct map_press press = {.seconds_most = 1e-9};
    struct error err = {0};
    struct press_series series = {.block = {.model = full_model(), .poisson = 0.3}, .rows = &row};
    assert_int_equal(map_press_begin(&press, &map, PRESS_PERIODIC, &err), 0);
    assert_int_equal(map_press_loads(&press, map.z, 1, &pressure, &series, &err), ERROR_STOPPED);
    assert_string_equal(err.text, "it took more than 1e-09 s of CPU time");
    assert_true(isnan(row.value[MEASURE_NODES]));
    map_press_clear(&press);
    height_map_clear(&map);
}

/* --- friction --- */

/* The curves are those of sliding: none of it sticks in the end, and force over load is the
 * friction. Points of the path have errors by the points and the solver, loads have none of
 * sliding. The path of every second point is as long. */
static void the_flat_slides(void **state) {
    (void)state;
    enum { POINTS = 5 };
    const double mu = 0.3, pressures[] = {0.03, 0.06};
    double path[POINTS] = {0, 0.2, 0.4, 0.6, 0.8};
    struct press_row rows[2], slides[POINTS];
    struct height_map map = waves(64, 1);
    struct map_press press = {.copies = 0};
    struct error err = {0};
    struct case_result result = {0};
    struct press_series series = {.block = {.model = full_model(),
                                            .poisson = 0.3,
                                            .friction = mu,
                                            .slide = path,
                                            .slide_count = POINTS,
                                            .slide_steps = POINTS - 1},
                                  .rows = rows,
                                  .slides = slides};
    press_waves(&press, &map, PRESS_PERIODIC, 2, pressures, &series);
    map_press_release(&press);
    assert_int_equal(map_press_error(&press, &map, 1, &series, 2, pressures, &err), 0);
    assert_true(slides[0].value[SLIDING_FORCE] == 0);
    check_close(slides[POINTS - 1].value[SLIDING_FORCE], mu, 1e-6);
    assert_true(slides[0].value[SLIDING_STICK_AREA] == 1);
    assert_true(slides[POINTS - 1].value[SLIDING_STICK_AREA] == 0);
    for (size_t i = 1; i < POINTS; i++) {
        const struct press_error *points = slides[i].error[ERROR_DISCRETISATION];
        assert_true(slides[i].value[SLIDING_DISSIPATION] >
                    slides[i - 1].value[SLIDING_DISSIPATION]);
        assert_true(points[SLIDING_FORCE].bound < 0.05 * mu);
        assert_true(slides[i].error[ERROR_SOLVER][SLIDING_GAP].bound > 0);
    }
    assert_true(isnan(rows[1].value[SLIDING_FORCE]));
    snprintf(series.note, sizeof series.note, "the path ends");
    assert_int_equal(map_press_result(&result, &press, 1, &series, 2, &err), 0);
    assert_int_equal(result.note_count, 1);
    assert_string_equal(result.notes[0].text, "model full: the path ends");
    const struct curve *force = result_curve(&result, "sliding_force");
    assert_non_null(force);
    assert_int_equal(force->n, POINTS);
    assert_true(force->x[POINTS - 1] == 0.8 && force->y[1] == slides[1].value[SLIDING_FORCE]);
    check_relative(force->pressure, pressures[1] / press.slope, 1e-15);
    assert_string_equal(force->x_label, "sliding/sqrt(m0)");
    assert_null(result_curve(&result, "stick_area")); /* that of lighter loads */
    result_clear(&result);
    map_press_clear(&press);
    height_map_clear(&map);
}

/* --- cost --- */

static void costs_are_estimated(void **state) {
    (void)state;
    const double pressure = 0.02;
    struct press_row row;
    struct map_press press = {.copies = 0};
    struct height_map map = waves(64, 1);
    struct press_series series = {.block = {.model = full_model(), .poisson = 0.3}, .rows = &row};
    press_waves(&press, &map, PRESS_MIRRORED, 1, &pressure, &series);
    double load = pressure / press.slope;
    const struct press_goals goals = {1, &load};
    const struct press_cost cost = press_cost_of(&press, &series.block, &goals, 64, 1);
    assert_int_equal((long)cost.nodes, (long)series.mesh.nodes); /* of the mesh itself */
    assert_int_equal(cost.pressed.nx, 128);
    assert_true(cost.seconds > cost.error_seconds && cost.error_seconds > 0);
    double path[] = {0, 0.5, 1};
    struct press_block dragged = series.block;
    dragged.friction = 0.3;
    dragged.slide = path;
    dragged.slide_count = 3;
    dragged.slide_steps = 2;
    const struct press_cost drag = press_cost_of(&press, &dragged, &goals, 64, 1);
    assert_true(drag.seconds > 2 * cost.seconds && drag.seconds < 1000 * cost.seconds);
    size_t nx = 0, ny = 0;
    struct press_room room = {.bytes = cost.bytes, .seconds = cost.seconds};
    assert_true(press_cost_fits(&cost, &room));
    room.with_errors = true;
    assert_false(press_cost_fits(&cost, &room));
    room.seconds = cost.seconds / 2;
    assert_true(press_cost_largest(&press, &series.block, &goals, &room, &nx, &ny));
    const struct press_cost largest = press_cost_of(&press, &series.block, &goals, nx, ny);
    const struct press_cost beyond = press_cost_of(&press, &series.block, &goals, nx + 2, ny);
    assert_true(nx % 2 == 0 && nx < 64 && ny == 1);
    assert_true(press_cost_fits(&largest, &room) && !press_cost_fits(&beyond, &room));
    room.bytes = 1;
    assert_false(press_cost_largest(&press, &series.block, &goals, &room, &nx, &ny));
    map_press_clear(&press);
    height_map_clear(&map);
}

/* Faces that cannot be meshed are refused with what makes them fit. */
static void steep_and_high_faces_are_refused(void **state) {
    (void)state;
    static const struct {
        double length, lengths;
        const char *reason;
    } WRONG[] = {{0.5, 0, "can mesh surfaces up to about 2"},
                 {8, 0.05, "RMS heights high: the model full needs 4"}};
    for (size_t n = 0; n < sizeof WRONG / sizeof *WRONG; n++) {
        struct error err = {0};
        struct map_press press = {.copies = 0};
        struct height_map map = waves(32, 1);
        const struct press_block block = {
            .model = full_model(), .poisson = 0.3, .lengths = WRONG[n].lengths};
        map.grid.lx = WRONG[n].length;
        assert_int_equal(map_press_begin(&press, &map, PRESS_PERIODIC, &err), 0);
        assert_int_equal(map_press_lift(&press, map.z, &block, &err), ERROR_INPUT);
        if (strstr(err.text, WRONG[n].reason) == NULL)
            fail_msg("\"%s\" does not contain \"%s\"", err.text, WRONG[n].reason);
        map_press_clear(&press);
        height_map_clear(&map);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(maps_are_pressed_as_studies_do),
        cmocka_unit_test(a_mirrored_map_is_the_doubled_map),
        cmocka_unit_test(loads_before_a_failure_stay),
        cmocka_unit_test(a_limit_of_time_ends_loads),
        cmocka_unit_test(the_flat_slides),
        cmocka_unit_test(costs_are_estimated),
        cmocka_unit_test(steep_and_high_faces_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
