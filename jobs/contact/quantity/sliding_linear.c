#include "jobs/contact/quantity/sliding_linear.h"
#include "core/contact/slip/partial_slip.h"
#include "core/cost.h"
#include "jobs/contact/quantity/sliding_edges.h"
#include <math.h>
#include <stdlib.h>

/* Friction while pressing acts in so many steps (quantity_coupling.c). Tractions rise in even
 * steps, so many at least, and then halve what is left to full slip. */
enum { PRESS_STEPS = 10, STEPS_LEAST = 10, HALVES = 3 };
/* Above it nodes that hardly stick near full slip are lost among others. */
static const double TOLERANCE_MOST = 1e-4;

bool sliding_linear_follows(const struct contact_case *one_case) {
    return one_case->slide_count == one_case->slide_steps + 1;
}

struct sliding_linear {
    struct slip *slip; /* owned, as the next */
    struct sliding_edges edges;
    double gap_without, area_without; /* where it was pressed without friction; by edges, share of
                                         the cell */
};

void sliding_linear_destroy(struct sliding_linear **sliding) {
    if (*sliding != NULL) {
        slip_destroy(&(*sliding)->slip);
        sliding_edges_clear(&(*sliding)->edges);
    }
    free(*sliding);
    *sliding = NULL;
}

int sliding_linear_create(struct sliding_linear **out, const struct quantity_scene *scene,
                          struct error *err) {
    const struct contact_case *one_case = scene->one_case;
    struct slip_options options = SLIP_DEFAULTS;
    options.poisson = scene->block.poisson;
    options.friction = one_case->friction;
    options.angle = one_case->slip_angle;
    options.press_steps = one_case->slip_pressing ? PRESS_STEPS : 0;
    options.tolerance = fmin(one_case->tolerance, TOLERANCE_MOST);
    struct sliding_linear *made = array_create(1, sizeof *made);
    if (made == NULL)
        return error_memory(err, sizeof *made, "sliding of a half-space");
    int status = slip_create(&made->slip, &scene->grid, &options, err);
    if (status == 0)
        status = sliding_edges_create(&made->edges, &scene->grid, scene->block.poisson,
                                      one_case->friction, err);
    if (status != 0)
        sliding_linear_destroy(&made);
    *out = made;
    return status;
}

static size_t steps_of(const struct contact_case *one_case) {
    return one_case->slide_steps > STEPS_LEAST ? one_case->slide_steps : STEPS_LEAST;
}

/* Goes on to full slip from a state near it, and along with it: what sticks is a small part that
 * falls evenly. */
static void slide_on(struct sliding_record *record, double forward, double share, double rate) {
    const struct contact_case *one_case = record->one_case;
    const double end = one_case->slide[one_case->slide_count - 1];
    const double work = one_case->friction * one_case->loads[one_case->slip_load];
    struct sliding_sample sample = record->last;
    double step = (1 - share) * rate;
    sample.sliding += step;
    sample.of[SAMPLE_FORCE] = forward * one_case->friction;
    sample.of[SAMPLE_STICK_AREA] = sample.of[SAMPLE_STICK_LOAD] = 0;
    sample.of[SAMPLE_STICK_EDGES] *= 0; /* NaN where it is not known */
    sample.of[SAMPLE_DISSIPATION] += work * fabs(step);
    sliding_record_add(record, &sample);
    step = fmax(0, forward * (end - sample.sliding));
    sample.sliding += forward * step;
    sample.of[SAMPLE_DISSIPATION] += work * step;
    sliding_record_add(record, &sample);
}

/* Returns the traction of a step over that of full slip. */
static double share_at(size_t step, size_t steps) {
    double even = 1 / (double)steps;
    return step < steps ? (double)step * even : 1 - even * ldexp(1, (int)(steps - 1) - (int)step);
}

static struct sliding_nodes nodes_of(const struct slip_state *state,
                                     const struct contact_case *one_case) {
    return (struct sliding_nodes){.p = state->p,
                                  .q = one_case->slip_angle > 0 ? state->qy : state->qx,
                                  .opening = state->gap,
                                  .over = state->over,
                                  .sticks = state->sticks};
}

/* What there is without friction is not known after pressing with it. */
static struct sliding_sample sample_of(struct sliding_linear *sliding,
                                       const struct slip_state *state,
                                       const struct measure_context *context,
                                       const struct sliding_record *record) {
    const size_t held = context->one_case->slip_load;
    const double touching = record->values[MEASURE_NODES * record->stride + held] * context->points;
    struct sliding_sample out = sliding_sample_none();
    out.sliding = state->displacement / context->rms_height;
    out.of[SAMPLE_FORCE] = state->traction / state->pressure;
    out.of[SAMPLE_STICK_AREA] = state->stick_area;
    out.of[SAMPLE_STICK_LOAD] = state->stick_load;
    out.of[SAMPLE_AREA] = (double)state->nodes / touching;
    out.of[SAMPLE_DISSIPATION] = state->dissipation / (context->rms_slope * context->rms_height);
    if (context->one_case->slip_pressing)
        return out;
    out.of[SAMPLE_GAP] = record->values[MEASURE_GAP * record->stride + held] +
                         (state->mean_gap - sliding->gap_without) / context->rms_height;
    if (!context->one_case->asked.of[SLIDING_EDGES_AT])
        return out;
    const struct sliding_nodes nodes = nodes_of(state, context->one_case);
    const struct sliding_area area = sliding_edges_measure(&sliding->edges, context->area, &nodes);
    out.of[SAMPLE_STICK_EDGES] = area.stick / area.contact;
    out.of[SAMPLE_AREA_EDGES] = area.contact / sliding->area_without;
    out.of[SAMPLE_STICK_UNKNOWN] = 0;
    return out;
}

int sliding_linear_solve(struct sliding_linear *sliding, const struct measure_context *context,
                         const double *z, struct sliding_record *record, struct error *err) {
    const struct contact_case *one_case = context->one_case;
    const size_t steps = steps_of(one_case), last = steps - 1 + HALVES;
    const double forward = one_case->slide[1] > 0 ? 1 : -1;
    const double pressure = one_case->loads[one_case->slip_load] * context->rms_slope;
    struct slip_state state;
    struct slip *slip = sliding->slip;
    double rate = 0; /* sliding over the share of full slip */
    slip_set_stop(slip, context->stop, context->stop_context);
    int status = slip_press(slip, z, pressure, &state, err);
    if (status != 0)
        return status;
    sliding_edges_begin(&sliding->edges, forward);
    sliding->gap_without = state.mean_gap;
    sliding->area_without = sliding_edges_area(context->area, state.p, state.gap);
    struct sliding_sample sample = sample_of(sliding, &state, context, record);
    sliding_record_begin(record, &sample);
    for (size_t step = 1; step <= last && !sliding_record_is_full(record); step++) {
        double share = share_at(step, steps), from = record->last.sliding;
        status = slip_load(slip, forward * share * one_case->friction * pressure, &state, err);
        if (status != 0)
            return status;
        sample = sample_of(sliding, &state, context, record);
        rate = (sample.sliding - from) / (share - share_at(step - 1, steps));
        sliding_record_add(record, &sample);
    }
    if (!sliding_record_is_full(record))
        slide_on(record, forward, share_at(last, steps), rate);
    return 0;
}

double sliding_linear_bytes(const struct quantity_scene *scene) {
    return slip_bytes(&scene->grid) + sliding_edges_bytes(&scene->grid);
}

double sliding_linear_seconds(const struct quantity_scene *scene) {
    static const double PROFILE = 2, SURFACE = 10; /* times the transforms of contact, as coupled
                                                      slip */
    const struct contact_case *one_case = scene->one_case;
    const size_t loads = steps_of(one_case) + HALVES + (one_case->slip_pressing ? PRESS_STEPS : 0);
    return (grid_is_profile(&scene->grid) ? PROFILE : SURFACE) *
           cost_linear_contact(&scene->grid, one_case->tolerance, loads);
}
