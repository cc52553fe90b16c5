/* What is left of a contact that yielded, as the load falls from its highest again: the face as it
 * was lowered is elastic (core/contact/contact.h). */
#include "core/contact/area.h"
#include "jobs/contact/contact_measure.h"
#include "jobs/contact/quantity/quantity.h"
#include <math.h>

/* Its measures, in this order. */
enum { AREA, GAP, APPROACH, UNLOAD_MEASURES };
_Static_assert((int)UNLOAD_MEASURE + AREA == (int)UNLOAD_AREA &&
                   (int)UNLOAD_MEASURE + GAP == (int)UNLOAD_GAP,
               "what slips after yielding");

static const struct parameter ROWS[] = {
    {.path = "/contact/unload",
     .type = PARAMETER_FLAG,
     .later = true,
     .target_refusal = "a target answers contact that is elastic",
     .example_json = "true",
     .help = "with a hardness: the loads fall again, from the highest through all below it; areas "
             "and gaps on that path, and the approach that is left without a load; under a coating "
             "of more than about 3 times the modulus the study may fail there"},
};
const struct parameter_table UNLOAD_PARAMETERS = {"contact", ROWS, sizeof ROWS / sizeof *ROWS};

/* Friction after yielding slips by the contact of falling loads. */
static bool asked(struct contact_case *one_case, struct values *values) {
    bool unloads = values_flag(values, ROWS[0].path);
    if (unloads && !(one_case->hardness > 0))
        values_fault(values, ROWS[0].path,
                     "an elastic block comes back as it went: give /contact/hardness, too");
    one_case->unloads = one_case->hardness > 0 && (unloads || one_case->friction > 0);
    return one_case->unloads;
}

/* The highest load is where both paths meet. */
static int measure(struct quantity_state *state, const struct measure_context *context,
                   const struct contact_pressed *pressed, const struct contact_area *area,
                   double *values, struct error *err) {
    (void)state, (void)err;
    values[AREA] = area->nodes;
    values[GAP] = pressed->state.mean_gap / context->rms_height;
    values[APPROACH] = pressed->state.permanent_approach / context->rms_height;
    return 0;
}

static void measure_falling(const struct measure_context *context,
                            const struct contact_state *state, double *values) {
    values[AREA] = (double)state->nodes / context->points;
    values[GAP] = state->mean_gap / context->rms_height;
}

static bool is_asked(const struct contact_case *one_case) {
    return one_case->asked.of[UNLOAD_AT];
}

static bool is_shown(const struct contact_case *one_case, size_t model) {
    (void)model;
    return is_asked(one_case);
}

static const struct measure MEASURES[UNLOAD_MEASURES] = {
    [AREA] = {.quantity = "unload_area",
              .series = "nodes",
              .y_label = "A/A0 as the load falls",
              .shown = is_shown,
              .kept = is_asked,
              .order = 1,
              .theories = THEORIES_NONE,
              .solver = SOLVER_COUNTED,
              .field = FIELD_PRESSURE,
              .load = LOAD_FALLS,
              .cell = CELL_SAME,
              .values = VALUES_SOME,
              .over = OVER_AREA},
    [GAP] = {.quantity = "unload_gap",
             .series = "",
             .y_label = "mean gap/sqrt(m0) as the load falls",
             .shown = is_shown,
             .kept = is_asked,
             .order = 1,
             .theories = THEORIES_NONE,
             .solver = SOLVER_SMOOTH,
             .field = FIELD_GAP,
             .load = LOAD_STAYS,
             .cell = CELL_SAME,
             .values = VALUES_SOME,
             .over = OVER_HEIGHT},
    [APPROACH] = {.quantity = "permanent_approach",
                  .series = "",
                  .y_label = "approach left/sqrt(m0)",
                  .shown = is_shown,
                  .kept = is_asked,
                  .order = 1,
                  .theories = THEORIES_NONE,
                  .solver = SOLVER_SMOOTH,
                  .field = FIELD_GAP,
                  .load = LOAD_FALLS,
                  .cell = CELL_SAME,
                  .values = VALUES_SOME,
                  .over = OVER_HEIGHT}};
const struct contact_quantity UNLOAD_QUANTITY = {
    .measures = MEASURES, .read = asked, .measure = measure, .measure_falling = measure_falling};
