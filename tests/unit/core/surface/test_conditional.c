/* Protects: surfaces that hold a patch are draws from those of their law, given the patch: their
 * means and covariances are those of a dense solution, with holes and without a plane too; where
 * the patch is itself of the law, they have the law's spectrum, and the patch is held to its noise
 * within few steps; a patch of another law is noticed. */
#include "core/surface/conditional.h"
#include "core/surface/transform.h"
#include "tests/support/check.h"
#include "tests/support/effort.h"
#include "tests/support/noise.h"
#include <stdlib.h>
#include <string.h>

static double *values(size_t count) {
    double *out = calloc(count, sizeof *out);
    assert_non_null(out);
    return out;
}

static double signed_row(const struct grid *cell, size_t row) {
    return row <= cell->ny / 2 ? (double)row : (double)row - (double)cell->ny;
}

/* Powers of a self-affine law of mean square 1 in a cell of points 1 apart. */
static double *law_of(const struct grid *cell, double hurst, double rolloff, double shortest) {
    double *power = values((cell->nx / 2 + 1) * cell->ny), total = 0;
    for (size_t mx = 0; mx <= cell->nx / 2; mx++)
        for (size_t row = 0; row < cell->ny; row++) {
            const double my = grid_is_profile(cell) ? 0 : signed_row(cell, row) / cell->ly;
            const double wave = 1 / hypot((double)mx / cell->lx, my);
            double *one = &power[mx * cell->ny + row];
            *one = wave < shortest
                       ? 0
                       : pow(fmin(wave, rolloff), (grid_is_profile(cell) ? 1 : 2) + 2 * hurst);
            total += (mx == 0 || 2 * mx == cell->nx ? 1 : 2) * *one;
        }
    for (size_t m = 0; m < (cell->nx / 2 + 1) * cell->ny; m++)
        power[m] /= total;
    return power;
}

/* A patch with noise from a surface of the law alone, which white noise is filtered to. */
static double *patch_of(const struct conditional_law *law, size_t nx, size_t ny, uint64_t *seed) {
    const struct grid *cell = law->cell;
    const size_t points = grid_points(cell), modes = (cell->nx / 2 + 1) * cell->ny;
    double *white = values(points), *root = values(modes), *patch = values(nx * ny);
    struct transform *transform = NULL;
    noise_fill(seed, points, white);
    for (size_t m = 0; m < modes; m++)
        root[m] = sqrt(law->power[m] * (double)points);
    assert_int_equal(transform_create(&transform, cell, cell->nx / 2, cell->ny / 2, NULL), 0);
    transform_filter(transform, root, 1, white, white);
    transform_destroy(&transform);
    noise_fill(seed, nx * ny / 2 * 2, patch);
    for (size_t j = 0; j < ny; j++)
        for (size_t i = 0; i < nx; i++)
            patch[j * nx + i] = sqrt(law->noise) * patch[j * nx + i] + white[j * cell->nx + i];
    free(root);
    free(white);
    return patch;
}

/* --- against a dense solution --- */

enum { NX = 4, NY = 3, MEASURED_MOST = NX * NY, CELL = 4 * NX * NY };

/* The law's covariance of two points of the cell. */
static double covariance(const struct conditional_law *law, size_t a, size_t b) {
    const struct grid *cell = law->cell;
    const double x = (double)(a % cell->nx) - (double)(b % cell->nx);
    const size_t row_a = a / cell->nx, row_b = b / cell->nx;
    const double y = (double)row_a - (double)row_b;
    double total = 0;
    for (size_t mx = 0; mx <= cell->nx / 2; mx++)
        for (size_t row = 0; row < cell->ny; row++)
            total += (mx == 0 || 2 * mx == cell->nx ? 1 : 2) * law->power[mx * cell->ny + row] *
                     cos(2 * M_PI *
                         ((double)mx * x / (double)cell->nx + (double)row * y / (double)cell->ny));
    return total;
}

/* Solves n equations by Gauss's elimination, for a positive matrix. */
static void dense_solve(size_t n, double matrix[][MEASURED_MOST], double *right) {
    for (size_t a = 0; a < n; a++)
        for (size_t b = a + 1; b < n; b++) {
            const double factor = matrix[b][a] / matrix[a][a];
            for (size_t c = a; c < n; c++)
                matrix[b][c] -= factor * matrix[a][c];
            right[b] -= factor * right[a];
        }
    for (size_t a = n; a-- > 0;) {
        for (size_t c = a + 1; c < n; c++)
            right[a] -= matrix[a][c] * right[c];
        right[a] /= matrix[a][a];
    }
}

/* Returns the covariance of a plane of any height and slopes, which measured points have beside the
 * law; 0 without a trend. */
static double plane(const struct conditional_law *law, int trend, size_t a, size_t b) {
    static const double LARGE = 1e4;
    const size_t nx = law->cell->nx;
    const size_t row_a = a / nx, row_b = b / nx, products = a % nx * (b % nx) + row_a * row_b;
    return trend == 0 ? 0 : LARGE * (1 + (double)products);
}

/* Fills weight[measured point] of the mean height at a point of the cell. */
static void weigh(const struct conditional_law *law, int trend, size_t n, const size_t *at,
                  size_t point, double *weight) {
    double matrix[MEASURED_MOST][MEASURED_MOST];
    for (size_t a = 0; a < n; a++) {
        weight[a] = covariance(law, at[a], point);
        for (size_t b = 0; b < n; b++)
            matrix[a][b] = covariance(law, at[a], at[b]) + plane(law, trend, at[a], at[b]) +
                           (a == b ? law->noise : 0);
    }
    dense_solve(n, matrix, weight);
}

/* trend: 2 where a plane was taken out of the patch. */
static void compare_with_dense(int trend) {
    enum { DRAWS = 6000 };
    static const struct grid GRID = {2 * NX, 2 * NY, 2 * NX, 2 * NY};
    double *power = law_of(&GRID, 0.4, 5, 2.5);
    power[0] = 0.05; /* the mean is another one, too */
    const struct conditional_law law = {&GRID, power, 0.01};
    uint64_t seed = 41;
    double *patch = patch_of(&law, NX, NY, &seed), *z = values(CELL);
    double sum[CELL] = {0}, square[CELL] = {0}, product[CELL] = {0};
    size_t at[MEASURED_MOST], n = 0;
    struct conditional_report report;
    patch[5] = patch[6] = (double)NAN; /* holes inside, and one at the side */
    patch[3] = (double)NAN;
    for (size_t p = 0; p < MEASURED_MOST; p++)
        if (!isnan(patch[p]))
            at[n++] = p / NX * GRID.nx + p % NX;
    assert_int_equal(n, MEASURED_MOST - 3);
    const struct conditional_patch held = {NX, NY, patch, trend};
    for (size_t r = 0; r < DRAWS; r++) {
        assert_int_equal(
            conditional_draw(&law, &held, (struct random_key){3, 0, r}, z, &report, NULL), 0);
        assert_int_equal(report.points, n);
        for (size_t p = 0; p < CELL; p++) {
            sum[p] += z[p];
            square[p] += z[p] * z[p];
            product[p] += z[p] * z[NX]; /* beside the patch */
        }
    }
    double other[MEASURED_MOST], beside = 0;
    weigh(&law, trend, n, at, NX, other);
    for (size_t a = 0; a < n; a++)
        beside += other[a] * patch[at[a] / GRID.nx * NX + at[a] % GRID.nx];
    for (size_t p = 0; p < CELL; p++) {
        double weight[MEASURED_MOST], mean = 0, variance = covariance(&law, p, p),
                                      together = covariance(&law, p, NX);
        weigh(&law, trend, n, at, p, weight);
        for (size_t a = 0; a < n; a++) {
            mean += weight[a] * patch[at[a] / GRID.nx * NX + at[a] % GRID.nx];
            variance -= weight[a] * covariance(&law, at[a], p);
            together -= weight[a] * covariance(&law, at[a], NX);
        }
        const double found = sum[p] / DRAWS;
        check_close(found, mean, 5 * sqrt(variance / DRAWS));
        check_close(square[p] / DRAWS - found * found, variance, 5 * variance * sqrt(2.0 / DRAWS));
        check_close(product[p] / DRAWS - found * sum[NX] / DRAWS, together,
                    5 * sqrt(2 * variance / DRAWS));
        if (p == NX)
            check_close(mean, beside, 1e-12);
    }
    free(z);
    free(patch);
    free(power);
}

static void draws_are_those_of_a_dense_solution(void **state) {
    (void)state;
    compare_with_dense(0);
    compare_with_dense(2);
}

/* --- of patches of the law --- */

static void patches_of_the_law_are_held(void **state) {
    (void)state;
    static const struct {
        size_t nx, ny;
        double shortest, noise;
        size_t steps;
    } CASES[] = {{64, 64, 2, 1e-3, 800},    {64, 64, 8, 1e-3, 3000},  {64, 48, 4, 0.02, 200},
                 {128, 128, 4, 1e-3, 2500}, {256, 256, 4, 0.02, 400}, {900, 1, 4, 1e-3, 1500}};
    for (size_t c = 0; c < sizeof CASES / sizeof *CASES; c += case_step()) {
        const size_t nx = CASES[c].nx, ny = CASES[c].ny, points = nx * ny;
        const struct grid cell = {2 * nx, ny == 1 ? 1 : 2 * ny, 2 * (double)nx, 2 * (double)ny};
        double *power = law_of(&cell, 0.8, (double)nx, CASES[c].shortest), *z = NULL;
        const struct conditional_law law = {&cell, power, CASES[c].noise * CASES[c].noise};
        uint64_t seed = 51 + c;
        double *patch = patch_of(&law, nx, ny, &seed);
        const struct conditional_patch held = {nx, ny, patch, 0};
        struct conditional_report report;
        for (size_t p = points / 3; p < points / 3 + nx / 2; p++)
            patch[p] = (double)NAN;
        z = values(grid_points(&cell));
        assert_int_equal(
            conditional_draw(&law, &held, (struct random_key){c, 0, 0}, z, &report, NULL), 0);
        print_message("%zu x %zu, shortest %g, noise %g: %zu steps, held %.3f, power %.3f\n", nx,
                      ny, CASES[c].shortest, CASES[c].noise, report.steps, report.held,
                      report.power);
        assert_in_range(report.steps, 5, CASES[c].steps);
        assert_true(report.residual <= 1e-3);
        const double deviation = sqrt(2 / (double)report.points);
        check_close(report.held, 1, 4 * deviation);
        check_close(report.power, 1, 8 * deviation);
        check_relative(report.difference, report.held * CASES[c].noise, 1e-12);
        free(z);
        free(patch);
        free(power);
    }
}

static void they_have_the_spectrum_of_the_law(void **state) {
    (void)state;
    enum { SIDE = 24, DRAWS = 300, RINGS = SIDE };
    static const struct grid GRID = {2 * SIDE, 2 * SIDE, 2 * SIDE, 2 * SIDE};
    double *power = law_of(&GRID, 0.6, SIDE, 2.5), *z = values(grid_points(&GRID));
    const struct conditional_law law = {&GRID, power, 1e-4};
    double found[RINGS] = {0}, wanted[RINGS] = {0}, count[RINGS] = {0};
    struct transform *transform = NULL;
    uint64_t seed = 61;
    assert_int_equal(transform_create(&transform, &GRID, SIDE, SIDE, NULL), 0);
    for (size_t r = 0; r < DRAWS; r++) {
        double *patch = patch_of(&law, SIDE, SIDE, &seed);
        const struct conditional_patch held = {SIDE, SIDE, patch, 0};
        struct conditional_report report;
        assert_int_equal(
            conditional_draw(&law, &held, (struct random_key){7, 1, r}, z, &report, NULL), 0);
        transform_forward(transform, z);
        const double complex *spectrum = transform_spectrum(transform);
        for (size_t mx = 1; mx < SIDE; mx++) /* each stands for two */
            for (size_t row = 0; row < GRID.ny; row++) {
                const size_t ring = (size_t)hypot((double)mx, signed_row(&GRID, row));
                const double size = cabs(spectrum[mx * GRID.ny + row]);
                if (ring >= RINGS || !(power[mx * GRID.ny + row] > 0))
                    continue;
                found[ring] += size * size;
                wanted[ring] += power[mx * GRID.ny + row];
                count[ring]++; /* of squares with two degrees of freedom */
            }
        free(patch);
    }
    size_t rings = 0;
    for (size_t ring = 1; ring < RINGS; ring++)
        if (count[ring] > 0) {
            check_relative(found[ring], wanted[ring], 5 / sqrt(count[ring]));
            rings++;
        }
    assert_in_range(rings, 15, RINGS);
    transform_destroy(&transform);
    free(z);
    free(power);
}

static void another_law_is_noticed(void **state) {
    (void)state;
    enum { SIDE = 48 };
    static const struct grid GRID = {2 * SIDE, 2 * SIDE, 2 * SIDE, 2 * SIDE};
    double *power = law_of(&GRID, 0.8, SIDE, 4), *z = values(grid_points(&GRID));
    const struct conditional_law law = {&GRID, power, 1e-4}, rougher = {&GRID, power, 2.5e-3};
    uint64_t seed = 71;
    double *patch = patch_of(&rougher, SIDE, SIDE, &seed);
    const struct conditional_patch held = {SIDE, SIDE, patch, 0};
    struct conditional_report report;
    assert_int_equal(conditional_draw(&law, &held, (struct random_key){1, 0, 0}, z, &report, NULL),
                     0);
    assert_true(report.held > 3 && report.power > 3);
    free(patch);
    free(z);
    free(power);
}

static void what_cannot_be_held_is_refused(void **state) {
    (void)state;
    static const struct grid GRID = {8, 8, 8, 8};
    double *power = law_of(&GRID, 0.8, 8, 2), z[64], patch[16];
    struct conditional_law law = {&GRID, power, 1e-4};
    struct conditional_patch held = {4, 4, patch, 0};
    struct conditional_report report;
    struct error err;
    const struct random_key key = {1, 0, 0};
    for (size_t p = 0; p < 16; p++)
        patch[p] = (double)NAN;
    assert_int_equal(conditional_draw(&law, &held, key, z, &report, &err), ERROR_INPUT);
    assert_non_null(strstr(err.text, "only holes"));
    patch[3] = 1;
    law.noise = 0;
    assert_int_equal(conditional_draw(&law, &held, key, z, &report, &err), ERROR_INPUT);
    assert_non_null(strstr(err.text, "above 0"));
    law.noise = 1e-4;
    held.nx = 3;
    assert_int_equal(conditional_draw(&law, &held, key, z, &report, &err), ERROR_INPUT);
    assert_non_null(strstr(err.text, "3 by 4"));
    held.nx = 4;
    assert_int_equal(conditional_draw(&law, &held, key, z, &report, &err), 0);
    assert_int_equal(report.points, 1);
    free(power);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(draws_are_those_of_a_dense_solution),
        cmocka_unit_test(patches_of_the_law_are_held),
        cmocka_unit_test(they_have_the_spectrum_of_the_law),
        cmocka_unit_test(another_law_is_noticed),
        cmocka_unit_test(what_cannot_be_held_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
