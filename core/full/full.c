#include "core/full/full.h"
#include "core/full/face.h"
#include "core/full/load_steps.h"
#include "core/sum.h"
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

const struct full_options FULL_DEFAULTS = {.kinematics = KINEMATICS_HENCKY,
                                           .transition = 8,
                                           .tolerance = 1e-9,
                                           .max_iterations = 60,
                                           .least_step = 1.0 / 256};

/* A state between loads; arrays are owned. */
struct full_state {
    double *u;
    bool *active;
    struct self_pair *pair;
    size_t pairs;
};

/* All lengths in this file are in units of dx, the mesh's unit. */
struct full {
    struct full_options options;
    struct mesh *mesh;
    struct newton newton;
    struct compliance *compliance;
    struct contact *linear;                     /* predicts which nodes touch */
    double *z;                                  /* heights of mean 0 */
    double *pressure, *gap, *opening, *tangent; /* by node of the face: results in the user's
                                                   units */
    double *kept;                               /* displacements of the last load that converged */
    double *displacement;                       /* displacements in the user's unit */
    bool *kept_active;     /* by node of the face: the active set of that load */
    bool *guess, *touches; /* by node of the face: contact by the linear model at that load, and at
                              the load being tried */
    double load;           /* that load; 0: no contact */
    double rms;            /* RMS height */
    double used;           /* counted seconds since full_begin (struct full_limit) */
    bool flat_only;        /* overhangs are not allowed */
    bool careful;          /* the face may overhang and jump: load steps did not go on otherwise */
    struct full_state last, held; /* when careful: of the last load, and before the next */
};

static int options_check(const struct full_options *options, struct error *err) {
    if (!(options->tolerance > 0 && options->tolerance < 1))
        return error_set(err, ERROR_INPUT, "tolerance = %g; allowed: above 0, below 1",
                         options->tolerance);
    if (!(options->least_step > 0 && options->least_step <= 1))
        return error_set(err, ERROR_INPUT, "least load step = %g; allowed: above 0, up to 1",
                         options->least_step);
    return 0;
}

static int arrays_create(struct full *f, struct error *err) {
    size_t face = f->mesh->face, degrees_of_freedom = mesh_degrees_of_freedom(f->mesh);
    f->z = array_create(face, sizeof *f->z);
    f->pressure = array_create(face, sizeof *f->pressure);
    f->gap = array_create(face, sizeof *f->gap);
    f->opening = array_create(face, sizeof *f->opening);
    f->tangent = array_create(face, sizeof *f->tangent);
    f->kept_active = array_create(face, sizeof *f->kept_active);
    f->guess = array_create(face, sizeof *f->guess);
    f->touches = array_create(face, sizeof *f->touches);
    f->kept = array_create(newton_unknowns(&f->newton), sizeof *f->kept);
    f->displacement = array_create(degrees_of_freedom, sizeof *f->displacement);
    if (f->z == NULL || f->pressure == NULL || f->gap == NULL || f->opening == NULL ||
        f->tangent == NULL || f->kept_active == NULL || f->guess == NULL || f->touches == NULL ||
        f->kept == NULL || f->displacement == NULL)
        return error_memory(err, 2 * degrees_of_freedom * sizeof(double), "finite elements");
    return 0;
}

int full_create(struct full **out, const struct grid *grid, const struct block *block,
                const struct full_options *options, struct error *err) {
    *out = NULL;
    int status = options_check(options, err);
    if (status == 0 && block_is_coated(block))
        status = error_set(err, ERROR_INPUT,
                           "a coating %g thick: the model full has no coatings, halfspace and "
                           "layered do",
                           block->coating.thickness);
    if (status != 0)
        return status;
    struct full *f = array_create(1, sizeof *f);
    if (f == NULL)
        return error_memory(err, sizeof *f, "finite elements");
    struct block linear = *block;
    struct contact_options loose = CONTACT_DEFAULTS;
    struct material material = material_of(block->poisson, options->kinematics);
    linear.model = MODEL_LAYERED;
    loose.tolerance = 1e-5;
    f->options = *options;
    status = mesh_create(&f->mesh, grid, block, options->transition, err);
    if (status == 0)
        status = compliance_create(&f->compliance, grid, &linear, err);
    if (status == 0)
        status = contact_create(&f->linear, f->compliance, &loose, err);
    if (status == 0)
        status =
            newton_create(&f->newton, f->mesh, &material, block->weighting, options->solver, err);
    if (status == 0)
        status = arrays_create(f, err);
    if (status != 0)
        full_destroy(&f);
    else {
        f->newton.tolerance = options->tolerance;
        f->newton.max_iterations = options->max_iterations;
    }
    *out = f;
    return status;
}

static void state_clear(struct full_state *state) {
    free(state->u);
    free(state->active);
    free(state->pair);
    *state = (struct full_state){0};
}

void full_destroy(struct full **full) {
    struct full *f = *full;
    if (f == NULL)
        return;
    newton_clear(&f->newton);
    contact_destroy(&f->linear);
    compliance_destroy(&f->compliance);
    mesh_destroy(&f->mesh);
    free(f->z);
    free(f->pressure);
    free(f->gap);
    free(f->opening);
    free(f->tangent);
    free(f->kept_active);
    free(f->guess);
    free(f->touches);
    free(f->kept);
    free(f->displacement);
    state_clear(&f->last);
    state_clear(&f->held);
    free(f);
    *full = NULL;
}

size_t full_degrees_of_freedom(const struct grid *grid, const struct block *block,
                               const struct full_options *options) {
    struct mesh *mesh = NULL;
    struct error ignored;
    if (mesh_create(&mesh, grid, block, options->transition, &ignored) != 0)
        return 0;
    size_t degrees_of_freedom = mesh_degrees_of_freedom(mesh);
    mesh_destroy(&mesh);
    return degrees_of_freedom;
}

double full_bytes(const struct grid *grid, const struct block *block,
                  const struct full_options *options, double iterations, bool overhangs) {
    struct mesh *mesh = NULL;
    if (mesh_create(&mesh, grid, block, options->transition, NULL) != 0)
        return NAN;
    enum {
        VECTORS = 6,
        OVERHANG_STATES = 2,
        OVERHANG_VECTORS = OVERHANG_STATES + 1, /* and what drags */
        FACES = 9
    }; /* arrays of newton.h and this file by unknown and by node of the face, and one of areas */
    struct material material = material_of(block->poisson, options->kinematics);
    bool pressures = gmres_needs_pressures(&material);
    double unknowns = (double)mesh_unknowns(mesh, pressures);
    double vectors = VECTORS + (overhangs ? OVERHANG_VECTORS : 0);
    double bytes =
        sizeof(double) * (vectors * unknowns + FACES * (double)mesh->face + (double)mesh->nodes) +
        tangent_bytes(mesh, pressures) +
        gmres_bytes(mesh, &material, iterations, overhangs && mesh->dimension == 3) +
        contact_bytes(grid, block, &CONTACT_DEFAULTS) + compliance_bytes(grid, block);
    if (overhangs)
        bytes += self_contact_bytes(mesh) +
                 sizeof(struct self_pair) * OVERHANG_STATES * (double)self_pairs_most(mesh);
    mesh_destroy(&mesh);
    return bytes;
}

void full_set_stop(struct full *f, int (*stop)(void *context), void *context) {
    f->newton.stop = stop;
    f->newton.context = context;
    contact_set_stop(f->linear, stop, context);
}

void full_set_overhangs(struct full *f, bool allowed) {
    f->flat_only = !allowed;
}

/* Copies the heights in units of dx, with mean 0. */
static int take_heights(struct full *f, const double *z, struct error *err) {
    size_t n = f->mesh->face;
    struct sum sum = {0}, square = {0};
    double largest = 0;
    for (size_t i = 0; i < n; i++) {
        f->z[i] = z[i] / f->mesh->unit;
        largest = fmax(largest, fabs(z[i]));
        if (!isfinite(f->z[i]))
            return error_set(err, ERROR_INPUT, "height %zu of the surface = %g is not finite", i,
                             z[i]);
        sum_add(&sum, f->z[i]);
    }
    double mean = sum_value(&sum) / (double)n, highest = -INFINITY;
    if (!isfinite(mean))
        return error_set(err, ERROR_INPUT,
                         "heights of the surface of up to %g: their sum is not finite", largest);
    for (size_t i = 0; i < n; i++) {
        f->z[i] -= mean;
        highest = fmax(highest, f->z[i]);
        sum_add(&square, f->z[i] * f->z[i]);
    }
    f->rms = sqrt(sum_value(&square) / (double)n);
    f->newton.flat_height = -highest;
    return 0;
}

static void lift(struct full *f) {
    f->load = 0;
    f->careful = f->newton.overhangs = false;
    f->newton.self.count = f->last.pairs = 0;
    f->newton.evaluated = false;
    memset(f->kept, 0, newton_unknowns(&f->newton) * sizeof *f->kept);
    memset(f->newton.u, 0, newton_unknowns(&f->newton) * sizeof *f->newton.u);
    for (size_t node = 0; node < f->mesh->face; node++)
        f->newton.active[node] = f->kept_active[node] = f->guess[node] = false;
}

int full_begin(struct full *f, const double *z, struct error *err) {
    int status = take_heights(f, z, err);
    if (status == 0)
        status = mesh_shape(f->mesh, f->z, err);
    if (status == 0)
        status = contact_begin(f->linear, z, err);
    lift(f);
    f->used = 0;
    return status;
}

/* --- load steps --- */

/* Predicts the active set at a load: the set of the last load, changed where the linear model's
 * contact changes between the two loads. Where the linear model fails, the last set is kept; it may
 * be stopped. */
static int predict(struct full *f, double load, struct error *err) {
    struct contact_state state;
    const int status = contact_press(f->linear, load, &state, err);
    const bool known = status == 0;
    if (status == ERROR_STOPPED)
        return status;
    for (size_t node = 0; node < f->mesh->face; node++) {
        f->touches[node] = known ? state.p[node] > 0 : f->guess[node];
        if (known && (f->load == 0 || f->touches[node] != f->guess[node]))
            f->newton.active[node] = f->touches[node];
    }
    return 0;
}

/* The state between loads has arrays of its own for what carries it through a whole series. */
static void state_take(struct full_state *state, const struct newton *n) {
    memcpy(state->u, n->u, newton_unknowns(n) * sizeof *n->u);
    memcpy(state->active, n->active, n->mesh->face * sizeof *n->active);
    state->pairs = n->self.count;
    memcpy(state->pair, n->self.pair, state->pairs * sizeof *state->pair);
}

static void state_give(const struct full_state *state, struct newton *n) {
    n->evaluated = false;
    memcpy(n->u, state->u, newton_unknowns(n) * sizeof *n->u);
    memcpy(n->active, state->active, n->mesh->face * sizeof *n->active);
    n->self.count = state->pairs;
    memcpy(n->self.pair, state->pair, state->pairs * sizeof *state->pair);
}

static void keep(struct full *f, double load) {
    size_t face = f->mesh->face;
    f->load = load;
    memcpy(f->kept, f->newton.u, newton_unknowns(&f->newton) * sizeof *f->kept);
    memcpy(f->kept_active, f->newton.active, face * sizeof *f->kept_active);
    if (f->careful)
        state_take(&f->last, &f->newton);
    else
        memcpy(f->guess, f->touches, face * sizeof *f->guess);
}

static void restore(struct full *f) {
    if (f->careful) {
        state_give(&f->last, &f->newton);
        return;
    }
    f->newton.evaluated = false;
    memcpy(f->newton.u, f->kept, newton_unknowns(&f->newton) * sizeof *f->kept);
    memcpy(f->newton.active, f->kept_active, f->mesh->face * sizeof *f->kept_active);
}

static void count_work(struct full *f, const struct newton_end *end, struct full_report *report) {
    report->newton += end->iterations;
    report->linear += end->linear;
    report->factored += end->factored;
    report->changes += end->changes;
    report->cycles += end->cycles;
    f->used += full_limit_count(&f->options.limit, end->iterations, end->linear, end->factored);
}

/* What load steps work on. */
struct loading {
    struct full *full;
    struct newton_end *end;
    struct full_report *report;
};

/* Solves within what is left of the limit; *change is face_stretch_change from `before`. An
 * equilibrium that changed by more than FACE_CHANGE_MOST is refused, because the face may have
 * reached it only by folding. */
static int solve(const struct loading *loading, double load, const double *before, double *change,
                 struct error *err) {
    struct full *f = loading->full;
    f->newton.limit = full_limit_left(&f->options.limit, f->used);
    int status = newton_solve(&f->newton, load, loading->end, err);
    count_work(f, loading->end, loading->report);
    *change = status == 0 ? face_stretch_change(f->mesh, f->newton.u, before) : 0;
    if (*change > FACE_CHANGE_MOST)
        status = error_set(err, ERROR_NUMERIC, "the face jumps, by %.2g of a cell", *change);
    return status;
}

static int step_to(void *solver, double load, double *change, struct error *err) {
    const struct loading *loading = solver;
    struct full *f = loading->full;
    int status = f->careful ? 0 : predict(f, load, err);
    *change = 0;
    if (status == 0)
        status = solve(loading, load, f->kept, change, err);
    if (status != 0)
        restore(f);
    else {
        keep(f, load);
        loading->report->steps++;
    }
    return status;
}

static int drag(void *solver, double load, double drag, double tolerance, struct dragged *out,
                struct error *err) {
    const struct loading *loading = solver;
    struct full *f = loading->full;
    struct newton *n = &f->newton;
    double usual = n->tolerance;
    size_t most = n->max_iterations;
    n->max_iterations = n->self.count > 0 ? ROUND_MOST_MET : ROUND_MOST;
    n->drag = drag;
    n->tolerance = tolerance;
    n->evaluated = false;
    int status = solve(loading, load, f->held.u, &out->change, err);
    n->tolerance = usual;
    n->max_iterations = most;
    out->force = mesh_largest_move(f->mesh, n->u, n->anchor) * drag / (load * newton_node_area(n));
    return status;
}

static void hold(void *solver) {
    struct full *f = ((const struct loading *)solver)->full;
    state_take(&f->held, &f->newton);
    memcpy(f->newton.anchor, f->held.u, mesh_degrees_of_freedom(f->mesh) * sizeof *f->held.u);
}

static void fall(void *solver) {
    struct full *f = ((const struct loading *)solver)->full;
    state_give(&f->held, &f->newton);
}

static void leave(void *solver) {
    restore(((const struct loading *)solver)->full);
}

static void land(void *solver, double load, bool rests) {
    const struct loading *loading = solver;
    loading->full->newton.drag = 0;
    if (!rests)
        restore(loading->full);
    else {
        (void)newton_evaluate(&loading->full->newton); /* without drag, and no element turns */
        keep(loading->full, load);
        loading->report->steps++;
    }
}

static bool is_used_up(const struct full *f) {
    return f->options.limit.seconds > 0 && f->used > f->options.limit.seconds;
}

static int check(void *solver, struct error *err) {
    const struct loading *loading = solver;
    if (is_used_up(loading->full))
        return error_set(err, ERROR_NUMERIC, "the time limit of %g s was used up",
                         loading->full->options.limit.seconds);
    if (loading->full->careful && loading->report->newton > CAREFUL_NEWTON_MOST)
        return error_set(err, ERROR_NUMERIC, "%zu iterations of Newton's were too few",
                         loading->report->newton);
    return 0;
}

static int raise_load(const struct loading *loading, double goal, struct error *err) {
    static const struct load_solver SOLVER = {step_to, check, drag, hold, fall, leave, land};
    struct full *f = loading->full;
    const bool hasty = f->careful && f->mesh->dimension == 2;
    f->newton.max_iterations = load_steps_iterations(hasty, f->options.max_iterations);
    struct load_steps steps = {.by = &SOLVER,
                               .solver = (void *)loading,
                               .least_step = f->options.least_step,
                               .tolerance = f->options.tolerance,
                               .careful = f->careful};
    int status = load_steps_follow(&steps, f->load, goal, err);
    loading->report->cuts += steps.cuts;
    loading->report->jumps += steps.jumps;
    if (status == ERROR_NUMERIC && is_used_up(f))
        return error_context(err,
                             "contact on the true geometry under a mean pressure of %g E* was "
                             "reached up to %g E* only",
                             goal, f->load);
    if (status == ERROR_NUMERIC)
        return error_context(err,
                             "contact on the true geometry under a mean pressure of %g E* was "
                             "reached up to %g E* only (steepest slope %.3g, worst element "
                             "%.2g); the next step of %.2g E* failed",
                             goal, f->load, f->mesh->slope, f->mesh->quality, steps.failed);
    return status;
}

static int state_create(struct full_state *state, const struct newton *n, struct error *err) {
    if (state->u != NULL)
        return 0;
    state->u = array_create(newton_unknowns(n), sizeof *state->u);
    state->active = array_create(n->mesh->face, sizeof *state->active);
    state->pair = array_create(self_pairs_most(n->mesh), sizeof *state->pair);
    if (state->u != NULL && state->active != NULL && state->pair != NULL)
        return 0;
    state_clear(state);
    return error_memory(err, newton_unknowns(n) * sizeof *state->u, "finite elements");
}

/* Allows overhangs and jumps from the last load on. */
static int become_careful(struct full *f, struct error *err) {
    int status = newton_allow_overhangs(&f->newton, err);
    if (status == 0)
        status = state_create(&f->last, &f->newton, err);
    if (status == 0)
        status = state_create(&f->held, &f->newton, err);
    if (status != 0) {
        f->newton.overhangs = false;
        return status;
    }
    state_take(&f->last, &f->newton);
    f->careful = true;
    return 0;
}

/* Goes on carefully where the usual steps end; where the face has too many nodes for that, err is
 * that of the steps. */
static int reach_load(struct full *f, double goal, struct newton_end *end,
                      struct full_report *report, struct error *err) {
    struct loading loading = {f, end, report};
    struct error why = {0};
    int status = raise_load(&loading, goal, err);
    bool refused = f->careful || f->flat_only || f->options.kinematics == KINEMATICS_SMALL;
    if (status != ERROR_NUMERIC || refused || is_used_up(f))
        return status;
    int able = become_careful(f, &why);
    if (able == ERROR_INPUT)
        return status;
    if (able != 0)
        return error_set(err, able, "%s", why.text);
    return raise_load(&loading, goal, err);
}

/* --- results --- */

static double deepest_node(const struct full *f) {
    double deepest = 0;
    for (size_t node = 0; node < f->mesh->face; node++)
        deepest = fmax(deepest, -f->newton.gap[node]);
    return deepest;
}

/* Returns the length over which violations are reported. */
static double height_scale(const struct full *f) {
    return f->rms > 0 ? f->rms : 1;
}

static void fill_report(struct full *f, const struct newton_end *end,
                        const struct contact_state *state, struct full_report *report) {
    struct sum force = {0};
    for (size_t node = 0; node < f->mesh->face; node++)
        sum_add(&force, f->pressure[node]);
    report->kinematics = f->options.kinematics;
    report->reached = state->pressure;
    report->balance =
        state->pressure > 0 ? sum_value(&force) / (double)f->mesh->face / state->pressure - 1 : 0;
    report->residual = end->residual;
    report->penetration = deepest_node(f) / height_scale(f);
    report->weighted_penetration = state->penetration;
    report->stretch = face_contact_stretch(f->mesh, f->newton.u, f->newton.active);
    report->open_stretch = face_open_stretch(f->mesh, state->nodes, report->stretch);
    if (f->options.current_areas) {
        struct face_tilt tilt = face_measure_tilt(f->mesh, f->newton.u, f->newton.active);
        report->face_tilt = tilt.face;
        report->contact_tilt = state->nodes > 0 ? tilt.contact : 0;
    }
    if (f->newton.overhangs)
        report->self = self_contact_measure(&f->newton.self, f->newton.u, f->newton.active);
    report->slope = f->mesh->slope;
    report->quality = f->mesh->quality;
    report->unchanged = end->unchanged;
    memcpy(report->history, end->history, sizeof report->history);
}

double full_mean_gap(const struct full_options *options, const struct mesh *mesh, const double *u,
                     const bool *touches, const double *columns, double *gap) {
    const bool deforms = options->kinematics != KINEMATICS_SMALL;
    if (!options->current_areas && !options->normal_gaps)
        return face_mean_gap(mesh, deforms ? u : NULL, columns) * mesh->unit;
    if (options->normal_gaps)
        face_turn_gaps(mesh, u, touches, gap);
    return options->current_areas ? face_mean_gap_current(mesh, u, gap)
                                  : face_mean_gap(mesh, u, gap);
}

static int fill_state(struct full *f, const struct newton_end *end, struct contact_state *out,
                      struct error *err) {
    struct newton *n = &f->newton;
    size_t face = f->mesh->face;
    newton_measure_gaps(n);
    for (size_t node = 0; node < face; node++) {
        double force = n->force[mesh_vertical(f->mesh, node)];
        f->gap[node] = n->gap[node] * f->mesh->unit;
        f->opening[node] = n->opening[node] * f->mesh->unit;
        /* A node whose force is 0 within the tolerance is still in contact, which callers recognise
         * by p > 0. */
        f->pressure[node] = n->active[node] ? fmax(DBL_MIN, force / newton_node_area(n)) : 0;
        out->nodes += n->active[node];
    }
    double compliance = 0;
    if (f->options.normal_gaps && face_folds(f->mesh, n->u))
        return error_set(err, ERROR_NUMERIC,
                         "the face overhangs under a mean pressure of %g E*: its normals do not "
                         "all meet the flat, and gaps along them are none",
                         out->pressure);
    out->mean_gap = full_mean_gap(&f->options, f->mesh, n->u, n->active, n->gap, f->gap);
    out->approach = out->unload_stiffness = NAN;
    out->penetration = end->penetration / height_scale(f);
    out->violation = fmax(end->inside, end->penetration) / height_scale(f);
    out->stiffness = out->nodes == face ? INFINITY : 0;
    if (out->nodes == 0 || out->nodes == face)
        return 0;
    f->newton.limit = (struct full_limit){0};
    int status = newton_compliance(&f->newton, &compliance, f->tangent, err);
    if (status == ERROR_NUMERIC)
        error_context(err,
                      "the stiffness of contact on the true geometry under a mean pressure of %g "
                      "E*, which was reached, was not found",
                      out->pressure);
    if (status == 0 && !(compliance > 0)) /* as of St. Venant's law under compression */
        status = error_set(err, ERROR_NUMERIC,
                           "contact on the true geometry was reached up to a mean pressure of %g "
                           "E*, where it is unstable: deeper it carries less",
                           out->pressure);
    out->tangent = status == 0 ? f->tangent : NULL;
    out->stiffness = 1 / (compliance * f->mesh->unit);
    return status;
}

int full_press(struct full *f, double pressure, struct contact_state *out,
               struct full_report *report, struct error *err) {
    if (!(pressure >= 0 && isfinite(pressure)))
        return error_set(err, ERROR_INPUT, "mean pressure = %g; allowed: 0 or more, finite",
                         pressure);
    struct contact_state state = {
        .pressure = pressure, .p = f->pressure, .gap = f->gap, .opening = f->opening};
    struct full_report full_report = {0};
    struct newton_end end = {0};
    int status = 0;
    if (pressure == 0)
        lift(f);
    else
        status = reach_load(f, pressure, &end, &full_report, err);
    if (status == 0)
        status = fill_state(f, &end, &state, err);
    full_report.reached = f->load;
    if (status == 0) {
        fill_report(f, &end, &state, &full_report);
        state.iterations = full_report.newton;
        state.work = (double)full_report.newton * (double)mesh_degrees_of_freedom(f->mesh);
        *out = state;
    }
    if (report != NULL)
        *report = full_report;
    return status;
}

const struct newton *full_newton(const struct full *f) {
    return &f->newton;
}

const struct mesh *full_mesh(const struct full *f) {
    return f->mesh;
}

const double *full_displacement(struct full *f) {
    for (size_t i = 0; i < mesh_degrees_of_freedom(f->mesh); i++)
        f->displacement[i] = f->newton.u[i] * f->mesh->unit;
    return f->displacement;
}
