/* Protects contact of a surface's face with itself: a fold that is alike in all rows is that of a
 * profile, folds along both axes and across the sides of the cell are alike, forces are the
 * gradient of an energy and balance as do their moments, and their tangent is exact. With friction
 * a fold that is alike in all rows is that of a profile, too; Coulomb's law in both directions
 * along the face, its exact tangent, and forces that turn with the face. */
#include "tests/support/check.h"
#include "tests/support/fold.h"
#include <stdlib.h>
#include <string.h>

enum { NODES = 16, ROWS = 8, FACE = NODES * ROWS, DEEP = 3, FIRST = 4 };

/* Displaces the nodes of one line across a fold DEEP columns deep, whose leaning flanks are `width`
 * apart at their narrowest, from node `first` on. `along` and the last component are displaced. */
static void fold_line(struct folded *f, size_t first, double width, double up, size_t axis,
                      size_t line) {
    size_t d = (size_t)f->mesh->dimension, nx = f->mesh->level[0].nx;
    size_t nodes = axis == 0 ? nx : f->mesh->level[0].ny;
    for (size_t a = 0; a <= 2 * DEEP; a++) {
        size_t number = first + a, at = number % nodes;
        size_t node = axis == 0 ? line * nx + at : at * nx + line;
        double depth = a <= DEEP ? (double)a : (double)(2 * DEEP - a);
        double lean = width / 2 + 0.05 * depth + (a == 0 || a == 2 * DEEP ? 0.5 : 0);
        double side = a < DEEP ? -1 : a > DEEP ? 1 : 0;
        f->u[d * node + axis] = (double)(first + DEEP) + side * lean - (double)number;
        f->u[d * node + d - 1] = up * depth + 0.02 * (double)a;
    }
}

/* Folds all lines along an axis; widths differ by `uneven` from line to line. */
static void fold(struct folded *f, size_t first, double width, double uneven, double up,
                 size_t axis) {
    size_t lines = axis == 0 ? f->mesh->level[0].ny : f->mesh->level[0].nx;
    memset(f->u, 0, mesh_degrees_of_freedom(f->mesh) * sizeof *f->u);
    for (size_t line = 0; line < lines; line++) {
        double wave = sin(0.3 + 2 * M_PI * (double)line / (double)lines);
        fold_line(f, first, width + uneven * wave, up, axis, line);
    }
}

/* Both splines are the same curve, and nodes of either flank meet the other one. */
static void even_folds_are_those_of_a_profile(void **state) {
    (void)state;
    struct folded f, profile;
    open_fold(&f, NODES, ROWS, 2);
    open_fold(&profile, NODES, 1, 2);
    for (size_t first = FIRST; first < FIRST + NODES; first += 5)
        for (int width = -1; width < 2; width += 2) {
            fold(&f, first, 0.2 * width, 0, 1, 0);
            fold(&profile, first, 0.2 * width, 0, 1, 0);
            self_contact_search(&f.self, f.u, f.active);
            self_contact_search(&profile.self, profile.u, profile.active);
            double energy = find(&f);
            check_relative(energy, ROWS * find(&profile), 1e-10);
            assert_true(width > 0 ? energy == 0 : energy > 0.1);
            assert_true(f.self.count == ROWS * profile.self.count && profile.self.count >= 2);
            check_close(self_contact_depth(&f.self, f.u, f.active),
                        self_contact_depth(&profile.self, profile.u, profile.active), 1e-12);
            for (size_t node = 0; node < FACE; node++) {
                check_close(f.force[3 * node], profile.force[2 * (node % NODES)], 1e-10);
                check_close(f.force[3 * node + 1], 0, 1e-10);
                check_close(f.force[3 * node + 2], profile.force[2 * (node % NODES) + 1], 1e-10);
            }
        }
    close_fold(&profile);
    close_fold(&f);
}

static void crests_and_graphs_meet_nothing(void **state) {
    (void)state;
    struct folded f;
    open_fold(&f, NODES, ROWS, 2);
    fold(&f, FIRST, 0.2, 0.04, -1, 0);
    self_contact_search(&f.self, f.u, f.active);
    assert_int_equal(f.self.count, 0);
    memset(f.u, 0, mesh_degrees_of_freedom(f.mesh) * sizeof *f.u);
    self_contact_search(&f.self, f.u, f.active);
    assert_int_equal(f.self.count, 0);
    close_fold(&f);
}

/* The same fold along the other axis and across the sides of the cell. Forces and their moments are
 * in balance, as each acts along the line between a node and the nearest point. */
static void axes_and_sides_are_alike(void **state) {
    (void)state;
    struct folded f, turned;
    double moment[3] = {0}, sum[3] = {0}, most = 0;
    open_fold(&f, NODES, ROWS, 2);
    open_fold(&turned, ROWS, NODES, 2);
    fold(&f, FIRST, -0.3, 0.1, 1, 0);
    fold(&turned, FIRST + 9, -0.3, 0.1, 1, 1);
    self_contact_search(&f.self, f.u, f.active);
    self_contact_search(&turned.self, turned.u, turned.active);
    check_relative(find(&turned), find(&f), 1e-10);
    for (size_t node = 0; node < FACE; node++) {
        const double *force = f.force + 3 * node, *u = f.u + 3 * node;
        size_t other = (node % NODES + 9) % NODES * ROWS + node / NODES;
        check_close(turned.force[3 * other + 1], force[0], 1e-10);
        check_close(turned.force[3 * other], force[1], 1e-10);
        check_close(turned.force[3 * other + 2], force[2], 1e-10);
        /* Forces do not reach across the sides along the first axis, and those across the others
         * bear no moment about the second. */
        double x = (double)(node % NODES) + u[0];
        moment[1] += f.mesh->height[node] * force[0] + u[2] * force[0] - x * force[2];
        for (int k = 0; k < 3; k++) {
            sum[k] += force[k];
            most = fmax(most, fabs(force[k]));
        }
    }
    assert_true(most > 1);
    for (int k = 0; k < 3; k++)
        check_close(sum[k], 0, 1e-11 * most);
    check_close(moment[1], 0, 1e-10 * most);
    close_fold(&turned);
    close_fold(&f);
}

/* Central differences, whose errors are of second order; a pair's patch and point follow each
 * displacement. Rows of all kinds are displaced in turn: every fifth value of the fold. */
static void forces_and_tangent_are_derivatives(void **state) {
    (void)state;
    static const double STEP = 1e-5;
    enum { VALUES = 3 * FACE };
    struct folded f;
    double force[VALUES], plus[VALUES], stiffness[VALUES];
    open_fold(&f, NODES, ROWS, 2);
    fold(&f, FIRST, -0.3, 0.1, 1, 0);
    self_contact_search(&f.self, f.u, f.active);
    assert_true(find(&f) > 0 && f.tangent->patches > 0);
    for (size_t i = 0; i < VALUES; i += 5) {
        for (size_t c = 0; c < f.self.count; c++)
            f.self.pair[c].multiplier = i % 2 == 0 ? 1 : 0;
        double here = f.u[i];
        (void)find(&f);
        memcpy(force, f.force, sizeof force);
        memset(f.change, 0, mesh_degrees_of_freedom(f.mesh) * sizeof *f.change);
        f.change[i] = 1;
        tangent_apply(f.tangent, f.change, f.force);
        memcpy(stiffness, f.force, sizeof stiffness);
        f.u[i] = here + STEP;
        double above = find(&f);
        memcpy(plus, f.force, sizeof plus);
        f.u[i] = here - STEP;
        double below = find(&f);
        f.u[i] = here;
        check_close((above - below) / (2 * STEP), force[i], 1e-5);
        for (size_t k = 0; k < VALUES; k++)
            check_close((plus[k] - f.force[k]) / (2 * STEP), stiffness[k], 1e-4);
    }
    close_fold(&f);
}

/* --- friction --- */

static const double FRICTION = 0.4;

/* A fold that is pressed together, with friction, whose left flank then moves over the other. */
static void rub(struct folded *f, double uneven, double along, double rise) {
    struct error err = {0};
    fold(f, FIRST, -0.3, uneven, 1, 0);
    f->self.count = 0;
    if (self_contact_add_friction(&f->self, FRICTION, &err) != 0)
        fail_msg("%s", err.text);
    self_contact_search(&f->self, f->u, f->active);
    (void)find(f);
    self_contact_settle(&f->self);
    for (size_t row = 0; row < f->mesh->level[0].ny; row++)
        for (size_t a = 1; a < DEEP; a++) {
            size_t d = (size_t)f->mesh->dimension, node = row * f->mesh->level[0].nx + FIRST + a;
            f->u[d * node + d - 1] += rise;
            if (d == 3)
                f->u[3 * node + 1] += along;
        }
}

static void even_folds_rub_as_those_of_a_profile(void **state) {
    (void)state;
    static const double RISES[] = {0.004, -0.1, 0.1};
    struct folded f, profile;
    open_fold(&f, NODES, ROWS, 2);
    open_fold(&profile, NODES, 1, 2);
    for (size_t r = 0; r < 3; r++) {
        rub(&f, 0, 0, RISES[r]);
        rub(&profile, 0, 0, RISES[r]);
        check_relative(find(&f), ROWS * find(&profile), 1e-10);
        double friction = self_contact_dissipation(&profile.self);
        assert_true(friction > 1e-6);
        check_relative(self_contact_dissipation(&f.self), ROWS * friction, 1e-9);
        for (size_t node = 0; node < FACE; node++) {
            check_close(f.force[3 * node], profile.force[2 * (node % NODES)], 1e-10);
            check_close(f.force[3 * node + 1], 0, 1e-10);
            check_close(f.force[3 * node + 2], profile.force[2 * (node % NODES) + 1], 1e-10);
        }
    }
    close_fold(&profile);
    close_fold(&f);
}

/* Counts the pairs that slide, whose force is at its bound and, where there is no multiplier,
 * against the slip; and those that stick. */
static void check_coulomb(const struct folded *f, size_t *slide, size_t *stick) {
    for (size_t c = 0; c < f->self.count; c++) {
        const struct self_pair *pair = &f->self.pair[c];
        double bound = FRICTION * pair->force, size = hypot(pair->shear[0], pair->shear[1]);
        double slip = hypot(pair->slip[0], pair->slip[1]);
        assert_true(size <= bound * (1 + 1e-12));
        *slide += bound > 0 && size >= bound * (1 - 1e-12);
        *stick += size < bound * (1 - 1e-12);
        check_close(pair->shear[0] * pair->slip[0] + pair->shear[1] * pair->slip[1], -size * slip,
                    1e-12 * bound);
    }
}

/* Central differences, whose errors are of second order: first without multipliers, then with such
 * as are across the slip. */
static void friction_follows_coulomb_and_its_tangent(void **state) {
    (void)state;
    static const double STEP = 1e-5, MOVES[][2] = {{0.003, 0.004}, {0.12, -0.05}, {-0.07, 0.1}};
    enum { VALUES = 3 * FACE };
    struct folded f;
    double plus[VALUES], stiffness[VALUES];
    open_fold(&f, NODES, ROWS, 2);
    for (size_t m = 0; m < 6; m++) {
        size_t slide = 0, stick = 0;
        rub(&f, 0.1, MOVES[m % 3][0], MOVES[m % 3][1]);
        (void)find(&f);
        check_coulomb(&f, &slide, &stick);
        assert_true(m % 3 == 0 ? stick > 0 : slide > 0);
        assert_true(self_contact_dissipation(&f.self) > 0);
        for (size_t c = 0; m > 2 && c < f.self.count; c++) {
            f.self.pair[c].shear_multiplier[0] = 0.3 * f.self.pair[c].force;
            f.self.pair[c].shear_multiplier[1] = -0.2 * f.self.pair[c].force;
        }
        for (size_t i = m; i < VALUES; i += 7) {
            double here = f.u[i];
            (void)find(&f);
            memset(f.change, 0, mesh_degrees_of_freedom(f.mesh) * sizeof *f.change);
            f.change[i] = 1;
            tangent_apply(f.tangent, f.change, f.force);
            memcpy(stiffness, f.force, sizeof stiffness);
            f.u[i] = here + STEP;
            (void)find(&f);
            memcpy(plus, f.force, sizeof plus);
            f.u[i] = here - STEP;
            (void)find(&f);
            f.u[i] = here;
            for (size_t k = 0; k < VALUES; k++)
                check_close((plus[k] - f.force[k]) / (2 * STEP), stiffness[k], 1e-4);
        }
    }
    close_fold(&f);
}

/* Turns a position about an axis that is oblique to all others. */
static void turn(const double x[3], double out[3]) {
    static const double MATRIX[3][3] = {
        {2 / 3.0, -1 / 3.0, 2 / 3.0}, {2 / 3.0, 2 / 3.0, -1 / 3.0}, {-1 / 3.0, 2 / 3.0, 2 / 3.0}};
    for (size_t i = 0; i < 3; i++)
        out[i] = MATRIX[i][0] * x[0] + MATRIX[i][1] * x[1] + MATRIX[i][2] * x[2];
}

/* Rows that are turned about the middle of the face do not reach across its sides: those at its
 * ends are left out, with the multipliers of a fold that has been rubbed before. */
static void friction_turns_with_the_face(void **state) {
    (void)state;
    struct folded f;
    double force[3 * FACE], most = 0;
    open_fold(&f, NODES, ROWS, 2);
    rub(&f, 0.1, 0.12, -0.05);
    size_t kept = 0;
    for (size_t c = 0; c < f.self.count; c++) {
        size_t row = f.self.pair[c].arc / NODES, own = f.self.pair[c].node / NODES;
        if (row >= 2 && row <= ROWS - 3 && own >= 2 && own <= ROWS - 3)
            f.self.pair[kept++] = f.self.pair[c];
    }
    f.self.count = kept;
    for (size_t c = 0; c < kept; c++)
        f.self.pair[c].shear_multiplier[0] = 0.1;
    (void)find(&f);
    memcpy(force, f.force, sizeof force);
    for (size_t node = 0; node < FACE; node++) {
        const double middle[3] = {0.5 * NODES, 0.5 * ROWS, 0};
        size_t row = node / NODES, column = node % NODES;
        double x[3] = {(double)column, (double)row, f.mesh->height[node]};
        double from[3], to[3];
        for (size_t k = 0; k < 3; k++)
            from[k] = x[k] + f.u[3 * node + k] - middle[k];
        turn(from, to);
        for (size_t k = 0; k < 3; k++)
            f.u[3 * node + k] = to[k] + middle[k] - x[k];
    }
    (void)find(&f);
    for (size_t node = 0; node < FACE; node++) {
        double expected[3];
        turn(force + 3 * node, expected);
        for (size_t k = 0; k < 3; k++) {
            check_close(f.force[3 * node + k], expected[k], 1e-9);
            most = fmax(most, fabs(force[3 * node + 1]));
        }
    }
    assert_true(kept > 0 && most > 0.01);
    close_fold(&f);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(even_folds_are_those_of_a_profile),
        cmocka_unit_test(crests_and_graphs_meet_nothing),
        cmocka_unit_test(axes_and_sides_are_alike),
        cmocka_unit_test(forces_and_tangent_are_derivatives),
        cmocka_unit_test(even_folds_rub_as_those_of_a_profile),
        cmocka_unit_test(friction_follows_coulomb_and_its_tangent),
        cmocka_unit_test(friction_turns_with_the_face),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
