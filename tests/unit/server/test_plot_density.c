/* Protects: the picture of a density has a colour for each level that occurs, theories as contours
 * where they cross the levels, joined bins that keep their mean, and the case's name. */
#include "server/show/plot/plot_density.h"
#include "server/show/plot/plot_heat.h"
#include "tests/support/check.h"
#include "tests/support/count_of.h"
#include "tests/support/result_builder.h"
#include <cjson/cJSON.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { ROWS = 8, COLUMNS = 6, CELLS = ROWS * COLUMNS };

static char *draw_wide(const struct study_result *study, double millimetres, int expected,
                       struct error *err) {
    char *text = NULL;
    size_t size = 0;
    FILE *file = open_memstream(&text, &size);
    assert_non_null(file);
    const struct curve *curve = NULL;
    assert_int_equal(density_curve(&study->cases[0], "joint", NULL, &curve, err), 0);
    assert_non_null(curve);
    assert_int_equal(plot_density(study, &study->cases[0], curve, millimetres, file, err),
                     expected);
    assert_int_equal(fclose(file), 0);
    return text;
}

static char *draw(const struct study_result *study, int expected, struct error *err) {
    return draw_wide(study, 0, expected, err);
}

/* A matrix over centres 0.5, 1.5, ... of the values given, and a theory that is `hill` in the
 * middle and 0 at the border. */
static struct study_result study_of(size_t rows, size_t columns, const double *values,
                                    double hill) {
    struct study_result study = built_study("statistics", "a & b", 2);
    study.swept = cJSON_Parse("[\"/surface/hurst\"]");
    assert_non_null(study.swept);
    struct case_result *one = &study.cases[0];
    size_t all = rows * columns, count = 0;
    double *axis = result_numbers(one, rows + columns), *y = result_numbers(one, 2 * all),
           *theory = result_numbers(one, all);
    uint32_t *cells = result_room(one, all, sizeof *cells);
    assert_true(axis != NULL && y != NULL && theory != NULL && cells != NULL);
    for (size_t n = 0; n < rows; n++)
        axis[n] = (double)n + 0.5;
    for (size_t n = 0; n < columns; n++)
        axis[rows + n] = -(double)(columns - n) + 0.5;
    for (size_t cell = 0; cell < all; cell++) {
        size_t row = cell / columns, column = cell % columns;
        bool inside = row > 1 && row + 2 < rows && column > 1 && column + 2 < columns;
        theory[cell] = inside ? hill : 0;
        if (values[cell] > 0) {
            cells[count] = (uint32_t)cell;
            y[count++] = values[cell];
        }
    }
    struct curve curve = curve_named("joint", "height <z>", "density");
    curve_set_points(&curve, rows, axis, y, y + all);
    curve.columns = columns;
    curve.x2 = axis + rows;
    curve.x2_label = "curvature";
    curve.cells = cells;
    curve.cell_count = count;
    if (hill > 0) {
        curve.theory_count = 2;
        curve.theories[0] = (struct theory){.name = "nayak", .y = theory};
        curve.theories[1] = (struct theory){.name = "grid", .y = NULL}; /* not made */
    }
    built_curve(one, &curve);
    built_parameter(one, "/surface/hurst", NULL, 0.25);
    built_parameter(&study.cases[1], "/surface/hurst", NULL, 0.75);
    return study;
}

static void levels_have_colours_and_theories_contours(void **state) {
    (void)state;
    struct error err = {0};
    double values[CELLS] = {0};
    values[0] = values[CELLS - 1] = 0.03; /* the lowest level, in two corners */
    values[COLUMNS + 1] = 0.35;
    values[COLUMNS + 2] = 0.35;
    struct study_result study = study_of(ROWS, COLUMNS, values, 0.55);
    char *text = draw(&study, 0, &err);
    assert_int_equal(count_of(text, "class=\"heat\""), 2);
    assert_int_equal(count_of(text, "class=\"theory\""), 2); /* and its legend */
    assert_int_equal(count_of(text, ">theory: Nayak<"), 1);
    assert_int_equal(count_of(text, "theory: grid"), 0);
    assert_int_equal(count_of(text, ">0.1 to 0.2<"), 1);
    assert_int_equal(count_of(text, ">0.02 to 0.05<"), 1);
    assert_int_equal(count_of(text, ">H = 0.25<"), 1);
    assert_int_equal(count_of(text, "a &amp; b: joint, case 0<"), 2);
    assert_int_equal(count_of(text, "height &lt;z&gt;"), 1);
    assert_int_equal(count_of(text, ">curvature<"), 1);
    assert_null(strstr(text, "nan"));
    /* two cells of one level beside each other along x are in different rows of the matrix; those
     * beside each other along y are a rectangle each: two corners, two cells */
    const char *heat = strstr(text, "class=\"heat\"");
    assert_int_equal(count_of(heat, "Z"), count_of(text, "Z"));
    assert_int_equal(count_of(text, "Z\"/>") + count_of(text, "ZM"), 4);
    free(text);
    study_result_clear(&study);
}

/* Where more was counted than any theory has, the levels reach there. */
static void levels_hold_all_values(void **state) {
    (void)state;
    struct error err = {0};
    double values[CELLS] = {0};
    values[COLUMNS + 1] = 0.95;
    struct study_result study = study_of(ROWS, COLUMNS, values, 0.15);
    char *text = draw(&study, 0, &err);
    assert_int_equal(count_of(text, ">0.5 to 1<"), 1);
    assert_int_equal(count_of(text, "class=\"heat\""), 1);
    free(text);
    study_result_clear(&study);
}

/* What lies far from all that has a colour does not make the picture larger. */
static void the_frame_holds_what_is_seen(void **state) {
    (void)state;
    enum { SIDE = 40 };
    struct error err = {0};
    double values[SIDE * SIDE] = {0};
    for (size_t cell = 0; cell < 6 * SIDE; cell++)
        values[cell] = cell % SIDE < 6 ? 1 : 0;
    values[SIDE * SIDE - 1] = 0.015; /* seen alone; below the lowest level, which has a fiftieth */
    struct study_result study = study_of(SIDE, SIDE, values, 0);
    char *text = draw(&study, 0, &err);
    assert_int_equal(count_of(text, ">6</text>"), 1); /* the frame ends at 7 in place of 40 */
    assert_int_equal(count_of(text, ">10</text>"), 0);
    free(text);
    study_result_clear(&study);
}

/* A theory that is singular leaves the matrix its colours. */
static void high_theories_keep_the_matrix(void **state) {
    (void)state;
    struct error err = {0};
    double values[CELLS] = {0};
    values[COLUMNS + 1] = values[COLUMNS + 2] = 0.35;
    struct study_result study = study_of(ROWS, COLUMNS, values, 500);
    char *text = draw(&study, 0, &err);
    assert_int_equal(count_of(text, "class=\"heat\""), 1);
    assert_int_equal(count_of(text, ">0.2 to 0.5<"), 1);
    free(text);
    study_result_clear(&study);
}

/* On paper it has the width that was asked for, and no title, which is the caption's matter. */
static void densities_have_sizes_on_paper(void **state) {
    (void)state;
    struct error err = {0};
    double values[CELLS] = {0};
    values[COLUMNS + 1] = 0.35;
    struct study_result study = study_of(ROWS, COLUMNS, values, 0.5);
    char *text = draw_wide(&study, 85, 0, &err);
    assert_int_equal(count_of(text, "width=\"85mm\""), 1);
    assert_int_equal(count_of(text, "a &amp; b: joint, case 0<"), 1); /* for readers of the file */
    free(text);
    study_result_clear(&study);
}

/* Contours are where the theory has the value: a plane's are straight lines. */
static void contours_lie_between_cells(void **state) {
    (void)state;
    char *text = NULL;
    size_t size = 0;
    const double values[] = {0, 1, 2, 0, 1, 2};
    const struct heat_scale scale = {.count = 1, .bounds = {0.5, 3}};
    const struct heat_cells cells = {.nx = 3, .ny = 2, .x = {0, 3}, .y = {0, 2}, .values = values};
    struct plot_pen pen = {.file = open_memstream(&text, &size)};
    assert_non_null(pen.file);
    frame_set(&pen.frame, (const double[]){0, 3}, (const double[]){0, 2}, false);
    heat_contours(&pen, &cells, &scale, "");
    assert_int_equal(fclose(pen.file), 0);
    double x[2], y[2];
    assert_int_equal(sscanf(text, "<path  d=\"M%lf %lfL%lf %lf\"", &x[0], &y[0], &x[1], &y[1]), 4);
    for (int end = 0; end < 2; end++) /* 0.5 is at x = 1; y reaches from centre to centre */
        assert_true(fabs(x[end] - frame_x(&pen.frame, 1)) < 0.06);
    assert_true(fabs(fabs(y[1] - y[0]) - (FRAME_BOTTOM - FRAME_TOP) / 2.0) < 0.11);
    free(text);
}

static void many_bins_are_joined(void **state) {
    (void)state;
    enum { MANY = 120 };
    struct error err = {0};
    double *values = array_create(MANY * MANY, sizeof *values);
    assert_non_null(values);
    for (size_t cell = 0; cell < MANY * MANY; cell++)
        values[cell] = cell % 2 == 0 ? 0.6 : 0; /* at most 0.4 as a mean of three */
    values[MANY * MANY - 1] = 0.1;
    struct study_result study = study_of(MANY, MANY, values, 0);
    char *text = draw(&study, 0, &err);
    size_t rectangles = count_of(text, "ZM") + count_of(text, "Z\"/>");
    assert_true(rectangles > 0 && rectangles < 60 * 60);
    assert_int_equal(count_of(text, "0.5 to"), 0); /* no level as high as a single bin */
    free(text);
    study_result_clear(&study);
    free(values);
}

static void nothing_is_told(void **state) {
    (void)state;
    struct error err = {0};
    const double values[CELLS] = {0};
    struct study_result study = study_of(ROWS, COLUMNS, values, 0);
    free(draw(&study, ERROR_ABSENT, &err));
    assert_non_null(strstr(err.text, "\"joint\" has no values yet"));
    const struct curve *curve = &study.cases[0].curves[0];
    assert_int_equal(density_curve(&study.cases[1], "joint", NULL, &curve, &err), 0);
    assert_null(curve);
    study_result_clear(&study);
}

static void series_are_told_apart(void **state) {
    (void)state;
    const double values[CELLS] = {[20] = 1};
    struct error err = {0};
    const struct curve *curve = NULL;
    struct study_result study = study_of(ROWS, COLUMNS, values, 0);
    struct case_result *one = &study.cases[0];
    struct curve pits = one->curves[0];
    pits.series = "pits";
    one->curves[0].series = "summits";
    assert_int_equal(result_add_curve(one, &pits, NULL), 0);
    assert_int_equal(density_curve(one, "joint", "pits", &curve, NULL), 0);
    assert_ptr_equal(curve, &one->curves[1]);
    assert_int_equal(density_curve(one, "joint", NULL, &curve, NULL), 0);
    assert_ptr_equal(curve, &one->curves[0]);
    assert_int_equal(density_curve(one, "joint", "peaks", &curve, &err), ERROR_INPUT);
    assert_non_null(strstr(err.text, "no series \"peaks\"; allowed: \"summits\", \"pits\""));
    study_result_clear(&study);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(levels_have_colours_and_theories_contours),
        cmocka_unit_test(levels_hold_all_values),
        cmocka_unit_test(the_frame_holds_what_is_seen),
        cmocka_unit_test(high_theories_keep_the_matrix),
        cmocka_unit_test(densities_have_sizes_on_paper),
        cmocka_unit_test(contours_lie_between_cells),
        cmocka_unit_test(many_bins_are_joined),
        cmocka_unit_test(nothing_is_told),
        cmocka_unit_test(series_are_told_apart),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
