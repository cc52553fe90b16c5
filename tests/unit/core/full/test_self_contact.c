/* Protects contact of a face with itself: what counts as a pair, also while forces settle, forces
 * that are the gradient of an energy and balance, their tangent, the periodic images, and
 * multipliers that take the forces; with friction Coulomb's law, its tangent, and forces that turn
 * with the face. */
#include "tests/support/check.h"
#include "tests/support/fold.h"
#include <stdlib.h>
#include <string.h>

enum { NODES = 24, FIRST = 8, DEEP = 4, FACE_VALUES = 2 * NODES };

/* A fold DEEP columns deep, upward (into the block) or downward (a crest), whose flanks lean over
 * and are `width` apart at their narrowest, from node `first` on. */
static void fold(struct folded *f, size_t first, double width, double up) {
    memset(f->u, 0, mesh_degrees_of_freedom(f->mesh) * sizeof *f->u);
    for (size_t a = 0; a <= 2 * DEEP; a++) {
        size_t number = first + a, node = number % NODES;
        double depth = a <= DEEP ? (double)a : (double)(2 * DEEP - a);
        double lean = width / 2 + 0.05 * depth + (a == 0 || a == 2 * DEEP ? 0.5 : 0);
        double side = a < DEEP ? -1 : a > DEEP ? 1 : 0;
        f->u[2 * node] = (double)(first + DEEP) + side * lean - (double)number;
        f->u[2 * node + 1] = up * depth + 0.02 * (double)a;
    }
}

static void flanks_meet_across_air_alone(void **state) {
    (void)state;
    struct folded f;
    open_fold(&f, NODES, 1, 1.3);
    for (size_t first = FIRST; first < FIRST + NODES; first += 5) {
        fold(&f, first, 0.2, 1);
        self_contact_search(&f.self, f.u, f.active);
        assert_true(f.self.count >= 2);
        (void)find(&f);
        for (size_t c = 0; c < f.self.count; c++) {
            assert_true(f.self.pair[c].gap > 0.1 && f.self.pair[c].gap < 1);
            assert_true(f.self.pair[c].force == 0);
        }
        assert_int_equal(f.tangent->links, 0);
        assert_true(self_contact_depth(&f.self, f.u, f.active) == 0);
        fold(&f, first, 0.2, -1);
        self_contact_search(&f.self, f.u, f.active);
        assert_int_equal(f.self.count, 0);
    }
    memset(f.u, 0, mesh_degrees_of_freedom(f.mesh) * sizeof *f.u);
    self_contact_search(&f.self, f.u, f.active);
    assert_int_equal(f.self.count, 0);
    close_fold(&f);
}

/* While forces settle, the nearest point may pass the end of a fold onto the node's own flank,
 * which the node would bear on for ever: no round finds that pair again. */
static void nodes_do_not_meet_their_own_flank(void **state) {
    (void)state;
    struct folded f;
    open_fold(&f, NODES, 1, 1.3);
    fold(&f, FIRST, 0.2, 1);
    for (size_t node = FIRST + DEEP - 1; node <= FIRST + DEEP + 1; node++) {
        f.self.pair[0] = (struct self_pair){
            .node = node, .arc = node, .at = 0.5, .kind = SELF_RIGHT, .multiplier = 20};
        f.self.count = 1;
        (void)find(&f);
        assert_true(f.self.pair[0].force == 0);
        assert_int_equal(f.tangent->links, 0);
    }
    close_fold(&f);
}

/* Lips that touch the flat meet along it. */
static void lips_on_the_flat_meet(void **state) {
    (void)state;
    struct folded f;
    open_fold(&f, NODES, 1, 1.3);
    fold(&f, FIRST, 0.2, 1);
    f.u[2 * FIRST] += 0.68;
    f.u[2 * (FIRST + 2 * DEEP)] -= 0.68;
    f.active[FIRST] = f.active[FIRST + 2 * DEEP] = true;
    self_contact_search(&f.self, f.u, f.active);
    (void)find(&f);
    const struct self_pair *last = &f.self.pair[f.self.count - 1];
    assert_true(f.self.count > 0 && last->kind == SELF_LIPS && last->node == FIRST);
    check_close(last->gap, -0.16, 1e-12);
    check_close(f.force[2 * FIRST], last->force, 1e-12);
    check_close(f.force[2 * (FIRST + 2 * DEEP)], -last->force, 1e-12);
    check_close(self_contact_depth(&f.self, f.u, f.active), 0.16, 1e-12);
    close_fold(&f);
}

/* Central differences of an energy and of forces, whose errors are of second order; a pair's arc
 * and point follow each displacement. */
static void forces_and_tangent_are_derivatives(void **state) {
    (void)state;
    static const double STEP = 1e-5;
    struct folded f;
    double force[FACE_VALUES], plus[FACE_VALUES];
    open_fold(&f, NODES, 1, 1.3);
    fold(&f, FIRST, -0.3, 1);
    self_contact_search(&f.self, f.u, f.active);
    assert_true(find(&f) > 0 && f.tangent->links > 0);
    for (int multiplied = 0; multiplied < 2; multiplied++) {
        for (size_t c = 0; multiplied != 0 && c < f.self.count; c++)
            f.self.pair[c].multiplier = 1;
        for (size_t i = 2 * FIRST; i < 2 * (FIRST + 2 * DEEP + 1); i++) {
            double here = f.u[i];
            (void)find(&f);
            memcpy(force, f.force, sizeof force);
            memset(f.change, 0, mesh_degrees_of_freedom(f.mesh) * sizeof *f.change);
            f.change[i] = 1;
            tangent_apply(f.tangent, f.change, f.force);
            double stiffness[FACE_VALUES];
            memcpy(stiffness, f.force, sizeof stiffness);
            f.u[i] = here + STEP;
            double above = find(&f);
            memcpy(plus, f.force, sizeof plus);
            f.u[i] = here - STEP;
            double below = find(&f);
            f.u[i] = here;
            check_close((above - below) / (2 * STEP), force[i], 1e-6);
            for (size_t k = 0; k < FACE_VALUES; k++)
                check_close((plus[k] - f.force[k]) / (2 * STEP), stiffness[k], 1e-5);
        }
    }
    close_fold(&f);
}

/* A fold that is pressed together, with friction, whose left flank then rises by so much. */
static void rub(struct folded *f, double rise) {
    fold(f, FIRST, -0.3, 1);
    f->self.friction = 0.4;
    f->self.count = 0;
    self_contact_search(&f->self, f->u, f->active);
    (void)find(f);
    self_contact_settle(&f->self);
    for (size_t a = 1; a < DEEP; a++)
        f->u[2 * (FIRST + a) + 1] += rise;
}

/* Errors of central differences are of second order. */
static void friction_follows_coulomb_and_its_tangent(void **state) {
    (void)state;
    static const double STEP = 1e-5, RISES[] = {0.004, -0.1, 0.1};
    struct folded f;
    double plus[FACE_VALUES], stiffness[FACE_VALUES];
    open_fold(&f, NODES, 1, 1.3);
    for (size_t r = 0; r < 3; r++) {
        size_t slide = 0, stick = 0;
        rub(&f, RISES[r]);
        (void)find(&f);
        for (size_t c = 0; c < f.self.count; c++) {
            const struct self_pair *pair = &f.self.pair[c];
            double bound = 0.4 * pair->force;
            assert_true(fabs(pair->shear[0]) <= bound * (1 + 1e-12) &&
                        pair->shear[0] * pair->slip[0] <= 0);
            slide += bound > 0 && fabs(pair->shear[0]) >= bound;
            stick += fabs(pair->shear[0]) < bound;
        }
        assert_true(r == 0 ? stick > 0 : slide > 0);
        assert_true(self_contact_dissipation(&f.self) > 0);
        for (size_t i = 2 * FIRST; i < 2 * (FIRST + 2 * DEEP + 1); i++) {
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
            for (size_t k = 0; k < FACE_VALUES; k++)
                check_close((plus[k] - f.force[k]) / (2 * STEP), stiffness[k], 1e-5);
        }
    }
    close_fold(&f);
}

static void forces_turn_with_the_face(void **state) {
    (void)state;
    static const double COSINE = 0.8, SINE = 0.6;
    struct folded f;
    double force[FACE_VALUES];
    open_fold(&f, NODES, 1, 1.3);
    rub(&f, 0.1);
    (void)find(&f);
    memcpy(force, f.force, sizeof force);
    for (size_t node = FIRST - 2; node < FIRST + 2 * DEEP + 3; node++) {
        double x = (double)node + f.u[2 * node] - FIRST,
               y = f.mesh->height[node] + f.u[2 * node + 1];
        f.u[2 * node] = COSINE * x - SINE * y + FIRST - (double)node;
        f.u[2 * node + 1] = SINE * x + COSINE * y - f.mesh->height[node];
    }
    (void)find(&f);
    double most = 0;
    for (size_t i = FIRST; i < FIRST + 2 * DEEP + 1; i++) {
        check_close(f.force[2 * i], COSINE * force[2 * i] - SINE * force[2 * i + 1], 1e-9);
        check_close(f.force[2 * i + 1], SINE * force[2 * i] + COSINE * force[2 * i + 1], 1e-9);
        most = fmax(most, fabs(force[2 * i + 1]));
    }
    assert_true(most > 0.1);
    close_fold(&f);
}

static void forces_balance_and_become_multipliers(void **state) {
    (void)state;
    struct folded f, across;
    open_fold(&f, NODES, 1, 1.3);
    open_fold(&across, NODES, 1, 1.3);
    fold(&f, FIRST, -0.3, 1);
    fold(&across, FIRST + 12, -0.3, 1);
    self_contact_search(&f.self, f.u, f.active);
    self_contact_search(&across.self, across.u, across.active);
    check_relative(find(&across), find(&f), 1e-12);
    double x = 0, y = 0, most = 0;
    for (size_t i = 0; i < NODES; i++) {
        x += f.force[2 * i];
        y += f.force[2 * i + 1];
        most = fmax(most, fabs(f.force[2 * i]));
        for (size_t k = 0; k < 2; k++)
            check_close(across.force[2 * ((i + 12) % NODES) + k], f.force[2 * i + k], 1e-10);
    }
    assert_true(most > 1);
    check_close(x, 0, 1e-12 * most);
    check_close(y, 0, 1e-12 * most);
    double first = 0, second = 0;
    for (size_t c = 0; c < f.self.count; c++)
        first = fmax(first, f.self.pair[c].force);
    check_relative(self_contact_renew(&f.self, f.u, f.active), first, 1e-9);
    (void)find(&f);
    for (size_t c = 0; c < f.self.count; c++)
        second = fmax(second, f.self.pair[c].force);
    check_relative(second, 2 * first, 1e-9);
    close_fold(&f);
    close_fold(&across);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(flanks_meet_across_air_alone),
        cmocka_unit_test(nodes_do_not_meet_their_own_flank),
        cmocka_unit_test(lips_on_the_flat_meet),
        cmocka_unit_test(forces_and_tangent_are_derivatives),
        cmocka_unit_test(friction_follows_coulomb_and_its_tangent),
        cmocka_unit_test(forces_turn_with_the_face),
        cmocka_unit_test(forces_balance_and_become_multipliers),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
