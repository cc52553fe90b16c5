/* Each load is a step, solved by sets of nodes as contact without friction is (F24.4;
 * solver/active_set.h): the equations of the sets are solved, then nodes change their sets. Nodes
 * under tension open, open nodes that penetrate touch; stuck nodes whose traction exceeds the
 * friction slide in its direction; nodes that slide towards their traction stick, on surfaces where
 * their traction less a part of their slip is within the friction, and the others turn to that. A
 * step whose sets do not settle is halved. */
#include "core/contact/slip/partial_slip.h"
#include "core/contact/contact.h"
#include "core/contact/slip/slip_sets.h"
#include <float.h>
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

const struct slip_options SLIP_DEFAULTS = {
    .poisson = 0.3, .friction = 0.2, .tolerance = 1e-8, .max_sets = 40, .max_iterations = 400};

static const struct block HALFSPACE = {
    .model = MODEL_HALFSPACE, .height = INFINITY, .layer_growth = 1};

enum { HALVINGS_MOST = 8, ITERATIONS_MOST = 60, PATIENCE = 8 };
/* The equations of a set are solved to this part of the violation with which they begin, or to
 * ENOUGH of the tolerance. After a set that was no better they are solved CLOSER times better
 * still: nodes that change by what was left over would change back again and again. */
static const double PROFILE_PART = 0.03, SURFACE_PART = 0.3, CLOSER = 0.5, ENOUGH = 0.3;
/* Of sets that do not improve, nodes with faults above this part of the largest change. */
static const double FEW = 0.5;
/* The largest turn over the local compliance. */
static const double TURN_MOST = 1e12;
/* The compliance over the local one by which slips of sliding nodes are compared with tractions.
 * With 1 few nodes changed for ever; 4 and 16 take as many sets. */
static const double SOFT = 8;

/* What a step starts from, and is restored where it fails. */
struct slip_point {
    double *tractions;         /* fields * n */
    double *reference;         /* displacements along the face less those of the flat, by node and
                                  direction: slip is their change */
    unsigned char *node;       /* enum slip_node */
    double *direction[2];      /* of sliding nodes */
    double pressure, shear[2]; /* means */
    double flat[2];            /* displacement of the flat */
    double violation;
};

struct slip {
    struct slip_options options;
    struct grid grid;
    struct compliance *compliance; /* owned, as the next, and the arrays */
    struct contact *contact;
    struct slip_sets sets;
    double *z;
    double *tractions, *u, *residual; /* fields * n each; u belongs to the tractions */
    double *reference;                /* as that of a point */
    double *begun;                    /* the same at the end of pressing */
    double *over;                     /* n: a result */
    bool *sticks;                     /* n: likewise */
    struct slip_point kept;
    double pressure, shear[2], flat[2]; /* of the last step */
    double start;             /* the flat's displacement at the end of pressing, along the load */
    double work, dissipation; /* since then */
    double highest;           /* |z| */
    size_t steps_sets, iterations; /* of this call */
    size_t iterations_most;        /* up to which its load may go */
    double violation, reach;       /* and the least that counts as one */
    bool pressed;
    int (*stop)(void *context);
    void *stop_context;
};

/* --- memory --- */

static int options_check(const struct grid *grid, const struct slip_options *options,
                         struct error *err) {
    if (!(options->friction >= 0 && isfinite(options->friction)))
        return error_set(err, ERROR_INPUT, "friction = %g; allowed: 0 or more, finite",
                         options->friction);
    if (!(isfinite(options->angle) && (options->angle == 0 || !grid_is_profile(grid))))
        return error_set(err, ERROR_INPUT,
                         "angle of the load along the face = %g; allowed: finite, of profiles 0",
                         options->angle);
    if (!(options->tolerance > 0 && options->tolerance < 1))
        return error_set(err, ERROR_INPUT, "tolerance of slip = %g; allowed: above 0, below 1",
                         options->tolerance);
    return 0;
}

static int arrays_create(struct slip *s, struct error *err) {
    const size_t n = s->sets.n, fields = s->sets.fields;
    struct {
        double **array;
        size_t count;
    } const arrays[] = {{&s->z, n},
                        {&s->tractions, fields * n},
                        {&s->u, fields * n},
                        {&s->residual, fields * n},
                        {&s->reference, (fields - 1) * n},
                        {&s->begun, (fields - 1) * n},
                        {&s->over, n},
                        {&s->kept.tractions, fields * n},
                        {&s->kept.reference, (fields - 1) * n},
                        {&s->kept.direction[0], n},
                        {&s->kept.direction[1], n}};
    for (size_t a = 0; a < sizeof arrays / sizeof *arrays; a++) {
        *arrays[a].array = array_create(arrays[a].count, sizeof(double));
        if (*arrays[a].array == NULL)
            return error_memory(err, arrays[a].count * sizeof(double), "partial slip");
    }
    s->kept.node = array_create(n, 1);
    s->sticks = array_create(n, sizeof *s->sticks);
    return s->kept.node != NULL && s->sticks != NULL ? 0 : error_memory(err, 2 * n, "partial slip");
}

int slip_create(struct slip **out, const struct grid *grid, const struct slip_options *options,
                struct error *err) {
    if (options_check(grid, options, err) != 0)
        return ERROR_INPUT;
    struct slip *made = array_create(1, sizeof *made);
    if (made == NULL)
        return error_memory(err, sizeof *made, "partial slip");
    made->options = *options;
    made->grid = *grid;
    struct contact_options pressing = CONTACT_DEFAULTS;
    pressing.tolerance = options->tolerance;
    pressing.without_tangent = true;
    int status = slip_sets_create(&made->sets, grid, options->poisson, options->friction, err);
    if (status == 0)
        status = compliance_create(&made->compliance, grid, &HALFSPACE, err);
    if (status == 0)
        status = contact_create(&made->contact, made->compliance, &pressing, err);
    if (status == 0)
        status = arrays_create(made, err);
    if (status != 0)
        slip_destroy(&made);
    *out = made;
    return status;
}

void slip_destroy(struct slip **slip) {
    struct slip *gone = *slip;
    if (gone == NULL)
        return;
    double *const arrays[] = {gone->z,
                              gone->tractions,
                              gone->u,
                              gone->residual,
                              gone->reference,
                              gone->begun,
                              gone->over,
                              gone->kept.tractions,
                              gone->kept.reference,
                              gone->kept.direction[0],
                              gone->kept.direction[1]};
    for (size_t a = 0; a < sizeof arrays / sizeof *arrays; a++)
        free(arrays[a]);
    free(gone->sticks);
    free(gone->kept.node);
    contact_destroy(&gone->contact);
    compliance_destroy(&gone->compliance);
    slip_sets_clear(&gone->sets);
    free(gone);
    *slip = NULL;
}

double slip_bytes(const struct grid *grid) {
    struct contact_options pressing = CONTACT_DEFAULTS;
    pressing.without_tangent = true;
    const double fields = grid_is_profile(grid) ? ALONG_Y : FIELDS;
    return slip_sets_bytes(grid) + compliance_bytes(grid, &HALFSPACE) +
           contact_bytes(grid, &HALFSPACE, &pressing) +
           (sizeof(double) * (4 * fields + 3 * (fields - 1) + 4) + 2) * (double)grid_points(grid);
}

void slip_set_stop(struct slip *slip, int (*stop)(void *context), void *context) {
    slip->stop = stop;
    slip->stop_context = context;
    contact_set_stop(slip->contact, stop, context);
}

/* --- points of the path --- */

static void keep(struct slip *s) {
    const size_t n = s->sets.n, fields = s->sets.fields;
    struct slip_point *to = &s->kept;
    memcpy(to->tractions, s->tractions, fields * n * sizeof(double));
    memcpy(to->reference, s->reference, (fields - 1) * n * sizeof(double));
    memcpy(to->node, s->sets.node, n);
    for (size_t d = 0; d < 2; d++) {
        memcpy(to->direction[d], s->sets.direction[d], n * sizeof(double));
        to->shear[d] = s->shear[d];
        to->flat[d] = s->flat[d];
    }
    to->pressure = s->pressure;
    to->violation = s->violation;
}

static void restore(struct slip *s) {
    const size_t n = s->sets.n, fields = s->sets.fields;
    const struct slip_point *from = &s->kept;
    memcpy(s->tractions, from->tractions, fields * n * sizeof(double));
    memcpy(s->reference, from->reference, (fields - 1) * n * sizeof(double));
    memcpy(s->sets.node, from->node, n);
    for (size_t d = 0; d < 2; d++) {
        memcpy(s->sets.direction[d], from->direction[d], n * sizeof(double));
        s->shear[d] = from->shear[d];
        s->flat[d] = from->flat[d];
    }
    s->pressure = from->pressure;
    s->violation = from->violation;
    slip_sets_count(&s->sets);
}

/* --- sets --- */

/* Sets the direction of a sliding node to that of v, of this length above 0. */
static void turn_node(struct slip *s, size_t i, double *const v[FIELDS], double length,
                      double sign) {
    s->sets.node[i] = NODE_SLIDING;
    for (size_t f = ALONG_X; f < slip_sets_end(&s->sets); f++)
        s->sets.direction[f - ALONG_X][i] = sign * v[f][i] / length;
}

static double length_along(const struct slip *s, size_t i, double *const v[FIELDS]) {
    return s->sets.fields == FIELDS ? hypot(v[ALONG_X][i], v[ALONG_Y][i]) : fabs(v[ALONG_X][i]);
}

/* Gives tractions the means of the load and the friction of sliding nodes. */
static void balance_tractions(struct slip *s) {
    const struct slip_sets *sets = &s->sets;
    double *t[FIELDS], n = (double)sets->n, sum = 0;
    double lacks[FIELDS] = {0, s->shear[0] * n, s->shear[1] * n};
    slip_sets_fields(sets, s->tractions, t);
    for (size_t i = 0; i < sets->n; i++) {
        t[NORMAL][i] = sets->node[i] != NODE_OPEN ? fmax(0, t[NORMAL][i]) : 0;
        sum += t[NORMAL][i];
    }
    for (size_t i = 0; i < sets->n; i++) {
        t[NORMAL][i] *= s->pressure * n / sum;
        double bound = sets->node[i] == NODE_SLIDING ? s->options.friction * t[NORMAL][i] : 0;
        for (size_t f = ALONG_X; f < slip_sets_end(sets); f++) {
            t[f][i] =
                sets->node[i] == NODE_STUCK ? t[f][i] : bound * sets->direction[f - ALONG_X][i];
            lacks[f] -= t[f][i];
        }
    }
    slip_sets_spread(sets, lacks, s->tractions);
}

/* Fills the residual: gaps, and slips since the last load; and the flat's displacements. Returns
 * the largest |u| across the face. */
static double displace(struct slip *s) {
    const struct slip_sets *sets = &s->sets;
    double *t[FIELDS], *u[FIELDS], *r[FIELDS], flat[FIELDS], deepest = 0;
    slip_sets_fields(sets, s->tractions, t);
    slip_sets_fields(sets, s->u, u);
    slip_sets_fields(sets, s->residual, r);
    transfer_apply(&s->sets.transfer, t, u);
    for (size_t i = 0; i < sets->n; i++) {
        r[NORMAL][i] = u[NORMAL][i] - s->z[i];
        r[ALONG_X][i] = u[ALONG_X][i] - s->reference[i];
        if (sets->fields == FIELDS)
            r[ALONG_Y][i] = u[ALONG_Y][i] - s->reference[sets->n + i];
        deepest = fmax(deepest, fabs(u[NORMAL][i]));
    }
    slip_sets_flat(sets, s->residual, flat);
    for (size_t f = 0; f < slip_sets_end(sets); f++)
        for (size_t i = 0; i < sets->n; i++)
            r[f][i] -= flat[f];
    for (size_t f = ALONG_X; f < slip_sets_end(sets); f++)
        s->flat[f - ALONG_X] = flat[f];
    return deepest;
}

/* Fields of the state that is judged. */
struct judged {
    double *t[FIELDS], *r[FIELDS]; /* tractions; gaps and slips */
};

static struct judged judged_of(const struct slip *s) {
    struct judged state;
    slip_sets_fields(&s->sets, s->tractions, state.t);
    slip_sets_fields(&s->sets, s->residual, state.r);
    return state;
}

/* Returns the slip of a node in the direction of its traction. */
static double slip_towards(const struct slip *s, size_t i, const struct judged *state) {
    double towards = 0;
    for (size_t f = ALONG_X; f < slip_sets_end(&s->sets); f++)
        towards += state->r[f][i] * s->sets.direction[f - ALONG_X][i];
    return towards;
}

/* By how much a node violates what its set leaves open, as lengths. */
struct fault {
    double across, along;
};
static struct fault fault_of(const struct slip *s, size_t i, const struct judged *state) {
    const double p = state->t[NORMAL][i], bound = s->options.friction * fmax(0, p);
    const double local = s->sets.local;
    switch ((enum slip_node)s->sets.node[i]) {
    case NODE_OPEN:
        return (struct fault){.across = fmax(0, -state->r[NORMAL][i])};
    case NODE_STUCK:
        return (struct fault){fmax(0, -p * local),
                              fmax(0, (length_along(s, i, state->t) - bound) * local)};
    case NODE_SLIDING:
        return (struct fault){fmax(0, -p * local), fmax(0, slip_towards(s, i, state))};
    }
    return (struct fault){0};
}

/* Lengths below which nothing is a fault: across the face, and along it. */
static struct fault reach_of(const struct slip *s, double deepest) {
    const double rounding = 64 * DBL_EPSILON * (s->highest + deepest);
    const double reach = s->options.tolerance * deepest;
    return (struct fault){fmax(reach, rounding),
                          fmax(fmin(1, s->options.friction) * reach, rounding)};
}

/* Returns the larger part of a fault over the reach. */
static double over(const struct fault *fault, const struct fault *reach) {
    return fmax(fault->across / reach->across, fault->along / reach->along);
}

/* Turns a sliding node of a surface to its traction less a part of its slip. Returns whether it
 * still slides: not where that is within the friction. Where equations are solved, slips are
 * against tractions, and both have that direction. The one of tractions alone turned nodes by more
 * than a quarter, which then stuck and slid in turn. */
static bool slides_on(struct slip *s, size_t i, const struct judged *state) {
    const double part = 1 / (SOFT * s->sets.local);
    const double bound = s->options.friction * state->t[NORMAL][i];
    double x = state->t[ALONG_X][i] - part * state->r[ALONG_X][i];
    double y = state->t[ALONG_Y][i] - part * state->r[ALONG_Y][i], length = hypot(x, y);
    if (!(state->t[NORMAL][i] > 0 && length > bound))
        return false;
    s->sets.direction[0][i] = x / length;
    s->sets.direction[1][i] = y / length;
    return true;
}

static void change_set(struct slip *s, size_t i, const struct judged *state) {
    const double slip = length_along(s, i, state->r), q = length_along(s, i, state->t);
    const unsigned char node = s->sets.node[i];
    const bool opens = node != NODE_OPEN && !(state->t[NORMAL][i] > 0);
    s->sets.node[i] = opens ? NODE_OPEN : NODE_STUCK;
    if (node == NODE_OPEN && slip > 0)
        turn_node(s, i, state->r, slip, -1);
    else if (node == NODE_STUCK && !opens)
        turn_node(s, i, state->t, q, 1);
}

/* Below the full friction some node sticks, or can turn. Where none does, that is the one with the
 * least slip of those whose traction is against what the load lacks. */
static void stick_one(struct slip *s, const struct judged *state) {
    const struct slip_sets *sets = &s->sets;
    double lacks[2] = {s->shear[0] * (double)sets->n, s->shear[1] * (double)sets->n};
    double least = INFINITY;
    size_t one = 0;
    for (size_t i = 0; i < sets->n; i++)
        for (size_t d = 0; sets->node[i] == NODE_SLIDING && d < 2; d++)
            lacks[d] -= s->options.friction * state->t[NORMAL][i] * sets->direction[d][i];
    for (size_t i = 0; i < sets->n; i++) {
        double slip = length_along(s, i, state->r);
        bool against = lacks[0] * sets->direction[0][i] + lacks[1] * sets->direction[1][i] < 0;
        if (sets->node[i] != NODE_SLIDING)
            continue;
        if (against && slip < least) {
            least = slip;
            one = i;
        } else if (isinf(least))
            one = i;
    }
    s->sets.node[one] = NODE_STUCK;
}

/* Changes the sets of nodes by the state that the equations left: of those with faults above a part
 * of the largest. Sliding nodes turn. Returns how many change. */
static size_t change_sets(struct slip *s, double part) {
    const struct judged state = judged_of(s);
    const struct fault reach = reach_of(s, displace(s));
    const bool turns = s->sets.fields == FIELDS;
    double worst = 0;
    size_t changed = 0;
    for (size_t i = 0; i < s->sets.n; i++) {
        struct fault fault = fault_of(s, i, &state);
        worst = fmax(worst, over(&fault, &reach));
    }
    for (size_t i = 0; i < s->sets.n; i++) {
        struct fault fault = fault_of(s, i, &state);
        if (turns && s->sets.node[i] == NODE_SLIDING && slides_on(s, i, &state))
            continue;
        if (over(&fault, &reach) > fmax(ENOUGH, part * worst)) {
            change_set(s, i, &state);
            changed++;
        } else if (s->sets.node[i] == NODE_SLIDING && length_along(s, i, state.t) > 0)
            turn_node(s, i, state.t, length_along(s, i, state.t), 1);
    }
    slip_sets_count(&s->sets);
    if (!s->sets.determined) {
        stick_one(s, &state);
        slip_sets_count(&s->sets);
        changed++;
    }
    return changed;
}

/* Returns what the equations of a node leave, and fills turn. Slip across the direction of a
 * sliding node counts by the traction that is wrong with it, times the local compliance. */
static struct fault equation_fault(struct slip *s, size_t i, const struct judged *state) {
    const unsigned char node = s->sets.node[i];
    const double slip = length_along(s, i, state->r);
    const double x = s->sets.direction[0][i], y = s->sets.direction[1][i];
    struct fault fault = {node == NODE_OPEN ? 0 : fabs(state->r[NORMAL][i]),
                          node == NODE_STUCK ? slip : 0};
    s->sets.turn[i] = 0;
    if (node == NODE_SLIDING) {
        const double local = s->sets.local, bound = s->options.friction * state->t[NORMAL][i];
        const double towards = slip_towards(s, i, state);
        s->sets.turn[i] = fmin(fmax(0, -towards) / bound, TURN_MOST * local);
        const double share = local / (s->sets.turn[i] + local);
        if (s->sets.fields == FIELDS)
            fault.along = fmax(share * fabs(state->r[ALONG_X][i] * y - state->r[ALONG_Y][i] * x),
                               local * fabs(state->t[ALONG_X][i] * y - state->t[ALONG_Y][i] * x));
    }
    return fault;
}

/* Returns the largest violation over the reach: 1 or less where the step is solved. */
static double judge(struct slip *s) {
    const struct judged state = judged_of(s);
    const struct fault reach = reach_of(s, displace(s));
    double worst = 0;
    for (size_t i = 0; i < s->sets.n; i++) {
        struct fault set = fault_of(s, i, &state), equation = equation_fault(s, i, &state);
        worst = fmax(worst, fmax(over(&set, &reach), over(&equation, &reach)));
    }
    s->violation = worst * s->options.tolerance;
    s->reach = fmin(reach.across, reach.along);
    return worst;
}

/* Adds to slips what tractions across the direction of sliding nodes make, by their turns. */
static void add_turns(struct slip *s) {
    const struct judged state = judged_of(s);
    for (size_t i = 0; i < s->sets.n; i++) {
        double q = 0;
        for (size_t f = ALONG_X; f < slip_sets_end(&s->sets); f++)
            q += state.t[f][i] * s->sets.direction[f - ALONG_X][i];
        for (size_t f = ALONG_X; s->sets.node[i] == NODE_SLIDING && f < slip_sets_end(&s->sets);
             f++)
            state.r[f][i] +=
                s->sets.turn[i] * (state.t[f][i] - q * s->sets.direction[f - ALONG_X][i]);
    }
}

/* Solves the equations of the sets, from a state that has been judged, to a part of its violation.
 */
static void solve_equations(struct slip *s, double part) {
    const size_t left = s->iterations_most - s->iterations;
    double most = 0;
    slip_sets_count(&s->sets);
    slip_sets_take(&s->sets);
    add_turns(s);
    slip_sets_centre(&s->sets, s->residual);
    for (size_t i = 0; i < s->sets.n * s->sets.fields; i++) {
        s->residual[i] = -s->residual[i];
        most = fmax(most, fabs(s->residual[i]));
    }
    s->iterations += slip_sets_solve(&s->sets, s->residual, fmax(part * most, ENOUGH * s->reach),
                                     left < ITERATIONS_MOST ? left : ITERATIONS_MOST, s->tractions);
}

/* Solves the step to the loads of s. Sets that do not improve for some time may cycle: then few
 * nodes change at once. */
static int solve_sets(struct slip *s, struct error *err) {
    const double part = s->sets.fields == FIELDS ? SURFACE_PART : PROFILE_PART;
    double best = INFINITY;
    size_t since = 0, least = SIZE_MAX, set = 0;
    for (; set < s->options.max_sets && s->iterations < s->iterations_most;
         set++, s->steps_sets++) {
        if (s->stop != NULL && s->stop(s->stop_context) != 0)
            return error_set(err, ERROR_STOPPED, "stopped after %zu sets of partial slip", set);
        size_t changed = change_sets(s, since < PATIENCE ? 0 : FEW);
        balance_tractions(s);
        double violation = judge(s);
        if (violation <= 1)
            return 0;
        since = changed < least || violation < best / 2 ? 0 : since + 1;
        best = since == 0 ? fmin(best, violation) : best;
        least = changed < least ? changed : least;
        solve_equations(s, part * pow(CLOSER, (double)since));
    }
    return error_set(err, ERROR_NUMERIC,
                     "partial slip under a mean pressure of %g E* and a traction of %g E* did not "
                     "converge: violation %.2g, asked %.2g, in %zu sets and %zu iterations",
                     s->pressure, hypot(s->shear[0], s->shear[1]), s->violation,
                     s->options.tolerance, set, s->iterations);
}

/* Slip counts from here on. */
static void settle(struct slip *s) {
    for (size_t f = ALONG_X; f < slip_sets_end(&s->sets); f++)
        for (size_t i = 0; i < s->sets.n; i++)
            s->reference[(f - ALONG_X) * s->sets.n + i] =
                s->u[f * s->sets.n + i] - s->flat[f - ALONG_X];
}

/* --- loads --- */

static double along_load(const struct slip *s, const double v[2]) {
    return v[0] * cos(s->options.angle) + v[1] * sin(s->options.angle);
}

/* Returns what slip of the step took, by area: from the tractions at both of its ends. */
static double dissipated(const struct slip *s) {
    const size_t n = s->sets.n;
    double sum = 0;
    for (size_t f = ALONG_X; f < slip_sets_end(&s->sets); f++)
        for (size_t i = f * n; i < (f + 1) * n; i++)
            sum -= (s->tractions[i] + s->kept.tractions[i]) / 2 * s->residual[i];
    return sum / (double)n;
}

/* Fills the gaps of a state that was restored. */
static void displace_again(struct slip *s) {
    (void)displace(s);
    for (size_t d = 0; d < 2; d++)
        s->flat[d] = s->kept.flat[d];
}

/* Goes to a pressure and a traction, in so many parts as it takes. */
static int go(struct slip *s, double pressure, double traction, struct error *err) {
    const double pressure_from = s->pressure, traction_from = along_load(s, s->shear);
    double reached = 0, part = 1;
    s->iterations_most = s->iterations + s->options.max_iterations;
    for (size_t halvings = 0; reached < 1;) {
        double to = fmin(1, reached + part), before = along_load(s, s->flat);
        keep(s);
        s->pressure = to < 1 ? pressure_from + to * (pressure - pressure_from) : pressure;
        double shear = to < 1 ? traction_from + to * (traction - traction_from) : traction;
        double kept_shear = along_load(s, s->kept.shear);
        s->shear[0] = shear * cos(s->options.angle);
        s->shear[1] = shear * sin(s->options.angle);
        int status = solve_sets(s, err);
        if (status == 0) {
            s->dissipation += dissipated(s);
            settle(s);
            reached = to;
            s->work += (shear + kept_shear) / 2 * (along_load(s, s->flat) - before);
            continue;
        }
        restore(s);
        if (status != ERROR_NUMERIC || ++halvings > HALVINGS_MOST ||
            s->iterations >= s->iterations_most) {
            displace_again(s);
            return status;
        }
        part /= 2;
    }
    return 0;
}

/* Fills how far nodes are over the flat since the end of pressing, along the load. */
static void fill_over(struct slip *s) {
    const size_t n = s->sets.n;
    for (size_t i = 0; i < n; i++) {
        double moved[2] = {s->reference[i] - s->begun[i], 0};
        if (s->sets.fields == FIELDS)
            moved[1] = s->reference[n + i] - s->begun[n + i];
        s->over[i] = along_load(s, moved);
    }
}

static void fill(struct slip *s, struct slip_state *out) {
    const size_t n = s->sets.n;
    double all = 0, stuck = 0, gaps = 0;
    fill_over(s);
    *out = (struct slip_state){.pressure = s->pressure,
                               .traction = along_load(s, s->shear),
                               .p = s->tractions,
                               .qx = s->tractions + n,
                               .qy = s->sets.fields == FIELDS ? s->tractions + 2 * n : NULL,
                               .gap = s->residual,
                               .over = s->over,
                               .sticks = s->sticks,
                               .displacement = along_load(s, s->flat) - s->start,
                               .work = s->work,
                               .dissipation = s->dissipation,
                               .sets = s->steps_sets,
                               .iterations = s->iterations,
                               .cost = s->sets.transfer.transforms * (double)n,
                               .violation = s->violation};
    for (size_t i = 0; i < n; i++) {
        bool sticks = out->p[i] > 0 && s->sets.node[i] == NODE_STUCK;
        s->sticks[i] = sticks;
        out->nodes += out->p[i] > 0 ? 1 : 0;
        out->stuck += sticks ? 1 : 0;
        all += out->p[i];
        stuck += sticks ? out->p[i] : 0;
        gaps += s->residual[i];
    }
    out->stick_load = stuck / all;
    out->mean_gap = gaps / (double)n;
    out->stick_area = out->nodes > 0 ? (double)out->stuck / (double)out->nodes : 0;
}

/* Begins with the pressures without friction, under which all nodes stick. */
static int begin(struct slip *s, double pressure, double *cost, struct error *err) {
    struct contact_state state;
    const size_t n = s->sets.n;
    int status = contact_press(s->contact, pressure, &state, err);
    if (status != 0)
        return status;
    memset(s->tractions, 0, s->sets.fields * n * sizeof *s->tractions);
    memset(s->reference, 0, (s->sets.fields - 1) * n * sizeof *s->reference);
    memcpy(s->tractions, state.p, n * sizeof *state.p);
    for (size_t i = 0; i < n; i++)
        s->sets.node[i] = state.p[i] > 0 ? NODE_STUCK : NODE_OPEN;
    s->pressure = pressure;
    s->shear[0] = s->shear[1] = s->flat[0] = s->flat[1] = 0;
    *cost = state.work;
    return 0;
}

int slip_press(struct slip *s, const double *z, double pressure, struct slip_state *out,
               struct error *err) {
    const size_t steps = s->options.friction > 0 ? s->options.press_steps : 0;
    double cost = 0, first = steps > 0 ? pressure / ((double)steps * (double)steps) : pressure;
    s->pressed = false;
    s->sets.transfer.transforms = 0;
    s->steps_sets = s->iterations = 0;
    s->violation = 0;
    if (!(pressure > 0 && isfinite(pressure)))
        return error_set(err, ERROR_INPUT, "mean pressure = %g; allowed: above 0, finite",
                         pressure);
    int status = contact_begin(s->contact, z, err);
    if (status == 0)
        status = begin(s, first, &cost, err);
    if (status != 0)
        return status;
    memcpy(s->z, z, s->sets.n * sizeof *z);
    s->highest = 0;
    for (size_t i = 0; i < s->sets.n; i++)
        s->highest = fmax(s->highest, fabs(z[i]));
    slip_sets_count(&s->sets);
    if (steps == 0) {
        displace(s);
        s->flat[0] = s->flat[1] = 0;
        settle(s);
    }
    for (size_t step = 1; status == 0 && step <= steps; step++) {
        double share = (double)step / (double)steps;
        status = go(s, step < steps ? pressure * share * share : pressure, 0, err);
    }
    if (status != 0)
        return status;
    s->start = along_load(s, s->flat);
    memcpy(s->begun, s->reference, (s->sets.fields - 1) * s->sets.n * sizeof *s->begun);
    s->work = s->dissipation = 0;
    s->pressed = true;
    fill(s, out);
    out->cost += cost;
    return 0;
}

int slip_load(struct slip *s, double traction, struct slip_state *out, struct error *err) {
    if (!s->pressed)
        return error_set(err, ERROR_STATE, "a load along the face comes after one across it");
    const double bound = s->options.friction * s->pressure;
    if (!(fabs(traction) < bound || traction == 0))
        return error_set(err, ERROR_INPUT,
                         "traction along the face = %g E* with a friction of %g; allowed: below "
                         "%g E*, the friction of the mean pressure, on both sides",
                         traction, s->options.friction, bound);
    s->sets.transfer.transforms = 0;
    s->steps_sets = s->iterations = 0;
    int status = traction != along_load(s, s->shear) ? go(s, s->pressure, traction, err) : 0;
    if (status == 0)
        fill(s, out);
    return status;
}
