/* Protects the active set of the full model: one answer from whatever set it starts, sets that come
 * back are taken apart, one node at least carries the load, and what a failure leaves. */
#include "tests/support/check.h"

#include "core/full/newton.h"
#include "core/random.h"
#include <stdlib.h>
#include <string.h>

struct equilibrium_work {
    struct mesh *mesh;
    struct newton newton;
    double *z;
};

/* Random heights, up to `rough` steps from their mean. */
static void open_work(struct equilibrium_work *w, struct grid grid, enum gap_weighting weighting,
                      double rough) {
    struct error err = {0};
    struct block block = {.poisson = 0.3, .height = 6 * grid_dx(&grid), .layer_growth = 1.3};
    struct material material = material_of(block.poisson, KINEMATICS_HENCKY);
    double mean = 0, highest = -INFINITY;
    *w = (struct equilibrium_work){0};
    if (mesh_create(&w->mesh, &grid, &block, INFINITY, &err) != 0 ||
        newton_create(&w->newton, w->mesh, &material, weighting, SOLVER_ITERATED, &err) != 0)
        fail_msg("%s", err.text);
    size_t face = w->mesh->face;
    w->z = array_create(face, sizeof *w->z);
    assert_non_null(w->z);
    random_uniform((struct random_key){.seed = 8}, 0, 0, face, w->z);
    for (size_t i = 0; i < face; i++)
        mean += w->z[i] / (double)face;
    for (size_t i = 0; i < face; i++) {
        w->z[i] = rough * (w->z[i] - mean);
        highest = fmax(highest, w->z[i]);
    }
    if (mesh_shape(w->mesh, w->z, &err) != 0)
        fail_msg("%s", err.text);
    w->newton.flat_height = -highest;
    w->newton.tolerance = 1e-10;
    w->newton.max_iterations = 200;
}

static void close_work(struct equilibrium_work *w) {
    newton_clear(&w->newton);
    mesh_destroy(&w->mesh);
    free(w->z);
}

/* From rest, with a set of its own: none, all, every other node, a random half. */
static void start(struct equilibrium_work *w, int which) {
    struct newton *n = &w->newton;
    double draw[64];
    assert_true(w->mesh->face <= 64);
    random_uniform((struct random_key){.seed = 9, .realisation = (uint64_t)which}, 0, 0, 64, draw);
    memset(n->u, 0, mesh_degrees_of_freedom(w->mesh) * sizeof *n->u);
    n->evaluated = false;
    for (size_t i = 0; i < w->mesh->face; i++)
        n->active[i] = which == 1 || (which == 2 && i % 2 == 0) || (which > 2 && draw[i] < 0.5);
}

/* The conditions of contact, to the tolerance. */
static void check_contact(struct equilibrium_work *w, double pressure) {
    struct newton *n = &w->newton;
    double sum = 0, most = 0;
    newton_measure_gaps(n);
    for (size_t i = 0; i < w->mesh->face; i++)
        most = fmax(most, fabs(n->force[mesh_vertical(w->mesh, i)]));
    for (size_t i = 0; i < w->mesh->face; i++) {
        double force = n->force[mesh_vertical(w->mesh, i)];
        sum += force;
        check_close(n->active[i] ? n->opening[i] : force, 0, 2e-10 * most);
        assert_true(n->active[i] ? force > -2e-10 * most : n->opening[i] > -2e-10 * most);
    }
    check_relative(sum, pressure * newton_node_area(n) * (double)w->mesh->face, 1e-8);
}

static void every_start_ends_at_the_same_set(void **state) {
    (void)state;
    static const struct grid GRIDS[] = {{48, 1, 1, 1}, {8, 8, 1, 1}};
    for (size_t c = 0; c < 4; c++) {
        struct equilibrium_work w;
        struct newton_end end;
        struct error err = {0};
        double force[64] = {0};
        open_work(&w, GRIDS[c % 2], c < 2 ? GAP_DUAL : GAP_STANDARD, 0.05);
        for (double pressure = 1e-4; pressure < 0.02; pressure *= 10)
            for (int which = 0; which < 12; which++) {
                start(&w, which);
                if (newton_solve(&w.newton, pressure, &end, &err) != 0)
                    fail_msg("start %d, pressure %g: %s", which, pressure, err.text);
                check_contact(&w, pressure);
                for (size_t i = 0; i < w.mesh->face; i++) {
                    double now = w.newton.force[mesh_vertical(w.mesh, i)];
                    if (which > 0)
                        check_close(now, force[i], 1e-7 * pressure * (double)w.mesh->face);
                    force[i] = now;
                }
            }
        close_work(&w);
    }
}

/* All nodes at once of a rough surface: a set comes back, and the answer is that of rising loads.
 */
static void a_set_that_comes_back_is_taken_apart(void **state) {
    (void)state;
    for (int weighting = 0; weighting < 2; weighting++) {
        struct equilibrium_work w;
        struct newton_end end = {0};
        struct error err = {0};
        double force[64];
        open_work(&w, (struct grid){8, 8, 1, 1}, weighting ? GAP_STANDARD : GAP_DUAL, 0.2);
        for (int which = 0; which < 2; which++) {
            start(&w, which);
            for (double load = which == 1 ? 0.081 : 0.003; load < 0.1; load *= 3)
                if (newton_solve(&w.newton, load, &end, &err) != 0)
                    fail_msg("start %d, load %g: %s", which, load, err.text);
            check_contact(&w, 0.081);
            assert_int_equal(end.cycles, which);
            for (size_t i = 0; i < 64; i++) {
                double now = w.newton.force[mesh_vertical(w.mesh, i)];
                if (which == 1)
                    check_close(now, force[i], 1e-8);
                force[i] = now;
            }
        }
        close_work(&w);
    }
}

static void a_load_that_is_too_great_fails_clearly(void **state) {
    (void)state;
    struct equilibrium_work w;
    struct newton_end end;
    struct error err = {0};
    open_work(&w, (struct grid){16, 1, 1, 1}, GAP_DUAL, 0.05);
    start(&w, 1);
    assert_int_equal(newton_solve(&w.newton, 1e6, &end, &err), ERROR_NUMERIC);
    assert_true(strlen(err.text) > 0);
    w.newton.max_iterations = 1;
    start(&w, 1);
    assert_int_equal(newton_solve(&w.newton, 0.01, &end, &err), ERROR_NUMERIC);
    assert_non_null(strstr(err.text, "1 iterations"));
    close_work(&w);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_start_ends_at_the_same_set),
        cmocka_unit_test(a_set_that_comes_back_is_taken_apart),
        cmocka_unit_test(a_load_that_is_too_great_fails_clearly),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
