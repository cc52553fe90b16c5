/* Protects: what theory expects of a study's surfaces, against the project's own table of alpha and
 * against the theories of a result of the same case. */
#include "jobs/kind.h"
#include "jobs/merger.h"
#include "jobs/runner.h"
#include "jobs/statistics/statistics_expectation.h"
#include "tests/support/check.h"
#include "tests/support/scalar_of.h"
#include <stdlib.h>
#include <string.h>

static const char SURFACE[] =
    "{\"surface\": {\"hurst\": 0.8, \"wavelength_ratio\": 8, \"points_per_wavelength\": 4}}";
static const char PROFILE[] =
    "{\"surface\": {\"dimension\": 1, \"hurst\": 0.8, \"wavelength_ratio\": 8}}";
static const char WEIBULL[] =
    "{\"surface\": {\"hurst\": 0.8, \"wavelength_ratio\": 4, \"length_ratio\": 2, \"heights\":"
    " {\"distribution\": \"weibull_max\", \"shape\": 1}}}";
static const char TRANSLATED[] =
    "{\"surface\": {\"hurst\": 0.8, \"wavelength_ratio\": 4, \"length_ratio\": 2, \"heights\":"
    " {\"distribution\": \"weibull_max\", \"shape\": 1, \"law\": \"translation\"},"
    " \"amplitudes\": \"random\"}}";
/* Flat ground of a fifth of the area, at the top. */
static const char OWN[] =
    "{\"surface\": {\"hurst\": 0.8, \"wavelength_ratio\": 4, \"length_ratio\": 2, \"heights\":"
    " {\"distribution\": \"quantiles\", \"probability\": [0, 0.1, 0.4, 0.6, 0.8, 1], \"quantile\":"
    " [1, 4, 6, 7, 8, 8]}}}";
static const char CONTACT[] = "{\"surface\": {\"hurst\": 0.8, \"wavelength_ratio\": 8},"
                              " \"contact\": {\"model\": \"halfspace\"}}";
static const char EXPONENTIAL[] =
    "{\"surface\": {\"wavelength_ratio\": 4, \"points_per_wavelength\": 4, \"spectrum\":"
    " {\"type\": \"exponential_acf\", \"length\": [2]}}}";
static const char LATTICE[] = "{\"surface\": {\"hurst\": 0.5, \"wavelength_ratio\": 1}}";
static const char REFINED[] =
    "{\"surface\": {\"hurst\": 0.8, \"wavelength_ratio\": 8}, \"statistics\": {\"summits\":"
    " \"refined\"}}";

static struct case_result expect(const char *text, bool joint) {
    struct case_result out = {0};
    struct error err = {0};
    cJSON *parameters = cJSON_Parse(text);
    assert_non_null(parameters);
    if (statistics_expectation(parameters, joint, &out, &err) != 0)
        fail_msg("%s", err.text);
    cJSON_Delete(parameters);
    return out;
}

static const struct curve *series(const struct case_result *result, const char *quantity,
                                  const char *name) {
    for (size_t a = 0; a < result->curve_count; a++)
        if (strcmp(result->curves[a].quantity, quantity) == 0 &&
            same_text(result->curves[a].series, name))
            return &result->curves[a];
    return NULL;
}

/* F2.6, to its digits. */
static void alpha_is_that_of_the_table(void **state) {
    (void)state;
    struct case_result surface = expect(SURFACE, false), contact = expect(CONTACT, false);
    check_close(scalar_of(&surface, "nayak_alpha")->value, 5.3368, 5e-5);
    check_close(scalar_of(&surface, "nayak_alpha_continuous")->value, 5.2277, 5e-5);
    check_close(scalar_of(&contact, "nayak_alpha")->value, 5.3368, 5e-5);
    const struct curve *by_ratio = result_curve(&surface, "nayak_alpha_by_ratio");
    check_close(by_ratio->x[0], 1, 1e-12);
    check_close(by_ratio->y[0], 1.5, 1e-9);
    check_close(by_ratio->y[40], 200.3832, 5e-5);
    const struct curve *by_hurst = result_curve(&surface, "nayak_alpha_by_hurst");
    check_close(by_hurst->x[16], 0.8, 1e-12);
    check_close(by_hurst->y[16], 5.2277, 5e-5);
    result_clear(&contact);
    result_clear(&surface);
}

/* The plateau's density times the shape of the spectrum adds up to m0; G and g are those whose
 * power law goes on from it; and the exponential autocorrelation falls to 1/e at its length. */
static void quantities_of_the_reference(void **state) {
    (void)state;
    for (int dimension = 1; dimension <= 2; dimension++) {
        char text[400];
        snprintf(text, sizeof text,
                 "{\"surface\": {\"dimension\": %d, \"hurst\": 0.7, \"wavelength_ratio\": 8, "
                 "\"rolloff_ratio\": 2, \"length_ratio\": 4, \"rms_height\": 3}}",
                 dimension);
        struct case_result result = expect(text, false);
        double rolloff = 2 * M_PI / 4, unit = 2 * M_PI / 32, sum = 0;
        double exponent = dimension == 1 ? 2.4 : 3.4;
        for (long mx = -32; mx <= 32; mx++)
            for (long my = dimension == 1 ? 0 : -32; my <= (dimension == 1 ? 0 : 32); my++) {
                double square = (double)(mx * mx + my * my);
                if (square >= 16 && square <= 1024)
                    sum += pow(fmax(1, unit * sqrt(square) / rolloff), -exponent);
            }
        double area = dimension == 1 ? unit : unit * unit;
        double plateau = scalar_of(&result, "psd_plateau")->value;
        double scale = scalar_of(&result, "fractal_scale")->value;
        check_relative(plateau * area * sum, 9, 1e-9);
        check_relative(pow(scale, 0.6) * pow(rolloff, -exponent),
                       plateau * pow(2 * M_PI, dimension), 1e-9);
        check_close(scalar_of(&result, "fractal_dimension")->value, dimension + 0.3, 1e-12);
        assert_true(scalar_of(&result, "correlation_length_e")->value <
                    scalar_of(&result, "correlation_length")->value);
        result_clear(&result);
    }
    struct case_result exponential =
        expect("{\"surface\": {\"dimension\": 1, \"wavelength_ratio\": 16, \"length_ratio\": 16, "
               "\"spectrum\": {\"type\": \"exponential_acf\", \"length\": [2]}}}",
               false);
    double mean = 2 * 2 / 256.0; /* of R over the cell, which a surface lacks (F2.2) */
    check_close(scalar_of(&exponential, "correlation_length_e")->value,
                -2 * log((1 - mean) * exp(-1) + mean), 0.01);
    check_close(scalar_of(&exponential, "correlation_length")->value,
                -2 * log((1 - mean) * 0.2 + mean), 0.01);
    result_clear(&exponential);
}

static void check_same(size_t n, const double *a, const double *b) {
    for (size_t k = 0; k < n; k++)
        assert_true(a[k] == b[k] || (isnan(a[k]) && isnan(b[k])));
}

/* The theories beside a result are the expectations, to the bit. */
static void results_have_the_same_theories(void **state) {
    (void)state;
    static const char *const TEXTS[] = {SURFACE, PROFILE};
    for (size_t t = 0; t < 2; t++) {
        struct case_result expected = expect(TEXTS[t], false), result = {0};
        struct error err = {0};
        struct job_merger *merger = NULL;
        cJSON *parameters = cJSON_Parse(TEXTS[t]);
        assert_int_equal(merger_create(&merger, kind_find("statistics"), parameters, &err), 0);
        assert_int_equal(merger_result(merger, &result, &err), 0);
        size_t compared = 0;
        for (size_t a = 0; a < result.curve_count; a++) {
            const struct curve *curve = &result.curves[a];
            for (size_t n = 0; n < curve->theory_count; n++) {
                const struct theory *theory = &curve->theories[n];
                const struct curve *other = series(&expected, curve->quantity, theory->name);
                if (theory->y == NULL || other == NULL)
                    continue;
                check_same(curve->n, theory->y, other->y);
                check_same(curve->n, curve->x, other->x);
                compared++;
            }
        }
        assert_true(compared >= 10);
        const struct scalar *density = scalar_of(&result, "summit_density");
        assert_true(density->theory == scalar_of(&expected, "summit_density")->value);
        assert_true(density->grid == scalar_of(&expected, "summit_density")->grid);
        cJSON_Delete(parameters);
        merger_destroy(&merger);
        result_clear(&result);
        result_clear(&expected);
    }
}

static void only_what_theory_tells(void **state) {
    (void)state;
    struct case_result weibull = expect(WEIBULL, false), refined = expect(REFINED, true);
    struct case_result own = expect(OWN, false);
    assert_null(result_scalar(&own, "summit_density")); /* flat ground is no translation */
    assert_null(result_curve(&own, "summit_height_pdf"));
    assert_null(series(&weibull, "summit_height_pdf", "nayak"));
    assert_null(series(&weibull, "summit_height_pdf", "grid"));
    check_close(scalar_of(&weibull, "skewness")->value, -2, 1e-9);
    assert_true(isnan(scalar_of(&weibull, "kurtosis")->grid));
    assert_non_null(series(&weibull, "height_pdf", "weibull"));
    assert_non_null(series(&refined, "summit_height_pdf", "nayak"));
    assert_null(series(&refined, "summit_height_pdf", "grid"));
    assert_true(isnan(scalar_of(&refined, "summit_density")->grid));
    const struct curve *joint = series(&refined, "summit_joint_pdf", "nayak");
    assert_non_null(joint);
    assert_int_equal(joint->cell_count, joint->n * joint->columns);
    double sum = 0, cell = (joint->x[1] - joint->x[0]) * (joint->x2[1] - joint->x2[0]);
    for (size_t a = 0; a < joint->cell_count; a++)
        sum += joint->y[a] * cell;
    check_close(sum, 1, 1e-4);
    result_clear(&own);
    result_clear(&refined);
    result_clear(&weibull);
}

static void result_of(const char *text, struct case_result *out) {
    struct error err = {0};
    struct job_merger *merger = NULL;
    cJSON *parameters = cJSON_Parse(text);
    assert_int_equal(merger_create(&merger, kind_find("statistics"), parameters, &err), 0);
    assert_int_equal(merger_result(merger, out, &err), 0);
    cJSON_Delete(parameters);
    merger_destroy(&merger);
}

static const double *theory_of(const struct case_result *result, const char *quantity,
                               const char *side, const char *name) {
    const struct curve *curve = series(result, quantity, side);
    assert_non_null(curve);
    for (size_t t = 0; t < curve->theory_count; t++)
        if (strcmp(curve->theories[t].name, name) == 0)
            return curve->theories[t].y;
    return NULL;
}

static const char *const OF_SUMMITS[] = {"summit_height_pdf", "summit_height_cdf",
                                         "summit_mean_curvature", "summit_curvature_pdf"};

/* Checks that the theories of one side of a result are the expectations, to the bit. */
static void check_side(const struct case_result *result, const char *side, const char *name,
                       const struct case_result *expected, const char *expected_series,
                       size_t quantities) {
    for (size_t q = 0; q < 4; q++) {
        const struct curve *curve = series(expected, OF_SUMMITS[q], expected_series);
        const double *theory = theory_of(result, OF_SUMMITS[q], side, name);
        if (q >= quantities) {
            assert_true(curve == NULL && theory == NULL);
            continue;
        }
        assert_non_null(curve);
        assert_non_null(theory);
        if (curve != NULL && theory != NULL)
            check_same(curve->n, theory, curve->y);
    }
}

/* Summits and pits differ, and have one density. A grid has no theory of the density of
 * their curvatures. */
static void translated_surfaces_have_summits_and_pits(void **state) {
    (void)state;
    struct case_result expected = expect(TRANSLATED, true), result = {0};
    result_of(TRANSLATED, &result);
    check_side(&result, "", "translation", &expected, "translation", 4);
    check_side(&result, "pits", "translation", &expected, "pits", 4);
    check_side(&result, "", "grid", &expected, "grid", 3);
    check_side(&result, "pits", "grid", &expected, "grid_pits", 3);
    const struct scalar *top = scalar_of(&result, "summit_height_mean");
    const struct scalar *bottom = scalar_of(&result, "pit_height_mean");
    assert_true(top->theory == scalar_of(&expected, "summit_height_mean")->value);
    assert_true(bottom->grid == scalar_of(&expected, "pit_height_mean")->grid);
    assert_true(top->theory < 0.8 && bottom->theory > 1);
    assert_true(scalar_of(&result, "summit_density")->theory ==
                scalar_of(&result, "pit_density")->theory);
    const struct scalar *bend = scalar_of(&result, "summit_curvature_mean");
    assert_true(bend->grid != bend->theory);
    check_relative(bend->grid, bend->theory, 0.1);
    double asked = scalar_of(&expected, "nayak_alpha_asked")->value;
    struct case_result iterated = expect(WEIBULL, false);
    check_relative(scalar_of(&iterated, "nayak_alpha")->value, asked, 1e-12);
    assert_true(scalar_of(&expected, "nayak_alpha_gaussian")->value > asked);
    /* the spectrum that is asked for, not that of the Gaussian field */
    const struct curve *psd = result_curve(&expected, "psd");
    const struct curve *same = result_curve(&iterated, "psd");
    for (size_t a = 0; a < psd->n; a++) {
        check_relative(psd->y[a], same->y[a], 1e-12);
        check_relative(result_curve(&result, "psd")->theories[0].y[a], psd->theories[0].y[a],
                       1e-12);
    }
    const struct curve *joint = series(&expected, "summit_joint_pdf", "pits");
    double sum = 0, cell = (joint->x[1] - joint->x[0]) * (joint->x2[1] - joint->x2[0]);
    for (size_t a = 0; a < joint->cell_count; a++)
        sum += joint->y[a] * cell;
    double inside = series(&expected, "summit_height_cdf", "pits")->y[joint->n - 1];
    assert_true(inside > 0.99 && inside < 1);
    check_close(sum, inside, 1e-3); /* bins of t1 end, too */
    result_clear(&iterated);
    result_clear(&result);
    result_clear(&expected);
}

/* Curves of iterated surfaces stand beside Gaussian ones, and beside the translated ones of their
 * heights and spectrum. The theory of a scalar is that of these, as without surfaces. */
static void iterated_surfaces_stand_beside_translated_ones(void **state) {
    (void)state;
    struct case_result expected = expect(WEIBULL, false), translated = expect(TRANSLATED, false);
    struct case_result result = {0};
    result_of(WEIBULL, &result);
    check_side(&result, "", "translation", &expected, "translation", 4);
    check_side(&result, "pits", "translation", &translated, "pits", 4);
    const struct curve *curve = series(&result, "summit_height_pdf", "");
    assert_int_equal(curve->theory_count, 2);
    assert_string_equal(curve->theories[0].name, "nayak");
    assert_true(scalar_of(&expected, "pit_height_mean")->value ==
                scalar_of(&translated, "pit_height_mean")->value);
    size_t compared = 0;
    for (size_t n = 0; n < result.scalar_count; n++) {
        const struct scalar *found = &result.scalars[n];
        bool summits = strncmp(found->name, "summit_", 7) == 0;
        if (!summits && strncmp(found->name, "pit_", 4) != 0)
            continue;
        assert_true(found->theory == scalar_of(&expected, found->name)->value);
        compared++;
    }
    assert_int_equal(compared, 14);
    result_clear(&result);
    result_clear(&translated);
    result_clear(&expected);
}

/* Heights of one's own have a theory, of all of them, in results as without. */
static void heights_of_ones_own_have_their_density(void **state) {
    (void)state;
    struct case_result expected = expect(OWN, false), result = {0};
    struct error err = {0};
    struct job_merger *merger = NULL;
    cJSON *parameters = cJSON_Parse(OWN);
    assert_int_equal(merger_create(&merger, kind_find("statistics"), parameters, &err), 0);
    assert_int_equal(merger_result(merger, &result, &err), 0);
    const struct curve *pdf = series(&expected, "height_pdf", "quantiles");
    const struct curve *cdf = series(&expected, "height_cdf", "quantiles");
    assert_non_null(pdf);
    assert_non_null(cdf);
    const struct theory *theory = &result_curve(&result, "height_pdf")->theories[0];
    assert_string_equal(theory->name, "quantiles");
    double width = pdf->x[1] - pdf->x[0], sum = 0, mean = 0, most = 0;
    for (size_t b = 0; b < pdf->n; b++) {
        assert_true(theory->y[b] == pdf->y[b]);
        sum += width * pdf->y[b];
        mean += width * pdf->y[b] * pdf->x[b];
        most = fmax(most, width * pdf->y[b]);
    }
    check_close(sum, 1, 1e-12);
    check_close(mean, 0, 0.02);   /* of the bin that holds the flat ground */
    check_close(most, 0.2, 0.02); /* that, and little beside it */
    check_close(cdf->y[cdf->n - 1], 1, 0);
    assert_true(scalar_of(&expected, "skewness")->value < -0.5);
    cJSON_Delete(parameters);
    merger_destroy(&merger);
    result_clear(&result);
    result_clear(&expected);
}

/* An exponential autocorrelation is there at every lag, less the mean of the cell; its moments
 * diverge, and a lattice of four modes is not isotropic: neither has Nayak's theory. */
static void theory_knows_its_limits(void **state) {
    (void)state;
    struct case_result exponential = expect(EXPONENTIAL, false), lattice = expect(LATTICE, false);
    const struct curve *acf = result_curve(&exponential, "acf");
    assert_string_equal(acf->theories[0].name, "prescribed");
    const double *prescribed = acf->theories[0].y;
    assert_true(scalar_of(&exponential, "spectrum_clipped")->value < 1e-9);
    double mean = (prescribed[1] - acf->y[1]) / (1 - acf->y[1]);
    assert_true(mean > 0 && mean < 0.05);
    for (size_t a = 0; a < acf->n; a++)
        check_close(acf->y[a], (prescribed[a] - mean) / (1 - mean), 1e-9);
    /* Rings are a point spacing wide: their mean is near the value at their middle. */
    for (size_t a = 4; a < acf->n; a++)
        check_close(prescribed[a], exp(-acf->x[a] / 2), 0.012);
    const struct curve *psd = result_curve(&exponential, "psd");
    check_relative(psd->y[0], psd->theories[0].y[0], 0.03); /* long waves: no alias there */
    assert_true(psd->y[psd->n / 2] > 1.05 * psd->theories[0].y[psd->n / 2]);
    assert_null(series(&exponential, "summit_height_pdf", "nayak"));
    assert_non_null(series(&exponential, "summit_height_pdf", "grid"));
    assert_null(series(&lattice, "summit_height_pdf", "nayak"));
    assert_non_null(series(&lattice, "summit_height_pdf", "grid"));
    check_close(scalar_of(&lattice, "isotropy")->value, 0, 1e-12);
    result_clear(&lattice);
    result_clear(&exponential);
    struct case_result surface = expect(SURFACE, false);
    check_close(scalar_of(&surface, "isotropy")->value, 1, 5e-3);
    psd = result_curve(&surface, "psd");
    size_t rings = 0; /* 8 to 64 waves: means over those of the band, also at its ends */
    for (size_t r = 0; r < psd->n; r++) {
        if (psd->theories[0].y[r] > 0)
            check_relative(psd->y[r], psd->theories[0].y[r], 0.12);
        rings += psd->theories[0].y[r] > 0;
    }
    assert_int_equal(rings, 57);
    result_clear(&surface);
}

static void anisotropic_surfaces_are_of_the_grid_alone(void **state) {
    (void)state;
    struct case_result out = expect(
        "{\"surface\": {\"hurst\": 0.8, \"wavelength_ratio\": 4, \"anisotropy\": 4}}", false);
    assert_null(series(&out, "summit_height_pdf", "nayak"));
    assert_non_null(series(&out, "summit_height_pdf", "grid"));
    assert_null(result_curve(&out, "nayak_alpha_by_ratio"));
    assert_true(scalar_of(&out, "isotropy")->value < 0.5);
    result_clear(&out);
}

/* With grooves the expectation of heights and slopes is that beside a result, of the sum; what is
 * known of the random part alone is not given as that of the surface, nor anything of the grid. */
static void grooves_are_part_of_the_surface(void **state) {
    (void)state;
    static const char TEXT[] =
        "{\"surface\": {\"hurst\": 0.8, \"wavelength_ratio\": 4, \"length_ratio\": 2, \"grooves\":"
        " {\"period\": 4, \"depth\": 2, \"shape\": \"arcs\"}}}";
    static const char *const KNOWN[] = {"m0", "rms_height", "rms_slope", "skewness", "kurtosis"};
    static const char *const UNKNOWN[] = {
        "m2", "m4", "nayak_alpha", "isotropy", "rms_curvature", "correlation_length"};
    struct case_result expected = expect(TEXT, false), result = {0};
    result_of(TEXT, &result);
    for (size_t a = 0; a < sizeof KNOWN / sizeof *KNOWN; a++) {
        const struct scalar *scalar = scalar_of(&expected, KNOWN[a]);
        assert_true(scalar->value == scalar_of(&result, KNOWN[a])->theory);
        assert_true(isnan(scalar->grid));
    }
    for (size_t a = 0; a < sizeof UNKNOWN / sizeof *UNKNOWN; a++)
        assert_null(result_scalar(&expected, UNKNOWN[a]));
    result_clear(&result);
    result_clear(&expected);
}

static void faults_are_told(void **state) {
    (void)state;
    struct case_result out = {0};
    struct error err = {0};
    cJSON *parameters = cJSON_Parse("{\"surface\": {\"hurst\": 3, \"wavelength_ratio\": 8}}");
    assert_int_equal(statistics_expectation(parameters, false, &out, &err), ERROR_INPUT);
    assert_non_null(strstr(err.text, "hurst"));
    assert_true(out.curve_count == 0 && out.arena == NULL);
    cJSON_Delete(parameters);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(quantities_of_the_reference),
        cmocka_unit_test(alpha_is_that_of_the_table),
        cmocka_unit_test(results_have_the_same_theories),
        cmocka_unit_test(only_what_theory_tells),
        cmocka_unit_test(translated_surfaces_have_summits_and_pits),
        cmocka_unit_test(iterated_surfaces_stand_beside_translated_ones),
        cmocka_unit_test(heights_of_ones_own_have_their_density),
        cmocka_unit_test(theory_knows_its_limits),
        cmocka_unit_test(anisotropic_surfaces_are_of_the_grid_alone),
        cmocka_unit_test(grooves_are_part_of_the_surface),
        cmocka_unit_test(faults_are_told),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
