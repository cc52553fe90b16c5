/* Protects: a picture distinguishes its curves by panels, colours and dashes, says what it leaves
 * out, and distinguishes models, levels, estimators and theories. */
#include "server/show/plot/plot.h"
#include "server/show/plot/plot_layout.h"
#include "tests/support/check.h"
#include "tests/support/count_of.h"
#include "tests/support/picture_text.h"
#include "tests/support/result_builder.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* A curve of two points. theory: a value that distinguishes theories; 0 for none. */
static void add_curve(struct case_result *one, const char *quantity, const char *series,
                      const char *model, double level, double theory) {
    struct curve curve = built_points(one, quantity, 2, (const double[]){0.1, 0.2},
                                      (const double[]){0.2, 0.3}, (const double[]){0.05, NAN});
    curve.series = series;
    curve.model = model;
    curve.level = level;
    curve.x_label = "load";
    curve.y_label = strcmp(series, "wave") == 0 ? "per wave" : "A/A0 <share>";
    if (theory > 0)
        built_theory(one, &curve, "persson", (const double[]){theory, 2 * theory});
    built_curve(one, &curve);
}

/* Cases of two models, as many levels, and the estimators edges and nodes with its bracket. */
static struct study_result contact_of(size_t cases, int levels) {
    static const char *const SERIES[] = {"edges", "nodes", "nodes_lower", "nodes_upper"};
    struct study_result study = built_study("contact", "a & b", cases);
    for (size_t c = 0; c < cases; c++) {
        struct case_result *one = &study.cases[c];
        built_parameter(one, "/surface/hurst", NULL, 0.1 * (double)(c + 1));
        for (int s = 0; s < 4; s++)
            for (int m = 0; m < 2; m++)
                for (int l = levels; l > 0; l--)
                    add_curve(one, "contact_area", SERIES[s], m ? "layered" : "halfspace", 4 * l,
                              s < 2 ? 0.1 : 0);
    }
    return study;
}

static void label_of(const struct plot_lines *lines, enum plot_channel_type channel, size_t v,
                     const char *expected) {
    char label[PLOT_LABEL_SIZE];
    channel_label(lines, channel, v, label, sizeof label);
    assert_string_equal(label, expected);
}

static void lines_narrow_as_far_as_they_must(void **state) {
    (void)state;
    static const struct {
        size_t cases;
        int levels;
        struct lines_request request;
        size_t count, panels, colours, dashes;
        const char *narrowed;
    } CHOICES[] = {
        {1, 1, {.quantity = "contact_area"}, 8, 1, 4, 2, ""},
        {1, 3, {.quantity = "contact_area"}, 12, 1, 2, 2, "without brackets"},
        {2, 2, {.quantity = "contact_area"}, 8, 2, 2, 2, "without brackets, finest level"},
        {5, 2, {.quantity = "contact_area"}, 10, 1, 5, 2, "without brackets, finest level, edges"},
        {9, 1, {.quantity = "contact_area"}, 9, 1, 9, 1, "without brackets, edges, halfspace"},
        {20, 1, {.quantity = "contact_area"}, 20, 1, 20, 1, "without brackets, edges, halfspace"},
        {20,
         1,
         {.quantity = "contact_area", .model = "layered", .series = "nodes"},
         20,
         1,
         20,
         1,
         ""},
        {5, 3, {.quantity = "contact_area", .level = "8"}, 10, 1, 5, 2, "without brackets, edges"},
        {9,
         1,
         {.quantity = "contact_area", .names = {[CHANNEL_DASH] = "model"}},
         18,
         1,
         9,
         2,
         "without brackets, edges"},
        {2,
         3,
         {.quantity = "contact_area", .names = {[CHANNEL_PANEL] = "level"}},
         12,
         3,
         2,
         2,
         "without brackets, edges"},
    };
    for (size_t n = 0; n < sizeof CHOICES / sizeof *CHOICES; n++) {
        struct error err = {0};
        struct study_result study = contact_of(CHOICES[n].cases, CHOICES[n].levels);
        struct plot_lines lines = {0};
        assert_int_equal(plot_lines_choose(&lines, &study, &CHOICES[n].request, &err), 0);
        if (lines.count != CHOICES[n].count)
            print_error("choice %zu\n", n);
        assert_int_equal(lines.count, CHOICES[n].count);
        assert_string_equal(lines.narrowed, CHOICES[n].narrowed);
        assert_int_equal(lines.channels[CHANNEL_PANEL].count, CHOICES[n].panels);
        assert_int_equal(lines.channels[CHANNEL_COLOUR].count, CHOICES[n].colours);
        assert_int_equal(lines.channels[CHANNEL_DASH].count, CHOICES[n].dashes);
        plot_lines_clear(&lines);
        study_result_clear(&study);
    }
}

/* Numbers rise, and have their symbols; words stand in the order of the study. */
static void channels_name_their_values(void **state) {
    (void)state;
    struct error err = {0};
    struct study_result study = contact_of(2, 2);
    struct plot_lines lines = {0};
    assert_int_equal(
        plot_lines_choose(&lines, &study,
                          &(struct lines_request){
                              .quantity = "contact_area",
                              .names = {[CHANNEL_COLOUR] = "model", [CHANNEL_PANEL] = "level"}},
                          &err),
        0);
    label_of(&lines, CHANNEL_COLOUR, 1, "layered");
    label_of(&lines, CHANNEL_PANEL, 0, "level 4");
    label_of(&lines, CHANNEL_PANEL, 1, "level 8");
    assert_false(lines.channels[CHANNEL_COLOUR].ordered);
    plot_lines_clear(&lines);
    study.cases[0].parameters[0].number = 0.9;
    assert_int_equal(
        plot_lines_choose(&lines, &study,
                          &(struct lines_request){.quantity = "contact_area", .series = "edges"},
                          &err),
        0);
    label_of(&lines, CHANNEL_COLOUR, 0, "H = 0.2");
    label_of(&lines, CHANNEL_COLOUR, 1, "H = 0.9");
    assert_int_equal(lines.list[0].at[CHANNEL_COLOUR], 1); /* the first case has the higher one */
    assert_true(lines.channels[CHANNEL_COLOUR].ordered);
    plot_lines_clear(&lines);
    study_result_clear(&study);
}

static void what_there_is_not_is_refused(void **state) {
    (void)state;
    static const struct {
        struct lines_request request;
        int status;
        const char *word;
    } REFUSED[] = {
        {{.quantity = "colour"}, ERROR_ABSENT, "no case has the quantity \"colour\""},
        {{.quantity = "contact_area", .model = "full"},
         ERROR_INPUT,
         "no curve of contact_area is of model full; there is (model series level): halfspace "
         "edges 8; halfspace edges 4; "},
        {{.quantity = "contact_area", .series = "edges", .level = "5"},
         ERROR_INPUT,
         "is of series edges, level 5; there is"},
        {{.quantity = "psd", .level = "16"},
         ERROR_INPUT,
         "no curve of psd is of level 16: its curves have no model, series or level"},
        {{.quantity = "acf", .model = "full"},
         ERROR_INPUT,
         "no curve of acf is of model full; there is (series): acf; other"},
        {{.quantity = "contact_area", .names = {[CHANNEL_COLOUR] = "shape"}},
         ERROR_INPUT,
         "colour: \"shape\" does not differ between the lines; what differs: hurst"},
        {{.quantity = "contact_area", .names = {"hurst", "surface/hurst", NULL}},
         ERROR_INPUT,
         "colour: \"surface/hurst\" is shown by another channel"},
        {{.quantity = "contact_area", .names = {[CHANNEL_DASH] = "hurst"}},
         ERROR_INPUT,
         "has 7 values, at most 6"},
    };
    struct study_result study = contact_of(7, 2);
    add_curve(&study.cases[0], "psd", "", NULL, NAN, 0);
    add_curve(&study.cases[0], "acf", "", NULL, NAN, 0);
    add_curve(&study.cases[0], "acf", "other", NULL, NAN, 0);
    for (size_t n = 0; n < sizeof REFUSED / sizeof *REFUSED; n++) {
        struct error err = {0};
        struct plot_lines lines = {0};
        int status = plot_lines_choose(&lines, &study, &REFUSED[n].request, &err);
        if (status != REFUSED[n].status || strstr(err.text, REFUSED[n].word) == NULL)
            print_error("%zu: %s\n", n, err.text);
        assert_int_equal(status, REFUSED[n].status);
        assert_non_null(strstr(err.text, REFUSED[n].word));
    }
    study_result_clear(&study);
}

/* What goes with the model, such as its kinematics, takes no channel of its own. */
static void kinematics_go_with_their_model(void **state) {
    (void)state;
    struct error err = {0};
    struct study_result study = built_study("contact", "finite", 1);
    struct case_result *one = &study.cases[0];
    struct plot_lines lines = {0};
    const struct lines_request area = {.quantity = "contact_area"};
    add_curve(one, "contact_area", "edges", "layered", 4, 0);
    add_curve(one, "contact_area", "edges", "full", 4, 0);
    one->curves[1].kinematics = "hencky";
    assert_int_equal(plot_lines_choose(&lines, &study, &area, &err), 0);
    assert_int_equal(lines.channels[CHANNEL_COLOUR].count, 2);
    assert_int_equal(lines.channels[CHANNEL_DASH].count, 1);
    assert_int_equal(lines.channels[CHANNEL_PANEL].count, 1);
    plot_lines_clear(&lines);
    add_curve(one, "contact_area", "edges", "full", 4, 0);
    one->curves[2].kinematics = "green";
    assert_int_equal(plot_lines_choose(&lines, &study, &area, &err), 0);
    assert_int_equal(lines.channels[CHANNEL_COLOUR].count, 3); /* which names the model, too */
    assert_int_equal(lines.channels[CHANNEL_DASH].count, 1);
    plot_lines_clear(&lines);
    study_result_clear(&study);
}

/* Patches in the cell and patches per wave have no axis in common. */
static void one_unit_a_picture(void **state) {
    (void)state;
    struct study_result study = contact_of(1, 1);
    struct case_result *one = &study.cases[0];
    struct error err = {0};
    struct plot_lines lines = {0};
    struct lines_request request = {.quantity = "patch_count"};
    add_curve(one, "patch_count", "cell", "halfspace", 4, 0);
    add_curve(one, "patch_count", "wave", "halfspace", 4, 0);
    assert_int_equal(plot_lines_choose(&lines, &study, &request, &err), 0);
    assert_int_equal(lines.count, 1);
    plot_lines_clear(&lines);
    request.y_label = "per wave";
    assert_int_equal(plot_lines_choose(&lines, &study, &request, &err), 0);
    assert_int_equal(lines.count, 1);
    assert_string_equal(lines.list[0].curve->series, "wave");
    plot_lines_clear(&lines);
    study_result_clear(&study);
}

static char *picture_of(const struct study_result *study, const struct plot_request *request) {
    struct error err = {0};
    char *text;
    assert_int_equal(picture_text(study, request, &text, &err), 0);
    return text;
}

static const struct plot_request AREA = {.lines = {.quantity = "contact_area"}};

static void a_picture_names_what_it_draws(void **state) {
    (void)state;
    struct study_result study = contact_of(1, 3);
    for (int logarithmic = 0; logarithmic < 2; logarithmic++) {
        char *text = picture_of(
            &study, &(struct plot_request){.lines = {.quantity = "contact_area"},
                                           .axes = logarithmic ? AXES_XY : AXES_AUTOMATIC});
        /* 12 lines; in the legend two series, two models, three levels */
        assert_int_equal(count_of(text, "class=\"curve\""), 12 + 7);
        assert_int_equal(count_of(text, "class=\"bar\""), 4); /* a known error a finest curve */
        assert_int_equal(count_of(text, "class=\"mark\""), 4 * 2 + 4); /* finest; legend */
        assert_int_equal(count_of(text, "class=\"theory\""), 2); /* shared: once, and its legend */
        assert_int_equal(count_of(text, ">theory: Persson<"), 1);
        assert_int_equal(count_of(text, ">level 12<"), 1);
        assert_int_equal(count_of(text, ">nodes<"), 1);
        assert_int_equal(count_of(text, "shown: without brackets"), 1);
        assert_int_equal(count_of(text, "a &amp; b"), 2);
        assert_int_equal(count_of(text, "A/A₀ &lt;share&gt;"), 1);
        assert_null(strstr(text, "nan"));
        assert_null(strstr(text, "inf"));
        free(text);
    }
    /* another theory in one case: each in the colour of its curve */
    study.cases[0].curves[0].theories[0].y = (const double[]){0.15, 0.25};
    char *text = picture_of(&study, &AREA);
    assert_int_equal(count_of(text, "class=\"theory\""), 3);
    assert_int_equal(count_of(text, "theory: Persson, of each line"), 1);
    free(text);
    study_result_clear(&study);
}

/* Points that are means over fewer realisations than the study's are open circles. */
static void missing_realisations_are_seen(void **state) {
    (void)state;
    const double valueless[] = {0, 3};
    struct study_result study = contact_of(1, 1);
    struct curve *curve = &study.cases[0].curves[0];
    char *text = picture_of(&study, &AREA);
    assert_int_equal(count_of(text, "circle"), 0);
    free(text);
    curve->valueless = valueless;
    text = picture_of(&study, &AREA);
    assert_int_equal(count_of(text, "<circle "), 1);
    assert_int_equal(count_of(text, "circles: not over all realisations"), 1);
    free(text);
    /* none has a value there: nothing to mark */
    curve->y = (const double[]){0.2, NAN};
    text = picture_of(&study, &AREA);
    assert_int_equal(count_of(text, "circle"), 0);
    free(text);
    study_result_clear(&study);
}

/* Axes in physical units stand opposite to the others where all lines share them; of several panels
 * the legend has them. */
static void second_axes_have_units(void **state) {
    (void)state;
    struct study_result study = contact_of(1, 1);
    struct case_result *one = &study.cases[0];
    char *text = picture_of(&study, &AREA);
    assert_int_equal(count_of(text, "p, GPa"), 0);
    free(text);
    for (size_t a = 0; a < one->curve_count; a++)
        one->curves[a].x_unit = (struct physical_unit){"Pa", "p", 2e10};
    text = picture_of(&study, &AREA);
    assert_int_equal(count_of(text, ">p, GPa<"), 1);
    assert_int_equal(count_of(text, "class=\"middle\">4</text>"), 1); /* the load 0.2 */
    free(text);
    text = picture_of(&study, &(struct plot_request){.lines = {.quantity = "contact_area",
                                                               .names = {"model", NULL, NULL}}});
    assert_int_equal(count_of(text, "load of 1: p = 20 GPa"), 1);
    assert_int_equal(count_of(text, ">p, GPa<"), 0);
    free(text);
    one->curves[1].x_unit.scale *= 2; /* nothing that they share */
    text = picture_of(&study, &AREA);
    assert_int_equal(count_of(text, ">p, GPa<"), 0);
    free(text);
    study_result_clear(&study);
}

/* More than colours can distinguish stand in panels, which share their axes; numbers are in the
 * margins alone. */
static void many_cases_are_panels(void **state) {
    (void)state;
    struct study_result study = contact_of(20, 1);
    for (size_t c = 0; c < 20; c++) {
        built_parameter(&study.cases[c], "/surface/heights/distribution",
                        c % 2 ? "weibull_min" : "weibull_max", 0);
        built_parameter(&study.cases[c], "/surface/wavelength_ratio", NULL, c < 10 ? 8 : 16);
        size_t step = c % 10 / 2;
        study.cases[c].parameters[0].number = 0.1 * (double)(step + 1);
    }
    char *text = picture_of(&study, &AREA);
    assert_int_equal(count_of(text, "<g class=\"panel\">"), 2);
    assert_int_equal(count_of(text, "class=\"curve\""), 20 + 5 + 2);
    assert_int_equal(count_of(text, ">H = 0.3<"), 1);
    assert_int_equal(count_of(text, ">Weibull min<"), 1);
    assert_int_equal(count_of(text, "</tspan> 16</text>"), 1); /* of a panel alone */
    assert_int_equal(count_of(text, "class=\"end\">0.2</text>"), 1);
    assert_int_equal(count_of(text, "class=\"middle\">0.2</text>"), 2);
    assert_int_equal(count_of(text, "first 12"), 0);
    assert_int_equal(count_of(text, "#440154"),
                     4 * (1 + 1 + 3 + 2 * 2) + 3); /* the least H is darkest */
    free(text);
    study_result_clear(&study);
}

/* On paper letters are small, a narrow picture has its legend below, and its title is the caption's
 * matter. */
static void pictures_have_sizes_on_paper(void **state) {
    (void)state;
    struct study_result study = contact_of(1, 1);
    struct plot_request request = AREA;
    struct error err = {0};
    assert_int_equal(plot_width_read("one", &request.millimetres, &err), 0);
    char *text = picture_of(&study, &request);
    assert_int_equal(count_of(text, "width=\"85mm\""), 1);
    assert_int_equal(count_of(text, "viewBox=\"0 0 321 "), 1);
    assert_int_equal(count_of(text, "font:10px"), 1);
    assert_int_equal(count_of(text, "a &amp; b"), 1);
    free(text);
    assert_int_equal(plot_width_read("120mm", &request.millimetres, &err), 0);
    assert_true(request.millimetres == 120);
    assert_int_equal(plot_width_read("two", &request.millimetres, &err), 0);
    assert_true(request.millimetres == WIDTH_TWO);
    static const char *const BAD[] = {"", "mm", "10", "1001", "nan", "85cm", "three"};
    for (size_t n = 0; n < sizeof BAD / sizeof *BAD; n++)
        assert_int_equal(plot_width_read(BAD[n], &request.millimetres, &err), ERROR_INPUT);
    study_result_clear(&study);
}

/* A difference names its cases, and has a band about a line of no difference. */
static void differences_have_bands(void **state) {
    (void)state;
    struct study_result study = contact_of(1, 1);
    struct case_result *one = &study.cases[0];
    one->difference = true;
    one->case_number = 2;
    for (size_t a = 0; a < one->curve_count; a++) {
        struct curve *curve = &one->curves[a];
        curve->y = built_numbers(one, 2, (const double[]){-0.1, 0.2});
        curve->standard_error = built_numbers(one, 2, (const double[]){0.05, 0.05});
        curve->minuend = curve->subtrahend = curve->y;
    }
    char *text = picture_of(&study, &AREA);
    assert_int_equal(count_of(text, "contact area, case 2 less case 0"), 2);
    assert_int_equal(count_of(text, "class=\"band\""), 8);
    assert_int_equal(count_of(text, "class=\"bar\""), 0);
    assert_int_equal(count_of(text, ">bands: one standard error<"), 1);
    free(text);
    study_result_clear(&study);
}

/* Around a bar of one standard error stands that of the total, dashed where a source is not known;
 * around a band a paler one. */
static void total_errors_are_drawn_around(void **state) {
    (void)state;
    static const double MESH[] = {-0.01, -0.01}, BOUND[] = {0.02, 0.02};
    struct study_result study = contact_of(1, 1);
    struct case_result *one = &study.cases[0];
    one->curve_count = 1;
    one->curves[0].errors[ERROR_DISCRETISATION] = (struct curve_error){
        .applies = true, .value = MESH, .bound = BOUND, .standard_error = BOUND, .order = NAN};
    char *text = picture_of(&study, &AREA);
    assert_int_equal(count_of(text, "class=\"bar\""), 1);
    assert_int_equal(count_of(text, "class=\"total\""), 2 * 3); /* a bar and its ends, each */
    assert_int_equal(count_of(text, ">bars: one standard error<"), 1);
    assert_int_equal(count_of(text, ">thin bars: total, 95 %<"), 1);
    assert_int_equal(count_of(text, "dashed"), 0);
    free(text);
    one->curves[0].errors[ERROR_BLOCK].applies = true;
    one->curves[0].errors[ERROR_SOLVER].applies = true;
    text = picture_of(&study, &AREA);
    assert_int_equal(count_of(text, "class=\"total part\""), 2);
    assert_int_equal(count_of(text, ">dashed bars: without block, solver<"), 1);
    free(text);
    text = picture_of(&study, &(struct plot_request){.lines = {.quantity = "contact_area"},
                                                     .without_total = true});
    assert_int_equal(count_of(text, "class=\"total"), 0);
    assert_int_equal(count_of(text, "total, 95 %") + count_of(text, "dashed"), 0);
    assert_int_equal(count_of(text, "class=\"bar\""), 1);
    free(text);
    one->curves[0].minuend = one->curves[0].subtrahend = one->curves[0].y;
    one->curves[0].standard_error = BOUND;
    text = picture_of(&study, &AREA);
    assert_int_equal(count_of(text, "class=\"band\""), 1);
    assert_int_equal(count_of(text, "class=\"wide part\""), 1);
    assert_int_equal(count_of(text, ">pale bands: total, 95 %<"), 1);
    assert_int_equal(count_of(text, ">dashed edges: without block, solver<"), 1);
    free(text);
    study_result_clear(&study);
}

/* However large a total is, lines keep a fifth of the height at least, and its bar ends at the
 * frame. */
static void lines_stay_large(void **state) {
    (void)state;
    static const double LARGE[] = {0, 0}, BOUND[] = {1000, 1000};
    struct study_result study = contact_of(1, 1);
    struct case_result *one = &study.cases[0];
    one->curve_count = 1;
    one->curves[0].errors[ERROR_CELL] = (struct curve_error){
        .applies = true, .value = LARGE, .bound = BOUND, .standard_error = LARGE, .order = NAN};
    for (enum plot_axes axes = AXES_LINEAR; axes < AXES_COUNT; axes++) {
        char *text = picture_of(
            &study, &(struct plot_request){.lines = {.quantity = "contact_area"}, .axes = axes});
        double x = NAN, from = NAN, to = NAN;
        const char *path = strstr(text, "class=\"curve\"");
        path = path != NULL ? strstr(path, " d=\"M") : NULL;
        assert_true(path != NULL && sscanf(path, " d=\"M%lf %lfL%lf %lf", &x, &from, &x, &to) == 4);
        if (!(from - to > (FRAME_BOTTOM - FRAME_TOP) / 5.0))
            fail_msg("axes %d: the line goes from %g to %g", (int)axes, from, to);
        assert_int_equal(count_of(text, "class=\"total\""), 2); /* bars without ends */
        assert_null(strstr(text, "nan"));
        assert_null(strstr(text, "inf"));
        free(text);
    }
    study_result_clear(&study);
}

/* The kind's view, not the picture, knows which quantity spans decades. */
static void the_view_sets_logarithmic_axes(void **state) {
    (void)state;
    static const char *const KINDS[] = {"statistics", "no such kind"};
    for (size_t n = 0; n < 2; n++) {
        struct study_result study = built_study(KINDS[n], "spectrum", 1);
        struct case_result *one = &study.cases[0];
        struct curve curve = built_points(one, "psd", 3, (const double[]){1, 10, 1000},
                                          (const double[]){1, 1e-3, 1e-6}, (const double[3]){0});
        built_curve(one, &curve);
        struct plot_request request = {.lines = {.quantity = "psd"}};
        char *text = picture_of(&study, &request);
        assert_int_equal(count_of(text, ">100</text>"), n == 0); /* a tick of the x axis */
        free(text);
        study_result_clear(&study);
    }
}

/* Of one-plus the height of a point is log(1 + y); zero is drawn, and the label says what is
 * drawn. Differences, which may be below -1, stay linear. */
static void one_plus_shows_peaks_beside_low_parts(void **state) {
    (void)state;
    struct study_result study = built_study("statistics", "peaks", 1);
    struct case_result *one = &study.cases[0];
    struct curve curve =
        built_points(one, "summit_height_pdf", 4, (const double[]){0, 1, 2, 3},
                     (const double[]){0, 1, 3, 9}, (const double[]){NAN, NAN, NAN, NAN});
    curve.y_label = "density";
    built_curve(one, &curve);
    struct plot_request request = {.lines = {.quantity = "summit_height_pdf"},
                                   .axes = AXES_ONE_PLUS};
    char *text = picture_of(&study, &request);
    struct frame frame = {.y = {.high = 9, .plus = 1}, .top = FRAME_TOP, .bottom = FRAME_BOTTOM};
    const double height = FRAME_BOTTOM - FRAME_TOP;
    assert_true(fabs(frame_y(&frame, 0) - FRAME_BOTTOM) < 1e-9);
    assert_true(fabs(frame_y(&frame, 1) - (FRAME_BOTTOM - height * log10(2))) < 1e-9);
    assert_true(fabs(frame_y(&frame, 9) - FRAME_TOP) < 1e-9);
    assert_false(frame_has_place(&frame, 0, -1));
    assert_true(frame_has_place(&frame, 0, -0.5));
    assert_int_equal(count_of(text, ">density, as log10(1 + y)<"), 1);
    assert_int_equal(count_of(text, "class=\"end\">0</text>"), 1);
    assert_int_equal(count_of(text, "class=\"end\">5</text>"), 1);
    assert_null(strstr(text, "nan"));
    free(text);
    one->difference = true;
    one->curves[0].minuend = one->curves[0].subtrahend = one->curves[0].y;
    text = picture_of(&study, &request);
    assert_int_equal(count_of(text, ">difference of density<"), 1);
    free(text);
    study_result_clear(&study);
}

/* A second axis shows the heights of one-plus in its unit: 2 stands where the other has 1. */
static void second_axes_of_one_plus_agree(void **state) {
    (void)state;
    const struct frame frame = {.y = {.high = 9, .plus = 1},
                                .top = FRAME_TOP,
                                .right = FRAME_RIGHT,
                                .bottom = FRAME_BOTTOM,
                                .scale = 1};
    char *text = NULL, tick[64];
    size_t size;
    FILE *file = open_memstream(&text, &size);
    assert_non_null(file);
    frame_draw_second(file, &frame, (const double[]){0, 2}, NULL, "z");
    assert_int_equal(fclose(file), 0);
    snprintf(tick, sizeof tick, "y=\"%.1f\">2</text>", frame_y(&frame, 1) + 4);
    assert_int_equal(count_of(text, tick), 1);
    free(text);
}

/* Pits of one distribution are the summits of its mirror image, and are called so where all lines
 * are of one; the summits themselves can be chosen by what the legend calls them. */
static void pits_are_named_after_their_distribution(void **state) {
    (void)state;
    struct error err = {0};
    for (int mixed = 0; mixed < 2; mixed++) {
        struct study_result study = built_study("statistics", "pits", 2);
        struct plot_lines lines = {0};
        struct lines_request request = {.quantity = "summit_height_pdf",
                                        .names = {[CHANNEL_DASH] = "series"}};
        for (size_t c = 0; c < 2; c++) {
            built_parameter(&study.cases[c], "/surface/heights/distribution",
                            mixed && c == 1 ? "weibull_max" : "weibull_min", 0);
            built_parameter(&study.cases[c], "/surface/hurst", NULL, 0.2 + 0.2 * (double)c);
            add_curve(&study.cases[c], "summit_height_pdf", "", NULL, NAN, 0);
            add_curve(&study.cases[c], "summit_height_pdf", "pits", NULL, NAN, 0);
        }
        assert_int_equal(plot_lines_choose(&lines, &study, &request, &err), 0);
        label_of(&lines, CHANNEL_DASH, 0, "summits");
        label_of(&lines, CHANNEL_DASH, 1, mixed ? "pits" : "Weibull max (as pits)");
        plot_lines_clear(&lines);
        request =
            (struct lines_request){.quantity = "summit_height_pdf", .series = "summit_height_pdf"};
        assert_int_equal(plot_lines_choose(&lines, &study, &request, &err), 0);
        assert_int_equal(lines.count, 2);
        assert_string_equal(lines.list[0].curve->series, "");
        plot_lines_clear(&lines);
        request.series = "pits";
        char *text = picture_of(&study, &(struct plot_request){.lines = request});
        assert_int_equal(count_of(text, mixed ? "summit height PDF, pits"
                                              : "summit height PDF, Weibull max (as pits)"),
                         2);
        free(text);
        study_result_clear(&study);
    }
}

/* A study of one curve, whose y axis is not A/A0. */
static struct study_result one_curve(const char *kind, const char *quantity, size_t n,
                                     const double *x, const double *y, const double *error) {
    struct study_result study = built_study(kind, "one", 1);
    struct curve curve = built_points(&study.cases[0], quantity, n, x, y, error);
    built_curve(&study.cases[0], &curve);
    return study;
}

/* Axes and legends are in words beside their symbols; where a small picture has no room for them,
 * symbols stand alone. */
static void axes_have_words(void **state) {
    (void)state;
    struct study_result study =
        one_curve("contact", "patch_largest_area", 2, (const double[]){0.1, 0.2},
                  (const double[]){0.1, 0.2}, (const double[]){0.01, 0.01});
    struct curve *curve = &study.cases[0].curves[0];
    struct plot_request request = {.lines = {.quantity = "patch_largest_area"}};
    curve->x_label = "p/(E* h'_rms)";
    curve->y_label = "K sqrt(m0)/(E* h'_rms)";
    curve->series = "wave";
    char *text = picture_of(&study, &request);
    assert_int_equal(count_of(text, "one: largest patch area<"), 2);
    assert_int_equal(count_of(text, ">load p/(E* h′"), 1);
    assert_int_equal(count_of(text, ">stiffness K √m₀"), 1);
    assert_int_equal(count_of(text, ">per longest wave<"), 1);
    free(text);
    request.millimetres = 40;
    text = picture_of(&study, &request);
    assert_int_equal(count_of(text, ">load p/(E* h′"), 1);
    assert_int_equal(count_of(text, ">stiffness K √m₀"), 0);
    assert_int_equal(count_of(text, ">K √m₀"), 1);
    free(text);
    study_result_clear(&study);
}

/* Numbers at axes have a minus sign, and a power of ten where they are large. */
static void numbers_are_set(void **state) {
    (void)state;
    struct study_result study =
        one_curve("contact", "work", 3, (const double[]){-2, 0, 2}, (const double[]){1e7, 2e7, 4e7},
                  (const double[]){0, 0, 0});
    char *text = picture_of(&study, &(struct plot_request){.lines = {.quantity = "work"}});
    assert_int_equal(count_of(text, ">−2</text>"), 1);
    assert_int_equal(count_of(text, ">-2</text>"), 0);
    assert_int_equal(count_of(text, ">2×10<tspan class=\"index\" dy=\"-5\">7</tspan></text>"), 1);
    assert_int_equal(count_of(text, ">10<tspan class=\"index\" dy=\"-5\">7</tspan></text>"), 1);
    assert_int_equal(count_of(text, "e+07"), 0);
    free(text);
    study_result_clear(&study);
}

/* Bands of more than three lines hide each other: the legend says that totals are left out. */
static void totals_of_many_bands_are_left_out(void **state) {
    (void)state;
    enum { POINTS = 50 };
    double x[POINTS], y[POINTS], error[POINTS];
    for (size_t n = 0; n < POINTS; n++) {
        x[n] = (double)n;
        y[n] = 1 + (double)n;
        error[n] = 0.5;
    }
    for (size_t cases = 3; cases <= 4; cases++) {
        struct study_result study = built_study("statistics", "bands", cases);
        for (size_t c = 0; c < cases; c++) {
            struct curve curve =
                built_points(&study.cases[c], "summit_height_pdf", POINTS, x, y, error);
            built_parameter(&study.cases[c], "/surface/hurst", NULL, 0.1 * (double)(c + 1));
            built_curve(&study.cases[c], &curve);
        }
        struct plot_request request = {.lines = {.quantity = "summit_height_pdf"}};
        char *text = picture_of(&study, &request);
        assert_int_equal(count_of(text, "class=\"band\""), cases);
        assert_int_equal(count_of(text, "class=\"wide\""), cases > 3 ? 0 : cases);
        assert_int_equal(count_of(text, ">total, 95 %: not drawn of so many bands<"), cases > 3);
        assert_int_equal(count_of(text, ">pale bands: total, 95 %<"), cases <= 3);
        free(text);
        request.lines.names[CHANNEL_PANEL] = "hurst"; /* a panel each has room for them */
        text = picture_of(&study, &request);
        assert_int_equal(count_of(text, "class=\"wide\""), cases);
        free(text);
        study_result_clear(&study);
    }
}

/* Where nothing else has dashes, coarser levels have them. */
static void levels_differ_by_dashes_that_are_free(void **state) {
    (void)state;
    struct study_result study = contact_of(1, 3);
    struct plot_request request = {
        .lines = {.quantity = "contact_area", .series = "edges", .model = "layered"}};
    char *text = picture_of(&study, &request);
    assert_int_equal(count_of(text, "stroke-dasharray=\"9 3\""), 2); /* and the legend */
    assert_int_equal(count_of(text, "stroke-dasharray=\"4 3\""), 2);
    free(text);
    request.lines.model = NULL;
    request.lines.names[CHANNEL_DASH] = "model"; /* which has the dashes */
    text = picture_of(&study, &request);
    assert_int_equal(count_of(text, "stroke-dasharray=\"9 3\""), 0);
    free(text);
    study_result_clear(&study);
}

/* Returns whether all lines of a class have dots among their dashes, or none has. */
static bool has_dots(const char *text, const char *class, bool dots) {
    static const char BEGIN[] = "stroke-dasharray=\"";
    bool all = true;
    for (const char *at = text; (at = strstr(at, class)) != NULL; at++) {
        const char *end = strstr(at, "/>"), *dash = strstr(at, BEGIN);
        bool dashed = dash != NULL && dash < end;
        const char *dot = dashed ? strstr(dash, "1.5 ") : NULL;
        bool has = dot != NULL && dot < strchr(dash + sizeof BEGIN, '"');
        all = all && has == dots;
    }
    return all;
}

/* Theories have dots, and curves, of several models or levels, dashes alone. */
static void theories_are_no_curves(void **state) {
    (void)state;
    struct study_result study = contact_of(2, 4);
    for (int dash = 0; dash < 2; dash++) {
        const struct plot_request request = {
            .lines = {.quantity = "contact_area",
                      .model = dash ? NULL : "layered",
                      .series = "edges",
                      .names = {[CHANNEL_DASH] = dash ? "model" : NULL}}};
        char *text = picture_of(&study, &request);
        assert_true(count_of(text, "class=\"theory\"") > 1);
        assert_true(count_of(text, "stroke-dasharray") > 3);
        assert_true(has_dots(text, "class=\"theory\"", true));
        assert_true(has_dots(text, "class=\"curve\"", false));
        free(text);
    }
    study_result_clear(&study);
}

/* Marks of the last load are drawn within the frame, on linear and on logarithmic axes. */
static void marks_keep_away_from_the_frame(void **state) {
    (void)state;
    struct study_result study = contact_of(1, 1);
    for (int logarithmic = 0; logarithmic < 2; logarithmic++) {
        char *text = picture_of(
            &study, &(struct plot_request){.lines = {.quantity = "contact_area"},
                                           .axes = logarithmic ? AXES_XY : AXES_AUTOMATIC});
        double most = 0, x;
        for (const char *at = text; (at = strstr(at, "<path transform=\"translate(")) != NULL;
             at++) {
            assert_int_equal(sscanf(at, "<path transform=\"translate(%lf", &x), 1);
            most = x < FRAME_RIGHT && x > most ? x : most;
        }
        assert_true(most < FRAME_RIGHT - 8 && most > FRAME_RIGHT - 40);
        free(text);
    }
    study_result_clear(&study);
}

/* A series without a name is called as its quantity is. */
static void what_is_shown_has_a_name(void **state) {
    (void)state;
    struct error err = {0};
    struct study_result study = built_study("contact", "leaks", 13);
    const struct lines_request request = {.quantity = "leak"};
    struct plot_lines lines = {0};
    for (size_t c = 0; c < 13; c++) {
        built_parameter(&study.cases[c], "/surface/hurst", NULL, 0.05 * (double)(c + 1));
        add_curve(&study.cases[c], "leak", "", NULL, 8, 0);
        add_curve(&study.cases[c], "leak", "effective_medium", NULL, 8, 0);
        add_curve(&study.cases[c], "leak", "", NULL, 4, 0);
    }
    assert_int_equal(plot_lines_choose(&lines, &study, &request, &err), 0);
    assert_string_equal(lines.narrowed, "finest level, leak");
    plot_lines_clear(&lines);
    study_result_clear(&study);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(lines_narrow_as_far_as_they_must),
        cmocka_unit_test(channels_name_their_values),
        cmocka_unit_test(what_there_is_not_is_refused),
        cmocka_unit_test(kinematics_go_with_their_model),
        cmocka_unit_test(one_unit_a_picture),
        cmocka_unit_test(second_axes_have_units),
        cmocka_unit_test(many_cases_are_panels),
        cmocka_unit_test(pictures_have_sizes_on_paper),
        cmocka_unit_test(a_picture_names_what_it_draws),
        cmocka_unit_test(missing_realisations_are_seen),
        cmocka_unit_test(differences_have_bands),
        cmocka_unit_test(total_errors_are_drawn_around),
        cmocka_unit_test(lines_stay_large),
        cmocka_unit_test(the_view_sets_logarithmic_axes),
        cmocka_unit_test(one_plus_shows_peaks_beside_low_parts),
        cmocka_unit_test(second_axes_of_one_plus_agree),
        cmocka_unit_test(pits_are_named_after_their_distribution),
        cmocka_unit_test(axes_have_words),
        cmocka_unit_test(numbers_are_set),
        cmocka_unit_test(totals_of_many_bands_are_left_out),
        cmocka_unit_test(levels_differ_by_dashes_that_are_free),
        cmocka_unit_test(theories_are_no_curves),
        cmocka_unit_test(marks_keep_away_from_the_frame),
        cmocka_unit_test(what_is_shown_has_a_name),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
