/* Scalars of realisations: kept in order whatever the order of arrival, overlaps refused. */
#include "jobs/realisations.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static int add(struct realisations *set, uint64_t first, uint64_t count, struct error *err) {
    double scalars[40];
    for (uint64_t r = 0; r < count; r++) {
        scalars[2 * r] = (double)(first + r);
        scalars[2 * r + 1] = -(double)(first + r);
    }
    const struct block_result result = {
        .first = first, .count = count, .scalar_count = 2, .scalars = scalars};
    int status = realisations_check(set, &result, err);
    return status != 0 ? status : realisations_add(set, &result, err);
}

static void order_of_arrival(void **state) {
    (void)state;
    static const uint64_t orders[4][4] = {{0, 1, 2, 3}, {3, 2, 1, 0}, {2, 0, 3, 1}, {1, 3, 0, 2}};
    static const uint64_t first[] = {0, 5, 9, 30}, count[] = {5, 1, 7, 2};
    for (int trial = 0; trial < 4; trial++) {
        struct realisations set = {.scalar_count = 2};
        double column[15];
        for (int a = 0; a < 4; a++)
            assert_int_equal(add(&set, first[orders[trial][a]], count[orders[trial][a]], NULL), 0);
        assert_int_equal(set.count, 15);
        realisations_column(&set, 1, column);
        assert_true(column[0] == 0 && column[5] == -5 && column[6] == -9 && column[14] == -31);
        for (int r = 1; r < 15; r++)
            assert_true(column[r] < column[r - 1]);
        realisations_clear(&set);
    }
}

static void overlaps(void **state) {
    (void)state;
    struct realisations set = {.scalar_count = 2};
    struct error err = {0};
    assert_int_equal(add(&set, 10, 5, &err), 0);
    assert_int_equal(add(&set, 20, 5, &err), 0);
    static const uint64_t bad[][2] = {{10, 5}, {9, 2}, {14, 1}, {14, 6}, {19, 2}, {0, 20}, {24, 9}};
    for (size_t a = 0; a < sizeof bad / sizeof *bad; a++) {
        assert_int_equal(add(&set, bad[a][0], bad[a][1], &err), ERROR_INPUT);
        assert_non_null(strstr(err.text, "is there already"));
    }
    assert_int_equal(add(&set, 15, 5, &err), 0); /* exactly the gap */
    assert_int_equal(add(&set, 25, 1, &err), 0);
    assert_int_equal(add(&set, 9, 1, &err), 0);
    assert_int_equal(set.count, 17);
    assert_int_equal(add(&set, UINT64_MAX - 1, 1, &err), 0);
    assert_int_equal(add(&set, UINT64_MAX, 1, &err), ERROR_INPUT);
    assert_int_equal(add(&set, 3, 0, &err), ERROR_INPUT);
    realisations_clear(&set);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(order_of_arrival),
                                       cmocka_unit_test(overlaps)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
