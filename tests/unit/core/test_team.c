/* Protects: a team works each part of a task once, whatever its size; what it computes has the same
 * digits as without one: pressures, gaps, tangents and areas of each kind of face. */
#include "core/contact/area.h"
#include "core/team.h"
#include "tests/support/check.h"
#include <math.h>
#include <stdatomic.h>
#include <string.h>
#include <time.h>

enum { PARTS_MOST = 1000, THREADS_MOST = 7 };
static const size_t THREADS[] = {0, 1, 2, 3, THREADS_MOST};
enum { TEAMS = sizeof THREADS / sizeof *THREADS };

struct tally {
    atomic_int times[PARTS_MOST];
    size_t threads;
};

static void count(void *context, size_t part, size_t thread) {
    struct tally *tally = context;
    assert_true(thread < tally->threads);
    atomic_fetch_add(&tally->times[part], 1);
}

static void each_part_is_worked_once(void **state) {
    (void)state;
    for (size_t t = 0; t < TEAMS; t++) {
        struct team *team;
        assert_int_equal(team_create(&team, THREADS[t], NULL), 0);
        assert_true(team_threads(team) >= 1);
        assert_true(team_threads(team) <= (THREADS[t] > 1 ? THREADS[t] : 1));
        for (size_t parts = 0; parts <= PARTS_MOST; parts += parts < 10 ? 1 : 330) {
            struct tally tally = {.threads = team_threads(team)};
            team_share(team, parts, count, &tally);
            for (size_t p = 0; p < PARTS_MOST; p++)
                assert_int_equal(atomic_load(&tally.times[p]), p < parts ? 1 : 0);
        }
        team_destroy(&team);
        assert_null(team);
    }
}

/* Works until its thread has spent 2 ms, and until all threads have a part. */
static void spend(void *context, size_t part, size_t thread) {
    atomic_int *begun = context;
    struct timespec at;
    double start = -1, now = 0;
    (void)part;
    (void)thread;
    atomic_fetch_add(begun, 1);
    do {
        assert_int_equal(clock_gettime(CLOCK_THREAD_CPUTIME_ID, &at), 0);
        now = (double)at.tv_sec + 1e-9 * (double)at.tv_nsec;
        start = start < 0 ? now : start;
    } while (now - start < 2e-3 || atomic_load(begun) < 2);
}

static void time_is_that_of_the_others(void **state) {
    (void)state;
    struct team *team;
    atomic_int begun = 0;
    assert_int_equal(team_create(&team, 2, NULL), 0);
    if (team_threads(team) == 2) {
        const double before = team_cpu_seconds(team);
        team_share(team, 2, spend, &begun);
        assert_true(team_cpu_seconds(team) - before >= 2e-3);
    }
    team_destroy(&team);
    assert_true(team_cpu_seconds(NULL) == 0);
}

/* Items of a task that is shared by ranges of so many. */
struct range_tally {
    atomic_int times[PARTS_MOST];
    size_t count, size, threads;
};

static void count_range(void *context, size_t first, size_t end, size_t thread) {
    struct range_tally *tally = context;
    assert_true(thread < tally->threads);
    assert_int_equal(first % tally->size, 0);
    assert_true(end == tally->count || (end == first + tally->size && end < tally->count));
    assert_true(end > first && end - first <= tally->size);
    for (size_t i = first; i < end; i++)
        atomic_fetch_add(&tally->times[i], 1);
}

static void ranges_hold_each_item_once(void **state) {
    static const size_t SIZES[] = {1, 7, 100, 3000}, COUNTS[] = {0, 1, 7, 99, 700, PARTS_MOST};
    (void)state;
    struct team *team;
    assert_int_equal(team_create(&team, 3, NULL), 0);
    for (size_t s = 0; s < sizeof SIZES / sizeof *SIZES; s++)
        for (size_t c = 0; c < sizeof COUNTS / sizeof *COUNTS; c++) {
            struct range_tally tally = {
                .count = COUNTS[c], .size = SIZES[s], .threads = team_threads(team)};
            team_share_ranges(c % 2 == 0 ? team : NULL, COUNTS[c], SIZES[s], count_range, &tally);
            for (size_t i = 0; i < PARTS_MOST; i++)
                assert_int_equal(atomic_load(&tally.times[i]), i < COUNTS[c] ? 1 : 0);
            size_t parts = team_parts(COUNTS[c], SIZES[s]);
            assert_true(parts * SIZES[s] >= COUNTS[c] && parts * SIZES[s] < COUNTS[c] + SIZES[s]);
        }
    team_destroy(&team);
}

/* What a face leaves under its last load. */
struct left {
    size_t n;
    double *p, *gap, *tangent;
    double stiffness, mean_gap;
    struct contact_area area;
};

static double *copy(size_t n, const double *x) {
    double *y = test_calloc(n, sizeof *y);
    memcpy(y, x, n * sizeof *y);
    return y;
}

static double height(const struct grid *grid, size_t i) {
    size_t row = i / grid->nx;
    double x = (double)(i % grid->nx) / (double)grid->nx, y = (double)row * 0.0051;
    double noise = sin(12.9898 * (double)(i + 1)) * 43758.5453;
    return 3 * cos(2 * M_PI * x) * cos(2 * M_PI * y) + noise - floor(noise);
}

/* hardness 0: none. */
static struct left press(const struct grid *grid, const struct block *block, bool open,
                         double hardness, size_t threads) {
    enum { LOADS = 2 };
    static const double LOAD[LOADS] = {0.3, 2};
    struct left left = {.n = grid_points(grid)};
    struct compliance *compliance;
    struct contact *contact;
    struct area_workspace *areas;
    struct contact_state pressed;
    struct team *team;
    struct contact_options options = CONTACT_DEFAULTS;
    options.tolerance = 1e-4;
    if (hardness > 0)
        options.hardness = hardness;
    double *z = test_calloc(left.n, sizeof *z);
    for (size_t i = 0; i < left.n; i++)
        z[i] = height(grid, i);
    assert_int_equal(open ? compliance_create_open(&compliance, grid, block, NULL)
                          : compliance_create(&compliance, grid, block, NULL),
                     0);
    assert_int_equal(team_create(&team, threads, NULL), 0);
    assert_int_equal(contact_create(&contact, compliance, &options, NULL), 0);
    assert_int_equal(area_workspace_create(&areas, compliance, NULL), 0);
    assert_int_equal(contact_set_team(contact, team, NULL), 0);
    assert_int_equal(area_workspace_set_team(areas, team, NULL), 0);
    assert_int_equal(contact_begin(contact, z, NULL), 0);
    for (size_t l = 0; l < LOADS; l++)
        assert_int_equal(contact_press(contact, LOAD[l], &pressed, NULL), 0);
    contact_area(areas, &pressed, &left.area);
    left.p = copy(left.n, pressed.p);
    left.gap = copy(left.n, pressed.gap);
    left.tangent = copy(left.n, pressed.tangent);
    left.stiffness = pressed.stiffness;
    left.mean_gap = pressed.mean_gap;
    area_workspace_destroy(&areas);
    contact_destroy(&contact);
    compliance_destroy(&compliance);
    team_destroy(&team);
    test_free(z);
    return left;
}

static void left_clear(struct left *left) {
    test_free(left->p);
    test_free(left->gap);
    test_free(left->tangent);
}

static void contact_has_the_same_digits(void **state) {
    (void)state;
    static const struct block DEEP = {.model = MODEL_HALFSPACE, .height = INFINITY};
    static const struct block LAYERED = {
        .model = MODEL_LAYERED, .poisson = 0.3, .height = 1.5, .layer_growth = 1.5};
    static const struct {
        struct grid grid;
        const struct block *block;
        bool open;
        double hardness;
    } CASES[] = {{{270, 180, 1, 0.7}, &DEEP, false, 0},  {{256, 256, 1, 1}, &LAYERED, false, 0},
                 {{149, 133, 1, 0.9}, &DEEP, true, 0},   {{40000, 1, 1, 1}, &DEEP, false, 0},
                 {{20000, 1, 1, 1}, &LAYERED, false, 0}, {{64, 300, 1, 3}, &DEEP, false, 0},
                 {{270, 180, 1, 0.7}, &DEEP, false, 20}};
    for (size_t c = 0; c < sizeof CASES / sizeof *CASES; c++) {
        struct left alone =
            press(&CASES[c].grid, CASES[c].block, CASES[c].open, CASES[c].hardness, 1);
        struct left shared =
            press(&CASES[c].grid, CASES[c].block, CASES[c].open, CASES[c].hardness, 3);
        const size_t BYTES = alone.n * sizeof *alone.p;
        assert_memory_equal(alone.p, shared.p, BYTES);
        assert_memory_equal(alone.gap, shared.gap, BYTES);
        assert_memory_equal(alone.tangent, shared.tangent, BYTES);
        assert_memory_equal(&alone.area.edges, &shared.area.edges, sizeof(double));
        assert_memory_equal(&alone.area.upper, &shared.area.upper, sizeof(double));
        assert_memory_equal(&alone.stiffness, &shared.stiffness, sizeof(double));
        assert_memory_equal(&alone.mean_gap, &shared.mean_gap, sizeof(double));
        left_clear(&alone);
        left_clear(&shared);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(each_part_is_worked_once),
        cmocka_unit_test(time_is_that_of_the_others),
        cmocka_unit_test(ranges_hold_each_item_once),
        cmocka_unit_test(contact_has_the_same_digits),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
