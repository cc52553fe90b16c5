/* Protects the stiffness of a set of nodes along the face: against a direct solution of all
 * equations of a small set, against ellipses and rough surfaces, and at the ends of its range. */
#include "tests/support/check.h"

#include "core/contact/slip/held.h"
#include "tests/support/contact_scene.h"
#include <stdio.h>

static const double PI = M_PI;

static struct held_stiffness measure(const struct grid *grid, double poisson, const double *p,
                                     double angle) {
    struct error err = {0};
    struct held *held = NULL;
    struct held_stiffness out = {0};
    if (held_create(&held, grid, poisson, &err) != 0 ||
        held_measure(held, p, angle, 1e-5, &out, &err) != 0)
        fail_msg("%s", err.text);
    held_destroy(&held);
    return out;
}

/* --- a direct solution --- */

enum { SIDE_X = 12, SIDE_Y = 10, MEMBERS = 30, UNKNOWNS = 2 * MEMBERS + 2 };

/* Displacement along a at (x, y) under a traction of 1 along b at node 0, by a sum over all waves.
 * Odd symbols are 0 where a wave is its own mirror image. */
static double response(const struct grid *grid, double poisson, int a, int b, size_t x, size_t y) {
    double sum = 0;
    for (int mx = -(int)grid->nx / 2 + 1; mx <= (int)grid->nx / 2; mx++)
        for (int my = -(int)grid->ny / 2 + 1; my <= (int)grid->ny / 2; my++) {
            double kx = 2 * PI * mx / grid->lx, ky = 2 * PI * my / grid->ly, k = hypot(kx, ky);
            bool edge = 2 * mx == (int)grid->nx || 2 * my == (int)grid->ny;
            double product = a != b ? (edge ? 0 : kx * ky) : a == 0 ? kx * kx : ky * ky;
            double symbol = 2 / ((1 - poisson) * k) * ((a == b) - poisson * product / (k * k));
            double phase = 2 * PI *
                           ((double)mx * (double)x / (double)grid->nx +
                            (double)my * (double)y / (double)grid->ny);
            sum += k > 0 ? symbol * cos(phase) : 0;
        }
    return sum / (double)grid_points(grid);
}

/* Solves m x = b in place by elimination with pivots. */
static void eliminate(size_t n, double *m, double *b) {
    for (size_t k = 0; k < n; k++) {
        size_t pivot = k;
        for (size_t i = k; i < n; i++)
            pivot = fabs(m[i * n + k]) > fabs(m[pivot * n + k]) ? i : pivot;
        for (size_t j = 0; j <= n; j++) {
            double *one = j < n ? &m[k * n + j] : &b[k],
                   *two = j < n ? &m[pivot * n + j] : &b[pivot];
            double kept = *one;
            *one = *two;
            *two = kept;
        }
        for (size_t i = 0; i < n; i++) {
            double factor = i == k ? 0 : m[i * n + k] / m[k * n + k];
            for (size_t j = k; j < n && factor != 0; j++)
                m[i * n + j] -= factor * m[k * n + j];
            b[i] -= factor * b[k];
        }
    }
    for (size_t k = 0; k < n; k++)
        b[k] /= m[k * n + k];
}

/* Tractions at MEMBERS nodes and the displacement of all of them, solved at once. The residual
 * asked, 1e-5, leaves 1e-10 of the stiffness. */
static void direct_solution(void **state) {
    (void)state;
    const struct grid grid = {.nx = SIDE_X, .ny = SIDE_Y, .lx = 3, .ly = 1.7};
    const double poisson = 0.2, angle = 0.7;
    static double p[SIDE_X * SIDE_Y], m[UNKNOWNS * UNKNOWNS], b[UNKNOWNS];
    size_t member[MEMBERS];
    for (size_t a = 0; a < MEMBERS; a++)
        p[member[a] = (a * 37 + a * a * 3 % 5) % (SIDE_X * SIDE_Y)] = 1 + (double)a;
    size_t count = 0;
    for (size_t i = 0; i < SIDE_X * SIDE_Y; i++)
        if (p[i] > 0)
            member[count++] = i;
    assert_true(count > MEMBERS / 2);
    size_t n = 2 * count + 2;
    for (size_t r = 0; r < 2 * count; r++) {
        size_t to = member[r % count];
        for (size_t c = 0; c < 2 * count; c++) {
            size_t from = member[c % count];
            m[r * n + c] = response(&grid, poisson, (int)(r / count), (int)(c / count),
                                    (to % SIDE_X + SIDE_X - from % SIDE_X) % SIDE_X,
                                    (to / SIDE_X + SIDE_Y - from / SIDE_X) % SIDE_Y);
        }
        m[r * n + 2 * count + r / count] = -1;
        m[(2 * count + r / count) * n + r] = 1.0 / (SIDE_X * SIDE_Y);
    }
    b[2 * count] = cos(angle);
    b[2 * count + 1] = sin(angle);
    eliminate(n, m, b);
    double displacement = b[2 * count] * cos(angle) + b[2 * count + 1] * sin(angle);
    check_relative(measure(&grid, poisson, p, angle).tangential, 1 / displacement, 1e-8);
}

/* --- shapes --- */

static double column(size_t i, size_t side) {
    return (double)(i % side);
}

static double row(size_t i, size_t side) {
    size_t j = i / side;
    return (double)j;
}

static double radius(double a, double b, double angle) {
    return hypot(a * cos(angle), b * sin(angle));
}

/* An ellipse of semi-axes 3 b and b under the traction (1 - r^2)^(-1/2), which moves it as one: its
 * displacement is the mean over the directions of waves of symbol/radius (F24.2). The lattice adds
 * what it adds to a circle, times the mean symbol. Nodes at the edge err to first order in the
 * spacing, mostly alike for both: 12 across the short axis leave 0.3 %. */
static void ellipse(void **state) {
    (void)state;
    enum { SIDE = 256, ANGLES = 3600 };
    const struct grid grid = {.nx = SIDE, .ny = SIDE, .lx = SIDE, .ly = SIDE};
    const double poisson = 0.3, a = 18, b = 6, lattice = 3.9002649 / SIDE;
    double *p = zeros(SIDE * SIDE), across = 0, along[2] = {0};
    for (size_t i = 0; i < SIDE * SIDE; i++)
        p[i] = hypot((column(i, SIDE) - 100.3) / a, (row(i, SIDE) - 90.6) / b) < 1;
    for (size_t i = 0; i < ANGLES; i++) {
        double angle = 2 * PI * (double)i / ANGLES, r = radius(a, b, angle);
        across += PI / 2 / r / ANGLES;
        along[0] += PI / 2 / r / ANGLES * (1 - poisson * pow(cos(angle), 2)) / (1 - poisson);
        along[1] += PI / 2 / r / ANGLES * (1 - poisson * pow(sin(angle), 2)) / (1 - poisson);
    }
    for (size_t d = 0; d < 2; d++) {
        double value = measure(&grid, poisson, p, (double)d * PI / 2).ratio;
        double exact =
            (across - lattice) / (along[d] - lattice * (1 - poisson / 2) / (1 - poisson));
        printf("[   INFO   ] ellipse 3:1, nu 0.3, load %s: k_t/k_n %.4f, closed form %.4f\n",
               d == 0 ? "along" : "across", value, exact);
        check_relative(value, exact, 0.005);
    }
    free(p);
}

/* Presses heights, and returns the ratio for a load along x (0) or y (1). */
static double pressed_ratio(struct scene *scene, double load, int direction) {
    scene_begin(scene);
    scene_press(scene, load);
    return measure(&scene->grid, 0.3, scene->state.p, direction * PI / 2).ratio;
}

/* Waves cos(2 pi x/3) cos(2 pi y). Values of another code, 0.760 and 0.907, are of a load that is
 * not known; from 5 to 25 % of the area in contact ours are 0.772 to 0.744 and 0.882 to 0.924. */
static void waves_with_lay(void **state) {
    (void)state;
    struct scene scene;
    scene_open(&scene, (struct grid){.nx = 192, .ny = 128, .lx = 3, .ly = 1}, DEEP, 1e-8);
    for (size_t i = 0; i < scene_points(&scene); i++)
        scene.z[i] = cos(2 * PI * column(i, 192) / 192) * cos(2 * PI * row(i, 192) / 128);
    double along = pressed_ratio(&scene, 0.2, 0), across = pressed_ratio(&scene, 0.2, 1);
    printf("[   INFO   ] waves 3:1, nu 0.3, %.3f of the area: along %.4f, across %.4f\n",
           (double)scene.state.nodes / (192 * 128), along, across);
    check_relative(along, 0.760, 0.01);
    check_relative(across, 0.907, 0.01);
    scene_close(&scene);
}

/* Waves of random phases, of lengths 1/4 to 1/16 of the side: (1 - nu)/(1 - nu/2) within 0.5 % in
 * the mean of both directions, at 4 % of the area. Above it is exceeded by 0.6 to 0.8 % at 15 %. */
static void isotropic_rough_surface(void **state) {
    (void)state;
    enum { SIDE = 128, LEAST = 4, MOST = 16 };
    struct scene scene;
    scene_open(&scene, (struct grid){.nx = SIDE, .ny = SIDE, .lx = 1, .ly = 1}, DEEP, 1e-8);
    for (int mx = 0; mx <= MOST; mx++)
        for (int my = -MOST; my <= MOST; my++) {
            double m = hypot(mx, my), phase = 100 * sin(12.9898 * mx + 78.233 * my);
            if (m < LEAST || m > MOST || (mx == 0 && my < 0))
                continue;
            for (size_t i = 0; i < SIDE * SIDE; i++) {
                double turn = mx * column(i, SIDE) + my * row(i, SIDE);
                scene.z[i] += pow(m, -1.8) * cos(2 * PI * turn / SIDE + phase);
            }
        }
    double mean = (pressed_ratio(&scene, 0.3, 0) + pressed_ratio(&scene, 0.3, 1)) / 2;
    printf("[   INFO   ] rough, nu 0.3, %.3f of the area: %.4f; (1 - nu)/(1 - nu/2) %.4f\n",
           (double)scene.state.nodes / (SIDE * SIDE), mean, 0.7 / 0.85);
    check_relative(mean, 0.7 / 0.85, 0.005);
    scene_close(&scene);
}

/* --- ends --- */

static int stop_at_once(void *context) {
    (void)context;
    return 1;
}

static void ends(void **state) {
    (void)state;
    struct error err = {0};
    struct held *held = NULL;
    struct held_stiffness out;
    const struct grid grid = {.nx = 16, .ny = 1, .lx = 1, .ly = 1};
    double p[16] = {0};
    assert_int_equal(held_create(&held, &grid, 0.6, &err), ERROR_INPUT);
    assert_non_null(strstr(err.text, "Poisson's ratio of the block = 0.6"));
    assert_null(held);
    out = measure(&grid, 0.3, p, 0);
    assert_true(out.normal == 0 && out.tangential == 0 && isnan(out.ratio));
    for (size_t i = 0; i < 16; i++)
        p[i] = i < 5;
    out = measure(&grid, 0.3, p, 0);
    assert_true(out.normal > 0 && out.ratio == 1 && out.iterations > 0 && out.work > 0);
    for (size_t i = 0; i < 16; i++)
        p[i] = 1;
    out = measure(&grid, 0.3, p, 0);
    assert_true(isinf(out.normal) && isinf(out.tangential) && isnan(out.ratio));
    p[3] = 0;
    assert_int_equal(held_create(&held, &grid, 0.3, &err), 0);
    assert_int_equal(held_measure(held, p, 0, NAN, &out, &err), ERROR_INPUT);
    assert_int_equal(held_measure(held, p, 0, 1e-300, &out, &err), ERROR_NUMERIC);
    assert_non_null(strstr(err.text, "15 nodes"));
    held_set_stop(held, stop_at_once, NULL);
    assert_int_equal(held_measure(held, p, 0, 1e-300, &out, &err), ERROR_STOPPED);
    held_destroy(&held);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(direct_solution), cmocka_unit_test(ellipse),
                                       cmocka_unit_test(waves_with_lay),
                                       cmocka_unit_test(isotropic_rough_surface),
                                       cmocka_unit_test(ends)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
