#include "core/contact/slip/slip_sets.h"
#include "core/contact/solver/lines.h"
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum {
    SHADOW,
    DIRECTION,
    DIRECTION_PRODUCT,
    REST_PRODUCT,
    STEP,
    REST_STEP,
    CHANGE,
    FULL,
    MARKED,
    CONTINUED
};
_Static_assert(CONTINUED + 1 == SLIP_VECTORS, "each vector has a name");

/* Sums of shares whose determinant is a smaller part of the square of the trace determine no motion
 * of the flat. */
static const double SLIMMEST = 1e-4;

/* --- memory --- */

static int allocate(double **out, size_t count, struct error *err) {
    *out = array_create(count, sizeof **out);
    return *out != NULL ? 0 : error_memory(err, count * sizeof **out, "partial slip");
}

/* Returns the displacement under a pressure of 1 at node 0. */
static double local_compliance(struct slip_sets *sets) {
    double *in[FIELDS] = {sets->vectors[FULL]}, *out[FIELDS] = {sets->vectors[MARKED]};
    in[NORMAL][0] = 1;
    transfer_apply(&sets->transfer, in, out);
    in[NORMAL][0] = 0;
    return out[NORMAL][0];
}

int slip_sets_create(struct slip_sets *out, const struct grid *grid, double poisson,
                     double friction, struct error *err) {
    const bool profile = grid_is_profile(grid);
    *out = (struct slip_sets){.n = grid_points(grid), .friction = friction};
    int status = transfer_create(&out->transfer, grid, poisson, err);
    out->fields = out->transfer.fields;
    for (size_t v = 0; status == 0 && v < SLIP_VECTORS; v++)
        status = allocate(&out->vectors[v], out->n * out->fields, err);
    for (size_t f = 0; status == 0 && f < 2; f++)
        status = allocate(&out->direction[f], out->n, err);
    if (status == 0)
        status = allocate(&out->turn, out->n, err);
    if (status == 0 && (out->node = array_create(out->n, 1)) == NULL)
        status = error_memory(err, out->n, "partial slip");
    for (size_t a = 0; status == 0 && !profile && a < 2; a++)
        status = pyramid_create(&out->pyramids[a], grid, err);
    if (status == 0)
        out->local = local_compliance(out);
    else
        slip_sets_clear(out);
    return status;
}

void slip_sets_clear(struct slip_sets *sets) {
    for (size_t v = 0; v < SLIP_VECTORS; v++)
        free(sets->vectors[v]);
    for (size_t a = 0; a < 2; a++) {
        free(sets->direction[a]);
        pyramid_clear(&sets->pyramids[a]);
    }
    free(sets->turn);
    free(sets->node);
    transfer_clear(&sets->transfer);
    *sets = (struct slip_sets){0};
}

double slip_sets_bytes(const struct grid *grid) {
    const bool profile = grid_is_profile(grid);
    double doubles = SLIP_VECTORS * (profile ? ALONG_Y : FIELDS) + 3;
    return transfer_bytes(grid) + (doubles * sizeof(double) + 1) * (double)grid_points(grid) +
           (profile ? 0 : 2 * pyramid_bytes(grid));
}

/* --- nodes --- */

/* Returns what v has in the direction of a sliding node. */
static double along(const struct slip_sets *sets, size_t i, double *const v[FIELDS]) {
    const double across = sets->fields == FIELDS ? v[ALONG_Y][i] * sets->direction[1][i] : 0;
    return v[ALONG_X][i] * sets->direction[0][i] + across;
}

/* Drops what v has outside of the unknowns. */
static void restrict_node(const struct slip_sets *sets, size_t i, double *const v[FIELDS]) {
    const unsigned char node = sets->node[i];
    const double drop = node == NODE_SLIDING ? along(sets, i, v) : 0;
    for (size_t f = ALONG_X; f < slip_sets_end(sets); f++)
        v[f][i] = node == NODE_OPEN ? 0 : v[f][i] - drop * sets->direction[f - ALONG_X][i];
    v[NORMAL][i] = node == NODE_OPEN ? 0 : v[NORMAL][i];
}

/* Whether a residual of tractions is continued from the node. Sliding nodes whose direction turns
 * hardly are preconditioned by what turns them. */
static bool is_continued(const struct slip_sets *sets, size_t i) {
    return sets->node[i] == NODE_STUCK ||
           (sets->fields == FIELDS && sets->node[i] == NODE_SLIDING && sets->turn[i] < sets->local);
}

/* Returns the share of a traction that the node takes up where its set lets it. */
static double share_of(const struct slip_sets *sets, size_t i) {
    switch ((enum slip_node)sets->node[i]) {
    case NODE_STUCK:
        return 1;
    case NODE_SLIDING:
        return sets->fields == FIELDS ? sets->local / (sets->turn[i] + sets->local) : 0;
    case NODE_OPEN:
        return 0;
    }
    return 0;
}

void slip_sets_count(struct slip_sets *sets) {
    double xx = 0, xy = 0, yy = 0;
    const bool profile = sets->fields != FIELDS;
    sets->contact = 0;
    for (size_t i = 0; i < sets->n; i++) {
        const bool slides = sets->node[i] == NODE_SLIDING;
        const double share = share_of(sets, i);
        const double x = slides ? sets->direction[0][i] : 0, y = slides ? sets->direction[1][i] : 0;
        sets->contact += sets->node[i] != NODE_OPEN ? 1 : 0;
        xx += share * (1 - x * x);
        xy -= share * x * y;
        yy += share * (1 - y * y);
    }
    yy = profile ? fmax(1, xx) : yy;
    const double area = xx * yy - xy * xy;
    sets->determined = area > SLIMMEST * (xx + yy) * (xx + yy) && area > 0;
    sets->share[0] = yy / area;
    sets->share[1] = -xy / area;
    sets->share[2] = xx / area;
}

void slip_sets_take(struct slip_sets *sets) {
    double *contact = sets->vectors[FULL], *tractions = sets->vectors[MARKED];
    if (sets->fields != FIELDS)
        return;
    for (size_t i = 0; i < sets->n; i++) {
        contact[i] = sets->node[i] != NODE_OPEN ? 1 : 0;
        tractions[i] = is_continued(sets, i) ? 1 : 0;
    }
    pyramid_set(&sets->pyramids[0], contact);
    pyramid_set(&sets->pyramids[1], tractions);
}

/* Multiplies what is along the face by the inverse that share holds. */
static void divide(const struct slip_sets *sets, double v[FIELDS]) {
    const double x = v[ALONG_X], y = v[ALONG_Y];
    v[ALONG_X] = sets->share[0] * x + sets->share[1] * y;
    v[ALONG_Y] = sets->share[1] * x + sets->share[2] * y;
}

void slip_sets_flat(const struct slip_sets *sets, double *residual, double flat[FIELDS]) {
    double *r[FIELDS];
    slip_sets_fields(sets, residual, r);
    for (size_t f = 0; f < FIELDS; f++)
        flat[f] = 0;
    for (size_t i = 0; i < sets->n; i++) {
        const double share = share_of(sets, i);
        const double drop = sets->node[i] == NODE_SLIDING ? along(sets, i, r) : 0;
        flat[NORMAL] += sets->node[i] != NODE_OPEN ? r[NORMAL][i] / (double)sets->contact : 0;
        for (size_t f = ALONG_X; f < slip_sets_end(sets); f++)
            flat[f] += share * (r[f][i] - drop * sets->direction[f - ALONG_X][i]);
    }
    divide(sets, flat);
}

void slip_sets_centre(const struct slip_sets *sets, double *residual) {
    double *r[FIELDS], flat[FIELDS];
    slip_sets_fields(sets, residual, r);
    slip_sets_flat(sets, residual, flat);
    for (size_t i = 0; i < sets->n; i++) {
        for (size_t f = 0; f < slip_sets_end(sets); f++)
            r[f][i] -= flat[f];
        restrict_node(sets, i, r);
        for (size_t f = ALONG_X; f < slip_sets_end(sets); f++)
            r[f][i] *= share_of(sets, i);
    }
}

void slip_sets_spread(const struct slip_sets *sets, const double sum[FIELDS], double *tractions) {
    double *t[FIELDS], each[FIELDS] = {0, sum[ALONG_X], sum[ALONG_Y]};
    slip_sets_fields(sets, tractions, t);
    divide(sets, each);
    for (size_t i = 0; i < sets->n; i++) {
        const double share = share_of(sets, i);
        double drop = 0;
        for (size_t f = ALONG_X; sets->node[i] == NODE_SLIDING && f < slip_sets_end(sets); f++)
            drop += each[f] * sets->direction[f - ALONG_X][i];
        for (size_t f = ALONG_X; share > 0 && f < slip_sets_end(sets); f++)
            t[f][i] += share * (each[f] - drop * sets->direction[f - ALONG_X][i]);
    }
}

/* Gives a change of tractions the means 0: the transpose of slip_sets_centre, but for the friction
 * of sliding nodes. */
static void balance(const struct slip_sets *sets, double *change) {
    double *x[FIELDS], lacks[FIELDS] = {0};
    slip_sets_fields(sets, change, x);
    for (size_t i = 0; i < sets->n; i++)
        lacks[NORMAL] -= x[NORMAL][i];
    for (size_t i = 0; i < sets->n; i++) {
        if (sets->node[i] != NODE_OPEN)
            x[NORMAL][i] += lacks[NORMAL] / (double)sets->contact;
        double slid = sets->node[i] == NODE_SLIDING ? sets->friction * x[NORMAL][i] : 0;
        for (size_t f = ALONG_X; f < slip_sets_end(sets); f++)
            lacks[f] -= x[f][i] + slid * sets->direction[f - ALONG_X][i];
    }
    slip_sets_spread(sets, lacks, change);
}

/* --- products --- */

/* out = the centred residual that a change of tractions makes. */
static void apply(struct slip_sets *sets, double *change, double *out) {
    double *x[FIELDS], *full[FIELDS], *u[FIELDS];
    slip_sets_fields(sets, change, x);
    slip_sets_fields(sets, sets->vectors[FULL], full);
    slip_sets_fields(sets, out, u);
    memcpy(full[NORMAL], change, sets->n * sets->fields * sizeof *change);
    for (size_t i = 0; i < sets->n; i++)
        for (size_t f = ALONG_X; sets->node[i] == NODE_SLIDING && f < slip_sets_end(sets); f++)
            full[f][i] += sets->friction * x[NORMAL][i] * sets->direction[f - ALONG_X][i];
    transfer_apply(&sets->transfer, full, u);
    for (size_t i = 0; i < sets->n; i++)
        for (size_t f = ALONG_X; sets->node[i] == NODE_SLIDING && f < slip_sets_end(sets); f++)
            u[f][i] += sets->turn[i] * x[f][i];
    slip_sets_centre(sets, out);
}

/* Continues the values of a field from its nodes over the grid. */
static void continue_field(struct slip_sets *sets, size_t f, double *marked, double *out) {
    if (sets->fields == FIELDS)
        pyramid_continue(&sets->pyramids[f == NORMAL ? 0 : 1], marked, out);
    else
        lines_continue(sets->n, marked, out);
}

static void transpose_field(struct slip_sets *sets, size_t f, const double *marked, double *x) {
    if (sets->fields == FIELDS)
        pyramid_transpose(&sets->pyramids[f == NORMAL ? 0 : 1], marked, x);
    else
        lines_transpose(sets->n, marked, x);
}

/* out = a change of tractions about as large as what takes off the residual. */
static void precondition(struct slip_sets *sets, double *residual, double *out) {
    double *r[FIELDS], *marked[FIELDS], *wide[FIELDS], *x[FIELDS];
    slip_sets_fields(sets, residual, r);
    slip_sets_fields(sets, sets->vectors[MARKED], marked);
    slip_sets_fields(sets, sets->vectors[CONTINUED], wide);
    slip_sets_fields(sets, out, x);
    for (size_t f = 0; f < slip_sets_end(sets); f++) {
        for (size_t i = 0; i < sets->n; i++) {
            bool in = f == NORMAL ? sets->node[i] != NODE_OPEN : is_continued(sets, i);
            double share = f == NORMAL ? 1 : share_of(sets, i);
            marked[f][i] = !in ? 0 : r[f][i] == 0 ? DBL_MIN : r[f][i] / share;
        }
        continue_field(sets, f, marked[f], wide[f]);
    }
    transfer_precondition(&sets->transfer, wide, wide);
    for (size_t f = 0; f < slip_sets_end(sets); f++) {
        transpose_field(sets, f, marked[f], wide[f]);
        for (size_t i = 0; i < sets->n; i++)
            x[f][i] = f == NORMAL || is_continued(sets, i) ? wide[f][i] : r[f][i] / sets->local;
    }
    for (size_t i = 0; i < sets->n; i++)
        restrict_node(sets, i, x);
    balance(sets, out);
}

/* --- biconjugate gradients --- */

/* to = from + step x. Returns the largest of them. */
static double advance(size_t n, const double *from, double step, const double *x, double *to) {
    double most = 0;
    for (size_t i = 0; i < n; i++) {
        to[i] = from[i] + step * x[i];
        most = fmax(most, fabs(to[i]));
    }
    return most;
}

/* Adds a change of the unknowns to all tractions. */
static void add_change(const struct slip_sets *sets, double *change, double *tractions) {
    double *x[FIELDS], *t[FIELDS];
    slip_sets_fields(sets, change, x);
    slip_sets_fields(sets, tractions, t);
    for (size_t i = 0; i < sets->n; i++) {
        double slid = sets->node[i] == NODE_SLIDING ? sets->friction * x[NORMAL][i] : 0;
        t[NORMAL][i] += x[NORMAL][i];
        for (size_t f = ALONG_X; f < slip_sets_end(sets); f++)
            t[f][i] += x[f][i] + slid * sets->direction[f - ALONG_X][i];
    }
}

size_t slip_sets_solve(struct slip_sets *sets, double *r, double enough, size_t max_iterations,
                       double *tractions) {
    const size_t n = sets->n * sets->fields;
    double *const shadow = sets->vectors[SHADOW], *const d = sets->vectors[DIRECTION];
    double *const dv = sets->vectors[DIRECTION_PRODUCT], *const rv = sets->vectors[REST_PRODUCT];
    double *const step = sets->vectors[STEP], *const rest = sets->vectors[REST_STEP];
    double *const change = sets->vectors[CHANGE];
    double last = 0, first = 1, second = 1, most = INFINITY;
    size_t iteration = 0;
    memcpy(shadow, r, n * sizeof *r);
    memset(change, 0, n * sizeof *change);
    for (; iteration < max_iterations && most > enough; iteration++) {
        double energy = transfer_dot(n, shadow, r),
               beta = last != 0 ? energy / last * first / second : 0;
        for (size_t i = 0; i < n; i++)
            d[i] = beta == 0 ? r[i] : r[i] + beta * (d[i] - second * dv[i]);
        precondition(sets, d, step);
        apply(sets, step, dv);
        first = energy / transfer_dot(n, shadow, dv);
        if (!isfinite(first))
            break;
        advance(n, r, -first, dv, r);
        precondition(sets, r, rest);
        apply(sets, rest, rv);
        double square = transfer_dot(n, rv, rv);
        second = square > 0 ? transfer_dot(n, rv, r) / square : 0;
        advance(n, change, first, step, change);
        advance(n, change, second, rest, change);
        most = advance(n, r, -second, rv, r);
        last = energy;
        if (second == 0)
            break;
    }
    add_change(sets, change, tractions);
    return iteration;
}
