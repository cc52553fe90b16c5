/* Protects: which points are summits, on any grid, against brute force; plateaus and ties are none;
 * refined summits are the true maxima. */
#include "core/statistics/summits/summits.h"
#include "core/surface/surface.h"
#include "tests/support/check.h"
#include "tests/support/seed.h"
#include <stdlib.h>
#include <string.h>

static size_t count_summits(const struct grid *grid, const double *z, enum summit_stencil stencil,
                            struct summit_list *list) {
    struct summit_finder *finder = NULL;
    assert_int_equal(summit_finder_create(&finder, grid, stencil, CURVATURE_FINITE_DIFFERENCE,
                                          grid->nx / 2, grid->ny / 2, NULL),
                     0);
    assert_int_equal(summits_find(finder, z, list, NULL), 0);
    summit_finder_destroy(&finder);
    return list->count;
}

static size_t brute_force(const struct grid *grid, const double *z, bool corners) {
    size_t count = 0;
    long nx = (long)grid->nx, ny = (long)grid->ny;
    for (long j = 0; j < ny; j++)
        for (long i = 0; i < nx; i++) {
            bool summit = true;
            for (long b = -1; b <= 1; b++)
                for (long a = -1; a <= 1; a++) {
                    if ((a == 0 && b == 0) || (ny == 1 && b != 0) || (!corners && a != 0 && b != 0))
                        continue;
                    double other = z[(j + b + ny) % ny * nx + (i + a + nx) % nx];
                    summit = summit && z[j * nx + i] > other;
                }
            count += summit;
        }
    return count;
}

/* Coarse levels make ties; sizes about the block of 64 columns and its remainders. */
static void grid_summits_are_those_of_brute_force(void **state) {
    (void)state;
    static const struct grid GRIDS[] = {
        {2, 2, 1, 1},  {3, 2, 1, 1},   {2, 5, 1, 1},    {64, 7, 1, 1}, {65, 66, 1, 1},
        {66, 3, 1, 1}, {67, 30, 1, 1}, {130, 17, 1, 1}, {2, 1, 1, 1},  {200, 1, 1, 1}};
    struct summit_list list = {0};
    uint64_t seed = seed_or(3);
    for (size_t g = 0; g < sizeof GRIDS / sizeof *GRIDS; g++)
        for (int levels = 3; levels <= 3000; levels *= 10) {
            size_t n = grid_points(&GRIDS[g]);
            double *z = malloc(n * sizeof *z);
            assert_non_null(z);
            for (size_t p = 0; p < n; p++) {
                seed = seed * 6364136223846793005u + 1442695040888963407u;
                z[p] = (double)((seed >> 33) % (uint64_t)levels);
            }
            assert_int_equal(count_summits(&GRIDS[g], z, SUMMITS_NINE_POINT, &list),
                             brute_force(&GRIDS[g], z, true));
            assert_int_equal(count_summits(&GRIDS[g], z, SUMMITS_FIVE_POINT, &list),
                             brute_force(&GRIDS[g], z, false));
            free(z);
        }
    summit_list_clear(&list);
}

static void flat_and_plateau_hold_none(void **state) {
    (void)state;
    const struct grid grid = {10, 10, 1, 1};
    struct summit_list list = {0};
    double z[100] = {0};
    assert_int_equal(count_summits(&grid, z, SUMMITS_NINE_POINT, &list), 0);
    assert_int_equal(count_summits(&grid, z, SUMMITS_REFINED, &list), 0);
    z[44] = z[45] = 1;
    assert_int_equal(count_summits(&grid, z, SUMMITS_NINE_POINT, &list), 0);
    z[45] = 2;
    assert_int_equal(count_summits(&grid, z, SUMMITS_NINE_POINT, &list), 1);
    check_close(list.summits[0].x, 0.5, 1e-15);
    check_close(list.summits[0].y, 0.4, 1e-15);
    summit_list_clear(&list);
}

/* cos cos has its maxima where they are put, height 1 and mean curvature k^2; off the grid points.
 */
static void refined_summits_are_exact(void **state) {
    (void)state;
    enum { N = 24 };
    const struct grid grid = {N, N, 3, 3};
    double z[N * N], shift_x = 0.0317, shift_y = 0.0911, k = 2 * M_PI * 2 / 3;
    struct summit_list list = {0};
    struct summit_finder *finder = NULL;
    for (size_t j = 0; j < N; j++)
        for (size_t i = 0; i < N; i++)
            z[j * N + i] =
                cos(k * (3.0 * (double)i / N - shift_x)) * cos(k * (3.0 * (double)j / N - shift_y));
    assert_int_equal(
        summit_finder_create(&finder, &grid, SUMMITS_REFINED, CURVATURE_SPECTRAL, 2, 2, NULL), 0);
    assert_int_equal(summits_find(finder, z, &list, NULL), 0);
    assert_int_equal(list.count, 8);
    for (size_t s = 0; s < list.count; s++) {
        const struct summit *summit = &list.summits[s];
        /* interpolation error of 8 points at 24 points a wave: below 1e-8 in height, 1e-5 in
         * curvature */
        check_close(cos(k * (summit->x - shift_x)) * cos(k * (summit->y - shift_y)), 1, 1e-9);
        check_close(summit->height, 1, 1e-7);
        check_relative(summit->curvature, k * k, 1e-5);
    }
    summit_finder_destroy(&finder);
    summit_list_clear(&list);
}

static void curvatures_of_a_wave(void **state) {
    (void)state;
    const struct grid grid = {32, 32, 1, 1};
    double z[1024], k = 2 * M_PI * 2, dx = 1.0 / 32;
    struct summit_list list = {0};
    for (size_t j = 0; j < 32; j++)
        for (size_t i = 0; i < 32; i++)
            z[j * 32 + i] = cos(k * (double)i * dx) + cos(k * (double)j * dx);
    for (int spectral = 0; spectral < 2; spectral++) {
        struct summit_finder *finder = NULL;
        assert_int_equal(
            summit_finder_create(&finder, &grid, SUMMITS_NINE_POINT,
                                 spectral ? CURVATURE_SPECTRAL : CURVATURE_FINITE_DIFFERENCE, 2, 2,
                                 NULL),
            0);
        assert_int_equal(summits_find(finder, z, &list, NULL), 0);
        assert_int_equal(list.count, 4);
        double expected = spectral ? k * k : 2 * (1 - cos(k * dx)) / (dx * dx);
        check_relative(list.summits[3].curvature, expected, 1e-12);
        summit_finder_destroy(&finder);
    }
    summit_list_clear(&list);
}

/* A field g with known derivatives, cos(kx x + 0.3) + cos(ky y + 0.2), of profiles the first wave
 * alone, and z = HEIGHT f(g) with log-normal heights: f = unit exp(SHAPE g) - least. */
enum { FIELD_SIDE = 24, FIELD_WAVES = 2 };
static const double SHAPE = 0.7, HEIGHT = 0.3;
struct field {
    struct grid grid;
    bool profile;
    double kx, ky, g[FIELD_SIDE * FIELD_SIDE], z[FIELD_SIDE * FIELD_SIDE];
    struct height_function *function;
};

static void field_fill(struct field *field, const struct grid *grid) {
    const struct heights heights = {.type = HEIGHTS_LOGNORMAL, .shape = SHAPE};
    field->grid = *grid;
    field->profile = grid_is_profile(grid);
    field->kx = 2 * M_PI * FIELD_WAVES / grid->lx;
    field->ky = field->profile ? 0 : 2 * M_PI * FIELD_WAVES / grid->ly;
    assert_int_equal(height_function_create(&field->function, &heights, NULL), 0);
    for (size_t j = 0; j < grid->ny; j++)
        for (size_t i = 0; i < grid->nx; i++)
            field->g[j * grid->nx + i] =
                cos(field->kx * (double)i * grid_dx(grid) + 0.3) +
                (field->profile ? 0 : cos(field->ky * (double)j * grid_dy(grid) + 0.2));
    memcpy(field->z, field->g, sizeof field->z);
    height_function_apply(field->function, HEIGHT, grid_points(grid), field->z);
}

/* The curvature of z at a point, from the derivatives of g along x and y. */
static void check_field_summit(const struct field *field, const struct summit *summit,
                               double sign) {
    double unit = exp(-SHAPE * SHAPE / 2) / sqrt(expm1(SHAPE * SHAPE));
    double least = 1 / sqrt(expm1(SHAPE * SHAPE));
    double kx = field->kx, ky = field->ky, x = kx * summit->x + 0.3, y = ky * summit->y + 0.2;
    double g = cos(x) + (field->profile ? 0 : cos(y));
    double slope = SHAPE * unit * exp(SHAPE * g), bend = SHAPE * slope;
    double xx = -slope * kx * kx * cos(x) + bend * kx * kx * sin(x) * sin(x);
    double yy = -slope * ky * ky * cos(y) + bend * ky * ky * sin(y) * sin(y);
    double curvature = field->profile ? -xx : -(xx + yy) / 2;
    check_close(summit->height, sign * HEIGHT * (unit * exp(SHAPE * g) - least), 1e-6);
    check_relative(summit->curvature, sign * HEIGHT * curvature, 1e-5);
}

/* Spectral curvatures are those of z at points of the grid, refined ones at its maxima. */
static void curvatures_of_translated_waves(void **state) {
    (void)state;
    const struct grid grids[] = {{FIELD_SIDE, FIELD_SIDE, 1, 2}, {FIELD_SIDE, 1, 1, 1}};
    for (size_t c = 0; c < 4; c++) {
        struct field field;
        struct summit_list list = {0};
        struct summit_finder *finder = NULL;
        field_fill(&field, &grids[c % 2]);
        assert_int_equal(summit_finder_create(&finder, &field.grid,
                                              c < 2 ? SUMMITS_REFINED : SUMMITS_NINE_POINT,
                                              CURVATURE_SPECTRAL, FIELD_WAVES,
                                              field.profile ? 0 : FIELD_WAVES, NULL),
                         0);
        assert_int_equal(summit_finder_translate(finder, field.function, HEIGHT, NULL), 0);
        summit_finder_gaussian(finder, field.g);
        for (int pits = 0; pits < 2; pits++) {
            assert_int_equal((pits ? pits_find : summits_find)(finder, field.z, &list, NULL), 0);
            assert_int_equal(list.count, field.profile ? FIELD_WAVES : FIELD_WAVES * FIELD_WAVES);
            for (size_t a = 0; a < list.count; a++)
                check_field_summit(&field, &list.summits[a], pits ? -1 : 1);
        }
        summit_list_clear(&list);
        summit_finder_destroy(&finder);
        height_function_destroy(&field.function);
    }
}

/* Refined summits of one surface do not depend on the grid that samples it. */
static void refined_summits_belong_to_the_surface(void **state) {
    (void)state;
    struct summit_list lists[2] = {{0}, {0}};
    for (size_t l = 0; l < 2; l++) {
        size_t n = l ? 512 : 128;
        struct grid grid = {n, n, 32, 32};
        struct spectrum spectrum = {.type = SPECTRUM_SELF_AFFINE,
                                    .hurst = 0.8,
                                    .wavelength_long = 4,
                                    .wavelength_rolloff = 4,
                                    .wavelength_short = 1};
        struct generator *generator = NULL;
        struct summit_finder *finder = NULL;
        double *z = malloc(n * n * sizeof *z);
        assert_non_null(z);
        assert_int_equal(generator_create(&generator, &spectrum, &grid, &SURFACE_DEFAULTS, NULL),
                         0);
        assert_int_equal(generator_run(generator, (struct random_key){2, 0, 0}, z, NULL, NULL), 0);
        assert_int_equal(
            summit_finder_create(&finder, &grid, SUMMITS_REFINED, CURVATURE_SPECTRAL, 32, 32, NULL),
            0);
        assert_int_equal(summits_find(finder, z, &lists[l], NULL), 0);
        generator_destroy(&generator);
        summit_finder_destroy(&finder);
        free(z);
    }
    assert_int_equal(lists[0].count, lists[1].count);
    for (size_t s = 0; s < lists[0].count; s++) {
        check_close(lists[0].summits[s].x, lists[1].summits[s].x, 1e-4);
        check_close(lists[0].summits[s].height, lists[1].summits[s].height, 1e-6);
    }
    summit_list_clear(&lists[0]);
    summit_list_clear(&lists[1]);
}

static struct summit_finder *finder_of(const struct grid *grid, enum summit_stencil stencil,
                                       enum summit_curvature curvature) {
    struct summit_finder *finder = NULL;
    assert_int_equal(
        summit_finder_create(&finder, grid, stencil, curvature, grid->nx / 2, grid->ny / 2, NULL),
        0);
    return finder;
}

/* Pits are the summits of -z, to the bit, for every rule, on surfaces and profiles, and summits are
 * not among them. */
static void pits_are_summits_of_the_mirror(void **state) {
    (void)state;
    const struct grid grids[] = {{64, 48, 2, 1.5}, {256, 1, 4, 0}};
    double z[64 * 48], mirrored[64 * 48];
    uint64_t seed = seed_or(11);
    for (size_t a = 0; a < 64 * 48; a++) {
        z[a] = (double)(next_word(&seed) % 1000);
        mirrored[a] = -z[a];
    }
    for (size_t g = 0; g < 2; g++)
        for (int stencil = SUMMITS_NINE_POINT; stencil <= SUMMITS_REFINED; stencil++)
            for (int curvature = 0; curvature < 2; curvature++) {
                struct summit_finder *finder = finder_of(&grids[g], (enum summit_stencil)stencil,
                                                         (enum summit_curvature)curvature);
                struct summit_list pits = {0}, summits = {0};
                assert_int_equal(pits_find(finder, z, &pits, NULL), 0);
                assert_int_equal(summits_find(finder, mirrored, &summits, NULL), 0);
                assert_true(pits.count > 20);
                assert_int_equal(pits.count, summits.count);
                assert_memory_equal(pits.summits, summits.summits,
                                    pits.count * sizeof *pits.summits);
                summit_list_clear(&pits);
                summit_list_clear(&summits);
                summit_finder_destroy(&finder);
            }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(grid_summits_are_those_of_brute_force),
        cmocka_unit_test(flat_and_plateau_hold_none),
        cmocka_unit_test(refined_summits_are_exact),
        cmocka_unit_test(curvatures_of_a_wave),
        cmocka_unit_test(curvatures_of_translated_waves),
        cmocka_unit_test(refined_summits_belong_to_the_surface),
        cmocka_unit_test(pits_are_summits_of_the_mirror),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
