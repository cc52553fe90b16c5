/* Protects how contact edges are found below the grid: Hertz's contacts of one node, and areas of
 * waves whose edges are near each other. Laws of distances rise, and are the same along x and y,
 * whatever the model and the grid. */
#include "tests/support/check.h"

#include "core/contact/area_law.h"
#include "core/contact/edge/edge.h"
#include "core/theory/contact.h"
#include "tests/support/contact_scene.h"
#include "tests/support/unstopped.h"
#include <string.h>

/* Gap at a distance x beside a Hertz line contact of half-width a: the integral from a of its slope
 * (4 force/(pi a^2)) sqrt(t^2 - a^2) (Johnson 1985, 4.2), by Simpson's rule in sqrt(t - a). */
static double line_gap(double a, double force, double x) {
    enum { STEPS = 2000 };
    double h = sqrt(x - a) / STEPS, sum = 0;
    for (size_t i = 0; i <= STEPS; i++) {
        double v = h * (double)i, t = a + v * v;
        double slope = 4 * force / (M_PI * a * a) * sqrt((t - a) * (t + a));
        sum += (i == 0 || i == STEPS ? 1 : i % 2 ? 4 : 2) * slope * 2 * v;
    }
    return sum * h / 3;
}

static void lone_inverts_hertz_lines(void **state) {
    (void)state;
    for (double a = 0.01; a < 0.999; a += 0.06) {
        double gap = line_gap(a, 0.3 + a, 1); /* the nodes beside it are 1 step away */
        check_relative(edge_lone(0.3 + a, gap, gap), a, 1e-8); /* Simpson's error */
    }
}

static void lone_has_its_limits(void **state) {
    (void)state;
    check_close(edge_lone(1, 0, 0), 1, 1e-12); /* it reaches both neighbours */
    assert_true(edge_lone(1, -1e-20, 0) <= 1); /* violations within tolerance */
    /* Far apart: gap = x^2/(2R) and a^2 = 4 force R/pi, a = sqrt(2 force/(pi gap)). */
    check_relative(edge_lone(1e-12, 1, 1), sqrt(2e-12 / M_PI), 1e-5);
    /* Two gaps: between those of either. */
    double wide = edge_lone(1, 0.1, 0.1), narrow = edge_lone(1, 3, 3), both = edge_lone(1, 0.1, 3);
    assert_true(narrow < both && both < wide);
    double last = 0;
    for (double force = 1e-9; force < 1e9; force *= 3) {
        double a = edge_lone(force, 1, 1);
        assert_true(a > last && a <= 1);
        last = a;
    }
}

/* Gap at a distance r beside Hertz's sphere: its shape, and the displacement outside less that in
 * the middle (Johnson 1985, 3.4). */
static double sphere_gap(double a, double force, double r) {
    double radius = 4 * a * a * a / (3 * force);
    double outside =
        ((2 * a * a - r * r) * asin(a / r) + a * sqrt(r * r - a * a)) / (M_PI * radius);
    return r * r / (2 * radius) + outside - a * a / radius;
}

static void lone_inverts_hertz_spheres(void **state) {
    (void)state;
    for (double a = 0.02; a < 0.999; a += 0.06) {
        double force = 0.3 + a, gap = sphere_gap(a, force, 1);
        /* The gap near the edge is a difference of larger numbers: 1e-16/gap. */
        check_relative(edge_lone_axis(force, gap, gap), a, 1e-12 + 1e-15 / gap);
    }
    check_close(edge_lone_axis(1, 0, 0), 1, 1e-6); /* gap ~ (r - a)^(3/2): 2/3 of the digits */
    check_relative(edge_lone_axis(1e-15, 1, 1), cbrt(0.75e-15 / 2), 1e-4); /* a^3 = 3 force R/4 */
    double last = 0;
    for (double force = 1e-12; force < 1e9; force *= 3) {
        double a = edge_lone_axis(force, 1, 1);
        assert_true(a > last && a <= 1);
        last = a;
    }
}

/* Distances rise with those of the fields; an edge between two nodes has the one scale at which
 * both distances add up; nodes are in contact up to where open ones begin. */
static void check_direction(const struct edge_direction *direction) {
    double inside = -INFINITY, outside = -INFINITY;
    for (double field = 0; field < 8; field += 0.03) {
        double next_in = edge_inside(direction, field), next_out = edge_outside(direction, field);
        assert_true(next_in > inside && next_out > outside);
        /* Measured 0.27 at most, at the edge. */
        assert_true(fabs(next_in - field) < 0.35 && fabs(next_out - field) < 0.35);
        assert_true(edge_inside_slope(direction, field) >= 0);
        inside = next_in;
        outside = next_out;
    }
    check_close(edge_inside(direction, 0), -edge_outside(direction, 0), 0.1); /* between samples */
    for (double ratio = 1e-12; ratio < 1e13; ratio *= 10)
        for (double apart = 0.1; apart < 1.5; apart += 0.3) {
            double w = edge_scale(direction, ratio, 1, apart, 0);
            /* A step of Newton's method short of rounding, over slopes of 0.05 at least. */
            check_close(edge_inside(direction, ratio * w * w * w) + edge_outside(direction, w),
                        apart, 1e-3);
        }
}

static void laws_rise(void **state) {
    (void)state;
    static const struct grid grids[] = {{64, 1, 1, 1}, {32, 32, 1e-9, 1e-9}, {16, 64, 1, 1}};
    for (size_t a = 0; a < 3; a++)
        for (size_t b = 0; b < 3; b++) {
            struct block block = {.model = b == 0 ? MODEL_HALFSPACE : MODEL_LAYERED,
                                  .poisson = 0.3,
                                  .height = b == 0 ? INFINITY : 1.5 * grids[a].lx,
                                  .layer_growth = 1.1,
                                  .weighting = b == 1 ? GAP_STANDARD : GAP_DUAL};
            struct edge_law law;
            struct error err = {0};
            assert_int_equal(edge_law_make(&grids[a], &block, &law, &err), 0);
            assert_int_equal(law.count, grids[a].ny == 1 ? 1 : EDGE_DIRECTIONS);
            for (double angle = 0; angle < M_PI / 2; angle += 0.1) {
                struct edge_direction direction = edge_direction(&law, angle);
                check_direction(&direction);
            }
            /* Half-space 0.13, dual 0.24, standard -0.02: the weighting draws nodes in. */
            double overlap = edge_overlap(&law);
            assert_true(b == 1 ? fabs(overlap) < 0.08 : overlap > 0.08 && overlap < 0.3);
        }
}

/* Checks that one law at an angle from x is the other at that angle from y. */
static void check_mirrored(const struct edge_law *law, const struct edge_law *other, double angle,
                           double tolerance) {
    struct edge_direction one = edge_direction(law, angle);
    struct edge_direction mirror = edge_direction(other, M_PI / 2 - angle);
    for (double field = 0; field < 4; field += 0.1) {
        check_close(edge_inside(&one, field), edge_inside(&mirror, field), tolerance);
        check_close(edge_outside(&one, field), edge_outside(&mirror, field), tolerance);
    }
}

/* Where dx = dy, x and y are alike. */
static void laws_are_symmetric(void **state) {
    (void)state;
    struct grid grid = {32, 32, 1, 1};
    struct block block = {.model = MODEL_HALFSPACE, .height = INFINITY};
    struct edge_law law;
    struct error err = {0};
    assert_int_equal(edge_law_make(&grid, &block, &law, &err), 0);
    for (double angle = 0; angle < M_PI / 4; angle += 0.05)
        check_mirrored(&law, &law, angle, 1e-12);
}

/* Where they differ the law of the grid with x and y exchanged is the same, also on a coating,
 * whose stiffness near edges depends on the spacing. Solutions are within 1e-10 of the pressure. */
static void laws_turn_with_the_grid(void **state) {
    (void)state;
    const struct grid grid = {16, 16, 16, 64}, turned = {16, 16, 64, 16};
    const struct block block = {
        .model = MODEL_HALFSPACE, .poisson = 0.3, .height = INFINITY, .coating = {2, 5, 0.3}};
    struct edge_law law, other;
    struct error err = {0};
    must(edge_law_make(&grid, &block, &law, &err), &err);
    must(edge_law_make(&turned, &block, &other, &err), &err);
    assert_true(law.stiffness > 1 && law.stiffness < 5);
    check_relative(other.stiffness, law.stiffness, 1e-9);
    for (double angle = 0; angle < M_PI / 2; angle += 0.1)
        check_mirrored(&law, &other, angle, 1e-6);
}

static void laws_pass_errors_on(void **state) {
    (void)state;
    struct grid grid = {64, 1, 1, 1};
    struct block block = {.model = MODEL_HALFSPACE, .poisson = 0.7, .height = INFINITY};
    struct edge_law law;
    struct error err = {0};
    assert_int_equal(edge_law_make(&grid, &block, &law, &err), ERROR_INPUT);
    assert_non_null(strstr(err.text, "law of contact edges: Poisson's ratio = 0.7"));
}

/* Mean over positions of the area of Westergaard's wave, pressed to r of full contact, less the
 * known one and over it. */
static double wave_error(size_t points, double r) {
    enum { PLACES = 32 };
    struct scene scene;
    double sum = 0;
    scene_open(&scene, (struct grid){points, 1, 1, 1}, DEEP, 1e-10);
    for (size_t place = 0; place < PLACES; place++) {
        scene_begin_wave(&scene, (double)place / PLACES);
        scene_press(&scene, r * M_PI);
        sum += scene_area(&scene).edges / PLACES;
    }
    scene_close(&scene);
    return sum / westergaard_area(r) - 1;
}

/* At 0.9 of full contact gaps of 3 and 7 points are left; pressures and gaps that did not bend in
 * between would make 1.3 and 0.3 % more. */
static void edges_bend_beside_narrow_gaps(void **state) {
    (void)state;
    static const double RATIO[] = {0.2, 0.4, 0.6, 0.8, 0.9};
    for (size_t a = 0; a < sizeof RATIO / sizeof *RATIO; a++) {
        check_close(wave_error(16, RATIO[a]), 0, 5e-3);
        check_close(wave_error(32, RATIO[a]), 0, 1e-3);
    }
}

/* A surface and the one with x and y exchanged have one law of areas. Solutions of double sines are
 * within 1e-8 of the pressure; patches of one position differ by 0.1 from those of
 * another. */
static void area_laws_are_symmetric(void **state) {
    (void)state;
    static const double RATIOS[] = {1, 1.7, 5};
    for (size_t c = 0; c < 6; c++) {
        const double ratio = RATIOS[c % 3];
        const struct grid grid = {16, 16, 16, 16 * ratio}, turned = {16, 16, 16 * ratio, 16};
        const struct block block = {.model = c < 3 ? MODEL_HALFSPACE : MODEL_LAYERED,
                                    .poisson = 0.3,
                                    .height = 24,
                                    .layer_growth = 1.2};
        struct area_law one, other;
        struct error err = {0};
        must(area_law_make(&grid, &block, &one, &err), &err);
        must(area_law_make(&turned, &block, &other, &err), &err);
        check_relative(other.overlap, one.overlap, 1e-6);
        check_close(other.patch, one.patch, 1e-5);
        check_close(other.patch_of_nodes, one.patch_of_nodes, 1e-5);
        check_relative(other.weighting, one.weighting, 1e-5);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(laws_are_symmetric),
        cmocka_unit_test(laws_turn_with_the_grid),
        cmocka_unit_test(area_laws_are_symmetric),
        cmocka_unit_test(lone_inverts_hertz_lines),
        cmocka_unit_test(lone_has_its_limits),
        cmocka_unit_test(lone_inverts_hertz_spheres),
        cmocka_unit_test(laws_rise),
        cmocka_unit_test(laws_pass_errors_on),
        cmocka_unit_test(edges_bend_beside_narrow_gaps),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
