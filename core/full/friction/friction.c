#include "core/full/friction/friction.h"
#include "core/full/face.h"
#include "core/full/friction/friction_newton.h"
#include "core/full/load_steps.h"
#include "core/sum.h"
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* What a step starts from. Lengths in this file are in units of dx, the mesh's unit. */
struct point {
    double *u;           /* unknowns of friction_newton */
    double *traction;    /* [node * sideways + axis]: force along the face */
    unsigned char *node; /* enum face_node */
    double *direction;   /* of sliding nodes, as traction */
    double shear[SIDEWAYS_MOST], flat[SIDEWAYS_MOST], pressure;
    double work, dissipation; /* since the end of pressing */
    struct self_pair *pair;   /* of a face that meets itself, as newton.self has them; or NULL */
    size_t pairs;
};

struct friction {
    struct full_options options;
    double coefficient;
    size_t press_steps;
    struct full_limit limit;
    double used;           /* counted seconds since friction_press began */
    size_t face, sideways; /* nodes, and directions of the face */
    size_t axis;           /* of the drag */
    struct full *full;     /* owned, as all below: the contact without friction */
    const struct mesh *mesh;
    struct friction_newton newton;
    struct point kept; /* of the last step that converged */
    struct point held; /* during a jump; empty until the first one */
    bool pressed;
    bool careful;                 /* the face may overhang and jump, as in full.c */
    struct contact_state without; /* without friction, as the next: at the last pressure */
    struct friction_face face_without;
    double most; /* pressure that contact without friction reaches where it folds */
    double start_flat, start_sliding, start_far, start_energy; /* at the end of pressing */
    double *start; /* [node * sideways + axis]: displacement over the flat then */
    double *p, *gap, *opening, *over; /* by node of the face: results */
    double *q, *slip;                 /* [axis * face + node] */
    bool *sticks, *touches;           /* by node of the face */
};

static int options_check(const struct grid *grid, const struct friction_options *friction,
                         struct error *err) {
    if (friction->along_y && grid_is_profile(grid))
        return error_set(err, ERROR_INPUT, "a profile is dragged along x alone");
    if (!(friction->coefficient > 0 && isfinite(friction->coefficient)))
        return error_set(err, ERROR_INPUT, "friction = %g; allowed: above 0, finite",
                         friction->coefficient);
    return 0;
}

static int point_create(struct point *point, const struct friction *f, bool pairs,
                        struct error *err) {
    const size_t n = f->newton.unknowns, along = f->face * f->sideways;
    if (point->u == NULL) {
        point->u = array_create(n, sizeof *point->u);
        point->traction = array_create(along, sizeof *point->traction);
        point->direction = array_create(along, sizeof *point->direction);
        point->node = array_create(f->face, sizeof *point->node);
    }
    if (pairs && point->pair == NULL)
        point->pair = array_create(self_pairs_most(f->mesh), sizeof *point->pair);
    if (point->u != NULL && point->traction != NULL && point->direction != NULL &&
        point->node != NULL && (!pairs || point->pair != NULL))
        return 0;
    return error_memory(err, (n + 2 * along) * sizeof(double), "contact with friction");
}

static void point_clear(struct point *point) {
    free(point->u);
    free(point->traction);
    free(point->node);
    free(point->direction);
    free(point->pair);
    *point = (struct point){0};
}

static int arrays_create(struct friction *f, struct error *err) {
    struct {
        double **array;
        size_t count;
    } const arrays[] = {{&f->start, f->face * f->sideways},
                        {&f->p, f->face},
                        {&f->q, f->face * f->sideways},
                        {&f->gap, f->face},
                        {&f->opening, f->face},
                        {&f->over, f->face},
                        {&f->slip, f->face * f->sideways}};
    for (size_t a = 0; a < sizeof arrays / sizeof *arrays; a++) {
        *arrays[a].array = array_create(arrays[a].count, sizeof(double));
        if (*arrays[a].array == NULL)
            return error_memory(err, arrays[a].count * sizeof(double), "contact with friction");
    }
    f->sticks = array_create(f->face, sizeof *f->sticks);
    f->touches = array_create(f->face, sizeof *f->touches);
    if (f->sticks == NULL || f->touches == NULL)
        return error_memory(err, 2 * f->face, "contact with friction");
    return point_create(&f->kept, f, false, err);
}

int friction_create(struct friction **out, const struct grid *grid, const struct block *block,
                    const struct full_options *options, const struct friction_options *friction,
                    struct error *err) {
    *out = NULL;
    int status = options_check(grid, friction, err);
    if (status != 0)
        return status;
    struct friction *f = array_create(1, sizeof *f);
    if (f == NULL)
        return error_memory(err, sizeof *f, "contact with friction");
    *f = (struct friction){.options = *options,
                           .coefficient = friction->coefficient,
                           .press_steps = friction->press_steps,
                           .axis = friction->along_y ? 1 : 0,
                           .limit = friction->limit};
    struct material material = material_of(block->poisson, options->kinematics);
    status = full_create(&f->full, grid, block, options, err);
    if (status == 0) {
        f->mesh = full_mesh(f->full);
        f->face = f->mesh->face;
        f->sideways = (size_t)f->mesh->dimension - 1;
        status = friction_newton_create(&f->newton, f->mesh, &material, block->weighting,
                                        friction->coefficient, full_newton(f->full)->gmres, err);
    }
    if (status == 0)
        status = arrays_create(f, err);
    if (status != 0)
        friction_destroy(&f);
    else {
        f->newton.axis = f->axis;
        f->newton.tolerance = options->tolerance;
        f->newton.max_iterations = options->max_iterations;
    }
    *out = f;
    return status;
}

void friction_destroy(struct friction **friction) {
    struct friction *f = *friction;
    if (f == NULL)
        return;
    friction_newton_clear(&f->newton);
    full_destroy(&f->full);
    point_clear(&f->kept);
    point_clear(&f->held);
    free(f->p);
    free(f->q);
    free(f->gap);
    free(f->slip);
    free(f->opening);
    free(f->over);
    free(f->sticks);
    free(f->touches);
    free(f->start);
    free(f);
    *friction = NULL;
}

void friction_set_stop(struct friction *f, int (*stop)(void *context), void *context) {
    full_set_stop(f->full, stop, context);
    f->newton.stop = stop;
    f->newton.context = context;
}

int friction_begin(struct friction *f, const double *z, struct error *err) {
    f->pressed = false;
    int status = full_begin(f->full, z, err);
    if (status == 0)
        f->newton.flat_height = full_newton(f->full)->flat_height;
    return status;
}

/* --- steps --- */

/* Returns the index of a node's displacement or force along an axis of the face. */
static size_t along(const struct friction *f, size_t node, size_t axis) {
    return node * (f->sideways + 1) + axis;
}

/* Returns a node's displacement over the flat at a point, along an axis. */
static double over_flat(const struct friction *f, const struct point *point, size_t node,
                        size_t axis) {
    return point->u[along(f, node, axis)] - point->flat[axis];
}

static void take(const struct friction *f, struct point *point) {
    const struct friction_newton *n = &f->newton;
    memcpy(point->u, n->u, n->unknowns * sizeof *n->u);
    memcpy(point->node, n->node, f->face);
    memcpy(point->direction, n->direction, f->face * f->sideways * sizeof *n->direction);
    for (size_t node = 0; node < f->face; node++)
        for (size_t k = 0; k < f->sideways; k++)
            point->traction[node * f->sideways + k] = n->force[along(f, node, k)];
    memcpy(point->shear, n->shear, sizeof n->shear);
    memcpy(point->flat, n->flat, sizeof n->flat);
    point->pairs = n->self.count;
    if (point->pair != NULL)
        memcpy(point->pair, n->self.pair, point->pairs * sizeof *point->pair);
}

static void give(struct friction *f, const struct point *point) {
    struct friction_newton *n = &f->newton;
    memcpy(n->u, point->u, n->unknowns * sizeof *n->u);
    memcpy(n->node, point->node, f->face);
    memcpy(n->direction, point->direction, f->face * f->sideways * sizeof *n->direction);
    memcpy(n->shear, point->shear, sizeof n->shear);
    memcpy(n->flat, point->flat, sizeof n->flat);
    n->self.count = point->pairs;
    if (point->pair != NULL)
        memcpy(n->self.pair, point->pair, point->pairs * sizeof *point->pair);
    n->evaluated = false;
}

static void keep(struct friction *f, double pressure) {
    take(f, &f->kept);
    f->kept.pressure = pressure;
}

static void restore(struct friction *f) {
    give(f, &f->kept);
}

/* Slip counts from a point, at which the face is. */
static void settle(struct friction *f, const struct point *from) {
    for (size_t node = 0; node < f->face; node++)
        for (size_t k = 0; k < f->sideways; k++)
            f->newton.reference[node * f->sideways + k] = over_flat(f, from, node, k);
    self_contact_settle(&f->newton.self);
}

/* Fills what was worked and dissipated to the present state, after a step from a point. */
static void add_works(const struct friction *f, const struct point *from, struct point *to) {
    const struct friction_newton *n = &f->newton;
    struct sum slid = {0};
    for (size_t node = 0; node < f->face; node++)
        for (size_t k = 0; k < f->sideways; k++)
            sum_add(&slid, (n->force[along(f, node, k)] + from->traction[node * f->sideways + k]) /
                               2 * friction_newton_slip(n, node, k));
    to->dissipation = from->dissipation - sum_value(&slid);
    if (n->self.count > 0)
        to->dissipation += self_contact_dissipation(&n->self);
    double work = from->work;
    for (size_t k = 0; k < f->sideways; k++)
        work += (n->shear[k] + from->shear[k]) / 2 * (n->flat[k] - from->flat[k]);
    to->work = work;
}

/* Measures the face around some of its nodes. Areas of the flat grid are counts; others are with
 * their slopes, over that of the face. */
static struct friction_face measure_face(const struct friction *f, const double *u,
                                         const bool *active) {
    size_t nodes = 0;
    for (size_t node = 0; node < f->face; node++)
        nodes += active[node];
    struct friction_face out = {.area = (double)nodes / (double)f->face, .open_stretch = 1};
    if (!f->options.current_areas || nodes == 0)
        return out;
    const struct face_tilt tilt = face_measure_tilt(f->mesh, u, active);
    const double stretch = face_contact_stretch(f->mesh, u, active);
    out.area = out.area * stretch * (1 + tilt.contact) / (1 + tilt.face);
    out.tilt = tilt.face;
    out.open_stretch = face_open_stretch(f->mesh, nodes, stretch);
    return out;
}

/* Presses without friction, for what that is. */
static int press_full(struct friction *f, double pressure, struct friction_state *out,
                      struct error *err) {
    struct contact_state state;
    struct full_report report;
    if (pressure > f->most)
        return error_set(err, ERROR_NUMERIC,
                         "without friction the load was reached up to %g E* only", f->most);
    int status = full_press(f->full, pressure, &state, &report, err);
    out->newton += report.newton;
    if (status == ERROR_NUMERIC && full_newton(f->full)->overhangs)
        f->most = report.reached;
    if (status != 0)
        return status;
    const struct newton *without = full_newton(f->full);
    f->without = state;
    f->face_without = measure_face(f, without->u, without->active);
    return 0;
}

/* Takes the nodes in contact without friction under this pressure for a guess; from no contact the
 * displacements too. */
static int guess(struct friction *f, double pressure, struct friction_state *out,
                 struct error *err) {
    int status = press_full(f, pressure, out, err);
    if (status != 0)
        return status;
    const struct newton *without = full_newton(f->full);
    if (f->kept.pressure == 0) {
        memcpy(f->newton.u, without->u, f->newton.unknowns * sizeof(double));
        f->newton.evaluated = false;
    }
    for (size_t node = 0; node < f->face; node++) {
        enum face_node does = f->newton.node[node];
        if (!without->active[node])
            does = NODE_FREE;
        else if (does == NODE_FREE)
            does = NODE_STICKS;
        f->newton.node[node] = (unsigned char)does;
    }
    return 0;
}

/* What load steps work on: a step from a point to a goal, of which the load is the part done. */
struct following {
    struct friction *friction;
    struct friction_goal from, goal;
    struct friction_state *out;
};

static struct friction_goal goal_at(const struct following *way, double done) {
    struct friction_goal next = way->goal;
    if (done < 1) {
        next.pressure = way->from.pressure + done * (way->goal.pressure - way->from.pressure);
        next.drive = way->from.drive + done * (way->goal.drive - way->from.drive);
    }
    return next;
}

/* Solves within what is left of the limit. *change: of cells since a point. */
static int solve(const struct following *way, const struct friction_goal *goal,
                 const struct point *from, double *change, struct error *err) {
    struct friction *f = way->friction;
    struct friction_end end = {0};
    f->newton.limit = full_limit_left(&f->limit, f->used);
    int status = friction_newton_solve(&f->newton, goal, &end, err);
    f->used += full_limit_count(&f->limit, end.iterations, end.work.iterations, end.work.factored);
    way->out->newton += end.iterations;
    way->out->linear += end.work.iterations;
    way->out->factored += end.work.factored;
    way->out->residual = end.residual;
    *change = status == 0 ? face_stretch_change(f->mesh, f->newton.u, from->u) : 0;
    if (*change > FACE_CHANGE_MOST)
        status = error_set(err, ERROR_NUMERIC, "the face jumps, by %.2g of a cell", *change);
    return status;
}

static int step_to(void *solver, double done, double *change, struct error *err) {
    const struct following *way = solver;
    struct friction *f = way->friction;
    struct friction_goal goal = goal_at(way, done);
    *change = 0;
    settle(f, &f->kept);
    /* Where the face folds the last nodes are nearer than those without friction. */
    bool guesses = goal.pressure != f->kept.pressure && !f->careful;
    int status = guesses ? guess(f, goal.pressure, way->out, err) : 0;
    if (status == 0)
        status = solve(way, &goal, &f->kept, change, err);
    if (status != 0) {
        restore(f);
        return status;
    }
    add_works(f, &f->kept, &f->kept);
    keep(f, goal.pressure);
    way->out->steps++;
    return 0;
}

static int drag(void *solver, double done, double drag, double tolerance, struct dragged *out,
                struct error *err) {
    const struct following *way = solver;
    struct friction *f = way->friction;
    struct friction_newton *n = &f->newton;
    struct friction_goal goal = goal_at(way, done);
    double usual = n->tolerance;
    size_t most = n->max_iterations;
    n->max_iterations = n->self.count > 0 ? ROUND_MOST_MET : ROUND_MOST;
    n->drag = drag;
    n->tolerance = tolerance;
    n->evaluated = false;
    settle(f, &f->held);
    int status = solve(way, &goal, &f->held, &out->change, err);
    n->tolerance = usual;
    n->max_iterations = most;
    out->force =
        mesh_largest_move(f->mesh, n->u, n->anchor) * drag / (goal.pressure * f->mesh->across);
    if (status == 0)
        add_works(f, &f->held, &f->held);
    return status;
}

static void hold(void *solver) {
    struct friction *f = ((const struct following *)solver)->friction;
    take(f, &f->held);
    memcpy(f->newton.anchor, f->held.u, mesh_degrees_of_freedom(f->mesh) * sizeof *f->held.u);
}

static void fall(void *solver) {
    struct friction *f = ((const struct following *)solver)->friction;
    give(f, &f->held);
}

/* The forces of the last point are those of the held one. */
static void leave(void *solver) {
    struct friction *f = ((const struct following *)solver)->friction;
    restore(f);
    f->held.work = f->kept.work;
    f->held.dissipation = f->kept.dissipation;
    for (size_t node = 0; node < f->face; node++)
        for (size_t k = 0; k < f->sideways; k++)
            f->newton.force[along(f, node, k)] = f->kept.traction[node * f->sideways + k];
}

static void land(void *solver, double done, bool rests) {
    const struct following *way = solver;
    struct friction *f = way->friction;
    f->newton.drag = 0;
    if (!rests)
        restore(f);
    else {
        (void)friction_newton_evaluate(&f->newton); /* without drag, and no element turns */
        keep(f, goal_at(way, done).pressure);
        f->kept.work = f->held.work;
        f->kept.dissipation = f->held.dissipation;
        way->out->steps++;
    }
}

static double drive_now(const struct friction *f) {
    const struct drive *drive = f->newton.conditions.drive;
    return drive[f->axis].flat * f->kept.flat[f->axis] +
           drive[f->axis].shear * f->kept.shear[f->axis];
}

/* In squares of the mesh's unit; of profiles in units. */
static double face_area(const struct friction *f) {
    return (double)f->face * f->mesh->across;
}

static bool is_used_up(const struct friction *f) {
    return f->limit.seconds > 0 && f->used > f->limit.seconds;
}

/* Of surfaces as CAREFUL_NEWTON_MOST: an iteration takes tens of times as long as of profiles. */
enum { SURFACE_NEWTON_MOST = 2000 };

static int check(void *solver, struct error *err) {
    const struct following *way = solver;
    if (is_used_up(way->friction))
        return error_set(err, ERROR_NUMERIC, "the time limit of %g s was used up",
                         way->friction->limit.seconds);
    const bool surface = way->friction->mesh->dimension == 3;
    const size_t most = surface ? SURFACE_NEWTON_MOST : CAREFUL_NEWTON_MOST;
    if (way->friction->careful && way->out->newton > most)
        return error_set(err, ERROR_NUMERIC, "%zu iterations of Newton's were too few",
                         way->out->newton);
    return 0;
}

/* Goes from the last point to a goal, in one step or in smaller ones. */
static int follow_steps(struct friction *f, const struct friction_goal *goal,
                        struct friction_state *out, struct error *err) {
    static const struct load_solver SOLVER = {step_to, check, drag, hold, fall, leave, land};
    struct following way = {f, {f->kept.pressure, drive_now(f)}, *goal, out};
    f->newton.max_iterations = load_steps_iterations(f->careful, f->options.max_iterations);
    struct load_steps steps = {.by = &SOLVER,
                               .solver = &way,
                               .least_step = f->options.least_step,
                               .tolerance = f->options.tolerance,
                               .careful = f->careful};
    int status = load_steps_follow(&steps, 0, 1, err);
    out->cuts += steps.cuts;
    out->jumps += steps.jumps;
    if (status != ERROR_NUMERIC)
        return status;
    return error_context(err,
                         "contact with friction %g under a mean pressure of %g E* and a "
                         "traction of %g E* was followed over %.3g of a step only; the "
                         "next %.2g of it failed",
                         f->coefficient, f->kept.pressure, f->kept.shear[f->axis] / face_area(f),
                         steps.reached, steps.failed);
}

/* Allows overhangs and jumps from the last point on. */
static int become_careful(struct friction *f, struct error *err) {
    int status = friction_newton_allow_overhangs(&f->newton, err);
    if (status == 0)
        status = point_create(&f->kept, f, true, err);
    if (status == 0)
        status = point_create(&f->held, f, true, err);
    f->newton.overhangs = f->careful = status == 0;
    return status;
}

/* As follow_steps, and on carefully where the usual steps end. */
static int follow(struct friction *f, const struct friction_goal *goal, struct friction_state *out,
                  struct error *err) {
    int status = follow_steps(f, goal, out, err);
    bool refused = f->careful || f->options.kinematics == KINEMATICS_SMALL || is_used_up(f);
    if (status != ERROR_NUMERIC || refused)
        return status;
    status = become_careful(f, err);
    return status == 0 ? follow_steps(f, goal, out, err) : status;
}

/* --- results --- */

static double far_height(const struct friction *f) {
    return f->kept.u[mesh_vertical(f->mesh, mesh_far_side(f->mesh))];
}

/* Displacement of the flat over the mean of the face. */
static double flat_over_face(const struct friction *f) {
    struct sum sum = {0};
    for (size_t node = 0; node < f->face; node++)
        sum_add(&sum, f->kept.flat[f->axis] - f->kept.u[along(f, node, f->axis)]);
    return sum_value(&sum) / (double)f->face;
}

static void fill_nodes(struct friction *f, struct friction_state *out) {
    struct friction_newton *n = &f->newton;
    struct sum all = {0}, stuck = {0};
    friction_newton_measure_gaps(n);
    for (size_t node = 0; node < f->face; node++) {
        bool touches = n->node[node] != NODE_FREE, sticks = n->node[node] == NODE_STICKS;
        double force = n->force[mesh_vertical(f->mesh, node)] / f->mesh->across;
        /* As in full_press, callers recognise contact by p > 0. */
        f->p[node] = touches ? fmax(DBL_MIN, force) : 0;
        f->gap[node] = n->gap[node] * f->mesh->unit;
        f->opening[node] = n->opening[node] * f->mesh->unit;
        for (size_t k = 0; k < f->sideways; k++) {
            double slip = over_flat(f, &f->kept, node, k) - f->start[node * f->sideways + k];
            f->q[k * f->face + node] = touches ? n->force[along(f, node, k)] / f->mesh->across : 0;
            f->slip[k * f->face + node] = touches ? slip * f->mesh->unit : NAN;
            f->over[node] = k == f->axis ? slip * f->mesh->unit : f->over[node];
        }
        f->touches[node] = touches;
        f->sticks[node] = sticks;
        out->nodes += touches;
        out->stuck += sticks;
        sum_add(&all, f->p[node]);
        sum_add(&stuck, sticks ? f->p[node] : 0);
    }
    out->face = measure_face(f, n->u, f->touches);
    out->stick_area = f->options.current_areas
                          ? measure_face(f, n->u, f->sticks).area / out->face.area
                          : (double)out->stuck / (double)out->nodes;
    out->stick_load = sum_value(&stuck) / sum_value(&all);
}

static void fill_state(struct friction *f, struct friction_state *out) {
    const struct friction_newton *n = &f->newton;
    double by_area = f->mesh->unit / face_area(f);
    fill_nodes(f, out);
    out->pressure = f->kept.pressure;
    out->traction = f->kept.shear[f->axis] / face_area(f);
    out->p = f->p;
    out->q = f->q;
    out->gap = f->gap;
    out->opening = f->opening;
    out->over = f->over;
    out->sticks = f->sticks;
    out->slip = f->slip;
    out->q_across = f->sideways > 1 ? f->q + f->face : NULL;
    out->slip_across = f->sideways > 1 ? f->slip + f->face : NULL;
    out->without = &f->without;
    out->face_without = f->face_without;
    out->mean_gap = full_mean_gap(&f->options, f->mesh, n->u, f->touches, n->gap, f->gap);
    out->displacement = (f->kept.flat[f->axis] - f->start_flat) * f->mesh->unit;
    out->sliding = (flat_over_face(f) - f->start_sliding) * f->mesh->unit;
    out->work = f->kept.work * by_area;
    out->dissipation = f->kept.dissipation * by_area;
    out->energy = (n->energy - f->start_energy) * by_area;
    if (f->careful)
        out->self =
            self_contact_measure(&f->newton.self, n->u, friction_newton_touching(&f->newton));
    out->pressing_work = f->kept.pressure * (f->start_far - far_height(f)) * f->mesh->unit;
}

/* --- pressing and dragging --- */

/* The unloaded block. */
static void lift(struct friction *f) {
    struct friction_newton *n = &f->newton;
    memset(n->u, 0, n->unknowns * sizeof *n->u);
    memset(n->force, 0, n->unknowns * sizeof *n->force);
    memset(n->node, NODE_FREE, f->face);
    memset(n->shear, 0, sizeof n->shear);
    memset(n->flat, 0, sizeof n->flat);
    n->evaluated = n->overhangs = f->careful = false;
    n->self.count = 0;
    keep(f, 0);
}

/* Goes on from contact without friction: no node has slid, all stick. The flat and the far side's
 * mean are set to 0. */
static int press_without(struct friction *f, double pressure, struct friction_state *out,
                         struct error *err) {
    struct friction_newton *n = &f->newton;
    size_t first = mesh_far_side(f->mesh);
    int status = guess(f, pressure, out, err);
    if (status == 0 && full_newton(f->full)->overhangs)
        status = become_careful(f, err);
    if (status != 0)
        return status;
    for (size_t k = 0; k < f->sideways; k++) {
        struct sum sum = {0};
        for (size_t node = first; node < f->mesh->nodes; node++)
            sum_add(&sum, n->u[along(f, node, k)]);
        double mean = sum_value(&sum) / (double)(f->mesh->nodes - first);
        for (size_t node = 0; node < f->mesh->nodes; node++)
            n->u[along(f, node, k)] -= mean;
    }
    if (f->careful) {
        const struct self_contact *self = &full_newton(f->full)->self;
        n->self.count = self->count;
        memcpy(n->self.pair, self->pair, self->count * sizeof *self->pair);
    }
    if (!friction_newton_evaluate(n))
        return error_set(err, ERROR_NUMERIC,
                         "an element is turned inside out under a mean pressure of %g E*",
                         pressure);
    keep(f, pressure);
    return 0;
}

static int press_with(struct friction *f, double pressure, struct friction_state *out,
                      struct error *err) {
    int status = 0;
    friction_newton_drive(&f->newton, (struct drive){.shear = 1});
    for (size_t step = 1; status == 0 && step <= f->press_steps; step++) {
        double root = (double)step / (double)f->press_steps;
        struct friction_goal goal = {.pressure = pressure * root * root};
        status = follow(f, &goal, out, err);
    }
    return status == 0 && f->careful ? press_full(f, pressure, out, err) : status;
}

/* Where the face folds there are no gaps along its normals. */
static int folds_check(const struct friction *f, struct error *err) {
    if (!f->options.normal_gaps || !f->careful || !face_folds(f->mesh, f->newton.u))
        return 0;
    return error_set(
        err, ERROR_NUMERIC,
        "contact with friction %g under a mean pressure of %g E* was followed to where "
        "the face overhangs: its normals do not all meet the flat, and gaps along "
        "them are none",
        f->coefficient, f->kept.pressure);
}

int friction_press(struct friction *f, double pressure, struct friction_state *out,
                   struct error *err) {
    if (!(pressure > 0 && isfinite(pressure)))
        return error_set(err, ERROR_INPUT, "mean pressure = %g; allowed: above 0, finite",
                         pressure);
    struct friction_state state = {0};
    f->pressed = false;
    f->used = 0;
    f->most = INFINITY;
    if (f->newton.lu != NULL)
        unsymmetric_forget(f->newton.lu);
    lift(f);
    int status = f->press_steps > 0 ? press_with(f, pressure, &state, err)
                                    : press_without(f, pressure, &state, err);
    if (status == 0)
        status = folds_check(f, err);
    if (status != 0)
        return status;
    f->pressed = true;
    f->kept.work = f->kept.dissipation = 0;
    f->start_flat = f->kept.flat[f->axis];
    f->start_sliding = flat_over_face(f);
    f->start_far = far_height(f);
    f->start_energy = f->newton.energy;
    for (size_t node = 0; node < f->face; node++)
        for (size_t k = 0; k < f->sideways; k++)
            f->start[node * f->sideways + k] = over_flat(f, &f->kept, node, k);
    fill_state(f, &state);
    *out = state;
    return 0;
}

static int pressed_check(const struct friction *f, struct error *err) {
    return f->pressed ? 0
                      : error_set(err, ERROR_STATE, "a load along the face before friction_press");
}

static int move(struct friction *f, struct drive drive, double goal, struct friction_state *out,
                struct error *err) {
    struct friction_state state = {0};
    friction_newton_drive(&f->newton, drive);
    struct friction_goal end = {f->kept.pressure, goal};
    int status = follow(f, &end, &state, err);
    if (status == 0)
        status = folds_check(f, err);
    if (status != 0)
        return status;
    fill_state(f, &state);
    *out = state;
    return 0;
}

int friction_drag(struct friction *f, double displacement, struct friction_state *out,
                  struct error *err) {
    int status = pressed_check(f, err);
    if (status == 0 && !isfinite(displacement))
        status = error_set(err, ERROR_INPUT, "displacement = %g; allowed: finite", displacement);
    if (status != 0)
        return status;
    return move(f, (struct drive){.flat = 1}, f->start_flat + displacement / f->mesh->unit, out,
                err);
}

int friction_load(struct friction *f, double traction, struct friction_state *out,
                  struct error *err) {
    int status = pressed_check(f, err);
    if (status == 0 && !(fabs(traction) < f->coefficient * f->kept.pressure))
        status = error_set(err, ERROR_INPUT,
                           "mean traction = %g E*; allowed: between -%g and %g, friction times the "
                           "mean pressure",
                           traction, f->coefficient * f->kept.pressure,
                           f->coefficient * f->kept.pressure);
    if (status != 0)
        return status;
    return move(f, (struct drive){.shear = 1}, traction * face_area(f), out, err);
}
