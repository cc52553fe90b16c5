/* Protects: each scan line loses its own mean, median or polynomial and nothing else, along either
 * axis, beside holes and where heights are few; the RMS of what was subtracted is stated. */
#include "core/map/preparation/scan_lines.h"
#include "tests/support/check.h"
#include <stdlib.h>

enum { NX = 50, NY = 40 };
static const struct grid GRID = {NX, NY, NX, NY};

/* What a line along x has of its own: offset, tilt and bow. */
static double offset(size_t j) {
    return 7 + 3 * sin(1.7 * (double)(j * j));
}
static double along(enum scan_lines kind, size_t i, size_t j) {
    const double u = (double)i / NX;
    return kind == SCAN_LINES_LINEAR ? offset(j) + cos((double)j) * u
           : kind == SCAN_LINES_QUADRATIC
               ? offset(j) + cos((double)j) * u + sin(3.0 * (double)j) * u * u
               : offset(j);
}
static double rough(size_t i, size_t j) {
    return 0.3 * sin(0.9 * (double)i + 0.4 * (double)j) + 0.1 * cos(2.3 * (double)i);
}

/* Lines along x, or the same along y. */
static void fill(double *z, enum scan_lines kind, enum scan_axis axis, bool lines) {
    for (size_t j = 0; j < NY; j++)
        for (size_t i = 0; i < NX; i++)
            z[axis == SCAN_ALONG_X ? j * NX + i : i * NY + j] =
                rough(i, j) + (lines ? along(kind, i, j) : 0);
}

/* What is subtracted from the lines does not depend on what they had. */
static void lines_lose_what_is_their_own(void **state) {
    (void)state;
    static double z[NX * NY], clean[NX * NY];
    for (int axis = 0; axis < 2; axis++)
        for (int kind = SCAN_LINES_MEAN; kind <= SCAN_LINES_QUADRATIC; kind++) {
            const struct grid grid = axis == SCAN_ALONG_X ? GRID : (struct grid){NY, NX, NY, NX};
            struct scan_lines_result done, of_clean;
            fill(z, (enum scan_lines)kind, (enum scan_axis)axis, true);
            fill(clean, (enum scan_lines)kind, (enum scan_axis)axis, false);
            for (size_t hole = 3; hole < (size_t)NX * NY; hole += 61)
                z[hole] = clean[hole] = (double)NAN;
            assert_int_equal(scan_lines_level(&grid, z, (enum scan_lines)kind, (enum scan_axis)axis,
                                              &done, NULL),
                             0);
            assert_int_equal(scan_lines_level(&grid, clean, (enum scan_lines)kind,
                                              (enum scan_axis)axis, &of_clean, NULL),
                             0);
            for (size_t point = 0; point < (size_t)NX * NY; point++) {
                assert_true(isnan(z[point]) == (point % 61 == 3));
                if (!isnan(z[point]))
                    check_close(z[point], clean[point], 1e-12);
            }
            assert_int_equal(done.lines, NY);
            assert_true(of_clean.rms < 0.1 && of_clean.rms > 0); /* a part of rough() */
            assert_true(done.rms > 1.5 && done.rms < 3 && done.share > 0.97 && done.share < 1);
        }
}

/* The median leaves the other heights of a line with a scratch as they are; the mean does not. */
static void a_scratch_bends_the_mean_alone(void **state) {
    (void)state;
    for (int kind = SCAN_LINES_MEAN; kind <= SCAN_LINES_MEDIAN; kind++) {
        double z[NX];
        const struct grid grid = {NX, 1, NX, NX};
        struct scan_lines_result done;
        for (size_t i = 0; i < NX; i++)
            z[i] = i < 10 ? -100 : 5 + 0.01 * (double)(i % 2);
        assert_int_equal(
            scan_lines_level(&grid, z, (enum scan_lines)kind, SCAN_ALONG_X, &done, NULL), 0);
        assert_true((fabs(z[30]) < 0.011) == (kind == SCAN_LINES_MEDIAN));
        assert_int_equal(done.lines, 1);
        check_close(done.rms, 0, 1e-5); /* a constant, to the rounding of squares */
    }
}

/* Lines of none, one, two and three heights. */
static void few_heights_lose_a_lower_degree(void **state) {
    (void)state;
    double z[4 * 4];
    const struct grid grid = {4, 4, 4, 4};
    struct scan_lines_result done;
    for (size_t point = 0; point < 16; point++)
        z[point] = point % 4 < point / 4 ? 1 + (double)(point * point) : (double)NAN;
    assert_int_equal(scan_lines_level(&grid, z, SCAN_LINES_QUADRATIC, SCAN_ALONG_X, &done, NULL),
                     0);
    for (size_t point = 0; point < 16; point++)
        if (point % 4 < point / 4)
            check_close(z[point], 0, 1e-9);
        else
            assert_true(isnan(z[point]));
    assert_int_equal(done.lines, 3);
}

static void level_heights_have_no_share(void **state) {
    (void)state;
    double z[6] = {2, 2, 2, 2, 2, 2};
    const struct grid grid = {3, 2, 3, 2};
    struct scan_lines_result done;
    assert_int_equal(scan_lines_level(&grid, z, SCAN_LINES_MEAN, SCAN_ALONG_X, &done, NULL), 0);
    assert_true(z[0] == 0 && z[5] == 0 && done.rms == 0 && isnan(done.share));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(lines_lose_what_is_their_own),
        cmocka_unit_test(a_scratch_bends_the_mean_alone),
        cmocka_unit_test(few_heights_lose_a_lower_degree),
        cmocka_unit_test(level_heights_have_no_share),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
