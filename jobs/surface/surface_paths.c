#include "jobs/surface/surface_paths.h"
#include "core/cost.h"
#include <math.h>
#include <stdlib.h>

/* A path has at most twice the iterations of the surface, within these limits. */
enum { LEAST_ITERATIONS = 100, MOST_ITERATIONS = 300 };
static const double DRIFT_MOST = 4;

struct surface_paths {
    const struct surface_case *surface;
    struct generator *generator; /* owned, as z */
    double *z;
};

bool surface_paths_apply(const struct surface_case *surface) {
    return surface_is_iterated(&surface->options);
}

static struct surface_options fast_options(const struct surface_case *surface) {
    struct surface_options options = surface->options;
    options.iteration = ITERATION_REFLECTIONS;
    return options;
}

int surface_paths_create(struct surface_paths **out, const struct surface_case *surface,
                         struct error *err) {
    size_t points = grid_points(&surface->grid);
    const struct surface_options options = fast_options(surface);
    struct surface_paths *paths = array_create(1, sizeof *paths);
    if (paths == NULL)
        return error_memory(err, sizeof *paths, "other surfaces");
    paths->surface = surface;
    paths->z = array_create(points, sizeof *paths->z);
    int status = paths->z != NULL ? 0 : error_memory(err, points * sizeof *paths->z, "a surface");
    if (status == 0)
        status =
            generator_create(&paths->generator, &surface->spectrum, &surface->grid, &options, err);
    if (status != 0)
        surface_paths_destroy(&paths);
    *out = paths;
    return status;
}

void surface_paths_destroy(struct surface_paths **paths) {
    struct surface_paths *gone = *paths;
    if (gone == NULL)
        return;
    generator_destroy(&gone->generator);
    free(gone->z);
    free(gone);
    *paths = NULL;
}

int surface_paths_make(struct surface_paths *paths, enum surface_path path, struct random_key key,
                       const struct surface_report *own, const double **z,
                       struct surface_report *report, struct error *err) {
    bool momentum = paths->surface->options.iteration == ITERATION_MOMENTUM;
    bool longer = path == PATH_LONGER;
    double worst = fmax(fmax(own->eps_h, own->eps_s), own->eps_s0);
    size_t most =
        (size_t)fmin(fmax(2 * (double)own->iterations, LEAST_ITERATIONS), MOST_ITERATIONS);
    const struct surface_aim aim = {.iteration = momentum == longer ? ITERATION_MOMENTUM
                                                                    : ITERATION_REFLECTIONS,
                                    .tolerance = longer ? worst / 2 : worst,
                                    .stall_iterations = most,
                                    .max_iterations = most};
    generator_aim(paths->generator, &aim);
    *z = paths->z;
    return generator_run(paths->generator, key, paths->z, report, err);
}

double surface_paths_bytes(const struct surface_case *surface) {
    struct surface_case again = *surface;
    again.options = fast_options(surface);
    return surface_case_bytes(&again);
}

double surface_paths_seconds(const struct surface_case *surface) {
    const struct surface_options options = fast_options(surface);
    double points = (double)grid_points(&surface->grid);
    return 4e-9 * cost_generation(&options, NULL) * points * cost_caches(points);
}

double surface_paths_drift(double halvings) {
    return halvings > 1 / DRIFT_MOST ? 1 / halvings : DRIFT_MOST;
}
