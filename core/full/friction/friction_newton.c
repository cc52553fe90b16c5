#include "core/full/friction/friction_newton.h"
#include "core/full/face.h"
#include "core/full/rounds.h"
#include "core/full/set_history.h"
#include "core/sum.h"
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

/* Residuals at which iterations of the linear equations end, at most. */
static const double LINEAR_MOST = 1e-3;
/* A direction that has so much across the axis of the drive. */
static const double TURNED = 0.1;

static int arrays_create(struct friction_newton *n, struct error *err) {
    const size_t unknowns = n->unknowns, face = n->mesh->face;
    const size_t linear =
        n->gmres != NULL ? gmres_friction_unknowns(n->gmres) : mesh_degrees_of_freedom(n->mesh) + 2;
    struct {
        double **array;
        size_t count;
    } const arrays[] = {{&n->u, unknowns},
                        {&n->force, unknowns},
                        {&n->before, unknowns},
                        {&n->change, unknowns},
                        {&n->step, linear},
                        {&n->reference, face * n->sideways},
                        {&n->direction, face * n->sideways},
                        {&n->turn, face},
                        {&n->gap, face},
                        {&n->opening, face}};
    for (size_t a = 0; a < sizeof arrays / sizeof *arrays; a++) {
        *arrays[a].array = array_create(arrays[a].count, sizeof(double));
        if (*arrays[a].array == NULL)
            return error_memory(err, arrays[a].count * sizeof(double), "contact with friction");
    }
    n->conditions.direction = n->direction;
    n->conditions.turn = n->turn;
    n->conditions.node = n->node = array_create(face, sizeof *n->node);
    n->touches = array_create(face, sizeof *n->touches);
    return n->node != NULL && n->touches != NULL ? 0
                                                 : error_memory(err, face, "contact with friction");
}

int friction_newton_create(struct friction_newton *out, const struct mesh *mesh,
                           const struct material *material, enum gap_weighting weighting,
                           double friction, struct gmres *gmres, struct error *err) {
    bool pressures = gmres_needs_pressures(material);
    *out = (struct friction_newton){
        .mesh = mesh,
        .material = *material,
        .unknowns = mesh_unknowns(mesh, pressures),
        .sideways = (size_t)mesh->dimension - 1,
        .gmres = mesh->dimension == 3 ? gmres : NULL,
        .conditions = {.friction = friction, .stiffness = COMPLEMENTARITY, .weighting = weighting}};
    friction_newton_drive(out, (struct drive){.flat = 1});
    int status = out->gmres != NULL ? gmres_add_friction(gmres, weighting, err)
                                    : unsymmetric_create(&out->lu, mesh, err);
    if (status == 0)
        status = tangent_create(&out->tangent, mesh, material, pressures, err);
    if (status == 0)
        status = arrays_create(out, err);
    if (status != 0)
        friction_newton_clear(out);
    return status;
}

void friction_newton_clear(struct friction_newton *n) {
    double *const arrays[] = {n->u,         n->force, n->before,  n->change,    n->step,
                              n->reference, n->gap,   n->opening, n->direction, n->turn};
    for (size_t a = 0; a < sizeof arrays / sizeof *arrays; a++)
        free(arrays[a]);
    free(n->node);
    free(n->touches);
    free(n->anchor);
    self_contact_clear(&n->self);
    tangent_destroy(&n->tangent);
    unsymmetric_destroy(&n->lu);
    *n = (struct friction_newton){0};
}

int friction_newton_allow_overhangs(struct friction_newton *n, struct error *err) {
    size_t count = mesh_degrees_of_freedom(n->mesh);
    if (n->anchor == NULL)
        n->anchor = array_create(count, sizeof *n->anchor);
    if (n->anchor == NULL)
        return error_memory(err, count * sizeof *n->anchor, "displacements");
    int status = n->gmres != NULL ? gmres_lengthen(n->gmres, err) : 0;
    if (status == 0 && n->self.pair == NULL)
        status = self_contact_create(&n->self, n->mesh, err);
    if (status == 0)
        status = self_contact_add_friction(&n->self, n->conditions.friction, err);
    n->overhangs = status == 0;
    return status;
}

void friction_newton_drive(struct friction_newton *n, struct drive drive) {
    for (size_t k = 0; k < SIDEWAYS_MOST; k++)
        n->conditions.drive[k] = k == n->axis ? drive : (struct drive){.shear = 1};
}

/* The weighted gaps of a profile. */
static void weigh(struct friction_newton *n) {
    size_t face = n->mesh->face;
    double beside = n->conditions.weighting == GAP_STANDARD ? 1.0 / 6 : 0;
    for (size_t node = 0; node < face; node++)
        n->opening[node] = (1 - 2 * beside) * n->gap[node] +
                           beside * (n->gap[(node + face - 1) % face] + n->gap[(node + 1) % face]);
}

void friction_newton_measure_gaps(struct friction_newton *n) {
    for (size_t node = 0; node < n->mesh->face; node++)
        n->gap[node] = n->mesh->height[node] + n->u[mesh_vertical(n->mesh, node)] - n->flat_height;
    if (n->gmres != NULL)
        gmres_weigh(n->gmres, n->gap, n->opening);
    else
        weigh(n);
}

/* Returns the index of a node's displacement or force along an axis of the face. */
static size_t along(const struct friction_newton *n, size_t node, size_t axis) {
    return node * (n->sideways + 1) + axis;
}

double friction_newton_slip(const struct friction_newton *n, size_t node, size_t axis) {
    return n->u[along(n, node, axis)] - n->flat[axis] - n->reference[node * n->sideways + axis];
}

static double slip_size(const struct friction_newton *n, size_t node) {
    double across = n->sideways > 1 ? friction_newton_slip(n, node, 1) : 0;
    return hypot(friction_newton_slip(n, node, 0), across);
}

static double pressing(const struct friction_newton *n, size_t node) {
    return n->force[mesh_vertical(n->mesh, node)];
}

static double gap_rounding(const struct friction_newton *n) {
    double flat = fmax(fabs(n->flat[0]), fabs(n->flat[1]));
    return rounds_gap(fmax(fabs(n->flat_height), flat));
}
static double force_rounding(const struct friction_newton *n) {
    return rounds_force(gap_rounding(n), &n->material, n->mesh->across);
}

/* --- what nodes do --- */

/* What a node does next, forward for any direction, and the force by which what it does contradicts
 * its forces, gap and slip. */
struct verdict {
    enum face_node next;
    double wrong;
};

/* The force along the face that a node would have, if what it slipped were undone: q - c w. */
struct trial {
    double of[SIDEWAYS_MOST], size;
};

static struct trial try_node(const struct friction_newton *n, size_t node) {
    struct trial trial = {.size = 0};
    for (size_t k = 0; k < n->sideways; k++)
        trial.of[k] =
            n->force[along(n, node, k)] - COMPLEMENTARITY * friction_newton_slip(n, node, k);
    trial.size = hypot(trial.of[0], trial.of[1]);
    return trial;
}

/* Makes a node slide in the direction of its trial. */
static void point(struct friction_newton *n, size_t node, const struct trial *trial) {
    double *e = n->direction + node * n->sideways;
    double friction = n->conditions.friction * fmax(0, pressing(n, node));
    for (size_t k = 0; k < n->sideways; k++)
        e[k] = trial->size > 0 ? trial->of[k] / trial->size : k == n->axis ? -1 : 0;
    n->turn[node] = trial->size > friction ? friction / trial->size : 1;
    n->node[node] = e[0] > 0 ? NODE_FORWARD : NODE_BACKWARD;
}

/* Returns what a trial has in a sliding node's direction. */
static double forward(const struct friction_newton *n, size_t node, const struct trial *trial) {
    double sum = 0;
    for (size_t k = 0; k < n->sideways; k++)
        sum += n->direction[node * n->sideways + k] * trial->of[k];
    return sum;
}

/* Lets the directions of sliding nodes follow their trials. One that turns back keeps its own, by
 * which it is judged. */
static void follow_directions(struct friction_newton *n) {
    for (size_t node = 0; node < n->mesh->face; node++) {
        if (!face_node_slides(n->node[node]))
            continue;
        struct trial trial = try_node(n, node);
        if (forward(n, node, &trial) > 0)
            point(n, node, &trial);
    }
}

static struct verdict judge(const struct friction_newton *n, size_t node) {
    enum face_node does = n->node[node];
    struct trial trial = try_node(n, node);
    double normal = pressing(n, node) - COMPLEMENTARITY * n->opening[node];
    double bound = n->conditions.friction * fmax(0, normal);
    switch (does) {
    case NODE_FREE:
        return (struct verdict){trial.size < bound ? NODE_STICKS : NODE_FORWARD,
                                -COMPLEMENTARITY * n->opening[node]};
    case NODE_STICKS:
        if (normal <= 0 && -normal >= trial.size - bound)
            return (struct verdict){NODE_FREE, -normal};
        return (struct verdict){NODE_FORWARD, trial.size - bound};
    case NODE_FORWARD:
    case NODE_BACKWARD:
        break;
    }
    double lack = bound - forward(n, node, &trial);
    return -normal > fmax(0, lack) ? (struct verdict){NODE_FREE, -normal}
                                   : (struct verdict){NODE_STICKS, lack};
}

/* A node that begins to slide does so in the direction of its trial. */
static void change(struct friction_newton *n, size_t node, enum face_node next) {
    struct trial trial = try_node(n, node);
    n->node[node] = (unsigned char)next;
    if (face_node_slides(next))
        point(n, node, &trial);
}

/* Makes the nearest node stick when none touches, because some node must carry the load. */
static void fill_contact(struct friction_newton *n) {
    size_t nearest = 0;
    for (size_t node = 0; node < n->mesh->face; node++) {
        if (n->node[node] != NODE_FREE)
            return;
        if (n->opening[node] < n->opening[nearest])
            nearest = node;
    }
    n->node[nearest] = NODE_STICKS;
}

/* The part of a sliding node's pressure that its traction along an axis is. */
static double sliding_share(const struct friction_newton *n, size_t node, size_t axis) {
    return n->conditions.friction * n->direction[node * n->sideways + axis];
}

/* Returns whether a sliding node holds the flat along its axis, as its direction turns. */
static bool turns(const struct friction_newton *n, size_t node) {
    return face_node_slides(n->node[node]) && n->sideways > 1 &&
           fabs(n->direction[node * n->sideways + 1 - n->axis]) > TURNED;
}

/* Where a given shear leaves no node sticking, and none turns, the flat follows the excess of the
 * sliding nodes' tractions until one of those in its direction stops: makes the one that slid least
 * stick. */
static void fill_sticking(struct friction_newton *n) {
    struct trial excess = {.of = {-n->shear[0], -n->shear[1]}};
    double shortest = INFINITY;
    size_t held = SIZE_MAX;
    for (size_t node = 0; node < n->mesh->face; node++) {
        if (n->node[node] == NODE_STICKS || turns(n, node) ||
            n->conditions.drive[n->axis].flat != 0)
            return;
        for (size_t k = 0; n->node[node] != NODE_FREE && k < n->sideways && k < SIDEWAYS_MOST; k++)
            excess.of[k] += sliding_share(n, node, k) * pressing(n, node);
    }
    for (size_t node = 0; node < n->mesh->face; node++) {
        double slid = slip_size(n, node);
        if (n->node[node] != NODE_FREE && forward(n, node, &excess) > 0 && slid < shortest) {
            shortest = slid;
            held = node;
        }
    }
    if (held < SIZE_MAX)
        n->node[held] = NODE_STICKS;
}

/* Changes all nodes that contradict their forces by more than `least`, or the worst one alone.
 * Returns their number. */
static size_t update(struct friction_newton *n, double least, bool one) {
    struct verdict worst = {.wrong = least};
    size_t changes = 0, which = 0;
    for (size_t node = 0; node < n->mesh->face; node++) {
        struct verdict verdict = judge(n, node);
        if (!(verdict.wrong > least))
            continue;
        changes++;
        if (verdict.wrong > worst.wrong) {
            worst = verdict;
            which = node;
        }
        if (!one)
            change(n, node, verdict.next);
    }
    if (one && changes > 0) {
        change(n, which, worst.next);
        changes = 1;
    }
    fill_contact(n);
    fill_sticking(n);
    return changes;
}

/* --- equilibrium --- */

/* Turns forces x, outer less inner, into the right side of the equations of the nodes in contact:
 * where displacements are prescribed, `gap` says whether they are, or 0. */
static void face_rows(const struct friction_newton *n, bool gap, double *x) {
    for (size_t node = 0; node < n->mesh->face; node++) {
        double *row = x + along(n, node, 0);
        if (n->node[node] == NODE_FREE)
            continue;
        for (size_t k = 0; k < n->sideways; k++)
            if (n->node[node] == NODE_STICKS)
                row[k] = gap ? -friction_newton_slip(n, node, k) : 0;
            else
                row[k] -= sliding_share(n, node, k) * row[n->sideways];
        row[n->sideways] = gap ? -n->opening[node] : 0;
    }
}

/* Adds the outer forces on the far side to x, and sums its vertical rows in that of its first
 * node. */
static void far_rows(const struct friction_newton *n, double pressure, double *x) {
    const struct mesh *mesh = n->mesh;
    size_t first = mesh_far_side(mesh);
    double nodes = (double)(mesh->nodes - first);
    struct sum vertical = {0};
    sum_add(&vertical, -pressure * mesh->across * (double)mesh->face);
    for (size_t node = first; node < mesh->nodes; node++) {
        for (size_t k = 0; k < n->sideways; k++)
            x[along(n, node, k)] -= n->shear[k] / nodes;
        sum_add(&vertical, x[mesh_vertical(mesh, node)]);
        x[mesh_vertical(mesh, node)] = 0;
    }
    x[mesh_vertical(mesh, first)] = sum_value(&vertical);
}

static double far_mean(const struct friction_newton *n, size_t axis) {
    size_t first = mesh_far_side(n->mesh);
    struct sum sum = {0};
    for (size_t node = first; node < n->mesh->nodes; node++)
        sum_add(&sum, n->u[along(n, node, axis)]);
    return sum_value(&sum) / (double)(n->mesh->nodes - first);
}

static double drive_left(const struct friction_newton *n, const struct friction_goal *goal,
                         size_t axis) {
    const struct drive *drive = &n->conditions.drive[axis];
    return (axis == n->axis ? goal->drive : 0) - drive->flat * n->flat[axis] -
           drive->shear * n->shear[axis];
}

/* Returns the largest out-of-balance force, and that of sliding nodes' friction. */
static double residual(struct friction_newton *n, const struct friction_goal *goal) {
    double largest = 0;
    for (size_t f = 0; f < n->unknowns; f++)
        n->change[f] = -n->force[f];
    far_rows(n, goal->pressure, n->change);
    face_rows(n, false, n->change);
    for (size_t f = 0; f < n->unknowns; f++)
        largest = fmax(largest, fabs(n->change[f]));
    return largest;
}

/* What the flat and the shear change by. */
struct motion {
    double flat[SIDEWAYS_MOST], shear[SIDEWAYS_MOST];
};

static double used_by(const struct friction_newton *n, const struct friction_end *end) {
    return full_limit_count(&n->limit, end->iterations, end->work.iterations, end->work.factored);
}

/* Replaces the right side x by the solution. */
static int solve(struct friction_newton *n, double tolerance, double *x, struct friction_end *end,
                 struct error *err) {
    if (n->gmres != NULL) {
        const struct linear_system system = {.tangent = n->tangent,
                                             .friction = &n->conditions,
                                             .drag = n->drag,
                                             .lengthy = n->overhangs,
                                             .most = full_limit_linear(&n->limit, used_by(n, end)),
                                             .stop = n->stop,
                                             .context = n->context};
        return gmres_solve(n->gmres, &system, tolerance, x, &end->work.iterations, err);
    }
    int status = unsymmetric_set(n->lu, n->tangent, &n->conditions, err);
    return status == 0 ? unsymmetric_solve(n->lu, tolerance, x, &end->work, err) : status;
}

/* Sets what is driven to its goal, which iterations leave by their tolerance. */
static void meet_drives(const struct friction_newton *n, const struct friction_goal *goal,
                        struct motion *motion) {
    for (size_t k = 0; k < n->sideways; k++) {
        const struct drive *drive = &n->conditions.drive[k];
        if (drive->flat == 0)
            motion->shear[k] = drive_left(n, goal, k) / drive->shear;
        else if (drive->shear == 0)
            motion->flat[k] = drive_left(n, goal, k) / drive->flat;
    }
}

/* off: the present residual in the units of the tolerance; the next one will be about its square.
 * Replaces change by Newton's change of u. */
static int newton_step(struct friction_newton *n, const struct friction_goal *goal, double off,
                       struct motion *motion, struct friction_end *end, struct error *err) {
    double tolerance = fmin(fmax(LINEAR_PART * off, LINEAR_PART * n->tolerance / off), LINEAR_MOST);
    size_t degrees_of_freedom = mesh_degrees_of_freedom(n->mesh), sideways = n->sideways;
    bool eliminated = n->gmres == NULL && n->unknowns > degrees_of_freedom;
    size_t solved = eliminated ? degrees_of_freedom : n->unknowns;
    double *x = n->step, *behind = x + solved;
    for (size_t f = 0; f < n->unknowns; f++)
        n->change[f] = -n->force[f];
    memcpy(x, n->change, solved * sizeof *x);
    if (eliminated) {
        double *excess = n->change + degrees_of_freedom;
        volumetric_scale(n->tangent->volumetric, 1 / n->tangent->volumetric->row, excess, excess);
        volumetric_forces(n->tangent->volumetric, excess, -1, x);
    }
    far_rows(n, goal->pressure, x);
    face_rows(n, true, x);
    for (size_t k = 0; k < sideways; k++) {
        behind[k] = -far_mean(n, k);
        behind[sideways + k] = drive_left(n, goal, k);
    }
    int status = solve(n, tolerance, x, end, err);
    if (status != 0)
        return status;
    memcpy(n->change, x, solved * sizeof *x);
    if (eliminated)
        volumetric_pressures(n->tangent->volumetric, x, 1, n->change + degrees_of_freedom,
                             n->change + degrees_of_freedom);
    *motion = (struct motion){0};
    memcpy(motion->shear, behind, sideways * sizeof *behind);
    memcpy(motion->flat, behind + sideways, sideways * sizeof *behind);
    if (n->gmres != NULL)
        meet_drives(n, goal, motion);
    return 0;
}

bool friction_newton_evaluate(struct friction_newton *n) {
    n->evaluated = tangent_evaluate(n->mesh, &n->material, n->u, &n->energy, n->force, n->tangent);
    n->tangent->links = n->tangent->patches = n->tangent->rubbings = 0;
    if (n->evaluated && n->drag > 0)
        tangent_add_drag(n->tangent, n->drag, n->u, n->anchor, n->force);
    if (n->evaluated && n->overhangs)
        self_contact_evaluate(&n->self, false, n->u, n->force, n->tangent);
    return n->evaluated;
}

const bool *friction_newton_touching(struct friction_newton *n) {
    for (size_t node = 0; node < n->mesh->face; node++)
        n->touches[node] = n->node[node] != NODE_FREE;
    return n->touches;
}

/* Advances u, flat and shear by the longest of the step and its halves that neither folds the face
 * nor inverts an element. */
static int advance(struct friction_newton *n, const struct motion *motion, struct error *err) {
    struct motion before;
    double length =
        n->overhangs ? fmin(1, SELF_LONGEST / face_largest_move(n->mesh, n->change)) : 1;
    bool folds = false;
    memcpy(before.flat, n->flat, sizeof before.flat);
    memcpy(before.shear, n->shear, sizeof before.shear);
    memcpy(n->before, n->u, n->unknowns * sizeof *n->before);
    for (int halving = 0; halving < HALVINGS; halving++, length /= 2) {
        for (size_t f = 0; f < n->unknowns; f++)
            n->u[f] = n->before[f] + length * n->change[f];
        for (size_t k = 0; k < n->sideways; k++) {
            n->flat[k] = before.flat[k] + length * motion->flat[k];
            n->shear[k] = before.shear[k] + length * motion->shear[k];
        }
        folds = n->overhangs
                    ? self_contact_depth(&n->self, n->u, friction_newton_touching(n)) > SELF_DEEPEST
                    : face_folds(n->mesh, n->u);
        if (!folds && friction_newton_evaluate(n))
            return 0;
    }
    n->evaluated = false;
    return error_set(err, ERROR_NUMERIC,
                     folds ? "the face folds over itself in 1/%d of a step of Newton's"
                           : "an element is turned inside out in 1/%d of a step of Newton's",
                     1 << (HALVINGS - 1));
}

/* State of u at the beginning of an iteration. */
struct round {
    double largest; /* largest contact force, at least the mean force of a node */
    double residual, inside;
    double balanced, closed; /* residuals, and gaps and slips, below these count as 0 */
    size_t changes;          /* nodes that changed in this round */
    bool driven;             /* whether the drive is at its goal */
};

static void measure(const struct friction_newton *n, struct friction_end *end) {
    end->inside = 0;
    for (size_t node = 0; node < n->mesh->face; node++) {
        if (n->node[node] == NODE_FREE)
            continue;
        end->inside = fmax(end->inside, fabs(n->opening[node]));
        if (n->node[node] == NODE_STICKS)
            end->inside = fmax(end->inside, slip_size(n, node));
    }
}

/* Returns whether the flat and the shear are at their goals. */
static bool is_driven(const struct friction_newton *n, const struct friction_goal *goal,
                      const struct round *round) {
    bool driven = true;
    for (size_t k = 0; k < n->sideways; k++) {
        const struct drive *drive = &n->conditions.drive[k];
        driven = driven &&
                 fabs(drive_left(n, goal, k)) <=
                     fmax(fabs(drive->flat) * round->closed, fabs(drive->shear) * round->balanced);
    }
    return driven;
}

static struct round assess(struct friction_newton *n, const struct friction_goal *goal,
                           struct set_history *history, struct friction_end *end) {
    struct round round = {.largest = 0};
    bool first = end->iterations == 0, careful = end->cycles > 0;
    friction_newton_measure_gaps(n);
    follow_directions(n);
    round.largest = fmax(rounds_largest_force(n->mesh, n->force), goal->pressure * n->mesh->across);
    round.balanced = fmax(n->tolerance * round.largest, force_rounding(n));
    round.closed = fmax(n->tolerance * round.largest / COMPLEMENTARITY, gap_rounding(n));
    round.residual = residual(n, goal);
    if (!first && rounds_trust(round.residual, round.largest, careful))
        round.changes = update(n, round.balanced, careful);
    if (round.changes > 0) {
        round.residual = residual(n, goal);
        end->cycles += set_history_meets(history, n->mesh->face, n->node);
    }
    measure(n, end);
    round.inside = end->inside;
    round.driven = is_driven(n, goal, &round);
    end->residual = round.residual / round.largest;
    return round;
}

static int check_progress(const struct friction_newton *n, struct round_progress *progress,
                          double off, const struct round *round, const struct friction_end *end,
                          struct error *err) {
    bool ends =
        round_progress_ends(progress, off, round->changes > 0, end->iterations, n->max_iterations);
    if (end->cycles > RETURNS)
        return error_set(err, ERROR_NUMERIC,
                         "the sets of nodes that stick and slide come back, %zu times in %zu "
                         "iterations of Newton's; residual %.2g of the largest force",
                         end->cycles, end->iterations, end->residual);
    if (ends)
        return error_set(err, ERROR_NUMERIC,
                         "%zu iterations of Newton's left %.2g of the largest force, and gaps and "
                         "slips of %.2g columns",
                         end->iterations, end->residual, end->inside);
    if (n->limit.seconds > 0 && used_by(n, end) > n->limit.seconds)
        return error_set(err, ERROR_NUMERIC, "the time limit was used up");
    if (n->stop != NULL && n->stop(n->context) != 0)
        return error_set(err, ERROR_STOPPED, "stopped after %zu iterations of Newton's",
                         end->iterations);
    return 0;
}

/* Finds contact of the face with itself anew where it has balanced. */
static int renew(struct friction_newton *n, double largest, struct self_rounds *rounds,
                 struct error *err) {
    bool met;
    int status = self_contact_round(&n->self, n->u, friction_newton_touching(n), n->tolerance,
                                    largest, rounds, &met, err);
    if (status != 0 || !met || friction_newton_evaluate(n))
        return status;
    return error_set(err, ERROR_NUMERIC, "an element is turned inside out");
}

int friction_newton_solve(struct friction_newton *n, const struct friction_goal *goal,
                          struct friction_end *end, struct error *err) {
    struct set_history history = {0};
    struct round_progress progress = {.least = INFINITY};
    struct self_rounds rounds = {0};
    *end = (struct friction_end){0};
    double load = goal->pressure * n->mesh->across * (double)n->mesh->face;
    if (force_rounding(n) > ROUNDING_MOST * load)
        return error_set(err, ERROR_NUMERIC, "rounding makes forces up to %.2g of so light a load",
                         force_rounding(n) / load);
    if (!n->evaluated && n->overhangs)
        self_contact_search(&n->self, n->u, friction_newton_touching(n));
    if (!n->evaluated && !friction_newton_evaluate(n))
        return error_set(err, ERROR_NUMERIC, "an element is turned inside out at the start");
    friction_newton_measure_gaps(n);
    fill_contact(n);
    fill_sticking(n);
    (void)set_history_meets(&history, n->mesh->face, n->node);
    for (;;) {
        struct round round = assess(n, goal, &history, end);
        bool balanced = end->iterations > 0 && round.changes == 0 &&
                        round.residual <= round.balanced && round.inside <= round.closed &&
                        round.driven;
        if (balanced && (rounds.settled || !n->overhangs))
            return 0;
        rounds.settled = false;
        int status = balanced ? renew(n, round.largest, &rounds, err) : 0;
        if (status != 0)
            return status;
        if (balanced) {
            progress = (struct round_progress){.least = INFINITY, .begun = end->iterations};
            continue;
        }
        double off = fmax(end->residual, round.inside * COMPLEMENTARITY / round.largest);
        struct motion motion;
        status = check_progress(n, &progress, off, &round, end, err);
        if (status == 0)
            status = newton_step(n, goal, off, &motion, end, err);
        end->iterations++;
        if (status == 0)
            status = advance(n, &motion, err);
        if (status != 0)
            return status;
    }
}
