/* Protects: a stratified face is at each point the lower of two independent Gaussian surfaces,
 * about its mean, on every grid; its heights follow the closed law, its slopes their shares. */
#include "core/surface/plateau_face.h"
#include "core/surface/surface.h"
#include "tests/support/check.h"
#include "tests/support/seed.h"
#include <gsl/gsl_cdf.h>
#include <stdlib.h>
#include <string.h>

static struct spectrum self_affine(double hurst, double longest, double shortest, double slope) {
    return (struct spectrum){.type = SPECTRUM_SELF_AFFINE,
                             .hurst = hurst,
                             .wavelength_long = longest,
                             .wavelength_rolloff = longest,
                             .wavelength_short = shortest,
                             .scale = SCALE_RMS_SLOPE,
                             .scale_value = slope};
}

static double *generate(const struct spectrum *spectrum, const struct grid *grid,
                        const struct surface_options *options, struct random_key key,
                        struct team *team, struct generator **generator) {
    double *z = malloc(grid_points(grid) * sizeof *z);
    assert_non_null(z);
    assert_int_equal(generator_create(generator, spectrum, grid, options, NULL), 0);
    if (team != NULL)
        assert_int_equal(generator_set_team(*generator, team, NULL), 0);
    assert_int_equal(generator_run(*generator, key, z, NULL, NULL), 0);
    return z;
}

/* The closed form against sums over the law's density, by differences of its distribution. */
static void moments_of_the_law(void **state) {
    (void)state;
    uint64_t seed = seed_or(21);
    for (int n = 0; n < 20; n++) {
        const double ratio = 0.05 + 0.95 * (double)(next_word(&seed) >> 11) * 0x1p-53;
        const double offset = 4 * (double)(next_word(&seed) >> 11) * 0x1p-53 - 2;
        const struct stratified_heights law = stratified_heights_of(2, 2 * ratio, 2 * offset);
        const struct height_moments moments = stratified_moments(&law);
        const double step = 1e-3;
        double sums[5] = {0};
        for (double z = -20; z < 20; z += step) {
            const double share =
                stratified_cdf(&law, z + step / 2) - stratified_cdf(&law, z - step / 2);
            for (int power = 0; power < 5; power++)
                sums[power] += share * pow(z, power);
            const double at = law.mean + z * law.deviation;
            check_close(1 - stratified_cdf(&law, z),
                        gsl_cdf_ugaussian_Q(at / 2) *
                            gsl_cdf_ugaussian_Q((at - 2 * offset) / (2 * ratio)),
                        1e-14);
        }
        check_close(sums[0], 1, 1e-12);
        check_close(sums[1], 0, 1e-8);
        check_close(sums[2], 1, 1e-6); /* bins add their own variance, step^2/12 */
        check_close(moments.skewness, sums[3], 1e-5);
        check_close(moments.kurtosis, sums[4], 1e-5 * sums[4]);
    }
    const struct stratified_heights same = stratified_heights_of(1, 1, 0);
    check_close(same.mean, -1 / sqrt(M_PI), 1e-14);
    check_close(same.deviation, sqrt(1 - 1 / M_PI), 1e-14);
    check_close(same.valley_share, 0.5, 1e-15);
    const struct stratified_heights high = stratified_heights_of(1, 0.5, 30);
    const struct height_moments gaussian = stratified_moments(&high);
    check_close(high.mean, 0, 1e-14);
    check_close(high.deviation, 1, 1e-14);
    check_close(gaussian.skewness, 0, 1e-12);
    check_close(gaussian.kurtosis, 3, 1e-12);
}

/* The straight lines of both on a normal plot cross where the share asked for lies above. */
static void offset_of_a_share(void **state) {
    (void)state;
    for (double share = 0.1; share < 1; share += 0.2) {
        const double ratio = 0.3, offset = stratified_offset(ratio, share);
        const double score = gsl_cdf_ugaussian_Qinv(share);
        check_close(offset + ratio * score, score, 1e-14);
    }
}

static const struct grid GRIDS[] = {{128, 128, 8, 8}, {192, 64, 12, 4}, {1024, 1, 32, 1}};

static void lower_of_both(void **state) {
    (void)state;
    struct team *team = NULL;
    assert_int_equal(team_create(&team, 3, NULL), 0);
    for (int g = 0; g < 6; g++) {
        const struct grid *grid = &GRIDS[g % 3];
        struct grid finer = *grid;
        finer.nx *= 2;
        finer.ny *= finer.ny > 1 ? 2 : 1;
        const struct random_key key = {7, 3, 2};
        struct random_key other_key = key;
        other_key.sequence ^= UINT64_C(1) << PLATEAU_BIT;
        struct surface_options options = SURFACE_DEFAULTS;
        options.amplitudes = g < 3 ? AMPLITUDES_FIXED : AMPLITUDES_RANDOM;
        const struct spectrum one = self_affine(0.8, 4, 1, 0.1);
        const struct plateau_face plateau = {self_affine(0.3, 4, 0.5, 7), options, 0.25, -0.6};
        struct spectrum both = one;
        both.plateau = &plateau;
        struct generator *of_one = NULL, *of_other = NULL, *of_both = NULL, *fine = NULL;
        struct generator *with_team = NULL;
        struct moments m, n, face;
        double *a = generate(&one, grid, &options, key, NULL, &of_one);
        modes_moments(generator_modes(of_one), &m);
        const struct spectrum second = plateau_spectrum(&both, m.rms_height);
        double *b = generate(&second, grid, &options, other_key, NULL, &of_other);
        double *z = generate(&both, grid, &options, key, NULL, &of_both);
        double *y = generate(&both, &finer, &options, key, NULL, &fine);
        double *x = generate(&both, grid, &options, key, team, &with_team);
        modes_moments(generator_modes(of_other), &n);
        modes_moments(generator_modes(of_both), &face);
        check_close(n.rms_height, 0.25 * m.rms_height, 1e-14);
        const struct stratified_heights law =
            stratified_heights_of(m.rms_height, n.rms_height, -0.6 * m.rms_height);
        size_t lower = 0;
        for (size_t j = 0; j < grid->ny; j++)
            for (size_t i = 0; i < grid->nx; i++) {
                const size_t at = j * grid->nx + i;
                assert_true(z[at] == fmin(a[at], b[at] + law.offset) - law.mean);
                check_close(y[2 * j * finer.nx + 2 * i], z[at], 1e-12);
                lower += a[at] < b[at] + law.offset;
            }
        assert_true(lower > 0 && lower < grid_points(grid));
        assert_memory_equal(x, z, grid_points(grid) * sizeof *z);
        check_close(face.rms_height, law.deviation, 1e-14);
        check_close(pow(face.rms_slope, 2),
                    law.valley_share * pow(m.rms_slope, 2) +
                        (1 - law.valley_share) * pow(n.rms_slope, 2),
                    1e-12);
        struct generator *all[] = {of_one, of_other, of_both, fine, with_team};
        double *heights[] = {a, b, z, y, x};
        for (size_t k = 0; k < 5; k++) {
            generator_destroy(&all[k]);
            free(heights[k]);
        }
    }
    team_destroy(&team);
}

/* Over many faces the share of points below each of some heights is that of the law, and the mean
 * square slope by the spectrum of fine points that of the shares. The scatter of the mean over 100
 * faces is estimated from the faces themselves; 5 standard errors. */
static void faces_follow_the_law(void **state) {
    (void)state;
    enum { FACES = 100, LEVELS = 5 };
    const struct grid grid = {4096, 1, 64, 1};
    struct surface_options options = SURFACE_DEFAULTS;
    options.amplitudes = AMPLITUDES_RANDOM;
    const struct plateau_face plateau = {self_affine(0.5, 2, 0.5, 1), options, 0.3, -0.5};
    struct spectrum both = self_affine(0.8, 4, 1, 0.1);
    both.plateau = &plateau;
    struct generator *generator = NULL;
    double *z =
        generate(&both, &grid, &options, (struct random_key){seed_or(5), 0, 0}, NULL, &generator);
    struct moments own, moments;
    struct spectrum valleys = both;
    valleys.plateau = NULL;
    assert_int_equal(spectrum_moments(&valleys, &grid, &own, NULL), 0);
    modes_moments(generator_modes(generator), &moments);
    const struct stratified_heights law =
        stratified_heights_of(own.rms_height, 0.3 * own.rms_height, -0.5 * own.rms_height);
    double sum[LEVELS + 1] = {0}, squares[LEVELS + 1] = {0};
    for (uint64_t r = 0; r < FACES; r++) {
        assert_int_equal(generator_run(generator, (struct random_key){5, 0, r}, z, NULL, NULL), 0);
        double found[LEVELS + 1] = {0};
        for (size_t i = 0; i < grid.nx; i++) {
            for (int l = 0; l < LEVELS; l++)
                found[l] += (z[i] < (1.2 * l - 3) * law.deviation) / (double)grid.nx;
            found[LEVELS] += pow((z[(i + 1) % grid.nx] - z[i]) / grid_dx(&grid), 2) /
                             (double)grid.nx / (moments.rms_slope * moments.rms_slope);
        }
        for (int l = 0; l <= LEVELS; l++) {
            sum[l] += found[l] / FACES;
            squares[l] += found[l] * found[l] / FACES;
        }
    }
    for (int l = 0; l <= LEVELS; l++) {
        const double error = sqrt((squares[l] - sum[l] * sum[l]) / FACES);
        const double expected = l < LEVELS ? stratified_cdf(&law, 1.2 * l - 3) : 1;
        print_message("%g +- %g of %g expected\n", sum[l], error, expected);
        /* differences over 1/32 of the shortest wave leave out less than 1 % of the slope */
        check_close(sum[l], expected, 5 * error + (l < LEVELS ? 0 : 0.015));
    }
    generator_destroy(&generator);
    free(z);
}

static void refused(void **state) {
    (void)state;
    struct error err = {0};
    struct generator *generator = NULL;
    struct plateau_face plateau = {self_affine(0.5, 4, 1, 1), SURFACE_DEFAULTS, 0.3, 0};
    const struct plateau_face third = plateau;
    struct spectrum both = self_affine(0.8, 4, 1, 0.1);
    both.plateau = &plateau;
    plateau.spectrum.plateau = &third;
    assert_int_equal(generator_create(&generator, &both, &GRIDS[0], &SURFACE_DEFAULTS, &err),
                     ERROR_INPUT);
    assert_non_null(strstr(err.text, "a third one"));
    assert_null(generator);
    plateau.spectrum = self_affine(0.5, 4, 0.01, 1); /* the grid does not resolve it */
    assert_int_equal(generator_create(&generator, &both, &GRIDS[0], &SURFACE_DEFAULTS, &err),
                     ERROR_INPUT);
    assert_null(generator);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(moments_of_the_law),
        cmocka_unit_test(offset_of_a_share),
        cmocka_unit_test(lower_of_both),
        cmocka_unit_test(faces_follow_the_law),
        cmocka_unit_test(refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
