/* Errors by source, from tallies filled by hand: limits of meshes and of models come out where they
 * were put in, a finite block and missing realisations have errors, and what is not known has
 * none. */
#include "core/statistics/uncertainty/richardson.h"
#include "jobs/contact/case/contact_case_read.h"
#include "jobs/contact/contact_errors.h"
#include "jobs/contact/target/contact_sum.h"
#include "tests/support/check.h"

#define STUDY(contact)                                                                             \
    "{\"surface\": {\"dimension\": 1, \"hurst\": 0.8, \"wavelength_ratio\": 2,"                    \
    " \"length_ratio\": 1, \"rms_slope\": 0.1, \"points_per_wavelength\": 16}, \"contact\": {"     \
    "\"pressures\": {\"values\": [0.1, 0.2, 0.3]}, " contact "}}"
enum { LOADS = 3 };

struct errors_fixture {
    struct contact_case one_case;
    struct contact_tally tally;
};

static void fixture_open(struct errors_fixture *f, const char *text) {
    struct error err = {0};
    cJSON *parameters = cJSON_Parse(text);
    assert_non_null(parameters);
    if (contact_case_read(&f->one_case, parameters, 0, NULL, &err) != 0 ||
        contact_tally_create(&f->tally, &f->one_case, &err) != 0)
        fail_msg("%s", err.text);
    cJSON_Delete(parameters);
}

static void add_realisation(struct contact_tally *tally) {
    struct error err = {0};
    assert_int_equal(contact_tally_add(tally, &err), 0);
}

static void fixture_close(struct errors_fixture *f) {
    contact_tally_clear(&f->tally);
    contact_case_clear(&f->one_case);
}

/* limit + slope (points)^-order on each level, with the slope of the load. */
static void fill_levels(struct errors_fixture *f, size_t model, double limit, double order,
                        const double slope[LOADS]) {
    double *values = contact_tally_values(&f->tally, MEASURE_EDGES);
    for (size_t l = 0; l < f->one_case.level_count; l++)
        for (size_t k = 0; k < LOADS; k++)
            values[contact_case_cell(&f->one_case, model, l, k)] =
                limit + slope[k] * pow((double)f->one_case.levels[l].grid.nx, -order);
}

static void limits_of_meshes_come_out(void **state) {
    (void)state;
    static const double SLOPE[LOADS] = {0.5, -0.5, 1};
    struct errors_fixture f;
    struct contact_error errors[LOADS];
    fixture_open(&f, STUDY("\"levels\": [4, 8, 16]"));
    fill_levels(&f, 0, 0.3, 2, SLOPE); /* the known order of edges of profiles */
    add_realisation(&f.tally);
    assert_true(contact_errors(&f.tally, MEASURE_EDGES, 0, ERROR_DISCRETISATION, errors));
    for (size_t k = 0; k < LOADS; k++) {
        check_relative(errors[k].value, SLOPE[k] / (32.0 * 32.0), 1e-9);
        check_close(errors[k].order, 2, 1e-6);
    }
    fixture_close(&f);
}

/* At the load in the middle nothing changes from level to level, which is random: its bound is that
 * of its neighbours, relative to the values. */
static void a_change_that_vanishes_is_no_proof(void **state) {
    (void)state;
    static const double SLOPE[LOADS] = {0.5, 0, 1};
    struct errors_fixture f;
    struct contact_error errors[LOADS];
    fixture_open(&f, STUDY("\"levels\": [8, 16]"));
    fill_levels(&f, 0, 0.3, 1, SLOPE);
    add_realisation(&f.tally);
    assert_true(contact_errors(&f.tally, MEASURE_EDGES, 0, ERROR_DISCRETISATION, errors));
    for (size_t k = 0; k < LOADS; k++)
        assert_true(errors[k].value == 0 && isnan(errors[k].order));
    double change = 1.0 / 16 - 1.0 / 32, y = 0.3 + 1.0 / 32;
    check_relative(errors[2].bound, 1.25 * change, 1e-9);
    check_relative(errors[1].bound, 1.25 * change / y * 0.3, 1e-9);
    fixture_close(&f);
}

/* Each model has an error of its own mesh, which the difference of the limits is free of. */
static void models_are_compared_in_their_limits(void **state) {
    (void)state;
    static const double SLOPE[LOADS] = {0.5, 0.5, 0.5}, OTHER[LOADS] = {-0.25, -0.25, -0.25};
    struct errors_fixture f;
    struct contact_error errors[LOADS];
    fixture_open(&f, STUDY("\"model\": [\"halfspace\", \"full\"], \"levels\": [4, 8, 16]"));
    const double order = 2;
    fill_levels(&f, 0, 0.32, order, SLOPE);
    fill_levels(&f, 1, 0.3, order, OTHER);
    add_realisation(&f.tally);
    assert_true(contact_errors(&f.tally, MEASURE_EDGES, 0, ERROR_MODEL, errors));
    for (size_t k = 0; k < LOADS; k++)
        check_relative(errors[k].value, 0.02, 1e-9);
    assert_false(contact_errors(&f.tally, MEASURE_EDGES, 1, ERROR_MODEL, errors));
    assert_false(contact_error_applies(&f.tally, MEASURE_EDGES, 1, 2, ERROR_MODEL));
    fixture_close(&f);
    /* with one level the meshes' errors are not known, and so the models' is not */
    fixture_open(&f, STUDY("\"model\": [\"halfspace\", \"full\"]"));
    fill_levels(&f, 0, 0.32, order, SLOPE);
    fill_levels(&f, 1, 0.3, order, OTHER);
    add_realisation(&f.tally);
    assert_false(contact_errors(&f.tally, MEASURE_EDGES, 0, ERROR_MODEL, errors));
    assert_true(contact_error_applies(&f.tally, MEASURE_EDGES, 0, 0, ERROR_MODEL));
    fixture_close(&f);
}

static void a_low_block_is_told(void **state) {
    (void)state;
    struct errors_fixture f;
    struct contact_error errors[LOADS];
    fixture_open(&f, STUDY("\"model\": [\"halfspace\", \"layered\"], \"cell_error\": \"none\""));
    /* 1.5 sides of the cell are as good as infinite */
    assert_false(contact_case_has(&f.one_case, COMPANION_PROBE));
    assert_true(contact_errors(&f.tally, MEASURE_EDGES, 1, ERROR_BLOCK, errors));
    fixture_close(&f);
    fixture_open(&f, STUDY("\"model\": \"layered\", \"block_height\": {\"lengths\": 0.25}"));
    /* each realisation counts, as rare ones may make most of the error */
    const struct subset *due = &f.one_case.companions[COMPANION_PROBE].due;
    assert_true(subset_has(due, 3) && subset_has(due, 17) && subset_has(due, 1001));
    for (int r = 0; r < 3; r++) { /* of which one has no solution on the coarse mesh */
        double *values = contact_tally_values(&f.tally, MEASURE_EDGES);
        double *half = contact_tally_series(&f.tally, COMPANION_PROBE, 0, MEASURE_EDGES);
        double *layer = contact_tally_series(&f.tally, COMPANION_PROBE, 1, MEASURE_EDGES);
        for (size_t k = 0; k < LOADS; k++) {
            values[contact_case_cell(&f.one_case, 0, 0, k)] = 0.4;
            if (r == 2)
                continue;
            half[k] = 0.5;
            layer[k] = r == 0 ? 0.45 : 0.43;
        }
        add_realisation(&f.tally);
    }
    assert_true(contact_errors(&f.tally, MEASURE_EDGES, 0, ERROR_BLOCK, errors));
    check_relative(errors[1].value, 0.4 / 0.44 * -0.06, 1e-9);
    check_relative(errors[1].bound, fabs(errors[1].value) / 4, 1e-9);
    /* a mean over the two realisations that have it */
    check_relative(errors[1].standard_error, 0.4 / 0.44 * sqrt(2 * 2e-4) / 2, 1e-6);
    fixture_close(&f);
    fixture_open(&f, STUDY("\"model\": \"halfspace\""));
    assert_false(contact_error_applies(&f.tally, MEASURE_EDGES, 0, 0, ERROR_BLOCK));
    fixture_close(&f);
}

enum { DRAWS = 4 };

/* Adds a realisation for each draw of the own length and of another one; NaN: none. */
static void add_draws(struct errors_fixture *f, enum companion_name length, double y,
                      const double own[DRAWS], const double other[LOADS][DRAWS]) {
    for (size_t r = 0; r < DRAWS; r++) {
        double *values = contact_tally_values(&f->tally, MEASURE_EDGES);
        double *equal = contact_tally_series(&f->tally, COMPANION_EQUAL, 0, MEASURE_EDGES);
        double *series = contact_tally_series(&f->tally, length, 0, MEASURE_EDGES);
        for (size_t k = 0; k < LOADS; k++) {
            values[contact_case_cell(&f->one_case, 0, 0, k)] = y;
            equal[k] = own[r];
            series[k] = other[k][r];
        }
        add_realisation(&f->tally);
    }
}

/* Own cells of mean 0.4 and longer ones, of 64 longest waves: the error is the relative difference
 * with its sign. Its bound has the interval of 95 % by Welch, and what doubling the length six
 * times leaves if it leaves 7/10 each time, 0.133 of the largest change around, but a fifth at
 * least for other models. At the second load the change vanishes: there that of the load
 * behind it counts, as far as it exceeds its interval, by its distance of log2(3/2). */
static void a_short_cell_is_told(void **state) {
    (void)state;
    static const double OWN[DRAWS] = {0.399, 0.401, 0.398, 0.402},
                        LONGER[LOADS][DRAWS] = {{0.38, 0.381, 0.379, 0.38},
                                                {0.4, 0.401, 0.399, 0.4},
                                                {0.41, 0.411, 0.409, NAN}};
    const double y = 0.5;
    struct errors_fixture f;
    struct contact_error errors[LOADS];
    fixture_open(&f, STUDY("\"model\": \"halfspace\""));
    check_relative(f.one_case.companions[COMPANION_LONGER].length, 64, 0);
    assert_false(contact_case_has(&f.one_case, COMPANION_SHORTER));
    add_draws(&f, COMPANION_LONGER, y, OWN, LONGER);
    assert_true(contact_errors(&f.tally, MEASURE_EDGES, 0, ERROR_CELL, errors));
    const double own = sqrt(1e-5 / 3 / 4), other = sqrt(2e-6 / 3 / 4);
    const double freedom = pow(own * own + other * other, 2) / (pow(own, 4) + pow(other, 4)) * 3;
    const double standard_error = hypot(own, other) / 0.4;
    assert_true(freedom > 4 && freedom < 5); /* quantiles of 2.776 and 2.571 */
    check_relative(errors[0].value, 0.05 * y, 1e-9);
    check_relative(errors[0].standard_error, standard_error * y, 1e-6);
    assert_true(errors[0].bound > hypot(2.571 * standard_error, 0.2 * 0.05) * y &&
                errors[0].bound < hypot(2.776 * standard_error, 0.2 * 0.05) * y);
    const double chance = sqrt(errors[0].bound * errors[0].bound / (y * y) - 0.01 * 0.01);
    assert_true(fabs(errors[1].value) < 1e-12 && isnan(errors[1].order));
    assert_true(errors[1].bound > 1.01 * chance * y && errors[1].bound < 1.06 * chance * y);
    check_relative(errors[2].value, -0.025 * y, 1e-9);
    fixture_close(&f);
    fixture_open(&f, STUDY("\"model\": \"halfspace\", \"cell_error\": \"none\""));
    assert_true(contact_error_applies(&f.tally, MEASURE_EDGES, 0, 0, ERROR_CELL));
    assert_false(contact_errors(&f.tally, MEASURE_EDGES, 0, ERROR_CELL, errors));
    fixture_close(&f);
}

/* Where longer cells are too large, cells a quarter as long bound the error on both sides: if
 * doubling the length leaves 7/10 of an error each time, doubling it twice leaves 0.49/0.51 of the
 * change. One draw shows no scatter, and nothing. */
static void a_shorter_cell_bounds(void **state) {
    (void)state;
    static const char study[] =
        "{\"surface\": {\"hurst\": 0.8, \"dimension\": 1, \"wavelength_ratio\": 2000, "
        "\"length_ratio\": 100000,"
        " \"heights\": {\"distribution\": \"weibull_min\", \"shape\": 1}}, \"contact\":"
        " {\"pressures\": {\"values\": [0.01, 0.1, 1]}}}"; /* loads apart */
    static const double OWN[DRAWS] = {0.4, 0.4, 0.4, 0.4},
                        SHORTER[LOADS][DRAWS] = {{0.41, 0.41, 0.41, 0.41},
                                                 {0.38, 0.38, 0.38, 0.38},
                                                 {0.4, NAN, NAN, NAN}};
    const double few = 0.49 / 0.51;
    struct errors_fixture f;
    struct contact_error errors[LOADS];
    fixture_open(&f, study);
    assert_false(contact_case_has(&f.one_case, COMPANION_LONGER));
    add_draws(&f, COMPANION_SHORTER, 0.4, OWN, SHORTER);
    assert_true(contact_errors(&f.tally, MEASURE_EDGES, 0, ERROR_CELL, errors));
    check_relative(errors[0].bound, few * 0.01, 1e-6);
    check_relative(errors[1].bound, few * 0.02, 1e-6);
    assert_true(errors[0].value == 0 && errors[1].value == 0 && isnan(errors[2].value));
    fixture_close(&f);
}

/* Of four realisations the model full lacks one: its mean is that of layered over all, and of the
 * difference over three. */
static void missing_realisations_bias_no_mean(void **state) {
    (void)state;
    static const double FULL[] = {0.2, 0.21, 0.22, NAN}, LAYERED[] = {0.22, 0.23, 0.25, 0.5};
    struct errors_fixture f;
    struct contact_error errors[LOADS];
    fixture_open(&f, STUDY("\"model\": [\"full\", \"layered\"]"));
    for (int r = 0; r < 4; r++) {
        double *values = contact_tally_values(&f.tally, MEASURE_EDGES);
        for (size_t k = 0; k < LOADS; k++) {
            values[contact_case_cell(&f.one_case, 0, 0, k)] = k == 0 ? 0.1 : FULL[r];
            values[contact_case_cell(&f.one_case, 1, 0, k)] = LAYERED[r];
        }
        add_realisation(&f.tally);
    }
    check_relative(contact_mean(&f.tally, MEASURE_EDGES, 0, 0, 0).value, 0.1, 1e-12);
    check_relative(contact_mean(&f.tally, MEASURE_EDGES, 0, 0, 1).value,
                   0.3 - (0.02 + 0.02 + 0.03) / 3, 1e-12);
    assert_true(contact_mean(&f.tally, MEASURE_EDGES, 0, 0, 1).standard_error >
                contact_tally_mean(&f.tally, MEASURE_EDGES, contact_case_cell(&f.one_case, 1, 0, 1))
                    .standard_error);
    assert_true(contact_errors(&f.tally, MEASURE_EDGES, 0, ERROR_MISSING, errors));
    assert_true(errors[0].bound == 0 && errors[1].value == 0 && errors[1].bound > 0);
    fixture_close(&f);
    /* nothing to go by: said as such */
    fixture_open(&f, STUDY("\"model\": \"full\""));
    for (int r = 0; r < 4; r++) {
        for (size_t k = 0; k < LOADS; k++)
            contact_tally_values(&f.tally, MEASURE_EDGES)[k] = FULL[r];
        add_realisation(&f.tally);
    }
    assert_true(contact_error_applies(&f.tally, MEASURE_EDGES, 0, 0, ERROR_MISSING));
    assert_false(contact_errors(&f.tally, MEASURE_EDGES, 0, ERROR_MISSING, errors));
    fixture_close(&f);
}

/* Up to the kurtosis that the bound was measured at it is the same for all; of longer tails more.
 */
static void long_tails_need_longer_cells(void **state) {
    (void)state;
    static const double P[] = {0, 0.02, 0.1, 0.4, 0.7, 1}, PLATEAU[] = {-8, -5, -2, -0.2, 0, 0};
    const struct heights skewed = {.type = HEIGHTS_WEIBULL_MIN, .shape = 1};
    const struct heights less = {.type = HEIGHTS_WEIBULL_MAX, .shape = 2};
    const struct heights more = {.type = HEIGHTS_WEIBULL_MIN, .shape = 0.5}; /* kurtosis 87.72 */
    struct heights own = {.type = HEIGHTS_TABLE};
    struct height_table *table = NULL;
    assert_int_equal(height_table_of_quantiles(&table, 6, P, PLATEAU, NULL), 0);
    own.table = table;
    assert_true(contact_heights_cell(&skewed) == HEIGHTS_CELL);
    assert_true(contact_heights_cell(&less) == HEIGHTS_CELL);
    check_close(contact_heights_cell(&more), 1.4 * 86.72 / 8, 1e-3);
    check_close(contact_heights_cell(&own), 1.4 * 12.514 / 8, 1e-3);
    height_table_destroy(&table);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(limits_of_meshes_come_out),
        cmocka_unit_test(a_change_that_vanishes_is_no_proof),
        cmocka_unit_test(models_are_compared_in_their_limits),
        cmocka_unit_test(a_low_block_is_told),
        cmocka_unit_test(a_short_cell_is_told),
        cmocka_unit_test(a_shorter_cell_bounds),
        cmocka_unit_test(missing_realisations_bias_no_mean),
        cmocka_unit_test(long_tails_need_longer_cells),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
