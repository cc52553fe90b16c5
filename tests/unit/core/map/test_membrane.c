/* Protects: holes are filled with the heights that solve Laplace's equation between their rims,
 * whatever the shape and size of the hole, and no other height changes. */
#include "core/map/preparation/membrane.h"
#include "tests/support/check.h"
#include "tests/support/seed.h"
#include <stdlib.h>
#include <string.h>

enum { NX = 97, NY = 64 };

/* Solves the equation of five points with spacing dx, dy exactly, as every quadratic harmonic
 * polynomial does. */
static double harmonic(double x, double y) {
    return 1e3 + 3 * x - 2 * y + 0.7 * x * y + 0.4 * (x * x - y * y);
}

/* Returns whether a point is in a hole of this kind: 0 single points, 1 one large hole with
 * islands, 2 stripes, 3 random points. */
static bool is_hole(int kind, size_t i, size_t j, uint64_t *state) {
    const double x = (double)i - 45, y = (double)j - 30;
    if (i == 0 || j == 0 || i == NX - 1 || j == NY - 1)
        return false;
    if (kind == 0)
        return i % 7 == 3 && j % 5 == 2;
    if (kind == 1)
        return x * x / 3 + y * y < 600 && !(i % 23 == 0 && j % 9 == 0);
    if (kind == 2)
        return j % 4 != 0;
    return next_word(state) % 5 < 2;
}

static void a_harmonic_map_is_found_again(void **state) {
    (void)state;
    const struct grid grid = {NX, NY, NX * 0.5, NY * 0.25};
    uint64_t seed = seed_or(11);
    double *z = array_create((size_t)NX * NY, sizeof *z);
    assert_non_null(z);
    for (int kind = 0; kind < 4; kind++) {
        size_t holes = 0;
        for (size_t j = 0; j < NY; j++)
            for (size_t i = 0; i < NX; i++) {
                bool hole = is_hole(kind, i, j, &seed);
                holes += hole ? 1 : 0;
                z[j * NX + i] = hole ? (double)NAN : harmonic(0.5 * (double)i, 0.25 * (double)j);
            }
        assert_true(holes > 100);
        assert_int_equal(membrane_fill(&grid, z, BOUNDARY_OPEN, NULL), 0);
        for (size_t point = 0; point < (size_t)NX * NY; point++) {
            const size_t i = point % NX, j = point / NX;
            double exact = harmonic(0.5 * (double)i, 0.25 * (double)j);
            check_close(z[point], exact, 1e-8);
        }
    }
    free(z);
}

/* A hole at the side of an open map has no slope across it; beyond both ends of a profile heights
 * go on as they are, and between them lie on a line. */
static void sides_are_free(void **state) {
    (void)state;
    double profile[10] = {(double)NAN, (double)NAN, 2, (double)NAN, (double)NAN,
                          (double)NAN, 6,           7, (double)NAN, (double)NAN};
    static const double FREE[10] = {2, 2, 2, 3, 4, 5, 6, 7, 7, 7};
    static const double ROUND[10] = {4, 3, 2, 3, 4, 5, 6, 7, 6, 5};
    double again[10];
    memcpy(again, profile, sizeof again);
    const struct grid grid = {10, 1, 10, 1};
    assert_int_equal(membrane_fill(&grid, profile, BOUNDARY_OPEN, NULL), 0);
    assert_int_equal(membrane_fill(&grid, again, BOUNDARY_PERIODIC, NULL), 0);
    for (size_t i = 0; i < 10; i++) {
        check_close(profile[i], FREE[i], 1e-11);
        check_close(again[i], ROUND[i], 1e-11);
    }
}

/* Heights of a filled map are the mean of their neighbours, across the sides of a periodic one. */
static void every_filled_height_is_a_mean(void **state) {
    (void)state;
    enum { N = 50, M = 33 };
    const struct grid grid = {N, M, N, M};
    uint64_t seed = seed_or(12);
    double z[N * M];
    bool hole[N * M];
    for (size_t point = 0; point < (size_t)N * M; point++) {
        z[point] = (double)(next_word(&seed) >> 11) * 0x1p-53;
        hole[point] = next_word(&seed) % 10 < 7;
        z[point] = hole[point] ? (double)NAN : z[point];
    }
    assert_int_equal(membrane_fill(&grid, z, BOUNDARY_PERIODIC, NULL), 0);
    for (size_t j = 0; j < M; j++)
        for (size_t i = 0; i < N; i++)
            if (hole[j * N + i]) {
                double mean = (z[j * N + (i + 1) % N] + z[j * N + (i + N - 1) % N] +
                               z[(j + 1) % M * N + i] + z[(j + M - 1) % M * N + i]) /
                              4;
                check_close(z[j * N + i], mean, 1e-10);
            }
}

static void heights_stay_bit_for_bit(void **state) {
    (void)state;
    enum { N = 20 };
    const struct grid grid = {N, N, 1e-6, 1e-6};
    double z[N * N], before[N * N];
    for (size_t point = 0; point < (size_t)N * N; point++)
        z[point] = before[point] = point % 9 == 4 ? (double)NAN : 1e-9 * sin((double)point);
    assert_int_equal(membrane_fill(&grid, z, BOUNDARY_OPEN, NULL), 0);
    for (size_t point = 0; point < (size_t)N * N; point++) {
        assert_true(isfinite(z[point]));
        assert_true(isnan(before[point]) || z[point] == before[point]);
    }
    double constant[4] = {5, (double)NAN, (double)NAN, 5};
    assert_int_equal(membrane_fill(&(struct grid){4, 1, 4, 1}, constant, BOUNDARY_OPEN, NULL), 0);
    assert_true(constant[1] == 5 && constant[2] == 5);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_harmonic_map_is_found_again),
        cmocka_unit_test(sides_are_free),
        cmocka_unit_test(every_filled_height_is_a_mean),
        cmocka_unit_test(heights_stay_bit_for_bit),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
