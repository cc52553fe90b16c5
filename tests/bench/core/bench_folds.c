/* Surfaces of `full` that are dragged until they overhang and fold: how far they go, in what time,
 * and how well Coulomb's law and the energy are met. The tables of core/full/friction/README.md are
 * of
 *
 *     bench_folds NODES SLOPE FRICTION LOAD PRESS_STEPS AXIS TO SEED SURFACES
 *
 * with the load over E* times the slope, the axis x or y, and the flat's displacement over the
 * cell. */
#include "core/full/friction/friction.h"
#include "core/surface/surface.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

enum { STEPS = 10, SECONDS_MOST = 60, ARGUMENTS = 9 };

struct scene {
    size_t nodes;
    double slope, load, to;
    struct friction_options friction;
    unsigned long seed, surfaces;
};

static double seconds_begun;

static double cpu_seconds(void) {
    struct timespec now;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

static int is_late(void *context) {
    (void)context;
    return cpu_seconds() - seconds_begun > SECONDS_MOST;
}

static int draw(const struct scene *scene, const struct grid *grid, unsigned long seed, double *z,
                struct error *err) {
    const struct spectrum spectrum = {.type = SPECTRUM_SELF_AFFINE,
                                      .hurst = 0.8,
                                      .wavelength_long = 0.5,
                                      .wavelength_rolloff = 0.5,
                                      .wavelength_short = 0.25,
                                      .scale = SCALE_RMS_SLOPE,
                                      .scale_value = scene->slope};
    struct generator *generator = NULL;
    int status = generator_create(&generator, &spectrum, grid, &SURFACE_DEFAULTS, err);
    if (status == 0)
        status = generator_run(generator, (struct random_key){.seed = seed}, z, NULL, err);
    generator_destroy(&generator);
    return status;
}

/* What a path came to. */
struct path {
    size_t steps, bear, newton, linear, jumps;
    double excess; /* of a traction over friction times pressure, E* */
    double first, longest, deepest;
};

static void count(const struct scene *scene, const struct friction_state *state, double seconds,
                  struct path *path) {
    path->first = path->steps == 0 ? seconds : path->first;
    path->longest = fmax(path->longest, seconds);
    path->deepest = fmax(path->deepest, state->self.penetration);
    path->bear = state->self.nodes > path->bear ? state->self.nodes : path->bear;
    path->newton += state->newton;
    path->linear += state->linear;
    path->jumps += state->jumps;
    path->steps++;
    for (size_t i = 0; i < scene->nodes * scene->nodes; i++)
        path->excess = fmax(path->excess, hypot(state->q[i], state->q_across[i]) -
                                              scene->friction.coefficient * state->p[i]);
}

static int drag(const struct scene *scene, struct friction *friction, const double *z,
                struct path *path, struct friction_state *state, struct error *err) {
    int status = friction_begin(friction, z, err);
    seconds_begun = cpu_seconds();
    if (status == 0)
        status = friction_press(friction, scene->load * scene->slope, state, err);
    for (int step = 1; status == 0 && step <= STEPS; step++) {
        double begun = cpu_seconds();
        status = friction_drag(friction, scene->to * step / STEPS, state, err);
        if (status == 0)
            count(scene, state, cpu_seconds() - begun, path);
    }
    return status;
}

static int run(const struct scene *scene, unsigned long seed, double *z, struct error *err) {
    const struct grid grid = {scene->nodes, scene->nodes, 1, 1};
    const struct block block = {.model = MODEL_LAYERED,
                                .poisson = 0.3,
                                .height = 1,
                                .layer_growth = 1.3,
                                .weighting = GAP_DUAL};
    struct friction *friction = NULL;
    struct friction_state state = {0};
    struct path path = {0};
    int status = draw(scene, &grid, seed, z, err);
    if (status == 0)
        status = friction_create(&friction, &grid, &block, &FULL_DEFAULTS, &scene->friction, err);
    if (status != 0)
        return status;
    friction_set_stop(friction, is_late, NULL);
    int ended = drag(scene, friction, z, &path, &state, err);
    double left = state.work + state.pressing_work - state.dissipation - state.energy;
    printf("seed %lu: %zu of %d steps, %.1f s, first %.2f s, longest %.2f s, %zu iterations of "
           "Newton's, %zu linear, %zu jumps; at most %zu nodes of folds bear, %.1g columns deep; "
           "tractions %.1g E* above friction; left of works %.1e of what friction takes%s%s\n",
           seed, path.steps, STEPS, cpu_seconds() - seconds_begun, path.first, path.longest,
           path.newton, path.linear, path.jumps, path.bear, path.deepest, path.excess,
           left / state.dissipation, ended != 0 ? ": " : "", ended != 0 ? err->text : "");
    fflush(stdout);
    friction_destroy(&friction);
    return ended == ERROR_NUMERIC || ended == ERROR_STOPPED ? 0 : ended;
}

int main(int argc, char **argv) {
    struct scene scene = {16, 1, 0.3, 0.4, {.coefficient = 0.3}, 11, 1};
    if (argc == ARGUMENTS + 1)
        scene = (struct scene){.nodes = strtoul(argv[1], NULL, 10),
                               .slope = strtod(argv[2], NULL),
                               .friction = {.coefficient = strtod(argv[3], NULL),
                                            .press_steps = strtoul(argv[5], NULL, 10),
                                            .along_y = strcmp(argv[6], "y") == 0},
                               .load = strtod(argv[4], NULL),
                               .to = strtod(argv[7], NULL),
                               .seed = strtoul(argv[8], NULL, 10),
                               .surfaces = strtoul(argv[9], NULL, 10)};
    struct error err = {0};
    double *z = array_create(scene.nodes * scene.nodes, sizeof *z);
    int status = z != NULL ? 0 : error_memory(&err, scene.nodes * sizeof *z, "heights");
    for (unsigned long k = 0; status == 0 && k < scene.surfaces; k++)
        status = run(&scene, scene.seed + k, z, &err);
    if (status != 0)
        fprintf(stderr, "bench_folds: %s\n", err.text);
    free(z);
    return status != 0;
}
