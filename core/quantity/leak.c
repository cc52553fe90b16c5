#include "core/quantity/leak.h"
#include "core/quantity/effective_medium.h"
#include "core/quantity/network/network.h"
#include "core/sum.h"
#include <math.h>
#include <stdlib.h>

const struct leak_options LEAK_DEFAULTS = {.tolerance = 1e-10, .max_iterations = 2000};

/* Cubes of this and of 1 are 15 decades apart: as far as pressures of about 1, in double, resolve
 * the flow between. */
static const double LEAST_GAP = 1e-5;

/* Of the arithmetic mean in the best estimate (FORMULAS.md, F20.4). */
static const double ARITHMETIC_PART = 1.0 / 3;

enum { DIRECTIONS = 2, ITERATIONS_MOST = 1000000 };

struct leak {
    struct grid grid;
    struct leak_options options;
    struct team *team;                   /* borrowed; NULL: the caller alone */
    struct network *network[DIRECTIONS]; /* owned; the second is NULL without a team, and the first
                                            serves both directions */
    double *cubes;                       /* owned, grid_points: g^3 over that of the mean */
};

static int check_options(const struct leak_options *options, struct error *err) {
    if (!(options->tolerance > 0))
        return error_set(err, ERROR_INPUT, "a leak's tolerance of %g; allowed: above 0",
                         options->tolerance);
    if (options->max_iterations == 0 || options->max_iterations > ITERATIONS_MOST)
        return error_set(err, ERROR_INPUT, "a leak's limit of %zu iterations; allowed: 1 to %d",
                         options->max_iterations, ITERATIONS_MOST);
    return 0;
}

int leak_create(struct leak **out, const struct grid *grid, const struct leak_options *options,
                struct error *err) {
    *out = NULL;
    int status = grid_check(grid, err);
    if (status == 0)
        status = check_options(options, err);
    if (status != 0)
        return status;
    if (grid_is_profile(grid))
        return error_set(err, ERROR_INPUT,
                         "the leak of a profile of %zu points; allowed: surfaces, of at least 2 by "
                         "2 points",
                         grid->nx);
    struct leak *leak = array_create(1, sizeof *leak);
    if (leak == NULL)
        return error_memory(err, sizeof *leak, "a leak");
    leak->grid = *grid;
    leak->options = *options;
    size_t n = grid_points(grid);
    leak->cubes = array_create(n, sizeof *leak->cubes);
    status = leak->cubes != NULL ? 0 : error_memory(err, n * sizeof(double), "a leak");
    if (status == 0)
        status =
            network_create(&leak->network[0], grid->nx, grid->ny, options->max_iterations, err);
    if (status != 0)
        leak_destroy(&leak);
    *out = leak;
    return status;
}

void leak_destroy(struct leak **leak) {
    if (*leak == NULL)
        return;
    for (size_t d = 0; d < DIRECTIONS; d++)
        network_destroy(&(*leak)->network[d]);
    free((*leak)->cubes);
    free(*leak);
    *leak = NULL;
}

int leak_set_team(struct leak *leak, struct team *team, struct error *err) {
    if (team_threads(team) > 1 && leak->network[1] == NULL) {
        int status = network_create(&leak->network[1], leak->grid.nx, leak->grid.ny,
                                    leak->options.max_iterations, err);
        if (status != 0)
            return status;
    }
    if (team_threads(team) == 1)
        network_destroy(&leak->network[1]);
    leak->team = team;
    return 0;
}

double leak_bytes(const struct grid *grid, const struct leak_options *options, size_t threads) {
    double networks = threads > 1 ? DIRECTIONS : 1;
    return networks * network_bytes(grid->nx, grid->ny, options->max_iterations) +
           sizeof(double) * (double)grid_points(grid);
}

/* --- nodes --- */

static bool is_free(const double *gap, const double *p, size_t i) {
    return gap[i] > 0 && !(p != NULL && p[i] > 0);
}

/* Mean over all nodes, with 0 where they are closed. */
static double mean_gap(size_t n, const double *gap, const double *p) {
    struct sum sum = {0};
    for (size_t i = 0; i < n; i++)
        sum_add(&sum, is_free(gap, p, i) ? gap[i] : 0);
    return sum_value(&sum) / (double)n;
}

static double cube_of(double relative) {
    double g = fmax(relative, LEAST_GAP);
    return g * g * g;
}

static int check_gaps(const struct leak *leak, const double *gap, struct error *err) {
    for (size_t i = 0; i < grid_points(&leak->grid); i++)
        if (!isfinite(gap[i]))
            return error_set(err, ERROR_INPUT,
                             "gap[%zu] = %g, at the node (%zu, %zu); allowed: finite", i, gap[i],
                             i % leak->grid.nx, i / leak->grid.nx);
    return 0;
}

static void fill_cubes(struct leak *leak, const double *gap, const double *p, double mean) {
    for (size_t i = 0; i < grid_points(&leak->grid); i++)
        leak->cubes[i] = is_free(gap, p, i) ? cube_of(gap[i] / mean) : 0;
}

/* --- directions --- */

static struct conductances nodes_of(const struct leak *leak, size_t direction) {
    const struct grid *grid = &leak->grid;
    double ratio = grid_dx(grid) / grid_dy(grid);
    return direction == 0 ? (struct conductances){.values = leak->cubes,
                                                  .nx = grid->nx,
                                                  .ny = grid->ny,
                                                  .step_across = 1,
                                                  .step_along = grid->nx,
                                                  .along = ratio * ratio,
                                                  .walled = leak->options.walled}
                          : (struct conductances){.values = leak->cubes,
                                                  .nx = grid->ny,
                                                  .ny = grid->nx,
                                                  .step_across = grid->nx,
                                                  .step_along = 1,
                                                  .along = 1 / (ratio * ratio),
                                                  .walled = leak->options.walled};
}

/* A uniform gap has ny/nx, across and along. */
static int measure_direction(const struct leak *leak, struct network *network, size_t direction,
                             struct leak_direction *out, struct error *err) {
    const struct conductances nodes = nodes_of(leak, direction);
    double *const leaks[MEAN_COUNT] = {
        [MEAN_HARMONIC] = &out->harmonic, [MEAN_ARITHMETIC] = &out->arithmetic};
    *out = (struct leak_direction){0};
    int status = network_take(network, &nodes, &out->open, err);
    for (int mean = 0; mean < MEAN_COUNT && status == 0 && out->open; mean++) {
        struct network_flow flow;
        status = network_solve(network, (enum face_mean)mean, leak->options.tolerance, &flow, err);
        *leaks[mean] = flow.flow * (double)nodes.nx / (double)nodes.ny;
        out->iterations += flow.iterations;
    }
    out->value = out->harmonic + ARITHMETIC_PART * (out->arithmetic - out->harmonic);
    return status != 0 ? error_context(err, "the leak along %c", "xy"[direction]) : 0;
}

struct task {
    const struct leak *leak;
    struct leak_direction *out[DIRECTIONS];
    struct error err[DIRECTIONS];
    int status[DIRECTIONS];
};

static void measure_part(void *context, size_t part, size_t thread) {
    (void)thread;
    struct task *task = context;
    const struct leak *leak = task->leak;
    struct network *network = leak->network[leak->network[part] != NULL ? part : 0];
    task->status[part] = measure_direction(leak, network, part, task->out[part], &task->err[part]);
}

int leak_measure(struct leak *leak, const double *gap, const double *p, struct leak_result *out,
                 struct error *err) {
    size_t n = grid_points(&leak->grid);
    int status = check_gaps(leak, gap, err);
    if (status != 0)
        return status;
    *out = (struct leak_result){.mean_gap = mean_gap(n, gap, p)};
    if (out->mean_gap == 0)
        return 0;
    fill_cubes(leak, gap, p, out->mean_gap);
    out->effective_medium = effective_medium(n, leak->cubes);
    struct task task = {.leak = leak, .out = {&out->x, &out->y}};
    team_share(leak->team, DIRECTIONS, measure_part, &task);
    for (size_t d = 0; d < DIRECTIONS; d++)
        if (task.status[d] != 0) {
            if (err != NULL)
                *err = task.err[d];
            return task.status[d];
        }
    return 0;
}
