/* Protects: what curves and scalars are in physical units, by hand-made numbers; what is not known
 * has no unit; and documents keep units. */
#include "jobs/units.h"
#include "schema/json/json.h"
#include "schema/result/csv.h"
#include "schema/result/difference.h"
#include "schema/result/result_json.h"
#include "tests/support/check.h"
#include "tests/support/result_builder.h"
#include <stdio.h>

static const double X[] = {0.1, 0.2}, Y[] = {2, 3}, ERRORS[] = {0.1, 0.2};

static void add_curve(struct case_result *one, const char *quantity, const char *x_label,
                      const char *y_label) {
    struct curve curve = built_points(one, quantity, 2, X, Y, ERRORS);
    curve.x_label = x_label;
    curve.y_label = y_label;
    built_curve(one, &curve);
}

/* lambda_s = 2 um, E* = 100 GPa, sqrt(m0) = 0.05 lambda_s by theory, h' = 0.1. */
static struct study_result contact_made(size_t cases) {
    struct study_result study = built_study("contact", "units", cases);
    for (size_t c = 0; c < cases; c++) {
        struct case_result *one = &study.cases[c];
        built_parameter(one, "/surface/unit", NULL, 2e-6);
        built_parameter(one, "/surface/dimension", NULL, 2);
        built_parameter(one, "/contact/young", NULL, 75e9);
        built_parameter(one, "/contact/poisson", NULL, 0.5);
        built_scalar(one, "rms_height", 0.06, 0.001, 0.05);
        built_scalar(one, "rms_slope", 0.1, 0, NAN);
        built_scalar(one, "wavelength_ratio", 8, 0, NAN);
        built_scalar(one, "mean_gap_last", 2, 0.1, NAN);
        built_scalar(one, "kappa", 2, 0.1, NAN);
        built_scalar(one, "percolation_load", 0.25, 0.1, NAN);
        built_scalar(one, "sliding_to_full_slip", 0.4, 0.1, NAN);
        add_curve(one, "contact_area", "p/(E* h'_rms)", "A/A0");
        add_curve(one, "mean_gap", "p/(E* h'_rms)", "mean gap/sqrt(m0)");
        add_curve(one, "stiffness", "p/(E* h'_rms)", "K sqrt(m0)/(E* h'_rms)");
        add_curve(one, "patch_count", "p/(E* h'_rms)", "patches per lambda_l^2");
        add_curve(one, "contact_pressure_pdf", "p/(E* h'_rms)", "probability density");
        units_set(one);
        result_sampled(one, one->realisations);
    }
    return study;
}

static void check_unit(const struct physical_unit *unit, const char *name, double scale) {
    if (name == NULL) {
        assert_null(unit->unit);
        return;
    }
    assert_non_null(unit->unit);
    assert_string_equal(unit->unit, name);
    check_relative(unit->scale, scale, 1e-14);
}

/* A map of 105 nm RMS height and slope 0.1 in metres, E* = 2 GPa, or what is known of that alone.
 */
static void maps_have_pressures_and_lengths(void **state) {
    (void)state;
    static const struct {
        struct map_scales known;
        double pressure, gap, stiffness, conductance;
    } MAPS[] = {{{false, 1, 2e9, 1e-7, false}, 2e8, 105e-9, 2e8 / 105e-9, 0.2 / 105e-9 / 1e-7},
                {{true, NAN, 2e9, NAN, false}, 2e8, 0, 0, 0},
                {{false, 1, NAN, NAN, false}, 0, 105e-9, 0, 0},
                {{false, NAN, NAN, NAN, false}, 0, 0, 0, 0}};
    for (size_t m = 0; m < sizeof MAPS / sizeof *MAPS; m++) {
        struct study_result study = built_study("contact", "map", 1);
        struct case_result *one = &study.cases[0];
        built_scalar(one, "rms_height", 105e-9, NAN, NAN);
        built_scalar(one, "rms_slope", 0.1, NAN, NAN);
        add_curve(one, "approach", "p/(E* h'_rms)", "approach/sqrt(m0)");
        add_curve(one, "stiffness", "p/(E* h'_rms)", "K sqrt(m0)/(E* h'_rms)");
        add_curve(one, "conductance", "p/(E* h'_rms)", "G (rho1 + rho2) sqrt(m0)/(2 h'_rms)");
        units_set_of_map(one, &MAPS[m].known);
        const double scales[] = {MAPS[m].gap, MAPS[m].stiffness, MAPS[m].conductance};
        static const char *const UNITS[] = {"m", "Pa/m", "S/m^2"};
        for (size_t c = 0; c < 3; c++) {
            check_unit(&one->curves[c].x_unit, MAPS[m].pressure > 0 ? "Pa" : NULL,
                       MAPS[m].pressure);
            check_unit(&one->curves[c].y_unit, scales[c] > 0 ? UNITS[c] : NULL, scales[c]);
        }
        check_unit(&one->scalars[0].unit, MAPS[m].gap > 0 ? "m" : NULL, 1);
        study_result_clear(&study);
    }
}

static void contact_has_pressures_and_lengths(void **state) {
    (void)state;
    struct study_result study = contact_made(1);
    static const struct {
        const char *unit;
        double scale;
    } OF_Y[] = {{NULL, 0},
                {"m", 0.05 * 2e-6},
                {"Pa/m", 100e9 * 0.1 / (0.05 * 2e-6)},
                {"1/m^2", 1 / (16e-6 * 16e-6)},
                {"1/Pa", 1 / (100e9 * 0.1)}};
    const struct case_result *one = &study.cases[0];
    for (size_t a = 0; a < sizeof OF_Y / sizeof *OF_Y; a++) {
        check_unit(&one->curves[a].x_unit, "Pa", 100e9 * 0.1);
        check_unit(&one->curves[a].y_unit, OF_Y[a].unit, OF_Y[a].scale);
    }
    check_unit(&result_scalar(one, "rms_height")->unit, "m", 2e-6);
    check_unit(&result_scalar(one, "mean_gap_last")->unit, "m", 1e-7);
    check_unit(&result_scalar(one, "kappa")->unit, NULL, 0);
    check_unit(&result_scalar(one, "percolation_load")->unit, "Pa", 1e10);
    check_unit(&result_scalar(one, "sliding_to_full_slip")->unit, "m", 1e-7);
    study_result_clear(&study);
}

static void statistics_have_heights_and_curvatures(void **state) {
    (void)state;
    struct study_result study = built_study("statistics", "units", 1);
    struct case_result *one = &study.cases[0];
    built_parameter(one, "/surface/unit", NULL, 2e-6);
    built_parameter(one, "/surface/dimension", NULL, 2);
    built_scalar(one, "rms_height", 0.05, 0, NAN);
    built_scalar(one, "m4", 3, 0, NAN);
    built_scalar(one, "summit_density", 0.25, 0, NAN);
    add_curve(one, "summit_height_pdf", "z/sqrt(m0)", "probability density");
    add_curve(one, "summit_curvature_pdf", "-sqrt(3/m4) kappa_m", "probability density");
    add_curve(one, "psd", "k lambda_s", "power spectral density");
    units_set(one);
    check_unit(&one->curves[0].x_unit, "m", 1e-7);
    check_unit(&one->curves[0].y_unit, "1/m", 1e7);
    check_unit(&one->curves[1].x_unit, "1/m", 1 / 2e-6); /* sqrt(m4/3) = 1 */
    check_unit(&one->curves[1].y_unit, "m", 2e-6);
    check_unit(&one->curves[2].x_unit, "1/m", 1 / 2e-6);
    check_unit(&one->curves[2].y_unit, "m^4", 16e-24);
    check_unit(&result_scalar(one, "summit_density")->unit, "1/m^2", 1 / 4e-12);
    study_result_clear(&study);
}

/* One resistivity is that of both bodies; without one conductance has no unit. */
static void conductance_is_of_current_or_heat(void **state) {
    (void)state;
    static const struct {
        const char *parameter, *list, *unit;
        double both;
    } CASES[] = {{"/contact/resistivity", "[2e-8]", "S/m^2", 4e-8},
                 {"/contact/resistivity", "[2e-8,6e-8]", "S/m^2", 8e-8},
                 {"/contact/conductivity", "[50]", "W/(m^2 K)", 2. / 50},
                 {"/contact/conductivity", "[50,20]", "W/(m^2 K)", 1. / 50 + 1. / 20},
                 {"/contact/tolerance", NULL, NULL, 0}};
    for (size_t n = 0; n < sizeof CASES / sizeof *CASES; n++) {
        struct study_result study = built_study("contact", "units", 1);
        struct case_result *one = &study.cases[0];
        built_parameter(one, "/surface/unit", NULL, 2e-6);
        built_parameter(one, CASES[n].parameter, CASES[n].list, NAN);
        built_scalar(one, "rms_height", 0.05, 0, NAN);
        built_scalar(one, "rms_slope", 0.1, 0, NAN);
        add_curve(one, "conductance", "p/(E* h'_rms)", "G (rho1 + rho2) sqrt(m0)/(2 h'_rms)");
        units_set(one);
        check_unit(&one->curves[0].y_unit, CASES[n].unit, 2 * 0.1 / (0.05 * 2e-6) / CASES[n].both);
        study_result_clear(&study);
    }
}

/* Without the unit of lengths pressures are known for loads in Pa alone, and not for the modulus
 * that stands for none. */
static void what_is_not_known_has_no_unit(void **state) {
    (void)state;
    static const struct {
        const char *loads;
        double young;
        const char *unit;
    } CASES[] = {{"E* h'", 75e9, NULL}, {"Pa", 75e9, "Pa"}, {"Pa", 1, NULL}, {NULL, 75e9, NULL}};
    for (size_t n = 0; n < sizeof CASES / sizeof *CASES; n++) {
        struct study_result study = built_study("contact", "units", 1);
        struct case_result *one = &study.cases[0];
        if (CASES[n].loads != NULL)
            built_parameter(one, "/contact/pressures/unit", CASES[n].loads, NAN);
        built_parameter(one, "/contact/young", NULL, CASES[n].young);
        built_parameter(one, "/contact/poisson", NULL, 0.5);
        built_scalar(one, "rms_height", 0.05, 0, NAN);
        built_scalar(one, "rms_slope", 0.1, 0, NAN);
        add_curve(one, "mean_gap", "p/(E* h'_rms)", "mean gap/sqrt(m0)");
        units_set(one);
        check_unit(&one->curves[0].x_unit, CASES[n].unit, 1e10);
        check_unit(&one->curves[0].y_unit, NULL, 0);
        study_result_clear(&study);
    }
}

/* E* of two bodies: 1/E* = (1 - nu1^2)/E1 + (1 - nu2^2)/E2; the second has the Poisson's ratio of
 * the first unless given. */
static void two_bodies_have_one_modulus(void **state) {
    (void)state;
    static const struct {
        double young, poisson, modulus;
    } CASES[] = {{NAN, NAN, 1e11}, {75e9, NAN, 5e10}, {1e11, 0, 5e10}};
    for (size_t n = 0; n < sizeof CASES / sizeof *CASES; n++) {
        struct study_result study = built_study("contact", "units", 1);
        struct case_result *one = &study.cases[0];
        double metres, modulus;
        built_parameter(one, "/surface/unit", NULL, 2e-6);
        built_parameter(one, "/contact/young", NULL, 75e9);
        built_parameter(one, "/contact/poisson", NULL, 0.5);
        if (!isnan(CASES[n].young))
            built_parameter(one, "/counter_surface/young", NULL, CASES[n].young);
        if (!isnan(CASES[n].poisson))
            built_parameter(one, "/counter_surface/poisson", NULL, CASES[n].poisson);
        units_scales(one, &metres, &modulus);
        check_relative(modulus, CASES[n].modulus, 1e-14);
        study_result_clear(&study);
    }
}

static char *printed(const struct study_result *study,
                     bool (*print)(FILE *file, const struct study_result *study)) {
    char *text = NULL;
    size_t size = 0;
    FILE *file = open_memstream(&text, &size);
    assert_non_null(file);
    assert_true(print(file, study));
    assert_int_equal(fclose(file), 0);
    return text;
}

static void documents_keep_units(void **state) {
    (void)state;
    struct study_result study = contact_made(1), again = {0};
    struct error err = {0};
    char *text = printed(&study, study_print);
    cJSON *document = cJSON_Parse(text);
    assert_non_null(strstr(text, "\"x_unit\":{\"unit\":\"Pa\",\"symbol\":\"p\",\"scale\":"));
    assert_int_equal(study_result_read(document, &again, &err), 0);
    char *second = printed(&again, study_print);
    assert_string_equal(second, text);
    free(second);
    free(text);
    text = printed(&again, csv_print);
    assert_non_null(strstr(text, ",x_physical,x_unit,x2_physical,x2_unit,y_physical,y_unit,"
                                 "standard_error_physical,total_low,total_high,unknown_errors\n"));
    assert_non_null(strstr(text, ",1000000000,Pa,,,")); /* the load 0.1 */
    free(text);
    cJSON_SetNumberHelper(
        cJSON_GetObjectItem(
            cJSON_GetObjectItem(
                cJSON_GetArrayItem(
                    cJSON_GetObjectItem(
                        cJSON_GetArrayItem(cJSON_GetObjectItem(document, "cases"), 0), "curves"),
                    0),
                "x_unit"),
            "scale"),
        0);
    struct study_result refused;
    assert_int_equal(study_result_read(document, &refused, &err), ERROR_INPUT);
    assert_non_null(strstr(err.text, "\"x_unit\""));
    cJSON_Delete(document);
    study_result_clear(&again);
    study_result_clear(&study);
}

/* A difference is in the unit that both cases have. */
static void differences_have_common_units(void **state) {
    (void)state;
    struct study_result study = contact_made(2);
    struct case_result out = {0};
    struct error err = {0};
    study.cases[1].curves[1].y_unit.scale *= 2;
    assert_int_equal(difference_make(&study.cases[0], &study.cases[1], NULL, &out, &err), 0);
    check_unit(&out.curves[0].x_unit, "Pa", 1e10);
    check_unit(&out.curves[1].y_unit, NULL, 0);
    check_unit(&out.curves[2].y_unit, "Pa/m", 100e9 * 0.1 / (0.05 * 2e-6));
    check_unit(&result_scalar(&out, "mean_gap_last")->unit, "m", 1e-7);
    result_clear(&out);
    study_result_clear(&study);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(maps_have_pressures_and_lengths),
        cmocka_unit_test(contact_has_pressures_and_lengths),
        cmocka_unit_test(statistics_have_heights_and_curvatures),
        cmocka_unit_test(conductance_is_of_current_or_heat),
        cmocka_unit_test(what_is_not_known_has_no_unit),
        cmocka_unit_test(two_bodies_have_one_modulus),
        cmocka_unit_test(documents_keep_units),
        cmocka_unit_test(differences_have_common_units),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
