/* Protects: theories of summits over bins of any width are means of those over narrow bins, and add
 * up to one. Tolerances are those of the 4-point rule in parts of 1/4. */
#include "core/theory/bin_averages.h"
#include "core/theory/contact.h"
#include "tests/support/check.h"

enum { FINE = 320, MERGED = 160, COARSE = FINE / MERGED };

static void wide_bins_are_means_of_narrow_ones(void **state) {
    (void)state;
    static double pdf[FINE], cdf[FINE], curvature[FINE], t1_pdf[FINE], joint[COARSE * FINE];
    const struct bins fine = {-16, 16, FINE}, coarse = {-16, 16, COARSE};
    const struct bins whole = {-1e6, 1e6, 1};
    for (int dimension = 1; dimension <= 2; dimension++) {
        double wide[COARSE], share[COARSE], bend[COARSE], t1[COARSE], all, alpha = 3;
        bin_averages_summits(dimension, alpha, &fine, pdf, cdf, curvature);
        bin_averages_summits(dimension, alpha, &coarse, wide, share, bend);
        bin_averages_curvatures(dimension, &fine, t1_pdf);
        bin_averages_curvatures(dimension, &coarse, t1);
        bin_averages_joint(dimension, alpha, &coarse, &fine, joint);
        for (size_t b = 0; b < COARSE; b++) {
            double mean = 0, moment = 0, mean_t1 = 0, sum = 0;
            for (size_t n = b * MERGED; n < (b + 1) * MERGED; n++) {
                mean += pdf[n] / MERGED;
                moment += pdf[n] * curvature[n] / MERGED;
                mean_t1 += t1_pdf[n] / MERGED;
            }
            for (size_t n = 0; n < FINE; n++)
                sum += joint[b * FINE + n] / 10;
            check_relative(wide[b], mean, 1e-6);
            check_relative(bend[b], moment / mean, 1e-6);
            check_close(t1[b], mean_t1, 1e-6);
            check_relative(sum, mean, 1e-6);
        }
        bin_averages_curvatures(dimension, &whole, &all);
        check_relative(all * 2e6, 1, 1e-6);
    }
}

/* Persson's density over all bins is the fraction in contact, wherever the load is in its bin. */
static void pressures_make_the_fraction_in_contact(void **state) {
    (void)state;
    static const double HIGH[] = {80, 200, 1e3, 1e6}, LOADS[] = {0.01, 0.3, 4, 33};
    enum { BINS = 10 };
    for (size_t h = 0; h < 4; h++)
        for (size_t k = 0; k < 4; k++) {
            const struct bins bins = {0, HIGH[h], BINS};
            double pdf[BINS], sum = 0;
            bin_averages_persson(LOADS[k], &bins, pdf);
            for (size_t b = 0; b < BINS; b++)
                sum += pdf[b] * HIGH[h] / BINS;
            check_relative(sum, persson_area(LOADS[k]), 1e-9);
        }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(wide_bins_are_means_of_narrow_ones),
        cmocka_unit_test(pressures_make_the_fraction_in_contact),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
