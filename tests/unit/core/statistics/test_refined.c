/* Protects: refined summits are all the maxima of the surface, each once, and nothing else. The
 * oracle takes the surface as a sum of waves, written out: its critical points by Newton's method
 * from everywhere, and on a torus maxima - saddles + minima = 0 (Morse), so that a point missing
 * from the oracle shows. Then maps whose symmetry, scale or flatness could mislead the search. */
#include "core/statistics/summits/refined.h"
#include "tests/support/check.h"
#include "tests/support/effort.h"
#include <stdlib.h>

enum { WAVES_MOST = 400, POINTS_MOST = 4000 };

struct wave {
    double kx, ky, amplitude, phase;
};

struct waves {
    double lx, ly;
    size_t count, mode_x, mode_y;
    struct wave waves[WAVES_MOST];
};

/* A deterministic generator: the test needs spread, not quality. */
static double uniform(uint64_t *seed) {
    *seed = *seed * 6364136223846793005u + 1442695040888963407u;
    return (double)(*seed >> 11) * 0x1p-53;
}

/* All waves of the half plane no shorter than 1, amplitudes falling as in self-affine surfaces. */
static void waves_draw(struct waves *w, double lx, double ly, uint64_t seed) {
    *w = (struct waves){.lx = lx, .ly = ly, .mode_x = (size_t)lx, .mode_y = (size_t)ly};
    for (long mx = 0; mx <= (long)lx; mx++)
        for (long my = ly > 0 ? -(long)ly : 0; my <= (long)ly; my++) {
            double fx = (double)mx / lx, fy = ly > 0 ? (double)my / ly : 0;
            if ((mx == 0 && my <= 0) || hypot(fx, fy) > 1)
                continue;
            assert_true(w->count < WAVES_MOST);
            w->waves[w->count++] =
                (struct wave){2 * M_PI * fx, 2 * M_PI * fy,
                              pow(hypot(fx, fy), -1.8) * uniform(&seed), 2 * M_PI * uniform(&seed)};
        }
}

struct point {
    double x, y, z, zx, zy, zxx, zxy, zyy;
};

static struct point waves_at(const struct waves *w, double x, double y) {
    struct point p = {.x = x, .y = y};
    for (size_t n = 0; n < w->count; n++) {
        const struct wave *wave = &w->waves[n];
        double angle = wave->kx * x + wave->ky * y + wave->phase;
        double c = wave->amplitude * cos(angle), s = wave->amplitude * sin(angle);
        p.z += c;
        p.zx -= wave->kx * s;
        p.zy -= wave->ky * s;
        p.zxx -= wave->kx * wave->kx * c;
        p.zxy -= wave->kx * wave->ky * c;
        p.zyy -= wave->ky * wave->ky * c;
    }
    return p;
}

static double *waves_sample(const struct waves *w, const struct grid *grid) {
    double *z = malloc(grid_points(grid) * sizeof *z);
    assert_non_null(z);
    for (size_t j = 0; j < grid->ny; j++)
        for (size_t i = 0; i < grid->nx; i++)
            z[j * grid->nx + i] =
                waves_at(w, (double)i * grid_dx(grid), (double)j * grid_dy(grid)).z;
    return z;
}

static double apart(double a, double b, double period) {
    double distance = fabs(a - b);
    distance -= period * floor(distance / period);
    return fmin(distance, period - distance);
}

static double distance(const struct waves *w, double x, double y, const struct point *p) {
    return hypot(apart(x, p->x, w->lx), apart(y, p->y, w->ly));
}

static double determinant(const struct point *p) {
    return p->zxx * p->zyy - p->zxy * p->zxy;
}

static bool newton(const struct waves *w, double x, double y, struct point *p) {
    for (int step = 0; step < 60; step++) {
        *p = waves_at(w, x, y);
        double dx = (p->zxy * p->zy - p->zyy * p->zx) / determinant(p);
        double dy = (p->zxy * p->zx - p->zxx * p->zy) / determinant(p);
        if (hypot(dx, dy) < 1e-11)
            return true;
        double shorter = fmin(1, 0.1 / hypot(dx, dy));
        x += shorter * dx;
        y += shorter * dy;
    }
    return false;
}

/* Critical points, from 10 starts a wave along each axis. */
static size_t critical_points(const struct waves *w, struct point *points) {
    size_t count = 0;
    for (double y = 0; y < w->ly; y += 0.1)
        for (double x = 0; x < w->lx; x += 0.1) {
            struct point p;
            if (!newton(w, x, y, &p))
                continue;
            bool known = false;
            for (size_t n = 0; n < count && !known; n++)
                known = distance(w, p.x, p.y, &points[n]) < 1e-6;
            if (!known) {
                assert_true(count < POINTS_MOST);
                points[count++] = p;
            }
        }
    return count;
}

static bool is_maximum(const struct point *p) {
    return determinant(p) > 0 && p->zxx < 0;
}

static long morse_sum(const struct point *points, size_t count) {
    long sum = 0;
    for (size_t n = 0; n < count; n++)
        sum += determinant(&points[n]) > 0 ? 1 : -1;
    return sum;
}

static void search(const struct grid *grid, size_t mode_x, size_t mode_y, const double *z,
                   struct summit_list *list) {
    struct refined *refined = NULL;
    list->count = 0;
    assert_int_equal(refined_create(&refined, grid, mode_x, mode_y, NULL), 0);
    assert_int_equal(refined_find(refined, z, list, NULL), 0);
    refined_destroy(&refined);
}

/* Each found summit is a maximum of its own, exact to the interpolant's error at 16 points a wave:
 * 1e-6 of the height, 1e-4 of the curvature, and 1e-4 waves in place where a maximum is flat. */
static void check_found(const struct waves *w, const struct summit_list *list,
                        const struct point *points, size_t count, bool *taken) {
    for (size_t s = 0; s < list->count; s++) {
        const struct summit *summit = &list->summits[s];
        size_t nearest = 0;
        for (size_t n = 0; n < count; n++)
            if (distance(w, summit->x, summit->y, &points[n]) <
                distance(w, summit->x, summit->y, &points[nearest]))
                nearest = n;
        const struct point *p = &points[nearest];
        assert_true(summit->x >= 0 && summit->x < w->lx && summit->y >= 0 && summit->y < w->ly);
        check_close(distance(w, summit->x, summit->y, p), 0, 1e-4);
        assert_true(is_maximum(p) && !taken[nearest]);
        taken[nearest] = true;
        check_close(summit->height, p->z, 1e-5);
        check_relative(summit->curvature, -(p->zxx + p->zyy) / 2, 2e-4);
    }
}

/* A maximum may be lost only to a saddle within a cell and a half of the fine grid. */
static size_t check_lost(const struct waves *w, const struct point *points, size_t count,
                         const bool *taken) {
    size_t lost = 0;
    for (size_t n = 0; n < count; n++) {
        if (!is_maximum(&points[n]) || taken[n])
            continue;
        double saddle = INFINITY;
        for (size_t m = 0; m < count; m++)
            if (determinant(&points[m]) < 0)
                saddle = fmin(saddle, distance(w, points[n].x, points[n].y, &points[m]));
        assert_true(saddle < 1.5 / REFINED_POINTS);
        lost++;
    }
    return lost;
}

static void all_maxima_of_random_surfaces(void **state) {
    (void)state;
    /* 2.2, 2.6, 4 and 5 points a wave, odd, prime and rectangular */
    static const struct grid GRIDS[] = {
        {13, 13, 6, 6}, {17, 18, 7, 7}, {24, 24, 6, 6}, {61, 20, 12, 4}, {20, 60, 4, 12}};
    static struct point points[POINTS_MOST];
    struct summit_list list = {0};
    size_t maxima = 0, lost = 0;
    for (uint64_t seed = 0; seed < 20; seed += case_step()) {
        const struct grid *grid = &GRIDS[seed % 5];
        struct waves w;
        bool taken[POINTS_MOST] = {false};
        waves_draw(&w, grid->lx, grid->ly, seed);
        double *z = waves_sample(&w, grid);
        size_t count = critical_points(&w, points);
        assert_int_equal(morse_sum(points, count), 0);
        for (size_t n = 0; n < count; n++)
            maxima += is_maximum(&points[n]);
        search(grid, w.mode_x, w.mode_y, z, &list);
        check_found(&w, &list, points, count, taken);
        lost += check_lost(&w, points, count, taken);
        free(z);
    }
    summit_list_clear(&list);
    print_message("%zu maxima in surfaces of seeds 0 to 19, %zu lost\n", maxima, lost);
    assert_true(maxima > 150 / case_step() && 100 * lost <= maxima);
}

/* Peaks of profiles against sign changes of the exact slope. */
static void all_peaks_of_random_profiles(void **state) {
    (void)state;
    enum { SAMPLES = 8192 };
    struct summit_list list = {0};
    for (uint64_t seed = 0; seed < 20; seed++) {
        const struct grid grid = {67 + seed, 1, 30, 1};
        struct waves w;
        size_t peaks = 0;
        waves_draw(&w, 30, 0, seed);
        double *z = waves_sample(&w, &grid);
        search(&grid, w.mode_x, 0, z, &list);
        for (size_t n = 0; n < SAMPLES; n++)
            peaks += waves_at(&w, 30.0 * (double)n / SAMPLES, 0).zx > 0 &&
                     waves_at(&w, 30.0 * (double)(n + 1) / SAMPLES, 0).zx <= 0;
        assert_int_equal(list.count, peaks);
        for (size_t s = 0; s < list.count; s++) {
            struct point p = waves_at(&w, list.summits[s].x, 0);
            check_close(p.zx / p.zxx, 0, 1e-4); /* distance to the peak */
            check_close(list.summits[s].height, p.z, 1e-5);
            check_relative(list.summits[s].curvature, -p.zxx, 2e-4);
        }
        free(z);
    }
    summit_list_clear(&list);
}

enum { SIDE = 32 };
static const struct grid SQUARE = {SIDE, SIDE, 1, 1};

/* offset + unit (cos x + cos y), two waves along each side, shifted by a part of a wave. */
static void lattice_fill(double *z, double offset, double unit, double shift) {
    for (size_t j = 0; j < SIDE; j++)
        for (size_t i = 0; i < SIDE; i++)
            z[j * SIDE + i] = offset + unit * (cos(2 * M_PI * (2 * (double)i / SIDE - shift)) +
                                               cos(2 * M_PI * (2 * (double)j / SIDE - shift)));
}

/* Maxima on points of the grids, midway between them and on their lines. */
static void aligned_maxima_are_found(void **state) {
    (void)state;
    static const double SHIFTS[] = {0, 1.0 / 16, 1.0 / 32, 1.0 / 64, 0.25, 1e-12, 0.2371 / 16};
    struct summit_list list = {0};
    double z[SIDE * SIDE];
    for (size_t s = 0; s < sizeof SHIFTS / sizeof *SHIFTS; s++)
        for (size_t mode = 2; mode <= 16; mode += 7) {
            lattice_fill(z, 0, 1, SHIFTS[s]);
            search(&SQUARE, mode, mode, z, &list);
            assert_int_equal(list.count, 4);
            for (size_t m = 0; m < 4; m++) {
                check_close(apart(list.summits[m].x, SHIFTS[s] / 2, 0.5), 0, 1e-5);
                check_close(apart(list.summits[m].y, SHIFTS[s] / 2, 0.5), 0, 1e-5);
                check_close(list.summits[m].height, 2, 1e-6);
            }
        }
    summit_list_clear(&list);
}

/* Neither an offset nor the unit of length changes what is found. 1e9: the input itself is rounded
 * to 1e-7; 1e-310: denormal, four digits left. */
static void offset_and_unit_do_not_matter(void **state) {
    (void)state;
    static const struct {
        double offset, unit, tolerance;
    } CASES[] = {{0, 1e-9, 1e-6},   {0, 1e150, 1e-6},  {0, 1e-200, 1e-6},
                 {0, 1e-310, 1e-4}, {1e3, 1e-3, 1e-6}, {1e9, 1, 1e-6}};
    struct summit_list list = {0};
    double z[SIDE * SIDE];
    for (size_t c = 0; c < sizeof CASES / sizeof *CASES; c++) {
        lattice_fill(z, CASES[c].offset, CASES[c].unit, 0.02);
        search(&SQUARE, 2, 2, z, &list);
        assert_int_equal(list.count, 4);
        for (size_t m = 0; m < 4; m++) {
            check_close((list.summits[m].height - CASES[c].offset) / CASES[c].unit, 2,
                        2 * CASES[c].tolerance);
            check_relative(list.summits[m].curvature / CASES[c].unit, 16 * M_PI * M_PI, 1e-4);
        }
    }
    summit_list_clear(&list);
}

/* Constants, and single waves whose crests are level ridges, along the grid and across it. */
static void flat_maps_and_ridges_hold_none(void **state) {
    (void)state;
    struct summit_list list = {0};
    for (size_t n = 24; n <= 32; n++) {
        const struct grid grid = {n, n, 1, 1};
        double *z = malloc(n * n * sizeof *z);
        assert_non_null(z);
        for (size_t p = 0; p < n * n; p++)
            z[p] = 0.1;
        search(&grid, n / 2, n / 2, z, &list);
        assert_int_equal(list.count, 0);
        for (size_t mx = 0; mx < 4; mx++)
            for (size_t my = 1; my < 4; my++) {
                for (size_t j = 0; j < n; j++)
                    for (size_t i = 0; i < n; i++)
                        z[j * n + i] = cos(2 * M_PI * (double)(i * mx + j * my) / (double)n + 0.3);
                search(&grid, 4, 4, z, &list);
                assert_int_equal(list.count, 0);
            }
        free(z);
    }
    summit_list_clear(&list);
}

/* The smallest grids: their Nyquist waves make z = 1.625 + 0.375 cos X - 0.125 cos Y - 0.875 cos X
 * cos Y through {1, 2, 3, 1/2}, maxima 3 at (0, 1/2) and 2 at (1/2, 0). */
static void smallest_grids(void **state) {
    (void)state;
    static const struct {
        struct grid grid;
        size_t count;
        double highest;
    } CASES[] = {{{2, 2, 1, 1}, 2, 3},
                 {{2, 1, 1, 1}, 1, 2},
                 {{3, 1, 1, 1}, 1, 3.1547005383792515}}; /* 2 + 2/sqrt(3) */
    static const double Z[] = {1, 2, 3, 0.5};
    struct summit_list list = {0};
    for (size_t c = 0; c < 3; c++) {
        double highest = -INFINITY;
        search(&CASES[c].grid, 1, CASES[c].grid.ny / 2, Z, &list);
        assert_int_equal(list.count, CASES[c].count);
        for (size_t s = 0; s < list.count; s++)
            highest = fmax(highest, list.summits[s].height);
        check_close(highest, CASES[c].highest, 1e-6);
    }
    search(&CASES[0].grid, 0, 0, Z, &list);
    assert_int_equal(list.count, 0);
    summit_list_clear(&list);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(all_maxima_of_random_surfaces),
        cmocka_unit_test(all_peaks_of_random_profiles),
        cmocka_unit_test(aligned_maxima_are_found),
        cmocka_unit_test(offset_and_unit_do_not_matter),
        cmocka_unit_test(flat_maps_and_ridges_hold_none),
        cmocka_unit_test(smallest_grids),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
