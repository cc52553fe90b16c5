/* Protects the steps of a case's surface: each load of the model that is asked for, in order; the
 * pressures carry the load, and at each node gap, height and displacement belong together. */
#include "jobs/contact/case/contact_case_read.h"
#include "jobs/contact/contact_steps.h"
#include "jobs/surface/realisation_map.h"
#include "tests/support/check.h"
#include <stdlib.h>
#include <string.h>

#define STUDY                                                                                      \
    "{\"surface\": {\"dimension\": %d, \"hurst\": 0.8, \"wavelength_ratio\": 2, "                  \
    "\"length_ratio\": 1, \"rms_slope\": 0.1}, \"contact\": {\"model\": %s, \"levels\": [4, 6], "  \
    "\"pressures\": {%s}}}"

static const char LOADS_OF[] = "\"values\": [0.1, 0.3]";

struct seen {
    size_t count, stop_after;
    double loads[4];
    bool displaced;
    const struct grid *grid; /* of the finest level */
};

/* The flat is as high as the highest node before the load; the solver's tolerance is 1e-8. */
static void check_nodes(const struct nodal_step *step) {
    size_t n = grid_points(&step->grid);
    double highest = step->z[0], sum = 0;
    for (size_t i = 0; i < n; i++) {
        highest = fmax(highest, step->z[i]);
        sum += step->p[i] / (double)n;
        assert_true((step->p[i] > 0) == (step->contact[i] > 0));
    }
    check_relative(sum, step->load, 1e-8);
    for (size_t i = 0; i < n && step->u != NULL; i++)
        check_close(step->gap[i], highest - step->z[i] - step->u[3 * i + 2], 1e-12);
}

static int see(void *context, const struct nodal_step *step, size_t number, size_t count,
               struct error *err) {
    struct seen *seen = context;
    assert_int_equal(number, seen->count);
    assert_true(count <= 4);
    seen->loads[seen->count++] = step->load;
    seen->displaced = step->u != NULL;
    assert_int_equal(step->grid.nx, seen->grid->nx);
    assert_true((step->mesh != NULL) == seen->displaced);
    check_nodes(step);
    return seen->count == seen->stop_after ? error_set(err, ERROR_SYSTEM, "a full disk") : 0;
}

struct pressed_case {
    struct contact_case one_case;
    double *z;
};

static struct pressed_case open_case(int dimension, const char *models, const char *pressures) {
    struct pressed_case out = {.z = NULL};
    struct surface_report report;
    struct error err = {0};
    char text[480];
    snprintf(text, sizeof text, STUDY, dimension, models, pressures);
    cJSON *parameters = cJSON_Parse(text);
    assert_non_null(parameters);
    const struct random_key key = {1, 0, 0};
    if (contact_case_read(&out.one_case, parameters, 0, NULL, &err) != 0 ||
        realisation_surface(&out.one_case.surface, key, &out.z, &report, &err) != 0)
        fail_msg("%s", err.text);
    cJSON_Delete(parameters);
    return out;
}

static void close_case(struct pressed_case *open) {
    free(open->z);
    contact_case_clear(&open->one_case);
}

static void every_load_is_a_step(void **state) {
    (void)state;
    static const double LOADS[] = {0, 0.2};
    for (int dimension = 1; dimension <= 2; dimension++) {
        struct pressed_case open = open_case(dimension, "[\"layered\", \"full\"]", LOADS_OF);
        const struct grid *grid = &contact_case_finest(&open.one_case)->grid;
        struct error err = {0};
        const struct steps_order orders[] = {
            {.z = open.z},
            {.z = open.z, .model = "layered"},
            {.z = open.z, .meshed = true, .load_count = 2, .loads = LOADS}};
        for (size_t o = 0; o < sizeof orders / sizeof *orders; o++) {
            struct seen seen = {.grid = grid};
            const struct steps_sink sink = {see, &seen};
            if (contact_press_steps(&open.one_case, &orders[o], &sink, &err) != 0)
                fail_msg("%s", err.text);
            assert_int_equal(seen.count, 2);
            check_close(seen.loads[1], o == 2 ? 0.2 : 0.3, 0);
            assert_true(seen.displaced == (o != 1));
        }
        close_case(&open);
    }
}

/* The pressures of the last step, a sum that differs in its last bits where any of them does. */
struct last_step {
    size_t count;
    double load, sum;
};

static int take_last(void *context, const struct nodal_step *step, size_t number, size_t count,
                     struct error *err) {
    struct last_step *last = context;
    (void)err;
    assert_true(number == last->count++ && number < count);
    last->load = step->load;
    last->sum = 0;
    for (size_t i = 0; i < grid_points(&step->grid); i++)
        last->sum += step->p[i] * (double)(i + 1);
    return 0;
}

/* A load that is kept alone is the study's, in its unit, and was pressed as the study presses it.
 */
static void kept_loads_are_the_studys(void **state) {
    (void)state;
    static const char *const PRESSURES[] = {
        "\"values\": [0.02, 0.1, 0.3]}, \"keep\": {\"realisations\": [0], \"loads\": [0.1]",
        "\"values\": [2e3, 1e4, 3e4], \"unit\": \"Pa\"}, \"young\": 0.91e6, \"keep\": "
        "{\"realisations\": [0], \"loads\": [1e4]"};
    for (size_t a = 0; a < 2; a++) {
        struct pressed_case open = open_case(1, "\"full\"", PRESSURES[a]);
        struct last_step kept = {0}, whole = {0};
        struct error err = {0};
        const struct steps_order order = {.z = open.z, .kept = true},
                                 two = {.z = open.z, .load_count = 2, .loads = open.one_case.loads};
        const struct steps_sink sink = {take_last, &kept}, sink_of_two = {take_last, &whole};
        assert_int_equal(contact_press_steps(&open.one_case, &order, &sink, &err), 0);
        assert_int_equal(contact_press_steps(&open.one_case, &two, &sink_of_two, &err), 0);
        assert_true(kept.count == 1 && whole.count == 2);
        check_relative(kept.load, 0.1, 1e-9);
        check_close(kept.sum, whole.sum, 0);
        close_case(&open);
    }
}

static int is_late(void *context) {
    (void)context;
    return 1;
}

static void faults_are_told(void **state) {
    (void)state;
    struct pressed_case open = open_case(1, "[\"halfspace\", \"layered\"]", LOADS_OF);
    struct seen seen = {.grid = &contact_case_finest(&open.one_case)->grid, .stop_after = 1};
    const struct steps_sink sink = {see, &seen};
    struct error err = {0};
    struct steps_order order = {.z = open.z, .model = "full"};
    assert_int_equal(contact_press_steps(&open.one_case, &order, &sink, &err), ERROR_INPUT);
    assert_string_equal(err.text, "the case has no model full; it has halfspace, layered");
    order = (struct steps_order){.z = open.z, .meshed = true};
    assert_int_equal(contact_press_steps(&open.one_case, &order, &sink, &err), ERROR_INPUT);
    assert_string_equal(err.text, "--mesh needs \"full\" among /contact/model");
    assert_int_equal(seen.count, 0);
    order.meshed = false;
    assert_int_equal(contact_press_steps(&open.one_case, &order, &sink, &err), ERROR_SYSTEM);
    assert_int_equal(seen.count, 1);
    order.stop = is_late;
    assert_int_equal(contact_press_steps(&open.one_case, &order, &sink, &err), ERROR_STOPPED);
    assert_int_equal(seen.count, 1);
    close_case(&open);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_load_is_a_step),
        cmocka_unit_test(kept_loads_are_the_studys),
        cmocka_unit_test(faults_are_told),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
