/* Protects how contact edges are found below the grid: the closed form of the first guess, Hertz's
 * contacts of one node, and laws that rise with the guess whatever the model and the grid. */
#include "tests/support/check.h"

#include "core/contact/edge.h"
#include <string.h>

/* p^2 = c^2 s and (3 gap/4)^(2/3) = c^(2/3) (1 - s) have s = ratio (1 - s)^3, ratio = p^2/rise^3.
 */
static void guess_solves_its_equation(void **state) {
    (void)state;
    for (double power = -30; power <= 30; power += 0.25) {
        double ratio = pow(10, power);
        double s = edge_guess(ratio, 1), rest = 1 - s;
        assert_true(s > 0 && s <= 1);
        /* Rounding of s, a few 1e-15, counts thrice in the cube of 1 - s. */
        check_close(s / (ratio * rest * rest * rest), 1, 1e-12 + 1e-14 / rest);
        if (rest < 1e-4)
            break;
    }
    /* Both sides of c alike: p^2 = c^2 s, rise = c^(2/3) (1 - s). */
    for (double c = 1e-3; c < 1e4; c *= 7)
        for (double s = 0.01; s < 1; s += 0.07)
            check_relative(edge_guess(c * c * s, cbrt(c * c) * (1 - s)), s, 1e-12); /* rounding */
}

static void guess_has_its_limits(void **state) {
    (void)state;
    assert_true(edge_guess(1, 0) == 1); /* no gap: the edge is at the node outside */
    assert_true(edge_guess(1, 1e-200) == 1);
    assert_true(edge_guess(1e-300, 1) >= 0 && edge_guess(1e-300, 1) < 1e-200);
    check_relative(edge_guess(1e-12, 1), 1e-12, 1e-10); /* s = ratio to first order */
    double last = 0;
    for (double ratio = 1e-20; ratio < 1e20; ratio *= 3) {
        double s = edge_guess(ratio, 1);
        assert_true(s >= last && s <= 1);
        last = s;
    }
}

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

static void check_law(const struct edge_law *law) {
    for (size_t a = 0; a < EDGE_PHASES; a++) {
        assert_true(law->root[a] >= 0 && law->root[a] <= 1);
        assert_true(law->share[a] > -0.3 && law->share[a] < 1.2 && law->before[a] > 1);
        assert_true(a == 0 ||
                    (law->root[a] >= law->root[a - 1] && law->share[a] > law->share[a - 1]));
    }
    double last = -1;
    for (double ratio = 1e-12; ratio < 1e12; ratio *= 1.5) {
        double share = edge_share(law, ratio, 0, 1);
        assert_true(share >= last);
        last = share;
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
            for (size_t columns = 0; columns < (grids[a].ny > 1 ? 2 : 1); columns++) {
                assert_int_equal(edge_law_make(&grids[a], &block, columns == 1, &law, &err), 0);
                check_law(&law);
            }
        }
}

static void laws_pass_errors_on(void **state) {
    (void)state;
    struct grid grid = {64, 1, 1, 1};
    struct block block = {.model = MODEL_HALFSPACE, .poisson = 0.7, .height = INFINITY};
    struct edge_law law;
    struct error err = {0};
    assert_int_equal(edge_law_make(&grid, &block, false, &law, &err), ERROR_INPUT);
    assert_non_null(strstr(err.text, "law of contact edges: Poisson's ratio = 0.7"));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(guess_solves_its_equation),  cmocka_unit_test(guess_has_its_limits),
        cmocka_unit_test(lone_inverts_hertz_lines),   cmocka_unit_test(lone_has_its_limits),
        cmocka_unit_test(lone_inverts_hertz_spheres), cmocka_unit_test(laws_rise),
        cmocka_unit_test(laws_pass_errors_on),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
