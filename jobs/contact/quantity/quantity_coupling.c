/* Partial slip with pressures and tractions coupled, of an infinite half-space on a rigid flat
 * (core/contact/slip/partial_slip.h): what the lighter loads of quantity_friction.c leave out. Each
 * of their points is solved here, so that both stand side by side. */
#include "core/contact/slip/partial_slip.h"
#include "core/cost.h"
#include "jobs/contact/contact_measure.h"
#include "jobs/contact/quantity/quantity.h"
#include <math.h>
#include <stdlib.h>

struct quantity_state {
    struct slip *slip;
};

/* Its measures, in this order. */
enum { STICK, DISPLACEMENT, AREA, COUPLING_MEASURES };

#define FRICTION "/contact/friction"
static const char COUPLING[] = "/contact/slip/coupling", PRESSING[] = "/contact/slip/pressing";
enum { PRESSING_FRICTIONLESS, PRESSING_FRICTIONAL };
static const struct choice PRESSINGS[] = {
    {"frictionless", PRESSING_FRICTIONLESS}, {"frictional", PRESSING_FRICTIONAL}, {0}};

static const struct parameter ROWS[] = {
    {.path = "/contact/slip/coupling",
     .type = PARAMETER_FLAG,
     .later = true,
     .target_refusal = FRICTION_NO_TARGET,
     .example_json = "true",
     .help = "with friction: also solve slip with what pressures move along the face and tractions "
             "across it, on an infinite half-space and a rigid flat; surfaces take 7 to 12 times "
             "as long as their contact, profiles 4 to 10 times"},
    {.path = "/contact/slip/pressing",
     .type = PARAMETER_CHOICE,
     .choices = PRESSINGS,
     .later = true,
     .target_refusal = FRICTION_NO_TARGET,
     .example_json = "\"frictional\"",
     .help = "with coupling, or friction of the model full: whether it acts while the block is "
             "pressed (frictionless unless given)"},
};
const struct parameter_table COUPLING_PARAMETERS = {"contact", ROWS, sizeof ROWS / sizeof *ROWS};

/* Friction while pressing acts in so many steps. On a cylinder 8 and 128 have the same stick radius
 * to 0.001 (F24.3). */
enum { PRESS_STEPS = 10 };
/* Above it nodes that hardly stick near full slip are lost among others. */
static const double TOLERANCE_MOST = 1e-4;

/* The heights of blocks, but for what the study gives, are read behind (contact_case_read.c). */
static void check(const struct contact_case *one_case, struct values *values) {
    int unit;
    if (isfinite(values_measure(values, "/contact/block_height", &unit)))
        values_fault(values, COUPLING, "blocks of finite height have none; leave one of them out");
    for (size_t m = 0; m < one_case->model_count; m++)
        if (one_case->models[m]->elements || isfinite(one_case->models[m]->default_height))
            values_fault(values, COUPLING,
                         "the model %s has none, but an infinite half-space; leave one of them out",
                         contact_model_name(one_case->models[m]));
    if (one_case->hardness > 0)
        values_fault(values, COUPLING, "a block that yields has none; leave one of them out");
    if (values_is_given(values, "/counter_surface/young"))
        values_fault(values, COUPLING,
                     "it is that against a rigid body, and the counter body is elastic; leave one "
                     "of them out");
}

static bool asked(struct contact_case *one_case, struct values *values) {
    bool coupled = values_flag(values, COUPLING);
    if (coupled && !(one_case->friction > 0))
        values_fault(values, COUPLING, "nothing slips unless " FRICTION " is given");
    bool pressed = coupled || contact_case_slides(one_case);
    if (!pressed && values_is_given(values, PRESSING))
        values_fault(values, PRESSING, "%s is not asked for, nor friction of the model full",
                     COUPLING);
    if (pressed && values_is_given(values, PRESSING))
        one_case->slip_pressing = values_choice(values, PRESSING) == PRESSING_FRICTIONAL;
    if (!coupled)
        return false;
    check(one_case, values);
    return one_case->friction > 0;
}

static bool is_solved(const struct quantity_scene *scene) {
    return scene->exact && !scene->open && !isfinite(scene->block.height);
}

static double bytes_of(const struct quantity_scene *scene) {
    return is_solved(scene) ? slip_bytes(&scene->grid) : 0;
}

static double seconds_of(const struct quantity_scene *scene) {
    /* Times the transforms of contact, as estimated and as planned. Profiles take 4.4 to 7, the
     * more the more points. */
    static const double PROFILE[] = {5, 2}, SURFACE[] = {9, 10};
    const struct contact_case *one_case = scene->one_case;
    const size_t loads = one_case->slip_load + (one_case->slip_pressing ? PRESS_STEPS : 0);
    const double *times = grid_is_profile(&scene->grid) ? PROFILE : SURFACE;
    return is_solved(scene) ? times[scene->planned ? 1 : 0] *
                                  cost_linear_contact(&scene->grid, one_case->tolerance, loads)
                            : 0;
}

static void destroy(struct quantity_state **state) {
    if (*state != NULL)
        slip_destroy(&(*state)->slip);
    free(*state);
    *state = NULL;
}

static int create(struct quantity_state **out, const struct quantity_scene *scene,
                  struct error *err) {
    const struct contact_case *one_case = scene->one_case;
    struct quantity_state *state = NULL;
    struct slip_options options = SLIP_DEFAULTS;
    int status = 0;
    if (is_solved(scene)) {
        options.poisson = scene->block.poisson;
        options.friction = one_case->friction;
        options.angle = one_case->slip_angle;
        options.press_steps = one_case->slip_pressing ? PRESS_STEPS : 0;
        options.tolerance = fmin(one_case->tolerance, TOLERANCE_MOST);
        state = array_create(1, sizeof *state);
        status = state != NULL ? slip_create(&state->slip, &scene->grid, &options, err)
                               : error_memory(err, sizeof *state, "partial slip");
        if (status != 0)
            destroy(&state);
    }
    *out = state;
    return status;
}

/* Solves the tangential loads from the lightest on. Points from one on that finds no solution have
 * no value. */
static int complete(struct quantity_state *state, const struct measure_context *context,
                    const double *z, size_t stride, double *values, struct error *err) {
    const struct contact_case *one_case = context->one_case;
    const size_t top = one_case->slip_load;
    const double pressed = values[MEASURE_NODES * stride + top] * context->points;
    double *own = values + COUPLING_MEASURE * stride;
    struct slip_state slip;
    if (state == NULL)
        return 0;
    slip_set_stop(state->slip, context->stop, context->stop_context);
    int status = slip_press(state->slip, z, one_case->loads[top] * context->rms_slope, &slip, err);
    for (size_t k = top; k-- > 0 && status == 0;) {
        double lacks = (one_case->loads[top] - one_case->loads[k]) * context->rms_slope;
        status = slip_load(state->slip, one_case->friction * lacks, &slip, err);
        if (status != 0)
            break;
        own[STICK * stride + k] = slip.stick_area;
        own[DISPLACEMENT * stride + k] = slip.displacement / context->rms_height;
        own[AREA * stride + k] = (double)slip.nodes / pressed;
    }
    return status == ERROR_NUMERIC ? 0 : status;
}

static bool is_kept(const struct contact_case *one_case) {
    return one_case->asked.of[COUPLING_AT];
}

static bool is_shown(const struct contact_case *one_case, size_t model) {
    (void)model;
    return is_kept(one_case);
}

static const struct measure MEASURES[COUPLING_MEASURES] = {
    [STICK] = {.quantity = "stick_area",
               .series = "coupled",
               .y_label = "area that sticks/contact area",
               .shown = is_shown,
               .kept = is_kept,
               .order = 1,
               .theories = THEORIES_NONE,
               .solver = SOLVER_COUNTED,
               .field = FIELD_PRESSURE,
               .load = LOAD_STAYS,
               .cell = CELL_SAME,
               .values = VALUES_REPORTED,
               .over = OVER_ONE,
               .by = BY_SLIP},
    [DISPLACEMENT] = {.quantity = "tangential_displacement",
                      .series = "coupled",
                      .y_label = "tangential displacement/sqrt(m0)",
                      .shown = is_shown,
                      .kept = is_kept,
                      .order = 1,
                      .theories = THEORIES_NONE,
                      .solver = SOLVER_SMOOTH,
                      .field = FIELD_GAP,
                      .load = LOAD_STAYS,
                      .cell = CELL_SAME,
                      .values = VALUES_REPORTED,
                      .over = OVER_HEIGHT,
                      .by = BY_SLIP},
    [AREA] = {.quantity = "slip_contact_area",
              .series = "coupled",
              .y_label = "contact area/that without friction",
              .shown = is_shown,
              .kept = is_kept,
              .order = 1,
              .theories = THEORIES_NONE,
              .solver = SOLVER_COUNTED,
              .field = FIELD_PRESSURE,
              .load = LOAD_STAYS,
              .cell = CELL_SAME,
              .values = VALUES_REPORTED,
              .over = OVER_ONE,
              .by = BY_SLIP}};
const struct contact_quantity COUPLING_QUANTITY = {.measures = MEASURES,
                                                   .read = asked,
                                                   .bytes = bytes_of,
                                                   .seconds = seconds_of,
                                                   .create = create,
                                                   .destroy = destroy,
                                                   .complete = complete};
