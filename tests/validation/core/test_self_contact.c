/* Protects steep faces of full: a symmetric groove that closes is one flank against a rigid plane,
 * which is solved here by itself; a rough profile of slope 1 that buckles and overhangs has values
 * beyond, and its flanks do not pass through each other; another that is dragged with friction
 * closes works and energy to second order in the step, folds and all; a surface that is alike
 * in all rows closes as the profile does, and is dragged as it is; a groove that winds closes works
 * and energy, too; and a limit of time ends what a jump takes. */
#include "tests/support/check.h"

#include "core/full/face.h"
#include "core/full/friction/friction.h"
#include "core/surface/surface.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { NODES_MOST = 320 };

struct pressed {
    struct grid grid;
    struct full *full;
    struct contact_state state;
    struct full_report report;
    double z[NODES_MOST];
};

static void open_profile(struct pressed *p, size_t n, double poisson, double growth) {
    struct error err = {0};
    struct block block = {.model = MODEL_LAYERED,
                          .poisson = poisson,
                          .height = 1,
                          .layer_growth = growth,
                          .weighting = GAP_DUAL};
    *p = (struct pressed){.grid = {.nx = n, .ny = 1, .lx = 1, .ly = 1}};
    if (full_create(&p->full, &p->grid, &block, &FULL_DEFAULTS, &err) != 0)
        fail_msg("%s", err.text);
}

static void press(struct pressed *p, double pressure) {
    struct error err = {0};
    if (full_press(p->full, pressure, &p->state, &p->report, &err) != 0)
        fail_msg("%s", err.text);
    check_close(p->report.balance, 0, 1e-8);
    assert_true(p->report.self.penetration < 1e-6);
}

/* A groove of a tenth of the cell, 0.2 deep, in an even face. */
static void open_groove(struct pressed *p, size_t n) {
    struct error err = {0};
    open_profile(p, n, 0.45, 1.3);
    for (size_t i = 0; i < n; i++) {
        double from = fabs((double)i / (double)n - 0.5);
        p->z[i] = from < 0.05 ? -0.2 * (1 - from / 0.05) : 0;
    }
    if (full_begin(p->full, p->z, &err) != 0)
        fail_msg("%s", err.text);
}

/* The groove again, without contact of the face with itself: nodes beside its middle are kept on
 * their side of it by stiff springs. */
struct beside_plane {
    const struct newton *newton; /* that of the groove: mesh, material and nodes on the flat */
    struct tangent *tangent;
    struct factorisation *factorisation;
    struct tangent_link *link;
    double *u, *force, *x;
    double left; /* force of the plane on the left flank */
};

static const double SPRING = 1e5;

static void plane_open(struct beside_plane *w, const struct newton *newton) {
    const struct mesh *mesh = newton->mesh;
    size_t count = mesh_degrees_of_freedom(mesh);
    struct error err = {0};
    *w = (struct beside_plane){.newton = newton,
                               .link = array_create(mesh->face, sizeof *w->link),
                               .u = array_create(count, sizeof *w->u),
                               .force = array_create(count, sizeof *w->force),
                               .x = array_create(count, sizeof *w->x)};
    if (w->link == NULL || w->u == NULL || w->force == NULL || w->x == NULL)
        abort();
    if (tangent_create(&w->tangent, mesh, &newton->material, false, &err) != 0 ||
        factorisation_create(&w->factorisation, mesh, &err) != 0)
        fail_msg("%s", err.text);
    memcpy(w->u, newton->u, count * sizeof *w->u);
    w->tangent->link = w->link;
}

static void plane_close(struct beside_plane *w) {
    factorisation_destroy(&w->factorisation);
    tangent_destroy(&w->tangent);
    free(w->link);
    free(w->u);
    free(w->force);
    free(w->x);
}

/* Adds the springs of nodes beyond the plane. */
static void add_springs(struct beside_plane *w) {
    size_t face = w->newton->mesh->face;
    w->left = 0;
    w->tangent->links = 0;
    for (size_t i = 1; i < face; i++) {
        bool left = 2 * i < face;
        double beyond = (double)i + w->u[2 * i] - (double)face / 2;
        if (2 * i == face || (left ? beyond <= 0 : beyond >= 0))
            continue;
        w->force[2 * i] += SPRING * beyond;
        w->left += left ? SPRING * beyond : 0;
        struct tangent_link *link = &w->link[w->tangent->links++];
        *link = (struct tangent_link){.at = {2 * i}, .stiffness = {{SPRING}}};
        for (size_t a = 1; a < LINK_MOST; a++)
            link->at[a] = 2 * i + 1;
    }
}

/* Fills x with the forces that are out of balance and returns the largest. */
static double plane_residual(struct beside_plane *w, double pressure) {
    const struct mesh *mesh = w->newton->mesh;
    size_t count = mesh_degrees_of_freedom(mesh), far = mesh_far_side(mesh);
    double down = -pressure * (double)mesh->face, largest = 0;
    for (size_t f = 0; f < count; f++)
        w->x[f] = -w->force[f];
    for (size_t i = far; i < mesh->nodes; i++) {
        down += w->x[2 * i + 1];
        w->x[2 * i + 1] = 0;
    }
    w->x[2 * far + 1] = down;
    for (size_t i = 0; i < mesh->face; i++)
        w->x[2 * i + 1] = w->newton->active[i] ? 0 : w->x[2 * i + 1];
    for (size_t f = 0; f < count; f++)
        largest = fmax(largest, fabs(w->x[f]));
    return largest;
}

/* Steps of Newton's method of a quarter of a column at most. */
static void plane_solve(struct beside_plane *w, double pressure) {
    const struct newton *n = w->newton;
    size_t count = mesh_degrees_of_freedom(n->mesh);
    double left = INFINITY;
    struct error err = {0};
    for (int round = 0; round < 60 && left > 1e-9; round++) {
        double most = 0;
        assert_true(tangent_evaluate(n->mesh, &n->material, w->u, NULL, w->force, w->tangent));
        add_springs(w);
        left = plane_residual(w, pressure);
        if (factorisation_run(w->factorisation, w->tangent, n->active, &err) != 0 ||
            factorisation_solve(w->factorisation, w->x, &err) != 0)
            fail_msg("%s", err.text);
        for (size_t f = 0; f < count; f++)
            most = fmax(most, fabs(w->x[f]));
        for (size_t f = 0; f < count; f++)
            w->u[f] += fmin(1, 0.25 / most) * w->x[f];
    }
    assert_true(left <= 1e-9);
}

/* The force on a flank, over E* times the cell. Meshes differ by where a groove of few cells
 * begins to close; the two solutions of one mesh by the smoothed face, to second order. */
static void a_groove_closes_on_its_plane(void **state) {
    (void)state;
    static const size_t NODES[] = {80, 160};
    double off[2];
    for (size_t m = 0; m < 2; m++) {
        struct pressed p;
        open_groove(&p, NODES[m]);
        press(&p, 0.2);
        press(&p, 0.6);
        const struct newton *n = full_newton(p.full);
        struct beside_plane w;
        double across = 0, away = 0;
        plane_open(&w, n);
        plane_solve(&w, 0.6);
        for (size_t c = 0; c < n->self.count; c++)
            across += n->self.pair[c].force * fabs(n->self.pair[c].normal[0]);
        for (size_t f = 0; f < 2 * n->mesh->face; f++)
            away = fmax(away, fabs(w.u[f] - n->u[f]));
        off[m] = across / w.left - 1;
        print_message("%zu nodes: %zu of a flank bear %.5f E* of the cell, a plane %.5f; the face "
                      "is off by %.3f columns\n",
                      NODES[m], p.report.self.nodes, across / (double)NODES[m],
                      w.left / (double)NODES[m], away);
        assert_true(p.report.self.nodes >= 3 && w.left > 0);
        plane_close(&w);
        full_destroy(&p.full);
    }
    assert_true(fabs(off[0]) < 0.05 && fabs(off[1]) < 0.02 && fabs(off[1]) < fabs(off[0]));
}

static void draw(const struct grid *grid, double shortest, double slope, uint64_t seed, double *z) {
    struct spectrum spectrum = {.type = SPECTRUM_SELF_AFFINE,
                                .hurst = 0.8,
                                .wavelength_long = 0.5,
                                .wavelength_rolloff = 0.5,
                                .wavelength_short = shortest,
                                .scale = SCALE_RMS_SLOPE,
                                .scale_value = slope};
    struct generator *generator = NULL;
    struct error err = {0};
    if (generator_create(&generator, &spectrum, grid, &SURFACE_DEFAULTS, &err) != 0 ||
        generator_run(generator, (struct random_key){.seed = seed}, z, NULL, &err) != 0)
        fail_msg("%s", err.text);
    generator_destroy(&generator);
}

/* A profile of RMS slope 1 with eight shortest waves. */
enum { ROUGH_NODES = 128 };
static void draw_rough(const struct grid *grid, uint64_t seed, double *z) {
    draw(grid, 1.0 / 16, 1, seed, z);
}

static void open_steep(struct pressed *p, double poisson, double slope, uint64_t seed) {
    struct error err = {0};
    open_profile(p, ROUGH_NODES, poisson, 1.2);
    draw(&p->grid, 1.0 / 16, slope, seed, p->z);
    if (full_begin(p->full, p->z, &err) != 0)
        fail_msg("%s", err.text);
}

static void open_rough(struct pressed *p, uint64_t seed) {
    open_steep(p, 0.3, 1, seed);
}

/* It buckles and overhangs before a load of 0.1, and goes on. What full allowed before ends there.
 */
static void a_steep_profile_goes_on(void **state) {
    (void)state;
    struct pressed p;
    struct error err = {0};
    open_rough(&p, 7);
    full_set_overhangs(p.full, false);
    assert_int_equal(full_press(p.full, 0.1, &p.state, &p.report, &err), ERROR_NUMERIC);
    assert_non_null(strstr(err.text, "mean pressure of 0.1 E* was reached up to"));
    full_set_overhangs(p.full, true);
    press(&p, 0.1);
    size_t nodes = p.state.nodes, jumps = p.report.jumps;
    double gap = p.state.mean_gap;
    const struct newton *n = full_newton(p.full);
    assert_true(face_folds(n->mesh, n->u));
    press(&p, 0.15);
    jumps += p.report.jumps;
    assert_true(p.state.nodes > nodes && p.state.mean_gap < gap && p.state.mean_gap > 0);
    assert_true(jumps > 0);
    full_destroy(&p.full);
}

/* Where equations are factorised the pressures of elements are eliminated from them, which must
 * leave the displacements that contact prescribes. When it did not, such a load took 2600
 * iterations of Newton's method; this one takes 130. */
static void a_steep_rubber_goes_on(void **state) {
    (void)state;
    struct pressed p;
    open_steep(&p, 0.4999, 0.7, 1);
    press(&p, 0.2);
    press(&p, 0.42);
    print_message("%zu iterations, %zu factorisations, %zu of 128 nodes touch, %zu the face\n",
                  p.report.newton, p.report.factored, p.state.nodes, p.report.self.nodes);
    assert_true(p.report.newton < 400 && p.report.factored > 0 && p.report.self.nodes > 0);
    full_destroy(&p.full);
}

/* Returns how deep the deepest node lies inside the block elsewhere: a ray down from just outside
 * of it crosses the face an odd number of times. */
static double overlap(const struct mesh *mesh, const double *u) {
    const size_t n = mesh->face, own = 3;
    static double x[3 * ROUGH_NODES], y[3 * ROUGH_NODES];
    double deepest = 0;
    for (size_t k = 0; k < 3 * n; k++) {
        x[k] = (double)k + u[2 * (k % n)];
        y[k] = mesh->height[k % n] + u[2 * (k % n) + 1];
    }
    for (size_t i = n; i < 2 * n; i++) {
        double before = hypot(x[i] - x[i - 1], y[i] - y[i - 1]);
        double after = hypot(x[i + 1] - x[i], y[i + 1] - y[i]);
        double along = (x[i] - x[i - 1]) / before + (x[i + 1] - x[i]) / after;
        double up = (y[i] - y[i - 1]) / before + (y[i + 1] - y[i]) / after;
        double size = hypot(along, up);
        double outside = x[i] + 1e-6 * up / size, below = y[i] - 1e-6 * along / size;
        double nearest = INFINITY;
        bool inside = false;
        for (size_t k = 0; k + 1 < 3 * n; k++) {
            double dx = x[k + 1] - x[k], dy = y[k + 1] - y[k];
            if ((x[k] <= outside) != (x[k + 1] <= outside))
                inside = inside != (y[k] + dy * (outside - x[k]) / dx < below);
            double t = ((x[i] - x[k]) * dx + (y[i] - y[k]) * dy) / (dx * dx + dy * dy);
            t = fmax(0, fmin(1, t));
            if (k + own < i || k >= i + own)
                nearest = fmin(nearest, hypot(x[i] - x[k] - t * dx, y[i] - y[k] - t * dy));
        }
        deepest = fmax(deepest, inside ? nearest : 0);
    }
    return deepest;
}

/* Where nodes of one flank alone met the other, corners went 2.4 columns between them. The smoothed
 * face is within an eighth of second differences, which are up to two columns. */
static void flanks_do_not_pass_through_each_other(void **state) {
    (void)state;
    static const double LOADS[] = {0.02, 0.1, 0.3, 0.6};
    struct pressed p;
    open_rough(&p, 3);
    for (size_t l = 0; l < sizeof LOADS / sizeof *LOADS; l++) {
        press(&p, LOADS[l]);
        const struct newton *n = full_newton(p.full);
        print_message("load %.2f: %zu nodes of folds bear, overlap %.3f columns\n", LOADS[l],
                      p.report.self.nodes, overlap(n->mesh, n->u));
        assert_true(overlap(n->mesh, n->u) < 0.25);
    }
    assert_true(p.report.self.nodes > 0);
    full_destroy(&p.full);
}

/* Drags a profile in even steps; returns what works, dissipation and energy leave. */
static double drag_rough(size_t steps) {
    struct grid grid = {.nx = ROUGH_NODES, .ny = 1, .lx = 1, .ly = 1};
    struct block block = {.model = MODEL_LAYERED,
                          .poisson = 0.3,
                          .height = 1,
                          .layer_growth = 1.2,
                          .weighting = GAP_DUAL};
    struct friction_options options = {.coefficient = 0.3};
    struct friction_state now;
    struct friction *friction = NULL;
    struct error err = {0};
    double z[ROUGH_NODES];
    draw_rough(&grid, 3, z);
    if (friction_create(&friction, &grid, &block, &FULL_DEFAULTS, &options, &err) != 0 ||
        friction_begin(friction, z, &err) != 0 || friction_press(friction, 0.15, &now, &err) != 0)
        fail_msg("%s", err.text);
    for (size_t k = 1; k <= steps; k++)
        if (friction_drag(friction, 0.1 * (double)k / (double)steps, &now, &err) != 0)
            fail_msg("%s", err.text);
    assert_true(now.self.nodes > 0 && now.self.penetration < 1e-6 && now.jumps == 0);
    double left = now.work + now.pressing_work - now.dissipation - now.energy;
    print_message("%zu steps: friction takes %.4g, %.2g of it are left; %zu nodes of folds bear\n",
                  steps, now.dissipation, left / now.dissipation, now.self.nodes);
    friction_destroy(&friction);
    return fabs(left / now.dissipation);
}

static void works_close_where_the_face_folds(void **state) {
    (void)state;
    double coarse = drag_rough(5), fine = drag_rough(20);
    assert_true(coarse < 1e-2 && fine < 1e-3 && fine < coarse / 8);
}

/* A groove that closes, alike in four rows: nothing differs from the profile but how the equations
 * are solved, to the tolerance of their solution (1e-9 of the largest force). Beyond, lips meet,
 * which surfaces do not treat apart. */
static void a_surface_alike_in_all_rows_is_a_profile(void **state) {
    (void)state;
    enum { NODES = 40, ROWS = 4 };
    static const double WIDTH = 0.075, DEPTH = 0.2;
    struct full_options options = FULL_DEFAULTS;
    struct full_report report[2];
    struct contact_state pressed[2];
    double z[NODES * ROWS];
    options.transition = INFINITY;
    for (size_t i = 0; i < NODES * ROWS; i++) {
        double from = fabs((double)(i % NODES) / NODES - 0.5);
        z[i] = from < WIDTH ? -DEPTH * (1 - from / WIDTH) : 0;
    }
    for (int d = 0; d < 2; d++) {
        struct error err = {0};
        struct block block = {.model = MODEL_LAYERED,
                              .poisson = 0.45,
                              .height = 1,
                              .layer_growth = 1.4,
                              .weighting = GAP_DUAL};
        struct grid grid = {NODES, d == 0 ? 1 : ROWS, 1, d == 0 ? 1 : (double)ROWS / NODES};
        struct full *full = NULL;
        if (full_create(&full, &grid, &block, &options, &err) != 0 ||
            full_begin(full, z, &err) != 0 ||
            full_press(full, 0.2, &pressed[d], &report[d], &err) != 0 ||
            full_press(full, 0.5, &pressed[d], &report[d], &err) != 0)
            fail_msg("%s", err.text);
        assert_true(face_folds(full_mesh(full), full_newton(full)->u));
        full_destroy(&full);
    }
    assert_true(report[0].self.nodes > 0);
    assert_int_equal(report[1].self.nodes, ROWS * report[0].self.nodes);
    assert_int_equal(pressed[1].nodes, ROWS * pressed[0].nodes);
    check_relative(report[1].self.force, ROWS * report[0].self.force, 1e-6);
    check_relative(pressed[1].mean_gap, pressed[0].mean_gap, 1e-8);
    check_relative(report[1].stretch, report[0].stretch, 1e-8);
}

/* --- folded surfaces with friction --- */

enum { GROOVE_MOST = 40, GROOVE_ROWS = 3 };

/* A groove across the drag, whose rows wind by so much. */
struct groove_shape {
    size_t nodes, rows;
    double width, depth, winds, load;
};

struct groove {
    struct grid grid;
    struct friction *friction;
    struct friction_state now;
    double z[GROOVE_MOST * GROOVE_ROWS];
};

/* Closes a groove by a load without friction. */
static void groove_open(struct groove *g, const struct groove_shape *shape) {
    const double nodes = (double)shape->nodes, rows = (double)shape->rows;
    struct full_options options = FULL_DEFAULTS;
    struct block block = {.model = MODEL_LAYERED,
                          .poisson = 0.45,
                          .height = 1,
                          .layer_growth = 1.4,
                          .weighting = GAP_DUAL};
    struct friction_options friction = {.coefficient = 0.05};
    struct error err = {0};
    options.transition = INFINITY;
    options.tolerance = 1e-7;
    *g =
        (struct groove){.grid = {shape->nodes, shape->rows, 1, shape->rows > 1 ? rows / nodes : 1}};
    for (size_t i = 0; i < shape->nodes * shape->rows; i++) {
        size_t row = i / shape->nodes, column = i % shape->nodes;
        double middle = 0.5 + shape->winds * sin(2 * M_PI * (double)row / rows);
        double from = fabs((double)column / nodes - middle);
        g->z[i] = from < shape->width ? -shape->depth * (1 - from / shape->width) : 0;
    }
    if (friction_create(&g->friction, &g->grid, &block, &options, &friction, &err) != 0 ||
        friction_begin(g->friction, g->z, &err) != 0 ||
        friction_press(g->friction, shape->load, &g->now, &err) != 0)
        fail_msg("%s", err.text);
    assert_true(g->now.self.nodes > 0);
}

static void groove_drag(struct groove *g, double to) {
    struct error err = {0};
    if (friction_drag(g->friction, to, &g->now, &err) != 0)
        fail_msg("%s", err.text);
    assert_true(g->now.self.nodes > 0 && g->now.self.penetration < 1e-5);
}

/* It differs from the profile by how the equations are solved alone. */
static void a_dragged_surface_alike_in_all_rows_is_a_profile(void **state) {
    (void)state;
    struct groove_shape shape = {.nodes = 40, .rows = 1, .width = 0.075, .depth = 0.2, .load = 0.5};
    struct groove profile, surface;
    groove_open(&profile, &shape);
    shape.rows = GROOVE_ROWS;
    groove_open(&surface, &shape);
    for (int step = 1; step <= 2; step++) {
        const struct friction_state *expected = &profile.now, *now = &surface.now;
        groove_drag(&profile, 0.05 * step);
        groove_drag(&surface, 0.05 * step);
        print_message("step %d: %zu nodes of the groove bear %.8g and %.8g, friction takes %.8g "
                      "and %.8g\n",
                      step, expected->self.nodes, expected->self.force,
                      now->self.force / GROOVE_ROWS, expected->dissipation, now->dissipation);
        assert_int_equal(now->self.nodes, GROOVE_ROWS * expected->self.nodes);
        assert_int_equal(now->nodes, GROOVE_ROWS * expected->nodes);
        assert_int_equal(now->stuck, GROOVE_ROWS * expected->stuck);
        check_relative(now->self.force, GROOVE_ROWS * expected->self.force, 1e-5);
        check_relative(now->traction, expected->traction, 1e-6);
        check_relative(now->mean_gap, expected->mean_gap, 1e-6);
        check_close(now->dissipation, expected->dissipation, 1e-5 * expected->work);
    }
    friction_destroy(&profile.friction);
    friction_destroy(&surface.friction);
}

/* Where flanks slide along both axes. */
static void works_close_where_a_surface_folds(void **state) {
    (void)state;
    static const struct groove_shape WINDING = {28, GROOVE_ROWS, 0.107, 0.3, 0.018, 0.6};
    struct groove g;
    groove_open(&g, &WINDING);
    for (int step = 1; step <= 2; step++)
        groove_drag(&g, 0.06 * step);
    const struct friction_state *now = &g.now;
    double left = now->work + now->pressing_work - now->dissipation - now->energy;
    print_message("friction takes %.4g, %.2g of it are left; %zu nodes of the groove bear\n",
                  now->dissipation, left / now->dissipation, now->self.nodes);
    assert_true(now->dissipation > 0.1 * now->work);
    check_close(left, 0, 1e-3 * now->dissipation);
    friction_destroy(&g.friction);
}

/* Iterations of Newton's method, and whether a face has been dragged from its last load. */
struct watched {
    const struct full *full;
    size_t iterations;
    bool jumps, stops;
};

static int watch(void *context) {
    struct watched *watched = context;
    watched->jumps = watched->jumps || full_newton(watched->full)->drag > 0;
    watched->iterations++;
    return watched->stops && watched->jumps;
}

/* A steep surface that buckles, pressed within so many iterations. */
static int press_surface(double most, struct watched *watched, struct full_report *report,
                         struct error *err) {
    enum { NODES = 12 };
    struct grid grid = {NODES, NODES, 1, 1};
    struct block block = {.model = MODEL_LAYERED,
                          .poisson = 0.3,
                          .height = 1,
                          .layer_growth = 1.3,
                          .weighting = GAP_DUAL};
    struct full_options options = FULL_DEFAULTS;
    struct full *full = NULL;
    struct contact_state state;
    double z[NODES * NODES];
    options.limit = (struct full_limit){.seconds = most, .newton = 1};
    draw(&grid, 0.33, 2, 8, z);
    if (full_create(&full, &grid, &block, &options, err) != 0 || full_begin(full, z, err) != 0)
        fail_msg("%s", err->text);
    watched->full = full;
    full_set_stop(full, watch, watched);
    int status = full_press(full, 0.3, &state, report, err);
    full_destroy(&full);
    return status;
}

/* A limit that is used up in the rounds of a jump ends them at once, with its note. */
static void a_limit_ends_the_rounds_of_a_surface(void **state) {
    (void)state;
    struct error err = {0};
    struct full_report report;
    struct watched first = {.stops = true}, limited = {.stops = false};
    assert_int_equal(press_surface(0, &first, &report, &err), ERROR_STOPPED);
    assert_true(first.jumps);
    size_t before = report.newton;
    err = (struct error){0};
    assert_int_equal(press_surface((double)before + 1.5, &limited, &report, &err), ERROR_NUMERIC);
    print_message("%zu iterations to the first round, %zu with the rounds: %s\n", before,
                  report.newton, err.text);
    assert_true(limited.jumps && report.newton > before + 1 && report.newton < before + 10);
    assert_true(report.reached > 0 && report.reached < 0.3);
    assert_non_null(strstr(err.text, "mean pressure of 0.3 E* was reached up to"));
    assert_non_null(strstr(err.text, "time limit"));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_groove_closes_on_its_plane),
        cmocka_unit_test(a_steep_profile_goes_on),
        cmocka_unit_test(a_steep_rubber_goes_on),
        cmocka_unit_test(flanks_do_not_pass_through_each_other),
        cmocka_unit_test(works_close_where_the_face_folds),
        cmocka_unit_test(a_surface_alike_in_all_rows_is_a_profile),
        cmocka_unit_test(a_dragged_surface_alike_in_all_rows_is_a_profile),
        cmocka_unit_test(works_close_where_a_surface_folds),
        cmocka_unit_test(a_limit_ends_the_rounds_of_a_surface),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
