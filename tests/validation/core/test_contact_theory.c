/* Protects: the theories that contact curves are held against: their normalisation, limits and
 * values by other roads, for alpha from 1.5001 to 1e4; NaN out of their domain. */
#include "core/theory/contact.h"
#include "core/theory/quadrature.h"
#include "tests/support/check.h"
#include "tests/support/drawn_summits.h"
#include "tests/support/hertz.h"

static const double ALPHAS[] = {1.5001, 1.51, 2, 5, 11.89, 206.45, 1e4};
enum { ALPHA_COUNT = sizeof ALPHAS / sizeof *ALPHAS };

typedef void curve_of(double, size_t, const double *, double *, double *);
typedef double area_of(double, double);
static const struct theory {
    curve_of *curve;
    area_of *area;
} THEORIES[] = {{bgt_curve, bgt_area}, {gw_mccool_curve, gw_mccool_area}};

struct pressures {
    double load;
    int order;
};

static double persson_integrand(double x, const void *context) {
    const struct pressures *p = context;
    return pow(x, p->order) * persson_pressure_pdf(x, p->load);
}

/* Its integral is the fraction and its mean the load. 1e-12: rounding, for smooth integrands whose
 * Gaussians are 0.5 wide and cut 5 off their centre (e^-50). */
static void persson_pressures_carry_the_load(void **state) {
    (void)state;
    for (double load = 1e-12; load < 200; load *= 7) {
        struct pressures zeroth = {load, 0}, first = {load, 1};
        double low = fmax(0, load - 5), high = load + 5;
        check_relative(quadrature(persson_integrand, &zeroth, low, high, 20), persson_area(load),
                       1e-12);
        check_relative(quadrature(persson_integrand, &first, low, high, 20), load, 1e-12);
    }
    check_relative(persson_area(1e-9) / 1e-9, persson_light_load(), 1e-14);
    check_relative(persson_area(0.5), 0.682689492137086, 1e-14); /* one standard deviation */
    check_close(persson_light_load(), 1.595769121605731, 1e-15);
    check_close(bgt_light_load(), 2.506628274631, 1e-15);
}

/* Shares between two absorbing ends: the sum over waves, which takes as many terms as the hardness
 * is high. 1e-14: rounding of sums of alternating terms. */
static double share_by_waves(double load, double hardness, bool plastic) {
    double share = plastic ? load / hardness : 0;
    for (int n = 1; n <= 20 + 10 * hardness; n++) {
        double sign = n % 2 == 0 ? 1 : -1, decay = exp(-pow(n * M_PI / hardness, 2) / 8);
        double factor = plastic ? 2 * sign : 2 * (1 - sign);
        share += factor / (n * M_PI) * sin(n * M_PI * load / hardness) * decay;
    }
    return share;
}

static void hardness_bounds_the_pressures(void **state) {
    (void)state;
    static const double HARDNESS[] = {0.003, 0.1, 0.7, 0.999, 1.001, 1.5, 3, 10, 40};
    for (size_t h = 0; h < sizeof HARDNESS / sizeof *HARDNESS; h++)
        for (double x = 0; x <= 1; x += 0.0625) {
            double load = x * HARDNESS[h], hardness = HARDNESS[h];
            double plastic = persson_plastic_area(load, hardness);
            double elastic = persson_elastic_area(load, hardness);
            check_close(plastic, share_by_waves(load, hardness, true), 1e-14);
            check_close(elastic, share_by_waves(load, hardness, false), 1e-14);
            assert_true(plastic >= 0 && elastic >= 0 && plastic + elastic <= 1 + 1e-14);
            assert_true(hardness * (plastic + elastic) >= load * (1 - 1e-14));
        }
    /* Soft faces bear all at the hardness; hard ones are elastic. */
    check_relative(persson_plastic_area(0.003, 0.01), 0.3, 1e-14);
    assert_true(persson_elastic_area(0.003, 0.01) < 1e-14);
    for (double load = 1e-3; load < 1e3; load *= 10) {
        assert_true(persson_elastic_area(load, INFINITY) == persson_area(load));
        check_close(persson_elastic_area(load, 1e12), persson_area(load), 1e-14);
        assert_true(persson_plastic_area(load, INFINITY) == 0);
        assert_true(persson_plastic_area(load, 1e300) == 0);
    }
}

/* Pressures' Fourier coefficients over their mean, m = 0 to modes - 1: over t in
 * sin(psi) = sqrt(ratio) sin(t) the integrand is smooth and periodic, so equal steps are exact once
 * they resolve the mode. */
static void pressure_modes(double ratio, size_t modes, double *coefficient) {
    size_t steps = 4 * modes;
    for (size_t m = 0; m < modes; m++)
        coefficient[m] = 0;
    for (size_t n = 0; n < steps; n++) {
        double t = M_PI * (((double)n + 0.5) / (double)steps - 0.5);
        double psi = asin(sqrt(ratio) * sin(t));
        double slope = sqrt(ratio) * cos(t) / (M_PI * cos(psi)); /* dx/dt */
        double share = westergaard_pressure(psi / M_PI, ratio) * slope * M_PI / (double)steps;
        for (size_t m = 0; m < modes; m++)
            coefficient[m] += share * cos(2 * (double)m * psi);
    }
}

/* The gap over the amplitude that those pressures leave at x, by the half-space's 2/(E* |k|). */
static double wave_gap(double x, double ratio, size_t modes, const double *coefficient) {
    double displacement = 0;
    for (size_t m = modes; m-- > 1;)
        displacement += coefficient[m] * cos(2 * M_PI * (double)m * x) / (double)m;
    return westergaard_gap(ratio) - cos(2 * M_PI * x) + 2 * ratio * displacement;
}

/* Westergaard's pressure, area and mean gap belong together: the pressure carries its mean, closes
 * the gap over the contact and nowhere else. 1e-4: coefficients fall as m^-1.5, so 1000 modes leave
 * 1000^-1.5 = 3e-5 times a factor of order 1. */
static void westergaard_is_a_contact(void **state) {
    (void)state;
    static double coefficient[1000];
    for (double ratio = 0.05; ratio < 1; ratio += 0.3) {
        pressure_modes(ratio, 1000, coefficient);
        check_close(coefficient[0], 1, 1e-9);
        double edge = westergaard_area(ratio) / 2;
        for (int i = 0; i < 8; i++)
            check_close(wave_gap(edge * i / 8, ratio, 1000, coefficient), 0, 1e-4);
        for (int i = 1; i <= 4; i++) {
            double x = edge + (0.5 - edge) * i / 4;
            assert_true(wave_gap(x, ratio, 1000, coefficient) > 1e-3 * (1 - ratio));
            assert_true(westergaard_pressure(x, ratio) == 0);
        }
        check_relative(westergaard_pressure(1 + edge / 3, ratio),
                       westergaard_pressure(-edge / 3, ratio), 1e-12);
    }
}

static void westergaard_has_its_limits(void **state) {
    (void)state;
    check_close(westergaard_area(0), 0, 0);
    check_close(westergaard_area(0.5), 0.5, 1e-15);
    check_close(westergaard_area(1), 1, 1e-15);
    check_close(westergaard_gap(0), 1, 0);
    check_close(westergaard_gap(1e-300), 1, 1e-15);
    check_close(westergaard_gap(1), 0, 0);
    /* (1 - ratio)^2/2 near full contact; what cancels there is 1e-16 (1 - ratio). */
    check_relative(westergaard_gap(1 - 1e-4), 0.5e-8, 1e-4);
    /* At full contact the pressure is 1 + cos(2 pi x): never negative. */
    for (double x = -0.5; x <= 0.5; x += 0.125)
        check_close(westergaard_pressure(x, 1), 1 + cos(2 * M_PI * x), 1e-14);
    /* A narrow contact is Hertz's: R = wavelength^2/(4 pi^2 amplitude), P = p wavelength.
     * Corrections are of the order of the ratio. */
    double ratio = 1e-6, amplitude = 0.01;
    double load = ratio * M_PI * amplitude, radius = 1 / (4 * M_PI * M_PI * amplitude);
    check_relative(westergaard_area(ratio) / 2, hertz_line_half_width(load, radius), 1e-6);
    check_relative(hertz_sphere_radius(4, 9), 3, 1e-15);
    check_relative(hertz_line_half_width(M_PI, 4), 4, 1e-15);
}

/* Greenwood & Williamson with McCool's parameters, in units: spheres of radius R on D summits an
 * area, by Simpson's rule over the root of the compression. */
static void spheres_by_hand(const double *moment, double separation, double *load, double *area) {
    double m0 = moment[0], m2 = moment[1], m4 = moment[2], alpha = m0 * m4 / (m2 * m2);
    double density = m4 / (m2 * 6 * M_PI * sqrt(3)), radius = 3 * sqrt(M_PI) / (8 * sqrt(m4));
    double deviation = sqrt(m0 * (1 - 0.896805756 / alpha));
    double distance = separation * sqrt(m0) - 4 * sqrt(m0 / (M_PI * alpha));
    double end = sqrt(fmax(0, -distance) + 9 * deviation), width = end / 4000;
    *load = *area = 0;
    for (int n = 0; n <= 4000; n++) {
        double root = n * width, t = (distance + root * root) / deviation;
        double simpson = width / 3 * (n == 0 || n == 4000 ? 1 : n % 2 ? 4 : 2);
        double heights = exp(-t * t / 2) / (sqrt(2 * M_PI) * deviation) * 2 * root * simpson;
        *area += heights * density * M_PI * radius * root * root;
        *load += heights * density * 4 / 3 * sqrt(radius) * pow(root, 3) / sqrt(2 * m2);
    }
}

/* The dimensionless curve depends on alpha alone: two surfaces of alpha 12, one a micrometre rough,
 * and one near the least alpha. 1e-8: the printed digits of 0.896805756; Simpson's error is
 * below 1e-10. */
static void spheres_agree_with_units(void **state) {
    (void)state;
    static const double MOMENTS[][3] = {{1, 1, 12}, {1e-12, 0.02, 4.8e9}, {2, 3, 6.8}};
    for (size_t m = 0; m < 3; m++) {
        const double *moment = MOMENTS[m];
        double alpha = moment[0] * moment[2] / (moment[1] * moment[1]);
        for (double separation = -4; separation <= 5; separation++) {
            double load, area, expected_load, expected_area;
            gw_mccool_curve(alpha, 1, &separation, &load, &area);
            spheres_by_hand(moment, separation, &expected_load, &expected_area);
            check_relative(load, expected_load, 1e-8);
            check_relative(area, expected_area, 1e-8);
        }
    }
}

/* Alpha, separation, fraction, load, computed apart in Python, by products of Gauss-Legendre rules
 * over height (400 nodes), mean curvature (120) and aspect ratio b/a (180). The integrand is
 * Nayak's joint density times that of the elongation, with Hertz's ellipses in K(e) and E(e) with
 * 40 digits and a numerical derivative. 1e-11: both rules' rounding and truncation, 3e-12 seen. */
static const double BGT_VALUES[][4] = {
    // clang-format off
    {1.51, -3, 0.4767445987276, 0.3822313884651},
    {1.51, 0, 0.1637574303756, 0.08670234515367},
    {1.51, 3, 0.0006430740941318, 0.0002626627860556},
    {1.51, 6, 4.862744296652e-10, 1.953304025582e-10},
    {2, -3, 0.523965195198, 0.44030750966},
    {2, 0, 0.1644356456343, 0.09054600692151},
    {2, 3, 0.0006300700300723, 0.0002600535809771},
    {2, 6, 4.8387336594e-10, 1.948316241341e-10},
    {5, -3, 0.7332961854986, 0.7282471999351},
    {5, 0, 0.1790179127841, 0.1139051544767},
    {5, 3, 0.0005574971466909, 0.0002489607287977},
    {5, 6, 4.669925094084e-10, 1.914079378027e-10},
    {11.89, -3, 1.042036075599, 1.232224306407},
    {11.89, 0, 0.2124226717885, 0.1579257288281},
    {11.89, 3, 0.0005051593140265, 0.0002551696760798},
    {11.89, 6, 4.269462992619e-10, 1.848538056702e-10},
    {206.45, -3, 3.823738008196, 8.637316449775},
    {206.45, 0, 0.5718280926043, 0.7827259802953},
    {206.45, 3, 0.0007253471790311, 0.0006458297582032},
    {206.45, 6, 4.063683946075e-10, 2.819396635925e-10},
    {10000, -3, 25.63732653593, 149.7828276396},
    {10000, 0, 3.469441564045, 12.12647625935},
    {10000, 3, 0.003470884457772, 0.00779132987958},
    {10000, 6, 1.496333906841e-09, 2.56042011631e-09},
    // clang-format on
};

static void ellipses_have_their_values(void **state) {
    (void)state;
    for (size_t n = 0; n < sizeof BGT_VALUES / sizeof *BGT_VALUES; n++) {
        const double *row = BGT_VALUES[n];
        double load, area;
        bgt_curve(row[0], 1, &row[1], &load, &area);
        check_relative(area, row[2], 1e-11);
        check_relative(load, row[3], 1e-11);
    }
}

/* The theory from its premises, at alphas near its bound and far from it. */
static void ellipses_agree_with_drawn_summits(void **state) {
    (void)state;
    enum { DRAWS = 400000 };
    static const double TRIED[] = {1.6, 5, 50}, SEPARATION = 0.5;
    for (size_t c = 0; c < 3; c++) {
        double load, area;
        bgt_curve(TRIED[c], 1, &SEPARATION, &load, &area);
        drawn_summits_check(DRAWS, c, TRIED[c], NULL, 1, SEPARATION, area, load);
    }
}

static double bgt_slope(double alpha, double separation) {
    double load, area;
    bgt_curve(alpha, 1, &separation, &load, &area);
    return area / load / bgt_light_load();
}

/* The fraction over the load rises to sqrt(2 pi) from below as separation grows, with a deviation
 * in even powers of sqrt(alpha)/separation: two separations cancel the first, and leave less than
 * the square of the smaller's. */
static void light_loads_tend_to_their_line(void **state) {
    (void)state;
    size_t compared = 0;
    for (size_t a = 0; a < ALPHA_COUNT; a++) {
        double alpha = ALPHAS[a];
        for (double d = -4; d < 36; d += 0.5)
            assert_true(bgt_slope(alpha, d) < bgt_slope(alpha, d + 0.5));
        assert_true(bgt_slope(alpha, 36) < 1);
        double left = alpha / (18 * 18);
        if (left < 1) {
            check_close((4 * bgt_slope(alpha, 36) - bgt_slope(alpha, 18)) / 3, 1,
                        left * left + 1e-5);
            compared++;
        }
    }
    assert_int_equal(compared, 6);
}

/* Both fall with separation, without end on either side, until they underflow. */
static void curves_fall_with_separation(void **state) {
    (void)state;
    for (size_t t = 0; t < 2; t++)
        for (size_t a = 0; a < ALPHA_COUNT; a++) {
            double separation[200], load[200], area[200];
            for (int n = 0; n < 200; n++)
                separation[n] = -12 + 0.1 * n;
            THEORIES[t].curve(ALPHAS[a], 200, separation, load, area);
            assert_true(load[199] > 0 && area[199] > 0);
            for (int n = 1; n < 200; n++)
                assert_true(load[n] < load[n - 1] && area[n] < area[n - 1]);
            static const double FAR[] = {45, 1e17, 1e300};
            THEORIES[t].curve(ALPHAS[a], 3, FAR, load, area);
            for (int n = 0; n < 3; n++)
                assert_true(load[n] == 0 && area[n] == 0);
        }
}

/* 1e-10: the inversion's 1e-12 in the load and the curve's own rounding. */
static void inversion_returns_to_the_curve(void **state) {
    (void)state;
    for (size_t t = 0; t < 2; t++)
        for (size_t a = 0; a < ALPHA_COUNT; a++) {
            for (double separation = -20; separation < 12; separation += 0.77) {
                double load, area;
                THEORIES[t].curve(ALPHAS[a], 1, &separation, &load, &area);
                check_relative(THEORIES[t].area(load, ALPHAS[a]), area, 1e-10);
            }
            double last = 0;
            for (double load = 1e-8; load < 12; load *= 1.7) {
                double area = THEORIES[t].area(load, ALPHAS[a]);
                assert_true(area > last);
                last = area;
            }
            assert_true(THEORIES[t].area(1e-250, ALPHAS[a]) > 0);
            assert_true(isfinite(THEORIES[t].area(1e6, ALPHAS[a])));
        }
}

static void out_of_domain_is_no_number(void **state) {
    (void)state;
    static const double BAD_ALPHAS[] = {1.5, 1, 0, -3, NAN, INFINITY};
    static const double BAD_LOADS[] = {0, -1, NAN, INFINITY, 1e-260, 1e7};
    static const double BAD_SEPARATIONS[] = {NAN, INFINITY, -INFINITY};
    for (size_t t = 0; t < 2; t++) {
        double load[3], area[3], fine[3] = {-1, 0, 1};
        for (size_t n = 0; n < 6; n++) {
            THEORIES[t].curve(BAD_ALPHAS[n], 3, fine, load, area);
            for (int i = 0; i < 3; i++)
                assert_true(isnan(load[i]) && isnan(area[i]));
            assert_true(isnan(THEORIES[t].area(0.1, BAD_ALPHAS[n])));
            assert_true(isnan(THEORIES[t].area(BAD_LOADS[n], 5)));
        }
        THEORIES[t].curve(5, 3, BAD_SEPARATIONS, load, area);
        for (int i = 0; i < 3; i++)
            assert_true(isnan(load[i]) && isnan(area[i]));
    }
    assert_true(isnan(persson_area(-1e-9)) && isnan(persson_area(NAN)));
    assert_true(isnan(persson_plastic_area(-1e-9, 1)) && isnan(persson_elastic_area(-1e-9, 1)));
    assert_true(isnan(persson_plastic_area(1.001, 1)) && isnan(persson_elastic_area(1.001, 1)));
    assert_true(isnan(persson_plastic_area(0, 0)) && isnan(persson_elastic_area(NAN, NAN)));
    assert_true(isnan(persson_pressure_pdf(-1, 1)) && isnan(persson_pressure_pdf(1, -1)));
    assert_true(isnan(westergaard_area(1.001)) && isnan(westergaard_area(-0.001)));
    assert_true(isnan(westergaard_gap(NAN)) && isnan(westergaard_gap(1.001)));
    assert_true(isnan(westergaard_pressure(0, 0)) && isnan(westergaard_pressure(INFINITY, 0.5)));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(persson_pressures_carry_the_load),
        cmocka_unit_test(hardness_bounds_the_pressures),
        cmocka_unit_test(westergaard_is_a_contact),
        cmocka_unit_test(westergaard_has_its_limits),
        cmocka_unit_test(spheres_agree_with_units),
        cmocka_unit_test(ellipses_have_their_values),
        cmocka_unit_test(ellipses_agree_with_drawn_summits),
        cmocka_unit_test(light_loads_tend_to_their_line),
        cmocka_unit_test(curves_fall_with_separation),
        cmocka_unit_test(inversion_returns_to_the_curve),
        cmocka_unit_test(out_of_domain_is_no_number),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
