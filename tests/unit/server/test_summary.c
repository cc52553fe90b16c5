/* Protects: tables show what the kind's view asks for, distinguish models, sources of error and
 * missing realisations, and need no view to show a kind. */
#include "schema/result/report.h"
#include "server/show/summary/summary.h"
#include "server/show/summary/summary_cells.h"
#include "server/show/summary/summary_status.h"
#include "server/show/summary/summary_target.h"
#include "server/show/table/text_table.h"
#include "tests/support/check.h"
#include "tests/support/result_builder.h"
#include <stdio.h>
#include <string.h>

static char *table_of(const struct study_result *study, const struct study_report *report) {
    char *text = NULL;
    size_t size = 0;
    FILE *file = open_memstream(&text, &size);
    assert_non_null(file);
    summary_of_curves(study, report, file);
    fclose(file);
    return text;
}

static void check_shown(const char *text, const char *const *parts) {
    for (; *parts != NULL; parts++)
        if (strstr(text, *parts) == NULL)
            fail_msg("no \"%s\" in\n%s", *parts, text);
}

/* Each scalar with a theory has a column; the view's headlines come first, and alone. */
static void scalars_are_those_of_the_view(void **state) {
    (void)state;
    static const char *const KINDS[] = {"statistics", "no such kind"};
    for (size_t n = 0; n < 2; n++) {
        struct study_result study = built_study(KINDS[n], "summits", 2);
        for (size_t c = 0; c < 2; c++) {
            struct case_result *one = &study.cases[c];
            built_parameter(one, "/surface/hurst", NULL, c == 0 ? 0.2 : 0.8);
            built_parameter(one, "/surface/dimension", NULL, 2);
            built_scalar(one, "rms_slope", 1.5, 0.1, 1.0);
            built_scalar(one, "summit_density", 0.25, 0.01, 0.5);
            built_scalar(one, "shape", 3, 0.1, NAN);
        }
        char *text = table_of(&study, NULL);
        check_shown(text,
                    (const char *[]){"summits (done), study 0123456789abcdef, 4 realisations",
                                     "\ncase  hurst  ", "summit_density  total %  theory   ratio",
                                     "0.250 +- 0.010      7.8     0.5  0.5000\n", NULL});
        assert_int_equal(strstr(text, "rms_slope") == NULL, n == 0);
        assert_null(strstr(text, "dimension")); /* not swept */
        assert_null(strstr(text, "shape"));     /* nothing to compare with */
        free(text);
        study_result_clear(&study);
    }
}

/* Two levels of a model; edges before nodes. */
static void add_areas(struct case_result *one, const char *model, const char *kinematics,
                      bool partial) {
    static const char *const SERIES[] = {"edges", "nodes"};
    static const double X[] = {0.1, 0.2, 0.3}, ERROR[] = {0.01, 0.01, 0.01};
    for (int s = 0; s < 2; s++)
        for (int level = 4; level <= 8; level += 4) {
            double base = level == 8 ? 0.2 : 0.7;
            struct curve curve = built_points(
                one, "contact_area", 3, X, (const double[]){base, base + 0.1, base + 0.2}, ERROR);
            curve.series = SERIES[s];
            curve.model = model;
            curve.kinematics = kinematics;
            curve.level = level;
            if (level == 8)
                curve.errors[ERROR_DISCRETISATION] = (struct curve_error){
                    .applies = true,
                    .value = built_numbers(one, 3, (const double[]){0.02, 0, 0.02}),
                    .bound = built_numbers(one, 3, (const double[]){0, 0.03, 0.01})};
            curve.errors[ERROR_CELL].applies = true;
            if (partial)
                curve.valueless = built_numbers(one, 3, (const double[]){0, 0, 3});
            built_theory(one, &curve, "persson", (const double[]){0.15, 0.25, 0.35});
            built_theory(one, &curve, "persson_light_load", (const double[]){0.16, 0.3, 0.5});
            built_curve(one, &curve);
        }
    built_scalar(one, "kappa", 2.5, 0.1, 1.5958);
}

static void few_cases_have_a_table_each(void **state) {
    (void)state;
    struct study_result study = built_study("contact", "pressed", 1);
    add_areas(&study.cases[0], "halfspace", NULL, false);
    char *text = table_of(&study, NULL);
    check_shown(text,
                (const char *[]){"case 0: 4 realisations; contact area by edges at 8 points",
                                 "\nload       halfspace  total %  mesh %   persson\n",
                                 "\n 0.1  0.200 +- 0.010  >20      +10       0.1500\n",
                                 "\n 0.2  0.300 +- 0.010  >17      +-10      0.2500\n",
                                 "\n 0.3  0.400 +- 0.010  >12      +5+-2.5   0.3500\n",
                                 "\nhalfspace: kappa 2.50 +- 0.10 (total 7.8 %, theory 1.5958)",
                                 "\nErrors not known: cell.\n", "\nload: p/(E* h'_rms); area: A/A0",
                                 NULL});
    assert_null(strstr(text, "model %  ")); /* of one model nothing is known */
    assert_null(strstr(text, "light_load"));
    assert_null(strstr(text, "(n of N)"));
    free(text);
    /* beside a second model, which lacks values at the last load */
    add_areas(&study.cases[0], "full", "hencky", true);
    for (size_t a = 0; a < study.cases[0].curve_count; a++)
        study.cases[0].curves[a].errors[ERROR_BLOCK].applies = a >= 4;
    text = table_of(&study, NULL);
    check_shown(text, (const char *[]){"\nErrors not known: cell; block of full.\n", NULL});
    check_shown(text, (const char *[]){"halfspace  total %  mesh %",
                                       "full (hencky)  total %  mesh %   persson",
                                       "0.400 +- 0.010 (1 of 4)", "\n(n of N): only n of N",
                                       "a value at the load;", NULL});
    free(text);
    study_result_clear(&study);
}

/* Where most of an error of the cell is statistical, the table has its largest size alone. */
static void statistical_errors_are_shown_as_sizes(void **state) {
    (void)state;
    static const double ALL[] = {1, 1, 1, 1};
    struct study_result study = built_study("contact", "pressed", 1);
    struct case_result *one = &study.cases[0];
    struct curve curve = built_points(one, "contact_area", 4, (const double[]){1, 2, 3, 4}, ALL,
                                      (const double[]){0.01, 0.01, 0.01, 0.01});
    curve.errors[ERROR_CELL] = (struct curve_error){
        .applies = true,
        .value = built_numbers(one, 4, (const double[]){0.01, -0.05, 0.01, 0}),
        .bound = built_numbers(one, 4, (const double[]){0.03, 0.03, 0.03, 0.03}),
        .standard_error = built_numbers(one, 4, (const double[]){0.015, 0.015, 0.001, 0.015})};
    built_curve(one, &curve);
    char *text = table_of(&study, NULL);
    check_shown(text, (const char *[]){"<4", "-5+-3", "+1+-3", "+-3", NULL});
    free(text);
    study_result_clear(&study);
}

static void many_cases_have_a_row_each(void **state) {
    (void)state;
    struct study_result study = built_study("contact", "pressed", 6);
    for (size_t c = 0; c < 6; c++) {
        built_parameter(&study.cases[c], "/surface/heights/distribution",
                        c < 3 ? "gaussian" : "weibull_min", 0);
        built_parameter(&study.cases[c], "/surface/hurst", NULL, 0.1 * (double)(c % 3 + 1));
        if (c < 5)
            add_areas(&study.cases[c], "layered", NULL, false);
    }
    study.cases[5].realisations = 0;
    char *text = table_of(&study, NULL);
    check_shown(text, (const char *[]){
                          "\ncase  distribution  hurst  realisations  ",
                          "area at 0.1     area at 0.2     area at 0.3  total %  mesh %\n",
                          /* of the lightest load, as in a table a case: it holds of all three */
                          "0.400 +- 0.010  >20          10\n", NULL});
    check_shown(text,
                (const char *[]){"\narea: of layered by edges at 8 points a shortest wave; its "
                                 "total, its errors: the largest at the loads of the row.\n",
                                 NULL});
    check_shown(text, (const char *[]){
                          "         kappa  total %  erf_kappa  ", "\nErrors not known: cell.\n",
                          "\n   4  weibull_min     0.2             4  0.200 +- ", NULL});
    check_shown(text, (const char *[]){
                          "\n   5  weibull_min     0.3             0               -   ", NULL});
    free(text);
    study_result_clear(&study);
}

static const char HEADING[] = "\ncase  realisations  seconds  CPU s  CPU s/realisation  "
                              "statistical %  discretisation %  size %  CPU s to halve\n";

/* The report of one case, made by hand: statistical, two sources, total. */
static void a_report_tells_errors_by_source(void **state) {
    (void)state;
    struct curve_report curves[] = {
        {.place = {.quantity = "contact_area", .series = "edges", .model = "layered", .level = 8},
         .seconds = 16,
         .cpu_seconds = 8,
         .statistical = 0.03,
         .errors = {0.04, NAN, NAN, NAN, NAN, NAN},
         .applies = {[ERROR_DISCRETISATION] = true, [ERROR_BLOCK] = true},
         .total = 0.05,
         .valueless = 1},
        {.place =
             {.quantity = "contact_area", .series = "edges_upper", .model = "layered", .level = 8},
         .seconds = 16,
         .cpu_seconds = 8,
         .errors = {0.04, NAN, NAN, NAN, NAN, NAN}},
    };
    struct case_report one = {.about = {.realisations = 4},
                              .time = {.seconds = 20, .cpu_seconds = 10},
                              .curve_count = 2,
                              .curves = curves,
                              .main = &curves[0]};
    char id[] = "12", name[] = "pressed", kind[] = "contact", done[] = "done", *text = NULL;
    struct study_report report = {
        .id = id, .name = name, .kind = kind, .state = done, .case_count = 1, .cases = &one};
    size_t size = 0;
    FILE *file = open_memstream(&text, &size);
    assert_non_null(file);
    summary_of_report(&report, file);
    fclose(file);
    check_shown(text,
                (const char *[]){"pressed (done), study 12: cost, and relative errors", HEADING,
                                 "4 (3 of 4)       20     10                2.5              3",
                                 "case 0: contact_area by model, level and estimator\n",
                                 "layered (3 of 4)      8  edges",
                                 "(n of N): ", "\nErrors not known: block.\n", NULL});
    assert_null(strstr(text, "upper")); /* a bracket is no estimate */
    free(text);
}

static void numbers_have_the_digits_of_their_error(void **state) {
    (void)state;
    static const struct {
        double value, error;
        const char *text;
    } NUMBERS[] = {{0.257716, 0.00022, "0.25772 +- 0.00022"},
                   {123.4, 17, "123 +- 17"},
                   {2, 0, "2"},
                   {2, NAN, "2"},
                   {1e-12, 1e-13, "1e-12 +- 1e-13"},
                   {NAN, 1, "-"}};
    for (size_t n = 0; n < sizeof NUMBERS / sizeof *NUMBERS; n++) {
        char text[64];
        measured_text(NUMBERS[n].value, NUMBERS[n].error, text, sizeof text);
        assert_string_equal(text, NUMBERS[n].text);
    }
}

/* Failed jobs and cases that could not be published; what is missing is no fault. */
static void failures_are_told(void **state) {
    (void)state;
    static const char DOCUMENT[] =
        "{\"id\":\"12\",\"name\":\"pressed\",\"kind\":\"contact\",\"state\":\"done\",\"jobs\":{"
        "\"done\":3,\"total\":5,\"running\":0,\"failed\":1},\"realisations\":{\"done\":30,"
        "\"total\":50},\"workers\":0,\"seconds\":12,\"cpu_seconds\":5,\"jobs_without_cpu\":1,"
        "\"share\":0.625,\"seconds_left\":null,\"failures\":[{\"job\":4,"
        "\"case\":1,\"first\":10,\"count\":10,\"attempts\":3,\"losses\":2,\"worker\":\"w\","
        "\"reason\":\"lost\"},"
        "{\"case\":2,\"reason\":\"of another program\"}]}";
    cJSON *document = cJSON_Parse(DOCUMENT), *empty = cJSON_Parse("{}");
    char *text = NULL;
    size_t size = 0;
    FILE *file = open_memstream(&text, &size);
    assert_true(file != NULL && document != NULL && empty != NULL);
    summary_of_status(document, file);
    summary_of_status(empty, file);
    fclose(file);
    check_shown(
        text, (const char *[]){
                  "12  pressed  contact  done\n  62.5 % of the work, realisations 30 of 50, jobs 3 "
                  "of 5 (0 running, 1 failed)\n  workers 0, spent 5 s of CPU time in 12 s of "
                  "workers' time, left -\nJobs "
                  "whose CPU time is not known, so that the clock stands for it: 1.\n",
                  "  failed: case 1, realisations 10 to 19, 3 attempts, 2 losses, "
                  "worker w: lost\n",
                  "  not published: case 2: of another program\n", "\n-  -  -  -\n", NULL});
    free(text);
    cJSON_Delete(document);
    cJSON_Delete(empty);
}

/* What a target reached has all its sources, the largest first; one that is the largest is what is
 * left. */
static void a_target_names_its_sources_by_size(void **state) {
    (void)state;
    static const struct {
        const char *name;
        double value;
    } SCALARS[] = {{"error_asked", 0.004}, {"error_reached", 0.0079}, {"error_chance", 0.006},
                   {"error_mesh", 0.0005}, {"error_cell", 0},         {"error_model", 0.001},
                   {"error_solver", 0.005}};
    struct study_result study = built_study("contact", "target", 1);
    char *text = NULL;
    size_t size = 0;
    for (size_t s = 0; s < sizeof SCALARS / sizeof *SCALARS; s++)
        built_scalar(&study.cases[0], SCALARS[s].name, SCALARS[s].value, NAN, NAN);
    FILE *file = open_memstream(&text, &size);
    assert_non_null(file);
    summary_of_target(&study.cases[0], file);
    assert_int_equal(fclose(file), 0);
    check_shown(text, (const char *[]){"reached 0.79 %: statistical 0.6, solver 0.5, model 0.1, "
                                       "mesh 0.05 %\n",
                                       "what is left is the solver", NULL});
    free(text);
    study_result_clear(&study);
}

/* Iterations that end above their tolerance are named by case, in a line and no column. */
static void stopped_iterations_are_named(void **state) {
    (void)state;
    struct study_result study = built_study("statistics", "heights", 3);
    for (size_t c = 0; c < 3; c++) {
        built_parameter(&study.cases[c], "/surface/hurst", NULL, 0.2 * (double)(c + 1));
        built_scalar(&study.cases[c], "eps_h", 0.002, 0.0001, NAN);
        built_scalar(&study.cases[c], "generator_converged", 0.5 * (double)c, 0.1, NAN);
    }
    char *text = table_of(&study, NULL);
    check_shown(text,
                (const char *[]){"\nIterated surfaces end above /surface/heights/tolerance in "
                                 "cases 0, 1 (50 % of them): eps_h, eps_s are what they "
                                 "reach.\n",
                                 NULL});
    assert_null(strstr(text, "generator_converged"));
    free(text);
    study.cases[0].scalars[1].value = study.cases[1].scalars[1].value = 1;
    text = table_of(&study, NULL);
    assert_null(strstr(text, "Iterated"));
    free(text);
    study_result_clear(&study);
}

/* Lines below tables are no longer than these; blanks fold them, and nothing gets lost. */
static void texts_are_folded(void **state) {
    (void)state;
    enum { WORDS = 60, LAST = 150 }; /* the last word is longer than a line */
    char text[WORDS * 5 + LAST + 1], *out = NULL;
    size_t size = 0, length = 0, lines = 0;
    for (size_t n = 0; n < WORDS; n++)
        length += (size_t)snprintf(text + length, sizeof text - length, "%s",
                                   n % 7 == 0 ? "a " : "word ");
    const size_t before = length;
    memset(text + length, 'x', LAST);
    text[length + LAST] = '\0';
    FILE *file = open_memstream(&out, &size);
    assert_non_null(file);
    print_folded(file, text);
    fclose(file);
    assert_int_equal(size, before + LAST + 1);
    for (size_t at = 0, first = 0; at < size; at++) {
        if (out[at] != '\n')
            continue;
        if (at < before)
            assert_true(at - first <= TABLE_ROOM);
        lines++;
        first = at + 1;
        out[at] = ' '; /* as it was */
    }
    assert_int_equal(lines, 3 + 1); /* 275 bytes of words, and the last one */
    assert_memory_equal(out, text, before + LAST);
    free(out);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(scalars_are_those_of_the_view),
        cmocka_unit_test(few_cases_have_a_table_each),
        cmocka_unit_test(statistical_errors_are_shown_as_sizes),
        cmocka_unit_test(many_cases_have_a_row_each),
        cmocka_unit_test(a_report_tells_errors_by_source),
        cmocka_unit_test(a_target_names_its_sources_by_size),
        cmocka_unit_test(failures_are_told),
        cmocka_unit_test(stopped_iterations_are_named),
        cmocka_unit_test(texts_are_folded),
        cmocka_unit_test(numbers_have_the_digits_of_their_error),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
