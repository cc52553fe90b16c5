/* Protects paths of loads along the face: a cycle against the solutions of Ciavarella, Jaeger and
 * Masing, and that drawn scenes of any kind end at states within the friction, in few sets. */
#include "tests/support/check.h"

#include "core/contact/slip/partial_slip.h"
#include "core/surface/transform.h"
#include "tests/support/contact_scene.h"
#include "tests/support/effort.h"
#include "tests/support/seed.h"
#include <complex.h>
#include <stdio.h>

static double uniform(uint64_t *seed, double from, double to) {
    return from + (to - from) * (double)(next_word(seed) >> 11) * 0x1p-53;
}

static size_t whole(uint64_t *seed, size_t from, size_t to) {
    return from + (size_t)(next_word(seed) % (to - from + 1));
}

/* Fills heights of waves with random phases, least to `most` a side, whose amplitudes fall by
 * hurst + 1 (profiles: 1/2). Waves along y count `lay` times. The RMS slope is 1. */
static void roughen(const struct grid *grid, uint64_t *seed, double hurst, double least,
                    double most, double lay, double *z) {
    struct error err = {0};
    struct transform *plan = NULL;
    const double fall = hurst + (grid_is_profile(grid) ? 0.5 : 1);
    double square = 0;
    if (transform_create(&plan, grid, grid->nx / 2, grid->ny / 2, &err) != 0)
        fail_msg("%s", err.text);
    double complex *spectrum = transform_spectrum(plan);
    for (size_t at = 0; at < (grid->nx / 2 + 1) * grid->ny; at++) {
        const size_t mx = at / grid->ny, row = at % grid->ny;
        const double my = row <= grid->ny / 2 ? (double)row : (double)row - (double)grid->ny;
        const double m = hypot((double)mx, lay * my), phase = uniform(seed, 0, 2 * M_PI);
        const bool in = m >= least && m <= most && mx > 0 && 2 * mx < grid->nx;
        spectrum[at] = in ? pow(m, -fall) * cexp(I * phase) : 0;
        const double slope = 2 * M_PI * hypot((double)mx / grid->lx, my / grid->ly);
        square += in ? 2 * pow(m, -2 * fall) * slope * slope : 0;
    }
    transform_inverse(plan, z);
    assert_true(square > 0);
    for (size_t i = 0; i < grid_points(grid); i++)
        z[i] /= sqrt(square);
    transform_destroy(&plan);
}

static struct slip *pressed(const struct grid *grid, const struct slip_options *options,
                            const double *z, double pressure, struct slip_state *state) {
    struct error err = {0};
    struct slip *slip = NULL;
    if (slip_create(&slip, grid, options, &err) != 0 ||
        slip_press(slip, z, pressure, state, &err) != 0)
        fail_msg("%s", err.text);
    return slip;
}

static void load(struct slip *slip, double traction, struct slip_state *state) {
    struct error err = {0};
    if (slip_load(slip, traction, state, &err) != 0)
        fail_msg("%s", err.text);
}

/* --- a cycle --- */

enum { RISES = 8 };

/* Fills the displacements of RISES equal loads up to share of the friction without coupling: the
 * gaps of contacts under P and P - Q/mu, times mu (Ciavarella 1998, Jaeger 1998). */
static void rise(struct scene *scene, double mu, double pressure, double share,
                 double displacement[RISES + 1]) {
    scene_begin(scene);
    scene_press(scene, pressure);
    const double gap = scene->state.mean_gap;
    for (size_t i = 0; i <= RISES; i++) {
        scene_press(scene, pressure * (1 - share * (double)i / RISES));
        displacement[i] = mu * (scene->state.mean_gap - gap);
    }
}

/* A load that goes to share of the friction, back to its opposite, and again, in steps of which
 * those of a turned load are twice as long, follows f(Q) - 2 f((Q - Q')/2), f the first rise
 * (Masing's rule). At nu = 1/2 that is exact of profiles. Of surfaces the first rise is times the
 * ratio of stiffnesses of a circle (F24.2), which their contact exceeds by up to 1 %, and the
 * tractions across the load, which it leaves out, change it by more. So their cycle is compared
 * with their own first rise. The work of a cycle is its area by the same steps. */
static void masing_cycle(const struct grid *grid, double tolerance, double first, double after) {
    const double pressure = 0.1, share = 0.9, mu = 0.3, top = share * mu * pressure;
    struct slip_options options = SLIP_DEFAULTS;
    struct scene scene;
    struct slip_state state;
    double f[RISES + 1], g[RISES + 1] = {0}, area = 0, most = 0;
    uint64_t seed = 4;
    options.poisson = 0.5;
    options.friction = mu;
    options.tolerance = tolerance;
    scene_open(&scene, *grid, DEEP, 1e-12);
    roughen(grid, &seed, 0.8, 2, (double)grid->nx / 8, 1, scene.z);
    rise(&scene, mu, pressure, share, f);
    struct slip *slip = pressed(grid, &options, scene.z, pressure, &state);
    const double ratio = grid_is_profile(grid) ? 1 : (1 - 0.5 / 2) / (1 - 0.5);
    for (size_t i = 1; i <= RISES; i++) {
        load(slip, top * (double)i / RISES, &state);
        g[i] = state.displacement;
        most = fmax(most, fabs(g[i] / (ratio * f[i]) - 1));
        area += top / RISES * (g[i - 1] + g[i]) / 2;
    }
    printf("[   INFO   ] the first rise is within %.2g of Ciavarella's\n", most);
    assert_true(most <= first);
    const double begun = state.work;
    most = 0;
    for (size_t turn = 0; turn < 2; turn++)
        for (size_t i = 1; i <= RISES; i++) {
            const double sign = turn == 0 ? 1 : -1;
            load(slip, sign * top * (1 - 2 * (double)i / RISES), &state);
            double expected = sign * (g[RISES] - 2 * g[i]);
            most = fmax(most, fabs(state.displacement - expected) / g[RISES]);
        }
    const double work = state.work - begun, masing = 4 * top * g[RISES] - 8 * area;
    printf("[   INFO   ] the cycle is within %.2g of Masing's rule, its work within %.2g\n", most,
           fabs(work / masing - 1));
    assert_true(most <= after);
    check_relative(work, masing, after);
    slip_destroy(&slip);
    scene_close(&scene);
}

static void cycle_of_a_profile(void **unused) {
    (void)unused;
    masing_cycle(&(struct grid){.nx = 512, .ny = 1, .lx = 1, .ly = 1}, 1e-11, 1e-7, 1e-7);
}

static void cycle_of_a_surface(void **unused) {
    (void)unused;
    masing_cycle(&(struct grid){.nx = 64, .ny = 64, .lx = 1, .ly = 1}, 1e-6, 0.06, 0.01);
}

/* --- drawn scenes --- */

enum { SIDE_MOST = 4, LOADS = 4, SETS_MOST = 60 };

struct drawn {
    struct grid grid;
    struct slip_options options;
    double hurst, points, lay, pressure;
};

/* Draws a scene; large says whether sides go to 256, else to 64 (profiles: four times). */
static struct drawn draw_scene(uint64_t *seed, bool large) {
    const bool profile = next_word(seed) % 3 == 0;
    const size_t most = large ? 256 : 64;
    struct drawn drawn = {.grid = {.lx = 1, .ly = 1}, .options = SLIP_DEFAULTS};
    drawn.grid.nx = whole(seed, 16, profile ? SIDE_MOST * most : most);
    drawn.grid.ny = profile ? 1 : whole(seed, 16, most);
    drawn.grid.ly = profile ? 1 : (double)drawn.grid.ny / (double)drawn.grid.nx;
    drawn.options.poisson = (double[]){0, 0.3, 0.5, uniform(seed, 0, 0.5)}[next_word(seed) % 4];
    drawn.options.friction = next_word(seed) % 4 == 0 ? 1 : pow(10, uniform(seed, -1.7, 0));
    drawn.options.angle = profile ? 0 : uniform(seed, -M_PI, M_PI);
    drawn.options.press_steps = next_word(seed) % 4 == 0 ? whole(seed, 1, 3) : 0;
    drawn.options.tolerance = next_word(seed) % 2 == 0 ? 1e-4 : 1e-8;
    drawn.hurst = uniform(seed, 0.1, 1);
    drawn.points = uniform(seed, 4, 10);
    drawn.lay = profile ? 1 : pow(2, uniform(seed, -2, 2));
    drawn.pressure = pow(10, uniform(seed, -2.5, -0.22));
    return drawn;
}

/* Pressures are not negative and tractions within the friction, to rounding, with the means asked,
 * and what the solver's own judgement left is below the tolerance. */
static void check_drawn(const struct drawn *drawn, double traction,
                        const struct slip_state *state) {
    const size_t n = grid_points(&drawn->grid);
    const double c = cos(drawn->options.angle), d = sin(drawn->options.angle);
    double along = 0, across = 0;
    for (size_t i = 0; i < n; i++) {
        double x = state->qx[i], y = state->qy != NULL ? state->qy[i] : 0;
        bool within = hypot(x, y) <= drawn->options.friction * state->p[i] * (1 + 1e-6) +
                                         1e-6 * drawn->options.friction * drawn->pressure;
        if (!(state->p[i] >= 0) || (!within && drawn->options.tolerance < 1e-6))
            fail_msg("node %zu bears %g and (%g, %g)", i, state->p[i], x, y);
        along += (c * x + d * y) / (double)n;
        across += (c * y - d * x) / (double)n;
    }
    const double bound = drawn->options.friction * drawn->pressure;
    check_relative(mean_of(n, state->p), drawn->pressure, 1e-10);
    check_close(along, traction, 1e-10 * bound);
    check_close(across, 0, 1e-10 * bound);
    assert_true(state->violation <= drawn->options.tolerance && state->sets <= SETS_MOST);
}

/* Paths of rising and falling loads on drawn scenes: all end, and at most one scene of 100 without
 * a solution, which is said. */
static void drawn_paths(void **unused) {
    (void)unused;
    const size_t scenes = 60 * effort();
    uint64_t seed = seed_or(6);
    size_t sets = 0, most = 0, loads = 0, failed = 0;
    for (size_t a = 0; a < scenes; a++) {
        const uint64_t begun = seed;
        const struct drawn drawn = draw_scene(&seed, effort() > 1 && a % 8 == 0);
        struct slip_state state;
        double *z = zeros(grid_points(&drawn.grid));
        const double highest = (double)drawn.grid.nx / drawn.points;
        roughen(&drawn.grid, &seed, drawn.hurst, 1, fmax(1.5, highest), drawn.lay, z);
        struct error err = {0};
        struct slip *slip = NULL;
        int status = slip_create(&slip, &drawn.grid, &drawn.options, &err);
        if (status == 0)
            status = slip_press(slip, z, drawn.pressure, &state, &err);
        for (size_t b = 0; status == 0 && b < LOADS; b++, loads++) {
            double share = b == 0 ? uniform(&seed, 0, 0.97) : uniform(&seed, -0.97, 0.97);
            double traction = share * drawn.options.friction * drawn.pressure;
            status = slip_load(slip, traction, &state, &err);
            if (status == 0)
                check_drawn(&drawn, traction, &state);
            sets += state.sets;
            most = state.sets > most ? state.sets : most;
        }
        if (status != 0 && status != ERROR_NUMERIC)
            fail_msg("%s", err.text);
        failed += status != 0;
        if (status != 0)
            print_message("scene of the seed %" PRIu64 ", %zu x %zu, nu = %g, friction %g: %s\n",
                          begun, drawn.grid.nx, drawn.grid.ny, drawn.options.poisson,
                          drawn.options.friction, err.text);
        slip_destroy(&slip);
        free(z);
    }
    printf("[   INFO   ] %zu scenes, %zu loads: %.1f sets a load, at most %zu; %zu failed\n",
           scenes, loads, (double)sets / (double)loads, most, failed);
    assert_true(100 * failed <= scenes);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(cycle_of_a_profile),
                                       cmocka_unit_test(cycle_of_a_surface),
                                       cmocka_unit_test(drawn_paths)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
