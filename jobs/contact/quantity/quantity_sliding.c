/* Friction at finite strain: blocks of the model full are pressed to one load, and the flat is then
 * dragged along x or y on a path (core/full/friction). Curves are by how far it has slid over the
 * mean of the face, over the RMS height. A half-space beside it, and those of companions, follow
 * the same path with pressures and tractions coupled: their differences are the errors of other
 * sources. */
#include "jobs/contact/contact_measure.h"
#include "jobs/contact/model/model_linear.h"
#include "jobs/contact/quantity/quantity.h"
#include "jobs/contact/quantity/sliding_full.h"
#include "jobs/contact/quantity/sliding_linear.h"
#include <math.h>
#include <stdlib.h>

struct quantity_state {
    struct sliding_full *full; /* one of both; owned */
    struct sliding_linear *linear;
};

/* The tables of curves and of paths: up to so many turning points, so far away. */
enum { TURNS_MOST = 100, STEPS_MOST = CONTACT_LOADS_MOST - 1 };
#define SLIDE_MOST 1e3
static const double COEFFICIENT_MOST = 1;

#define FRICTION "/contact/friction"
static const char TO[] = "/contact/slip/to", STEPS[] = "/contact/slip/steps";

static const struct parameter ROWS[] = {
    {.path = "/contact/slip/to",
     .type = PARAMETER_NUMBERS,
     .minimum = -SLIDE_MOST,
     .maximum = SLIDE_MOST,
     .items_low = 1,
     .items_high = TURNS_MOST,
     .later = true,
     .target_refusal = FRICTION_NO_TARGET,
     .unit = "sqrt(m0)",
     .example_json = "[1]",
     .help =
         "full, with friction: how far the flat slides over the mean of the face, [4 mu] unless "
         "given; several values are points at which it turns"},
    {.path = "/contact/slip/steps",
     .type = PARAMETER_INTEGER,
     .minimum = 1,
     .maximum = STEPS_MOST,
     .later = true,
     .target_refusal = FRICTION_NO_TARGET,
     .example_json = "40",
     .help = "full, with friction: points of curves, evenly spaced, from one turn to the next; 30 "
             "unless given"},
};
const struct parameter_table SLIDING_PARAMETERS = {"contact", ROWS, sizeof ROWS / sizeof *ROWS};

/* The path is read behind (contact_case_read.c). */
static bool asked(struct contact_case *one_case, struct values *values) {
    const bool slides = contact_case_slides(one_case);
    static const char *const own[] = {TO, STEPS};
    for (size_t a = 0; a < sizeof own / sizeof *own; a++)
        if (!slides && values_is_given(values, own[a]))
            values_fault(values, own[a], "belongs to " FRICTION " with the model full");
    if (slides && one_case->friction > COEFFICIENT_MOST)
        values_fault(values, FRICTION, "%g; allowed with the model full: (0, %g]",
                     one_case->friction, COEFFICIENT_MOST);
    return slides;
}

static bool is_linear(const struct quantity_scene *scene) {
    return scene->exact && !scene->open && !isfinite(scene->block.height) &&
           sliding_linear_follows(scene->one_case);
}

static double bytes_of(const struct quantity_scene *scene) {
    if (scene->slides)
        return sliding_full_bytes(scene);
    return is_linear(scene) ? sliding_linear_bytes(scene) : 0;
}

static double seconds_of(const struct quantity_scene *scene) {
    if (scene->slides)
        return sliding_full_seconds(scene);
    return is_linear(scene) ? sliding_linear_seconds(scene) : 0;
}

static struct cost_jumps jumps_of(const struct quantity_scene *scene) {
    return scene->slides ? sliding_full_jumps(scene) : (struct cost_jumps){0};
}

static void destroy(struct quantity_state **state) {
    if (*state != NULL) {
        sliding_full_destroy(&(*state)->full);
        sliding_linear_destroy(&(*state)->linear);
    }
    free(*state);
    *state = NULL;
}

static int create(struct quantity_state **out, const struct quantity_scene *scene,
                  struct error *err) {
    *out = NULL;
    if (!scene->slides && !is_linear(scene))
        return 0;
    struct quantity_state *state = array_create(1, sizeof *state);
    if (state == NULL)
        return error_memory(err, sizeof *state, "sliding");
    int status = scene->slides ? sliding_full_create(&state->full, scene, err)
                               : sliding_linear_create(&state->linear, scene, err);
    if (status != 0)
        destroy(&state);
    *out = state;
    return status;
}

/* Where the linear model finds no solution, points from there on have no value. */
static int complete(struct quantity_state *state, const struct measure_context *context,
                    const double *z, size_t stride, double *values, struct error *err) {
    struct sliding_record record = {
        .one_case = context->one_case, .values = values, .stride = stride};
    if (state == NULL)
        return 0;
    if (state->full != NULL)
        return sliding_full_solve(state->full, context, z, &record, err);
    int status = sliding_linear_solve(state->linear, context, z, &record, err);
    return status == ERROR_NUMERIC ? 0 : status;
}

/* --- scalars --- */

static const char *const SCALARS[] = {"sliding_to_full_slip", NULL};
/* The part of the friction that counts as full slip: the last nodes slide late, and as they are
 * meshed. */
static const double FULL_SLIP = 0.99;

/* Returns how far the flat slides until then, on the first part of its path. */
static void summarise(const struct quantity_values *values, double *scalars) {
    const struct contact_case *one_case = values->one_case;
    const double *force = values->of + SAMPLE_FORCE * values->load_count;
    const double most = FULL_SLIP * one_case->friction;
    scalars[0] = NAN;
    for (size_t i = 1; i <= one_case->slide_steps; i++)
        if (fabs(force[i]) >= most) {
            double share = (most - fabs(force[i - 1])) / (fabs(force[i]) - fabs(force[i - 1]));
            double from = fabs(one_case->slide[i - 1]), to = fabs(one_case->slide[i]);
            scalars[0] = from + share * (to - from);
            return;
        }
}

/* --- measures --- */

static bool is_kept(const struct contact_case *one_case) {
    return one_case->asked.of[SLIDING_AT];
}

/* Of the linear model, too. */
static bool is_shown(const struct contact_case *one_case, size_t model) {
    bool linear = linear_is_exact(one_case->models[model]) &&
                  !isfinite(one_case->blocks[model].height) && sliding_linear_follows(one_case);
    return is_kept(one_case) && (one_case->models[model]->slides || linear);
}

/* What its pressing with friction leaves of the gap is not known of the linear model. */
static bool is_gap_shown(const struct contact_case *one_case, size_t model) {
    return is_shown(one_case, model) &&
           (one_case->models[model]->slides || !one_case->slip_pressing);
}

#define MEMBERS                                                                                    \
    .series = "", .kept = is_kept, .order = 1, .theories = THEORIES_NONE, .load = LOAD_STAYS,      \
    .cell = CELL_SAME, .values = VALUES_REPORTED, .by = BY_SLIDING
static const struct measure MEASURES[SLIDING_VALUES] = {
    [SAMPLE_FORCE] = {MEMBERS, .quantity = "sliding_force", .y_label = "Q/P", .shown = is_shown,
                      .solver = SOLVER_SMOOTH, .field = FIELD_PRESSURE, .over = OVER_ONE},
    [SAMPLE_STICK_AREA] = {MEMBERS, .quantity = "sliding_stick_area",
                           .y_label = "area that sticks/contact area", .shown = is_shown,
                           .solver = SOLVER_COUNTED, .field = FIELD_PRESSURE, .over = OVER_ONE},
    [SAMPLE_STICK_LOAD] = {MEMBERS, .quantity = "sliding_stick_load",
                           .y_label = "load on what sticks/load", .shown = is_shown,
                           .solver = SOLVER_COUNTED, .field = FIELD_PRESSURE, .over = OVER_ONE},
    [SAMPLE_AREA] = {MEMBERS, .quantity = "sliding_contact_area",
                     .y_label = "contact area/that without friction", .shown = is_shown,
                     .solver = SOLVER_COUNTED, .field = FIELD_PRESSURE, .over = OVER_ONE},
    [SAMPLE_GAP] = {MEMBERS, .quantity = "sliding_gap", .y_label = "mean gap/sqrt(m0)",
                    .shown = is_gap_shown, .solver = SOLVER_GAP, .field = FIELD_GAP,
                    .over = OVER_HEIGHT},
    [SAMPLE_DISSIPATION] = {MEMBERS, .quantity = "sliding_dissipation",
                            .y_label = "work that friction takes/(E* h'_rms sqrt(m0))",
                            .shown = is_shown, .solver = SOLVER_FLOW, .field = FIELD_GAP,
                            .over = OVER_WORK}};
const struct contact_quantity SLIDING_QUANTITY = {.measures = MEASURES,
                                                  .scalars = SCALARS,
                                                  .read = asked,
                                                  .bytes = bytes_of,
                                                  .seconds = seconds_of,
                                                  .jumps = jumps_of,
                                                  .create = create,
                                                  .destroy = destroy,
                                                  .complete = complete,
                                                  .summarise = summarise};
