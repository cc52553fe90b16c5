/* Studies with results made by hand, for tests of what shows them. Each function fails the test
 * when out of memory; study_result_clear frees what they made. */
#ifndef RUGO_TESTS_SUPPORT_RESULT_BUILDER_H
#define RUGO_TESTS_SUPPORT_RESULT_BUILDER_H

#include "schema/result/result.h"
#include "tests/support/check.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Of cases without results, as of 4 realisations. */
static inline struct study_result built_study(const char *kind, const char *name, size_t cases) {
    struct study_result study = {.id = strdup("0123456789abcdef"),
                                 .name = strdup(name),
                                 .kind = strdup(kind),
                                 .state = strdup("done"),
                                 .case_count = cases,
                                 .cases = calloc(cases, sizeof *study.cases)};
    assert_true(study.id != NULL && study.name != NULL && study.kind != NULL &&
                study.state != NULL && study.cases != NULL);
    for (size_t c = 0; c < cases && study.cases != NULL; c++) {
        study.cases[c].case_number = c;
        study.cases[c].realisations = 4;
    }
    return study;
}

/* text: NULL for a number. Both are copied. */
static inline void built_parameter(struct case_result *one, const char *pointer, const char *text,
                                   double number) {
    size_t n = one->parameter_count;
    struct result_parameter *list = result_room(one, n + 1, sizeof *list);
    assert_non_null(list);
    for (size_t p = 0; p < n; p++)
        list[p] = one->parameters[p];
    list[n] = (struct result_parameter){
        .pointer = result_text(one, pointer), .text = result_text(one, text), .number = number};
    one->parameters = list;
    one->parameter_count = n + 1;
}

static inline const double *built_numbers(struct case_result *one, size_t n,
                                          const double *numbers) {
    double *copy = result_numbers(one, n);
    assert_non_null(copy);
    memcpy(copy, numbers, n * sizeof *copy);
    return copy;
}

/* A curve without attributes, errors and theories, to be completed and added. Copies the numbers;
 * borrows the text. */
static inline struct curve built_points(struct case_result *one, const char *quantity, size_t n,
                                        const double *x, const double *y,
                                        const double *standard_error) {
    return (struct curve){.quantity = quantity,
                          .x_label = "x",
                          .y_label = "y",
                          .series = "",
                          .level = NAN,
                          .points = NAN,
                          .pressure = NAN,
                          .n = n,
                          .x = built_numbers(one, n, x),
                          .y = built_numbers(one, n, y),
                          .standard_error = built_numbers(one, n, standard_error)};
}

static inline void built_theory(struct case_result *one, struct curve *curve, const char *name,
                                const double *y) {
    assert_true(curve->theory_count < THEORIES_MOST);
    curve->theories[curve->theory_count++] =
        (struct theory){.name = name, .y = built_numbers(one, curve->n, y)};
}

static inline void built_curve(struct case_result *one, const struct curve *curve) {
    struct error err = {0};
    assert_int_equal(result_add_curve(one, curve, &err), 0);
}

/* theory: NaN for none. Borrows the name. */
static inline void built_scalar(struct case_result *one, const char *name, double value,
                                double standard_error, double theory) {
    struct error err = {0};
    const struct scalar scalar = scalar_named(name, value, standard_error, theory);
    assert_int_equal(result_add_scalar(one, &scalar, &err), 0);
}

#endif
