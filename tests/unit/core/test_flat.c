/* Protects what the full model's equations are solved with: the flat block's stiffness inverted by
 * waves, the forces that hold its face, and the iterations that these precondition; each against
 * the assembled stiffness itself. And the mesh that they stand on. */
#include "tests/support/check.h"

#include "core/full/krylov.h"
#include "core/random.h"
#include <stdlib.h>
#include <string.h>

static const struct grid GRIDS[] = {{8, 1, 8, 1}, {7, 1, 3, 1}, {2, 1, 1, 1},
                                    {6, 5, 6, 7}, {4, 8, 2, 2}, {2, 2, 1, 1}};
enum { GRIDS_COUNT = 6 };

struct work {
    struct mesh *mesh;
    struct stencil *tangent;
    struct solid solid;
    size_t freedoms;
    double *z, *force, *x, *y;
};

static double *numbers(size_t n) {
    double *x = array_create(n, sizeof *x);
    assert_non_null(x);
    return x;
}

static void fill_random(uint64_t draw, size_t n, double *x) {
    random_uniform((struct random_key){.seed = 6, .realisation = draw}, 0, 0, n, x);
    for (size_t i = 0; i < n; i++)
        x[i] = 2 * x[i] - 1;
}

/* A block of random heights up to rough steps, at rest. */
static void open_work(struct work *w, struct grid grid, double poisson, double growth, double rough,
                      double transition) {
    struct error err = {0};
    struct block block = {.model = MODEL_LAYERED,
                          .poisson = poisson,
                          .height = 4 * grid_dx(&grid),
                          .layer_growth = growth};
    *w = (struct work){.solid = solid_of(poisson, KINEMATICS_HENCKY)};
    if (mesh_create(&w->mesh, &grid, &block, transition, &err) != 0 ||
        stencil_create(&w->tangent, w->mesh, &err) != 0)
        fail_msg("%s", err.text);
    w->freedoms = mesh_freedoms(w->mesh);
    w->z = numbers(w->mesh->face);
    w->force = numbers(w->freedoms);
    w->x = numbers(w->freedoms);
    w->y = numbers(w->freedoms);
    fill_random(1, w->mesh->face, w->z);
    for (size_t i = 0; i < w->mesh->face; i++)
        w->z[i] *= rough;
    if (mesh_shape(w->mesh, w->z, &err) != 0)
        fail_msg("%s", err.text);
    assert_true(stencil_evaluate(w->mesh, &w->solid, w->x, NULL, w->y, w->tangent));
}

static void close_work(struct work *w) {
    stencil_destroy(&w->tangent);
    mesh_destroy(&w->mesh);
    free(w->z);
    free(w->force);
    free(w->x);
    free(w->y);
}

/* The far side's vertical rows become their sum at its first node. */
static void sum_far_side(const struct mesh *mesh, double *forces) {
    double sum = 0;
    for (size_t node = mesh_far_side(mesh); node < mesh->nodes; node++) {
        sum += forces[mesh_vertical(mesh, node)];
        forces[mesh_vertical(mesh, node)] = 0;
    }
    forces[mesh_vertical(mesh, mesh_far_side(mesh))] = sum;
}

/* Forces that no side has to carry: each component's sum is 0. */
static void fill_balanced(uint64_t draw, const struct mesh *mesh, double *forces) {
    size_t d = (size_t)mesh->dimension;
    fill_random(draw, mesh_freedoms(mesh), forces);
    sum_far_side(mesh, forces);
    for (size_t axis = 0; axis < d; axis++) {
        double sum = 0;
        for (size_t node = 0; node < mesh->nodes; node++)
            sum += forces[node * d + axis];
        forces[axis] -= sum;
    }
}

/* Bound: rounding times the condition, up to 1e7 by lambda/mu; at nu = 0.3 1e-13 is seen. */
static void waves_invert_the_flat_block(void **state) {
    (void)state;
    static const double POISSON[] = {0, 0.3, 0.4999};
    for (size_t c = 0; c < 3 * GRIDS_COUNT; c++) {
        struct work w;
        struct error err = {0};
        struct flat *flat = NULL;
        open_work(&w, GRIDS[c % GRIDS_COUNT], POISSON[c / GRIDS_COUNT], 1.3, 0, INFINITY);
        assert_int_equal(flat_create(&flat, w.mesh, &w.solid, &err), 0);
        size_t face = w.mesh->face, far_side = mesh_far_side(w.mesh);
        double *vertical = numbers(face), *nothing = numbers(face);
        fill_balanced(c, w.mesh, w.force);
        flat_load(flat, w.force);
        flat_face(flat, vertical);
        flat_displace(flat, nothing, w.x);
        stencil_apply(w.tangent, w.x, w.y);
        sum_far_side(w.mesh, w.y);
        for (size_t f = 0; f < w.freedoms; f++)
            check_close(w.y[f], w.force[f], 1e-8);
        for (size_t node = 0; node < face; node++) {
            check_close(vertical[node], w.x[mesh_vertical(w.mesh, node)], 1e-8);
            check_close(w.x[mesh_vertical(w.mesh, far_side + node)],
                        w.x[mesh_vertical(w.mesh, far_side)], 1e-10);
        }
        free(vertical);
        free(nothing);
        flat_destroy(&flat);
        close_work(&w);
    }
}

/* Rows of forces where free, of the weighted face where held, on a rough block. */
static void check_solution(struct work *w, const struct krylov *krylov, const bool *active,
                           double tolerance) {
    size_t face = w->mesh->face;
    double *vertical = numbers(face), square = 0, first = 0;
    stencil_apply(w->tangent, w->x, w->y);
    sum_far_side(w->mesh, w->y);
    for (size_t node = 0; node < face; node++)
        vertical[node] = w->x[mesh_vertical(w->mesh, node)];
    krylov_weigh(krylov, vertical, vertical);
    for (size_t node = 0; node < face; node++)
        if (active[node])
            w->y[mesh_vertical(w->mesh, node)] = vertical[node];
    for (size_t f = 0; f < w->freedoms; f++) {
        square += (w->y[f] - w->force[f]) * (w->y[f] - w->force[f]);
        first += w->force[f] * w->force[f];
    }
    /* Twice, for the rounding of the recurrence. */
    assert_true(sqrt(square) <= 2 * tolerance * sqrt(first));
    free(vertical);
}

static void rough_blocks_are_solved(void **state) {
    (void)state;
    static const double TOLERANCE = 1e-9;
    for (size_t c = 0; c < 8 * GRIDS_COUNT; c++) {
        struct work w;
        struct error err = {0};
        struct krylov *krylov = NULL;
        struct factor *factor = NULL;
        const struct grid *grid = &GRIDS[c % GRIDS_COUNT];
        enum gap_weighting weighting = c / GRIDS_COUNT % 2 == 0 ? GAP_DUAL : GAP_STANDARD;
        bool factored = c / GRIDS_COUNT / 2 % 2 == 1, *active;
        size_t spacing = c / GRIDS_COUNT / 4 == 0 ? 3 : 1, iterations = 0;
        open_work(&w, *grid, 0.3, 1.3, 0.1, INFINITY);
        assert_int_equal(krylov_create(&krylov, w.mesh, &w.solid, weighting, &err), 0);
        assert_int_equal(factor_create(&factor, w.mesh, &err), 0);
        active = array_create(w.mesh->face, sizeof *active);
        assert_non_null(active);
        for (size_t node = 0; node < w.mesh->face; node += spacing)
            active[node] = true;
        assert_int_equal(factor_run(factor, w.tangent, active, &err), 0);
        fill_balanced(c, w.mesh, w.force);
        memcpy(w.x, w.force, w.freedoms * sizeof *w.x);
        struct equations equations = {
            .tangent = w.tangent, .active = active, .factor = factored ? factor : NULL};
        if (krylov_solve(krylov, &equations, TOLERANCE, w.x, &iterations, &err) != 0)
            fail_msg("%s", err.text);
        check_solution(&w, krylov, active, TOLERANCE);
        assert_in_range(iterations, 1, factored && weighting == GAP_DUAL ? 2 : 40);
        free(active);
        factor_destroy(&factor);
        krylov_destroy(&krylov);
        close_work(&w);
    }
}

/* A uniform vertical stretch is in balance within a rough mesh: the patch test of all its elements,
 * the periodic sides with them. */
static void a_rough_mesh_passes_the_patch_test(void **state) {
    (void)state;
    for (size_t c = 0; c < GRIDS_COUNT; c++) {
        struct work w;
        open_work(&w, GRIDS[c], 0.3, 1.3, 0.2, INFINITY);
        const struct mesh *mesh = w.mesh;
        for (size_t node = 0; node < mesh->nodes; node++)
            w.x[mesh_vertical(mesh, node)] = -0.1 * mesh->height[node];
        assert_true(stencil_evaluate(mesh, &w.solid, w.x, NULL, w.y, NULL));
        size_t d = (size_t)mesh->dimension;
        for (size_t f = mesh->face * d; f < (mesh_far_side(mesh)) * d; f++)
            check_close(w.y[f], 0, 1e-13);
        assert_true(mesh->quality > 0.6 && mesh->quality < 1);
        close_work(&w);
    }
}

static void bad_meshes_are_refused(void **state) {
    (void)state;
    struct work w;
    struct mesh *mesh = NULL;
    struct error err = {0};
    struct grid grid = {8, 1, 8, 1};
    struct block block = {.poisson = 0.3, .height = 0, .layer_growth = 1.2};
    assert_int_equal(mesh_create(&mesh, &grid, &block, INFINITY, &err), ERROR_INPUT);
    assert_non_null(strstr(err.text, "block height"));
    block.height = 1e9;
    block.layer_growth = 1;
    assert_int_equal(mesh_create(&mesh, &grid, &block, INFINITY, &err), ERROR_INPUT);
    assert_null(mesh);
    open_work(&w, grid, 0.3, 1.3, 0, INFINITY);
    w.z[3] = 7; /* steeper than any mesh */
    assert_int_equal(mesh_shape(w.mesh, w.z, &err), ERROR_INPUT);
    assert_non_null(strstr(err.text, "steepest slope"));
    for (size_t i = 0; i < 8; i++) /* gentle, but a valley deeper than the block is high */
        w.z[i] = -5 * cos(M_PI * (double)i / 4);
    w.z[0] = -5;
    assert_int_equal(mesh_shape(w.mesh, w.z, &err), ERROR_INPUT);
    assert_non_null(strstr(err.text, "too high for a block"));
    w.z[3] = NAN;
    assert_int_equal(mesh_shape(w.mesh, w.z, &err), ERROR_INPUT);
    close_work(&w);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(waves_invert_the_flat_block),
        cmocka_unit_test(rough_blocks_are_solved),
        cmocka_unit_test(a_rough_mesh_passes_the_patch_test),
        cmocka_unit_test(bad_meshes_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
