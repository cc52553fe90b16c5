/* What yields under a hardness (core/contact/contact.h): how much of the cell and of the load, and
 * by which volume. The solvers of all models take the hardness from the case. */
#include "core/contact/area.h"
#include "jobs/contact/contact_measure.h"
#include "jobs/contact/quantity/quantity.h"
#include <math.h>

/* Its measures, in this order. */
enum { AREA, LOAD, VOLUME, UNLOAD_STIFFNESS, EDGES, HARDNESS_MEASURES };
_Static_assert((int)HARDNESS_MEASURE + AREA == (int)PLASTIC_AREA &&
                   (int)HARDNESS_MEASURE + VOLUME == (int)PLASTIC_VOLUME &&
                   (int)HARDNESS_MEASURE + EDGES == (int)EDGES_YIELDED,
               "columns of tables");

static const struct parameter ROWS[] = {
    {.path = "/contact/hardness",
     .type = PARAMETER_NUMBER,
     .minimum = 0,
     .maximum = CONTACT_HARDNESS_MOST,
     .above_minimum = true,
     .sweep = true,
     .later = true,
     .unit = "E* h'",
     .target_refusal = "a target answers contact that is elastic",
     .example_json = "[0.2, 0.5, 1]",
     .help = "pressure at which the block yields, elastic, ideally plastic, over E* h', so that a "
             "sweep of slopes is one of materials; above all loads; unless given nothing yields"},
};
const struct parameter_table HARDNESS_PARAMETERS = {"contact", ROWS, sizeof ROWS / sizeof *ROWS};

static bool asked(struct contact_case *one_case, struct values *values) {
    double hardness = values_number(values, ROWS[0].path);
    if (isnan(hardness))
        return false;
    one_case->hardness = hardness;
    for (size_t m = 0; m < one_case->model_count; m++)
        if (!one_case->models[m]->yields)
            values_fault(values, ROWS[0].path, "the model %s does not yield; leave one of them out",
                         contact_model_name(one_case->models[m]));
    return true;
}

static int measure(struct quantity_state *state, const struct measure_context *context,
                   const struct contact_pressed *pressed, const struct contact_area *area,
                   double *values, struct error *err) {
    const struct contact_state *contact = &pressed->state;
    (void)state;
    (void)err;
    values[AREA] = (double)contact->yielded / context->points;
    values[LOAD] = contact->plastic_load;
    values[VOLUME] = contact->plastic_volume / context->rms_height;
    values[EDGES] = area->edges_unknown;
    values[UNLOAD_STIFFNESS] = measure_stiffness(context, contact->unload_stiffness);
    return 0;
}

static bool is_asked(const struct contact_case *one_case) {
    return one_case->asked.of[HARDNESS_AT];
}

static bool is_shown(const struct contact_case *one_case, size_t model) {
    (void)model;
    return is_asked(one_case);
}

static bool is_edges_shown(const struct contact_case *one_case, size_t model) {
    (void)model;
    return is_asked(one_case) && one_case->edges;
}

static bool is_stiffness_kept(const struct contact_case *one_case) {
    return is_asked(one_case) && one_case->stiffness;
}

static bool is_stiffness_shown(const struct contact_case *one_case, size_t model) {
    (void)model;
    return is_stiffness_kept(one_case);
}

static const struct measure MEASURES[HARDNESS_MEASURES] = {
    [AREA] = {.quantity = "plastic_area",
              .series = "",
              .y_label = "A/A0 at the hardness",
              .shown = is_shown,
              .kept = is_asked,
              .order = 1,
              .theories = THEORIES_PLASTIC,
              .solver = SOLVER_COUNTED,
              .field = FIELD_PRESSURE,
              .load = LOAD_FALLS,
              .cell = CELL_SAME,
              .values = VALUES_SOME,
              .over = OVER_AREA},
    [LOAD] = {.quantity = "plastic_load",
              .series = "",
              .y_label = "share of the load at the hardness",
              .shown = is_shown,
              .kept = is_asked,
              .order = 1,
              .theories = THEORIES_NONE,
              .solver = SOLVER_COUNTED,
              .field = FIELD_PRESSURE,
              .load = LOAD_STAYS,
              .cell = CELL_SAME,
              .values = VALUES_SOME,
              .over = OVER_ONE},
    [VOLUME] = {.quantity = "plastic_volume",
                .series = "",
                .y_label = "plastic volume/(A0 sqrt(m0))",
                .shown = is_shown,
                .kept = is_asked,
                .order = 1,
                .theories = THEORIES_NONE,
                .solver = SOLVER_COUNTED,
                .field = FIELD_GAP,
                .load = LOAD_FALLS,
                .cell = CELL_SAME,
                .values = VALUES_SOME,
                .over = OVER_HEIGHT},
    [EDGES] = {.quantity = "contact_area",
               .series = "edges_yielded",
               .y_label = "A/A0",
               .shown = is_edges_shown,
               .kept = is_asked,
               .order = 1,
               .theories = THEORIES_NONE,
               .solver = SOLVER_COUNTED,
               .field = FIELD_PRESSURE,
               .load = LOAD_FALLS,
               .cell = CELL_SAME,
               .values = VALUES_SOME,
               .over = OVER_AREA},
    [UNLOAD_STIFFNESS] = {.quantity = "unload_stiffness",
                          .series = "",
                          .y_label = "K sqrt(m0)/(E* h'_rms)",
                          .shown = is_stiffness_shown,
                          .kept = is_stiffness_kept,
                          .order = 1,
                          .theories = THEORIES_NONE,
                          .solver = SOLVER_STIFFNESS,
                          .field = FIELD_GAP,
                          .load = LOAD_FALLS,
                          .cell = CELL_SAME,
                          .values = VALUES_REPORTED,
                          .over = OVER_STIFFNESS}};
const struct contact_quantity HARDNESS_QUANTITY = {
    .measures = MEASURES, .read = asked, .measure = measure};
