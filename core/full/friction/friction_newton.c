#include "core/full/friction/friction_newton.h"
#include "core/full/face.h"
#include "core/full/set_history.h"
#include "core/sum.h"
#include <float.h>
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

/* As in newton.c: stiffness that weights gaps and slips against forces, residuals from which forces
 * may change the sets, and what ends the iteration. */
static const double COMPLEMENTARITY = 1;
static const double TRUSTED = 0.1, TRUSTED_ONE = 1e-4;
static const double LINEAR_MOST = 1e-3, LINEAR_PART = 0.1;
static const double ROUNDINGS = 8, ROUNDING_MOST = 0.01;
enum { HALVINGS = 8, PATIENCE = 10, RETURNS = 3 };

static int arrays_create(struct friction_newton *n, struct error *err) {
    const size_t unknowns = n->unknowns, face = n->mesh->face;
    struct {
        double **array;
        size_t count;
    } const arrays[] = {{&n->u, unknowns},
                        {&n->force, unknowns},
                        {&n->before, unknowns},
                        {&n->change, unknowns},
                        {&n->step, mesh_degrees_of_freedom(n->mesh) + 2},
                        {&n->reference, face},
                        {&n->gap, face},
                        {&n->opening, face}};
    for (size_t a = 0; a < sizeof arrays / sizeof *arrays; a++) {
        *arrays[a].array = array_create(arrays[a].count, sizeof(double));
        if (*arrays[a].array == NULL)
            return error_memory(err, arrays[a].count * sizeof(double), "contact with friction");
    }
    n->conditions.node = n->node = array_create(face, sizeof *n->node);
    return n->node != NULL ? 0 : error_memory(err, face, "contact with friction");
}

int friction_newton_create(struct friction_newton *out, const struct mesh *mesh,
                           const struct material *material, enum gap_weighting weighting,
                           double friction, struct error *err) {
    bool pressures = gmres_needs_pressures(material);
    *out = (struct friction_newton){
        .mesh = mesh,
        .material = *material,
        .unknowns = mesh_unknowns(mesh, pressures),
        .conditions = {.friction = friction, .weighting = weighting, .drive = {.flat = 1}}};
    int status = unsymmetric_create(&out->lu, mesh, err);
    if (status == 0)
        status = tangent_create(&out->tangent, mesh, material, pressures, err);
    if (status == 0)
        status = arrays_create(out, err);
    if (status != 0)
        friction_newton_clear(out);
    return status;
}

void friction_newton_clear(struct friction_newton *n) {
    double *const arrays[] = {n->u,    n->force,     n->before, n->change,
                              n->step, n->reference, n->gap,    n->opening};
    for (size_t a = 0; a < sizeof arrays / sizeof *arrays; a++)
        free(arrays[a]);
    free(n->node);
    tangent_destroy(&n->tangent);
    unsymmetric_destroy(&n->lu);
    *n = (struct friction_newton){0};
}

void friction_newton_measure_gaps(struct friction_newton *n) {
    size_t face = n->mesh->face;
    double beside = n->conditions.weighting == GAP_STANDARD ? 1.0 / 6 : 0;
    for (size_t node = 0; node < face; node++)
        n->gap[node] = n->mesh->height[node] + n->u[mesh_vertical(n->mesh, node)] - n->flat_height;
    for (size_t node = 0; node < face; node++)
        n->opening[node] = (1 - 2 * beside) * n->gap[node] +
                           beside * (n->gap[(node + face - 1) % face] + n->gap[(node + 1) % face]);
}

double friction_newton_slip(const struct friction_newton *n, size_t node) {
    return n->u[node * 2] - n->flat - n->reference[node];
}

static double pressing(const struct friction_newton *n, size_t node) {
    return n->force[node * 2 + 1];
}

/* Rounding errors, as in newton.c. */
static double gap_rounding(const struct friction_newton *n) {
    return ROUNDINGS * DBL_EPSILON * fmax(fabs(n->flat_height), fabs(n->flat));
}
static double force_rounding(const struct friction_newton *n) {
    return gap_rounding(n) * (2 * n->material.shear + n->material.local + n->material.mean);
}

static double largest_force(const struct friction_newton *n) {
    double most = 0;
    for (size_t node = 0; node < n->mesh->face; node++)
        most = fmax(most, fabs(pressing(n, node)));
    return most;
}

/* --- what nodes do --- */

/* What a node does next, and the force by which what it does contradicts its forces, gap and
 * slip. */
struct verdict {
    enum face_node next;
    double wrong;
};

static enum face_node towards(double traction) {
    return traction > 0 ? NODE_FORWARD : NODE_BACKWARD;
}

static struct verdict judge(const struct friction_newton *n, size_t node) {
    enum face_node does = n->node[node];
    double normal = pressing(n, node) - COMPLEMENTARITY * n->opening[node];
    double trial = n->force[node * 2] - COMPLEMENTARITY * friction_newton_slip(n, node);
    double bound = n->conditions.friction * fmax(0, normal);
    enum face_node in_contact = fabs(trial) < bound ? NODE_STICKS : towards(trial);
    switch (does) {
    case NODE_FREE:
        return (struct verdict){in_contact, -COMPLEMENTARITY * n->opening[node]};
    case NODE_STICKS:
        if (normal <= 0 && -normal >= fabs(trial) - bound)
            return (struct verdict){NODE_FREE, -normal};
        return (struct verdict){towards(trial), fabs(trial) - bound};
    case NODE_FORWARD:
    case NODE_BACKWARD:
        break;
    }
    double lack = bound - (does == NODE_FORWARD ? trial : -trial);
    return -normal > fmax(0, lack) ? (struct verdict){NODE_FREE, -normal}
                                   : (struct verdict){NODE_STICKS, lack};
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

/* The part of a sliding node's pressure that its traction is. */
static double sliding_share(const struct friction_newton *n, size_t node) {
    return n->node[node] == NODE_FORWARD ? n->conditions.friction : -n->conditions.friction;
}

/* Where a given shear leaves no node sticking, the flat follows the excess of the sliding nodes'
 * tractions until one of those in its direction stops: makes the one that slid least stick. */
static void fill_sticking(struct friction_newton *n) {
    double excess = -n->shear, shortest = INFINITY;
    size_t held = SIZE_MAX;
    for (size_t node = 0; node < n->mesh->face; node++) {
        if (n->node[node] == NODE_STICKS || n->conditions.drive.flat != 0)
            return;
        if (n->node[node] != NODE_FREE)
            excess += sliding_share(n, node) * pressing(n, node);
    }
    for (size_t node = 0; node < n->mesh->face; node++) {
        double slid = fabs(friction_newton_slip(n, node));
        if (n->node[node] == (unsigned char)towards(excess) && slid < shortest) {
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
            n->node[node] = (unsigned char)verdict.next;
    }
    if (one && changes > 0) {
        n->node[which] = (unsigned char)worst.next;
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
        double *row = x + 2 * node;
        if (n->node[node] == NODE_FREE)
            continue;
        if (n->node[node] == NODE_STICKS)
            row[0] = gap ? -friction_newton_slip(n, node) : 0;
        else
            row[0] -= sliding_share(n, node) * row[1];
        row[1] = gap ? -n->opening[node] : 0;
    }
}

/* Adds the outer forces on the far side to x, and sums its vertical rows in that of its first
 * node. */
static void far_rows(const struct friction_newton *n, double pressure, double *x) {
    const struct mesh *mesh = n->mesh;
    size_t first = mesh_far_side(mesh);
    double nodes = (double)(mesh->nodes - first);
    struct sum vertical = {0};
    sum_add(&vertical, -pressure * (double)mesh->face);
    for (size_t node = first; node < mesh->nodes; node++) {
        x[node * 2] -= n->shear / nodes;
        sum_add(&vertical, x[node * 2 + 1]);
        x[node * 2 + 1] = 0;
    }
    x[first * 2 + 1] = sum_value(&vertical);
}

static double far_mean(const struct friction_newton *n) {
    size_t first = mesh_far_side(n->mesh);
    struct sum sum = {0};
    for (size_t node = first; node < n->mesh->nodes; node++)
        sum_add(&sum, n->u[node * 2]);
    return sum_value(&sum) / (double)(n->mesh->nodes - first);
}

static double drive_left(const struct friction_newton *n, const struct friction_goal *goal) {
    const struct drive *drive = &n->conditions.drive;
    return goal->drive - drive->flat * n->flat - drive->shear * n->shear;
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

/* off: the present residual in the units of the tolerance; the next one will be about its square.
 * Replaces change by Newton's change of u, and *flat and *shear by those of flat and shear. */
static int newton_step(struct friction_newton *n, const struct friction_goal *goal, double off,
                       double *flat, double *shear, struct friction_end *end, struct error *err) {
    double tolerance = fmin(fmax(LINEAR_PART * off, LINEAR_PART * n->tolerance / off), LINEAR_MOST);
    size_t degrees_of_freedom = mesh_degrees_of_freedom(n->mesh);
    bool pressures = n->unknowns > degrees_of_freedom;
    double *x = n->step;
    for (size_t f = 0; f < n->unknowns; f++)
        n->change[f] = -n->force[f];
    memcpy(x, n->change, degrees_of_freedom * sizeof *x);
    if (pressures) {
        double *excess = n->change + degrees_of_freedom;
        volumetric_scale(n->tangent->volumetric, 1 / n->tangent->volumetric->row, excess, excess);
        volumetric_forces(n->tangent->volumetric, excess, -1, x);
    }
    far_rows(n, goal->pressure, x);
    face_rows(n, true, x);
    x[degrees_of_freedom] = -far_mean(n);
    x[degrees_of_freedom + 1] = drive_left(n, goal);
    int status = unsymmetric_set(n->lu, n->tangent, &n->conditions, err);
    if (status == 0)
        status = unsymmetric_solve(n->lu, tolerance, x, &end->work, err);
    if (status != 0)
        return status;
    memcpy(n->change, x, degrees_of_freedom * sizeof *x);
    if (pressures)
        volumetric_pressures(n->tangent->volumetric, x, 1, n->change + degrees_of_freedom,
                             n->change + degrees_of_freedom);
    *shear = x[degrees_of_freedom];
    *flat = x[degrees_of_freedom + 1];
    return 0;
}

static bool evaluate(struct friction_newton *n) {
    n->evaluated = tangent_evaluate(n->mesh, &n->material, n->u, &n->energy, n->force, n->tangent);
    return n->evaluated;
}

/* Advances u, flat and shear by the longest of the step and its halves that neither folds the face
 * nor inverts an element. */
static int advance(struct friction_newton *n, double flat, double shear, struct error *err) {
    double length = 1, flat_before = n->flat, shear_before = n->shear;
    bool folds = false;
    memcpy(n->before, n->u, n->unknowns * sizeof *n->before);
    for (int halving = 0; halving < HALVINGS; halving++, length /= 2) {
        for (size_t f = 0; f < n->unknowns; f++)
            n->u[f] = n->before[f] + length * n->change[f];
        n->flat = flat_before + length * flat;
        n->shear = shear_before + length * shear;
        folds = face_folds(n->mesh, n->u);
        if (!folds && evaluate(n))
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
    end->inside = end->penetration = 0;
    for (size_t node = 0; node < n->mesh->face; node++) {
        double gap = n->opening[node];
        if (n->node[node] == NODE_FREE) {
            end->penetration = fmax(end->penetration, -gap);
            continue;
        }
        end->inside = fmax(end->inside, fabs(gap));
        if (n->node[node] == NODE_STICKS)
            end->inside = fmax(end->inside, fabs(friction_newton_slip(n, node)));
    }
}

static struct round assess(struct friction_newton *n, const struct friction_goal *goal,
                           struct set_history *history, struct friction_end *end) {
    struct round round = {.largest = 0};
    const struct drive *drive = &n->conditions.drive;
    bool first = end->iterations == 0, careful = end->cycles > 0;
    friction_newton_measure_gaps(n);
    round.largest = fmax(largest_force(n), goal->pressure);
    round.balanced = fmax(n->tolerance * round.largest, force_rounding(n));
    round.closed = fmax(n->tolerance * round.largest / COMPLEMENTARITY, gap_rounding(n));
    round.residual = residual(n, goal);
    if (!first && round.residual <= (careful ? TRUSTED_ONE : TRUSTED) * round.largest)
        round.changes = update(n, round.balanced, careful);
    if (round.changes > 0) {
        end->changes += round.changes;
        round.residual = residual(n, goal);
        end->cycles += set_history_meets(history, n->mesh->face, n->node);
    }
    measure(n, end);
    round.inside = end->inside;
    round.driven = fabs(drive_left(n, goal)) <=
                   fmax(fabs(drive->flat) * round.closed, fabs(drive->shear) * round.balanced);
    end->residual = round.residual / round.largest;
    return round;
}

/* The best round since the sets changed. */
struct progress {
    double least; /* residual, in the units of the tolerance */
    size_t rounds;
};

static int check_progress(const struct friction_newton *n, struct progress *progress, double off,
                          const struct round *round, const struct friction_end *end,
                          struct error *err) {
    bool better = round->changes > 0 || off < progress->least;
    progress->least = better ? off : progress->least;
    progress->rounds = better ? 0 : progress->rounds + 1;
    if (end->cycles > RETURNS)
        return error_set(err, ERROR_NUMERIC,
                         "the sets of nodes that stick and slide come back, %zu times in %zu "
                         "iterations of Newton's; residual %.2g of the largest force",
                         end->cycles, end->iterations, end->residual);
    if (end->iterations == n->max_iterations || progress->rounds > PATIENCE)
        return error_set(err, ERROR_NUMERIC,
                         "%zu iterations of Newton's left %.2g of the largest force, and gaps and "
                         "slips of %.2g columns",
                         end->iterations, end->residual, end->inside);
    if (n->stop != NULL && n->stop(n->context) != 0)
        return error_set(err, ERROR_STOPPED, "stopped after %zu iterations of Newton's",
                         end->iterations);
    return 0;
}

int friction_newton_solve(struct friction_newton *n, const struct friction_goal *goal,
                          struct friction_end *end, struct error *err) {
    struct set_history history = {0};
    struct progress progress = {.least = INFINITY};
    *end = (struct friction_end){0};
    double load = goal->pressure * (double)n->mesh->face;
    if (force_rounding(n) > ROUNDING_MOST * load)
        return error_set(err, ERROR_NUMERIC, "rounding makes forces up to %.2g of so light a load",
                         force_rounding(n) / load);
    if (!n->evaluated && !evaluate(n))
        return error_set(err, ERROR_NUMERIC, "an element is turned inside out at the start");
    friction_newton_measure_gaps(n);
    fill_contact(n);
    fill_sticking(n);
    (void)set_history_meets(&history, n->mesh->face, n->node);
    for (;;) {
        struct round round = assess(n, goal, &history, end);
        if (end->iterations > 0 && round.changes == 0 && round.residual <= round.balanced &&
            round.inside <= round.closed && round.driven)
            return 0;
        double off = fmax(end->residual, round.inside * COMPLEMENTARITY / round.largest);
        double flat, shear;
        int status = check_progress(n, &progress, off, &round, end, err);
        if (status == 0)
            status = newton_step(n, goal, off, &flat, &shear, end, err);
        end->iterations++;
        if (status == 0)
            status = advance(n, flat, shear, err);
        if (status != 0)
            return status;
    }
}
