/* Protects partial slip: stick areas of a cylinder and a sphere, uncoupled solutions on a rough
 * profile, values of another code where pressures and tractions are coupled, an independent solver
 * on small problems, and what it refuses. */
#include "tests/support/check.h"

#include "tests/support/contact_scene.h"
#include "tests/support/seed.h"
#include "tests/support/slip_scene.h"
#include <stdio.h>

static struct slip *made(const struct grid *grid, const struct slip_options *options) {
    struct error err = {0};
    struct slip *slip = NULL;
    if (slip_create(&slip, grid, options, &err) != 0)
        fail_msg("%s", err.text);
    return slip;
}

static struct slip_state press(struct slip *slip, const double *z, double pressure) {
    struct error err = {0};
    struct slip_state state;
    if (slip_press(slip, z, pressure, &state, &err) != 0)
        fail_msg("%s", err.text);
    return state;
}

static struct slip_state load(struct slip *slip, double traction) {
    struct error err = {0};
    struct slip_state state;
    if (slip_load(slip, traction, &state, &err) != 0)
        fail_msg("%s", err.text);
    return state;
}

/* Waves of random phases, of `least` to `most` a side of 1. */
static void roughen(const struct grid *grid, uint64_t seed, int least, int most, double *z) {
    for (int mx = 0; mx <= most; mx++)
        for (int my = grid_is_profile(grid) ? 0 : -most; my <= (grid_is_profile(grid) ? 0 : most);
             my++) {
            double m = hypot(mx, my), phase = (double)(next_word(&seed) >> 11) * 0x1p-53;
            for (size_t i = 0; m >= least && m <= most && i < grid_points(grid); i++) {
                size_t row = i / grid->nx;
                double turn = mx * (double)(i % grid->nx) / (double)grid->nx +
                              my * (double)row / (double)grid->ny;
                z[i] += pow(m, -1.5) * cos(2 * M_PI * (turn + phase));
            }
        }
}

/* --- a cylinder and a sphere --- */

/* Fills heights of a radius of 1 in a cell of side 1. */
static void round_off(const struct grid *grid, double *z) {
    for (size_t i = 0; i < grid_points(grid); i++) {
        size_t row = i / grid->nx;
        double x = (double)(i % grid->nx) / (double)grid->nx - 0.5;
        double y = grid_is_profile(grid) ? 0 : (double)row / (double)grid->ny - 0.5;
        z[i] = -(x * x + y * y) / 2;
    }
}

/* Returns the stick radius over that of the contact, at a share of the friction. */
static double stick_radius(size_t nx, size_t ny, struct slip_options options, double radius,
                           double share) {
    const struct grid grid = {.nx = nx, .ny = ny, .lx = 1, .ly = 1};
    const double pressure =
        ny == 1 ? M_PI / 4 * radius * radius : 4.0 / 3 * radius * radius * radius;
    struct slip *slip = made(&grid, &options);
    double *z = zeros(nx * ny);
    round_off(&grid, z);
    press(slip, z, pressure);
    struct slip_state state = load(slip, share * options.friction * pressure);
    double ratio = ny == 1 ? state.stick_area : sqrt(state.stick_area);
    slip_destroy(&slip);
    free(z);
    return ratio;
}

/* (1 - Q/(mu P))^(1/2) of a cylinder (Cattaneo 1938), exact at nu = 1/2 but for the cell, whose
 * images leave less than 0.1 % with a contact of an eighth of it. A half-width of 64 nodes, each of
 * which sticks or not, leaves 1 of 128 in both counts. Of a sphere it is the cube root, without the
 * tractions across the load that nu = 1/2 brings along: 1 % of the radius; 16 nodes of radius. */
static void cattaneo_s_stick_radius(void **state) {
    (void)state;
    static const double SHARES[] = {0.2, 0.45, 0.8};
    struct slip_options options = SLIP_DEFAULTS;
    options.poisson = 0.5;
    options.friction = 0.3;
    for (size_t a = 0; a < 3; a++) {
        double line = stick_radius(1024, 1, options, 1.0 / 16, SHARES[a]);
        double point = stick_radius(128, 128, options, 1.0 / 8, SHARES[a]);
        printf("[   INFO   ] Q = %.2f mu P: cylinder %.4f (%.4f), sphere %.4f (%.4f)\n", SHARES[a],
               line, sqrt(1 - SHARES[a]), point, cbrt(1 - SHARES[a]));
        check_close(line, sqrt(1 - SHARES[a]), 0.016);
        check_close(point, cbrt(1 - SHARES[a]), 0.016);
    }
}

/* A cylinder, mu = 0.3, Q = 0.45 mu P: values of another code on this cell and grid. A node of the
 * 126 in contact may differ. */
static void coupled_cylinder(void **state) {
    (void)state;
    static const struct {
        double poisson, radius;
        size_t steps;
    } OTHERS[] = {{0.5, 0.748, 0}, {0.3, 0.750, 0}, {0.3, 0.492, 8}, {0, 0.766, 0}, {0, 0.397, 8}};
    struct slip_options options = SLIP_DEFAULTS;
    options.friction = 0.3;
    for (size_t a = 0; a < sizeof OTHERS / sizeof *OTHERS; a++) {
        options.poisson = OTHERS[a].poisson;
        options.press_steps = OTHERS[a].steps;
        double radius = stick_radius(1024, 1, options, 1.0 / 16, 0.45);
        printf("[   INFO   ] nu = %.1f, pressed %s friction: %.4f, others %.3f\n", options.poisson,
               OTHERS[a].steps > 0 ? "with" : "without", radius, OTHERS[a].radius);
        check_close(radius, OTHERS[a].radius, 0.009);
    }
}

/* --- uncoupled: the solution of Ciavarella and Jaeger --- */

enum { PROFILE = 256 };

/* Tractions mu (p(P) - p(P - Q/mu)) on a rough profile at nu = 1/2 (Ciavarella 1998, Jaeger 1998),
 * and the displacement mu times that of the approaches. After Q to -Q they have the other sign. */
static void uncoupled_profile(void **unused) {
    (void)unused;
    const double pressure = 2, share = 0.6, mu = 0.4;
    struct slip_options options = SLIP_DEFAULTS;
    struct scene scene;
    options.poisson = 0.5;
    options.friction = mu;
    options.tolerance = 1e-12;
    scene_open(&scene, (struct grid){.nx = PROFILE, .ny = 1, .lx = 1, .ly = 1}, DEEP, 1e-12);
    roughen(&scene.grid, 5, 2, 32, scene.z);
    struct slip *slip = made(&scene.grid, &options);
    press(slip, scene.z, pressure);
    struct slip_state state = load(slip, share * mu * pressure);
    double q[PROFILE], most = 0;
    scene_begin(&scene);
    scene_press(&scene, pressure);
    for (size_t i = 0; i < PROFILE; i++) {
        q[i] = mu * scene.state.p[i];
        most = fmax(most, q[i]);
    }
    double gap = scene.state.mean_gap;
    scene_press(&scene, (1 - share) * pressure);
    for (size_t i = 0; i < PROFILE; i++) {
        q[i] -= mu * scene.state.p[i];
        check_close(state.qx[i], q[i], 1e-8 * most);
    }
    assert_true(state.stuck > 10 && state.stuck < state.nodes);
    assert_int_equal(state.stuck, scene.state.nodes);
    check_relative(state.displacement, mu * (scene.state.mean_gap - gap), 1e-8);
    state = load(slip, -share * mu * pressure);
    for (size_t i = 0; i < PROFILE; i++)
        check_close(state.qx[i], -q[i], 1e-8 * most);
    assert_true(state.work > 0);
    slip_destroy(&slip);
    scene_close(&scene);
}

/* Without friction the pressures have the digits of contact, however the flat is pressed on. */
static void without_friction(void **unused) {
    (void)unused;
    const struct grid grid = {.nx = 32, .ny = 24, .lx = 1, .ly = 1};
    struct error err = {0};
    struct slip_state state;
    struct slip_options options = SLIP_DEFAULTS;
    struct scene scene;
    options.friction = 0;
    options.press_steps = 4;
    scene_open(&scene, grid, DEEP, options.tolerance);
    roughen(&grid, 3, 1, 6, scene.z);
    struct slip *slip = made(&grid, &options);
    state = press(slip, scene.z, 0.5);
    scene_begin(&scene);
    scene_press(&scene, 0.5);
    assert_memory_equal(state.p, scene.state.p, 32 * 24 * sizeof(double));
    state = load(slip, 0);
    assert_memory_equal(state.p, scene.state.p, 32 * 24 * sizeof(double));
    assert_int_equal(slip_load(slip, 1e-9, &state, &err), ERROR_INPUT);
    slip_destroy(&slip);
    scene_close(&scene);
}

/* --- coupled: an independent solver --- */

/* Follows loads, and compares each state with the independent solution at the flat's position. The
 * residual asked, 1e-11 of the displacements, leaves less than 1e-7 of the tractions. */
static void compare(struct slip_scene *scene, double pressure, const double *shares, size_t count) {
    const double mu = scene->options.friction;
    struct slip *slip = made(&scene->grid, &scene->options);
    struct slip_state state = press(slip, scene->z, pressure);
    double *t = zeros(3 * scene->n), flat[3], most = largest(scene->n, state.p);
    for (size_t step = 0; step <= count; step++) {
        if (step > 0)
            state = load(slip, shares[step - 1] * mu * pressure);
        slip_scene_take(scene, &state);
        const bool frictionless = step == 0 && scene->options.press_steps == 0;
        slip_scene_flat(scene, flat);
        if (frictionless)
            flat[1] = flat[2] = 0;
        else {
            size_t sweeps = slip_scene_solve(scene, flat, t, 1e-11 * most);
            printf("[   INFO   ] step %zu: %zu of %zu nodes stick, %zu sweeps\n", step, state.stuck,
                   state.nodes, sweeps);
            for (size_t i = 0; i < 3 * scene->n; i++)
                check_close(scene->t[i], t[i], 1e-7 * most);
        }
        check_relative(mean_of(scene->n, state.p), pressure, 1e-12);
        slip_scene_settle(scene, flat + 1);
    }
    check_close(state.traction, shares[count - 1] * mu * pressure, 1e-15);
    assert_true(state.stuck > 0 && state.stuck < state.nodes && state.nodes < scene->n);
    slip_destroy(&slip);
    free(t);
}

static void small_profile(void **unused) {
    (void)unused;
    static const double SHARES[] = {0.3, 0.7, -0.2};
    struct slip_options options = SLIP_DEFAULTS;
    struct slip_scene scene;
    options.tolerance = 1e-11;
    options.poisson = 0;
    for (size_t steps = 0; steps < 2; steps++) {
        options.friction = steps == 0 ? 0.3 : 1;
        options.press_steps = steps;
        slip_scene_open(&scene, (struct grid){.nx = 60, .ny = 1, .lx = 1, .ly = 1}, options);
        roughen(&scene.grid, 7, 1, 7, scene.z);
        compare(&scene, 1, SHARES, 3);
        slip_scene_close(&scene);
    }
}

static void small_surface(void **unused) {
    (void)unused;
    static const double SHARES[] = {0.4, 0.8, 0.2};
    struct slip_options options = SLIP_DEFAULTS;
    struct slip_scene scene;
    options.tolerance = 1e-11;
    options.angle = 0.6;
    for (size_t steps = 0; steps < 2; steps++) {
        options.poisson = steps == 0 ? 0.3 : 0;
        options.friction = steps == 0 ? 0.3 : 1;
        options.press_steps = steps;
        slip_scene_open(&scene, (struct grid){.nx = 14, .ny = 12, .lx = 1.2, .ly = 1}, options);
        roughen(&scene.grid, 9, 1, 3, scene.z);
        compare(&scene, 0.8, SHARES, 3);
        slip_scene_close(&scene);
    }
}

/* Rough faces at the largest friction and coupling: all loads end at solutions, whose sets are
 * consistent by the solver's own measure, in at most 40 sets. */
static void high_friction(void **unused) {
    (void)unused;
    struct slip_options options = SLIP_DEFAULTS;
    uint64_t seed = seed_or(20);
    options.poisson = 0;
    for (size_t a = 0; a < 12; a++) {
        const struct grid grid = {
            .nx = a % 3 == 2 ? 32 : 128, .ny = a % 3 == 2 ? 32 : 1, .lx = 1, .ly = 1};
        double *z = zeros(grid_points(&grid));
        options.friction = a % 2 == 0 ? 1 : 0.1;
        options.press_steps = a % 4 == 0 ? 0 : 3;
        roughen(&grid, next_word(&seed), 2, (int)grid.nx / 6, z);
        struct slip *slip = made(&grid, &options);
        press(slip, z, 0.5);
        for (size_t step = 1; step <= 3; step++) {
            struct slip_state state = load(slip, 0.3 * (double)step * options.friction * 0.5);
            assert_true(state.violation <= options.tolerance && state.sets <= 40);
            assert_true(state.stuck > 0 && state.stuck < state.nodes);
        }
        slip_destroy(&slip);
        free(z);
    }
}

/* --- what is refused --- */

static int always(void *context) {
    (void)context;
    return 1;
}

static int third(void *context) {
    int *calls = context;
    return ++*calls >= 3;
}

/* A load that was stopped among its sets leaves the gaps, and all else, of the load before. */
static void stopped_loads_leave_the_state(void **unused) {
    (void)unused;
    enum { POINTS = 64 };
    const struct grid grid = {.nx = POINTS, .ny = 1, .lx = 1, .ly = 1};
    struct slip_options options = SLIP_DEFAULTS;
    struct error err = {0};
    struct slip_state state;
    double z[POINTS] = {0}, gap[POINTS];
    int calls = 0;
    options.poisson = 0;
    roughen(&grid, 1, 1, 8, z);
    struct slip *slip = made(&grid, &options);
    press(slip, z, 1);
    const struct slip_state before = load(slip, 0.05);
    memcpy(gap, before.gap, sizeof gap);
    slip_set_stop(slip, third, &calls);
    assert_int_equal(slip_load(slip, 0.18, &state, &err), ERROR_STOPPED);
    assert_int_equal(calls, 3);
    slip_set_stop(slip, NULL, NULL);
    const struct slip_state after = load(slip, 0.05);
    assert_memory_equal(after.gap, gap, sizeof gap);
    assert_true(after.mean_gap == before.mean_gap && after.violation == before.violation);
    assert_true(after.displacement == before.displacement && after.work == before.work);
    slip_destroy(&slip);
}

static void refusals(void **unused) {
    (void)unused;
    const struct grid grid = {.nx = 32, .ny = 1, .lx = 1, .ly = 1};
    struct error err = {0};
    struct slip_options options = SLIP_DEFAULTS;
    struct slip *slip = NULL;
    struct slip_state state;
    double z[32] = {0};
    roughen(&grid, 1, 1, 4, z);
    options.friction = -0.1;
    assert_int_equal(slip_create(&slip, &grid, &options, &err), ERROR_INPUT);
    assert_non_null(strstr(err.text, "friction = -0.1"));
    options.friction = 0.2;
    options.angle = 1;
    assert_int_equal(slip_create(&slip, &grid, &options, &err), ERROR_INPUT);
    assert_non_null(strstr(err.text, "angle"));
    options.angle = 0;
    slip = made(&grid, &options);
    assert_int_equal(slip_load(slip, 0, &state, &err), ERROR_STATE);
    assert_int_equal(slip_press(slip, z, 0, &state, &err), ERROR_INPUT);
    press(slip, z, 1);
    assert_int_equal(slip_load(slip, 0.2, &state, &err), ERROR_INPUT);
    assert_non_null(strstr(err.text, "0.2"));
    assert_int_equal(slip_load(slip, NAN, &state, &err), ERROR_INPUT);
    slip_set_stop(slip, always, NULL);
    assert_int_equal(slip_load(slip, 0.1, &state, &err), ERROR_STOPPED);
    slip_set_stop(slip, NULL, NULL);
    double after = load(slip, 0.1).displacement;
    press(slip, z, 1);
    assert_true(load(slip, 0.1).displacement == after);
    slip_destroy(&slip);
    options.tolerance = 1e-8;
    options.max_sets = 1;
    slip = made(&grid, &options);
    press(slip, z, 1);
    assert_int_equal(slip_load(slip, 0.19, &state, &err), ERROR_NUMERIC);
    assert_non_null(strstr(err.text, "mean pressure of 1 E*"));
    slip_destroy(&slip);
    options.max_sets = SLIP_DEFAULTS.max_sets;
    options.max_iterations = 2;
    slip = made(&grid, &options);
    press(slip, z, 1);
    assert_int_equal(slip_load(slip, 0.19, &state, &err), ERROR_NUMERIC);
    assert_non_null(strstr(err.text, "2 iterations"));
    slip_destroy(&slip);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(cattaneo_s_stick_radius),
                                       cmocka_unit_test(coupled_cylinder),
                                       cmocka_unit_test(uncoupled_profile),
                                       cmocka_unit_test(without_friction),
                                       cmocka_unit_test(small_profile),
                                       cmocka_unit_test(small_surface),
                                       cmocka_unit_test(high_friction),
                                       cmocka_unit_test(stopped_loads_leave_the_state),
                                       cmocka_unit_test(refusals)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
