/* Protects: the leak of gaps whose flow is known without computing, on grids of any shape; what is
 * open and what is closed; pockets, which carry nothing; the same digits again and with a team; bad
 * inputs, by their text. */
#include "core/quantity/leak.h"
#include "tests/support/check.h"
#include "tests/support/seed.h"
#include <stdlib.h>
#include <string.h>

enum { MOST = 128 * 128 };

static const struct grid SHAPES[] = {{2, 2, 1, 1},      {2, 7, 1, 1},      {5, 2, 3, 1},
                                     {3, 3, 1, 1},      {13, 17, 1, 2},    {101, 67, 1.5, 1},
                                     {128, 96, 1, 0.3}, {3, 1201, 0.1, 1}, {127, 125, 1, 1}};
enum { SHAPE_COUNT = sizeof SHAPES / sizeof *SHAPES };

static struct leak *leak_of(struct grid grid) {
    struct leak *leak = NULL;
    struct error err = {0};
    if (leak_create(&leak, &grid, &LEAK_DEFAULTS, &err) != 0)
        fail_msg("%s", err.text);
    return leak;
}

static struct leak_result measure(struct leak *leak, const double *gap, const double *p) {
    struct leak_result result;
    struct error err = {0};
    if (leak_measure(leak, gap, p, &result, &err) != 0)
        fail_msg("%s", err.text);
    return result;
}

static struct leak_result measure_once(struct grid grid, const double *gap, const double *p) {
    struct leak *leak = leak_of(grid);
    struct leak_result result = measure(leak, gap, p);
    leak_destroy(&leak);
    return result;
}

static void check_leak(struct leak_direction direction, double expected) {
    assert_true(direction.open == (expected > 0));
    check_relative(direction.harmonic, expected, 1e-9);
    check_relative(direction.arithmetic, expected, 1e-9);
    check_relative(direction.value, expected, 1e-9);
}

/* Gaps of a few decades, with a part of the nodes closed. */
static void draw(size_t n, double closed, uint64_t *words, double *gap) {
    for (size_t i = 0; i < n; i++) {
        double part = ldexp((double)(next_word(words) >> 11), -53);
        gap[i] = part < closed ? 0 : 0.01 + part;
    }
}

static void uniform_gaps_have_the_leak_1(void **state) {
    (void)state;
    static double gap[MOST];
    for (size_t g = 0; g < SHAPE_COUNT; g++) {
        for (size_t i = 0; i < grid_points(&SHAPES[g]); i++)
            gap[i] = 3e-7;
        struct leak_result result = measure_once(SHAPES[g], gap, NULL);
        check_leak(result.x, 1);
        check_leak(result.y, 1);
        check_relative(result.mean_gap, 3e-7, 1e-14);
        check_relative(result.effective_medium, 1, 1e-11);
    }
}

/* Of a part f open along y the mean gap is f, and the leak f/f^3. The closed columns reach both
 * ends of y and close x. The same for rows. */
static void walls_close_across_and_not_along(void **state) {
    (void)state;
    static double gap[MOST], turned[MOST];
    for (size_t g = 0; g < SHAPE_COUNT; g++) {
        size_t nx = SHAPES[g].nx, ny = SHAPES[g].ny, closed_x = nx / 2, closed_y = ny / 2;
        for (size_t j = 0; j < ny; j++)
            for (size_t i = 0; i < nx; i++) {
                gap[j * nx + i] = i < closed_x ? 0 : 1;
                turned[j * nx + i] = j < closed_y ? 0 : 1;
            }
        double f = 1 - (double)closed_x / (double)nx, h = 1 - (double)closed_y / (double)ny;
        struct leak_result columns = measure_once(SHAPES[g], gap, NULL);
        struct leak_result rows = measure_once(SHAPES[g], turned, NULL);
        check_leak(columns.x, 0);
        check_leak(columns.y, 1 / (f * f));
        check_leak(rows.x, 1 / (h * h));
        check_leak(rows.y, 0);
        check_relative(columns.mean_gap, f, 1e-14);
    }
}

static void pressures_close_nodes_whatever_their_gap(void **state) {
    (void)state;
    enum { N = 9 };
    static const struct grid GRID = {N, N, 1, 1};
    double gap[N * N], p[N * N] = {0};
    for (size_t i = 0; i < N * N; i++)
        gap[i] = 1;
    for (size_t i = 0; i < N; i++)
        p[4 * N + i] = 0.1;
    struct leak_result result = measure_once(GRID, gap, p);
    check_leak(result.x, 81.0 / 64);
    check_leak(result.y, 0);
    for (size_t i = 0; i < N * N; i++)
        p[i] = 1;
    result = measure_once(GRID, gap, p);
    check_leak(result.x, 0);
    check_leak(result.y, 0);
    assert_true(result.mean_gap == 0 && result.effective_medium == 0);
}

/* Free nodes are joined along grid lines alone, so a diagonal line of contact around the periodic
 * side closes the cell across; one node less opens it. */
static void diagonal_lines_close(void **state) {
    (void)state;
    enum { N = 24 };
    static const struct grid GRID = {N, N, 1, 1};
    static double gap[N * N];
    for (size_t j = 0; j < N; j++)
        for (size_t i = 0; i < N; i++)
            gap[j * N + i] = i == 5 + (j < N / 2 ? j : N - j) ? 0 : 1;
    struct leak_result result = measure_once(GRID, gap, NULL);
    assert_true(!result.x.open && result.y.open);
    gap[3 * N + 8] = 1;
    result = measure_once(GRID, gap, NULL);
    assert_true(result.x.open && result.y.open);
    assert_true(result.x.value > 0.05 && result.x.value < 0.5);
    /* A path to one end alone, or around the periodic side, is none. */
    for (size_t j = 0; j < N; j++)
        for (size_t i = 0; i < N; i++)
            gap[j * N + i] = i < N / 2 ? 1 : 0;
    result = measure_once(GRID, gap, NULL);
    assert_true(!result.x.open && result.y.open);
}

/* Between walls gaps leak as they do mirrored, where nothing crosses a side: mirrored both along
 * and across, as half of the pressure falls over each half. Of a third closed some paths go through
 * sides. */
static void walled_gaps_leak_as_mirrored(void **state) {
    (void)state;
    static double gap[MOST], mirrored[4 * MOST];
    struct leak_options walled = LEAK_DEFAULTS;
    size_t open = 0, wrapped = 0;
    uint64_t words = seed_or(3);
    walled.walled = true;
    for (size_t g = 0; g < SHAPE_COUNT; g++) {
        const size_t nx = SHAPES[g].nx, ny = SHAPES[g].ny;
        const struct grid twice = {2 * nx, 2 * ny, 2 * SHAPES[g].lx, 2 * SHAPES[g].ly};
        struct leak *leak = NULL;
        draw(nx * ny, 0.36, &words, gap);
        for (size_t j = 0; j < 2 * ny; j++)
            for (size_t i = 0; i < 2 * nx; i++)
                mirrored[j * 2 * nx + i] =
                    gap[(j < ny ? j : 2 * ny - 1 - j) * nx + (i < nx ? i : 2 * nx - 1 - i)];
        assert_int_equal(leak_create(&leak, &SHAPES[g], &walled, NULL), 0);
        const struct leak_result result = measure(leak, gap, NULL);
        const struct leak_result expected = measure_once(twice, mirrored, NULL);
        const struct leak_result periodic = measure_once(SHAPES[g], gap, NULL);
        assert_true(result.x.open == expected.x.open && result.y.open == expected.y.open);
        check_relative(result.x.harmonic, expected.x.harmonic, 1e-8);
        check_relative(result.y.arithmetic, expected.y.arithmetic, 1e-8);
        open += result.x.open + result.y.open;
        wrapped += periodic.x.harmonic > 1.001 * result.x.harmonic;
        leak_destroy(&leak);
    }
    assert_true(open > 4 && wrapped > 0);
}

/* A closed square with free nodes within, and free nodes that only one end reaches, change the mean
 * gap, and no flow. */
static void pockets_carry_nothing(void **state) {
    (void)state;
    enum { NX = 70, NY = 45 };
    static const struct grid GRID = {NX, NY, 1, 1};
    static double with[NX * NY], without[NX * NY];
    uint64_t words = seed_or(1);
    draw((size_t)NX * NY, 0, &words, with);
    for (size_t j = 0; j < NY; j++)
        for (size_t i = 0; i < NX; i++) {
            bool square = i >= 20 && i < 33 && j >= 10 && j < 27;
            bool inside = i >= 21 && i < 32 && j >= 11 && j < 26;
            double *node = &with[j * NX + i];
            *node = square && !inside ? 0 : *node;
            without[j * NX + i] = square ? 0 : *node;
        }
    struct leak *leak = leak_of(GRID);
    struct leak_result a = measure(leak, with, NULL), b = measure(leak, without, NULL);
    double scale = pow(b.mean_gap / a.mean_gap, 3);
    assert_true(scale < 0.95);
    check_relative(a.x.harmonic, scale * b.x.harmonic, 1e-8);
    check_relative(a.y.arithmetic, scale * b.y.arithmetic, 1e-8);
    leak_destroy(&leak);
}

static bool same(const struct leak_result *a, const struct leak_result *b) {
    return a->x.harmonic == b->x.harmonic && a->x.arithmetic == b->x.arithmetic &&
           a->y.harmonic == b->y.harmonic && a->y.arithmetic == b->y.arithmetic &&
           a->x.iterations == b->x.iterations && a->y.iterations == b->y.iterations &&
           a->mean_gap == b->mean_gap && a->effective_medium == b->effective_medium;
}

/* Also with other gaps in between, with a team, and turned by a right angle. */
static void digits_are_the_same_again(void **state) {
    (void)state;
    static double gap[MOST], other[MOST], turned[MOST];
    uint64_t words = seed_or(2);
    struct team *team = NULL;
    assert_int_equal(team_create(&team, 2, NULL), 0);
    for (size_t g = 0; g < SHAPE_COUNT; g++) {
        const struct grid *grid = &SHAPES[g], other_side = {grid->ny, grid->nx, grid->ly, grid->lx};
        size_t n = grid_points(grid);
        draw(n, 0.2, &words, gap);
        draw(n, 0.1, &words, other);
        for (size_t i = 0; i < n; i++)
            turned[i % grid->nx * grid->ny + i / grid->nx] = gap[i];
        struct leak *leak = leak_of(*grid);
        struct leak_result first = measure(leak, gap, NULL);
        measure(leak, other, NULL);
        struct leak_result again = measure(leak, gap, NULL);
        assert_true(same(&first, &again));
        assert_int_equal(leak_set_team(leak, team, NULL), 0);
        again = measure(leak, gap, NULL);
        assert_true(same(&first, &again));
        assert_int_equal(leak_set_team(leak, NULL, NULL), 0);
        again = measure(leak, gap, NULL);
        assert_true(same(&first, &again));
        leak_destroy(&leak);
        struct leak_result by_side = measure_once(other_side, turned, NULL);
        check_relative(by_side.x.harmonic, first.y.harmonic, 1e-9);
        check_relative(by_side.y.arithmetic, first.x.arithmetic, 1e-9);
    }
    team_destroy(&team);
}

/* Gaps of 1e-9 of the mean across the whole cell still have a leak: that of 1e-5. */
static void tiny_gaps_are_open(void **state) {
    (void)state;
    enum { N = 64 };
    static const struct grid GRID = {N, N, 1, 1};
    static double gap[N * N];
    for (size_t i = 0; i < (size_t)N * N; i++)
        gap[i] = i % N == 20 ? 1e-9 : 1;
    struct leak_result result = measure_once(GRID, gap, NULL);
    /* N columns in series, of which one has all the resistance */
    check_relative(result.x.harmonic, N * 1e-15, 1e-6);
    assert_true(result.x.arithmetic > result.x.harmonic);
}

static void check_refused(struct grid grid, struct leak_options options, const char *text) {
    struct leak *leak = NULL;
    struct error err = {0};
    assert_int_equal(leak_create(&leak, &grid, &options, &err), ERROR_INPUT);
    assert_null(leak);
    assert_non_null(strstr(err.text, text));
}

static void bad_inputs_are_refused(void **state) {
    (void)state;
    static const struct grid GRID = {8, 6, 1, 1};
    check_refused((struct grid){8, 1, 1, 1}, LEAK_DEFAULTS, "a profile of 8 points");
    check_refused((struct grid){1, 8, 1, 1}, LEAK_DEFAULTS, "a grid of 1 by 8 points");
    check_refused((struct grid){8, 8, -1, 1}, LEAK_DEFAULTS, "lx = -1");
    check_refused(GRID, (struct leak_options){NAN, 10, false}, "tolerance of nan");
    check_refused(GRID, (struct leak_options){1e-6, 0, false}, "limit of 0 iterations");
    struct leak *leak = leak_of(GRID);
    struct leak_result result;
    struct error err = {0};
    double gap[48] = {0};
    gap[13] = NAN;
    assert_int_equal(leak_measure(leak, gap, NULL, &result, &err), ERROR_INPUT);
    assert_non_null(strstr(err.text, "gap[13] = nan, at the node (5, 1)"));
    gap[13] = 1;
    assert_false(measure(leak, gap, NULL).x.open);
    leak_destroy(&leak);
    leak_destroy(&leak);
}

static void what_is_not_reached_is_an_error(void **state) {
    (void)state;
    static const struct grid GRID = {96, 96, 1, 1};
    static double gap[96 * 96];
    uint64_t words = seed_or(3);
    struct leak *leak = NULL;
    struct leak_result result;
    struct error err = {0};
    draw((size_t)96 * 96, 0.3, &words, gap);
    assert_int_equal(leak_create(&leak, &GRID, &(struct leak_options){1e-10, 1, false}, &err), 0);
    assert_int_equal(leak_measure(leak, gap, NULL, &result, &err), ERROR_NUMERIC);
    assert_non_null(strstr(err.text, "the leak along x: the flow through 96 by 96 nodes"));
    assert_non_null(strstr(err.text, "after 1 iterations; allowed: 1e-10"));
    leak_destroy(&leak);
}

/* About 130 bytes a node; a team of two takes another solver. */
static void bytes_are_stated(void **state) {
    (void)state;
    static const struct grid GRID = {256, 200, 1, 1};
    double alone = leak_bytes(&GRID, &LEAK_DEFAULTS, 1), two = leak_bytes(&GRID, &LEAK_DEFAULTS, 2);
    assert_true(alone > 100.0 * 256 * 200 && alone < 200.0 * 256 * 200);
    assert_true(two > 1.8 * alone && two < 2 * alone);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(uniform_gaps_have_the_leak_1),
        cmocka_unit_test(walls_close_across_and_not_along),
        cmocka_unit_test(pressures_close_nodes_whatever_their_gap),
        cmocka_unit_test(diagonal_lines_close),
        cmocka_unit_test(walled_gaps_leak_as_mirrored),
        cmocka_unit_test(pockets_carry_nothing),
        cmocka_unit_test(digits_are_the_same_again),
        cmocka_unit_test(tiny_gaps_are_open),
        cmocka_unit_test(bad_inputs_are_refused),
        cmocka_unit_test(what_is_not_reached_is_an_error),
        cmocka_unit_test(bytes_are_stated),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
