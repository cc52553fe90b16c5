/* Protects: the picture of a scalar over a parameter has a line for each setting of the others,
 * marks with their errors, theories once each, and says what it leaves out or cannot draw. */
#include "server/show/table/sweep.h"
#include "tests/support/check.h"
#include "tests/support/count_of.h"
#include "tests/support/result_builder.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { HURSTS = 4, RATIOS = 2 };

/* Cases of four Hurst exponents (falling) by `ratios` ratios; theory is of the exponent alone. */
static struct study_result study_of(size_t ratios) {
    struct study_result study = built_study("statistics", "a & b", HURSTS * ratios);
    for (size_t c = 0; c < study.case_count; c++) {
        size_t step = c / ratios;
        double hurst = 0.8 - 0.2 * (double)step, ratio = 8 * (double)(c % ratios + 1);
        built_parameter(&study.cases[c], "/surface/hurst", NULL, hurst);
        built_parameter(&study.cases[c], "/surface/wavelength_ratio", NULL, ratio);
        built_parameter(&study.cases[c], "/surface/spectrum", "self_affine", 0);
        built_scalar(&study.cases[c], "summit_density", hurst + ratio, 0.5, hurst);
    }
    return study;
}

/* What a picture is asked for. */
struct request {
    const char *name, *x, *colour;
    enum plot_axes axes;
};

/* Gives a table the scalars of a study, which the table then owns. */
static int results(const void *context, const struct result_filter *filter,
                   struct study_result *out, struct error *err) {
    struct study_result *study = (struct study_result *)(size_t)context;
    (void)filter;
    (void)err;
    *out = *study;
    *study = (struct study_result){0};
    return 0;
}

/* Draws, and leaves the study as it was. */
static char *draw(struct study_result *study, const struct request *request, int expected,
                  struct error *err) {
    const struct picture_source source = {.context = study, .results = results};
    const struct plot_request plot = {
        .lines = {.quantity = request->name, .names = {[CHANNEL_COLOUR] = request->colour}},
        .axes = request->axes};
    struct case_table table = {0};
    char *text = NULL;
    size_t size = 0;
    FILE *file = open_memstream(&text, &size);
    assert_non_null(file);
    assert_int_equal(case_table_open(&table, &source, NULL, err), 0);
    int status = case_table_add(&table, &source, "quantity", request->name, err);
    if (status == 0)
        status = sweep_draw(&table, request->name, request->x, &plot, file, err);
    assert_int_equal(fclose(file), 0);
    if (status != expected)
        print_error("%s\n", err->text);
    assert_int_equal(status, expected);
    *study = table.study;
    table.study = (struct study_result){0};
    case_table_clear(&table);
    return text;
}

static void check_count(struct study_result *study, const struct request *request, const char *word,
                        size_t expected) {
    struct error err = {0};
    char *text = draw(study, request, 0, &err);
    if (count_of(text, word) != expected)
        print_error("%zu times %s\n", count_of(text, word), word);
    assert_int_equal(count_of(text, word), expected);
    assert_null(strstr(text, "nan"));
    assert_null(strstr(text, "inf"));
    free(text);
}

static const struct request DENSITY = {.name = "summit_density"};

/* The errors of a scalar go with it: those that are known at every point, and those that are not at
 * some. */
static void points_have_total_errors(void **state) {
    (void)state;
    struct study_result study = study_of(RATIOS);
    const size_t points = study.case_count;
    check_count(&study, &DENSITY, "class=\"total\"", 3 * points); /* a bar and its ends */
    check_count(&study, &DENSITY, "dashed bars", 0);
    study.cases[0].scalars[0].errors[ERROR_CELL].applies = true;
    check_count(&study, &DENSITY, "class=\"total part\"", 1);
    check_count(&study, &DENSITY, ">dashed bars: without cell<", 1);
    study.cases[0].scalars[0].errors[ERROR_CELL] = (struct scalar_error){
        .applies = true, .known = true, .value = -100, .bound = 200, .standard_error = 0};
    check_count(&study, &DENSITY, "class=\"total\"", 3 * points);
    check_count(&study, &DENSITY, ">300</text>", 1); /* the axis reaches as far: 8.8 + 300 */
    study_result_clear(&study);
}

/* A logarithmic axis holds a point whose standard error reaches below zero. */
static void uncertain_points_are_on_a_logarithmic_axis(void **state) {
    (void)state;
    static const struct request LOGARITHMIC = {.name = "summit_density", .axes = AXES_Y};
    struct study_result study = study_of(RATIOS);
    study.cases[0].scalars[0].value = 1e-4; /* beside a standard error of 0.5 */
    check_count(&study, &LOGARITHMIC, "class=\"mark\"", study.case_count + RATIOS);
    check_count(&study, &LOGARITHMIC, "class=\"bar\"", study.case_count);
    check_count(&study, &LOGARITHMIC, "not on this axis", 0);
    study_result_clear(&study);
}

static void each_setting_is_a_line(void **state) {
    (void)state;
    struct study_result study = study_of(RATIOS);
    const size_t points = study.case_count;
    check_count(&study, &DENSITY, "class=\"curve\"", 2 * RATIOS);     /* and the legend */
    check_count(&study, &DENSITY, "class=\"mark\"", points + RATIOS); /* likewise */
    check_count(&study, &DENSITY, "class=\"bar\"", points);           /* an error each */
    check_count(&study, &DENSITY, "class=\"theory\"", 2);             /* shared, and legend */
    check_count(&study, &DENSITY, ">theory<", 1);
    check_count(&study, &DENSITY, "</tspan> 8</text>", 1);
    check_count(&study, &DENSITY, "</tspan> 16</text>", 1);
    check_count(&study, &DENSITY, "a &amp; b: summit density over Hurst exponent<", 2);
    check_count(&study, &DENSITY, ">0.6</text>", 1); /* what was swept has the ticks */
    study.cases[0].scalars[0].theory = 9;
    check_count(&study, &DENSITY, "class=\"theory\"", 3);
    check_count(&study, &DENSITY, ">theory, of each line<", 1);
    study.cases[0].scalars[0].grid = 9;
    check_count(&study, &DENSITY, ">theory of the grid<", 1);
    study_result_clear(&study);
}

/* Lines that lack points have the same theory as the others where they have any. */
static void theories_of_shorter_lines_are_shared(void **state) {
    (void)state;
    struct study_result study = study_of(RATIOS);
    study.cases[0].scalars[0].value = NAN;
    study.cases[3].scalars[0].value = NAN;
    check_count(&study, &DENSITY, "class=\"theory\"", 3); /* each lacks a point; and the legend */
    study.cases[3].scalars[0].value = 1;
    check_count(&study, &DENSITY, "class=\"theory\"", 2);
    check_count(&study, &DENSITY, ">theory<", 1);
    study_result_clear(&study);
}

/* Cases stand in the order of the study, points of a line by rising x. */
static void points_rise_along_a_line(void **state) {
    (void)state;
    struct error err = {0};
    struct study_result study = study_of(RATIOS);
    char *text = draw(&study, &DENSITY, 0, &err), *next = text;
    size_t lines = 0;
    for (; (next = strstr(next, "class=\"curve\"")) != NULL; next++) {
        double x, last = 0;
        char *point = strstr(next, " d=\"M") + 4;
        size_t points = 0;
        for (; (*point == 'M' || *point == 'L') && strtod(point + 1, &point) > last; points++) {
            x = last;
            last = x + 1;
            point = strchr(point, ' ') + 1;
            (void)strtod(point, &point);
        }
        lines += points == HURSTS;
    }
    assert_int_equal(lines, RATIOS);
    free(text);
    study_result_clear(&study);
}

static void parameters_are_named(void **state) {
    (void)state;
    static const struct {
        struct request request;
        int status;
        const char *word; /* of the picture or of the error */
    } ROWS[] = {
        {{"summit_density", "wavelength_ratio", NULL, AXES_AUTOMATIC}, 0, "H = 0.4"},
        {{"summit_density", "surface/wavelength_ratio", "hurst", AXES_AUTOMATIC}, 0, "H = 0.4"},
        {{"summit_density", "/surface/hurst", "wavelength_ratio", AXES_AUTOMATIC},
         0,
         "</tspan> 16</text>"},
        {{"summit_density", "shape", NULL, AXES_AUTOMATIC}, ERROR_INPUT, "\"shape\" is no number"},
        {{"summit_density", "spectrum", NULL, AXES_AUTOMATIC},
         ERROR_INPUT,
         "\"spectrum\" is no number of the study's cases, but words; --colour"},
        {{"summit_density", "H", NULL, AXES_AUTOMATIC}, ERROR_INPUT, "did you mean hurst?"},
        {{"summit_density", "hurst", "hurst", AXES_AUTOMATIC},
         ERROR_INPUT,
         "\"hurst\" does not differ"},
        {{"summit_density", "hurst", "spectrum", AXES_AUTOMATIC},
         ERROR_INPUT,
         "\"spectrum\" does not differ"},
        {{"kurtosis", NULL, NULL, AXES_AUTOMATIC},
         ERROR_INPUT,
         "no case has a scalar \"kurtosis\""},
    };
    struct study_result study = study_of(RATIOS);
    for (size_t r = 0; r < sizeof ROWS / sizeof *ROWS; r++) {
        struct error err = {0};
        char *text = draw(&study, &ROWS[r].request, ROWS[r].status, &err);
        assert_non_null(strstr(ROWS[r].status == 0 ? text : err.text, ROWS[r].word));
        free(text);
    }
    study_result_clear(&study);
}

/* A colour stands for the values of a parameter, dashes and marks for the rest. */
static void colours_are_of_a_parameter(void **state) {
    (void)state;
    const struct request by_spectrum = {"summit_density", "hurst", "spectrum", AXES_AUTOMATIC};
    struct study_result study = study_of(4);
    for (size_t c = 0; c < study.case_count; c++)
        study.cases[c].parameters[2].text = c % 4 < 2 ? "self_affine" : "table";
    check_count(&study, &DENSITY, "stroke=\"#440154\"", 1 + 5 * HURSTS + 2); /* the least ratio */
    check_count(&study, &by_spectrum, "stroke=\"#440154\"", 0);
    check_count(&study, &by_spectrum, "stroke=\"#d55e00\"", 2 * (1 + 5 * HURSTS) + 2);
    study_result_clear(&study);
}

/* The theory of a scalar has the name that its kind gives it. */
static void theories_of_scalars_have_names(void **state) {
    (void)state;
    struct study_result study = built_study("contact", "light", 2);
    const struct request kappa = {"kappa", "hurst", NULL, AXES_AUTOMATIC};
    for (size_t c = 0; c < 2; c++) {
        built_parameter(&study.cases[c], "/surface/hurst", NULL, 0.4 * (double)(c + 1));
        built_scalar(&study.cases[c], "kappa", 2, 0.1, 1.5958);
    }
    check_count(&study, &kappa, ">theory: Persson<", 1);
    study_result_clear(&study);
}

static void what_is_left_out_is_told(void **state) {
    (void)state;
    struct error err = {0};
    struct study_result study = study_of(20);
    const struct request by_hurst = {"summit_density", "hurst", NULL, AXES_AUTOMATIC};
    check_count(&study, &DENSITY, "over wavelength ratio<", 2); /* which has more values */
    check_count(&study, &by_hurst, "class=\"curve\"", 20 + 7);  /* not all are named */
    check_count(&study, &by_hurst, "in between: of 20 values of ", 1);
    study_result_clear(&study);
    study = study_of(RATIOS);
    study.cases[3].scalars[0].value = NAN;
    check_count(&study, &DENSITY, "without a value: case 3<", 1);
    for (size_t c = 0; c < 7; c++)
        study.cases[c].scalars[0].value = NAN;
    check_count(&study, &DENSITY, "without a value: cases 0, 1, 2, 3, 4, 5 and 1 more<", 1);
    study_result_clear(&study);
    study = built_study("statistics", "alone", 1);
    built_parameter(&study.cases[0], "/surface/hurst", NULL, 0.5);
    built_scalar(&study.cases[0], "summit_density", 0, NAN, NAN);
    free(draw(&study, &DENSITY, ERROR_INPUT, &err));
    assert_non_null(strstr(err.text, "sweeps no number"));
    check_count(&study, &by_hurst, "class=\"mark\"", 2); /* one point, at zero */
    study_result_clear(&study);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(points_have_total_errors),
        cmocka_unit_test(uncertain_points_are_on_a_logarithmic_axis),
        cmocka_unit_test(each_setting_is_a_line),
        cmocka_unit_test(theories_of_shorter_lines_are_shared),
        cmocka_unit_test(points_rise_along_a_line),
        cmocka_unit_test(parameters_are_named),
        cmocka_unit_test(colours_are_of_a_parameter),
        cmocka_unit_test(theories_of_scalars_have_names),
        cmocka_unit_test(what_is_left_out_is_told),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
