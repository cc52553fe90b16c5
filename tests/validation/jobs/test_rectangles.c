/* Studies of rectangular cells: their results agree with theory within their errors. A cell of 8 by
 * 4 longest waves agrees with one of 4 by 8, and both with the square, as far as cells of so few
 * waves are alike. Seeds are fixed: a failure can be looked at again. */
#include "tests/support/contact_document.h"
#include <stdio.h>
#include <stdlib.h>

/* Of four standard errors a true value is outside once in 16000 comparisons; here are 60. */
static const double ERRORS = 4;

static cJSON *study_of(const char *kind_name, const char *parameters_text, uint64_t count) {
    const struct job_kind *kind = kind_find(kind_name);
    struct job_runner *runner = NULL;
    struct job_merger *merger = NULL;
    struct block_result result = {0};
    struct error err = {0};
    cJSON *document = NULL, *parameters = cJSON_Parse(parameters_text);
    assert_non_null(parameters);
    if (runner_create(&runner, kind, parameters, NULL, 31, 0, &err) != 0 ||
        merger_create(&merger, kind, parameters, &err) != 0 ||
        runner_run(runner, 0, count, NULL, &result, &err) != 0 ||
        merger_add(merger, &result, &err) != 0 ||
        merger_tree(merger, NULL, NULL, &document, &err) != 0)
        fail_msg("%s: %s", parameters_text, err.text);
    block_result_clear(&result);
    runner_destroy(&runner);
    merger_destroy(&merger);
    cJSON_Delete(parameters);
    return document;
}

struct told {
    double value, standard_error, theory, grid;
};

static double number_of(const cJSON *document, const char *name, const char *what) {
    char pointer[100];
    snprintf(pointer, sizeof pointer, "/scalars/%s/%s", name, what);
    const cJSON *value = json_at(document, pointer);
    return cJSON_IsNumber(value) ? value->valuedouble : NAN;
}

static struct told told_of(const cJSON *document, const char *name) {
    struct told out = {
        number_of(document, name, "value"), number_of(document, name, "standard_error"),
        number_of(document, name, "theory"), number_of(document, name, "grid_theory")};
    if (!(out.standard_error >= 0))
        fail_msg("no %s", name);
    return out;
}

static void check_within(const char *name, double value, double expected, double tolerance) {
    if (!(fabs(value - expected) <= tolerance))
        fail_msg("%s is %.6g, not within %.3g of %.6g", name, value, tolerance, expected);
}

/* A case of statistics on a cell of x by y longest waves; more: the rest of its surface, with a
 * comma before it. */
static cJSON *statistics(double x, double y, const char *more, uint64_t count) {
    char text[600];
    snprintf(
        text, sizeof text,
        "{\"surface\": {\"wavelength_ratio\": 4, \"length_ratio\": %g, \"length_ratio_y\": %g%s}}",
        x, y, more);
    return study_of("statistics", text, count);
}

#define SELF_AFFINE ", \"hurst\": 0.8"

static const char *const OF_SUMMITS[] = {"summit_density", "summit_height_mean",
                                         "summit_height_variance", "summit_curvature_mean"};
enum { SUMMIT_SCALARS = sizeof OF_SUMMITS / sizeof *OF_SUMMITS };

/* m2 and m4 over m0 of a self-affine spectrum (H = 0.8, ratio 4, lambda_s = 1) by a plain sum over
 * all waves of the cell. */
static void plain_moments(double x, double y, double *m2, double *m4) {
    double sum0 = 0, sum2 = 0, sum4 = 0;
    for (int a = -100; a <= 100; a++)
        for (int b = -100; b <= 100; b++) {
            double kx = a / (4 * x), ky = b / (4 * y), k = hypot(kx, ky);
            if (k < 0.25 * (1 - 1e-9) || k > 1 + 1e-9)
                continue;
            double power = pow(k, -3.6);
            sum0 += power;
            sum2 += power * k * k / 2;
            sum4 += power * (pow(kx, 4) + pow(ky, 4)) / 2;
        }
    *m2 = sum2 / sum0 * pow(2 * M_PI, 2);
    *m4 = sum4 / sum0 * pow(2 * M_PI, 4);
}

/* Moments are the sums of the cell to rounding. Summits are those of theory on the grid within
 * their errors, on sides in odd ratios and on strips as well. */
static void statistics_agree_with_theory(void **state) {
    (void)state;
    static const double SIDES[][2] = {{8, 4}, {4, 8}, {6, 5}, {16, 2}};
    for (size_t s = 0; s < sizeof SIDES / sizeof *SIDES; s++) {
        cJSON *cell = statistics(SIDES[s][0], SIDES[s][1], SELF_AFFINE, 60);
        double m2, m4;
        plain_moments(SIDES[s][0], SIDES[s][1], &m2, &m4);
        check_within("m0", told_of(cell, "m0").value, 1, 1e-12);
        check_within("m2", told_of(cell, "m2").value, m2, 1e-11 * m2);
        check_within("m4", told_of(cell, "m4").value, m4, 1e-11 * m4);
        for (size_t a = 0; a < SUMMIT_SCALARS; a++) {
            struct told told = told_of(cell, OF_SUMMITS[a]);
            assert_true(told.standard_error > 0);
            check_within(OF_SUMMITS[a], told.value, told.grid, ERRORS * told.standard_error);
        }
        cJSON_Delete(cell);
    }
}

/* The moments of 8 by 4 lie between those of the squares of its sides, and so does what follows
 * from them: within standard errors and these two. */
static void a_rectangle_is_like_the_squares(void **state) {
    (void)state;
    cJSON *few = statistics(4, 4, SELF_AFFINE, 80), *cell = statistics(8, 4, SELF_AFFINE, 40),
          *many = statistics(8, 8, SELF_AFFINE, 20);
    for (size_t a = 0; a < SUMMIT_SCALARS; a++) {
        struct told low = told_of(few, OF_SUMMITS[a]), high = told_of(many, OF_SUMMITS[a]);
        struct told told = told_of(cell, OF_SUMMITS[a]);
        double half = fabs(high.value - low.value) / 2;
        double chance = hypot(told.standard_error, hypot(low.standard_error, high.standard_error));
        check_within(OF_SUMMITS[a], told.value, (high.value + low.value) / 2,
                     half + ERRORS * chance);
        assert_true(chance < 0.02 * told.value); /* so that it says something */
    }
    static const char *const MOMENTS[] = {"m2", "m4"};
    for (size_t a = 0; a < 2; a++) {
        double value = told_of(cell, MOMENTS[a]).value;
        assert_true(value > told_of(few, MOMENTS[a]).value &&
                    value < told_of(many, MOMENTS[a]).value);
    }
    cJSON_Delete(few);
    cJSON_Delete(cell);
    cJSON_Delete(many);
}

/* A set-up that is turned by a right angle, spectrum and all, is the same: moments to rounding,
 * summits within their errors, theory on the grid to the error of its quadrature. That is 1e-4, but
 * 0.5 % where the spectrum is anisotropic, whose directions it takes in turn (0.23 % on a
 * square). */
static void a_turned_cell_is_the_same(void **state) {
    (void)state;
    static const char *const SPECTRA[][2] = {
        {SELF_AFFINE, SELF_AFFINE},
        {SELF_AFFINE ", \"amplitudes\": \"random\"", SELF_AFFINE ", \"amplitudes\": \"random\""},
        {SELF_AFFINE ", \"heights\": {\"distribution\": \"weibull_min\", \"shape\": 2}",
         SELF_AFFINE ", \"heights\": {\"distribution\": \"weibull_min\", \"shape\": 2}"},
        {", \"spectrum\": {\"type\": \"exponential_acf\", \"length\": [3, 1]}",
         ", \"spectrum\": {\"type\": \"exponential_acf\", \"length\": [1, 3]}"}};
    for (size_t s = 0; s < sizeof SPECTRA / sizeof *SPECTRA; s++) {
        cJSON *wide = statistics(4, 2, SPECTRA[s][0], 60),
              *high = statistics(2, 4, SPECTRA[s][1], 60);
        for (size_t a = 0; a < SUMMIT_SCALARS; a++) {
            struct told one = told_of(wide, OF_SUMMITS[a]), other = told_of(high, OF_SUMMITS[a]);
            double chance = hypot(one.standard_error, other.standard_error);
            assert_true(chance > 0);
            check_within(OF_SUMMITS[a], one.value, other.value, ERRORS * chance);
            if (!isnan(one.grid))
                check_within(OF_SUMMITS[a], one.grid, other.grid,
                             (s == 3 ? 5e-3 : 1e-4) * fabs(other.grid));
        }
        static const char *const MOMENTS[] = {"rms_height", "rms_slope", "rms_curvature"};
        for (size_t a = 0; a < 3; a++) {
            struct told one = told_of(wide, MOMENTS[a]), other = told_of(high, MOMENTS[a]);
            check_within(MOMENTS[a], one.theory, other.theory, 1e-11 * other.theory);
        }
        cJSON_Delete(wide);
        cJSON_Delete(high);
    }
}

/* An autocorrelation in rings has lags up to half of the shorter side, all of their directions, and
 * an error at each. */
static void lags_end_with_the_shorter_side(void **state) {
    (void)state;
    for (size_t turned = 0; turned < 2; turned++)
        for (size_t exact = 0; exact < 2; exact++) {
            cJSON *cell =
                statistics(turned ? 2 : 4, turned ? 4 : 2,
                           exact ? SELF_AFFINE : SELF_AFFINE ", \"amplitudes\": \"random\"", 8);
            const cJSON *curve;
            size_t found = 0;
            cJSON_ArrayForEach(curve, json_at(cell, "/curves")) {
                if (!text_is(curve, "/quantity", "acf"))
                    continue;
                found++;
                assert_int_equal(points(curve), 33); /* 64 points of 1/8 along the shorter side */
                check_within("lag", at(curve, "/x", 32), 4, 1e-12);
                check_within("acf", at(curve, "/y", 0), 1, 1e-12);
                for (int k = 0; k < 33; k++)
                    assert_true(at(curve, "/discretisation_bound", k) >= 0);
            }
            assert_int_equal(found, 1);
            cJSON_Delete(cell);
        }
}

/* --- contact --- */

static cJSON *contact(double x, double y, const char *cell_error, uint64_t count) {
    char text[600];
    snprintf(text, sizeof text,
             "{\"surface\": {\"hurst\": 0.8, \"wavelength_ratio\": 4, \"length_ratio\": %g,"
             " \"length_ratio_y\": %g, \"rms_slope\": 0.1}, \"contact\": {\"pressures\":"
             " {\"values\": [0.03, 0.1, 0.3]}, \"model\": [\"halfspace\", \"layered\"],"
             " \"levels\": [4, 8], \"cell_error\": \"%s\"}}",
             x, y, cell_error);
    return study_of("contact", text, count);
}

/* Areas and gaps of turned cells agree within their errors, and with the square's within these and
 * the bound that a cell reports of its size. */
static void contact_agrees_with_the_square(void **state) {
    (void)state;
    static const struct {
        const char *quantity, *series;
    } CURVES[] = {{"contact_area", "edges"}, {"mean_gap", ""}};
    cJSON *wide = contact(4, 2, "probed", 20), *high = contact(2, 4, "none", 20);
    cJSON *square = contact(4, 4, "none", 10);
    for (size_t c = 0; c < 2; c++)
        for (size_t m = 0; m < 2; m++) {
            const char *model = m == 0 ? "halfspace" : "layered";
            const cJSON *a = curve_of(wide, CURVES[c].quantity, CURVES[c].series, model);
            const cJSON *b = curve_of(high, CURVES[c].quantity, CURVES[c].series, model);
            const cJSON *all = curve_of(square, CURVES[c].quantity, CURVES[c].series, model);
            assert_int_equal(points(a), 3);
            for (int k = 0; k < 3; k++) {
                double chance = hypot(at(a, "/standard_error", k), at(b, "/standard_error", k));
                double more = hypot(at(a, "/standard_error", k), at(all, "/standard_error", k));
                check_within(CURVES[c].quantity, at(a, "/y", k), at(b, "/y", k), ERRORS * chance);
                check_within(CURVES[c].quantity, at(a, "/y", k), at(all, "/y", k),
                             ERRORS * more + at(a, "/cell_bound", k));
                assert_true(chance > 0 && chance < 0.05 * at(a, "/y", k));
            }
        }
    cJSON_Delete(wide);
    cJSON_Delete(high);
    cJSON_Delete(square);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(statistics_agree_with_theory),
        cmocka_unit_test(a_rectangle_is_like_the_squares),
        cmocka_unit_test(a_turned_cell_is_the_same),
        cmocka_unit_test(lags_end_with_the_shorter_side),
        cmocka_unit_test(contact_agrees_with_the_square),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
