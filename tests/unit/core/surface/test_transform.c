/* Protects: band-limited transforms against sums written out, on odd, even, prime and tiny grids.
 */
#include "core/surface/transform.h"
#include "tests/support/check.h"
#include "tests/support/seed.h"
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

static const struct grid GRIDS[] = {{16, 12, 1, 1}, {15, 9, 1, 1}, {13, 7, 1, 1},
                                    {2, 2, 1, 1},   {3, 2, 1, 1},  {32, 1, 1, 1},
                                    {17, 1, 1, 1},  {2, 1, 1, 1},  {40, 19, 1, 1}};
enum { GRID_COUNT = sizeof GRIDS / sizeof *GRIDS };

static double noise(uint64_t *seed) {
    *seed = *seed * 6364136223846793005u + 1442695040888963407u;
    return (double)(int64_t)*seed * 0x1p-63;
}

static void forward_is_the_sum(void **state) {
    (void)state;
    uint64_t seed = seed_or(1);
    for (size_t g = 0; g < GRID_COUNT; g++) {
        const struct grid *grid = &GRIDS[g];
        size_t nx = grid->nx, ny = grid->ny, mode_x = nx / 2, mode_y = ny / 2;
        struct transform *transform = NULL;
        double *z = malloc(nx * ny * sizeof *z);
        assert_non_null(z);
        for (size_t p = 0; p < nx * ny; p++)
            z[p] = noise(&seed);
        assert_int_equal(transform_create(&transform, grid, mode_x, mode_y, NULL), 0);
        transform_forward(transform, z);
        for (size_t mx = 0; mx <= mode_x; mx++)
            for (size_t row = 0; row < ny; row++) {
                double complex sum = 0;
                for (size_t j = 0; j < ny; j++)
                    for (size_t i = 0; i < nx; i++)
                        sum +=
                            z[j * nx + i] *
                            cexp(-2 * M_PI * I *
                                 ((double)(mx * i) / (double)nx + (double)(row * j) / (double)ny));
                sum /= (double)(nx * ny);
                check_close(cabs(transform_spectrum(transform)[mx * ny + row] - sum), 0, 1e-14);
            }
        /* and back */
        double *again = malloc(nx * ny * sizeof *again);
        assert_non_null(again);
        transform_inverse(transform, again);
        for (size_t p = 0; p < nx * ny; p++)
            check_close(again[p], z[p], 1e-14);
        free(z);
        free(again);
        transform_destroy(&transform);
    }
}

static void rows_one_by_one_are_the_whole(void **state) {
    (void)state;
    const struct grid grid = {20, 21, 1, 1};
    struct transform *transform = NULL;
    double whole[420], parts[420];
    assert_int_equal(transform_create(&transform, &grid, 4, 3, NULL), 0);
    for (int pass = 0; pass < 2; pass++) {
        double complex *spectrum = transform_spectrum(transform);
        for (size_t k = 0; k < 5 * 21; k++)
            spectrum[k] = 0;
        spectrum[2 * 21 + 3] = 1 + 2 * I;
        spectrum[4 * 21 + 20] = -I;
        if (pass == 0) {
            transform_inverse(transform, whole);
        } else {
            transform_inverse_columns(transform);
            for (size_t j = 0; j < 21; j += 5)
                transform_inverse_rows(transform, j, 21 - j < 5 ? 21 - j : 5, parts + j * 20);
        }
    }
    assert_memory_equal(whole, parts, sizeof whole);
    transform_destroy(&transform);
}

/* A Nyquist mode of the coarse grid becomes two halves on the finer one: the same heights at common
 * points. */
/* Halves the odd rows of every second column. */
static void halve(const void *context, size_t mx, double complex *column) {
    const struct grid *grid = context;
    for (size_t row = 0; row < grid->ny; row++)
        if (mx % 2 == 1 && row % 2 == 1)
            column[row] /= 2;
}

struct field {
    const struct grid *grid;
    double *z;
};

static void row_give(void *context, size_t j, double *line) {
    const struct field *field = context;
    memcpy(line, field->z + j * field->grid->nx, field->grid->nx * sizeof *line);
}

static void row_take(void *context, size_t j, double *line) {
    const struct field *field = context;
    memcpy(field->z + j * field->grid->nx, line, field->grid->nx * sizeof *line);
    line[0] = 1e300; /* the line is the caller's: no other one holds it */
}

/* Columns that stay in cache between their transforms, and rows that are handed over one by one,
 * have the digits of whole transforms: of short sides, which are planned together, and of long
 * ones. */
static void what_stays_in_cache_is_the_same(void **state) {
    (void)state;
    static const struct grid MORE[] = {{16, 12, 1, 1}, {15, 9, 1, 1},   {32, 1, 1, 1},
                                       {40, 19, 1, 1}, {300, 21, 1, 1}, {24, 300, 1, 1},
                                       {257, 5, 1, 1}, {272, 288, 1, 1}};
    uint64_t seed = seed_or(7);
    for (size_t g = 0; g < sizeof MORE / sizeof *MORE; g++) {
        const struct grid *grid = &MORE[g];
        const size_t points = grid_points(grid), mode_x = grid->nx / 3, mode_y = grid->ny / 2;
        struct transform *whole = NULL, *parts = NULL;
        double *z = malloc(points * sizeof *z), *same = malloc(points * sizeof *same);
        assert_non_null(z);
        assert_non_null(same);
        for (size_t p = 0; p < points; p++)
            same[p] = z[p] = noise(&seed);
        assert_int_equal(transform_create(&whole, grid, mode_x, mode_y, NULL), 0);
        assert_int_equal(transform_create(&parts, grid, mode_x, mode_y, NULL), 0);
        transform_forward(whole, z);
        for (size_t mx = 0; mx <= mode_x; mx++)
            halve(grid, mx, transform_spectrum(whole) + mx * grid->ny);
        transform_inverse(whole, z);
        transform_forward_each(parts, row_give, &(struct field){grid, same});
        transform_change_columns(parts, halve, grid);
        transform_inverse_each(parts, row_take, &(struct field){grid, same});
        assert_memory_equal(z, same, points * sizeof *z);
        free(z);
        free(same);
        transform_destroy(&whole);
        transform_destroy(&parts);
    }
}

static void padding_keeps_the_surface(void **state) {
    (void)state;
    const struct grid coarse = {8, 6, 1, 1}, fine = {24, 18, 1, 1};
    struct transform *from = NULL, *to = NULL;
    double z[48], dense[432];
    uint64_t seed = seed_or(9);
    for (size_t p = 0; p < 48; p++)
        z[p] = noise(&seed);
    assert_int_equal(transform_create(&from, &coarse, 4, 3, NULL), 0);
    assert_int_equal(transform_create(&to, &fine, 4, 3, NULL), 0);
    transform_forward(from, z);
    transform_pad(from, to);
    transform_inverse(to, dense);
    for (size_t j = 0; j < 6; j++)
        for (size_t i = 0; i < 8; i++)
            check_close(dense[3 * j * 24 + 3 * i], z[j * 8 + i], 1e-14);
    transform_destroy(&from);
    transform_destroy(&to);
}

/* Waves of as many as half the points of the coarser grid, along one side and along both: the
 * finer grid, without all other waves, has the same values at every second point. */
static void coarser_points_sample_the_shortest_waves(void **state) {
    (void)state;
    const struct grid fine = {16, 12, 1, 1}, coarse = {8, 6, 1, 1};
    struct transform *from = NULL, *to = NULL;
    double z[192], sampled[48];
    uint64_t seed = seed_or(11);
    for (size_t p = 0; p < 192; p++)
        z[p] = noise(&seed);
    assert_int_equal(transform_create(&from, &fine, 4, 3, NULL), 0);
    assert_int_equal(transform_create(&to, &coarse, 4, 3, NULL), 0);
    transform_forward(from, z);
    double complex *mode = transform_spectrum(from);
    for (size_t mx = 0; mx <= 4; mx++)
        for (size_t row = 4; row < 9; row++)
            mode[mx * 12 + row] = 0;
    transform_pad(from, to);
    transform_inverse(from, z);
    transform_inverse(to, sampled);
    for (size_t j = 0; j < 6; j++)
        for (size_t i = 0; i < 8; i++)
            check_close(sampled[j * 8 + i], z[2 * j * 16 + 2 * i], 1e-14);
    transform_destroy(&from);
    transform_destroy(&to);
}

static void fast_counts_are_even_and_above_zero(void **state) {
    (void)state;
    static const size_t COUNTS[][2] = {{0, 2}, {1, 2}, {2, 2}, {7, 8}, {8, 8}, {13, 16}};
    for (size_t c = 0; c < sizeof COUNTS / sizeof *COUNTS; c++)
        assert_int_equal(transform_fast_count(COUNTS[c][0]), COUNTS[c][1]);
}

static void bands_beyond_the_grid_are_refused(void **state) {
    (void)state;
    struct transform *transform = NULL;
    const struct grid grid = {8, 8, 1, 1}, none = {0, 8, 1, 1}, flat = {8, 8, 0, 1};
    assert_int_equal(transform_create(&transform, &grid, 5, 4, NULL), ERROR_INPUT);
    assert_int_equal(transform_create(&transform, &grid, 4, 5, NULL), ERROR_INPUT);
    assert_int_equal(transform_create(&transform, &none, 0, 0, NULL), ERROR_INPUT);
    assert_int_equal(transform_create(&transform, &flat, 0, 0, NULL), ERROR_INPUT);
    assert_null(transform);
}

/* Returns the status of transform_create where the process may have `more` bytes beyond those it
 * has; -1: the process died. */
static int status_with(rlim_t more) {
    const struct grid grid = {.nx = 16, .ny = 65537, .lx = 1, .ly = 4096};
    pid_t child = fork();
    if (child == 0) {
        long pages = 0;
        FILE *file = fopen("/proc/self/statm", "r");
        bool known = file != NULL && fscanf(file, "%ld", &pages) == 1;
        rlim_t most = (rlim_t)pages * (rlim_t)sysconf(_SC_PAGESIZE) + more;
        struct rlimit none = {0, 0}, limit = {most, most};
        struct transform *transform = NULL;
        setrlimit(RLIMIT_CORE, &none);
        if (!known || setrlimit(RLIMIT_AS, &limit) != 0)
            _exit(99);
        _exit(transform_create(&transform, &grid, 8, 8, NULL) == 0 ? 0 : 1);
    }
    int status = 0;
    assert_int_equal(waitpid(child, &status, 0), child);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

/* FFTW would abort where its plans run out of memory. */
static void little_memory_is_an_error(void **state) {
    (void)state;
#ifdef RUGO_SANITIZED
    print_message("SKIP: sanitizers take any address space\n");
    skip();
#endif
    static const rlim_t SCARCE[] = {8, 10, 12, 14, 18}; /* MB; the arrays take 9.4 */
    for (size_t n = 0; n < sizeof SCARCE / sizeof *SCARCE; n++)
        assert_int_equal(status_with(SCARCE[n] << 20), 1);
    assert_int_equal(status_with((rlim_t)256 << 20), 0);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(little_memory_is_an_error),
        cmocka_unit_test(forward_is_the_sum),
        cmocka_unit_test(rows_one_by_one_are_the_whole),
        cmocka_unit_test(what_stays_in_cache_is_the_same),
        cmocka_unit_test(padding_keeps_the_surface),
        cmocka_unit_test(coarser_points_sample_the_shortest_waves),
        cmocka_unit_test(fast_counts_are_even_and_above_zero),
        cmocka_unit_test(bands_beyond_the_grid_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
