/* Protects: the continuation of residuals by a pyramid keeps what is known, does not depend on
 * where the set lies by more than its cells, and its transpose is one, of any grid: else conjugate
 * gradients, which it preconditions, would not converge. */
#include "core/contact/solver/pyramid.h"
#include "tests/support/check.h"
#include "tests/support/seed.h"
#include <math.h>
#include <string.h>

static const struct grid GRIDS[] = {{16, 16, 1, 1}, {9, 14, 1, 1}, {2, 3, 1, 1}, {30, 6, 1, 1},
                                    {7, 1, 1, 1},   {1, 5, 1, 1},  {1, 1, 1, 1}, {64, 3, 1, 1}};
enum { MOST = 300, COUNT = sizeof GRIDS / sizeof *GRIDS };

/* Values of -1 to 1 in so much of the grid, 0 elsewhere. */
static void draw(size_t n, double part, uint64_t *state, double *r) {
    for (size_t i = 0; i < n; i++) {
        double in = ldexp((double)(next_word(state) >> 11), -53);
        double value = ldexp((double)(next_word(state) >> 11), -52) - 1;
        r[i] = in < part ? value : 0;
    }
}

static double product(size_t n, const double *a, const double *b) {
    double sum = 0;
    for (size_t i = 0; i < n; i++)
        sum += a[i] * b[i];
    return sum;
}

/* (E r).y = r.(E^T y), and E r is r in the set, for sparse sets and dense ones. */
static void the_transpose_is_one(void **state) {
    (void)state;
    static const double PARTS[] = {0.02, 0.3, 1};
    uint64_t words = seed_of_now();
    for (size_t g = 0; g < COUNT; g++)
        for (size_t p = 0; p < 3; p++) {
            const size_t N = grid_points(&GRIDS[g]);
            double r[MOST], x[MOST], y[MOST] = {0}, back[MOST];
            struct pyramid pyramid;
            assert_true(N <= MOST);
            assert_int_equal(pyramid_create(&pyramid, &GRIDS[g], NULL), 0);
            draw(N, PARTS[p], &words, r);
            draw(N, 1, &words, y);
            memcpy(back, y, sizeof back);
            pyramid_set(&pyramid, r);
            pyramid_continue(&pyramid, r, x);
            pyramid_transpose(&pyramid, r, back);
            for (size_t i = 0; i < N; i++)
                if (r[i] != 0)
                    assert_true(x[i] == r[i]);
            check_close(product(N, x, y), product(N, r, back), 1e-13 * (double)N);
            pyramid_clear(&pyramid);
        }
}

/* Of one known node, values fall off with the distance, to all sides alike. */
static void values_fall_off(void **state) {
    (void)state;
    enum { SIDE = 16, AT = 8 };
    static const struct grid GRID = {SIDE, SIDE, 1, 1};
    double r[SIDE * SIDE] = {0}, x[SIDE * SIDE];
    struct pyramid pyramid;
    assert_int_equal(pyramid_create(&pyramid, &GRID, NULL), 0);
    r[AT * SIDE + AT] = 1;
    pyramid_set(&pyramid, r);
    pyramid_continue(&pyramid, r, x);
    for (size_t i = 0; i < SIDE; i++) {
        check_close(x[AT * SIDE + i], x[i * SIDE + AT], 1e-15);
        assert_true(x[i * SIDE + i] >= 0 && x[i * SIDE + i] <= 1);
    }
    assert_true(x[AT * SIDE + AT] > x[AT * SIDE + AT + 1]);
    assert_true(x[AT * SIDE + AT + 1] > x[AT * SIDE + AT + 3]);
    assert_true(x[AT * SIDE + AT + 3] > x[AT * SIDE]);
    pyramid_clear(&pyramid);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_transpose_is_one),
        cmocka_unit_test(values_fall_off),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
