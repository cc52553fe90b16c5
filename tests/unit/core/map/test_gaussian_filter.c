/* Protects: Gaussian filters leave of each wave what the standard says, half of it at the cut-off,
 * by transforms as by plain sums; sides and holes have no part in the means; robust ones keep
 * clear of spikes. */
#include "core/map/preparation/gaussian_filter.h"
#include "tests/support/check.h"
#include "tests/support/seed.h"
#include <stdlib.h>
#include <string.h>

static const double PI = 3.14159265358979323846, ALPHA = 0.46971863934982566;

static double transmission(double cut_off, double length) {
    return exp(-PI * ALPHA * ALPHA * cut_off * cut_off / (length * length));
}

static double noise(uint64_t *state) {
    return (double)(next_word(state) >> 11) * 0x1p-53 - 0.5;
}

/* Waves along x and y at once are left the product of what each is left. */
static void a_periodic_wave_is_left_exactly(void **state) {
    (void)state;
    enum { N = 60, M = 45 };
    const struct grid grid = {N, M, 12, 9};
    static const double CUT_OFFS[] = {0.5, 2.4, 6, 11};
    double z[N * M], was[N * M];
    for (size_t c = 0; c < 4; c++)
        for (int waves = 1; waves < 6; waves++) {
            struct gaussian_filter filter = {CUT_OFFS[c], true, false, false};
            struct gaussian_filter_result result;
            for (size_t i = 0; i < (size_t)N * M; i++)
                z[i] = was[i] =
                    sin(2 * PI * waves * (double)(i % N) / N) *
                    cos(2 * PI * 2 * waves * ((double)i - (double)(i % N)) / (N * (double)M));
            assert_int_equal(
                gaussian_filter_run(&grid, z, BOUNDARY_PERIODIC, &filter, &result, NULL), 0);
            double left = transmission(filter.cut_off, 12.0 / waves) *
                          transmission(filter.cut_off, 9.0 / (2 * waves));
            for (size_t i = 0; i < (size_t)N * M; i++)
                check_close(z[i], left * was[i], 1e-13);
            memcpy(z, was, sizeof z);
            filter.keeps_long_waves = false;
            assert_int_equal(
                gaussian_filter_run(&grid, z, BOUNDARY_PERIODIC, &filter, &result, NULL), 0);
            for (size_t i = 0; i < (size_t)N * M; i++)
                check_close(z[i], (1 - left) * was[i], 1e-13);
        }
}

/* Far from the sides of an open profile waves are left the same, at the cut-off half of them; long
 * kernels go by transforms, short ones do not. */
static void an_open_wave_is_left_inside(void **state) {
    (void)state;
    enum { N = 4000 };
    static const double CUT_OFFS[] = {5, 10, 60, 150, 400};
    const struct grid grid = {N, 1, N, 1};
    double *z = array_create(N, sizeof *z);
    assert_non_null(z);
    for (size_t c = 0; c < 5; c++)
        for (int part = 1; part <= 3; part++) {
            const struct gaussian_filter filter = {CUT_OFFS[c], true, false, false};
            struct gaussian_filter_result result;
            const double length = CUT_OFFS[c] * part;
            for (size_t i = 0; i < N; i++)
                z[i] = 7 + sin(2 * PI * (double)i / length);
            assert_int_equal(gaussian_filter_run(&grid, z, BOUNDARY_OPEN, &filter, &result, NULL),
                             0);
            check_close(result.transmission, 0.5, 1e-3);
            for (size_t i = 1000; i < N - 1000; i++)
                check_close(z[i] - 7,
                            transmission(filter.cut_off, length) * sin(2 * PI * (double)i / length),
                            CUT_OFFS[c] < 10 ? 2e-4 : 1e-9);
        }
    free(z);
}

/* The definition, as slow as it is: sums of weights over all heights that are there. */
static double plain_sum(const struct grid *grid, const double *z, size_t point, double cut_off) {
    const double dx = grid_dx(grid), dy = grid_dy(grid);
    double sum = 0, weights = 0;
    for (size_t other = 0; other < grid_points(grid); other++) {
        if (isnan(z[other]))
            continue;
        const double x = ((double)(other % grid->nx) - (double)(point % grid->nx)) * dx;
        const size_t rows = other / grid->nx, row = point / grid->nx;
        const double y = ((double)rows - (double)row) * dy;
        const double weight = exp(-PI * (x * x + y * y) / (ALPHA * ALPHA * cut_off * cut_off));
        sum += weight * z[other];
        weights += weight;
    }
    return sum / weights;
}

static void sides_and_holes_have_no_part(void **state) {
    (void)state;
    enum { N = 70, M = 53 };
    const struct grid grid = {N, M, N * 0.5, M * 0.75};
    uint64_t seed = seed_or(21);
    double z[N * M], was[N * M];
    for (int kind = 0; kind < 4; kind++) {
        const bool holes = kind % 2 == 1;
        /* half kernels of 12 and of 69 points along x */
        const struct gaussian_filter filter = {kind < 2 ? 4 : 34, true, false, false};
        struct gaussian_filter_result result;
        for (size_t i = 0; i < (size_t)N * M; i++)
            z[i] = was[i] = holes && next_word(&seed) % 3 == 0 ? (double)NAN : 100 + noise(&seed);
        assert_int_equal(gaussian_filter_run(&grid, z, BOUNDARY_OPEN, &filter, &result, NULL), 0);
        for (size_t point = 0; point < (size_t)N * M; point += 37) {
            assert_int_equal(isnan(z[point]) != 0, isnan(was[point]) != 0);
            if (!isnan(was[point]))
                check_close(z[point], plain_sum(&grid, was, point, filter.cut_off), 1e-11);
        }
    }
}

/* Spikes pull the plain mean and hardly the robust one, which is the plain one of a smooth map. */
static void a_robust_filter_keeps_clear_of_spikes(void **state) {
    (void)state;
    enum { N = 128 };
    const struct grid grid = {N, N, N, N};
    uint64_t seed = seed_or(22);
    double *z = array_create((size_t)N * N, sizeof *z);
    double *clean = array_create((size_t)N * N, sizeof *clean);
    double *plain = array_create((size_t)N * N, sizeof *plain);
    assert_non_null(z);
    assert_non_null(clean);
    assert_non_null(plain);
    for (size_t i = 0; i < (size_t)N * N; i++) {
        clean[i] = noise(&seed) + noise(&seed) + noise(&seed);
        plain[i] = z[i] = clean[i] + (next_word(&seed) % 20 == 0 ? 40 : 0);
    }
    struct gaussian_filter filter = {20, true, false, false};
    struct gaussian_filter_result result;
    assert_int_equal(gaussian_filter_run(&grid, plain, BOUNDARY_OPEN, &filter, &result, NULL), 0);
    assert_int_equal(gaussian_filter_run(&grid, clean, BOUNDARY_OPEN, &filter, &result, NULL), 0);
    filter.robust = true;
    assert_int_equal(gaussian_filter_run(&grid, z, BOUNDARY_OPEN, &filter, &result, NULL), 0);
    assert_true(result.steps > 1 && result.steps < 40);
    check_close(result.rejected, 0.05, 0.01);
    double robust_error = 0, plain_error = 0;
    for (size_t i = 0; i < (size_t)N * N; i++) {
        robust_error = fmax(robust_error, fabs(z[i] - clean[i]));
        plain_error = fmax(plain_error, fabs(plain[i] - clean[i]));
    }
    assert_true(plain_error > 1);
    assert_true(robust_error < 0.1);
    free(z);
    free(clean);
    free(plain);
}

static void cut_offs_without_meaning_are_refused(void **state) {
    (void)state;
    const struct grid grid = {20, 20, 10, 10};
    static const double CUT_OFFS[] = {0, -1, 1.2, 10.1, (double)NAN, (double)INFINITY};
    double z[400] = {1};
    for (size_t c = 0; c < sizeof CUT_OFFS / sizeof *CUT_OFFS; c++) {
        struct error err = {0};
        struct gaussian_filter_result result;
        const struct gaussian_filter filter = {CUT_OFFS[c], true, false, false};
        assert_int_equal(gaussian_filter_run(&grid, z, BOUNDARY_OPEN, &filter, &result, &err),
                         ERROR_INPUT);
        assert_non_null(strstr(err.text, "allowed"));
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_periodic_wave_is_left_exactly),
        cmocka_unit_test(an_open_wave_is_left_inside),
        cmocka_unit_test(sides_and_holes_have_no_part),
        cmocka_unit_test(a_robust_filter_keeps_clear_of_spikes),
        cmocka_unit_test(cut_offs_without_meaning_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
