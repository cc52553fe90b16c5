/* What leaks through the gap of a surface, and whether anything can (core/quantity/leak.h). */
#include "core/quantity/leak.h"
#include "jobs/contact/contact_measure.h"
#include "jobs/contact/quantity/quantity.h"
#include <math.h>
#include <stdlib.h>

struct quantity_state {
    struct leak *leak;
};

/* Its measures, in this order. */
enum { MEAN, HARMONIC, ARITHMETIC, MEDIUM, ALONG_X, ALONG_Y, PERCOLATES, LEAK_MEASURES };

_Static_assert((int)LEAK_MEASURE + ALONG_X == (int)LEAK_ALONG_X &&
                   (int)LEAK_MEASURE + ALONG_Y == (int)LEAK_ALONG_Y,
               "columns of tables");

static const struct parameter ROWS[] = {
    {.path = "/contact/leak",
     .type = PARAMETER_FLAG,
     .later = true,
     .example_json = "true",
     .help = "what leaks through the gap of a surface, over what a uniform gap of the same mean "
             "lets through, and whether the free space crosses the cell; of surfaces"},
};
const struct parameter_table LEAK_PARAMETERS = {"contact", ROWS, sizeof ROWS / sizeof *ROWS};

static bool asked(struct contact_case *one_case, struct values *values) {
    bool leaks = values_flag(values, "/contact/leak");
    (void)one_case;
    if (leaks && values_number(values, "/surface/dimension") == 1)
        values_fault(values, "/contact/leak",
                     "a profile leaks nothing, as each contact closes it; take a surface");
    return leaks;
}

static double bytes_of(const struct quantity_scene *scene) {
    return leak_bytes(&scene->grid, &LEAK_DEFAULTS, 1);
}

static double seconds_of(const struct quantity_scene *scene) {
    static const double A_POINT = 1.2e-6; /* both directions, both means */
    return A_POINT * (double)grid_points(&scene->grid) * (double)scene->one_case->load_count;
}

static void destroy(struct quantity_state **state) {
    if (*state != NULL)
        leak_destroy(&(*state)->leak);
    free(*state);
    *state = NULL;
}

static int create(struct quantity_state **out, const struct quantity_scene *scene,
                  struct error *err) {
    struct quantity_state *state = array_create(1, sizeof *state);
    if (state == NULL)
        return error_memory(err, sizeof *state, "a leak");
    struct leak_options options = LEAK_DEFAULTS;
    options.walled = scene->open;
    int status = leak_create(&state->leak, &scene->grid, &options, err);
    if (status != 0)
        destroy(&state);
    *out = state;
    return status;
}

/* A flow that is not found is a value that is missing, which curves count. */
static int measure(struct quantity_state *state, const struct measure_context *context,
                   const struct contact_pressed *pressed, const struct contact_area *area,
                   double *values, struct error *err) {
    struct leak_result leak;
    struct error why = {0};
    (void)context;
    (void)area;
    int status = leak_measure(state->leak, pressed->state.gap, pressed->state.p, &leak, &why);
    if (status == ERROR_NUMERIC)
        return 0;
    if (status != 0)
        return error_set(err, status, "%s", why.text);
    values[MEAN] = (leak.x.value + leak.y.value) / 2;
    values[HARMONIC] = (leak.x.harmonic + leak.y.harmonic) / 2;
    values[ARITHMETIC] = (leak.x.arithmetic + leak.y.arithmetic) / 2;
    values[MEDIUM] = leak.effective_medium;
    values[ALONG_X] = leak.x.value;
    values[ALONG_Y] = leak.y.value;
    values[PERCOLATES] = (leak.x.open + leak.y.open) / 2.0;
    return 0;
}

/* Each direction closes between two loads; its threshold is taken in their middle. None where one
 * closes nowhere or below the first load. */
static void summarise(const struct quantity_values *values, double *scalars) {
    const double *open = values->of + PERCOLATES * values->load_count;
    double closed = 0, load = 0, area = 0;
    for (size_t k = 1; k < values->load_count; k++) {
        double closes = open[k - 1] - open[k];
        if (!(closes > 0))
            continue;
        closed += closes;
        load += closes * (values->loads[k - 1] + values->loads[k]) / 2;
        area += closes * (values->areas[k - 1] + values->areas[k]) / 2;
    }
    bool both = closed == 1;
    scalars[0] = both ? load : (double)NAN;
    scalars[1] = both ? area : (double)NAN;
}

static bool is_asked(const struct contact_case *one_case) {
    return one_case->asked.of[LEAK_AT];
}

static bool is_shown(const struct contact_case *one_case, size_t model) {
    (void)model;
    return is_asked(one_case);
}

#define LEAK_ROW(name, label)                                                                      \
    {                                                                                              \
        .quantity = "leak", .series = (name), .y_label = (label), .shown = is_shown,               \
        .kept = is_asked, .order = 2, .theories = THEORIES_NONE, .solver = SOLVER_FLOW,            \
        .field = FIELD_GAP, .load = LOAD_STAYS, .cell = CELL_SAME, .values = VALUES_REPORTED,      \
        .over = OVER_ONE                                                                           \
    }
#define FACTOR "leak over that of the mean gap"
static const struct measure MEASURES[LEAK_MEASURES] = {
    [MEAN] = LEAK_ROW("", FACTOR),
    [HARMONIC] = LEAK_ROW("harmonic", FACTOR),
    [ARITHMETIC] = LEAK_ROW("arithmetic", FACTOR),
    [MEDIUM] = LEAK_ROW("effective_medium", FACTOR),
    [ALONG_X] = LEAK_ROW("x", FACTOR),
    [ALONG_Y] = LEAK_ROW("y", FACTOR),
    [PERCOLATES] = {.quantity = "percolates",
                    .series = "",
                    .y_label = "share of directions that are open",
                    .shown = is_shown,
                    .kept = is_asked,
                    .order = 1,
                    .theories = THEORIES_NONE,
                    .solver = SOLVER_COUNTED,
                    .field = FIELD_GAP,
                    .load = LOAD_STAYS,
                    .cell = CELL_SAME,
                    .values = VALUES_REPORTED,
                    .over = OVER_ONE}};
static const char *const SCALARS[] = {"percolation_load", "percolation_area", NULL};

const struct contact_quantity LEAK_QUANTITY = {.measures = MEASURES,
                                               .scalars = SCALARS,
                                               .read = asked,
                                               .bytes = bytes_of,
                                               .seconds = seconds_of,
                                               .create = create,
                                               .destroy = destroy,
                                               .measure = measure,
                                               .summarise = summarise};
