/* Protects: a picture shows as many curves as its legend can name, says what it leaves out, and
 * tells models, levels, estimators and theories apart. */
#include "server/show/plot.h"
#include "server/show/plot_choice.h"
#include "tests/support/check.h"
#include "tests/support/count_of.h"
#include "tests/support/result_builder.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* A curve of two points. theory: a value that tells theories apart; 0 for none. */
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

static void a_choice_narrows_as_far_as_it_must(void **state) {
    (void)state;
    static const struct {
        size_t cases;
        int levels;
        size_t count, colours;
        const char *left_out, *first, *last;
    } CHOICES[] = {
        {1, 1, 8, 8, "", "halfspace, edges", "layered, nodes_upper"},
        {1, 3, 12, 4, "without brackets", "halfspace, edges, level 12", "layered, nodes, level 4"},
        {2, 2, 8, 8, "without brackets, finest level", "hurst 0.1, halfspace, edges",
         "hurst 0.2, layered, nodes"},
        {5, 2, 10, 10, "without brackets, finest level, edges", "hurst 0.1, halfspace, edges",
         "hurst 0.5, layered, edges"},
        {9, 1, 9, 9, "without brackets, edges, halfspace", "hurst 0.1, edges", "hurst 0.9, edges"},
        {20, 1, 12, 12, "without brackets, edges, halfspace, first 12 of 20 curves",
         "hurst 0.1, edges", "hurst 1.2, edges"},
    };
    for (size_t n = 0; n < sizeof CHOICES / sizeof *CHOICES; n++) {
        struct study_result study = contact_of(CHOICES[n].cases, CHOICES[n].levels);
        struct plot_choice choice;
        char label[PLOT_LABEL_SIZE];
        size_t colours = 0;
        plot_choose(&choice, &study, "contact_area", NULL);
        assert_int_equal(choice.count, CHOICES[n].count);
        assert_string_equal(choice.left_out, CHOICES[n].left_out);
        plot_label(&choice, 0, label);
        assert_string_equal(label, CHOICES[n].first);
        plot_label(&choice, choice.count - 1, label);
        assert_string_equal(label, CHOICES[n].last);
        for (size_t l = 0; l < choice.count; l++)
            colours = choice.lines[l].colour >= colours ? choice.lines[l].colour + 1 : colours;
        assert_int_equal(colours, CHOICES[n].colours); /* levels share theirs */
        study_result_clear(&study);
    }
}

/* Where strains are finite, their kinematics are named, even where all lines have the same. */
static void kinematics_are_named(void **state) {
    (void)state;
    struct study_result study = built_study("contact", "finite", 1);
    struct case_result *one = &study.cases[0];
    struct plot_choice choice;
    char label[PLOT_LABEL_SIZE];
    add_curve(one, "contact_area", "edges", "full", 4, 0);
    one->curves[0].kinematics = "hencky";
    plot_choose(&choice, &study, "contact_area", NULL);
    plot_label(&choice, 0, label);
    assert_string_equal(label, "full (hencky), edges");
    add_curve(one, "contact_area", "edges", "layered", 4, 0);
    plot_choose(&choice, &study, "contact_area", NULL);
    plot_label(&choice, 1, label);
    assert_string_equal(label, "layered, edges");
    study_result_clear(&study);
}

/* Patches in the cell and patches per wave have no axis in common. */
static void one_unit_a_picture(void **state) {
    (void)state;
    struct study_result study = contact_of(1, 1);
    struct case_result *one = &study.cases[0];
    struct plot_choice choice;
    add_curve(one, "patch_count", "cell", "halfspace", 4, 0);
    add_curve(one, "patch_count", "wave", "halfspace", 4, 0);
    plot_choose(&choice, &study, "patch_count", NULL);
    assert_int_equal(choice.count, 1);
    plot_choose(&choice, &study, "patch_count", "per wave");
    assert_int_equal(choice.count, 1);
    assert_string_equal(choice.lines[0].curve->series, "wave");
    plot_choose(&choice, &study, "colour", NULL);
    assert_int_equal(choice.count, 0);
    study_result_clear(&study);
}

static char *picture_of(const struct study_result *study, const struct plot_request *request) {
    struct error err = {0};
    char *text = NULL;
    size_t size = 0;
    FILE *file = open_memstream(&text, &size);
    assert_non_null(file);
    assert_int_equal(plot_quantity(study, request, file, &err), 0);
    fclose(file);
    return text;
}

static const struct plot_request AREA = {.quantity = "contact_area"};

static void a_picture_names_what_it_draws(void **state) {
    (void)state;
    struct study_result study = contact_of(1, 3);
    for (int logarithmic = 0; logarithmic < 2; logarithmic++) {
        char *text = picture_of(
            &study, &(struct plot_request){.quantity = "contact_area", .logarithmic = logarithmic});
        assert_int_equal(count_of(text, "class=\"curve\""), 24); /* a line and its legend each */
        assert_int_equal(count_of(text, "class=\"bar\""), 4);    /* a known error a finest curve */
        assert_int_equal(count_of(text, "class=\"theory\""), 2); /* shared: once, and its legend */
        assert_int_equal(count_of(text, "theory: persson<"), 1);
        assert_int_equal(count_of(text, "shown: without brackets"), 1);
        assert_int_equal(count_of(text, "a &amp; b"), 2);
        assert_int_equal(count_of(text, "A/A0 &lt;share&gt;"), 1);
        assert_null(strstr(text, "nan"));
        assert_null(strstr(text, "inf"));
        free(text);
    }
    /* another theory in one case: each in the colour of its curve */
    study.cases[0].curves[0].theories[0].y = (const double[]){0.15, 0.25};
    char *text = picture_of(&study, &AREA);
    assert_int_equal(count_of(text, "class=\"theory\""), 3);
    assert_int_equal(count_of(text, "theory: persson of each"), 1);
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
        struct plot_request request = {.quantity = "psd"};
        char *text = picture_of(&study, &request);
        assert_int_equal(count_of(text, ">100</text>"), n == 0); /* a tick of the x axis */
        free(text);
        study_result_clear(&study);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_choice_narrows_as_far_as_it_must),
        cmocka_unit_test(kinematics_are_named),
        cmocka_unit_test(one_unit_a_picture),
        cmocka_unit_test(a_picture_names_what_it_draws),
        cmocka_unit_test(missing_realisations_are_seen),
        cmocka_unit_test(the_view_sets_logarithmic_axes),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
