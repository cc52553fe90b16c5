#include "jobs/statistics/statistics_generation.h"
#include "core/cost.h"
#include "core/statistics/surface_pass.h"
#include <math.h>
#include <stdlib.h>

/* Of the first realisations more are measured again than of the later ones. */
enum { FIRST = 32, FIRST_INTERVAL = 8, INTERVAL = 64 };
/* Iterations that go on are twice those of the surface, within these. */
enum { LEAST_ITERATIONS = 100, MOST_ITERATIONS = 300 };

struct statistics_generation {
    const struct statistics_case *one_case;
    struct moments moments;
    struct summit_finder *finder;
    struct generator *generator; /* owned, as all below */
    struct summit_list summits[SIDES];
    double *z;
};

bool statistics_generation_applies(const struct statistics_case *one_case) {
    return one_case->surface.options.heights.type != HEIGHTS_GAUSSIAN;
}

static bool is_due(uint64_t realisation) {
    return realisation % (realisation < FIRST ? FIRST_INTERVAL : INTERVAL) == 0;
}

static struct surface_options fast_options(const struct statistics_case *one_case) {
    struct surface_options options = one_case->surface.options;
    options.iteration = ITERATION_REFLECTIONS;
    return options;
}

static int generation_fill(struct statistics_generation *generation, struct error *err) {
    const struct surface_case *surface = &generation->one_case->surface;
    size_t points = grid_points(&surface->grid);
    const struct surface_options options = fast_options(generation->one_case);
    generation->z = array_create(points, sizeof *generation->z);
    if (generation->z == NULL)
        return error_memory(err, points * sizeof *generation->z, "a surface");
    return generator_create(&generation->generator, &surface->spectrum, &surface->grid, &options,
                            err);
}

int statistics_generation_create(struct statistics_generation **out,
                                 const struct statistics_case *one_case,
                                 const struct moments *moments, struct summit_finder *finder,
                                 struct error *err) {
    *out = NULL;
    if (!statistics_generation_applies(one_case))
        return 0;
    struct statistics_generation *generation = array_create(1, sizeof *generation);
    if (generation == NULL)
        return error_memory(err, sizeof *generation, "other surfaces");
    generation->one_case = one_case;
    generation->moments = *moments;
    generation->finder = finder;
    int status = generation_fill(generation, err);
    if (status != 0)
        statistics_generation_destroy(&generation);
    *out = generation;
    return status;
}

void statistics_generation_destroy(struct statistics_generation **generation) {
    struct statistics_generation *gone = *generation;
    if (gone == NULL)
        return;
    generator_destroy(&gone->generator);
    for (size_t side = 0; side < SIDES; side++)
        summit_list_clear(&gone->summits[side]);
    free(gone->z);
    free(gone);
    *generation = NULL;
}

/* Puts the scalars of the surface of this aim from `first` on. */
static int measure(struct statistics_generation *generation, struct random_key key,
                   const struct surface_aim *aim, double *first, struct error *err) {
    const struct grid *grid = &generation->one_case->surface.grid;
    struct surface_report report;
    struct roughness roughness;
    double scalars[SCALAR_COUNT];
    const struct surface_pass pass = {.finder = generation->finder,
                                      .summits = &generation->summits[SIDE_SUMMITS],
                                      .pits = &generation->summits[SIDE_PITS]};
    generator_aim(generation->generator, aim);
    int status = generator_run(generation->generator, key, generation->z, &report, err);
    if (status == 0)
        status = surface_pass_run(&pass, grid, generation->z, err);
    if (status != 0)
        return status;
    roughness_measure(grid, generation->z, &roughness);
    statistics_scalars_measure(generation->one_case, &generation->moments,
                               &(struct realisation_measures){&roughness, &generation->moments,
                                                              generation->summits, &report},
                               scalars);
    for (size_t a = 0; a < GENERATION_COUNT; a++)
        first[a] = scalars[GENERATION_OWN[a]];
    return 0;
}

int statistics_generation_measure(struct statistics_generation *generation, struct random_key key,
                                  double scalars[SCALAR_COUNT], struct error *err) {
    if (generation == NULL || !is_due(key.realisation))
        return 0;
    bool momentum = generation->one_case->surface.options.iteration == ITERATION_MOMENTUM;
    double twice = 2 * scalars[SCALAR_GENERATOR_ITERATIONS];
    double worst = fmax(fmax(scalars[SCALAR_EPS_H], scalars[SCALAR_EPS_S]), scalars[SCALAR_EPS_S0]);
    size_t most = (size_t)fmin(fmax(twice, LEAST_ITERATIONS), MOST_ITERATIONS);
    const struct surface_aim other = {.iteration =
                                          momentum ? ITERATION_REFLECTIONS : ITERATION_MOMENTUM,
                                      .tolerance = worst,
                                      .stall_iterations = most,
                                      .max_iterations = most};
    const struct surface_aim longer = {.iteration =
                                           momentum ? ITERATION_MOMENTUM : ITERATION_REFLECTIONS,
                                       .tolerance = worst / 2,
                                       .stall_iterations = most,
                                       .max_iterations = most};
    int status = measure(generation, key, &other, scalars + SCALAR_OTHER, err);
    return status != 0 ? status : measure(generation, key, &longer, scalars + SCALAR_LONGER, err);
}

double statistics_generation_bytes(const struct statistics_case *one_case) {
    struct surface_case surface = one_case->surface;
    surface.options = fast_options(one_case);
    return statistics_generation_applies(one_case) ? surface_case_bytes(&surface) : 0;
}

double statistics_generation_seconds(const struct statistics_case *one_case) {
    const struct surface_options options = fast_options(one_case);
    double points = (double)grid_points(&one_case->surface.grid);
    if (!statistics_generation_applies(one_case))
        return 0;
    return 4e-9 * cost_generation(&options) * points * cost_caches(points) / INTERVAL;
}
