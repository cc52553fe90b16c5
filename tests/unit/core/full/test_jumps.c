/* Protects jumps of the model full: equilibrium without drag is tried once the drag is small over
 * the mean force of a node, whatever the area of a node. */
#include "tests/support/check.h"

#include "core/full/full.h"
#include <stdlib.h>
#include <string.h>

enum { NX = 8, NY = 4, NODES = NX * NY };

/* What stop sees before each iteration. */
struct seen {
    const struct full *full;
    double *anchor; /* of the last iteration under drag */
    double drag;    /* likewise; 0: the last one was without */
    double force;   /* largest of a drag on a degree of freedom where one without is tried */
    size_t tries;
};

static int see(void *context) {
    struct seen *seen = context;
    const struct newton *n = full_newton(seen->full);
    const size_t count = mesh_degrees_of_freedom(n->mesh);
    if (n->drag == 0 && seen->drag > 0) {
        /* The last round has ended where this solution begins. */
        seen->force =
            fmax(seen->force, mesh_largest_move(n->mesh, n->u, seen->anchor) * seen->drag);
        seen->tries++;
    }
    if (n->drag > 0)
        memcpy(seen->anchor, n->anchor, count * sizeof *seen->anchor);
    seen->drag = n->drag;
    return 0;
}

/* An iteration is too few for the usual steps, so that the face goes on in jumps. dy/dx is
 * 1/50: with the force over the pressure alone the drags were fifty times as large. */
static void small_drags_are_those_over_the_force_of_a_node(void **state) {
    (void)state;
    static const double ACROSS = 0.02, LOAD = 0.05;
    struct grid grid = {NX, NY, 1, ACROSS * NY / NX};
    struct block block = {.poisson = 0.3, .height = 1, .layer_growth = 1.5, .weighting = GAP_DUAL};
    struct full_options options = FULL_DEFAULTS;
    struct contact_state pressed;
    struct full_report report;
    struct seen seen = {0};
    struct error err = {0};
    double z[NODES];
    options.max_iterations = 1;
    options.least_step = 1;
    options.tolerance = 1e-6;
    for (size_t i = 0; i < NODES; i++)
        z[i] = 0.1 * cos(2 * M_PI * (double)(i % NX) / NX);
    struct full *full = NULL;
    if (full_create(&full, &grid, &block, &options, &err) != 0 || full_begin(full, z, &err) != 0)
        fail_msg("%s", err.text);
    seen.full = full;
    seen.anchor = array_create(mesh_degrees_of_freedom(full_mesh(full)), sizeof *seen.anchor);
    assert_non_null(seen.anchor);
    full_set_stop(full, see, &seen);
    if (full_press(full, LOAD, &pressed, &report, &err) != 0)
        fail_msg("%s", err.text);
    double over = seen.force / (LOAD * full_mesh(full)->across);
    print_message("%zu jumps, %zu tries without drag, the largest from %.2g of the mean force\n",
                  report.jumps, seen.tries, over);
    assert_true(report.jumps > 0 && seen.tries > 0);
    assert_true(over <= 0.01 * (1 + 1e-9));
    free(seen.anchor);
    full_destroy(&full);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(small_drags_are_those_over_the_force_of_a_node),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
