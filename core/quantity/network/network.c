#include "core/quantity/network/network.h"
#include "core/quantity/network/lanczos.h"
#include "core/quantity/network/multigrid.h"
#include "core/quantity/network/percolation.h"
#include "core/vectors.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* The finest level has an even number of rows. Where the grid has not, a row is added between the
 * last and the first, whose nodes only part a conductance along in two of twice that each. */
struct network {
    size_t nx, ny; /* of the grid, across and along */
    double along;
    bool walled;
    struct multigrid multigrid;
    struct level *finest; /* its u is the preconditioned residual r, its residual A d */
    double *memory;       /* owned: k, x, d */
    double *k;            /* conductances of nodes, of the finest level's layout */
    double *x, *d;        /* solution, direction */
    ptrdiff_t *link;      /* owned, scratch of percolation */
    size_t max_iterations;
    double *steps; /* owned: what struct lanczos borrows */
    bool started;  /* x is a solution for this k */
};
enum { ARRAYS = 3, STEP_ARRAYS = 2, LANES = 8 };

static size_t even(size_t n) {
    return n + n % 2;
}

/* Values of an array of the finest level, whichever direction is across. */
static size_t layout_of(size_t nx, size_t ny) {
    size_t x = (nx + 2) * even(ny) + 2, y = (ny + 2) * even(nx) + 2;
    return x > y ? x : y;
}

static size_t values_of(size_t nx, size_t ny) {
    size_t x = multigrid_values(nx, even(ny)), y = multigrid_values(ny, even(nx));
    return x > y ? x : y;
}

double network_bytes(size_t nx, size_t ny, size_t max_iterations) {
    double values = (double)values_of(nx, ny) + ARRAYS * (double)layout_of(nx, ny) +
                    STEP_ARRAYS * (double)max_iterations;
    double coarsest =
        fmax(multigrid_coarsest_bytes(nx, even(ny)), multigrid_coarsest_bytes(ny, even(nx)));
    return sizeof(double) * values + sizeof(ptrdiff_t) * (double)nx * (double)ny + coarsest;
}

int network_create(struct network **out, size_t nx, size_t ny, size_t max_iterations,
                   struct error *err) {
    *out = NULL;
    struct network *net = array_create(1, sizeof *net);
    if (net == NULL)
        return error_memory(err, sizeof *net, "a leak");
    int status = multigrid_create(&net->multigrid, values_of(nx, ny), err);
    if (status == 0) {
        size_t size = layout_of(nx, ny);
        net->memory = array_create(ARRAYS * size, sizeof *net->memory);
        net->link = array_create(nx * ny, sizeof *net->link);
        net->max_iterations = max_iterations;
        net->steps = array_create(max_iterations, STEP_ARRAYS * sizeof *net->steps);
        if (net->memory == NULL || net->link == NULL || net->steps == NULL)
            status = error_memory(err, (ARRAYS * size + nx * ny) * sizeof(double), "a leak");
        else {
            net->k = net->memory;
            net->x = net->k + size;
            net->d = net->x + size;
        }
    }
    if (status != 0)
        network_destroy(&net);
    *out = net;
    return status;
}

void network_destroy(struct network **network) {
    struct network *net = *network;
    if (net == NULL)
        return;
    multigrid_clear(&net->multigrid);
    free(net->memory);
    free(net->link);
    free(net->steps);
    free(net);
    *network = NULL;
}

int network_take(struct network *net, const struct conductances *nodes, bool *open,
                 struct error *err) {
    bool same = nodes->nx == net->nx && nodes->ny == net->ny;
    int status = multigrid_shape(&net->multigrid, nodes->nx, even(nodes->ny), err);
    if (status != 0)
        return status;
    const struct level *finest = net->finest = &net->multigrid.levels[0];
    if (!same)
        memset(net->memory, 0, ARRAYS * (size_t)(net->x - net->k) * sizeof *net->memory);
    net->nx = nodes->nx;
    net->ny = nodes->ny;
    net->along = nodes->along;
    net->walled = nodes->walled;
    net->started = false;
    for (size_t j = 0; j < net->ny; j++)
        for (size_t i = 0; i < net->nx; i++)
            net->k[level_row(finest, j) + i] =
                nodes->values[j * nodes->step_along + i * nodes->step_across];
    *open = percolation_keep(net->nx, net->ny, net->walled, finest->stride,
                             net->k + level_row(finest, 0), net->link);
    return 0;
}

/* --- the equations --- */

/* Conductances of the faces between nodes a and b. */
WIDE_VECTORS static void harmonic(size_t count, double factor, const double *a, const double *b,
                                  double *out) {
    for (size_t i = 0; i < count; i++) {
        double product = a[i] * b[i], mean = 2 * factor * product / (a[i] + b[i]);
        out[i] = product > 0 ? mean : 0;
    }
}

WIDE_VECTORS static void arithmetic(size_t count, double factor, const double *a, const double *b,
                                    double *out) {
    for (size_t i = 0; i < count; i++) {
        double mean = factor * (a[i] + b[i]) / 2;
        out[i] = a[i] * b[i] > 0 ? mean : 0;
    }
}

static void fill_faces(struct network *net, enum face_mean mean) {
    struct level *finest = net->finest;
    void (*fill)(size_t, double, const double *, const double *, double *) =
        mean == MEAN_HARMONIC ? harmonic : arithmetic;
    size_t nx = net->nx, ny = net->ny;
    for (size_t j = 0; j < ny; j++) {
        size_t row = level_row(finest, j), up = level_row(finest, j + 1 < ny ? j + 1 : 0);
        const double *k = net->k;
        fill(nx - 1, 1, k + row, k + row + 1, finest->e + row);
        fill(nx, net->along, k + row, k + up, finest->n + row);
        finest->s[row] = 2 * k[row];
        finest->s[row + nx - 1] = 2 * k[row + nx - 1];
    }
    const size_t last = level_row(finest, ny - 1);
    if (net->walled)
        memset(finest->n + last, 0, nx * sizeof *finest->n);
    if (finest->ny > ny) {
        size_t added = level_row(finest, ny);
        for (size_t i = 0; i < nx; i++)
            finest->n[added + i] = finest->n[last + i] *= 2;
    }
}

/* Sums over a row, in so many lanes. */
static double lanes_sum(const double *lanes) {
    double sum = 0;
    for (size_t a = 0; a < LANES; a++)
        sum += lanes[a];
    return sum;
}

WIDE_VECTORS static double product_row(size_t n, const double *a, const double *b) {
    double sum[LANES] = {0};
    size_t i = 0;
    for (; i + LANES <= n; i += LANES)
        for (size_t l = 0; l < LANES; l++)
            sum[l] += a[i + l] * b[i + l];
    for (; i < n; i++)
        sum[0] += a[i] * b[i];
    return lanes_sum(sum);
}

static double product(const struct level *level, const double *a, const double *b) {
    double sum = 0;
    for (size_t j = 0; j < level->ny; j++)
        sum += product_row(level->nx, a + level_row(level, j), b + level_row(level, j));
    return sum;
}

/* d = z + beta d. */
WIDE_VECTORS static void direct_row(size_t n, const double *z, double beta, double *d) {
    for (size_t i = 0; i < n; i++)
        d[i] = z[i] + beta * d[i];
}

struct around {
    const double *e, *n, *n_below, *s, *inverse, *x, *above, *below;
};
static struct around around_of(const struct level *level, const double *x, size_t j) {
    size_t row = level_row(level, j), below = level_below(level, j), above = level_above(level, j);
    return (struct around){level->e + row,       level->n + row, level->n + below, level->s + row,
                           level->inverse + row, x + row,        x + above,        x + below};
}

/* out = A x, as what flows out of each node. */
WIDE_VECTORS static void apply_row(size_t n, struct around w, double *out) {
    for (size_t i = 0; i < n; i++)
        out[i] = w.e[i] * (w.x[i] - w.x[i + 1]) +
                 w.e[(ptrdiff_t)i - 1] * (w.x[i] - w.x[(ptrdiff_t)i - 1]) +
                 w.n[i] * (w.x[i] - w.above[i]) + w.n_below[i] * (w.x[i] - w.below[i]) +
                 w.s[i] * w.x[i];
}

/* Sum of c (difference)^2 of the faces above and at the right of a row's nodes. */
WIDE_VECTORS static double energy_row(size_t n, struct around w) {
    double sum[LANES] = {0};
    size_t i = 0;
    for (; i + LANES <= n; i += LANES)
        for (size_t l = 0; l < LANES; l++) {
            double right = w.x[i + l] - w.x[i + l + 1], up = w.x[i + l] - w.above[i + l];
            sum[l] += w.e[i + l] * right * right + w.n[i + l] * up * up;
        }
    for (; i < n; i++) {
        double right = w.x[i] - w.x[i + 1], up = w.x[i] - w.above[i];
        sum[0] += w.e[i] * right * right + w.n[i] * up * up;
    }
    return lanes_sum(sum);
}

/* Conductance of a node to an end. */
static double to_first(const struct network *net, size_t j) {
    return j < net->ny ? 2 * net->k[level_row(net->finest, j)] : 0;
}
static double to_last(const struct network *net, size_t j) {
    return j < net->ny ? 2 * net->k[level_row(net->finest, j) + net->nx - 1] : 0;
}

/* The energy of x with the ends at 1 and 0, which is least, and the flow, at the solution. */
static double energy(const struct network *net) {
    const struct level *level = net->finest;
    double sum = 0;
    for (size_t j = 0; j < level->ny; j++) {
        struct around w = around_of(level, net->x, j);
        double first = 1 - w.x[0], last = w.x[net->nx - 1];
        sum += energy_row(net->nx, w) + to_first(net, j) * first * first +
               to_last(net, j) * last * last;
    }
    return sum;
}

/* A uniform fall of pressure. */
static void begin(struct network *net) {
    const struct level *level = net->finest;
    for (size_t j = 0; j < level->ny; j++)
        for (size_t i = 0; i < net->nx; i++)
            net->x[level_row(level, j) + i] = 1 - ((double)i + 0.5) / (double)net->nx;
}

static void fill_residual(struct network *net) {
    struct level *level = net->finest;
    for (size_t j = 0; j < level->ny; j++) {
        size_t row = level_row(level, j);
        double *r = level->r + row;
        struct around w = around_of(level, net->x, j);
        apply_row(net->nx, w, r);
        for (size_t i = 0; i < net->nx; i++)
            r[i] = -r[i];
        /* without the difference of two products that cancel */
        r[0] += to_first(net, j);
    }
}

/* --- conjugate gradients (Hestenes & Stiefel 1952) --- */

/* d = z + beta d and q = A d. Returns d.q. */
static double search(struct network *net, double beta) {
    struct level *level = net->finest;
    double sum = 0;
    for (size_t j = 0; j < level->ny; j++)
        direct_row(net->nx, level->u + level_row(level, j), beta, net->d + level_row(level, j));
    for (size_t j = 0; j < level->ny; j++) {
        size_t row = level_row(level, j);
        apply_row(net->nx, around_of(level, net->d, j), level->residual + row);
        sum += product_row(net->nx, net->d + row, level->residual + row);
    }
    return sum;
}

WIDE_VECTORS static void step_row(size_t n, double step, const double *d, const double *q,
                                  double *x, double *r) {
    for (size_t i = 0; i < n; i++) {
        x[i] += step * d[i];
        r[i] -= step * q[i];
    }
}

static void advance(struct network *net, double step) {
    struct level *level = net->finest;
    for (size_t j = 0; j < level->ny; j++) {
        size_t row = level_row(level, j);
        step_row(net->nx, step, net->d + row, level->residual + row, net->x + row, level->r + row);
    }
}

static int iterate(struct network *net, double tolerance, struct network_flow *out,
                   struct error *err) {
    const struct level *level = net->finest;
    struct lanczos lanczos = {.diagonal = net->steps, .beside = net->steps + net->max_iterations};
    double before = 0;
    out->error = 1;
    for (out->iterations = 0;; out->iterations++) {
        int status = multigrid_cycle(&net->multigrid, err);
        if (status != 0)
            return status;
        double now = product(level, level->u, level->r);
        out->flow = energy(net);
        if (lanczos.count > 0 || now == 0)
            out->error = now > 0 ? now / lanczos_least(&lanczos) / out->flow : fabs(now);
        if (out->error <= tolerance)
            return 0;
        if (out->iterations == net->max_iterations)
            break;
        double beta = before > 0 ? now / before : 0, below = search(net, beta);
        if (!(now > 0 && below > 0))
            break;
        advance(net, now / below);
        lanczos_add(&lanczos, now / below, beta);
        before = now;
    }
    return error_set(err, ERROR_NUMERIC,
                     "the flow through %zu by %zu nodes is known to a relative %.2g after %zu "
                     "iterations; allowed: %.2g",
                     net->nx, net->ny, out->error, out->iterations, tolerance);
}

int network_solve(struct network *net, enum face_mean mean, double tolerance,
                  struct network_flow *out, struct error *err) {
    *out = (struct network_flow){0};
    fill_faces(net, mean);
    int status = multigrid_prepare(&net->multigrid, err);
    if (status != 0)
        return status;
    if (!net->started)
        begin(net);
    memset(net->d, 0, level_size(net->finest) * sizeof *net->d);
    fill_residual(net);
    status = iterate(net, tolerance, out, err);
    net->started = status == 0;
    return status;
}
