/* A result with one of everything: plain points with a gap, a matrix, a curve with attributes,
 * errors by source and missing realisations, a scalar, a note. */
#ifndef RUGO_TESTS_SUPPORT_SAMPLE_RESULT_H
#define RUGO_TESTS_SUPPORT_SAMPLE_RESULT_H

#include "schema/result/result.h"
#include "tests/support/check.h"
#include <math.h>
#include <string.h>

static inline void sample_result(struct case_result *out) {
    static const double x[] = {0.1, 2}, y[] = {3, NAN}, error[] = {0.1, NAN}, nayak[] = {1.5, 2.5};
    static const double x2[] = {7, 8, 9}, cell_y[] = {2, 6}, cell_error[] = {0.25, 1};
    static const uint32_t cells[] = {1, 5};
    static const double cell_mesh[] = {-0.5, 1}, cell_bound[] = {0.75, 0};
    static const double area[] = {1e-300, 0.5}, zero[] = {0, 0}, persson[] = {3, 4};
    static const double mesh[] = {0.25, 0.5}, mesh_error[] = {0.01, 0.02}, bound[] = {0.125, 0};
    static const double model[] = {NAN, -2}, model_error[] = {0.03, 0.04}, valueless[] = {0, 3};
    static const double effective[] = {6.5, 4};
    static const double law[] = {0.5, -1}, law_error[] = {0.25, 0.5};
    static struct result_note notes[] = {{7, "why"}};
    struct curve plain = curve_named("q", "z/\302\265m", "density");
    struct curve matrix = curve_named("joint", "z", "density");
    struct curve full = curve_named("area", "load", "A/A0");
    struct scalar m0 = scalar_named("m0", 1, 0.5, NAN), alpha = scalar_named("alpha", 5, NAN, 6);
    m0.errors[ERROR_CELL].applies = true;
    m0.errors[ERROR_MODEL] = (struct scalar_error){true, true, -0.5, 0.25, 0.125};
    m0.effective = 5.25;
    alpha.grid = 5.5;
    alpha.law_difference = -0.5;
    alpha.law_standard_error = 0.125;
    *out = (struct case_result){.case_number = 3, .realisations = 24, .notes = notes};
    out->note_count = 1;
    out->notes_all = 2;
    curve_set_points(&plain, 2, x, y, error);
    plain.series = "x, \"y\"";
    plain.theories[plain.theory_count++] = (struct theory){"nayak", nayak};
    plain.counted = true;
    plain.underflow = 4;
    curve_set_points(&matrix, 2, x, cell_y, cell_error);
    matrix.columns = 3;
    matrix.x2 = x2;
    matrix.x2_label = "t";
    matrix.cells = cells;
    matrix.cell_count = 2;
    matrix.errors[ERROR_DISCRETISATION] =
        (struct curve_error){true, cell_mesh, cell_bound, cell_error, NAN, false};
    matrix.theories[matrix.theory_count++] = (struct theory){"nayak", NULL};
    curve_set_points(&full, 2, x, area, zero);
    full.series = "edges";
    full.model = "full";
    full.kinematics = "hencky";
    full.level = 8;
    full.points = 64;
    full.pressure = 0.5;
    full.errors[ERROR_DISCRETISATION] =
        (struct curve_error){true, mesh, bound, mesh_error, 1.5, true};
    full.errors[ERROR_MODEL] = (struct curve_error){true, model, NULL, model_error, NAN, false};
    full.errors[ERROR_BLOCK].applies = true;
    plain.errors[ERROR_DISCRETISATION].applies = true;
    full.law_difference = law;
    full.law_standard_error = law_error;
    full.valueless = valueless;
    full.effective = effective;
    full.theories[full.theory_count++] = (struct theory){"persson", persson};
    assert_int_equal(result_add_curve(out, &plain, NULL), 0);
    assert_int_equal(result_add_curve(out, &matrix, NULL), 0);
    assert_int_equal(result_add_curve(out, &full, NULL), 0);
    assert_int_equal(result_add_scalar(out, &m0, NULL), 0);
    assert_int_equal(result_add_scalar(out, &alpha, NULL), 0);
    result_sampled(out, out->realisations);
}

#endif
