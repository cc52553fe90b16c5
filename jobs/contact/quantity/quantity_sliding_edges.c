/* Areas of faces that slide (quantity_sliding.c), within edges found between nodes
 * (sliding_edges.h): two more curves of that path, whose values its solvers fill. */
#include "jobs/contact/contact_measure.h"
#include "jobs/contact/model/model_linear.h"
#include "jobs/contact/quantity/quantity.h"
#include "jobs/contact/quantity/sliding_linear.h"
#include <math.h>

/* A study asks by friction and the estimators. */
const struct parameter_table SLIDING_EDGES_PARAMETERS = {"contact", NULL, 0};

static bool asked(struct contact_case *one_case, struct values *values) {
    (void)values;
    return contact_case_slides(one_case) && one_case->edges;
}

static bool is_asked(const struct contact_case *one_case) {
    return one_case->asked.of[SLIDING_EDGES_AT];
}

/* Of what sticks, which is not known by edges where friction acted before. */
static bool is_stick_kept(const struct contact_case *one_case) {
    return is_asked(one_case) && !one_case->slip_pressing;
}

static bool is_never_shown(const struct contact_case *one_case, size_t model) {
    (void)one_case, (void)model;
    return false;
}

static bool is_never_kept(const struct contact_case *one_case) {
    (void)one_case;
    return false;
}

static bool is_linear(const struct contact_case *one_case, size_t model) {
    return linear_is_exact(one_case->models[model]) && !isfinite(one_case->blocks[model].height) &&
           sliding_linear_follows(one_case);
}

static bool is_stick_shown(const struct contact_case *one_case, size_t model) {
    return is_stick_kept(one_case) &&
           (one_case->models[model]->slides || is_linear(one_case, model));
}

static bool is_area_shown(const struct contact_case *one_case, size_t model) {
    return is_asked(one_case) &&
           (one_case->models[model]->slides || is_stick_shown(one_case, model));
}

/* The mesh couples pressures and tractions near edges, of first order in its spacing. */
#define MEMBERS                                                                                    \
    .series = "edges", .order = 1, .theories = THEORIES_NONE, .solver = SOLVER_SMOOTH,             \
    .field = FIELD_PRESSURE, .load = LOAD_STAYS, .cell = CELL_SAME, .values = VALUES_REPORTED,     \
    .over = OVER_ONE, .by = BY_SLIDING
/* The last one is by how much the first may be off (contact_errors.c). */
static const struct measure MEASURES[] = {
    {MEMBERS, .quantity = "sliding_stick_area", .y_label = "area that sticks/contact area",
     .shown = is_stick_shown, .kept = is_stick_kept},
    {MEMBERS, .quantity = "sliding_contact_area", .y_label = "contact area/that without friction",
     .shown = is_area_shown, .kept = is_asked},
    {MEMBERS, .quantity = "sliding_stick_unknown", .y_label = "area/contact area",
     .shown = is_never_shown, .kept = is_never_kept}};

const struct contact_quantity SLIDING_EDGES_QUANTITY = {.measures = MEASURES, .read = asked};
