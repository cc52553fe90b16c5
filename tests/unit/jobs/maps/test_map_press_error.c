/* Protects: errors of the contact of one map by source, as a study has them. Each is compared with
 * the change that it is an estimate of: another height, another model, another tolerance. */
#include "jobs/contact/contact_errors.h"
#include "jobs/maps/press/map_press_curves.h"
#include "jobs/maps/press/map_press_error.h"
#include "tests/support/check.h"
#include "tests/support/effort.h"
#include <stdlib.h>

enum { LOADS = 3, SERIES_MOST = 3, WAVES = 8, SEEDS = 2 };
static const double REDUCED[LOADS] = {0.02, 0.1, 0.3};

static const struct contact_model *model_named(const char *name) {
    const struct choice *choice = choice_find(CONTACT_MODEL_CHOICES, name);
    assert_non_null(choice);
    return CONTACT_MODELS[choice->value];
}

/* A map of waves of random phases, which repeats: 16 points a shortest wave of a profile, 8 of a
 * surface. */
static struct height_map rough(int dimension, double slope, uint64_t seed) {
    size_t nx = dimension == 1 ? 16 * WAVES : 8 * WAVES, ny = dimension == 1 ? 1 : nx;
    struct height_map map = {.grid = {nx, ny, 1, 1}};
    double squares = 0;
    map.z = array_create(nx * ny, sizeof *map.z);
    assert_non_null(map.z);
    for (int a = 1; a <= WAVES; a++)
        for (int b = dimension == 1 ? 0 : 1 - a; b < a && a * a + b * b <= WAVES * WAVES; b++) {
            double k = 2 * M_PI * hypot(a, b), high = pow(k, -1.8);
            seed = seed * 6364136223846793005u + 1442695040888963407u;
            double phase = 2 * M_PI * (double)(seed >> 11) / 0x1p53;
            squares += k * k * high * high / 2;
            for (size_t j = 0; j < ny; j++)
                for (size_t i = 0; i < nx; i++)
                    map.z[j * nx + i] +=
                        high *
                        cos(2 * M_PI * (a * (double)i / (double)nx + b * (double)j / (double)ny) +
                            phase);
            if (dimension == 1)
                break;
        }
    for (size_t i = 0; i < nx * ny; i++)
        map.z[i] *= slope / sqrt(squares);
    return map;
}

/* The contact of a periodic map by several models, with its errors. */
struct pressed {
    struct press_series series[SERIES_MOST];
    struct press_row rows[SERIES_MOST][LOADS];
};

static void press_map(struct pressed *out, struct height_map map, size_t count,
                      const struct press_block *blocks) {
    struct map_press press = {0};
    struct error err = {0};
    double pressures[LOADS];
    int status = map_press_begin(&press, &map, PRESS_PERIODIC, &err);
    for (size_t l = 0; l < LOADS; l++)
        pressures[l] = REDUCED[l] * press.slope;
    for (size_t m = 0; m < count && status == 0; m++) {
        out->series[m] = (struct press_series){.block = blocks[m], .rows = out->rows[m]};
        status = map_press_loads(&press, map.z, LOADS, pressures, &out->series[m], &err);
    }
    map_press_release(&press);
    if (status == 0)
        status = map_press_error(&press, &map, count, out->series, LOADS, pressures, &err);
    if (status != 0)
        fail_msg("%s", err.text);
    map_press_clear(&press);
    height_map_clear(&map);
}

/* Returns the part of its bound, widened by `more`, that an error takes. */
static double part(const struct press_row *row, enum error_source source, size_t value,
                   double error, double more) {
    const struct press_error *known = &row->error[source][value];
    return fabs(error - known->value) / (known->bound + more);
}

/* A layer of 0.3 lengths less a half-space: of an exact layer the difference itself, of finite
 * elements, which are not pressed as high, within a quarter of it and 0.2 % for their edges on one
 * mesh. A block of 1.5 lengths is infinite but for 1e-5. */
static void low_blocks_are_compared(void **state) {
    (void)state;
    for (int dimension = 1; dimension <= 2; dimension++)
        for (uint64_t seed = 1; seed <= SEEDS; seed += case_step()) {
            static struct pressed high, low;
            struct press_block blocks[] = {{.model = model_named("halfspace"), .poisson = 0.3},
                                           {.model = model_named("layered"), .poisson = 0.3}};
            press_map(&high, rough(dimension, 0.05, seed), 2, blocks);
            blocks[0].lengths = blocks[1].lengths = 0.3;
            press_map(&low, rough(dimension, 0.05, seed), 2, blocks);
            static const size_t VALUES[] = {MEASURE_EDGES, MEASURE_GAP, PRESS_APPROACH};
            for (size_t v = 0; v < 3; v++)
                for (size_t l = 0; l < LOADS; l++) {
                    size_t value = VALUES[v];
                    for (size_t m = 0; m < 2; m++) {
                        double y = high.rows[m][l].value[value];
                        double error = low.rows[m][l].value[value] - y;
                        double more = m == 0 ? 1e-12 : 2e-3 * y;
                        const struct press_row *row = &low.rows[m][l];
                        assert_true(part(row, ERROR_BLOCK, value, error, more) <= 1);
                    }
                    assert_true(isnan(high.rows[0][l].error[ERROR_BLOCK][value].bound) ||
                                high.rows[0][l].error[ERROR_BLOCK][value].bound == 0);
                    assert_true(high.rows[1][l].error[ERROR_BLOCK][value].bound <=
                                1e-5 * fabs(high.rows[1][l].value[value]));
                }
            assert_false(map_press_applies(1, high.series, 0, MEASURE_EDGES, ERROR_BLOCK));
            assert_true(map_press_applies(1, low.series, 0, MEASURE_EDGES, ERROR_BLOCK));
        }
}

/* Alone, a linear model knows the sideways strain: its area less that of full is within what it
 * reports, with Poisson's ratios and slopes of the whole range; each third case is of another ratio
 * and another slope. The bound is of use: without the strain it would be too small by far. */
static void strain_is_known_to_first_order(void **state) {
    (void)state;
    static const double SLOPES[] = {0.01, 0.1, 0.5}, RATIOS[] = {0, 0.3, 0.4999};
    double most = 0, signed_most = 0;
    for (size_t c = 0; c < 9; c += case_step()) {
        static struct pressed linear, full;
        double slope = SLOPES[c / 3], poisson = RATIOS[(c + c / 3) % 3];
        const struct press_block layered = {.model = model_named("layered"), .poisson = poisson};
        const struct press_block complete = {.model = model_named("full"), .poisson = poisson};
        press_map(&linear, rough(1, slope, c + 1), 1, &layered);
        press_map(&full, rough(1, slope, c + 1), 1, &complete);
        for (size_t l = 0; l < LOADS; l++) {
            const struct press_row *row = &linear.rows[0][l];
            double error = row->value[MEASURE_EDGES] - full.rows[0][l].value[MEASURE_EDGES];
            double bound = row->error[ERROR_MODEL][MEASURE_EDGES].bound;
            most = fmax(most, part(row, ERROR_MODEL, MEASURE_EDGES, error, 0));
            signed_most = fmax(signed_most, fabs(error) / bound);
            assert_true(isnan(row->error[ERROR_MODEL][MEASURE_GAP].bound));
            assert_true(isnan(full.rows[0][l].error[ERROR_MODEL][MEASURE_EDGES].bound));
        }
    }
    print_message("at most %.2g of the bound; without the strain %.2g\n", most, signed_most);
    assert_true(most <= 1 && signed_most > 1.2);
}

/* Steep maps are beyond what was measured. */
static void strain_of_steep_maps_is_not_known(void **state) {
    (void)state;
    static struct pressed linear;
    const struct press_block block = {.model = model_named("halfspace"), .poisson = 0.3};
    press_map(&linear, rough(1, 0.7, 1), 1, &block);
    assert_true(isnan(linear.rows[0][0].error[ERROR_MODEL][MEASURE_EDGES].bound));
    assert_true(linear.rows[0][0].value[MEASURE_EDGES_STRETCHED] > 0);
}

/* Of several models each is compared with the most complete one, wherever it stands. The value
 * without the error of two meshes is the difference on the map. */
static void several_models_are_compared(void **state) {
    (void)state;
    static struct pressed pressed;
    const struct press_block blocks[] = {{.model = model_named("full"), .poisson = 0.3},
                                         {.model = model_named("halfspace"), .poisson = 0.3},
                                         {.model = model_named("layered"), .poisson = 0.3}};
    static const size_t VALUES[] = {MEASURE_EDGES, MEASURE_GAP, MEASURE_STIFFNESS, PRESS_PEAK};
    press_map(&pressed, rough(1, 0.1, 5), 3, blocks);
    for (size_t l = 0; l < LOADS; l++)
        for (size_t v = 0; v < 4; v++) {
            const struct press_row *full = &pressed.rows[0][l];
            assert_true(isnan(full->error[ERROR_MODEL][VALUES[v]].bound));
            for (size_t m = 1; m < 3; m++) {
                const struct press_row *row = &pressed.rows[m][l];
                const struct press_error *error = &row->error[ERROR_MODEL][VALUES[v]];
                check_close(error->value, row->value[VALUES[v]] - full->value[VALUES[v]], 1e-15);
                assert_true(error->bound > 0);
            }
        }
    assert_false(map_press_applies(3, pressed.series, 0, MEASURE_EDGES, ERROR_MODEL));
    assert_true(map_press_applies(3, pressed.series, 2, MEASURE_EDGES, ERROR_MODEL));
}

/* All that errs is within its bound of what a tolerance of 1e-11 finds. */
static void tolerances_bound_the_solver(void **state) {
    (void)state;
    for (int dimension = 1; dimension <= 2; dimension++)
        for (uint64_t seed = 1; seed <= SEEDS; seed += case_step()) {
            static struct pressed coarse, exact;
            struct press_block block = {.model = model_named("halfspace"), .tolerance = 1e-11};
            press_map(&exact, rough(dimension, 0.05, seed), 1, &block);
            for (block.tolerance = 1e-2; block.tolerance > 1e-7; block.tolerance *= 1e-2) {
                press_map(&coarse, rough(dimension, 0.05, seed), 1, &block);
                for (size_t l = 0; l < LOADS; l++)
                    for (size_t v = 0; v < PRESS_VALUES; v++) {
                        double y = exact.rows[0][l].value[v];
                        double error = coarse.rows[0][l].value[v] - y;
                        if (map_press_applies(1, coarse.series, 0, v, ERROR_SOLVER) && !isnan(y))
                            assert_true(part(&coarse.rows[0][l], ERROR_SOLVER, v, error,
                                             1e-9 * fabs(y)) <= 1);
                    }
            }
        }
}

/* What is not known is there without values, what does not bear on a curve is not. */
static void curves_say_what_is_known(void **state) {
    (void)state;
    static struct pressed pressed;
    struct map_press press = {.grid = {8 * WAVES, 1, 1, 1}, .slope = 1, .height = 1};
    struct case_result result = {0};
    struct error err = {0};
    const struct press_block block = {.model = model_named("halfspace"), .poisson = 0.3};
    press_map(&pressed, rough(1, 0.1, 6), 1, &block);
    press.one_case = (struct contact_case){.surface = {.spectrum = {.scale = SCALE_RMS_SLOPE}},
                                           .edges = true,
                                           .nodes = true,
                                           .model_count = 1};
    assert_int_equal(map_press_result(&result, &press, 1, pressed.series, LOADS, &err), 0);
    const struct curve *gap = result_curve(&result, "mean_gap");
    const struct curve *load = result_curve(&result, "load");
    const struct curve_error *solver = &gap->errors[ERROR_SOLVER];
    assert_true(gap->errors[ERROR_MODEL].applies && gap->errors[ERROR_MODEL].value == NULL);
    assert_false(gap->errors[ERROR_BLOCK].applies || gap->errors[ERROR_CELL].applies ||
                 gap->errors[ERROR_MISSING].applies || gap->law_difference != NULL);
    assert_true(solver->value[1] == 0);
    double nodes = pressed.rows[0][1].value[PRESS_CONTACT_NODES];
    const struct solver_counts of = {.tolerance = 1e-8,
                                     .nodes = nodes,
                                     .open = (double)grid_points(&press.map) - nodes,
                                     .patches = NAN};
    check_relative(solver->bound[1], contact_errors_solver(SOLVER_GAP, &of, gap->y[1]), 1e-12);
    assert_true(isnan(solver->standard_error[1]) && isnan(gap->standard_error[1]));
    for (size_t s = 0; s < ERROR_SOURCES; s++)
        assert_false(load->errors[s].applies);
    result_clear(&result);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(low_blocks_are_compared),
        cmocka_unit_test(strain_is_known_to_first_order),
        cmocka_unit_test(strain_of_steep_maps_is_not_known),
        cmocka_unit_test(several_models_are_compared),
        cmocka_unit_test(tolerances_bound_the_solver),
        cmocka_unit_test(curves_say_what_is_known),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
