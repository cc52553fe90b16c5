/* Protects friction of profiles at finite strain: the stick radius of a cylinder in closed form,
 * the coupled half-plane where slopes are small, evenly loaded faces, rigid motions, energy, mirror
 * images, contact without friction as the limit, and what it refuses. Drawn scenes must end in an
 * answer that meets Coulomb's law, or in an error with its numbers. */
#include "tests/support/check.h"

#include "core/contact/slip/partial_slip.h"
#include "core/full/friction/friction.h"
#include "tests/support/contact_scene.h"
#include "tests/support/effort.h"
#include "tests/support/seed.h"
#include <stdio.h>
#include <string.h>

static const struct block BLOCK = {.model = MODEL_LAYERED,
                                   .poisson = 0.3,
                                   .height = 1,
                                   .layer_growth = 1.2,
                                   .weighting = GAP_DUAL};
enum { NODES_MOST = 512 };

struct dragged {
    struct grid grid;
    struct block block;
    struct full_options options;
    struct friction_options friction;
    struct friction *solver;
    struct friction_state state;
    double z[NODES_MOST];
};

/* A flat face; fill z and then begin. */
static struct dragged opened(size_t n, double poisson, double coefficient, size_t press_steps) {
    struct dragged d = {.grid = {.nx = n, .ny = 1, .lx = 1, .ly = 1},
                        .block = BLOCK,
                        .options = FULL_DEFAULTS,
                        .friction = {coefficient, press_steps}};
    d.block.poisson = poisson;
    return d;
}

static void begin(struct dragged *d) {
    struct error err = {0};
    if (friction_create(&d->solver, &d->grid, &d->block, &d->options, &d->friction, &err) != 0 ||
        friction_begin(d->solver, d->z, &err) != 0)
        fail_msg("%s", err.text);
}

/* Coulomb's law at each node, balance of forces, and nothing through the flat. `since`: slips of a
 * state before, from which there was one step, or NULL. */
static void check_law(const struct dragged *d, const double *since) {
    const struct friction_state *s = &d->state;
    size_t n = d->grid.nx, nodes = 0, stuck = 0;
    double most = largest(n, s->p), reach = 1e-7 * most, deep = 1e-7 * most / (double)n;
    for (size_t i = 0; i < n; i++) {
        double bound = d->friction.coefficient * s->p[i];
        bool touches = s->p[i] > 0;
        assert_true(isfinite(s->p[i]) && s->p[i] >= 0 && isfinite(s->gap[i]));
        assert_true(fabs(s->q[i]) <= bound + reach);
        nodes += touches;
        stuck += touches && fabs(s->q[i]) < bound - reach;
        if (d->block.weighting == GAP_DUAL)
            assert_true(touches ? fabs(s->gap[i]) <= deep : s->gap[i] >= -deep);
        if (since == NULL || !touches || !isfinite(since[i]))
            continue;
        double slip = s->slip[i] - since[i];
        if (fabs(s->q[i]) < bound - reach)
            check_close(slip, 0, deep);
        else
            assert_true(slip * s->q[i] <= deep * bound);
    }
    assert_int_equal(nodes, s->nodes);
    assert_true(stuck <= s->stuck && s->stuck <= nodes);
    check_relative(mean_of(n, s->p), s->pressure, 1e-7);
    check_close(mean_of(n, s->q), s->traction, 1e-7 * s->pressure);
}

static void press(struct dragged *d, double pressure) {
    struct error err = {0};
    if (friction_press(d->solver, pressure, &d->state, &err) != 0)
        fail_msg("%s", err.text);
    check_law(d, NULL);
}

/* One step, whose slips are checked. */
static void move(struct dragged *d,
                 int (*how)(struct friction *, double, struct friction_state *, struct error *),
                 double to) {
    struct error err = {0};
    double since[NODES_MOST];
    memcpy(since, d->state.slip, d->grid.nx * sizeof *since);
    if (how(d->solver, to, &d->state, &err) != 0)
        fail_msg("%s", err.text);
    check_law(d, d->state.steps == 1 ? since : NULL);
}

static void load(struct dragged *d, double traction) {
    move(d, friction_load, traction);
}

static void drag(struct dragged *d, double displacement) {
    move(d, friction_drag, displacement);
}

/* A cylinder of this radius, whose crest stands on a node. */
static void round_off(struct dragged *d, double radius) {
    for (size_t i = 0; i < d->grid.nx; i++) {
        double x = (double)i / (double)d->grid.nx - 0.5;
        d->z[i] = -x * x / (2 * radius);
    }
}

/* Waves of random phases, up to one of 8 nodes, of this RMS slope. */
static void roughen(struct dragged *d, double slope, uint64_t seed) {
    size_t n = d->grid.nx;
    double square = 0;
    memset(d->z, 0, n * sizeof *d->z);
    for (size_t m = 1; m <= n / 8; m++) {
        double phase = (double)(next_word(&seed) >> 11) * 0x1p-53;
        double height = pow((double)(m < 2 ? 2 : m), -1.3);
        square += height * height * (double)(m * m) * 2 * M_PI * M_PI;
        for (size_t i = 0; i < n; i++)
            d->z[i] += height * cos(2 * M_PI * ((double)(m * i) / (double)n + phase));
    }
    for (size_t i = 0; i < n; i++)
        d->z[i] *= slope / sqrt(square);
}

/* --- small strains --- */

/* Slopes of 0.0005: what finite slopes change is far below what is compared. */
static const double RADIUS = 1000;

static double hertz_pressure(double half_width) {
    return M_PI / 4 * half_width * half_width / RADIUS;
}

/* Returns the half-width of an elliptic distribution about the crest, over the cell, by its second
 * moment: that depends on no node at an edge. */
static double half_width(size_t n, const double *value) {
    double moment = 0, sum = 0;
    for (size_t i = 0; i < n; i++) {
        double x = (double)i / (double)n - 0.5;
        moment += x * x * value[i];
        sum += value[i];
    }
    return 2 * sqrt(moment / sum);
}

/* Returns how far the stick radius of a cylinder is from its closed form, over that; at 8 to 32
 * elements a radius of the contact. */
static double cattaneo_s_error(size_t n, double share) {
    struct dragged d = opened(n, 0.4999, 0.3, 0);
    double radius = 1.0 / 16, pressure = hertz_pressure(radius), excess[NODES_MOST];
    double closed = sqrt(1 - share) * radius, dx = 1 / (double)n;
    d.options.kinematics = KINEMATICS_SMALL;
    round_off(&d, RADIUS);
    begin(&d);
    press(&d, pressure);
    double gap = d.state.mean_gap;
    load(&d, share * 0.3 * pressure);
    for (size_t i = 0; i < n; i++)
        excess[i] = 0.3 * d.state.p[i] - d.state.q[i];
    double sticks = half_width(n, excess), sliding = d.state.sliding;
    double edge = (double)d.state.stuck * dx / 2;
    press(&d, (1 - share) * pressure);
    double rises = 0.3 * (d.state.mean_gap - gap);
    printf("[   INFO   ] %zu nodes, Q = %.2f mu P: stick radius %.4f, by its nodes %.4f (%.4f), "
           "sliding %.5g (%.5g)\n",
           n, share, sticks / radius, edge / radius, sqrt(1 - share), sliding, rises);
    check_relative(sliding, rises, 0.005);
    check_close(edge, closed, dx);
    friction_destroy(&d.solver);
    return fabs(sticks / closed - 1);
}

/* (1 - Q/(mu P))^(1/2) (Cattaneo 1938), with 8, 16 and 32 elements a radius of the contact.
 * Pressures and tractions are uncoupled at nu = 1/2 alone, which 0.4999 comes close enough to;
 * images of the contact, an eighth of the cell, leave 0.1 %. Nodes show the edge to one of them.
 * The displacement is mu times the difference of the approaches of the same block. */
static void cattaneo_s_stick_radius(void **state) {
    (void)state;
    double coarse = cattaneo_s_error(128, 0.45), fine = cattaneo_s_error(512, 0.45);
    assert_true(fine <= 0.01);
    assert_true(fine <= coarse / 4 + 1e-3);
    assert_true(cattaneo_s_error(256, 0.8) <= 0.03); /* 7 elements stick */
}

/* Against pressures and tractions of the half-plane, coupled: another discretisation and another
 * solver. A node at an edge may differ. */
static void coupled_half_plane(void **state) {
    (void)state;
    static const struct {
        double poisson;
        size_t steps;
    } CASES[] = {{0.3, 0}, {0.3, 4}, {0, 0}, {0, 4}};
    for (size_t c = 0; c < sizeof CASES / sizeof *CASES; c++) {
        enum { N = 256 };
        struct dragged d = opened(N, CASES[c].poisson, 0.3, CASES[c].steps);
        struct slip_options options = SLIP_DEFAULTS;
        struct slip *slip = NULL;
        struct slip_state linear;
        struct error err = {0};
        double pressure = hertz_pressure(1.0 / 8), traction = 0.45 * 0.3 * pressure;
        options.poisson = CASES[c].poisson;
        options.friction = 0.3;
        options.press_steps = CASES[c].steps;
        round_off(&d, RADIUS);
        begin(&d);
        press(&d, pressure);
        load(&d, traction);
        if (slip_create(&slip, &d.grid, &options, &err) != 0)
            fail_msg("%s", err.text);
        if (slip_press(slip, d.z, pressure, &linear, &err) != 0)
            fail_msg("%s", err.text);
        if (slip_load(slip, traction, &linear, &err) != 0)
            fail_msg("%s", err.text);
        double apart = 0, all = 0;
        for (size_t i = 0; i < N; i++) {
            apart += pow(d.state.q[i] - linear.qx[i], 2);
            all += pow(linear.qx[i], 2);
        }
        printf("[   INFO   ] nu = %.1f, pressed in %zu steps: sticks %.4f (%.4f), sliding %.5g "
               "(%.5g), tractions apart %.2g\n",
               CASES[c].poisson, CASES[c].steps, d.state.stick_area, linear.stick_area,
               d.state.sliding, linear.displacement, sqrt(apart / all));
        check_close(d.state.stick_area, linear.stick_area, 1.01 / (double)linear.nodes);
        check_relative(d.state.sliding, linear.displacement, 0.01);
        assert_true(sqrt(apart / all) <= 0.03);
        slip_destroy(&slip);
        friction_destroy(&d.solver);
    }
}

/* A cycle of tractions dissipates what it does on the half-plane. */
static void cycle_of_the_half_plane(void **state) {
    (void)state;
    struct dragged d = opened(256, 0.4999, 0.3, 0);
    struct slip_options options = SLIP_DEFAULTS;
    struct slip *slip = NULL;
    struct slip_state linear;
    struct error err = {0};
    double pressure = hertz_pressure(1.0 / 8), most = 0.6 * 0.3 * pressure, first = 0, before = 0,
           taken = 0;
    options.poisson = 0.5;
    options.friction = 0.3;
    round_off(&d, RADIUS);
    begin(&d);
    press(&d, pressure);
    if (slip_create(&slip, &d.grid, &options, &err) != 0)
        fail_msg("%s", err.text);
    if (slip_press(slip, d.z, pressure, &linear, &err) != 0)
        fail_msg("%s", err.text);
    for (int step = 1; step <= 10; step++) {
        double traction = most * (step <= 2   ? step / 2.0
                                  : step <= 6 ? (4 - step) / 2.0
                                              : (step - 8) / 2.0);
        load(&d, traction);
        if (slip_load(slip, traction, &linear, &err) != 0)
            fail_msg("%s", err.text);
        if (step == 2) {
            first = d.state.dissipation;
            before = linear.work;
            taken = linear.dissipation;
        }
    }
    printf("[   INFO   ] a cycle dissipates %.5g (%.5g)\n", d.state.dissipation - first,
           linear.work - before);
    check_relative(d.state.dissipation - first, linear.work - before, 0.01);
    check_relative(linear.dissipation - taken, linear.work - before, 1e-5);
    slip_destroy(&slip);
    friction_destroy(&d.solver);
}

/* --- finite strains --- */

/* An even face is pressed, sheared and dragged evenly: the same pressure and traction at all nodes,
 * no sliding while it sticks, and then friction times the pressure. */
static void flat_face(void **state) {
    (void)state;
    static const double POISSON[] = {0, 0.3, 0.4999};
    for (size_t a = 0; a < 6; a++) {
        struct dragged d = opened(32, POISSON[a / 2], 0.5, 0);
        d.options.kinematics = a % 2 == 0 ? KINEMATICS_SMALL : KINEMATICS_HENCKY;
        begin(&d);
        press(&d, 0.05);
        for (int step = 0; step < 3; step++) {
            if (step < 2)
                load(&d, step == 0 ? 0.02 : -0.01);
            else
                drag(&d, 3);
            double traction = step == 0 ? 0.02 : step == 1 ? -0.01 : 0.025;
            for (size_t i = 0; i < 32; i++) {
                check_relative(d.state.p[i], 0.05, 1e-8);
                check_close(d.state.q[i], traction, 1e-9);
            }
            assert_int_equal(d.state.stuck, step < 2 ? 32 : 0);
            if (step < 2)
                check_close(d.state.sliding, 0, 1e-9);
        }
        friction_destroy(&d.solver);
    }
}

/* Once all nodes slide, the flat's motion changes nothing in the block, however far it goes, and
 * all its work is dissipated. */
static void steady_sliding(void **state) {
    (void)state;
    struct dragged d = opened(64, 0.3, 0.3, 0);
    double p[64], q[64];
    roughen(&d, 0.3, 3);
    begin(&d);
    press(&d, 0.03);
    for (int step = 1; step <= 4; step++)
        drag(&d, 0.05 * step);
    assert_int_equal(d.state.stuck, 0);
    memcpy(p, d.state.p, sizeof p);
    memcpy(q, d.state.q, sizeof q);
    struct friction_state before = d.state;
    drag(&d, 50);
    for (size_t i = 0; i < 64; i++) {
        check_close(d.state.p[i], p[i], 1e-7 * largest(64, p));
        check_close(d.state.q[i], q[i], 1e-7 * largest(64, p));
    }
    double distance = d.state.displacement - before.displacement;
    check_relative(d.state.traction, 0.3 * 0.03, 1e-8);
    check_relative(d.state.work - before.work, 0.3 * 0.03 * distance, 1e-7);
    check_relative(d.state.dissipation - before.dissipation, 0.3 * 0.03 * distance, 1e-7);
    check_close(d.state.energy, before.energy, 1e-9 * fabs(before.energy));
    friction_destroy(&d.solver);
}

/* Returns how far works and energy are from balance, over the dissipation, after so many steps. */
static double imbalance(double slope, double poisson, int steps, size_t press_steps) {
    struct dragged d = opened(128, poisson, 0.3, press_steps);
    roughen(&d, slope, 8);
    begin(&d);
    press(&d, 0.1 * slope);
    for (int step = 1; step <= steps; step++)
        drag(&d, slope / 15 * step / steps);
    const struct friction_state *s = &d.state;
    double left = s->work + s->pressing_work - s->dissipation - s->energy;
    printf(
        "[   INFO   ] slope %.1f, nu %g, %d steps: work %.5g, dissipation %.5g, balance %.2g and "
        "%.2g of them; %.2f sticks\n",
        slope, poisson, steps, s->work, s->dissipation, left / s->work, left / s->dissipation,
        s->stick_area);
    if (steps >= 20)
        assert_true(fabs(left) <= 1e-5 * s->work);
    assert_true(s->dissipation > 0 && s->stick_area > 0 && s->stick_area < 1);
    friction_destroy(&d.solver);
    return fabs(left / s->dissipation);
}

/* The works of both loads are what friction takes and the block keeps: nothing else gives or takes
 * energy, with tractions and pressures changing at once at finite strain. Trapezoids leave an error
 * of second order in the step: of four times as many steps a sixteenth, where one of first order
 * would leave a quarter. */
static void energy(void **state) {
    (void)state;
    static const struct { double slope, poisson; } FACES[] = {{0.3, 0.3}, {0.5, 0.4999}};
    for (size_t a = 0; a < sizeof FACES / sizeof *FACES; a++) {
        double few = imbalance(FACES[a].slope, FACES[a].poisson, 5, 0);
        double many = imbalance(FACES[a].slope, FACES[a].poisson, 20, 0);
        assert_true(many <= 1e-4);
        assert_true(many <= few / 8);
    }
    assert_true(imbalance(0.3, 0.3, 20, 3) <= 1e-4);
}

/* A mirrored face, dragged backward, has the mirrored solution. */
static void mirror_image(void **state) {
    (void)state;
    struct dragged one = opened(64, 0.2, 0.4, 3), other = one;
    roughen(&one, 0.3, 5);
    for (size_t i = 0; i < 64; i++)
        other.z[i] = one.z[(64 - i) % 64];
    begin(&one);
    begin(&other);
    press(&one, 0.03);
    press(&other, 0.03);
    for (int step = 1; step <= 3; step++) {
        drag(&one, 0.01 * step);
        drag(&other, -0.01 * step);
    }
    check_close(one.state.traction, -other.state.traction, 1e-9);
    check_relative(one.state.work, other.state.work, 1e-6);
    for (size_t i = 0; i < 64; i++) {
        check_close(one.state.p[i], other.state.p[(64 - i) % 64], 1e-7);
        check_close(one.state.q[i], -other.state.q[(64 - i) % 64], 1e-7);
    }
    friction_destroy(&one.solver);
    friction_destroy(&other.solver);
}

/* Pressed without friction, pressures are those of full_press to the rounding of a force; with a
 * vanishing coefficient they tend to them. */
static void without_friction(void **state) {
    (void)state;
    struct dragged d = opened(64, 0.3, 0.5, 0), little = opened(64, 0.3, 1e-6, 2);
    struct full *full = NULL;
    struct contact_state without;
    struct error err = {0};
    roughen(&d, 0.3, 7);
    memcpy(little.z, d.z, sizeof d.z);
    begin(&d);
    begin(&little);
    press(&d, 0.04);
    press(&little, 0.04);
    if (full_create(&full, &d.grid, &d.block, &d.options, &err) != 0 ||
        full_begin(full, d.z, &err) != 0)
        fail_msg("%s", err.text);
    if (full_press(full, 0.04, &without, NULL, &err) != 0)
        fail_msg("%s", err.text);
    for (size_t i = 0; i < 64; i++) {
        check_close(d.state.p[i], without.p[i], 1e-12);
        check_close(d.state.q[i], 0, 1e-9);
        check_close(little.state.p[i], without.p[i], 1e-4);
    }
    check_relative(d.state.mean_gap, without.mean_gap, 1e-12);
    full_destroy(&full);
    friction_destroy(&d.solver);
    friction_destroy(&little.solver);
}

/* Measures over the face as it stands change nothing of the solution. Before the drag they are
 * those of contact without friction. The face has about half the slope squared more area, where it
 * is open; a node there has a gap along its normal that is as much larger. */
static void face_as_it_stands(void **state) {
    (void)state;
    struct dragged d = opened(64, 0.3, 0.5, 0), plain = opened(64, 0.3, 0.5, 0);
    struct full *full = NULL;
    struct contact_state without = {.nodes = 0};
    struct full_report report = {.stretch = NAN};
    struct error err = {0};
    roughen(&d, 0.3, 7);
    memcpy(plain.z, d.z, sizeof d.z);
    d.options.current_areas = d.options.normal_gaps = true;
    begin(&d);
    begin(&plain);
    press(&d, 0.04);
    press(&plain, 0.04);
    if (full_create(&full, &d.grid, &d.block, &d.options, &err) != 0 ||
        full_begin(full, d.z, &err) != 0 || full_press(full, 0.04, &without, &report, &err) != 0)
        fail_msg("%s", err.text);
    double share = (double)without.nodes / 64;
    double area = share * report.stretch * (1 + report.contact_tilt) / (1 + report.face_tilt);
    check_relative(d.state.face.area, area, 1e-9);
    check_relative(d.state.face_without.area, area, 1e-9);
    check_relative(d.state.face.tilt, report.face_tilt, 1e-9);
    check_relative(d.state.face.open_stretch, report.open_stretch, 1e-9);
    check_relative(d.state.mean_gap, without.mean_gap, 1e-9);
    check_relative(plain.state.face.area, share, 1e-12);
    assert_true(d.state.face.area < share / (1 + 0.2 * 0.3 * 0.3));
    assert_true(d.state.mean_gap > plain.state.mean_gap);
    for (int step = 1; step <= 4; step++) {
        drag(&d, 0.01 * step);
        drag(&plain, 0.01 * step);
    }
    assert_true(d.state.stuck > 0 && d.state.stuck < d.state.nodes);
    assert_true(d.state.traction == plain.state.traction);
    check_close(d.state.stick_area, plain.state.stick_area, 0.05);
    assert_true(d.state.stick_area != plain.state.stick_area);
    for (size_t i = 0; i < 64; i++) {
        assert_true(d.state.q[i] == plain.state.q[i]);
        assert_true(d.state.p[i] > 0 || d.state.gap[i] >= plain.state.gap[i]);
    }
    full_destroy(&full);
    friction_destroy(&d.solver);
    friction_destroy(&plain.solver);
}

/* --- drawn scenes --- */

static double drawn(uint64_t *seed) {
    return (double)(next_word(seed) >> 11) * 0x1p-53;
}

/* Returns 0, or the status of the step that failed, whose message must hold numbers. */
static int draw_scene(uint64_t *seed) {
    double coefficient = drawn(seed) < 0.1 ? 1 : 0.001 + 0.999 * drawn(seed);
    double poisson = drawn(seed) < 0.2 ? 0.4999 : 0.4999 * drawn(seed), slope = drawn(seed);
    size_t steps = drawn(seed) < 0.5 ? 0 : (size_t)(1 + 4 * drawn(seed));
    struct dragged d = opened(48, poisson, coefficient, steps);
    struct error err = {0};
    double pressure = slope * 0.005 * pow(100, drawn(seed));
    double most = coefficient * (slope / 200 + 0.4 * pressure / (1 - poisson));
    d.options.kinematics = drawn(seed) < 0.2 ? KINEMATICS_SMALL : KINEMATICS_HENCKY;
    d.block.weighting = drawn(seed) < 0.2 ? GAP_STANDARD : GAP_DUAL;
    d.options.least_step = 1.0 / 16;
    roughen(&d, slope, next_word(seed));
    begin(&d);
    int status = friction_press(d.solver, pressure, &d.state, &err);
    for (int step = 1; status == 0 && step <= 6; step++) {
        check_law(&d, NULL);
        status = friction_drag(d.solver, most * (step <= 4 ? step : 8 - step), &d.state, &err);
    }
    if (status != 0) {
        assert_int_equal(status, ERROR_NUMERIC);
        assert_true(strlen(err.text) > 20 && strpbrk(err.text, "0123456789") != NULL);
        printf("[   INFO   ] friction %.2f, nu %.4f, slope %.2f: %s\n", coefficient, poisson, slope,
               err.text);
    }
    friction_destroy(&d.solver);
    return status;
}

/* Folding faces need contact with themselves, and with friction near 1 some increments have no
 * solution: such scenes end with an error. Of slopes to 1 and coefficients to 1 a quarter may. */
static void drawn_scenes(void **state) {
    (void)state;
    uint64_t seed = seed_or(20261128), count = 12 * effort(), failed = 0;
    for (uint64_t scene = 0; scene < count; scene++)
        failed += draw_scene(&seed) != 0;
    printf("[   INFO   ] %d of %d scenes failed\n", (int)failed, (int)count);
    assert_true(4 * failed <= count);
}

/* --- refusals --- */

static int stop_at_once(void *context) {
    (void)context;
    return 1;
}

static void refusals(void **state) {
    (void)state;
    struct dragged d = opened(32, 0.3, 0, 0);
    struct error err = {0};
    assert_int_equal(friction_create(&d.solver, &d.grid, &d.block, &d.options, &d.friction, &err),
                     ERROR_INPUT);
    assert_string_equal(err.text, "friction = 0; allowed: above 0, finite");
    assert_null(d.solver);
    d.friction.coefficient = 0.25;
    round_off(&d, 10);
    begin(&d);
    assert_int_equal(friction_drag(d.solver, 0.1, &d.state, &err), ERROR_STATE);
    assert_int_equal(friction_press(d.solver, 0, &d.state, &err), ERROR_INPUT);
    press(&d, 0.001);
    assert_int_equal(friction_drag(d.solver, NAN, &d.state, &err), ERROR_INPUT);
    assert_int_equal(friction_load(d.solver, -0.00025, &d.state, &err), ERROR_INPUT);
    assert_string_equal(err.text, "mean traction = -0.00025 E*; allowed: between -0.00025 and "
                                  "0.00025, friction times the mean pressure");
    friction_set_stop(d.solver, stop_at_once, NULL);
    assert_int_equal(friction_load(d.solver, 0.0001, &d.state, &err), ERROR_STOPPED);
    /* The state before is left. */
    friction_set_stop(d.solver, NULL, NULL);
    load(&d, 0.0001);
    friction_destroy(&d.solver);
    friction_destroy(&d.solver);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(cattaneo_s_stick_radius),
                                       cmocka_unit_test(coupled_half_plane),
                                       cmocka_unit_test(cycle_of_the_half_plane),
                                       cmocka_unit_test(flat_face),
                                       cmocka_unit_test(steady_sliding),
                                       cmocka_unit_test(energy),
                                       cmocka_unit_test(mirror_image),
                                       cmocka_unit_test(face_as_it_stands),
                                       cmocka_unit_test(without_friction),
                                       cmocka_unit_test(drawn_scenes),
                                       cmocka_unit_test(refusals)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
