/* Protects: the error of a mesh is reported with a sign only where three levels show the known
 * order, and is covered by its bound wherever it can be. */
#include "core/statistics/uncertainty/richardson.h"
#include "tests/support/check.h"

/* f(h) = c h^q on h = 1, coarse, coarse * fine. */
static struct mesh_changes changes_of(double c, double q, double fine, double coarse) {
    double next = pow(fine, q), third = pow(fine * coarse, q);
    return (struct mesh_changes){c * (1 - next), c * (next - third), fine, coarse};
}

/* The finest level errs by c itself. */
static void clean_orders_are_told_with_a_sign(void **state) {
    (void)state;
    static const double ORDERS[] = {1, 1.5, 2, 2.5}, RATIOS[] = {2, 1.5, 4};
    for (size_t q = 0; q < 4; q++)
        for (size_t r = 0; r < 3; r++) {
            struct mesh_changes changes = changes_of(-0.3, ORDERS[q], RATIOS[r], 2);
            struct mesh_error exact = mesh_error(&changes, ORDERS[q]);
            check_relative(exact.order, ORDERS[q], 1e-12);
            check_relative(exact.error, -0.3, 1e-12);
            check_relative(exact.bound, 0.3, 1e-10); /* the margin is the error itself */
            /* of another order than the known one, within the margin of half an order */
            struct mesh_error near = mesh_error(&changes, ORDERS[q] + 0.4);
            check_relative(near.order, ORDERS[q], 1e-12);
            assert_true(fabs(near.error + 0.3) <= near.bound && near.error < 0);
        }
}

static void other_series_are_bounded_on_both_sides(void **state) {
    (void)state;
    /* order 1/2 where 2 is known; a change of sign; nothing coarser */
    struct mesh_changes slow = changes_of(0.1, 0.5, 2, 2), turn = {0.01, -0.2, 2, 2},
                        two = {0.05, NAN, 2, NAN}, close = {0.05, NAN, 1.25, NAN};
    struct mesh_error error = mesh_error(&slow, 2);
    assert_true(error.error == 0 && isnan(error.order));
    check_relative(error.bound, 1.25 * fabs(slow.fine), 1e-14);
    error = mesh_error(&turn, 1.5);
    assert_true(error.error == 0 && isnan(error.order));
    check_relative(error.bound, 0.2 / 4, 1e-14); /* what the coarser change leaves at order 2 */
    error = mesh_error(&two, 1);
    check_relative(error.bound, 1.25 * 0.05, 1e-14);
    check_relative(error.weight, 1.25, 1e-14);
    error = mesh_error(&close, 1); /* meshes that hardly differ say little */
    check_relative(error.bound, 1.25 * 0.2, 1e-14);
}

static void nothing_known_and_nothing_changed(void **state) {
    (void)state;
    struct mesh_changes none = {NAN, NAN, 2, 2}, same = {0, 0, 2, 2};
    assert_true(isnan(mesh_error(&none, 1).bound));
    struct mesh_error error = mesh_error(&same, 1);
    assert_true(error.error == 0 && error.bound == 0);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(clean_orders_are_told_with_a_sign),
        cmocka_unit_test(other_series_are_bounded_on_both_sides),
        cmocka_unit_test(nothing_known_and_nothing_changed),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
