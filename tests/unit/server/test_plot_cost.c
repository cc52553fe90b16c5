/* Protects: the picture of speed against error has a line, a circle and a label a series, its front
 * is the least of the lines, and it says which sources of error it does not know. */
#include "server/show/plot/plot_cost.h"
#include "server/show/plot/plot_frame.h"
#include "tests/support/check.h"
#include "tests/support/count_of.h"
#include <stdlib.h>
#include <string.h>

/* A report of one case of 4 realisations: a cheap series, a dear one, and a second estimator. */
struct cost_fixture {
    struct curve_report curves[3];
    struct case_report one;
    struct study_report study;
};

static struct curve_report series(const char *model, const char *estimator, double cpu_seconds,
                                  double mesh) {
    struct curve_report curve = {
        .place = {.quantity = "contact_area", .series = estimator, .model = model, .level = 8},
        .cpu_seconds = cpu_seconds,
        .statistical = 0.1,
        .total = NAN,
        .valueless = NAN};
    for (size_t s = 0; s < ERROR_SOURCES; s++)
        curve.errors[s] = NAN;
    curve.errors[ERROR_DISCRETISATION] = mesh;
    curve.applies[ERROR_DISCRETISATION] = curve.applies[ERROR_CELL] = true;
    return curve;
}

static void fixture_make(struct cost_fixture *f) {
    static char id[] = "12", name[] = "a & b", kind[] = "contact", done[] = "done";
    f->curves[0] = series("halfspace", "edges", 4, 0.05);
    f->curves[1] = series("full", "edges", 400, 0.001);
    f->curves[2] = series("full", "nodes", 400, 0.02);
    f->one = (struct case_report){
        .about = {.realisations = 4}, .curve_count = 3, .curves = f->curves, .main = &f->curves[0]};
    f->study = (struct study_report){
        .id = id, .name = name, .kind = kind, .state = done, .case_count = 1, .cases = &f->one};
}

static char *draw(const struct study_report *study, int expected) {
    char *text = NULL;
    size_t size = 0;
    struct error err = {0};
    FILE *file = open_memstream(&text, &size);
    assert_non_null(file);
    assert_int_equal(plot_cost(study, file, &err), expected);
    assert_int_equal(fclose(file), 0);
    return text;
}

static void each_series_is_drawn(void **state) {
    (void)state;
    struct cost_fixture f;
    fixture_make(&f);
    char *text = draw(&f.study, 0);
    assert_true(strncmp(text, "<svg ", 5) == 0 && strstr(text, "</svg>\n") != NULL);
    assert_non_null(strstr(text, "a &amp; b: error of contact area by cost"));
    assert_non_null(strstr(text, "halfspace, level 8, edges"));
    assert_non_null(strstr(text, "full, level 8, edges"));
    assert_null(strstr(text, "nodes")); /* reads the same solves */
    assert_int_equal(count_of(text, "<circle "), 2);
    assert_non_null(strstr(text, "not known: cell"));
    free(text);
}

/* Points "x y" of the path that begins at the first `class` in the text; how many. */
static size_t read_path(const char *text, const char *class, double x[], double y[]) {
    const char *at = strstr(text, class);
    size_t n = 0;
    assert_non_null(at);
    at = strstr(at, " d=\"") + 4;
    while (n < 80 && sscanf(at, "%*c%lf %lf", &x[n], &y[n]) == 2) {
        n++;
        at += 1 + strcspn(at + 1, "ML\"");
    }
    return n;
}

/* On the picture y falls downwards: at the dear end the front lies at least as low as the line of
 * the dear series, and at the cheap end it is that of the cheap one. */
static void the_front_is_the_least(void **state) {
    (void)state;
    struct cost_fixture f;
    double x[80], y[80], line_x[80], line_y[80];
    fixture_make(&f);
    char *text = draw(&f.study, 0);
    size_t n = read_path(text, "stroke=\"#bbb\"", x, y);
    assert_true(n > 50);
    for (size_t k = 1; k < n; k++)
        assert_true(x[k] > x[k - 1] && y[k] >= y[k - 1] - 0.02); /* rounding of the digits */
    assert_true(read_path(text, "stroke=\"#0072b2\"", line_x, line_y) > 50);
    check_close(line_x[0], x[0], 0.02);
    check_close(line_y[0], y[0], 0.02);
    size_t m = read_path(text, "stroke=\"#d55e00\"", line_x, line_y);
    assert_true(m > 50);
    check_close(line_x[m - 1], x[n - 1], 0.02);
    check_close(line_y[m - 1], y[n - 1], 0.02);
    free(text);
}

static void nothing_to_draw_is_said(void **state) {
    (void)state;
    struct cost_fixture f;
    fixture_make(&f);
    for (size_t a = 0; a < 3; a++)
        f.curves[a].statistical = NAN;
    free(draw(&f.study, ERROR_ABSENT));
    f.one.curve_count = 0;
    f.one.main = NULL;
    free(draw(&f.study, ERROR_ABSENT));
}

/* The circle of a study that asks for an error is at the error reached, which its answer states and
 * all else shows: where a study stands whose own errors are of those sizes. An answer has no level.
 */
static void a_target_stands_at_what_it_reached(void **state) {
    (void)state;
    struct cost_fixture f;
    struct scalar_report scalars[] = {{.name = "error_reached", .value = 0.13},
                                      {.name = "error_chance", .value = 0.05}};
    fixture_make(&f);
    f.one.curve_count = 1;
    f.curves[0].statistical = 0.05;
    f.curves[0].errors[ERROR_DISCRETISATION] = 0.12;
    char *same = draw(&f.study, 0), *circle = strstr(same, "<circle ");
    f.curves[0].statistical = 0.001;
    f.curves[0].errors[ERROR_DISCRETISATION] = 0.002;
    f.curves[0].place.level = NAN;
    f.one.scalars = scalars;
    f.one.scalar_count = 2;
    char *text = draw(&f.study, 0);
    assert_non_null(circle);
    circle[strcspn(circle, "\n")] = '\0';
    assert_non_null(strstr(text, circle));
    assert_non_null(strstr(text, ">halfspace, edges<"));
    assert_null(strstr(text, "nan"));
    free(same);
    free(text);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(each_series_is_drawn),
        cmocka_unit_test(the_front_is_the_least),
        cmocka_unit_test(a_target_stands_at_what_it_reached),
        cmocka_unit_test(nothing_to_draw_is_said),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
