/* Protects: the axes of a picture of lines hold all that is drawn, and their numbers differ. */
#include "server/show/plot/picture.h"
#include "server/show/plot/plot_heat.h"
#include "tests/support/check.h"
#include "tests/support/count_of.h"
#include "tests/support/picture_text.h"
#include "tests/support/result_builder.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { POINTS = 4 };
static const double LOADS[POINTS] = {0.1, 0.2, 0.4, 0.8};
static const double NO_ERRORS[POINTS] = {0};

/* A study of one curve of contact. */
static struct study_result study_of(const char *quantity, const double y[POINTS],
                                    const double errors[POINTS]) {
    struct study_result study = built_study("contact", "one", 1);
    struct curve curve = built_points(&study.cases[0], quantity, POINTS, LOADS, y, errors);
    built_curve(&study.cases[0], &curve);
    return study;
}

static char *picture_of(const struct study_result *study, const char *quantity,
                        enum plot_axes axes) {
    const struct plot_request request = {
        .lines = {.quantity = quantity}, .axes = axes, .without_total = true};
    struct error err = {0};
    char *text;
    if (picture_text(study, &request, &text, &err) != 0)
        fail_msg("%s", err.text);
    assert_null(strstr(text, "nan"));
    assert_null(strstr(text, "inf"));
    return text;
}

/* Returns how many points the first curve of a picture is drawn through. */
static size_t drawn_points(const char *text) {
    const char *at = strstr(text, "class=\"curve\"");
    at = at != NULL ? strstr(at, " d=\"") : NULL;
    assert_non_null(at);
    size_t count = 0;
    for (at += strlen(" d=\""); at != NULL && *at != '"' && *at != '\0'; at++)
        count += *at == 'M' || *at == 'L';
    return count;
}

/* Values of zero at the ends are values: a surface that is closed at the highest loads. */
static void curves_are_drawn_to_their_ends(void **state) {
    (void)state;
    static const double Y[][POINTS] = {{1, 1, 0, 0}, {0, 0, 1, 1}, {0, 0, 0, 0}};
    for (size_t n = 0; n < sizeof Y / sizeof *Y; n++) {
        struct study_result study = study_of("percolates", Y[n], NO_ERRORS);
        char *text = picture_of(&study, "percolates", AXES_AUTOMATIC);
        assert_int_equal(drawn_points(text), POINTS);
        assert_int_equal(count_of(text, "class=\"middle\">0.8</text>"), 1); /* the highest load */
        free(text);
        study_result_clear(&study);
    }
}

/* Empty bins at the ends of a density do not widen its picture, unless all are empty. */
static void empty_bins_are_left_out_of_densities(void **state) {
    (void)state;
    static const double Y[][POINTS] = {{1, 1, 0, 0}, {0, 0, 0, 0}};
    for (size_t n = 0; n < 2; n++) {
        struct study_result study = study_of("contact_pressure_pdf", Y[n], NO_ERRORS);
        char *text = picture_of(&study, "contact_pressure_pdf", AXES_AUTOMATIC);
        assert_int_equal(count_of(text, "class=\"middle\">0.8</text>"), n);
        free(text);
        study_result_clear(&study);
    }
}

/* A picture without a point is refused in words, not drawn as an empty page. */
static void pictures_without_points_are_refused(void **state) {
    (void)state;
    static const double ZERO[POINTS] = {0}, NONE[POINTS] = {NAN, NAN, NAN, NAN};
    static const struct {
        const double *y;
        enum plot_axes axes;
        const char *words;
    } CASES[] = {{ZERO, AXES_Y, "no point to draw: none is above 0 on the logarithmic y"},
                 {ZERO, AXES_XY, "none is above 0 on the logarithmic x and y"},
                 {NONE, AXES_LINEAR, "no point to draw: no value is a finite number"}};
    for (size_t n = 0; n < sizeof CASES / sizeof *CASES; n++) {
        struct study_result study = study_of("percolates", CASES[n].y, NO_ERRORS);
        const struct plot_request request = {.lines = {.quantity = "percolates"},
                                             .axes = CASES[n].axes};
        struct error err = {0};
        char *text;
        assert_int_equal(picture_text(&study, &request, &text, &err), ERROR_ABSENT);
        assert_non_null(strstr(err.text, "open directions"));
        assert_non_null(strstr(err.text, CASES[n].words));
        assert_true(text == NULL || *text == '\0');
        free(text);
        study_result_clear(&study);
    }
}

/* Reads the ends of the first bar, or of the stroke of a total, of a picture. */
static void bar_of(const char *text, double *top, double *bottom) {
    const char *bar = strstr(text, "class=\"bar\"");
    assert_non_null(bar);
    while (*bar != 'M')
        bar--;
    double x;
    assert_int_equal(sscanf(bar, "M%lf %lfV%lf", &x, top, bottom), 3);
}

/* Bars of one standard error lie within the frame, also where totals are not drawn. */
static void standard_errors_are_not_cut(void **state) {
    (void)state;
    static const double Y[POINTS] = {1, 1.1, 1.2, 1.3}, WIDE[POINTS] = {0.4, 0, 0, 0};
    for (int logarithmic = 0; logarithmic < 2; logarithmic++) {
        struct study_result study = study_of("work", Y, WIDE);
        char *text = picture_of(&study, "work", logarithmic ? AXES_Y : AXES_LINEAR);
        double top, bottom;
        bar_of(text, &top, &bottom);
        assert_true(top > FRAME_TOP + 1 && bottom < FRAME_BOTTOM - 1);
        free(text);
        study_result_clear(&study);
    }
}

/* A density is not drawn below zero, however uncertain it is. */
static void bands_of_densities_end_at_zero(void **state) {
    (void)state;
    enum { BINS = 50 };
    double x[BINS], y[BINS], errors[BINS];
    for (size_t n = 0; n < BINS; n++) {
        x[n] = (double)n;
        y[n] = 1 + (double)(n % 7);
        errors[n] = 3;
    }
    struct study_result study = built_study("statistics", "one", 1);
    struct curve curve = built_points(&study.cases[0], "summit_height_pdf", BINS, x, y, errors);
    built_curve(&study.cases[0], &curve);
    char *text = picture_of(&study, "summit_height_pdf", AXES_LINEAR);
    assert_int_equal(count_of(text, "class=\"band\""), 1);
    assert_int_equal(count_of(text, "y=\"504.0\" class=\"end\">0</text>"), 1); /* at the frame */
    assert_int_equal(count_of(text, "class=\"end\">10</text>"), 1);            /* 7 + 3 */
    free(text);
    study_result_clear(&study);
}

/* A bar that reaches zero ends at the frame of a logarithmic axis, and a band likewise. */
static void errors_that_reach_zero_end_at_a_logarithmic_axis(void **state) {
    (void)state;
    static const double Y[POINTS] = {1, 2, 4, 8}, WIDE[POINTS] = {1.5, 0, 0, 0};
    struct study_result study = study_of("work", Y, WIDE);
    char *text = picture_of(&study, "work", AXES_Y);
    double top, bottom;
    bar_of(text, &top, &bottom);
    assert_true(top > FRAME_TOP && fabs(bottom - FRAME_BOTTOM) < 0.1);
    free(text);
    study_result_clear(&study);
}

/* Values that a logarithmic axis has not are counted in the legend. */
static void values_off_a_logarithmic_axis_are_counted(void **state) {
    (void)state;
    static const double Y[][POINTS] = {{1, 2, 0, -1}, {1, 2, 4, 0}, {1, 2, 4, 8}};
    static const char *const NOTES[] = {">not on this axis: 2 points<",
                                        ">not on this axis: 1 point<", "not on this axis"};
    for (size_t n = 0; n < 3; n++) {
        struct study_result study = study_of("work", Y[n], NO_ERRORS);
        char *text = picture_of(&study, "work", AXES_Y);
        assert_int_equal(count_of(text, NOTES[n]), n < 2);
        free(text);
        study_result_clear(&study);
    }
}

/* Returns the path of the first line of a class; *end: behind it. */
static const char *path_of(const char *text, const char *class, const char **end) {
    static const char BEGIN[] = " d=\"";
    const char *at = strstr(text, class);
    at = at != NULL ? strstr(at, BEGIN) : NULL;
    *end = at != NULL ? strchr(at + strlen(BEGIN), '"') : NULL;
    assert_non_null(*end);
    return at != NULL ? at + strlen(BEGIN) : text;
}

/* A theory that leaves the frame is drawn to its edge, on linear and on logarithmic axes, and does
 * not widen it. */
static void theories_are_drawn_to_the_frame(void **state) {
    (void)state;
    static const double Y[POINTS] = {1, 2, 3, 4}, FAR[POINTS] = {1e-3, 2, 1e9, 3};
    for (int logarithmic = 0; logarithmic < 2; logarithmic++) {
        struct study_result study = study_of("work", Y, NO_ERRORS);
        built_theory(&study.cases[0], &study.cases[0].curves[0], "persson", FAR);
        char *text = picture_of(&study, "work", logarithmic ? AXES_XY : AXES_LINEAR);
        const char *end, *path = path_of(text, "class=\"theory\"", &end);
        double x, y, top = INFINITY;
        for (const char *at = path; at < end; at++)
            if (sscanf(at, "%*[ML]%lf %lf", &x, &y) == 2) {
                assert_true(x >= FRAME_LEFT && x <= FRAME_RIGHT);
                assert_true(y >= FRAME_TOP && y <= FRAME_BOTTOM);
                top = fmin(top, y);
            }
        assert_true(top == FRAME_TOP); /* where it leaves the frame, and comes back */
        assert_int_equal(count_of(text, "class=\"end\">4</text>"), !logarithmic);
        assert_int_equal(count_of(text, "beyond the axes"), 0);
        free(text);
        study_result_clear(&study);
    }
}

/* A theory near the curve is seen; the legend says which is not. */
static void near_theories_are_seen(void **state) {
    (void)state;
    static const double Y[POINTS] = {1, 2, 3, 4}, NEAR[POINTS] = {5, 5, 5, 5},
                        FAR[POINTS] = {1e9, 1e9, 1e9, 1e9};
    struct study_result study = study_of("work", Y, NO_ERRORS);
    struct curve *curve = &study.cases[0].curves[0];
    built_theory(&study.cases[0], curve, "persson", NEAR);
    char *text = picture_of(&study, "work", AXES_LINEAR);
    assert_int_equal(count_of(text, "class=\"end\">5</text>"), 1);
    assert_int_equal(count_of(text, ">theory: Persson<"), 1);
    free(text);
    curve->theory_count = 0;
    built_theory(&study.cases[0], curve, "persson", FAR);
    text = picture_of(&study, "work", AXES_LINEAR);
    assert_int_equal(count_of(text, ">theory: Persson, beyond the axes<"), 1);
    assert_int_equal(count_of(text, "class=\"end\">4</text>"), 1);
    free(text);
    study_result_clear(&study);
}

/* Numbers of neighbours differ, at axes and in the legend of colours, however small their step. */
static void neighbours_have_different_numbers(void **state) {
    (void)state;
    static const double Y[POINTS] = {1, 1.00001, 1.00002, 1.00004};
    struct study_result study = study_of("work", Y, NO_ERRORS);
    char *text = picture_of(&study, "work", AXES_LINEAR), first[HEAT_LABEL_SIZE];
    assert_int_equal(count_of(text, "class=\"end\">1.00001</text>"), 1);
    assert_int_equal(count_of(text, "class=\"end\">1.00002</text>"), 1);
    assert_int_equal(count_of(text, "class=\"end\">1</text>"), 1);
    free(text);
    study_result_clear(&study);
    char style[HEAT_STYLE_SIZE], second[HEAT_LABEL_SIZE];
    const struct heat_scale scale = heat_scale_between(25.000012, 25.000048, 4, HEAT_HEIGHT);
    heat_level(&scale, 0, style, first);
    heat_level(&scale, 1, style, second);
    assert_string_equal(first, "25.00001 to 25.00002");
    assert_string_equal(second, "25.00002 to 25.00003");
    assert_int_equal(number_digits(0, 1e-5), 4);
    assert_int_equal(number_digits(123.456, 0), 4);
}

/* Reads where the first point of the first curve stands. */
static void first_point(const char *text, double *x, double *y) {
    const char *end, *path = path_of(text, "class=\"curve\"", &end);
    if (sscanf(path, "M%lf %lf", x, y) != 2)
        fail_msg("%.80s", path);
}

/* Values that are one, or differ by rounding alone, stand in the middle of an axis that is in
 * proportion to them, with their error. */
static void one_value_stands_in_the_middle(void **state) {
    (void)state;
    static const double Y[][POINTS] = {{1000, 1000, 1000, 1000},
                                       {1, 1 + 1e-15, 1 - 1e-15, 1},
                                       {1e-9, 1e-9, 1e-9, 1e-9},
                                       {-3, -3, -3, -3},
                                       {0, 0, 0, 0}};
    for (size_t n = 0; n < sizeof Y / sizeof *Y; n++)
        for (int logarithmic = 0; logarithmic < (n < 3 ? 2 : 1); logarithmic++) {
            double x, y, middle = (FRAME_TOP + FRAME_BOTTOM) / 2.0;
            struct study_result study = study_of("work", Y[n], NO_ERRORS);
            char *text = picture_of(&study, "work", logarithmic ? AXES_Y : AXES_LINEAR);
            first_point(text, &x, &y);
            if (!(fabs(y - middle) < 1))
                fail_msg("value %g at %g", Y[n][0], y);
            free(text);
            study_result_clear(&study);
        }
    static const double LARGE[POINTS] = {1, 1, 1, 1}, ERRORS[POINTS] = {3, 0, 0, 0};
    struct study_result study = study_of("work", LARGE, ERRORS);
    study.cases[0].curves[0].n = 1; /* one load, too */
    char *text = picture_of(&study, "work", AXES_LINEAR);
    double x, y, top, bottom;
    first_point(text, &x, &y);
    assert_true(fabs(x - (FRAME_LEFT + FRAME_RIGHT) / 2.0) < 1);
    bar_of(text, &top, &bottom);
    assert_true(top > FRAME_TOP && bottom < FRAME_BOTTOM && fabs(top + bottom - 2 * y) < 1);
    free(text);
    study_result_clear(&study);
}

/* A logarithmic axis of a part of a decade has numbers, at their logarithmic positions. */
static void short_logarithmic_axes_have_numbers(void **state) {
    (void)state;
    static const double Y[POINTS] = {2.4, 2.5, 2.9, 3};
    struct study_result study = study_of("work", Y, NO_ERRORS);
    char *text = picture_of(&study, "work", AXES_Y), tick[64];
    const struct frame frame = {.y = {.low = 2.4 / 1.5, .high = 3 * 1.5, .logarithmic = true},
                                .top = FRAME_TOP,
                                .bottom = FRAME_BOTTOM};
    snprintf(tick, sizeof tick, "y=\"%.1f\" class=\"end\">3</text>", frame_y(&frame, 3) + 4);
    assert_int_equal(count_of(text, tick), 1);
    assert_true(count_of(text, "class=\"end\">") >= 3);
    free(text);
    study_result_clear(&study);
}

/* Gives a difference with values of either sign. */
static int difference_of(const void *context, const struct comparison *comparison,
                         struct study_result *out, struct error *err) {
    static const double Y[POINTS] = {-1, 2, -3, 4};
    (void)context;
    (void)comparison;
    (void)err;
    *out = study_of("work", Y, NO_ERRORS);
    struct case_result *one = &out->cases[0];
    one->difference = true;
    one->curves[0].minuend = one->curves[0].subtrahend = one->curves[0].y;
    return 0;
}

/* A logarithmic y axis of a difference is refused, not drawn as another one. */
static void differences_have_a_linear_y_axis(void **state) {
    (void)state;
    const struct picture_source source = {.difference = difference_of};
    const struct comparison comparison = {0};
    for (int axes = AXES_AUTOMATIC; axes < AXES_COUNT; axes++) {
        const struct picture_request request = {
            .quantity = "work", .axes = axes, .case_number = -1, .difference = &comparison};
        bool allowed = axes == AXES_AUTOMATIC || axes == AXES_LINEAR || axes == AXES_X;
        struct error err = {0};
        char *text = NULL, expected[32];
        size_t size = 0;
        FILE *file = open_memstream(&text, &size);
        assert_non_null(file);
        assert_int_equal(picture_draw(&source, &request, file, &err), allowed ? 0 : ERROR_INPUT);
        fclose(file);
        snprintf(expected, sizeof expected, "log %s: a difference", AXES_NAMES[axes]);
        assert_int_equal(strstr(err.text, expected) == NULL, allowed);
        free(text);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(curves_are_drawn_to_their_ends),
        cmocka_unit_test(empty_bins_are_left_out_of_densities),
        cmocka_unit_test(pictures_without_points_are_refused),
        cmocka_unit_test(standard_errors_are_not_cut),
        cmocka_unit_test(bands_of_densities_end_at_zero),
        cmocka_unit_test(errors_that_reach_zero_end_at_a_logarithmic_axis),
        cmocka_unit_test(values_off_a_logarithmic_axis_are_counted),
        cmocka_unit_test(theories_are_drawn_to_the_frame),
        cmocka_unit_test(near_theories_are_seen),
        cmocka_unit_test(neighbours_have_different_numbers),
        cmocka_unit_test(one_value_stands_in_the_middle),
        cmocka_unit_test(short_logarithmic_axes_have_numbers),
        cmocka_unit_test(differences_have_a_linear_y_axis),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
