/* Protects: Nayak's functions against computed values, their own integrals and their limits, for
 * every alpha from 1.5001 to 1e4. */
#include "core/theory/nayak.h"
#include "core/theory/quadrature.h"
#include "tests/support/check.h"
#include "tests/support/effort.h"

static const double ALPHAS[] = {1.5001, 1.51, 1.6, 2, 3.7617, 5, 11.89, 206.45, 1e4};
enum { ALPHA_COUNT = sizeof ALPHAS / sizeof *ALPHAS };

/* 1e-9 relative; 1e-6 near alpha = 1.5, where the densities turn steep. */
static double tolerance(double alpha) {
    return alpha < 1.51 ? 1e-6 : 1e-9;
}

/* Values of F6.9, computed with other formulas; printed to 12 digits. */
static void values(void **state) {
    (void)state;
    static const double SUMMITS_5[] = {0.00157918086611, 0.0368965781848, 0.238734539355,
                                       0.440589833349,   0.239972906815,  0.0400447123382};
    static const double SUMMITS_12[] = {0.00906936812777, 0.094410967995, 0.329684336652,
                                        0.388569701421,   0.155616307033, 0.0213305263227};
    static const double CURVATURES[] = {0.985763871473, 1.122953361,   1.28837924175,
                                        1.48712166005,  1.72353316362, 1.99987556893};
    for (int z = -2; z <= 3; z++) {
        check_relative(nayak_summit_pdf(z, 5), SUMMITS_5[z + 2], 3e-12);
        check_relative(nayak_summit_pdf(z, 11.89), SUMMITS_12[z + 2], 3e-12);
        check_relative(nayak_mean_curvature(z, 5), CURVATURES[z + 2], 3e-12);
    }
    check_relative(nayak_joint_pdf(0, -2, 5), 0.126779835284, 3e-12);
    check_relative(nayak_joint_pdf(1, -2.5, 5), 0.211687756196, 3e-12);
    check_relative(nayak_joint_pdf(2, -3, 5), 0.104407216828, 3e-12);
}

struct moment {
    double alpha;
    int order;
    double (*pdf)(double, double);
};

static double weighted(double z, const void *context) {
    const struct moment *m = context;
    return pow(z, m->order) * m->pdf(z, m->alpha);
}

static double integral(double alpha, int order, double (*pdf)(double, double)) {
    struct moment m = {alpha, order, pdf};
    double low = alpha < 1.52 ? -2 : -14; /* steep at zero: finer panels there */
    return quadrature(weighted, &m, low, 0, 400) + quadrature(weighted, &m, 0, 14, 400);
}

static void densities_have_their_moments(void **state) {
    (void)state;
    for (size_t a = 0; a < ALPHA_COUNT; a += case_step()) {
        double alpha = ALPHAS[a], mean = integral(alpha, 1, nayak_summit_pdf);
        check_close(integral(alpha, 0, nayak_summit_pdf), 1, tolerance(alpha));
        check_relative(mean, 4 / sqrt(M_PI * alpha), tolerance(alpha));
        check_relative(nayak_summit_mean(alpha), mean, tolerance(alpha));
        double variance = integral(alpha, 2, nayak_summit_pdf) - mean * mean;
        check_relative(nayak_summit_variance(alpha), variance, tolerance(alpha));
        check_close((1 - nayak_summit_variance(alpha)) * alpha, 0.896805756, 1e-9 * alpha);
    }
}

static void distribution_is_the_integral(void **state) {
    (void)state;
    for (size_t a = 0; a < ALPHA_COUNT; a += case_step())
        for (double z = -1; z <= 3; z += 0.7) {
            struct moment m = {ALPHAS[a], 0, nayak_summit_pdf};
            double low = ALPHAS[a] < 1.52 ? -2 : -14;
            double sum = quadrature(weighted, &m, low, fmin(z, 0), 400) +
                         quadrature(weighted, &m, 0, z, 400);
            check_close(nayak_summit_cdf(z, ALPHAS[a]), sum, tolerance(ALPHAS[a]));
        }
    check_close(nayak_summit_cdf(20, 5), 1, 1e-12);
    check_close(nayak_summit_cdf(-20, 5), 0, 1e-12);
}

struct slice {
    double z, alpha;
    int order;
};

static double joint_slice(double s, const void *context) {
    const struct slice *slice = context;
    return pow(s, slice->order) * nayak_joint_pdf(slice->z, -s, slice->alpha);
}

static void joint_density_has_its_marginals(void **state) {
    (void)state;
    for (size_t a = 1; a < ALPHA_COUNT; a++)
        for (double z = -1; z <= 3; z += 0.5) {
            struct slice zeroth = {z, ALPHAS[a], 0}, first = {z, ALPHAS[a], 1};
            double density = quadrature(joint_slice, &zeroth, 0, 20, 600);
            double curvature = quadrature(joint_slice, &first, 0, 20, 600);
            if (density < 1e-200)
                continue;
            check_relative(nayak_summit_pdf(z, ALPHAS[a]), density, 1e-9);
            check_relative(nayak_mean_curvature(z, ALPHAS[a]), curvature / density / sqrt(3), 1e-9);
        }
    assert_true(nayak_joint_pdf(0, 0, 5) == 0 && nayak_joint_pdf(0, 1, 5) == 0);
}

static double curvature_weighted(double z, const void *context) {
    const struct moment *m = context;
    double density = nayak_summit_pdf(z, m->alpha);
    return density > 0 ? density * nayak_mean_curvature(z, m->alpha) : 0;
}

/* Mean curvature over all summits is the same for every alpha. */
static void overall_curvature(void **state) {
    (void)state;
    check_close(nayak_overall_curvature(), 1.50450556, 5e-9);
    for (size_t a = 0; a < ALPHA_COUNT; a += case_step()) {
        struct moment m = {ALPHAS[a], 0, NULL};
        double low = ALPHAS[a] < 1.52 ? -2 : -14;
        double mean = quadrature(curvature_weighted, &m, low, 0, 400) +
                      quadrature(curvature_weighted, &m, 0, 14, 400);
        check_relative(mean, nayak_overall_curvature(), tolerance(ALPHAS[a]));
    }
}

static void limits(void **state) {
    (void)state;
    for (double z = 0.5; z <= 3; z += 0.5) /* alpha -> 3/2: falls with alpha - 3/2 */
        check_relative(nayak_mean_curvature(z, 1.5 + 1e-8), sqrt(2.0 / 3) * z, 1e-6);
    for (double z = -2; z <= 2; z++)
        check_relative(nayak_mean_curvature(z, 1e12), nayak_overall_curvature(), 1e-5);
    /* The distance from a Gaussian falls as 0.54607/sqrt(alpha), from 0.668 times that root at
     * alpha = 3/2. */
    for (size_t a = 0; a < ALPHA_COUNT; a++) {
        double farthest = 0;
        for (double z = -4; z <= 4; z += 0.01) {
            double normal = exp(-z * z / 2) / sqrt(2 * M_PI);
            farthest = fmax(farthest, fabs(nayak_summit_pdf(z, ALPHAS[a]) - normal));
        }
        assert_true(farthest <= 0.668 / sqrt(ALPHAS[a]));
        if (ALPHAS[a] >= 1e4)
            check_close(farthest * sqrt(ALPHAS[a]), 0.54607, 1e-5);
    }
}

static void out_of_domain_is_no_number(void **state) {
    (void)state;
    static const double BAD[] = {1.5, 1, 0, -3, NAN, INFINITY};
    for (size_t b = 0; b < sizeof BAD / sizeof *BAD; b++) {
        assert_true(isnan(nayak_summit_pdf(0, BAD[b])));
        assert_true(isnan(nayak_summit_cdf(0, BAD[b])));
        assert_true(isnan(nayak_joint_pdf(0, -1, BAD[b])));
        assert_true(isnan(nayak_mean_curvature(0, BAD[b])));
    }
    assert_true(isnan(nayak_summit_pdf(NAN, 5)));
    assert_true(nayak_summit_pdf(-40, 1.5001) == 0);
    assert_true(isfinite(nayak_summit_pdf(40, 1e4)));
    assert_true(isfinite(nayak_joint_pdf(3, -3, 1.5001)));
}

static double profile_slice(double s, const void *context) {
    const struct slice *slice = context;
    return pow(s, slice->order) * profile_peak_joint_pdf(slice->z, -s, slice->alpha);
}

static void profile_joint_has_its_marginals(void **state) {
    (void)state;
    static const double PROFILE[] = {1.01, 1.5, 5, 1e4};
    /* Heights on both sides of where the continued fraction takes over; at 1.01 the quadrature's
     * own argument of the exponential holds it to 1e-12. */
    for (size_t a = 0; a < 4; a++)
        for (double z = -1.75; z <= 3; z += 0.25) {
            struct slice zeroth = {z, PROFILE[a], 0}, first = {z, PROFILE[a], 1};
            double density = quadrature(profile_slice, &zeroth, 0, 20, 600);
            double curvature = quadrature(profile_slice, &first, 0, 20, 600);
            check_relative(profile_peak_pdf(z, PROFILE[a]), density, 1e-12);
            check_relative(profile_mean_curvature(z, PROFILE[a]), curvature / density, 1e-12);
        }
    assert_true(profile_peak_joint_pdf(0, 0, 5) == 0 && isnan(profile_peak_joint_pdf(0, -1, 1)));
}

/* Peaks of profiles: the density integrates to 1, its closed distribution is its integral, and the
 * limits alpha -> 1 (Rayleigh) and alpha -> infinity (normal) hold. */
static void profile_peaks(void **state) {
    (void)state;
    static const double PROFILE[] = {1.01, 1.5, 5, 1e4};
    for (size_t a = 0; a < 4; a++) {
        double alpha = PROFILE[a];
        struct moment m = {alpha, 0, profile_peak_pdf};
        double below = quadrature(weighted, &m, -14, 0, 800),
               sum = below + quadrature(weighted, &m, 0, 0.7, 200);
        check_close(below + quadrature(weighted, &m, 0, 14, 800), 1, 1e-9);
        check_close(profile_peak_cdf(0.7, alpha), sum, 1e-9);
    }
    check_relative(profile_peak_pdf(1, 1 + 1e-10), exp(-0.5), 1e-4);
    check_relative(profile_peak_pdf(1, 1e12), exp(-0.5) / sqrt(2 * M_PI), 1e-5);
    check_relative(profile_mean_curvature(0, 1e12), sqrt(M_PI / 2), 1e-5);
    check_relative(profile_peak_density(4, 16), 1 / M_PI, 1e-15);
    assert_true(isnan(profile_peak_pdf(0, 1)));
}

/* --- moments of all summit heights --- */

struct height_slice {
    double (*joint)(double, double, double);
    double alpha, z;
    int order;
};

static double over_curvature(double s, const void *context) {
    const struct height_slice *slice = context;
    return slice->joint(slice->z, -s, slice->alpha);
}

static double over_height(double z, const void *context) {
    struct height_slice slice = *(const struct height_slice *)context;
    slice.z = z;
    return pow(z, slice.order) * quadrature(over_curvature, &slice, 0, 16, 20);
}

/* The first four moments of the joint density over heights and curvatures, term by term. */
static void check_moments(int dimension, double alpha, double (*joint)(double, double, double)) {
    double m[5];
    for (int order = 0; order <= 4; order++) {
        struct height_slice slice = {joint, alpha, 0, order};
        m[order] = quadrature(over_height, &slice, -12, 12, 50);
    }
    double variance = m[2] - m[1] * m[1];
    double third = m[3] - 3 * m[1] * m[2] + 2 * m[1] * m[1] * m[1];
    double fourth = m[4] - 4 * m[1] * m[3] + 6 * m[1] * m[1] * m[2] - 3 * pow(m[1], 4);
    struct summit_expectation found = summit_expectation(dimension, 1, 1, alpha);
    check_close(m[0], 1, 1e-9);
    check_close(found.height_mean, m[1], 1e-9);
    check_close(found.height_variance, variance, 1e-9);
    check_close(found.height_skewness, third / pow(variance, 1.5), 1e-8);
    check_close(found.height_kurtosis, fourth / (variance * variance), 1e-8);
}

static void moments_of_heights(void **state) {
    (void)state;
    static const double SOME[] = {2, 5, 206.45};
    for (size_t a = 0; a < sizeof SOME / sizeof *SOME; a++) {
        check_moments(2, SOME[a], nayak_joint_pdf);
        check_moments(1, SOME[a], profile_peak_joint_pdf);
    }
    struct summit_expectation nearly_normal = summit_expectation(2, 1, 1, 1e9);
    check_close(nearly_normal.height_skewness, 0, 1e-9);
    check_close(nearly_normal.height_kurtosis, 3, 1e-9);
    assert_true(isnan(summit_expectation(2, 1, 1, 1.5).height_skewness));
    assert_true(isnan(summit_expectation(1, 1, 1, 1).height_kurtosis));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(values),
        cmocka_unit_test(densities_have_their_moments),
        cmocka_unit_test(distribution_is_the_integral),
        cmocka_unit_test(joint_density_has_its_marginals),
        cmocka_unit_test(overall_curvature),
        cmocka_unit_test(limits),
        cmocka_unit_test(out_of_domain_is_no_number),
        cmocka_unit_test(profile_joint_has_its_marginals),
        cmocka_unit_test(profile_peaks),
        cmocka_unit_test(moments_of_heights),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
