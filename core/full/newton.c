#include "core/full/newton.h"
#include "core/full/face.h"
#include "core/full/rounds.h"
#include "core/full/set_history.h"
#include "core/sum.h"
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

/* Residuals at which iterations of the linear equations end: LINEAR_PART times Newton's residual,
 * at most LINEAR_MOST; LINEAR_EXACT with a factorisation. For newton_compliance
 * STIFFNESS_TOLERANCES times the tolerance, at most the first of LINEAR_STIFFNESS, and these where
 * it is not reached. */
static const double LINEAR_MOST = 1e-2, LINEAR_EXACT = 1e-10;
static const double STIFFNESS_TOLERANCES = 1e3, LINEAR_STIFFNESS[] = {1e-6, 1e-4};

int newton_create(struct newton *out, const struct mesh *mesh, const struct material *material,
                  enum gap_weighting weighting, enum equation_solver solver, struct error *err) {
    *out = (struct newton){.mesh = mesh, .material = *material, .solver = solver};
    double **const arrays[] = {&out->u, &out->force, &out->before, &out->change};
    double **const faces[] = {&out->gap, &out->opening};
    int status =
        tangent_create(&out->tangent, mesh, material, gmres_needs_pressures(material), err);
    if (status == 0)
        status = gmres_create(&out->gmres, mesh, material, weighting, err);
    for (size_t a = 0; status == 0 && a < sizeof arrays / sizeof *arrays; a++) {
        *arrays[a] = array_create(newton_unknowns(out), sizeof(double));
        if (*arrays[a] == NULL)
            status = error_memory(err, newton_unknowns(out) * sizeof(double), "displacements");
    }
    for (size_t a = 0; status == 0 && a < sizeof faces / sizeof *faces; a++) {
        *faces[a] = array_create(mesh->face, sizeof(double));
        if (*faces[a] == NULL)
            status = error_memory(err, mesh->face * sizeof(double), "gaps");
    }
    if (status == 0) {
        out->active = array_create(mesh->face, sizeof *out->active);
        if (out->active == NULL)
            status = error_memory(err, mesh->face * sizeof(bool), "the active set");
    }
    if (status != 0)
        newton_clear(out);
    return status;
}

/* Returns whether a factorisation is affordable: with Netlib's BLAS it takes about ten seconds and
 * a gigabyte at this size, and as long for a surface of 20 x 20 nodes. */
static bool factorable(const struct mesh *mesh) {
    return mesh->dimension == 2 && mesh_degrees_of_freedom(mesh) <= 500000;
}

int newton_allow_overhangs(struct newton *n, struct error *err) {
    const struct mesh *mesh = n->mesh;
    bool able = mesh->dimension == 3 ? n->solver == SOLVER_ITERATED : factorable(mesh);
    int status = 0;
    if (!able)
        return error_set(
            err, ERROR_INPUT,
            "a face of %zu x %zu nodes may not overhang: profiles do that have up to 500000 "
            "degrees of freedom, and surfaces whose equations are iterated",
            mesh->level[0].nx, mesh->level[0].ny);
    if (n->anchor == NULL)
        n->anchor = array_create(mesh_degrees_of_freedom(mesh), sizeof *n->anchor);
    if (n->anchor == NULL)
        return error_memory(err, mesh_degrees_of_freedom(mesh) * sizeof *n->anchor,
                            "displacements");
    if (!factorable(mesh))
        status = gmres_lengthen(n->gmres, err);
    if (status == 0 && n->self.pair == NULL)
        status = self_contact_create(&n->self, mesh, err);
    n->overhangs = status == 0;
    return status;
}

size_t newton_unknowns(const struct newton *n) {
    return tangent_unknowns(n->tangent);
}

void newton_clear(struct newton *n) {
    tangent_destroy(&n->tangent);
    factorisation_destroy(&n->factorisation);
    gmres_destroy(&n->gmres);
    self_contact_clear(&n->self);
    free(n->u);
    free(n->force);
    free(n->before);
    free(n->anchor);
    free(n->change);
    free(n->gap);
    free(n->opening);
    free(n->active);
    *n = (struct newton){0};
}

void newton_measure_gaps(struct newton *n) {
    for (size_t node = 0; node < n->mesh->face; node++)
        n->gap[node] = n->mesh->height[node] + n->u[mesh_vertical(n->mesh, node)] - n->flat_height;
    gmres_weigh(n->gmres, n->gap, n->opening);
}

double newton_node_area(const struct newton *n) {
    return n->mesh->across;
}

static double contact_force(const struct newton *n, size_t node) {
    return n->force[mesh_vertical(n->mesh, node)];
}

/* Return the rounding error of gaps, which are sums of heights and displacements as large as the
 * highest height, and of the forces that strains of that size cause. */
static double gap_rounding(const struct newton *n) {
    return rounds_gap(fabs(n->flat_height));
}
static double force_rounding(const struct newton *n) {
    return rounds_force(gap_rounding(n), &n->material, newton_node_area(n));
}

/* --- the active set --- */

static double largest_force(const struct newton *n) {
    return rounds_largest_force(n->mesh, n->force);
}

/* Returns the force by which a node's state (active or not) contradicts its contact force and gap;
 * 0 where it agrees or contradicts by less than `least`. */
static double contradiction(const struct newton *n, size_t node, double least) {
    double gap = COMPLEMENTARITY * n->opening[node];
    double wrong = n->active[node] ? gap - contact_force(n, node) : -gap;
    return wrong > least ? wrong : 0;
}

static size_t active_count(const struct newton *n) {
    size_t count = 0;
    for (size_t node = 0; node < n->mesh->face; node++)
        count += n->active[node];
    return count;
}

static size_t nearest_node(const struct newton *n) {
    size_t nearest = 0;
    for (size_t node = 1; node < n->mesh->face; node++)
        if (n->opening[node] < n->opening[nearest])
            nearest = node;
    return nearest;
}

/* Makes the nearest node active when none is, because some node must carry the load. */
static void active_fill(struct newton *n) {
    if (active_count(n) == 0)
        n->active[nearest_node(n)] = true;
}

/* Changes the state of all nodes that contradict it, or of the worst one alone. Returns their
 * number. */
static size_t active_update(struct newton *n, bool one) {
    double least = fmax(n->tolerance * largest_force(n), force_rounding(n)), worst = 0;
    size_t changes = 0, which = 0;
    for (size_t node = 0; node < n->mesh->face; node++) {
        double wrong = contradiction(n, node, least);
        if (wrong > worst) {
            worst = wrong;
            which = node;
        }
        if (wrong > 0 && !one)
            n->active[node] = !n->active[node];
        changes += wrong > 0;
    }
    if (one && changes > 0) {
        n->active[which] = !n->active[which];
        changes = 1;
    }
    active_fill(n);
    return changes;
}

/* Returns whether the active set was met before, and remembers it. */
static bool active_met(const struct newton *n, struct set_history *history) {
    _Static_assert(sizeof *n->active == 1, "a byte a node");
    return set_history_meets(history, n->mesh->face, (const unsigned char *)n->active);
}

/* --- equilibrium --- */

/* Returns whether the first node of the far side does not move sideways: a factorisation holds it.
 * Drag holds the block where equations are iterated. */
static bool is_pinned(const struct newton *n) {
    return n->drag > 0 && n->factored;
}

/* Computes out-of-balance forces, outer less inner, in the layout of gmres_solve; they are 0 at
 * active nodes, where the flat carries the difference. Returns the largest. */
static double residual(const struct newton *n, double pressure, double *out) {
    const struct mesh *mesh = n->mesh;
    size_t far_side = mesh_far_side(mesh);
    double largest = 0;
    struct sum far_force = {0};
    for (size_t f = 0; f < newton_unknowns(n); f++)
        out[f] = -n->force[f];
    sum_add(&far_force, -pressure * newton_node_area(n) * (double)mesh->face);
    for (size_t node = far_side; node < mesh->nodes; node++) {
        sum_add(&far_force, out[mesh_vertical(mesh, node)]);
        out[mesh_vertical(mesh, node)] = 0;
    }
    for (size_t node = 0; node < mesh->face; node++)
        if (n->active[node])
            out[mesh_vertical(mesh, node)] = 0;
    out[mesh_vertical(mesh, far_side)] = sum_value(&far_force);
    for (int k = 0; is_pinned(n) && k + 1 < mesh->dimension; k++)
        out[far_side * (size_t)mesh->dimension + (size_t)k] = 0;
    for (size_t f = 0; f < newton_unknowns(n); f++)
        largest = fmax(largest, fabs(out[f]));
    return largest;
}

static void measure(const struct newton *n, struct newton_end *end) {
    end->inside = end->penetration = 0;
    for (size_t node = 0; node < n->mesh->face; node++) {
        double gap = n->opening[node];
        if (n->active[node])
            end->inside = fmax(end->inside, fabs(gap));
        else
            end->penetration = fmax(end->penetration, -gap);
    }
}

bool newton_evaluate(struct newton *n) {
    n->evaluated = tangent_evaluate(n->mesh, &n->material, n->u, NULL, n->force, n->tangent);
    n->tangent->links = n->tangent->patches = 0;
    if (n->evaluated && n->drag > 0)
        tangent_add_drag(n->tangent, n->drag, n->u, n->anchor, n->force);
    if (n->evaluated && n->overhangs)
        self_contact_evaluate(&n->self, n->material.convex, n->u, n->force, n->tangent);
    return n->evaluated;
}

static double used_by(const struct newton *n, const struct newton_end *end) {
    return full_limit_count(&n->limit, end->iterations, end->linear, end->factored);
}

/* Returns whether more than the limit, with these seconds more, is used. */
static bool is_used_up(const struct newton *n, const struct newton_end *end, double more) {
    return n->limit.seconds > 0 && used_by(n, end) + more > n->limit.seconds;
}

static struct linear_system system_of(const struct newton *n, struct factorisation *factorisation,
                                      const struct newton_end *end) {
    return (struct linear_system){.tangent = n->tangent,
                                  .active = n->active,
                                  .factorisation = factorisation,
                                  .pinned = is_pinned(n),
                                  .drag = factorisation == NULL ? n->drag : 0,
                                  .lengthy = n->overhangs,
                                  .most = full_limit_linear(&n->limit, used_by(n, end)),
                                  .stop = n->stop,
                                  .context = n->context};
}

/* Replaces the forces in change by displacements, using a factorisation. */
static int solve_factored(struct newton *n, double tolerance, struct newton_end *end,
                          struct error *err) {
    int status =
        n->factorisation == NULL ? factorisation_create(&n->factorisation, n->mesh, err) : 0;
    if (status == 0)
        status = factorisation_run(n->factorisation, n->tangent, n->active, err);
    if (status == ERROR_NUMERIC) { /* stress makes the tangent indefinite: the factorised matrix
                                      leaves its terms out */
        n->material.convex = true;
        status = newton_evaluate(n)
                     ? factorisation_run(n->factorisation, n->tangent, n->active, err)
                     : status;
        n->material.convex = false;
        (void)newton_evaluate(n); /* cannot fail where it succeeded before */
    }
    if (status != 0)
        return status;
    end->factored++;
    const struct linear_system system = system_of(n, n->factorisation, end);
    return gmres_solve(n->gmres, &system, tolerance, n->change, &end->linear, err);
}

static int solve_iterated(struct newton *n, double tolerance, struct newton_end *end,
                          struct error *err) {
    const struct linear_system system = system_of(n, NULL, end);
    return gmres_solve(n->gmres, &system, tolerance, n->change, &end->linear, err);
}

/* Replaces the out-of-balance forces in change by Newton's change of u. off: the present residual
 * in the units of the tolerance. The next residual will be about its square, so that the linear
 * equations need not be solved more accurately. */
static int newton_change(struct newton *n, double off, struct newton_end *end, struct error *err) {
    for (size_t node = 0; node < n->mesh->face; node++)
        if (n->active[node])
            n->change[mesh_vertical(n->mesh, node)] = -n->opening[node];
    /* With a factorisation the equations are solved to rounding, which shows Newton's own
     * convergence. */
    double quadratic = n->solver == SOLVER_FACTORED ? LINEAR_EXACT : LINEAR_PART * off;
    double tolerance = fmin(fmax(quadratic, LINEAR_PART * n->tolerance / off), LINEAR_MOST);
    return (n->factored ? solve_factored : solve_iterated)(n, tolerance, end, err);
}

/* Advances u by the longest of the step and its halves that neither folds the face nor inverts an
 * element. */
static int advance(struct newton *n, struct error *err) {
    size_t unknowns = newton_unknowns(n);
    double length =
        n->overhangs ? fmin(1, SELF_LONGEST / face_largest_move(n->mesh, n->change)) : 1;
    bool folds = false;
    memcpy(n->before, n->u, unknowns * sizeof *n->before);
    for (int halving = 0; halving < HALVINGS; halving++, length /= 2) {
        for (size_t f = 0; f < unknowns; f++)
            n->u[f] = n->before[f] + length * n->change[f];
        folds = n->overhangs ? self_contact_depth(&n->self, n->u, n->active) > SELF_DEEPEST
                             : face_folds(n->mesh, n->u);
        if (!folds && newton_evaluate(n))
            return 0;
    }
    n->evaluated = false;
    return error_set(err, ERROR_NUMERIC,
                     folds ? "the face folds over itself" : "an element is turned inside out");
}

static void remember_residual(struct newton_end *end, double value, bool changed) {
    if (changed)
        end->unchanged = 0;
    memmove(end->history, end->history + 1, (NEWTON_HISTORY - 1) * sizeof *end->history);
    end->history[NEWTON_HISTORY - 1] = value;
    end->unchanged++;
}

/* State of u at the beginning of an iteration of Newton's method. */
struct round {
    double largest; /* largest contact force, at least the mean force of a node */
    double residual, inside;
    double balanced, closed; /* residuals and gaps below these count as 0 */
    size_t changes;          /* changes of the active set that this round made */
};

/* Measures gaps and forces at u and, except in the first round, updates the active set from them.
 * Once an earlier set returns, the set changes one node at a time and only near balance. If sets
 * still return, there is no equilibrium (RETURNS). */
static struct round assess(struct newton *n, double pressure, bool first,
                           struct set_history *history, struct newton_end *end) {
    struct round round = {.largest = 0};
    newton_measure_gaps(n);
    round.largest = fmax(largest_force(n), pressure * newton_node_area(n));
    round.residual = residual(n, pressure, n->change);
    bool careful = end->cycles > 0;
    if (!first && rounds_trust(round.residual, round.largest, careful))
        round.changes = active_update(n, careful);
    if (round.changes > 0) {
        end->changes += round.changes;
        round.residual = residual(n, pressure, n->change);
        end->cycles += active_met(n, history);
    }
    measure(n, end);
    round.inside = end->inside;
    round.closed = fmax(n->tolerance * round.largest / COMPLEMENTARITY, gap_rounding(n));
    round.balanced = fmax(n->tolerance * round.largest, force_rounding(n));
    end->residual = round.residual / round.largest;
    remember_residual(end, end->residual, round.changes > 0);
    return round;
}

/* Returns 0 when the iteration may go on from a round whose residual is `off`. */
static int check_progress(const struct newton *n, struct round_progress *progress, double off,
                          bool changed, const struct newton_end *end, struct error *err) {
    bool ends = round_progress_ends(progress, off, changed, end->iterations, n->max_iterations);
    if (end->cycles > RETURNS)
        return error_set(err, ERROR_NUMERIC, "the sets of nodes in contact come back");
    if (ends)
        return error_set(err, ERROR_NUMERIC,
                         "%zu iterations of Newton's left %.2g of the largest force",
                         end->iterations, end->residual);
    if (is_used_up(n, end, 0))
        return error_set(err, ERROR_NUMERIC, "the time limit was used up");
    if (n->stop != NULL && n->stop(n->context) != 0)
        return error_set(err, ERROR_STOPPED, "stopped after %zu iterations of Newton's",
                         end->iterations);
    return 0;
}

/* Finds contact of the face with itself anew where it has balanced. */
static int renew(struct newton *n, double largest, struct self_rounds *rounds, struct error *err) {
    bool met;
    int status =
        self_contact_round(&n->self, n->u, n->active, n->tolerance, largest, rounds, &met, err);
    if (status != 0 || !met || newton_evaluate(n))
        return status;
    return error_set(err, ERROR_NUMERIC, "an element is turned inside out");
}

/* Prepares forces, gaps and the active set. */
static int begin(struct newton *n, double pressure, struct error *err) {
    double load = pressure * newton_node_area(n) * (double)n->mesh->face;
    n->factored = n->solver == SOLVER_FACTORED || (n->drag > 0 && factorable(n->mesh));
    if (force_rounding(n) > ROUNDING_MOST * load)
        return error_set(err, ERROR_NUMERIC, "rounding makes forces up to %.2g of so light a load",
                         force_rounding(n) / load);
    if (!n->evaluated && n->overhangs)
        self_contact_search(&n->self, n->u, n->active);
    if (!n->evaluated && !newton_evaluate(n))
        return error_set(err, ERROR_NUMERIC, "an element is turned inside out");
    newton_measure_gaps(n);
    active_fill(n);
    return 0;
}

int newton_solve(struct newton *n, double pressure, struct newton_end *end, struct error *err) {
    struct set_history history = {0};
    struct round_progress progress = {.least = INFINITY};
    struct self_rounds rounds = {0};
    *end = (struct newton_end){0};
    int status = begin(n, pressure, err);
    if (status != 0)
        return status;
    (void)active_met(n, &history);
    for (;;) {
        bool first = end->iterations == 0;
        struct round round = assess(n, pressure, first, &history, end);
        bool balanced = !first && round.changes == 0 && round.residual <= round.balanced &&
                        round.inside <= round.closed;
        if (balanced && (rounds.settled || !n->overhangs))
            return 0;
        rounds.settled = false;
        if (balanced) {
            status = renew(n, round.largest, &rounds, err);
            if (status != 0)
                return status;
            progress = (struct round_progress){.least = INFINITY, .begun = end->iterations};
            continue;
        }
        double off = fmax(end->residual, round.inside * COMPLEMENTARITY / round.largest);
        status = check_progress(n, &progress, off, round.changes > 0, end, err);
        if (status != 0)
            return status;
        end->iterations++;
        n->factored = n->factored || n->tangent->links > 0;
        status = newton_change(n, off, end, err);
        if (status == ERROR_NUMERIC && !n->factored && factorable(n->mesh) &&
            !is_used_up(n, end, n->limit.factored)) {
            n->factored = true;
            continue;
        }
        if (status == 0)
            status = advance(n, err);
        if (status != 0)
            return status;
    }
}

/* Returns the displacements for areas of the face's cells; NULL where strains are small. */
static const double *face_displacement(const struct newton *n) {
    return n->material.kinematics != KINEMATICS_SMALL ? n->u : NULL;
}

/* Computes the forces at the nodes in contact under the displacements in change, scaled to a mean
 * of 1. */
static void tangent_pressures(struct newton *n, double *tangent) {
    struct sum sum = {0};
    tangent_apply(n->tangent, n->change, n->before);
    for (size_t node = 0; node < n->mesh->face; node++) {
        tangent[node] = n->active[node] ? n->before[mesh_vertical(n->mesh, node)] : 0;
        sum_add(&sum, tangent[node]);
    }
    double mean = sum_value(&sum) / (double)n->mesh->face;
    for (size_t node = 0; node < n->mesh->face; node++)
        tangent[node] /= mean;
}

/* Replaces change by the displacements under a mean pressure of 1 with the nodes in contact held.
 */
static int solve_held(struct newton *n, bool factored, double tolerance, struct error *err) {
    struct newton_end ignored = {0};
    memset(n->change, 0, newton_unknowns(n) * sizeof *n->change);
    n->change[mesh_vertical(n->mesh, mesh_far_side(n->mesh))] =
        -newton_node_area(n) * (double)n->mesh->face;
    return (factored ? solve_factored : solve_iterated)(n, tolerance, &ignored, err);
}

int newton_compliance(struct newton *n, double *out, double *tangent, struct error *err) {
    const double goal = fmin(LINEAR_STIFFNESS[0], STIFFNESS_TOLERANCES * n->tolerance);
    int status = solve_held(n, n->factored, goal, err);
    if (status == ERROR_NUMERIC && !n->factored && factorable(n->mesh))
        status = solve_held(n, true, goal, err);
    if (status == ERROR_NUMERIC && goal < LINEAR_STIFFNESS[0])
        status = solve_held(n, false, LINEAR_STIFFNESS[0], err);
    if (status == ERROR_NUMERIC)
        status = solve_held(n, false, LINEAR_STIFFNESS[1], err);
    if (status != 0)
        return status;
    *out = -face_mean_gap_change(n->mesh, face_displacement(n), n->gap, n->change);
    tangent_pressures(n, tangent);
    return 0;
}
