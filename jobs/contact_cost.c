/* What a contact case costs, before anything ran. */
#include "jobs/contact_case.h"
#include "jobs/contact_scene.h"
#include "jobs/contact_tally.h"
#include <math.h>

/* CPU seconds of one realisation's surface on a 3 GHz core; as statistics_case.c. */
static double surface_seconds(const struct surface_case *surface) {
    const struct surface_options *options = &surface->options;
    double points = (double)grid_points(&surface->grid), nanoseconds = 6;
    if (options->heights.type != HEIGHTS_GAUSSIAN) {
        bool plain = options->iteration == ITERATION_PLAIN;
        double iterations = plain ? 120 : (double)options->relaxed_iterations + 3;
        nanoseconds += fmin(iterations, (double)options->max_iterations) * 15;
    }
    return 1e-9 * nanoseconds * points;
}

/* Transforms a load, on the grid of the level. */
static double load_transforms(const struct contact_case *study) {
    return (study->surface.dimension == 1 ? 60 : 100) * log10(1 / study->tolerance) / 8;
}

static double level_seconds(const struct contact_case *study, const struct grid *grid) {
    double points = (double)grid_points(grid);
    return (double)study->load_count * load_transforms(study) * 8e-9 * points *
           fmax(1, log2(points) / 16);
}

/* Standard deviation of the fraction over itself: a cell of n longest waves holds about n^d
 * independent patches of surface. */
static double area_scatter(const struct contact_case *study) {
    return 0.5 / sqrt(pow(study->surface.length_ratio, study->surface.dimension));
}

void contact_case_estimate(const struct contact_case *study, struct job_estimate *out) {
    const struct surface_case *surface = &study->surface;
    const struct grid *finest = &contact_case_finest(study)->grid;
    size_t mode_x = surface_case_band(surface), mode_y = surface->dimension == 1 ? 0 : mode_x;
    out->nx = finest->nx;
    out->ny = finest->ny;
    out->memory_bytes = generator_bytes(&surface->grid, mode_x, mode_y, &surface->options) +
                        contact_scene_bytes(study) + contact_tally_bytes(study) + 6e6;
    out->seconds = 1e-4 + surface_seconds(surface);
    for (size_t l = 0; l < study->level_count; l++)
        out->seconds += (double)study->model_count * level_seconds(study, &study->levels[l].grid);
    out->relative_error = area_scatter(study);
}
