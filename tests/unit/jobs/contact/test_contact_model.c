/* A contact model is one struct: a fourth one, springs without neighbours (Winkler's foundation),
 * stands in this file alone, and goes from parameters to curves beside a half-space. */
#include "jobs/contact/case/contact_case_read.h"
#include "jobs/maps/press/map_press_curves.h"
#include "jobs/maps/press/map_press_error.h"
#include "tests/support/check.h"
#include "tests/support/contact_document.h"
#include <stdlib.h>

#define MODELS(ENTRY) ENTRY(HALFSPACE, "halfspace", 0) ENTRY(WINKLER, "winkler", -1)
CONTACT_MODEL_TABLES(MODELS)

enum { SHORTEST_SPRING };
static const char *const SCALARS[] = {"winkler_shortest_spring"};
static const struct model_curve CURVES[] = {
    {"shortest_spring", "compression/lambda_s", SHORTEST_SPRING}};

struct contact_solver {
    size_t n;
    double modulus, *z, *p, *gap; /* E* a length; owned, n each */
};

static void destroy(struct contact_solver **solver) {
    if (*solver != NULL)
        free((*solver)->z);
    free(*solver);
    *solver = NULL;
}

static int create(struct contact_solver **out, const struct contact_case *one_case, size_t model,
                  const struct compliance *compliance, struct error *err) {
    struct contact_solver *solver = array_create(1, sizeof *solver);
    (void)one_case;
    (void)model;
    *out = solver;
    if (solver == NULL)
        return error_memory(err, sizeof *solver, "springs");
    solver->n = grid_points(&compliance->grid);
    solver->modulus = 1 / compliance->grid.lx;
    solver->z = array_create(solver->n, 3 * sizeof *solver->z);
    solver->p = solver->z + solver->n;
    solver->gap = solver->p + solver->n;
    if (solver->z == NULL)
        destroy(out);
    return *out != NULL ? 0 : error_memory(err, 3 * sizeof(double), "springs");
}

static int begin(struct contact_solver *solver, const double *z, int (*stop)(void *context),
                 void *context, double *facts, struct error *err) {
    (void)stop;
    (void)context;
    (void)facts;
    (void)err;
    memcpy(solver->z, z, solver->n * sizeof *z);
    return 0;
}

/* Mean pressure of a flat at height d, and all of the state there. */
static double press_to(struct contact_solver *s, double d, struct contact_state *state) {
    double n = (double)s->n;
    *state = (struct contact_state){.p = s->p, .gap = s->gap, .opening = s->gap, .work = n};
    for (size_t i = 0; i < s->n; i++) {
        s->p[i] = s->modulus * fmax(0, s->z[i] - d);
        s->gap[i] = fmax(0, d - s->z[i]);
        state->pressure += s->p[i] / n;
        state->mean_gap += s->gap[i] / n;
        state->nodes += s->p[i] > 0;
    }
    state->stiffness = s->modulus * (double)state->nodes / (n - (double)state->nodes);
    return state->pressure;
}

static int press(struct contact_solver *s, double pressure, struct contact_pressed *out,
                 struct error *err) {
    double low = -100, high = 100;
    (void)err;
    for (int step = 0; step < 100; step++) {
        double middle = (low + high) / 2;
        if (press_to(s, middle, &out->state) > pressure)
            low = middle;
        else
            high = middle;
        out->own[SHORTEST_SPRING] = 0;
        for (size_t i = 0; i < s->n; i++)
            out->own[SHORTEST_SPRING] = fmax(out->own[SHORTEST_SPRING], s->p[i] / s->modulus);
    }
    out->state.iterations = 100;
    return 0;
}

static double bytes(const struct contact_case *one_case, size_t model, const struct grid *grid) {
    (void)one_case;
    (void)model;
    return 24.0 * (double)grid_points(grid);
}

static double seconds(const struct contact_case *one_case, size_t model, const struct grid *grid) {
    (void)model;
    return 1e-7 * (double)grid_points(grid) * (double)one_case->load_count;
}

static void measure(const struct model_values *values, double *scalars) {
    scalars[SHORTEST_SPRING] =
        model_largest(values->load_count, values->of[MEASURE_OWN + SHORTEST_SPRING]);
}

const struct contact_model WINKLER_MODEL = {
    .rank = -1,
    .block = MODEL_HALFSPACE,
    .default_height = INFINITY,
    .curve_count = sizeof CURVES / sizeof *CURVES,
    .curves = CURVES,
    .scalar_count = sizeof SCALARS / sizeof *SCALARS,
    .scalars = SCALARS,
    .bytes = bytes,
    .seconds = seconds,
    .create = create,
    .destroy = destroy,
    .begin = begin,
    .press = press,
    .measure = measure,
};

#define STUDY(models)                                                                              \
    "{\"surface\": {\"dimension\": 1, \"hurst\": 0.8, \"wavelength_ratio\": 4, \"length_ratio\":"  \
    " 4, \"points_per_wavelength\": 8, \"rms_slope\": 0.1}, \"contact\": {\"model\": " models ","  \
    " \"levels\": [4, 8], \"pressures\": {\"values\": [0.01, 0.05]}, \"pressure_pdf\": {\"bins\":" \
    " [0, 4, 4000]}}}"

/* Springs carry the load, report what they alone know, and are compared with the half-space. */
static void fourth_model_goes_through(void **state) {
    (void)state;
    cJSON *document = solve(STUDY("[\"halfspace\", \"winkler\"]"), 3);
    const cJSON *area = curve_of(document, "contact_area", "nodes", "winkler");
    const cJSON *spring = curve_of(document, "shortest_spring", "", "winkler");
    const cJSON *pdf = curve_of(document, "contact_pressure_pdf", "", "winkler");
    double width = at(pdf, "/x", 1) - at(pdf, "/x", 0), moment = 0, sum = 0;
    for (int b = 0; b < points(pdf); b++) {
        moment += width * at(pdf, "/y", b) * at(pdf, "/x", b);
        sum += width * at(pdf, "/y", b);
    }
    assert_near(moment, 0.05, width / 2 * sum, 0.05);
    check_relative(sum, at(curve_of(document, "contact_area", "edges", "winkler"), "/y", 1), 1e-6);
    for (int k = 0; k < 2; k++) {
        const cJSON *solid = curve_of(document, "contact_area", "nodes", "halfspace");
        assert_true(isfinite(at(area, "/model_error", k)));
        check_relative(at(area, "/y", k) > 0 ? 1 : 0, 1, 0);
        assert_null(json_at(solid, "/model_error"));
    }
    assert_true(at(spring, "/y", 1) > at(spring, "/y", 0) && at(spring, "/y", 0) > 0);
    check_relative(json_at(document, "/scalars/winkler_shortest_spring/value")->valuedouble,
                   at(spring, "/y", 1), 1e-12);
    cJSON_Delete(document);
}

/* Without the model nothing is reported of it, with it alone the rest is there, and a model that is
 * not in the table is no choice. */
static void table_is_all_that_is_known(void **state) {
    (void)state;
    cJSON *document = solve(STUDY("\"halfspace\""), 1);
    const cJSON *curve;
    cJSON_ArrayForEach(curve, json_at(document, "/curves"))
        assert_false(text_is(curve, "/quantity", "shortest_spring"));
    assert_null(json_at(document, "/scalars/winkler_shortest_spring"));
    assert_non_null(json_at(document, "/scalars/kappa"));
    cJSON_Delete(document);
    document = solve(STUDY("\"winkler\""), 2);
    assert_non_null(json_at(document, "/scalars/winkler_shortest_spring"));
    cJSON_Delete(document);
    struct contact_case one_case;
    struct error err = {0};
    cJSON *parameters = cJSON_Parse(STUDY("\"layered\""));
    assert_int_equal(contact_case_read(&one_case, parameters, 0, NULL, &err), ERROR_INPUT);
    cJSON_Delete(parameters);
}

/* A measured map is pressed by it as by the others: mirrored, since nobody said that it presses
 * maps that do not repeat; its own curve follows those of all models. */
static void fourth_model_presses_a_map(void **state) {
    (void)state;
    struct press_row row;
    struct press_series series = {.block = {.model = &WINKLER_MODEL, .poisson = 0.3}, .rows = &row};
    struct map_press press = {0};
    struct error err = {0};
    struct case_result result = {0};
    struct height_map map = {.grid = {24, 1, 6, 1}, .z = array_create(24, sizeof *map.z)};
    const double load = 0.001;
    assert_non_null(map.z);
    for (size_t i = 0; i < 24; i++)
        map.z[i] = 0.05 * cos(2 * M_PI * (double)i / 24);
    if (map_press_begin(&press, &map, PRESS_MIRRORED, &err) != 0 ||
        map_press_loads(&press, map.z, 1, &load, &series, &err) != 0 ||
        map_press_error(&press, &map, 1, &series, 1, &load, &err) != 0 ||
        map_press_result(&result, &press, 1, &series, 1, &err) != 0)
        fail_msg("%s", err.text);
    assert_true(row.value[MEASURE_NODES] > 0 && row.value[MEASURE_NODES] < 1);
    assert_true(isnan(press.full_contact));
    const struct curve *spring = result_curve(&result, "shortest_spring");
    assert_non_null(spring);
    assert_string_equal(spring->model, "winkler");
    assert_true(spring->y[0] > 0);
    /* Its face is not known to strain sideways: the error of the model applies, and is unknown. */
    const struct curve_error *model = &result_curve(&result, "contact_area")->errors[ERROR_MODEL];
    assert_true(model->applies && model->value == NULL);
    result_clear(&result);
    map_press_clear(&press);
    assert_int_equal(map_press_check(PRESS_OPEN, &WINKLER_MODEL, &err), ERROR_INPUT);
    assert_non_null(strstr(err.text, "--model winkler needs a block that does"));
    assert_non_null(strstr(err.text, "or --model halfspace"));
    height_map_clear(&map);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(fourth_model_goes_through),
        cmocka_unit_test(fourth_model_presses_a_map),
        cmocka_unit_test(table_is_all_that_is_known),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
