/* Protects: fits of areas over loads: that each model has them over its own range, that they are
 * the fits of its curve, and that residuals are those of the curve from the line that is stated. */
#include "core/statistics/fit.h"
#include "tests/support/contact_document.h"
#include <stdio.h>

enum { LOADS = 20, COUNT = 6 };

static double scalar_of(const cJSON *document, const char *model, const char *name) {
    char path[80];
    snprintf(path, sizeof path, "/scalars/%s%s/value", model, name);
    const cJSON *value = json_at(document, path);
    if (!cJSON_IsNumber(value))
        fail_msg("no scalar %s", path);
    return value != NULL ? value->valuedouble : (double)NAN;
}

static double residual_of(const cJSON *area, int loads, double (*line)(double, double, double),
                          double a, double b) {
    double squares = 0, size = 0;
    for (int k = 0; k < loads; k++) {
        double y = at(area, "/y", k), r = y - line(at(area, "/x", k), a, b);
        squares += r * r;
        size += y * y;
    }
    return sqrt(squares / size);
}

static double straight(double load, double a, double b) {
    (void)b;
    return a * load;
}

static double power(double load, double a, double b) {
    return a * pow(load, b);
}

static double error_function(double load, double a, double b) {
    (void)b;
    return erf(sqrt(M_PI) / 2 * a * load);
}

/* Checks the loads of a fit, and returns how many they are. */
static int check_range(const cJSON *document, const char *model, const char *name,
                       const cJSON *area, double most) {
    char count[40], highest[40];
    int n = 0;
    while (n < LOADS && at(area, "/y", n) <= most)
        n++;
    snprintf(count, sizeof count, "%s_loads", name);
    snprintf(highest, sizeof highest, "%s_highest_load", name);
    assert_int_equal((int)scalar_of(document, model, count), n);
    check_close(scalar_of(document, model, highest), at(area, "/x", n - 1), 0);
    return n;
}

static void check_model(const cJSON *document, const char *name, const char *prefix) {
    const cJSON *area = curve_of(document, "contact_area", "edges", name);
    double products = 0, squares = 0, x[LOADS], y[LOADS];
    struct fit fit;
    struct error err = {0};
    int line = check_range(document, prefix, "kappa", area, 0.1);
    for (int k = 0; k < LOADS; k++) {
        x[k] = at(area, "/x", k);
        y[k] = at(area, "/y", k);
        products += k < line ? x[k] * y[k] : 0;
        squares += k < line ? x[k] * x[k] : 0;
    }
    /* a line's slope is linear in areas: the mean of the fits is the fit of the mean */
    double kappa = scalar_of(document, prefix, "kappa");
    check_relative(kappa, products / squares, 1e-9);
    check_close(scalar_of(document, prefix, "kappa_residual"),
                residual_of(area, line, straight, kappa, 0), 1e-9);
    double a = scalar_of(document, prefix, "power_law_a");
    double b = scalar_of(document, prefix, "power_law_b");
    int curved = check_range(document, prefix, "power_law", area, 0.5);
    check_close(scalar_of(document, prefix, "power_law_residual"),
                residual_of(area, curved, power, a, b), 1e-9);
    /* curved lines: the realisations scatter by a tenth about the mean curve */
    a = scalar_of(document, prefix, "erf_kappa");
    assert_int_equal(check_range(document, prefix, "erf", area, 1), LOADS);
    assert_int_equal(fit_erf(LOADS, x, y, &fit, &err), 0);
    check_relative(a, fit.a, 0.05);
    check_close(scalar_of(document, prefix, "erf_residual"),
                residual_of(area, LOADS, error_function, a, 0), 1e-9);
}

static void each_model_has_fits(void **state) {
    (void)state;
    cJSON *document = solve(
        "{\"surface\": {\"dimension\": 1, \"hurst\": 0.8, \"wavelength_ratio\": 4,"
        " \"length_ratio\": 8, \"points_per_wavelength\": 8}, \"contact\": {\"model\":"
        " [\"halfspace\", \"layered\"], \"cell_error\": \"none\", \"pressures\": {\"to\": 0.4,"
        " \"steps\": 20}}}",
        COUNT);
    check_model(document, "halfspace", "");
    check_model(document, "layered", "layered_");
    cJSON_Delete(document);
}

/* Steps from a slope nearby end at the least squares of fit_erf(), from both sides. */
static void near_slopes_meet(void **state) {
    (void)state;
    static const double LOAD[] = {0.01, 0.1, 0.2, 0.5, 1}, AREA[] = {0.03, 0.2, 0.3, 0.7, 0.9};
    struct fit fit;
    struct error err = {0};
    for (size_t n = 1; n <= 5; n++) {
        assert_int_equal(fit_erf(n, LOAD, AREA, &fit, &err), 0);
        check_relative(fit_erf_near(n, LOAD, AREA, 0.7 * fit.a), fit.a, 1e-12);
        check_relative(fit_erf_near(n, LOAD, AREA, 1.3 * fit.a), fit.a, 1e-12);
    }
    assert_true(isnan(fit_erf_near(1, LOAD, AREA, NAN)));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(each_model_has_fits),
        cmocka_unit_test(near_slopes_meet),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
