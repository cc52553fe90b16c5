/* Protects what callers of the model full rely on beside its values: a stop is heard during linear
 * equations, too; heights whose sum overflows are refused; the tolerance holds for the stiffness;
 * and overhangs count in the memory. */
#include "core/full/full.h"
#include "core/random.h"
#include "tests/support/check.h"
#include "tests/support/unstopped.h"
#include <string.h>

enum { SIDE = 16, NODES = SIDE * SIDE };
static const struct grid SURFACE = {SIDE, SIDE, SIDE, SIDE}, PROFILE = {NODES, 1, NODES, 1};

/* Random heights without the shortest waves, of an RMS slope between neighbours. */
static void draw(const struct grid *grid, double slope, double *z) {
    double square = 0;
    random_uniform((struct random_key){.seed = 12}, 0, 0, NODES, z);
    for (int pass = 0; pass < 3; pass++) {
        double smooth[NODES];
        square = 0;
        for (size_t i = 0; i < NODES; i++) {
            size_t x = i % grid->nx, y = i / grid->nx;
            double right = z[y * grid->nx + (x + 1) % grid->nx];
            double above = z[(y + 1) % grid->ny * grid->nx + x];
            square += (pow(right - z[i], 2) + pow(above - z[i], 2)) / NODES;
            smooth[i] = z[i] + right + above;
        }
        if (pass < 2)
            memcpy(z, smooth, sizeof smooth);
    }
    for (size_t i = 0; i < NODES; i++)
        z[i] *= slope / sqrt(square);
}

static struct full *begin(const struct grid *grid, double poisson,
                          const struct full_options *options, const double *z) {
    const struct block block = {
        .poisson = poisson, .height = SIDE, .layer_growth = 1.5, .weighting = GAP_DUAL};
    struct full *full = NULL;
    struct error err = {0};
    if (full_create(&full, grid, &block, options, &err) != 0 || full_begin(full, z, &err) != 0)
        fail_msg("%s", err.text);
    return full;
}

/* Stops when it has been asked so often. */
struct patience {
    size_t asked, most;
};

static int count(void *context) {
    struct patience *patience = context;
    return ++patience->asked > patience->most;
}

/* Each iteration asks, of Newton's method and of linear equations, and those of the stiffness and
 * of the linear model do besides. Wherever it stops, the load is then reached as if it had not. */
static void a_stop_is_heard_in_each_iteration(void **state) {
    (void)state;
    static const double LOAD = 0.03, POISSON = 0.4999;
    double z[NODES];
    struct contact_state pressed;
    struct full_report report;
    struct error err = {0};
    draw(&SURFACE, 0.3, z);
    struct full *full = begin(&SURFACE, POISSON, &FULL_DEFAULTS, z);
    struct patience whole = {.most = SIZE_MAX};
    full_set_stop(full, count, &whole);
    must(full_press(full, LOAD, &pressed, &report, &err), &err);
    const double stiffness = pressed.stiffness;
    print_message("asked %zu times in %zu + %zu iterations\n", whole.asked, report.newton,
                  report.linear);
    assert_true(whole.asked > report.newton + report.linear + 10);
    for (size_t part = 0; part < 8; part++) {
        struct patience some = {.most = part * (whole.asked - 1) / 7};
        must(full_begin(full, z, &err), &err);
        full_set_stop(full, count, &some);
        assert_int_equal(full_press(full, LOAD, &pressed, NULL, &err), ERROR_STOPPED);
        assert_int_equal(some.asked, some.most + 1);
        full_set_stop(full, NULL, NULL);
        must(full_press(full, LOAD, &pressed, NULL, &err), &err);
        check_relative(pressed.stiffness, stiffness, 1e-3);
    }
    full_destroy(&full);
}

/* A flat surface, whose heights are finite and whose mean is not. */
static void heights_that_overflow_are_refused(void **state) {
    (void)state;
    double z[NODES] = {0};
    struct error err = {0};
    struct full *full = begin(&SURFACE, 0.3, &FULL_DEFAULTS, z);
    for (size_t i = 0; i < NODES; i++)
        z[i] = 1.7e308;
    assert_int_equal(full_begin(full, z, &err), ERROR_INPUT);
    assert_non_null(strstr(err.text, "up to 1.7e+308: their sum is not finite"));
    full_destroy(&full);
}

static const double TOLERANCE = 1e-12; /* the least of studies */

static double stiffness_of(enum equation_solver solver, const double *z) {
    struct full_options options = FULL_DEFAULTS;
    struct contact_state pressed;
    struct error err = {0};
    options.tolerance = TOLERANCE;
    options.solver = solver;
    struct full *full = begin(&PROFILE, 0.3, &options, z);
    must(full_press(full, 0.02, &pressed, NULL, &err), &err);
    full_destroy(&full);
    return pressed.stiffness;
}

/* With a factorisation the equations of the stiffness are solved to rounding, so that those that
 * are iterated are within the bound that is stated of a tolerance, 1000 times this. */
static void the_tolerance_holds_for_the_stiffness(void **state) {
    (void)state;
    for (double slope = 0.2; slope < 0.65; slope += 0.2) {
        double z[NODES];
        draw(&PROFILE, slope, z);
        check_relative(stiffness_of(SOLVER_ITERATED, z), stiffness_of(SOLVER_FACTORED, z),
                       1e3 * TOLERANCE);
    }
}

/* A face that may overhang has the vectors of two states and of what drags, pairs of both, and what
 * finds them. */
static void overhangs_take_memory(void **state) {
    (void)state;
    const struct grid *const grids[] = {&PROFILE, &SURFACE};
    const struct block block = {.poisson = 0.3, .height = SIDE, .layer_growth = 1.5};
    for (size_t g = 0; g < 2; g++) {
        struct mesh *mesh = NULL;
        struct error err = {0};
        must(mesh_create(&mesh, grids[g], &block, FULL_DEFAULTS.transition, &err), &err);
        const double more = full_bytes(grids[g], &block, &FULL_DEFAULTS, 20, true) -
                            full_bytes(grids[g], &block, &FULL_DEFAULTS, 20, false);
        const double pairs = 2.0 * (double)self_pairs_most(mesh) * sizeof(struct self_pair);
        const double vectors = 3.0 * sizeof(double) * (double)mesh_degrees_of_freedom(mesh);
        const double least = self_contact_bytes(mesh) + pairs + vectors;
        assert_true(more >= least && (g == 1 || more < 1.01 * least));
        mesh_destroy(&mesh);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_stop_is_heard_in_each_iteration),
        cmocka_unit_test(heights_that_overflow_are_refused),
        cmocka_unit_test(overhangs_take_memory),
        cmocka_unit_test(the_tolerance_holds_for_the_stiffness),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
