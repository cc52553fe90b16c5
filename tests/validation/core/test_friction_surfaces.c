/* Protects friction of surfaces at finite strain: faces that are the same along one side are
 * profiles, the coupled half-space where slopes are small, a sphere, evenly loaded faces, rigid
 * motions, energy, mirror images, contact without friction, and Coulomb's law with its direction at
 * each node. Drawn scenes must end in an answer that meets it, or in an error with its numbers. */
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
enum { FINE = 96, NODES_MOST = FINE * FINE };

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
static struct dragged *opened(size_t nx, size_t ny, double poisson, double coefficient,
                              size_t press_steps) {
    struct dragged *d = array_create(1, sizeof *d);
    if (d == NULL)
        abort();
    *d = (struct dragged){
        .grid = {.nx = nx, .ny = ny, .lx = 1, .ly = ny > 1 ? (double)ny / (double)nx : 1},
        .block = BLOCK,
        .options = FULL_DEFAULTS,
        .friction = {coefficient, press_steps}};
    d->block.poisson = poisson;
    return d;
}

static void closed(struct dragged *d) {
    friction_destroy(&d->solver);
    free(d);
}

static size_t count(const struct dragged *d) {
    return grid_points(&d->grid);
}

static void begin(struct dragged *d) {
    struct error err = {0};
    if (friction_create(&d->solver, &d->grid, &d->block, &d->options, &d->friction, &err) != 0 ||
        friction_begin(d->solver, d->z, &err) != 0)
        fail_msg("%s", err.text);
}

/* Slips of a state, by which those of one step to the next are known. */
struct slips {
    double along[NODES_MOST], across[NODES_MOST];
};

/* Coulomb's law at a node that slipped by this since one step before: a traction at its bound, and
 * against the slip. */
static void check_node(const struct dragged *d, size_t i, const struct slips *since, double reach,
                       double deep) {
    const struct friction_state *s = &d->state;
    double x = s->slip[i] - since->along[i], y = s->slip_across[i] - since->across[i];
    double bound = d->friction.coefficient * s->p[i], q = hypot(s->q[i], s->q_across[i]);
    double slipped = hypot(x, y);
    if (q < bound - reach)
        check_close(slipped, 0, deep);
    else
        check_close(x * s->q[i] + y * s->q_across[i], -slipped * q, deep * bound + reach * slipped);
}

/* Coulomb's law at each node, balance of forces, and nothing through the flat. `since`: slips of a
 * state before, from which there was one step, or NULL. */
static void check_law(const struct dragged *d, const struct slips *since) {
    const struct friction_state *s = &d->state;
    size_t n = count(d), nodes = 0, stuck = 0;
    double most = largest(n, s->p), reach = 1e-7 * most, deep = 1e-7 * most / (double)d->grid.nx;
    for (size_t i = 0; i < n; i++) {
        double bound = d->friction.coefficient * s->p[i], q = hypot(s->q[i], s->q_across[i]);
        bool touches = s->p[i] > 0;
        assert_true(isfinite(s->p[i]) && s->p[i] >= 0 && isfinite(s->gap[i]));
        assert_true(q <= bound + reach);
        nodes += touches;
        stuck += touches && q < bound - reach;
        if (d->block.weighting == GAP_DUAL)
            assert_true(touches ? fabs(s->gap[i]) <= deep : s->gap[i] >= -deep);
        if (since != NULL && touches && isfinite(since->along[i]))
            check_node(d, i, since, reach, deep);
    }
    assert_int_equal(nodes, s->nodes);
    assert_true(stuck <= s->stuck && s->stuck <= nodes);
    check_relative(mean_of(n, s->p), s->pressure, 1e-7);
    check_close(mean_of(n, s->q), s->traction, 1e-7 * s->pressure);
    check_close(mean_of(n, s->q_across), 0, 1e-7 * s->pressure);
}

static void press(struct dragged *d, double pressure) {
    struct error err = {0};
    if (friction_press(d->solver, pressure, &d->state, &err) != 0)
        fail_msg("%s", err.text);
    if (d->grid.ny > 1)
        check_law(d, NULL);
}

/* One step, whose slips are checked. */
static void move(struct dragged *d,
                 int (*how)(struct friction *, double, struct friction_state *, struct error *),
                 double to) {
    static struct slips since;
    struct error err = {0};
    memcpy(since.along, d->state.slip, count(d) * sizeof *since.along);
    if (d->grid.ny > 1)
        memcpy(since.across, d->state.slip_across, count(d) * sizeof *since.across);
    if (how(d->solver, to, &d->state, &err) != 0)
        fail_msg("%s", err.text);
    if (d->grid.ny > 1)
        check_law(d, d->state.steps == 1 ? &since : NULL);
}

static void load(struct dragged *d, double traction) {
    move(d, friction_load, traction);
}

static void drag(struct dragged *d, double displacement) {
    move(d, friction_drag, displacement);
}

static double drawn(uint64_t *seed) {
    return (double)(next_word(seed) >> 11) * 0x1p-53;
}

/* Where a node is, over the sides of the cell. */
struct at {
    double x, y;
};
static struct at at_of(const struct grid *grid, size_t node) {
    const size_t column = node % grid->nx, row = node / grid->nx;
    return (struct at){(double)column / (double)grid->nx, (double)row / (double)grid->ny};
}

/* Waves of random phases, down to one of so many nodes, of this RMS slope; ridges are the same
 * along y. */
static void roughen(struct dragged *d, bool ridges, double nodes, double slope, uint64_t seed) {
    const size_t nx = d->grid.nx;
    const double most = (double)nx / nodes;
    double square = 0;
    memset(d->z, 0, sizeof d->z);
    for (double m = 0; m <= most; m++)
        for (double row = ridges ? 0 : m > 0 ? -most : 1; row <= (ridges ? 0 : most); row++) {
            double k = hypot(m, row / d->grid.ly), height = pow(fmax(k, 2), -1.8);
            double phase = drawn(&seed);
            if (k > most || k == 0)
                continue;
            square += height * height * k * k * 2 * M_PI * M_PI;
            for (size_t i = 0; i < count(d); i++) {
                struct at at = at_of(&d->grid, i);
                d->z[i] += height * cos(2 * M_PI * (m * at.x + row * at.y + phase));
            }
        }
    for (size_t i = 0; i < count(d); i++)
        d->z[i] *= slope / sqrt(square);
}

/* --- profiles and half-spaces --- */

/* A face that is the same along y has the pressures, tractions and works of its profile, which
 * another solver of other linear equations computes, and nothing happens across. */
static void ridges_are_profiles(void **state) {
    (void)state;
    static const struct {
        double poisson;
        enum gap_weighting weighting;
        size_t steps;
    } CASES[] = {{0.3, GAP_DUAL, 0}, {0, GAP_STANDARD, 2}, {0.4999, GAP_DUAL, 0}};
    for (size_t c = 0; c < sizeof CASES / sizeof *CASES; c++) {
        enum { NX = 32, NY = 4 };
        struct dragged *profile = opened(NX, 1, CASES[c].poisson, 0.4, CASES[c].steps);
        struct dragged *ridges = opened(NX, NY, CASES[c].poisson, 0.4, CASES[c].steps);
        struct dragged *const both[] = {profile, ridges};
        double apart = 0;
        for (size_t a = 0; a < 2; a++) {
            both[a]->options.transition = INFINITY;
            both[a]->block.weighting = CASES[c].weighting;
            roughen(both[a], true, 8, 0.2, 11);
            begin(both[a]);
            press(both[a], 0.02);
            for (int step = 1; step <= 4; step++)
                drag(both[a], 0.008 * (step <= 3 ? step : 1));
        }
        const struct friction_state *one = &profile->state, *other = &ridges->state;
        for (size_t i = 0; i < NX * NY; i++) {
            apart = fmax(apart, fabs(one->p[i % NX] - other->p[i]));
            apart = fmax(apart, fabs(one->q[i % NX] - other->q[i]));
            apart = fmax(apart, fabs(other->q_across[i]));
        }
        printf("[   INFO   ] nu = %.4f, pressed in %zu steps: apart %.2g of the pressure; %.2f "
               "sticks, Q/P %.4f\n",
               CASES[c].poisson, CASES[c].steps, apart / one->pressure, one->stick_area,
               one->traction / one->pressure);
        assert_true(apart <= 1e-6 * one->pressure);
        assert_true(one->stick_area > 0 && one->stick_area < 1);
        check_close(other->stick_area, one->stick_area, 1e-12);
        check_relative(other->sliding, one->sliding, 1e-6);
        check_relative(other->work, one->work, 1e-6);
        check_relative(other->dissipation, one->dissipation, 1e-5);
        check_relative(other->energy, one->energy, 1e-5);
        closed(profile);
        closed(ridges);
    }
}

static struct slip *half_space(const struct dragged *d, double pressure, struct slip_state *out) {
    struct slip_options options = SLIP_DEFAULTS;
    struct slip *slip = NULL;
    struct error err = {0};
    options.poisson = d->block.poisson;
    options.friction = d->friction.coefficient;
    options.press_steps = d->friction.press_steps;
    options.tolerance = 1e-5;
    if (slip_create(&slip, &d->grid, &options, &err) != 0 ||
        slip_press(slip, d->z, pressure, out, &err) != 0)
        fail_msg("%s", err.text);
    return slip;
}

static void load_half_space(struct slip *slip, double traction, struct slip_state *out) {
    struct error err = {0};
    if (slip_load(slip, traction, out, &err) != 0)
        fail_msg("%s", err.text);
}

/* Rough faces of small slopes slide as far as those of the half-space, pressures and tractions
 * coupled, and as much of them sticks: another discretisation and another solver. With 16 nodes a
 * shortest wave the sliding is 1 % off, and 3 % with finite strains of a slope of 0.05. */
static void coupled_half_space(void **state) {
    (void)state;
    static const double SLOPES[] = {0.005, 0.05};
    for (size_t c = 0; c < 2; c++) {
        struct dragged *d = opened(32, 32, 0.3, 0.3, 0);
        struct slip_state linear;
        double pressure = 0.1 * SLOPES[c];
        roughen(d, false, 16, SLOPES[c], 5);
        begin(d);
        press(d, pressure);
        struct slip *slip = half_space(d, pressure, &linear);
        for (int step = 1; step <= 2; step++) {
            double traction = step * 0.45 * 0.3 * pressure;
            load(d, traction);
            load_half_space(slip, traction, &linear);
            printf("[   INFO   ] slope %.3f, Q = %.2f mu P: sticks %.3f (%.3f), sliding %.4g "
                   "(%.4g)\n",
                   SLOPES[c], step * 0.45, d->state.stick_area, linear.stick_area, d->state.sliding,
                   linear.displacement);
            check_close(d->state.stick_area, linear.stick_area, 0.05);
            check_close(d->state.stick_load, linear.stick_load, 0.05);
            check_relative(d->state.sliding, linear.displacement, 0.04);
        }
        slip_destroy(&slip);
        closed(d);
    }
}

/* Returns the radius of what sticks of a sphere in the middle of the cell: excesses of friction
 * over tractions are about (c^2 - r^2)^(1/2), whose second moment is 2 c^2/5. */
static double stick_radius(const struct grid *grid, double friction, const double *p,
                           const double *q, const double *across) {
    double moment = 0, sum = 0;
    for (size_t i = 0; i < grid_points(grid); i++) {
        double x = at_of(grid, i).x - 0.5, y = at_of(grid, i).y - 0.5;
        double excess = friction * p[i] - hypot(q[i], across[i]);
        moment += (x * x + y * y) * excess;
        sum += excess;
    }
    return sqrt(2.5 * moment / sum);
}

static const double SPHERE = 1000, CONTACT = 0.25; /* radii of a sphere and of its contact */
static double sphere_pressure(void) {
    return 4.0 / 3 * pow(CONTACT, 3) / SPHERE;
}

static void round_off(struct dragged *d) {
    for (size_t i = 0; i < count(d); i++) {
        double x = at_of(&d->grid, i).x - 0.5, y = at_of(&d->grid, i).y - 0.5;
        d->z[i] = -(x * x + y * y) / (2 * SPHERE);
    }
}

/* What a sphere at Q = 0.45 mu P has. */
struct sphere {
    double stick_radius, sliding; /* over the contact's radius, and the pressure */
};

static struct sphere sphere_of_half_space(double poisson) {
    struct dragged *d = opened(FINE, FINE, poisson, 0.3, 0);
    struct slip_state linear;
    double pressure = sphere_pressure();
    round_off(d);
    struct slip *slip = half_space(d, pressure, &linear);
    for (int step = 1; step <= 2; step++)
        load_half_space(slip, 0.225 * step * 0.3 * pressure, &linear);
    struct sphere out = {stick_radius(&d->grid, 0.3, linear.p, linear.qx, linear.qy) / CONTACT,
                         linear.displacement / pressure};
    slip_destroy(&slip);
    closed(d);
    return out;
}

/* Returns how far the stick radius and the sliding are from those, as parts. */
static struct sphere sphere_s_error(size_t n, double poisson, const struct sphere *expected) {
    struct dragged *d = opened(n, n, poisson, 0.3, 0);
    double pressure = sphere_pressure();
    round_off(d);
    d->options.kinematics = KINEMATICS_SMALL;
    begin(d);
    press(d, pressure);
    for (int step = 1; step <= 2; step++)
        load(d, 0.225 * step * 0.3 * pressure);
    const struct friction_state *s = &d->state;
    struct sphere here = {stick_radius(&d->grid, 0.3, s->p, s->q, s->q_across) / CONTACT,
                          s->sliding / pressure};
    printf("[   INFO   ] %.0f elements a radius, nu = %.1f: stick radius %.5f (%.5f), sliding %.5f "
           "(%.5f)\n",
           CONTACT * (double)n, poisson, here.stick_radius, expected->stick_radius, here.sliding,
           expected->sliding);
    closed(d);
    return (struct sphere){fabs(here.stick_radius / expected->stick_radius - 1),
                           fabs(here.sliding / expected->sliding - 1)};
}

/* A sphere against the half-space with 24 nodes a radius of the contact, which has 3e-4 of its
 * limit at most. There is no closed form, since a rigid flat couples pressures and tractions.
 * Errors are of second order in the mesh. */
static void sphere(void **state) {
    (void)state;
    struct sphere expected = sphere_of_half_space(0);
    struct sphere coarse = sphere_s_error(32, 0, &expected);
    struct sphere fine = sphere_s_error(48, 0, &expected);
    assert_true(coarse.stick_radius <= 0.005 && coarse.sliding <= 0.012);
    assert_true(fine.stick_radius <= coarse.stick_radius / 1.5);
    assert_true(fine.sliding <= coarse.sliding / 1.5);
}

/* --- finite strains --- */

/* An even face is pressed, sheared and dragged evenly: the same pressure and traction at all nodes,
 * no sliding while it sticks, and then friction times the pressure, however far it slides. */
static void flat_face(void **state) {
    (void)state;
    static const double POISSON[] = {0, 0.3, 0.4999};
    for (size_t a = 0; a < 6; a++) {
        struct dragged *d = opened(12, 8, POISSON[a / 2], 0.5, 0);
        d->grid.ly = 1; /* columns that are no squares */
        d->options.kinematics = a % 2 == 0 ? KINEMATICS_SMALL : KINEMATICS_HENCKY;
        begin(d);
        press(d, 0.05);
        for (int step = 0; step < 4; step++) {
            if (step < 2)
                load(d, step == 0 ? 0.02 : -0.01);
            else
                drag(d, step == 2 ? 3 : 50);
            double traction = step == 0 ? 0.02 : step == 1 ? -0.01 : 0.025;
            for (size_t i = 0; i < count(d); i++) {
                check_relative(d->state.p[i], 0.05, 1e-8);
                check_close(d->state.q[i], traction, 1e-9);
                check_close(d->state.q_across[i], 0, 1e-9);
            }
            assert_int_equal(d->state.stuck, step < 2 ? count(d) : 0);
            if (step < 2)
                check_close(d->state.sliding, 0, 1e-9);
        }
        closed(d);
    }
}

/* Directions of sliding nodes turn towards that of the flat, by what they slid over. After that the
 * flat's motion changes nothing in the block, and all its work is dissipated. */
static void steady_sliding(void **state) {
    (void)state;
    static double p[NODES_MOST];
    struct dragged *d = opened(16, 16, 0.3, 0.3, 0);
    roughen(d, false, 8, 0.3, 3);
    begin(d);
    press(d, 0.03);
    for (int step = 1; step <= 4; step++)
        drag(d, 0.05 * step);
    drag(d, 50);
    drag(d, 1e4);
    assert_int_equal(d->state.stuck, 0);
    memcpy(p, d->state.p, count(d) * sizeof *p);
    struct friction_state before = d->state;
    drag(d, 2e4);
    for (size_t i = 0; i < count(d); i++)
        check_close(d->state.p[i], p[i], 1e-6 * largest(count(d), p));
    double distance = d->state.displacement - before.displacement;
    check_relative(d->state.traction, 0.3 * 0.03, 1e-8);
    check_relative(d->state.work - before.work, 0.3 * 0.03 * distance, 1e-7);
    check_relative(d->state.dissipation - before.dissipation, 0.3 * 0.03 * distance, 1e-7);
    closed(d);
}

/* Returns how far works and energy are from balance, over the dissipation, after so many steps. */
static double imbalance(int steps, size_t press_steps) {
    struct dragged *d = opened(16, 16, 0.3, 0.3, press_steps);
    roughen(d, false, 8, 0.3, 8);
    begin(d);
    press(d, 0.03);
    for (int step = 1; step <= steps; step++)
        drag(d, 0.02 * step / steps);
    const struct friction_state *s = &d->state;
    double left = s->work + s->pressing_work - s->dissipation - s->energy;
    printf("[   INFO   ] %d steps: work %.5g, dissipation %.5g, balance %.2g of it; %.2f sticks\n",
           steps, s->work, s->dissipation, left / s->dissipation, s->stick_area);
    assert_true(s->dissipation > 0 && s->stick_area > 0 && s->stick_area < 1);
    left = fabs(left / s->dissipation);
    closed(d);
    return left;
}

/* The works of both loads are what friction takes and the block keeps, to second order in the
 * step. */
static void energy(void **state) {
    (void)state;
    double few = imbalance(5, 0), many = imbalance(12, 0);
    assert_true(many <= 1e-3);
    assert_true(many <= few / 4);
    assert_true(imbalance(6, 1) <= 1e-3);
}

/* Pressures of elements are unknowns of nearly incompressible blocks, with equations that are
 * scaled (gmres.h). When the preconditioner had another scale no step converged. Measured: 17 and
 * 23 iterations a step of Newton's. */
static void rubber(void **state) {
    (void)state;
    static const double SLOPES[] = {0.1, 0.4};
    for (size_t a = 0; a < 2; a++) {
        struct dragged *d = opened(16, 16, 0.4999, 0.4, 0);
        size_t newton = 0, linear = 0;
        roughen(d, false, 8, SLOPES[a], 12);
        begin(d);
        press(d, 0.1 * SLOPES[a]);
        for (int step = 1; step <= 4; step++) {
            drag(d, 0.03 * SLOPES[a] * step);
            newton += d->state.newton;
            linear += d->state.linear;
        }
        printf("[   INFO   ] slope %.1f: %.1f iterations a step of Newton's, %.2f sticks\n",
               SLOPES[a], (double)linear / (double)newton, d->state.stick_area);
        assert_true(d->state.stick_area > 0 && d->state.stick_area < 1);
        assert_true(linear < 35 * newton);
        closed(d);
    }
}

/* A face that is mirrored along x and y, dragged backward, has the mirrored solution. */
static void mirror_image(void **state) {
    (void)state;
    enum { N = 16 };
    struct dragged *one = opened(N, N, 0.2, 0.4, 1), *other = opened(N, N, 0.2, 0.4, 1);
    roughen(one, false, 8, 0.2, 5);
    for (size_t i = 0; i < N * N; i++)
        other->z[i] = one->z[(N - i / N) % N * N + (N - i % N) % N];
    begin(one);
    begin(other);
    press(one, 0.02);
    press(other, 0.02);
    for (int step = 1; step <= 3; step++) {
        drag(one, 0.01 * step);
        drag(other, -0.01 * step);
    }
    check_close(one->state.traction, -other->state.traction, 1e-9);
    check_relative(one->state.work, other->state.work, 1e-6);
    assert_true(largest(N * N, one->state.q_across) > 1e-3 * one->state.pressure);
    for (size_t i = 0; i < N * N; i++) {
        size_t mirrored = (N - i / N) % N * N + (N - i % N) % N;
        check_close(one->state.p[i], other->state.p[mirrored], 1e-7);
        check_close(one->state.q[i], -other->state.q[mirrored], 1e-7);
        check_close(one->state.q_across[i], -other->state.q_across[mirrored], 1e-7);
    }
    closed(one);
    closed(other);
}

/* A face whose x and y are exchanged, dragged along y, has the exchanged solution. */
static void along_y(void **state) {
    (void)state;
    enum { N = 16 };
    struct dragged *one = opened(N, N, 0.2, 0.4, 1), *other = opened(N, N, 0.2, 0.4, 1);
    const struct friction_state *s = &other->state;
    roughen(one, false, 8, 0.2, 5);
    for (size_t i = 0; i < N * N; i++)
        other->z[i] = one->z[i % N * N + i / N];
    other->friction.along_y = true;
    begin(one);
    begin(other);
    press(one, 0.02);
    press(other, 0.02);
    for (int step = 1; step <= 3; step++) {
        struct error err = {0};
        drag(one, 0.01 * step);
        if (friction_drag(other->solver, 0.01 * step, &other->state, &err) != 0)
            fail_msg("%s", err.text);
    }
    assert_true(one->state.stuck > 0 && one->state.stuck < one->state.nodes);
    assert_int_equal(s->stuck, one->state.stuck);
    check_close(s->traction, one->state.traction, 1e-9);
    check_close(mean_of(N * N, s->q), 0, 1e-9);
    check_relative(s->dissipation, one->state.dissipation, 1e-5);
    check_relative(s->sliding, one->state.sliding, 1e-6);
    for (size_t i = 0; i < N * N; i++) {
        size_t turned = i % N * N + i / N;
        check_close(s->p[turned], one->state.p[i], 1e-7);
        check_close(s->q_across[turned], one->state.q[i], 1e-7);
        check_close(s->q[turned], one->state.q_across[i], 1e-7);
        check_close(s->over[turned], one->state.over[i], 1e-7);
        assert_true(s->sticks[turned] == one->state.sticks[i]);
    }
    closed(one);
    closed(other);
}

/* Pressed without friction, pressures are those of full_press to the rounding of a force; with a
 * vanishing coefficient they tend to them. */
static void without_friction(void **state) {
    (void)state;
    struct dragged *d = opened(16, 16, 0.3, 0.5, 0), *little = opened(16, 16, 0.3, 1e-6, 2);
    struct full *full = NULL;
    struct contact_state without;
    struct error err = {0};
    roughen(d, false, 8, 0.2, 7);
    memcpy(little->z, d->z, sizeof d->z);
    begin(d);
    begin(little);
    press(d, 0.02);
    press(little, 0.02);
    if (full_create(&full, &d->grid, &d->block, &d->options, &err) != 0 ||
        full_begin(full, d->z, &err) != 0)
        fail_msg("%s", err.text);
    if (full_press(full, 0.02, &without, NULL, &err) != 0)
        fail_msg("%s", err.text);
    for (size_t i = 0; i < count(d); i++) {
        check_close(d->state.p[i], without.p[i], 1e-12);
        check_close(d->state.q[i], 0, 1e-9);
        check_close(d->state.q_across[i], 0, 1e-9);
        check_close(little->state.p[i], without.p[i], 1e-4);
    }
    check_relative(d->state.mean_gap, without.mean_gap, 1e-12);
    full_destroy(&full);
    closed(d);
    closed(little);
}

/* --- drawn scenes --- */

/* Returns 0, or the status of the step that failed, whose message must hold numbers. */
static int draw_scene(uint64_t *seed) {
    double coefficient = drawn(seed) < 0.1 ? 1 : 0.001 + 0.999 * drawn(seed);
    double kind = drawn(seed), poisson = kind < 0.7 ? 0.64 * kind : 0.4999;
    double slope = 0.5 * drawn(seed);
    size_t steps = drawn(seed) < 0.5 ? 0 : (size_t)(1 + 4 * drawn(seed));
    struct dragged *d = opened(16, drawn(seed) < 0.3 ? 12 : 16, poisson, coefficient, steps);
    struct error err = {0};
    double pressure = slope * 0.005 * pow(100, drawn(seed));
    double most = coefficient * (slope / 100 + 0.4 * pressure / (1 - poisson));
    d->options.kinematics = drawn(seed) < 0.2 ? KINEMATICS_SMALL : KINEMATICS_HENCKY;
    d->block.weighting = drawn(seed) < 0.2 ? GAP_STANDARD : GAP_DUAL;
    d->options.least_step = 1.0 / 16;
    roughen(d, false, 8, slope, next_word(seed));
    begin(d);
    int status = friction_press(d->solver, pressure, &d->state, &err);
    for (int step = 1; status == 0 && step <= 6; step++) {
        check_law(d, NULL);
        status = friction_drag(d->solver, most * (step <= 4 ? step : 8 - step), &d->state, &err);
    }
    if (status != 0) {
        assert_int_equal(status, ERROR_NUMERIC);
        assert_true(strlen(err.text) > 20 && strpbrk(err.text, "0123456789") != NULL);
        printf("[   INFO   ] friction %.2f, nu %.4f, slope %.2f: %s\n", coefficient, poisson, slope,
               err.text);
    }
    closed(d);
    return status;
}

/* As of profiles, where a step has no solution a scene ends with an error: with coefficients to 1
 * and slopes to 0.5 a quarter may. */
static void drawn_scenes(void **state) {
    (void)state;
    uint64_t seed = seed_or(20261128), scenes = 2 * effort(), failed = 0;
    for (uint64_t scene = 0; scene < scenes; scene++)
        failed += draw_scene(&seed) != 0;
    printf("[   INFO   ] %d of %d scenes failed\n", (int)failed, (int)scenes);
    assert_true(4 * failed <= scenes);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(ridges_are_profiles),
                                       cmocka_unit_test(coupled_half_space),
                                       cmocka_unit_test(sphere),
                                       cmocka_unit_test(flat_face),
                                       cmocka_unit_test(steady_sliding),
                                       cmocka_unit_test(energy),
                                       cmocka_unit_test(rubber),
                                       cmocka_unit_test(mirror_image),
                                       cmocka_unit_test(along_y),
                                       cmocka_unit_test(without_friction),
                                       cmocka_unit_test(drawn_scenes)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
