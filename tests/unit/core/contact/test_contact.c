/* Protects the contact solver's contract: what it refuses and how it says so, ends of the range of
 * loads, states that depend on the load alone, units, symmetries of the grid, failures that do no
 * harm; and the counts of patches and areas on given patterns. */
#include "tests/support/check.h"
#include "tests/support/effort.h"

#include "tests/support/contact_scene.h"
#include <stdio.h>

static const struct block LAYERED = {
    .model = MODEL_LAYERED, .poisson = 0.3, .height = 1.5, .layer_growth = 1.2};

/* Numbers in [0, 1), the same in every run: a rough surface for small grids. */
static double noise(size_t i) {
    double x = sin(12.9898 * (double)(i + 1)) * 43758.5453;
    return x - floor(x);
}

static void noisy_scene(struct scene *scene, struct grid grid, struct block block,
                        double tolerance) {
    scene_open(scene, grid, block, tolerance);
    for (size_t i = 0; i < scene_points(scene); i++)
        scene->z[i] = noise(i) + 2 * cos(2 * M_PI * (double)(i % grid.nx) / (double)grid.nx);
    scene_begin(scene);
}

static struct grid square(size_t n) {
    return (struct grid){.nx = n, .ny = n, .lx = 1, .ly = 1};
}

static struct grid line(size_t n) {
    return (struct grid){.nx = n, .ny = 1, .lx = 1, .ly = 1};
}

static double *copy(size_t n, const double *x) {
    double *y = zeros(n);
    memcpy(y, x, n * sizeof *y);
    return y;
}

static double apart(size_t n, const double *x, const double *y) {
    double most = 0;
    for (size_t i = 0; i < n; i++)
        most = fabs(x[i] - y[i]) <= most ? most : fabs(x[i] - y[i]); /* a NaN stays */
    return most;
}

/* --- what is refused --- */

static void pressures_refused(void **state) {
    (void)state;
    static const struct {
        double pressure;
        const char *text;
    } cases[] = {
        {-1e-300, "mean pressure = -1e-300; allowed: 0 or more, finite"},
        {NAN, "allowed: 0 or more, finite"},
        {INFINITY, "mean pressure = inf; allowed: 0 or more, finite"},
        {-INFINITY, "mean pressure = -inf; allowed: 0 or more, finite"},
    };
    struct scene scene;
    noisy_scene(&scene, line(16), DEEP, 1e-10);
    scene_press(&scene, 0.1);
    struct contact_state before = scene.state, after = before;
    double *p = copy(16, before.p);
    for (size_t a = 0; a < sizeof cases / sizeof *cases; a++) {
        struct error err = {0};
        assert_int_equal(contact_press(scene.contact, cases[a].pressure, &after, &err),
                         ERROR_INPUT);
        assert_non_null(strstr(err.text, cases[a].text));
        assert_memory_equal(&after, &before, sizeof after);
    }
    scene_press(&scene, 0.1); /* the solver still holds its state */
    assert_true(apart(16, p, scene.state.p) <= 1e-9);
    free(p);
    scene_close(&scene);
}

static void heights_refused(void **state) {
    (void)state;
    struct scene scene;
    struct error err = {0};
    noisy_scene(&scene, square(4), DEEP, 1e-10);
    static const double bad[] = {NAN, INFINITY, -INFINITY};
    for (size_t a = 0; a < 3; a++) {
        scene.z[11] = bad[a];
        assert_int_equal(contact_begin(scene.contact, scene.z, &err), ERROR_INPUT);
        assert_non_null(strstr(err.text, "height 11 of the surface = "));
        assert_non_null(strstr(err.text, "is not finite"));
    }
    scene.z[11] = 1;
    scene_begin(&scene);
    scene_press(&scene, 0.1);
    check_contact(&scene);
    scene_close(&scene);
}

static void tolerances_refused(void **state) {
    (void)state;
    struct compliance *compliance = NULL;
    struct contact *contact = NULL;
    struct error err = {0};
    struct grid grid = line(8);
    assert_int_equal(compliance_create(&compliance, &grid, &DEEP, &err), 0);
    static const double bad[] = {0, -1e-8, 1, NAN, INFINITY};
    for (size_t a = 0; a < sizeof bad / sizeof *bad; a++) {
        struct contact_options options = CONTACT_DEFAULTS;
        options.tolerance = bad[a];
        assert_int_equal(contact_create(&contact, compliance, &options, &err), ERROR_INPUT);
        assert_null(contact);
        assert_non_null(strstr(err.text, "contact tolerance = "));
        assert_non_null(strstr(err.text, "allowed: above 0, below 1"));
    }
    contact_destroy(&contact); /* of none */
    compliance_destroy(&compliance);
}

/* Without its tangent a half-space has the same pressures, load after load, and no stiffness. */
static void tangents_can_be_left_out(void **state) {
    (void)state;
    struct scene scene, bare;
    noisy_scene(&scene, square(16), DEEP, 1e-10);
    noisy_scene(&bare, square(16), DEEP, 1e-10);
    struct contact_options options = CONTACT_DEFAULTS;
    struct error err = {0};
    options.tolerance = 1e-10;
    options.without_tangent = true;
    contact_destroy(&bare.contact);
    assert_int_equal(contact_create(&bare.contact, bare.compliance, &options, &err), 0);
    scene_begin(&scene);
    scene_begin(&bare);
    double full = contact_full_pressure(scene.contact);
    static const double LOADS[] = {0.01, 0.02, 0.3, 0.1, 0.1};
    for (size_t k = 0; k < sizeof LOADS / sizeof *LOADS; k++) {
        scene_press(&scene, LOADS[k] * full);
        scene_press(&bare, LOADS[k] * full);
        assert_int_equal(bare.state.nodes, scene.state.nodes);
        for (size_t i = 0; i < 256; i++)
            check_close(bare.state.p[i], scene.state.p[i], 1e-8 * full);
        check_relative(bare.state.mean_gap, scene.state.mean_gap, 1e-8);
        assert_null(bare.state.tangent);
        assert_true(isnan(bare.state.stiffness));
        assert_true(scene.state.stiffness > 0);
    }
    scene_close(&bare);
    scene_close(&scene);
}

/* A loose tolerance loosens the tangent too: stiffness, an energy, stays about within the
 * tolerance where the nodes in contact are the same, and the work falls by a third. */
static void tangents_follow_the_tolerance(void **state) {
    (void)state;
    enum { LOADS = 8, SIDE = 64, POINTS = SIDE * SIDE };
    static bool touches[LOADS][POINTS];
    double stiffness[LOADS], work[2] = {0};
    size_t same = 0;
    static const double TOLERANCES[] = {1e-8, 1e-4};
    for (size_t t = 0; t < 2; t++) {
        struct scene scene;
        noisy_scene(&scene, square(SIDE), DEEP, TOLERANCES[t]);
        scene_begin(&scene);
        double full = contact_full_pressure(scene.contact);
        for (size_t k = 0; k < LOADS; k++) {
            scene_press(&scene, 0.02 * (double)(k + 1) * full);
            work[t] += scene.state.work;
            bool all = t == 1;
            for (size_t i = 0; i < POINTS; i++) {
                all = all && touches[k][i] == (scene.state.p[i] > 0);
                touches[k][i] = scene.state.p[i] > 0;
            }
            if (all)
                check_relative(scene.state.stiffness, stiffness[k], 2e-4);
            same += all;
            stiffness[k] = scene.state.stiffness;
        }
        scene_close(&scene);
    }
    print_message("work at 1e-4: %.2f of that at 1e-8\n", work[1] / work[0]);
    assert_true(same >= LOADS / 2);
    assert_true(work[1] < 0.72 * work[0]);
}

static void too_few_iterations(void **state) {
    (void)state;
    struct scene scene, sound;
    noisy_scene(&scene, square(16), DEEP, 1e-10);
    noisy_scene(&sound, square(16), DEEP, 1e-10);
    struct contact_options options = {
        .tolerance = 1e-10, .max_iterations = 6, .stall_iterations = 60, .hardness = INFINITY};
    struct error err = {0};
    contact_destroy(&scene.contact);
    assert_int_equal(contact_create(&scene.contact, scene.compliance, &options, &err), 0);
    scene_begin(&scene);
    double full = contact_full_pressure(scene.contact), light = 1e-4 * full;
    scene_press(&sound, light);
    double *p = copy(256, sound.state.p);
    assert_true(sound.state.iterations <= 6); /* or the choice of loads does not fit */
    scene_press(&scene, light);
    struct contact_state untouched = {.nodes = 77};
    assert_int_equal(contact_press(scene.contact, 0.1 * full, &untouched, &err), ERROR_NUMERIC);
    char load[40];
    snprintf(load, sizeof load, "mean pressure of %g E*", 0.1 * full);
    assert_non_null(strstr(err.text, load));
    assert_non_null(strstr(err.text, "did not converge: 6 iterations left gaps of "));
    assert_non_null(strstr(err.text, "RMS heights"));
    assert_int_equal(untouched.nodes, 77);
    scene_press(&scene, light); /* anew, as if nothing had been */
    assert_memory_equal(scene.state.p, p, 256 * sizeof *p);
    scene_press(&scene, 2 * full);
    assert_int_equal(scene.state.nodes, 256);
    scene_begin(&scene);
    assert_int_equal(contact_press(scene.contact, 0.1 * full, &untouched, &err), ERROR_NUMERIC);
    scene_press(&scene, 0);
    assert_int_equal(scene.state.nodes, 0);
    free(p);
    scene_close(&scene);
    scene_close(&sound);
}

/* --- the ends --- */

/* Stops at the call that is the last one, and counts them. */
struct stop_at {
    size_t call, last;
};

static int stop_at(void *context) {
    struct stop_at *at = context;
    return ++at->call >= at->last;
}

/* All that takes iterations hears a stop, the tangent's last of all; the solver then starts anew.
 */
static void stops_are_heard(void **state) {
    (void)state;
    struct scene scene;
    struct error err = {0};
    noisy_scene(&scene, square(48), DEEP, 1e-13);
    double load = 0.3 * contact_full_pressure(scene.contact);
    struct stop_at at = {.last = SIZE_MAX};
    contact_set_stop(scene.contact, stop_at, &at);
    scene_press(&scene, load);
    double *p = copy(scene_points(&scene), scene.state.p);
    size_t calls = at.call;
    assert_true(calls > 1);
    for (size_t last = 1; last <= calls; last++) {
        at = (struct stop_at){.last = last};
        scene_begin(&scene);
        assert_int_equal(contact_press(scene.contact, load, &scene.state, &err), ERROR_STOPPED);
        assert_int_equal(at.call, last);
    }
    assert_non_null(strstr(err.text, "in those of its stiffness"));
    at = (struct stop_at){.last = SIZE_MAX};
    scene_press(&scene, load);
    check_close(apart(scene_points(&scene), p, scene.state.p), 0, 1e-9 * load);
    free(p);
    scene_close(&scene);
}

static void no_load(void **state) {
    (void)state;
    static const enum gap_weighting weightings[] = {GAP_STANDARD, GAP_DUAL};
    for (size_t a = 0; a < 2; a++) {
        struct block block = LAYERED;
        struct scene scene;
        block.weighting = weightings[a];
        noisy_scene(&scene, line(9), block, 1e-10);
        scene_press(&scene, 0.2);
        scene_press(&scene, 0);
        const struct contact_state *s = &scene.state;
        double least = INFINITY;
        for (size_t i = 0; i < 9; i++) {
            assert_true(s->p[i] == 0);
            least = fmin(least, s->opening[i]);
        }
        assert_true(s->nodes == 0 && s->stiffness == 0 && s->violation == 0);
        check_close(least, 0, 1e-14); /* it hangs on its highest point */
        check_contact(&scene);
        scene_close(&scene);
    }
}

static void flat_surface(void **state) {
    (void)state;
    static const double heights[] = {0, 1, -1e100, 1e-300};
    for (size_t a = 0; a < sizeof heights / sizeof *heights; a++) {
        struct scene scene;
        scene_open(&scene, square(4), LAYERED, 1e-10);
        for (size_t i = 0; i < 16; i++)
            scene.z[i] = heights[a];
        scene_begin(&scene);
        assert_true(contact_full_pressure(scene.contact) == 0);
        scene_press(&scene, 1e-8);
        assert_int_equal(scene.state.nodes, 16);
        for (size_t i = 0; i < 16; i++)
            assert_true(scene.state.p[i] == 1e-8 && scene.state.gap[i] == 0);
        assert_true(isinf(scene.state.stiffness) && scene.state.mean_gap == 0);
        assert_true(scene_area(&scene).edges == 1);
        scene_press(&scene, 0);
        assert_true(scene.state.nodes == 0 && scene.state.mean_gap == 0);
        scene_close(&scene);
    }
}

/* One summit takes a light load alone: p = mean * points there. */
static void one_point(void **state) {
    (void)state;
    struct scene scene;
    scene_open(&scene, square(8), DEEP, 1e-10);
    scene.z[27] = 1;
    scene_begin(&scene);
    scene_press(&scene, 1e-6);
    assert_int_equal(scene.state.nodes, 1);
    check_relative(scene.state.p[27], 64e-6, 1e-15); /* rounding */
    check_contact(&scene);
    scene_close(&scene);
}

/* Beyond full contact the pressures rise by a constant and the gap stays closed. */
static void beyond_full_contact(void **state) {
    (void)state;
    struct scene scene;
    noisy_scene(&scene, square(6), LAYERED, 1e-10);
    double full = contact_full_pressure(scene.contact);
    scene_press(&scene, full);
    double *p = copy(36, scene.state.p), least = INFINITY;
    for (size_t i = 0; i < 36; i++)
        least = fmin(least, p[i]);
    check_close(least, 0, 1e-14 * full); /* rounding */
    scene_press(&scene, 100 * full);
    assert_int_equal(scene.state.nodes, 36);
    for (size_t i = 0; i < 36; i++) {
        check_relative(scene.state.p[i] - p[i], 99 * full, 1e-13);
        assert_true(scene.state.gap[i] == 0 && scene.state.opening[i] == 0);
    }
    assert_true(scene.state.mean_gap == 0 && isinf(scene.state.stiffness));
    assert_true(scene.state.iterations == 0);
    free(p);
    scene_close(&scene);
}

/* --- the state depends on the load alone --- */

static void any_path_of_loads(void **state) {
    (void)state;
    static const double up[] = {1e-6, 1e-3, 0.03, 0.2, 0.5, 0.9};
    static const double jumps[] = {0.9, 1e-6, 0.5, 0, 2, 0.03, 1e-3, 0.2, 1e-6};
    enum { LOADS = 6, JUMPS = 9, POINTS = 15 * 12 };
    struct scene scene;
    noisy_scene(&scene, (struct grid){15, 12, 1, 1}, LAYERED, 1e-12);
    double full = contact_full_pressure(scene.contact);
    double *p[LOADS], gap[LOADS], stiffness[LOADS];
    for (size_t a = 0; a < LOADS; a++) {
        scene_press(&scene, up[a] * full);
        check_contact(&scene);
        p[a] = copy(POINTS, scene.state.p);
        gap[a] = scene.state.mean_gap;
        stiffness[a] = scene.state.stiffness;
    }
    for (size_t a = LOADS + JUMPS; a-- > 0;) { /* down, then at random */
        double load = a >= JUMPS ? up[a - JUMPS] : jumps[a];
        scene_press(&scene, load * full);
        for (size_t b = 0; b < LOADS; b++)
            if (up[b] == load) {
                /* Gaps are right to the tolerance of 1e-12, pressures to that times the stiffness
                 * of the shortest waves; the tangent's stiffness to the square of 1e-5 (contact.c).
                 */
                double most = largest(POINTS, p[b]);
                assert_true(apart(POINTS, p[b], scene.state.p) <= 1e-9 * fmax(most, full));
                check_close(scene.state.mean_gap, gap[b], 1e-10);
                check_relative(scene.state.stiffness, stiffness[b], 1e-4);
            }
    }
    for (size_t a = 0; a < LOADS; a++)
        free(p[a]);
    scene_close(&scene);
}

/* A solver that has seen another surface gives the same digits as a new one. */
static void surfaces_leave_nothing(void **state) {
    (void)state;
    struct scene used, fresh;
    noisy_scene(&used, square(12), LAYERED, 1e-10);
    noisy_scene(&fresh, square(12), LAYERED, 1e-10);
    scene_press(&used, 0.3);
    for (size_t i = 0; i < 144; i++)
        used.z[i] = fresh.z[i] = noise(3 * i + 1);
    scene_begin(&used);
    scene_begin(&fresh);
    for (double load = 0.5; load > 1e-3; load /= 5) {
        scene_press(&used, load);
        scene_press(&fresh, load);
        assert_memory_equal(used.state.p, fresh.state.p, 144 * sizeof(double));
        assert_true(used.state.stiffness == fresh.state.stiffness);
        assert_true(used.state.iterations == fresh.state.iterations);
    }
    scene_close(&used);
    scene_close(&fresh);
}

/* --- units --- */

static void any_unit(void **state) {
    (void)state;
    static const double height[] = {1, 1e-9, 1e6, 1e-100, 1e100, 1e-9, 1e6};
    static const double length[] = {1, 1, 1, 1, 1, 1e-9, 1e6};
    for (size_t model = 0; model < 2; model++) {
        struct scene scene;
        double fraction = 0, gap = 0, stiffness = 0, full = 0, *p = NULL;
        for (size_t a = 0; a < sizeof height / sizeof *height; a++) {
            double l = length[a], h = height[a];
            struct block block = model == 0 ? DEEP : LAYERED;
            block.height *= l;
            scene_open(&scene, (struct grid){12, 10, l, 1.5 * l}, block, 1e-12);
            for (size_t i = 0; i < 120; i++)
                scene.z[i] = h * (noise(i) - 0.5);
            scene_begin(&scene);
            scene_press(&scene, 0.2 * h / l);
            struct contact_area area = scene_area(&scene);
            if (a == 0) {
                full = contact_full_pressure(scene.contact);
                fraction = area.edges;
                gap = scene.state.mean_gap;
                stiffness = scene.state.stiffness;
                p = copy(120, scene.state.p);
            }
            check_relative(contact_full_pressure(scene.contact) * (l / h), full, 1e-10);
            check_relative(area.edges, fraction, 1e-10);
            check_relative(scene.state.mean_gap / h, gap, 1e-10);
            check_relative(scene.state.stiffness * l, stiffness, 1e-10);
            for (size_t i = 0; i < 120; i++)
                check_close(scene.state.p[i] * (l / h), p[i], 1e-10);
            scene_close(&scene);
        }
        free(p);
    }
}

/* Pressures are in E*: Poisson's ratio does not enter a half-space, and heights count from any
 * level. */
static void what_does_not_enter(void **state) {
    (void)state;
    struct block other = DEEP;
    other.poisson = 0.49;
    struct scene one, two;
    noisy_scene(&one, line(24), DEEP, 1e-12);
    noisy_scene(&two, line(24), other, 1e-12);
    for (size_t i = 0; i < 24; i++)
        two.z[i] += 4;
    scene_begin(&two);
    scene_press(&one, 0.5);
    scene_press(&two, 0.5);
    assert_true(one.state.nodes > 1 && one.state.nodes < 24);
    assert_true(apart(24, one.state.p, two.state.p) <= 1e-10); /* the tolerance, times stiffness */
    check_close(one.state.mean_gap, two.state.mean_gap, 1e-11);
    scene_close(&one);
    scene_close(&two);
}

/* --- the grid --- */

/* From 2 nodes on, odd, prime, oblong; both models, both weightings: each a solution. */
static void any_grid(void **state) {
    (void)state;
    static const struct grid grids[] = {
        {2, 1, 1, 1}, {3, 1, 1, 1},    {4, 1, 1, 1},    {13, 1, 1, 1},     {31, 1, 1, 1},
        {2, 2, 1, 1}, {2, 3, 1, 1},    {3, 2, 1, 1},    {3, 3, 1, 1},      {7, 5, 1, 1},
        {5, 7, 1, 3}, {16, 4, 1, 2.5}, {11, 13, 2, .3}, {1 << 8, 1, 1, 1},
    };
    static const double loads[] = {1e-8, 1e-3, 0.1, 0.4, 0.8, 0.999999, 1};
    for (size_t a = 0; a < sizeof grids / sizeof *grids; a += case_step())
        for (size_t b = 0; b < 3; b++) {
            struct block block = b == 0 ? DEEP : LAYERED;
            block.weighting = b == 1 ? GAP_STANDARD : GAP_DUAL;
            struct scene scene;
            noisy_scene(&scene, grids[a], block, 1e-10);
            double full = contact_full_pressure(scene.contact);
            for (size_t c = 0; c < sizeof loads / sizeof *loads; c++) {
                scene_press(&scene, loads[c] * full);
                check_contact(&scene);
            }
            scene_close(&scene);
        }
}

static void shifted_grid(void **state) {
    (void)state;
    enum { NX = 16, NY = 9, RIGHT = 5, UP = 7 };
    struct scene here, there;
    noisy_scene(&here, (struct grid){NX, NY, 1, 1}, LAYERED, 1e-12);
    noisy_scene(&there, (struct grid){NX, NY, 1, 1}, LAYERED, 1e-12);
    for (size_t j = 0; j < NY; j++)
        for (size_t i = 0; i < NX; i++)
            there.z[(j + UP) % NY * NX + (i + RIGHT) % NX] = here.z[j * NX + i];
    scene_begin(&there);
    for (double load = 0.01; load < 10; load *= 4) {
        scene_press(&here, load);
        scene_press(&there, load);
        for (size_t j = 0; j < NY; j++)
            for (size_t i = 0; i < NX; i++) /* the tolerance, times the stiffness of short waves */
                check_close(there.state.p[(j + UP) % NY * NX + (i + RIGHT) % NX],
                            here.state.p[j * NX + i], 1e-9);
        check_close(there.state.mean_gap, here.state.mean_gap, 1e-11);
        /* Edges see p^2 of small pressures: square root of their error. */
        check_close(scene_area(&there).edges, scene_area(&here).edges, 1e-5);
    }
    scene_close(&here);
    scene_close(&there);
}

/* The weightings differ by terms of second order in the node distance, not more. */
static void weightings_agree(void **state) {
    (void)state;
    struct block standard = LAYERED, dual = LAYERED;
    dual.weighting = GAP_DUAL;
    struct scene one, two;
    scene_open(&one, line(256), standard, 1e-10);
    scene_open(&two, line(256), dual, 1e-10);
    for (size_t i = 0; i < 256; i++)
        one.z[i] = two.z[i] = cos(2 * M_PI * (double)i / 256);
    scene_begin(&one);
    scene_begin(&two);
    scene_press(&one, 1);
    scene_press(&two, 1);
    assert_true(apart(256, one.state.p, two.state.p) > 1e-6);
    /* (2 pi/256)^2/6 = 1e-4 of the gap at the wave itself, more near the edges. */
    check_relative(one.state.mean_gap, two.state.mean_gap, 1e-3);
    scene_close(&one);
    scene_close(&two);
}

/* --- patches --- */

static void draw(const char *rows, size_t n, double *p) {
    assert_int_equal(strlen(rows), n);
    for (size_t i = 0; i < n; i++)
        p[i] = rows[i] == '#' ? 0.5 : 0;
}

static void patterns_of_patches(void **state) {
    (void)state;
    static const struct {
        const char *rows; /* 5 by 4 */
        size_t count, largest, sizes[4];
    } cases[] = {
        {"....."
         "....."
         "....."
         ".....",
         0,
         0,
         {0}},
        {"#####"
         "#####"
         "#####"
         "#####",
         1,
         20,
         {20}},
        {"#...#" /* joined across all sides */
         "....."
         "....."
         "#...#",
         1,
         4,
         {4}},
        {"#...." /* diagonal neighbours are apart, across the corner too */
         ".#..."
         "....."
         "....#",
         3,
         1,
         {1, 1, 1}},
        {".###." /* a U whose arms meet last */
         ".#.#."
         ".#.#."
         ".....",
         1,
         7,
         {7}},
        {"##..." /* in the order of their first node */
         "...#."
         ".#.#."
         "...#.",
         3,
         3,
         {2, 3, 1}},
    };
    struct grid grid = {5, 4, 1, 1};
    struct patch_finder *finder = NULL;
    struct error err = {0};
    assert_int_equal(patch_finder_create(&finder, &grid, &err), 0);
    for (size_t a = 0; a < sizeof cases / sizeof *cases; a++) {
        double p[20];
        size_t sizes[20] = {0}, nodes = 0;
        struct patches patches, again;
        draw(cases[a].rows, 20, p);
        patches_find(finder, p, &patches, sizes);
        double scratch[20];
        patch_finder_lend(finder, scratch);
        patches_find(finder, p, &again, NULL);
        assert_memory_equal(&again.count, &patches.count, sizeof patches.count);
        assert_int_equal(patches.count, cases[a].count);
        assert_int_equal(patches.largest, cases[a].largest);
        for (size_t b = 0; b < patches.count; b++) {
            assert_int_equal(sizes[b], cases[a].sizes[b]);
            nodes += sizes[b];
        }
        if (patches.count == 0) {
            assert_true(isnan(patches.mean));
            continue;
        }
        check_close(patches.mean, (double)nodes / (double)patches.count, 1e-14);
    }
    patch_finder_destroy(&finder);
    patch_finder_destroy(&finder);
}

static void patches_of_profiles(void **state) {
    (void)state;
    struct grid grid = line(8);
    struct patch_finder *finder = NULL;
    struct patches patches;
    struct error err = {0};
    double p[8];
    assert_int_equal(patch_finder_create(&finder, &grid, &err), 0);
    draw("#..##..#", 8, p);
    patches_find(finder, p, &patches, NULL);
    assert_true(patches.count == 2 && patches.largest == 2);
    draw("########", 8, p);
    patches_find(finder, p, &patches, NULL);
    assert_true(patches.count == 1 && patches.largest == 8 && patches.mean == 8);
    patch_finder_destroy(&finder);
}

/* --- areas of given patterns --- */

static struct contact_area area_of(struct grid grid, const double *p, const double *opening) {
    struct compliance *compliance = NULL;
    struct area_workspace *workspace = NULL;
    struct contact_area area;
    struct error err = {0};
    assert_int_equal(compliance_create(&compliance, &grid, &DEEP, &err), 0);
    assert_int_equal(area_workspace_create(&workspace, compliance, &err), 0);
    struct contact_state state = {.p = p, .gap = opening, .opening = opening};
    contact_area(workspace, &state, &area);
    area_workspace_destroy(&workspace);
    area_workspace_destroy(&workspace);
    compliance_destroy(&compliance);
    return area;
}

static void areas_of_patterns(void **state) {
    (void)state;
    struct grid grid = {5, 4, 1, 1};
    double p[20], opening[20];
    for (size_t i = 0; i < 20; i++)
        opening[i] = 0.1;
    draw("....................", 20, p);
    struct contact_area area = area_of(grid, p, opening);
    assert_true(area.nodes == 0 && area.lower == 0 && area.upper == 0 && area.edges == 0 &&
                area.perimeter == 0);
    draw("####################", 20, p);
    area = area_of(grid, p, opening);
    assert_true(area.nodes == 1 && area.lower == 1 && area.upper == 1 && area.edges == 1 &&
                area.perimeter == 1);
    p[7] = DBL_MIN; /* whose square is 0 */
    area = area_of(grid, p, opening);
    assert_true(area.nodes == 1 && area.lower == 1 && area.perimeter == 1);
    draw(".......#............", 20, p); /* one node: 4 cells round it, 4 sides */
    area = area_of(grid, p, opening);
    check_close(area.nodes, 1.0 / 20, 1e-15);
    check_close(area.upper, 4.0 / 20, 1e-15);
    assert_true(area.lower == 0 && area.edges > 0 && area.edges < area.upper);
    double lone = 20 * area.perimeter;
    draw("......##...##.......", 20, p); /* a square: 8 sides, one full cell, 9 touched */
    area = area_of(grid, p, opening);
    check_close(area.lower, 1.0 / 20, 1e-15);
    check_close(area.upper, 9.0 / 20, 1e-15);
    double square = 20 * area.perimeter;
    draw(".....#####..........", 20, p); /* a band: 10 sides, and no patch that ends */
    area = area_of(grid, p, opening);
    check_close(area.upper, 10.0 / 20, 1e-15);
    double overlap = (5 - 20 * area.perimeter) / 10; /* of a side; 0.10 was measured */
    assert_true(overlap > 0.05 && overlap < 0.15);
    check_close(square - 4 + 8 * overlap, lone - 1 + 4 * overlap, 1e-13); /* a patch's own */
}

static void areas_of_profiles(void **state) {
    (void)state;
    double p[8], opening[8] = {1, 1, 1, 1, 1, 1, 1, 1};
    draw("##....#.", 8, p);
    struct contact_area area = area_of(line(8), p, opening);
    assert_true(isnan(area.perimeter));
    check_close(area.nodes, 3.0 / 8, 1e-15);
    check_close(area.lower, 1.0 / 8, 1e-15);
    check_close(area.upper, 5.0 / 8, 1e-15);
    draw("........", 8, p);
    assert_true(area_of(line(8), p, opening).edges == 0);
    draw("########", 8, p);
    assert_true(area_of(line(8), p, opening).edges == 1);
}

/* Any pattern at all, with gaps from none to huge: fractions, and in order. */
static void areas_of_anything(void **state) {
    (void)state;
    static const struct grid grids[] = {{2, 1, 1, 1}, {3, 1, 1, 1}, {17, 1, 1, 1},
                                        {2, 2, 1, 1}, {3, 2, 1, 5}, {9, 7, 3, 1}};
    double p[63], opening[63];
    for (size_t a = 0; a < 6; a++) {
        struct scene scene;
        scene_open(&scene, grids[a], a % 2 ? LAYERED : DEEP, 1e-10);
        for (size_t b = 0; b < 100; b++) {
            for (size_t i = 0; i < scene_points(&scene); i++) {
                bool in = noise(997 * a + 97 * b + i) < noise(b);
                p[i] = in ? pow(10, 6 * noise(i + b) - 6) : 0;
                opening[i] = in || b % 5 == 0 ? 0 : pow(10, 12 * noise(7 * i + b) - 9);
            }
            struct contact_area area;
            struct contact_state given = {.p = p, .gap = opening, .opening = opening};
            contact_area(scene.areas, &given, &area);
            assert_true(0 <= area.lower && area.lower <= area.nodes && area.nodes <= area.upper &&
                        area.upper <= 1);
            assert_true(area.edges >= 0 && area.edges <= 1 + 1e-12);
            assert_true((area.edges > 0) == (area.nodes > 0));
        }
        scene_close(&scene);
    }
}

/* What areas are learnt from takes as many times the time and memory as one spacing is of the
 * other: a grid of few points would never be pressed, or not fit. */
static void areas_where_spacings_are_far_apart(void **state) {
    (void)state;
    static const struct {
        struct grid grid;
        int status;
    } CASES[] = {{{6, 4, 6, 40}, 0},
                 {{6, 4, 6, 4040}, ERROR_INPUT},
                 {{6, 4, 6e300, 4}, ERROR_INPUT},
                 {{6, 4, 6, 4e-300}, ERROR_INPUT},
                 {{6, 1, 6, 4e300}, 0}}; /* a profile */
    for (size_t c = 0; c < sizeof CASES / sizeof *CASES; c++) {
        struct compliance *compliance = NULL;
        struct area_workspace *workspace = NULL;
        struct error err = {0};
        if (CASES[c].status != 0) /* its padding would be as many rows */
            assert_int_equal(compliance_create_open(&compliance, &CASES[c].grid, &DEEP, &err),
                             CASES[c].status);
        assert_int_equal(compliance_create(&compliance, &CASES[c].grid, &DEEP, &err), 0);
        assert_int_equal(area_workspace_create(&workspace, compliance, &err), CASES[c].status);
        if (CASES[c].status != 0)
            assert_non_null(strstr(err.text, "apart: contact can be computed where"));
        area_workspace_destroy(&workspace);
        compliance_destroy(&compliance);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(pressures_refused),
        cmocka_unit_test(heights_refused),
        cmocka_unit_test(tolerances_refused),
        cmocka_unit_test(tangents_can_be_left_out),
        cmocka_unit_test(tangents_follow_the_tolerance),
        cmocka_unit_test(too_few_iterations),
        cmocka_unit_test(stops_are_heard),
        cmocka_unit_test(no_load),
        cmocka_unit_test(flat_surface),
        cmocka_unit_test(one_point),
        cmocka_unit_test(beyond_full_contact),
        cmocka_unit_test(any_path_of_loads),
        cmocka_unit_test(surfaces_leave_nothing),
        cmocka_unit_test(any_unit),
        cmocka_unit_test(what_does_not_enter),
        cmocka_unit_test(any_grid),
        cmocka_unit_test(shifted_grid),
        cmocka_unit_test(weightings_agree),
        cmocka_unit_test(patterns_of_patches),
        cmocka_unit_test(patches_of_profiles),
        cmocka_unit_test(areas_of_patterns),
        cmocka_unit_test(areas_of_profiles),
        cmocka_unit_test(areas_of_anything),
        cmocka_unit_test(areas_where_spacings_are_far_apart),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
