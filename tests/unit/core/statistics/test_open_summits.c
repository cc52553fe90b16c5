/* Protects: slopes, curvatures and summits of a sub-map are those of the surface at the same
 * positions; holes take away what is near them, and nothing else. */
#include "core/statistics/summits/local_wave.h"
#include "core/statistics/summits/open_refined.h"
#include "core/statistics/summits/open_summits.h"
#include "core/statistics/summits/refined.h"
#include "tests/support/check.h"
#include "tests/support/cut.h"

static const struct grid WHOLE = {256, 256, 32, 32}; /* 8 points a shortest wave */
static const struct grid LINE = {256, 1, 32, 1};

/* The bounds that local_wave.h states, and exact polynomials. */
static void interpolation_is_as_stated(void **state) {
    (void)state;
    static const struct {
        double points, value, bend;
    } WAVES[] = {
        {3, 3e-2, 8e-2}, {4, 1e-3, 4e-3}, {5, 5e-5, 3e-4}, {6, 3e-6, 3e-5}, {8, 4e-8, 7e-7}};
    double worst_value = 0, worst_bend = 0;
    for (size_t w = 0; w < sizeof WAVES / sizeof *WAVES; w++) {
        double k = 2 * M_PI / WAVES[w].points;
        for (double t = -0.25; t <= 1.25; t += 0.0625)
            for (double phase = 0; phase < 6.2; phase += 0.4) {
                struct local_basis basis;
                double value = 0, slope = 0, bend = 0;
                local_basis_at(t, &basis);
                for (int a = 0; a < LOCAL_POINTS; a++) {
                    double z = cos(k * (a + 1 - LOCAL_HALF) + phase);
                    value += basis.value[a] * z;
                    slope += basis.slope[a] * z;
                    bend += basis.bend[a] * z;
                }
                bool inside = t >= 0 && t <= 1; /* outside of its cell it is a little worse */
                double more = inside ? 1.35 : 4;
                check_close(value, cos(k * t + phase), more * WAVES[w].value);
                check_close(slope / k, -sin(k * t + phase), more * WAVES[w].bend);
                check_close(bend / (k * k), -cos(k * t + phase), more * WAVES[w].bend);
                if (w == 1 && inside) {
                    worst_value = fmax(worst_value, fabs(value - cos(k * t + phase)));
                    worst_bend = fmax(worst_bend, fabs(bend / (k * k) + cos(k * t + phase)));
                }
            }
    }
    assert_true(worst_value > 0.7e-3 && worst_bend > 2e-3); /* no better than stated */
}

/* z = x^3 y^2 has no error; its moments over the inner points are written out. */
static void moments_of_a_polynomial(void **state) {
    (void)state;
    enum { NX = 20, NY = 19 };
    const struct grid grid = {NX, NY, NX * 0.5, NY * 2.0};
    double z[NX * NY];
    struct average m20 = {0}, m02 = {0}, m11 = {0}, m22 = {0}, m40 = {0}, m04 = {0}, bend = {0};
    struct average m31 = {0}, m13 = {0};
    for (size_t point = 0; point < NX * NY; point++) {
        size_t i = point % NX, j = point / NX;
        double x = ((double)i - 9) * 0.5, y = ((double)j - 9) * 2.0;
        z[point] = x * x * x * y * y;
        if (i < 8 || i >= NX - 8 || j < 8 || j >= NY - 8)
            continue;
        double zx = 3 * x * x * y * y, zy = 2 * x * x * x * y, zxx = 6 * x * y * y;
        double zyy = 2 * x * x * x, zxy = 6 * x * x * y;
        average_add(&m20, zx * zx);
        average_add(&m02, zy * zy);
        average_add(&m11, zx * zy);
        average_add(&m22, zxy * zxy);
        average_add(&m40, zxx * zxx);
        average_add(&m04, zyy * zyy);
        average_add(&m31, zxx * zxy);
        average_add(&m13, zyy * zxy);
        average_add(&bend, (zxx + zyy) * (zxx + zyy) / 4);
    }
    const struct measured_map map = {&grid, z, BOUNDARY_OPEN};
    struct moments m;
    assert_int_equal(local_moments_measure(&map, &m, NULL), 0);
    assert_int_equal(m20.count, 4 * 3);
    check_relative(m.m20, average_value(&m20), 1e-10);
    check_relative(m.m02, average_value(&m02), 1e-10);
    check_relative(m.m11, average_value(&m11), 1e-9);
    check_relative(m.m22, average_value(&m22), 1e-9);
    check_relative(m.m40, average_value(&m40), 1e-9);
    check_relative(m.m04, average_value(&m04), 1e-9);
    check_close(m.m31, average_value(&m31), 1e-8 * m.m40);
    check_close(m.m13, average_value(&m13), 1e-8 * m.m40);
    check_relative(m.rms_curvature, sqrt(average_value(&bend)), 1e-9);
    check_relative(m.rms_slope, sqrt(m.m20 + m.m02), 1e-12);
    const struct grid small = {16, 16, 1, 1}; /* no point has 8 neighbours to all sides */
    const struct measured_map few = {&small, z, BOUNDARY_OPEN};
    assert_int_equal(local_moments_measure(&few, &m, NULL), 0);
    assert_true(isnan(m.rms_slope) && isnan(m.rms_curvature) && isfinite(m.rms_height));
}

/* Returns the summit of the list that is nearest to a position. */
static const struct summit *nearest(const struct summit_list *list, double x, double y) {
    const struct summit *best = NULL;
    double least = INFINITY;
    for (size_t s = 0; s < list->count; s++) {
        double distance = hypot(list->summits[s].x - x, list->summits[s].y - y);
        if (distance < least) {
            least = distance;
            best = &list->summits[s];
        }
    }
    return best;
}

/* Refined summits of a sub-map, against those of the whole in the cells that are searched: each is
 * found, once, at the same position, with its height and curvature. Heights are about 1, curvatures
 * about 6; measured: within 4e-8 and 5e-5. */
static void refined_summits_are_those_of_the_whole(void **state) {
    (void)state;
    for (int profile = 0; profile < 2; profile++) {
        const struct grid *grid = profile == 1 ? &LINE : &WHOLE;
        size_t i0 = 40, j0 = profile == 1 ? 0 : 60, nx = profile == 1 ? 200 : 150;
        size_t ny = profile == 1 ? 1 : 140, mode = 32;
        double *z = whole_surface(grid, 0.8, 3);
        struct grid piece;
        struct refined *refined = NULL;
        struct summit_list all = {0}, found = {0};
        double *part = cut(grid, z, i0, j0, nx, ny, &piece), searched = 0;
        const struct measured_map map = {&piece, part, BOUNDARY_OPEN};
        assert_int_equal(refined_create(&refined, grid, mode, profile == 1 ? 0 : mode, NULL), 0);
        assert_int_equal(refined_find(refined, z, &all, NULL), 0);
        assert_int_equal(open_summits_find(&map, SUMMITS_REFINED, &found, &searched, NULL), 0);
        double dx = grid_dx(grid), dy = profile == 1 ? 1 : grid_dy(grid);
        double x0 = (double)i0 * dx, y0 = profile == 1 ? 0 : (double)j0 * dy;
        size_t expected = 0;
        for (size_t s = 0; s < all.count; s++) {
            double x = (all.summits[s].x - x0) / dx, y = (all.summits[s].y - y0) / dy;
            bool inside =
                x >= 8 && x < (double)nx - 9 && (profile == 1 || (y >= 8 && y < (double)ny - 9));
            if (!inside)
                continue;
            expected++;
            const struct summit *match =
                nearest(&found, all.summits[s].x - x0, all.summits[s].y - y0);
            assert_non_null(match);
            check_close(match->x, all.summits[s].x - x0, 1e-3 * dx);
            check_close(match->y, all.summits[s].y - y0, 1e-3 * dx);
            check_close(match->height, all.summits[s].height, 1e-6);
            check_close(match->curvature, all.summits[s].curvature, 5e-4);
        }
        assert_int_equal(found.count, expected);
        assert_true(expected > (profile == 1 ? 7 : 35));
        check_relative(searched,
                       (double)(nx - 17) * dx * (profile == 1 ? 1 : (double)(ny - 17) * dy), 1e-12);
        summit_list_clear(&all);
        summit_list_clear(&found);
        refined_destroy(&refined);
        free(z);
        free(part);
    }
}

/* Grid summits of a sub-map are those of the whole at its inner points; a hole takes the points
 * beside it away. */
static void grid_summits_are_those_of_the_whole(void **state) {
    (void)state;
    struct grid piece;
    double *z = whole_surface(&WHOLE, 0.3, 1), *part = cut(&WHOLE, z, 20, 30, 100, 80, &piece);
    for (int hole = 0; hole < 2; hole++)
        for (int stencil = SUMMITS_NINE_POINT; stencil <= SUMMITS_FIVE_POINT; stencil++) {
            struct summit_finder *finder = NULL;
            struct summit_list all = {0}, found = {0};
            const struct measured_map map = {&piece, part, BOUNDARY_OPEN};
            double searched = 0;
            size_t expected = 0;
            if (hole == 1)
                part[40 * 100 + 50] = NAN;
            assert_int_equal(summit_finder_create(&finder, &WHOLE, (enum summit_stencil)stencil,
                                                  CURVATURE_FINITE_DIFFERENCE, 128, 128, NULL),
                             0);
            assert_int_equal(summits_find(finder, z, &all, NULL), 0);
            assert_int_equal(
                open_summits_find(&map, (enum summit_stencil)stencil, &found, &searched, NULL), 0);
            for (size_t s = 0; s < all.count; s++) {
                long i = lround(all.summits[s].x / 0.125) - 20,
                     j = lround(all.summits[s].y / 0.125) - 30;
                if (i < 1 || i > 98 || j < 1 || j > 78 ||
                    (hole == 1 && labs(i - 50) <= 1 && labs(j - 40) <= 1))
                    continue;
                assert_true(expected < found.count);
                const struct summit *match = &found.summits[expected++];
                check_close(match->x, (double)i * 0.125, 1e-12);
                check_close(match->y, (double)j * 0.125, 1e-12);
                check_relative(match->height, all.summits[s].height, 1e-12);
                check_relative(match->curvature, all.summits[s].curvature, 1e-9);
            }
            assert_int_equal(found.count, expected);
            assert_true(expected > 20);
            check_relative(searched, (98 * 78 - (hole == 1 ? 9 : 0)) * 0.125 * 0.125, 1e-12);
            summit_list_clear(&all);
            summit_list_clear(&found);
            summit_finder_destroy(&finder);
        }
    free(z);
    free(part);
}

/* A hole takes away the refined summits within its reach, and no others. */
static void holes_hide_what_is_near(void **state) {
    (void)state;
    struct grid piece;
    struct summit_list all = {0}, found = {0};
    double *z = whole_surface(&WHOLE, 0.5, 2), searched = 0;
    double *part = cut(&WHOLE, z, 0, 0, 120, 120, &piece);
    const struct measured_map map = {&piece, part, BOUNDARY_OPEN};
    assert_int_equal(open_summits_find(&map, SUMMITS_REFINED, &all, &searched, NULL), 0);
    part[60 * 120 + 55] = NAN;
    assert_int_equal(open_summits_find(&map, SUMMITS_REFINED, &found, &searched, NULL), 0);
    size_t expected = 0;
    for (size_t s = 0; s < all.count; s++) {
        long i = (long)floor(all.summits[s].x / 0.125), j = (long)floor(all.summits[s].y / 0.125);
        bool hidden = i >= 55 - OPEN_REFINED_AFTER && i <= 55 + OPEN_REFINED_BEFORE &&
                      j >= 60 - OPEN_REFINED_AFTER && j <= 60 + OPEN_REFINED_BEFORE;
        if (hidden)
            continue;
        assert_true(expected < found.count);
        assert_true(found.summits[expected].height == all.summits[s].height);
        expected++;
    }
    assert_int_equal(found.count, expected);
    assert_true(expected < all.count);
    check_relative(searched, (103 * 103 - 18 * 18) * 0.125 * 0.125, 1e-12);
    summit_list_clear(&all);
    summit_list_clear(&found);
    free(z);
    free(part);
}

/* Flat, one row too few, plane: no summit, and no area where there is no room. */
static void odd_maps_have_none(void **state) {
    (void)state;
    double z[40 * 17];
    struct summit_list found = {0};
    double searched = 0;
    const struct grid grid = {40, 17, 40, 17}, low = {40, 15, 40, 15};
    for (size_t point = 0; point < 40 * 17; point++)
        z[point] = 0.1;
    const struct measured_map flat = {&grid, z, BOUNDARY_OPEN}, few = {&low, z, BOUNDARY_OPEN};
    for (int stencil = SUMMITS_NINE_POINT; stencil <= SUMMITS_REFINED; stencil++) {
        assert_int_equal(
            open_summits_find(&flat, (enum summit_stencil)stencil, &found, &searched, NULL), 0);
        assert_int_equal(found.count, 0);
        assert_int_equal(
            open_summits_find(&few, (enum summit_stencil)stencil, &found, &searched, NULL), 0);
        assert_int_equal(found.count, 0);
    }
    assert_true(searched == 0);
    summit_list_clear(&found);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(interpolation_is_as_stated),
        cmocka_unit_test(moments_of_a_polynomial),
        cmocka_unit_test(refined_summits_are_those_of_the_whole),
        cmocka_unit_test(grid_summits_are_those_of_the_whole),
        cmocka_unit_test(holes_hide_what_is_near),
        cmocka_unit_test(odd_maps_have_none),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
