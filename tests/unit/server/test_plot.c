/* Protects: a picture shows as many curves as its legend can name, says what it leaves out, and
 * tells models, levels, estimators and theories apart. */
#include "server/show/plot.h"
#include "server/show/plot_choice.h"
#include "tests/support/check.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* A curve of two points. theory: a value that tells theories apart; 0 for none. */
static void add_curve(cJSON *curves, const char *quantity, const char *series, const char *model,
                      double level, double theory) {
    char text[512], theories[64] = "";
    if (theory > 0)
        snprintf(theories, sizeof theories, "\"persson\":[%g,%g]", theory, 2 * theory);
    snprintf(
        text, sizeof text,
        "{\"quantity\":\"%s\",\"series\":\"%s\",\"model\":\"%s\",\"level\":%g,\"x\":[0.1,0.2],"
        "\"y\":[0.2,0.3],\"standard_error\":[0.05,null],\"x_label\":\"load\",\"y_label\":\"%s\","
        "\"theory\":{%s}}",
        quantity, series, model, level, strcmp(series, "wave") == 0 ? "per wave" : "A/A0 <share>",
        theories);
    cJSON *curve = cJSON_Parse(text);
    assert_non_null(curve);
    cJSON_AddItemToArray(curves, curve);
}

/* Cases of two models, as many levels, and the estimators edges and nodes with its bracket. */
static cJSON *contact_of(int cases, int levels) {
    static const char *const SERIES[] = {"edges", "nodes", "nodes_lower", "nodes_upper"};
    cJSON *document = cJSON_Parse("{\"name\":\"a & b\"}");
    cJSON *list = cJSON_AddArrayToObject(document, "cases");
    for (int c = 0; c < cases; c++) {
        cJSON *one = cJSON_CreateObject();
        cJSON_AddItemToArray(list, one);
        cJSON_AddNumberToObject(one, "case", c);
        cJSON_AddNumberToObject(cJSON_AddObjectToObject(one, "parameters"), "/surface/hurst",
                                0.1 * (c + 1));
        cJSON *curves = cJSON_AddArrayToObject(one, "curves");
        for (int s = 0; s < 4; s++)
            for (int m = 0; m < 2; m++)
                for (int l = levels; l > 0; l--)
                    add_curve(curves, "contact_area", SERIES[s], m ? "layered" : "halfspace", 4 * l,
                              s < 2 ? 0.1 : 0);
    }
    return document;
}

static void a_choice_narrows_as_far_as_it_must(void **state) {
    (void)state;
    static const struct {
        int cases, levels;
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
        cJSON *document = contact_of(CHOICES[n].cases, CHOICES[n].levels);
        struct plot_choice choice;
        char label[PLOT_LABEL_SIZE];
        size_t colours = 0;
        plot_choose(&choice, document, "contact_area", NULL);
        assert_int_equal(choice.count, CHOICES[n].count);
        assert_string_equal(choice.left_out, CHOICES[n].left_out);
        plot_label(&choice, 0, label);
        assert_string_equal(label, CHOICES[n].first);
        plot_label(&choice, choice.count - 1, label);
        assert_string_equal(label, CHOICES[n].last);
        for (size_t l = 0; l < choice.count; l++)
            colours = choice.lines[l].colour >= colours ? choice.lines[l].colour + 1 : colours;
        assert_int_equal(colours, CHOICES[n].colours); /* levels share theirs */
        cJSON_Delete(document);
    }
}

/* Where strains are finite, their kinematics are named, even where all lines have the same. */
static void kinematics_are_named(void **state) {
    (void)state;
    cJSON *document = cJSON_Parse("{\"cases\":[{\"case\":0,\"curves\":[]}]}");
    cJSON *one = cJSON_GetObjectItem(document, "cases")->child;
    cJSON *curves = cJSON_GetObjectItem(one, "curves");
    struct plot_choice choice;
    char label[PLOT_LABEL_SIZE];
    add_curve(curves, "contact_area", "edges", "full", 4, 0);
    cJSON_AddStringToObject(curves->child, "kinematics", "hencky");
    plot_choose(&choice, document, "contact_area", NULL);
    plot_label(&choice, 0, label);
    assert_string_equal(label, "full (hencky), edges");
    add_curve(curves, "contact_area", "edges", "layered", 4, 0);
    plot_choose(&choice, document, "contact_area", NULL);
    plot_label(&choice, 1, label);
    assert_string_equal(label, "layered, edges");
    cJSON_Delete(document);
}

/* Patches in the cell and patches per wave have no axis in common. */
static void one_unit_a_picture(void **state) {
    (void)state;
    cJSON *document = contact_of(1, 1);
    cJSON *curves = cJSON_GetObjectItem(
        cJSON_GetArrayItem(cJSON_GetObjectItem(document, "cases"), 0), "curves");
    struct plot_choice choice;
    add_curve(curves, "patch_count", "cell", "halfspace", 4, 0);
    add_curve(curves, "patch_count", "wave", "halfspace", 4, 0);
    plot_choose(&choice, document, "patch_count", NULL);
    assert_int_equal(choice.count, 1);
    plot_choose(&choice, document, "patch_count", "per wave");
    assert_int_equal(choice.count, 1);
    assert_string_equal(cJSON_GetStringValue(cJSON_GetObjectItem(choice.lines[0].curve, "series")),
                        "wave");
    plot_choose(&choice, document, "colour", NULL);
    assert_int_equal(choice.count, 0);
    cJSON_Delete(document);
}

static char *picture_of(const cJSON *document, bool logarithmic) {
    struct plot_request request = {.quantity = "contact_area", .logarithmic = logarithmic};
    struct error err = {0};
    char *text = NULL;
    size_t size = 0;
    FILE *file = open_memstream(&text, &size);
    assert_non_null(file);
    assert_int_equal(plot_quantity(document, &request, file, &err), 0);
    fclose(file);
    return text;
}

static size_t count_of(const char *text, const char *part) {
    size_t count = 0;
    for (; (text = strstr(text, part)); text += strlen(part))
        count++;
    return count;
}

static void a_picture_names_what_it_draws(void **state) {
    (void)state;
    cJSON *document = contact_of(1, 3);
    for (int logarithmic = 0; logarithmic < 2; logarithmic++) {
        char *text = picture_of(document, logarithmic != 0);
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
    cJSON *theory = cJSON_CreateObject();
    const double other[] = {0.15, 0.25};
    cJSON_AddItemToObject(theory, "persson", cJSON_CreateDoubleArray(other, 2));
    cJSON *one = cJSON_GetArrayItem(cJSON_GetObjectItem(document, "cases"), 0);
    cJSON_ReplaceItemInObject(cJSON_GetArrayItem(cJSON_GetObjectItem(one, "curves"), 0), "theory",
                              theory);
    char *text = picture_of(document, false);
    assert_int_equal(count_of(text, "class=\"theory\""), 3);
    assert_int_equal(count_of(text, "theory: persson of each"), 1);
    free(text);
    cJSON_Delete(document);
}

/* Points that are means over fewer realisations than the study's are open circles. */
static void missing_realisations_are_seen(void **state) {
    (void)state;
    const double valueless[] = {0, 3};
    cJSON *document = contact_of(1, 1);
    cJSON *one = cJSON_GetArrayItem(cJSON_GetObjectItem(document, "cases"), 0);
    cJSON *curve = cJSON_GetArrayItem(cJSON_GetObjectItem(one, "curves"), 0);
    char *text = picture_of(document, false);
    assert_int_equal(count_of(text, "circle"), 0);
    free(text);
    cJSON_AddItemToObject(curve, "valueless", cJSON_CreateDoubleArray(valueless, 2));
    text = picture_of(document, false);
    assert_int_equal(count_of(text, "<circle "), 1);
    assert_int_equal(count_of(text, "circles: not over all realisations"), 1);
    free(text);
    /* none has a value there: nothing to mark */
    cJSON_ReplaceItemInArray(cJSON_GetObjectItem(curve, "y"), 1, cJSON_CreateNull());
    text = picture_of(document, false);
    assert_int_equal(count_of(text, "circle"), 0);
    free(text);
    cJSON_Delete(document);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_choice_narrows_as_far_as_it_must),
        cmocka_unit_test(kinematics_are_named),
        cmocka_unit_test(one_unit_a_picture),
        cmocka_unit_test(a_picture_names_what_it_draws),
        cmocka_unit_test(missing_realisations_are_seen),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
