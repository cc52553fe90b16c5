/* The flat is dragged by displacements over the far side of the block: neither the traction nor the
 * sliding can drive it where all of the face sticks, or slides. Most of a displacement shears the
 * block at first. So steps are chosen by how far the flat slid in the one before, and none is
 * longer than an even part of the path with that shear. */
#include "jobs/contact/quantity/sliding_full.h"
#include "core/contact/stretch.h"
#include "core/cost.h"
#include "core/full/friction/friction.h"
#include "jobs/contact/quantity/sliding_edges.h"
#include <math.h>
#include <stdlib.h>

/* Friction while pressing acts in so many steps, as on half-spaces. */
enum { PRESS_STEPS = 10 };
/* The longest step is this part of the path with the shear; a path ends in vain after so many
 * times its points, and these. */
enum { STEPS_LEAST = 16, STEPS_TIMES = 20 };
/* The part of the friction from which all of the face slides evenly: on surfaces, directions still
 * turn by a little. */
static const double EVEN = 0.999;
/* The mesh couples pressures and tractions, so that edges of what sticks lie up to so many steps
 * farther in or out, on meshes of any fineness: measured 0.16 at a Poisson's ratio of 0.4999, with
 * 8 to 32 points a shortest wave, and 0.05 at 0.3. */
static const double EDGE_UNKNOWN = 0.2;
/* The least step, over the longest; how near a point may be that a step aims at, over what lies
 * between points. */
static const double STEP_LEAST = 1e-3, AIM_LEAST = 0.5;

struct sliding_full {
    struct friction *friction; /* owned, as the next */
    struct sliding_edges edges;
    struct block block;
    double area_without;         /* by edges, without friction, share of the face */
    struct friction_state state; /* of the last step */
    double displacement;         /* of the flat then */
};

void sliding_full_destroy(struct sliding_full **sliding) {
    if (*sliding != NULL) {
        friction_destroy(&(*sliding)->friction);
        sliding_edges_clear(&(*sliding)->edges);
    }
    free(*sliding);
    *sliding = NULL;
}

/* Of a case whose loads are not known. */
static const double USUAL_LOAD = 0.1;

static double held_load(const struct contact_case *one_case) {
    return one_case->loads != NULL ? one_case->loads[one_case->slip_load] : USUAL_LOAD;
}

/* What a step takes, of the scene and loads without friction. */
static struct friction_work work_of(const struct quantity_scene *scene,
                                    const struct full_size *load) {
    const struct contact_case *one_case = scene->one_case;
    return (struct friction_work){
        .grid = &scene->grid,
        .load = load,
        .coefficient = one_case->friction,
        .rms_slope = one_case->rms_slope,
        .poisson = scene->block.poisson,
        .pressure = held_load(one_case),
        .wave = contact_case_wave(one_case, &scene->grid),
        .leg = fmax((double)one_case->slide_steps, STEPS_LEAST),
    };
}

int sliding_full_create(struct sliding_full **out, const struct quantity_scene *scene,
                        struct error *err) {
    const struct contact_case *one_case = scene->one_case;
    const struct full_options options =
        contact_case_limited_options(one_case, &scene->grid, &scene->block);
    const struct full_size size =
        cost_full_size(&scene->grid, &scene->block, &options, one_case->rms_slope);
    const struct friction_work work = work_of(scene, &size);
    const struct friction_options friction = {
        .coefficient = one_case->friction,
        .press_steps = one_case->slip_pressing ? PRESS_STEPS : 0,
        .along_y = one_case->slip_angle > 0,
        .limit = cost_friction_limit(&work, one_case->time_limit)};
    struct sliding_full *made = array_create(1, sizeof *made);
    if (made == NULL)
        return error_memory(err, sizeof *made, "sliding at finite strain");
    made->block = scene->block;
    int status =
        friction_create(&made->friction, &scene->grid, &made->block, &options, &friction, err);
    if (status == 0)
        status = sliding_edges_create(&made->edges, &scene->grid, scene->block.poisson,
                                      one_case->friction, err);
    if (status != 0)
        sliding_full_destroy(&made);
    *out = made;
    return status;
}

static struct sliding_nodes nodes_of(const struct sliding_full *sliding,
                                     const struct contact_case *one_case) {
    const struct friction_state *state = &sliding->state;
    return (struct sliding_nodes){.p = state->p,
                                  .q = one_case->slip_angle > 0 ? state->q_across : state->q,
                                  .opening = state->opening,
                                  .over = state->over,
                                  .sticks = state->sticks};
}

/* Returns an area by edges over that of the face as areas are taken: within them it has no
 * slopes. */
static double over_face(double area, const struct friction_face *face) {
    return stretch_fraction(area, face->open_stretch) / (1 + face->tilt);
}

/* Adds the areas by edges. Where friction acted before, what stuck then is not known by edges. */
static void sample_edges(struct sliding_full *sliding, const struct measure_context *context,
                         double *of) {
    const struct friction_state *state = &sliding->state;
    const struct sliding_nodes nodes = nodes_of(sliding, context->one_case);
    const struct sliding_area area = sliding_edges_measure(&sliding->edges, context->area, &nodes);
    of[SAMPLE_AREA_EDGES] = over_face(area.contact, &state->face) / sliding->area_without;
    if (context->one_case->slip_pressing)
        return;
    of[SAMPLE_STICK_EDGES] = area.stick / area.contact;
    of[SAMPLE_STICK_UNKNOWN] = EDGE_UNKNOWN * area.crossed / area.contact;
}

/* The mean gap is that of the held load without friction, with what friction changes of it. */
static struct sliding_sample sample_of(struct sliding_full *sliding,
                                       const struct measure_context *context,
                                       const struct sliding_record *record) {
    const struct friction_state *state = &sliding->state;
    const struct contact_case *one_case = context->one_case;
    const size_t held = one_case->slip_load;
    const double values[SLIDING_VALUES] = {
        [SAMPLE_FORCE] = state->traction / state->pressure,
        [SAMPLE_STICK_AREA] = state->stick_area,
        [SAMPLE_STICK_LOAD] = state->stick_load,
        [SAMPLE_AREA] = one_case->current_areas
                            ? state->face.area / state->face_without.area
                            : (double)state->nodes / (double)state->without->nodes,
        [SAMPLE_GAP] = record->values[MEASURE_GAP * record->stride + held] +
                       (state->mean_gap - state->without->mean_gap) / context->rms_height,
        [SAMPLE_DISSIPATION] = state->dissipation / (context->rms_slope * context->rms_height),
        [SAMPLE_STICK_EDGES] = NAN,
        [SAMPLE_AREA_EDGES] = NAN,
        [SAMPLE_STICK_UNKNOWN] = NAN};
    struct sliding_sample out = {.sliding = state->sliding / context->rms_height};
    for (size_t a = 0; a < SLIDING_VALUES; a++)
        out.of[a] = values[a];
    if (one_case->asked.of[SLIDING_EDGES_AT])
        sample_edges(sliding, context, out.of);
    return out;
}

/* Returns how far the far side lags at most where all of the face slides, Q h/G with G of the block
 * undeformed (E* = 1). */
static double shear_most(const struct sliding_full *sliding, double pressure, double friction) {
    return friction * pressure * sliding->block.height * 2 / (1 - sliding->block.poisson);
}

/* Returns the point that a step is to reach: the next one, or where that is near the one behind. */
static size_t aim_of(const struct sliding_record *record, double sliding) {
    const double *at = record->one_case->slide;
    const size_t next = record->next;
    bool near = fabs(at[next] - sliding) < AIM_LEAST * fabs(at[next] - at[next - 1]);
    return near && next < sliding_record_turn(record) ? next + 1 : next;
}

static bool slides_evenly(const struct friction_state *state, double friction) {
    return state->stuck == 0 && fabs(state->traction) >= EVEN * friction * state->pressure;
}

/* Drags the flat to the next turning point. Where all of the face slides, nothing changes any more
 * but the work. */
static int drag(struct sliding_full *sliding, const struct measure_context *context,
                struct sliding_record *record, struct error *err) {
    const struct contact_case *one_case = context->one_case;
    const double *at = one_case->slide, height = context->rms_height;
    const size_t first = record->next - 1, turn = sliding_record_turn(record);
    const double span = at[turn] - at[first], forward = span > 0 ? 1 : -1;
    const struct sliding_nodes nodes = nodes_of(sliding, one_case);
    const double shear =
        (first > 0 ? 2 : 1) * shear_most(sliding, sliding->state.pressure, one_case->friction);
    const double whole = fabs(span) * height + shear, most = whole / STEPS_LEAST;
    const double first_step = fmin(most, whole / (double)one_case->slide_steps);
    double rate = 0; /* sliding over displacement */
    bool slides = false;
    if (first > 0)
        sliding_edges_turn(&sliding->edges, &nodes);
    for (size_t step = 0; record->next <= turn; step++) {
        const double before = sliding->state.sliding;
        const size_t aim = slides ? turn : aim_of(record, before / height);
        const double next = forward * (at[aim] * height - before);
        double by = slides ? next : rate > 0 ? fmin(most, next / rate) : first_step;
        by = fmax(by, STEP_LEAST * most);
        if (step > STEPS_TIMES * (one_case->slide_steps + STEPS_LEAST))
            return error_set(err, ERROR_NUMERIC, "the flat did not slide on in %zu steps", step);
        int status = friction_drag(sliding->friction, sliding->displacement + forward * by,
                                   &sliding->state, err);
        if (status != 0)
            return status;
        sliding->displacement += forward * by;
        rate = forward * (sliding->state.sliding - before) / by;
        slides = slides_evenly(&sliding->state, one_case->friction);
        const struct sliding_sample sample = sample_of(sliding, context, record);
        sliding_record_add(record, &sample);
        if (context->progress != NULL)
            context->progress(context->progress_context,
                              (double)(record->next - 1) / (double)one_case->slide_count);
    }
    return 0;
}

int sliding_full_solve(struct sliding_full *sliding, const struct measure_context *context,
                       const double *z, struct sliding_record *record, struct error *err) {
    const struct contact_case *one_case = context->one_case;
    const double load = one_case->loads[one_case->slip_load];
    friction_set_stop(sliding->friction, context->stop, context->stop_context);
    sliding->displacement = 0;
    int status = friction_begin(sliding->friction, z, err);
    if (status == 0)
        status = friction_press(sliding->friction, load * context->rms_slope, &sliding->state, err);
    if (status != 0) {
        error_context(err, "load %g with friction", load);
        return status;
    }
    sliding_edges_begin(&sliding->edges, one_case->slide[1] > 0 ? 1 : -1);
    const struct contact_state *without = sliding->state.without;
    sliding->area_without =
        over_face(sliding_edges_area(context->area, without->p, without->opening),
                  &sliding->state.face_without);
    const struct sliding_sample start = sample_of(sliding, context, record);
    sliding_record_begin(record, &start);
    while (!sliding_record_is_full(record) && status == 0)
        status = drag(sliding, context, record, err);
    if (status != 0)
        error_context(err, "load %g, slid %.4g of %g", load, record->last.sliding,
                      one_case->slide[sliding_record_turn(record)]);
    return status;
}

/* --- cost --- */

/* Of surfaces that are dragged none of lower RMS slopes overhangs. */
static const double OVERHANG_SLOPE = 0.5;

double sliding_full_bytes(const struct quantity_scene *scene) {
    const struct contact_case *one_case = scene->one_case;
    const struct full_options options = contact_case_full_options(one_case, &scene->grid);
    struct full_size size =
        cost_full_size(&scene->grid, &scene->block, &options, one_case->rms_slope);
    if (!grid_is_profile(&scene->grid) && one_case->rms_slope > OVERHANG_SLOPE)
        size.overhangs = options.kinematics != KINEMATICS_SMALL;
    return cost_friction_bytes(&scene->grid, &scene->block, &options, &size) +
           sliding_edges_bytes(&scene->grid);
}

/* The flat goes SLIP sqrt(m0) times the coefficient, at a load of 0.1 E* h', until all slides, by
 * this power of the load and this part more a doubling of the cell over CELL_WAVES longest waves.
 * Of the traction q over that of full slip, it goes 1 - (1 - q)^SLIP_SHAPE of this. Steps are by
 * STEEPER h' more, and LAST from there to the turn. On surfaces it goes SURFACE times as far, and
 * more by their tangential compliance (F14.20). Fitted to profiles with slopes of 0.05 to 0.7,
 * coefficients of 0.1 to 1, loads of 0.02 to 0.4, and 10 to 90 points: within 0.15. */
static const double SLIP = 1.6, SLIP_POWER = 0.2, SLIP_SHAPE = 0.7, SLIP_CELL = 0.3, CELL_WAVES = 2;
static const double STEEPER = 0.6, LAST = 2, SURFACE = 1.2;
/* Nearly all slides from this part of that distance on. */
static const double SLIP_MOST = 0.6;
enum { SLIP_PARTS = 32 };

/* Returns the steps from one turn to the next, or from the start: as drag() takes them. span: the
 * path, which may end before all slides, shear: how far the far side lags, and slip: how far the
 * flat goes, until all slides, over the RMS height. */
static double leg_steps(double span, double points, double shear, double slip) {
    const double step = (span + shear) / STEPS_LEAST;
    double before = 0, all = 0;
    for (int part = 1; part <= SLIP_PARTS && before < span; part++) {
        double left = 1 - (double)part / SLIP_PARTS;
        double at = fmin(span, slip * (1 - pow(left, SLIP_SHAPE)));
        all += fmax((at - before + shear / SLIP_PARTS) / step, (at - before) / span * points);
        before = at;
    }
    return all + (before < span ? LAST : 0);
}

/* What the whole path takes: steps, and how far all of the face slides, nearly, over the RMS
 * height. */
struct path_expected {
    double steps, slid;
};

static struct path_expected path_of(const struct quantity_scene *scene) {
    const struct contact_case *one_case = scene->one_case;
    const size_t steps = one_case->slide_steps;
    const double load = held_load(one_case), slope = one_case->rms_slope;
    const double waves = surface_case_mean_side(&one_case->surface); /* 0 where not known */
    const double shear = one_case->friction * load * slope * scene->block.height * 2 /
                         (1 - scene->block.poisson) / one_case->rms_height;
    const double nu = scene->block.poisson;
    const double more = grid_is_profile(&scene->grid) ? 1 : SURFACE * (1 - nu / 2) / (1 - nu);
    const double slip = SLIP * one_case->friction * pow(load / USUAL_LOAD, SLIP_POWER) * more *
                        (1 + SLIP_CELL * fmax(0, log2(waves / CELL_WAVES)));
    struct path_expected path = {0};
    double legs = 1;
    for (size_t turn = 0; turn + 1 < one_case->slide_count; turn += steps, legs = 2) {
        const double span = fabs(one_case->slide[turn + steps] - one_case->slide[turn]);
        path.steps += leg_steps(span, (double)steps, legs * shear, legs * slip);
        path.slid += fmax(0, span - SLIP_MOST * legs * slip);
    }
    path.steps *= 1 + STEEPER * slope;
    return path;
}

/* CPU seconds until the load is held and along the path, each within the limit, and what jumps take
 * of both. */
struct sliding_cost {
    double held, dragged;
    struct cost_jumps jumps;
};

static struct sliding_cost cost_of(const struct quantity_scene *scene) {
    const struct contact_case *one_case = scene->one_case;
    const struct full_options options = contact_case_full_options(one_case, &scene->grid);
    const struct full_size size =
        cost_full_size(&scene->grid, &scene->block, &options, one_case->rms_slope);
    const struct friction_work work = work_of(scene, &size);
    const double pressing = one_case->slip_pressing ? PRESS_STEPS : 0;
    const double load = held_load(one_case), limit = one_case->time_limit;
    const struct path_expected path = path_of(scene);
    const double loads =
        cost_full_loads(&scene->grid, &size, one_case->rms_slope, 1, &load) + pressing;
    const double pressed = cost_full_contact(&scene->grid, &size, loads);
    const double steps = cost_friction_steps(&work, path.steps + pressing);
    const struct cost_jumps held = cost_full_jumps(
        &scene->grid, &size, work.wave, one_case->rms_slope, load, cost_jumps_most(limit, pressed));
    const struct cost_jumps dragged =
        cost_friction_jumps(&work, path.slid, cost_jumps_most(limit, steps));
    const double most = limit > 0 ? limit : INFINITY;
    return (struct sliding_cost){.held = fmin(pressed + held.seconds, most),
                                 .dragged = fmin(steps + dragged.seconds, most),
                                 .jumps = cost_jumps_sum(held, dragged)};
}

double sliding_full_seconds(const struct quantity_scene *scene) {
    const struct sliding_cost cost = cost_of(scene);
    return cost.held + cost.dragged;
}

struct cost_jumps sliding_full_jumps(const struct quantity_scene *scene) {
    return cost_of(scene).jumps;
}
