/* What a contact case costs, before anything ran. */
#include "jobs/contact/contact_case.h"
#include "jobs/contact/contact_scene.h"
#include "jobs/contact/contact_solver.h"
#include "jobs/contact/contact_tally.h"
#include <math.h>

/* The program, its libraries, and tables that do not grow with the grid. */
static const double PROCESS_BYTES = 1.2e7;

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

/* Transforms a load, on the grid of the level: fitted to profiles of 64 to 4096 points and surfaces
 * of 128 x 128 to 1024 x 1024, loads up to 0.3. Loads far apart take more. */
static double load_transforms(const struct contact_case *study, const struct grid *grid) {
    double side = (double)grid->nx, digits = -log10(study->tolerance);
    double transforms = grid_is_profile(grid) ? 12.5 * pow(side, 0.37) : 9.3 * pow(side, 0.45);
    return transforms * (1 + 1.5 / (double)study->load_count) * (2 + digits) / 10;
}

/* A transform takes 4 to 5 ns a point with what belongs to it; more beyond the caches. */
static double level_seconds(const struct contact_case *study, const struct grid *grid) {
    double points = (double)grid_points(grid), nanoseconds = grid_is_profile(grid) ? 4 : 5;
    nanoseconds *= 1 + 0.1 * fmax(0, log2(points) - 14);
    return 1e-9 * nanoseconds * points * load_transforms(study, grid) * (double)study->load_count;
}

/* Of all loads. */
static double full_seconds(const struct contact_case *study, size_t model,
                           const struct grid *grid) {
    struct contact_full_size size = contact_full_size(study, model, grid);
    bool profile = grid_is_profile(grid);
    double linear = (profile ? 36 : 80) + (size.bulk ? 50 : 0);
    double nanoseconds = (profile ? 250 : 1100) + linear * size.linear;
    if (size.factored)
        nanoseconds = profile ? 5000 : 7e4;
    return 1e-9 * nanoseconds * size.freedoms * size.newton * (double)study->load_count;
}

/* Standard deviation of the fraction over itself: a cell of n longest waves holds about n^d
 * independent pieces of surface; fitted to profiles of 2 to 32 and surfaces of 4 and 8 waves. Small
 * Hurst exponents put more into the short waves, of which there are many. */
static double area_scatter(const struct surface_case *surface) {
    double waves = surface->length_ratio;
    double scatter = surface->dimension == 1 ? 0.2 / sqrt(waves) : 0.05 / waves;
    bool affine = surface->spectrum.type == SPECTRUM_SELF_AFFINE;
    return affine ? scatter * (0.25 + surface->spectrum.hurst) : scatter;
}

void contact_case_estimate(const struct contact_case *study, struct job_estimate *out) {
    const struct surface_case *surface = &study->surface;
    const struct grid *finest = &contact_case_finest(study)->grid;
    size_t mode_x = surface_case_band(surface), mode_y = surface->dimension == 1 ? 0 : mode_x;
    out->nx = finest->nx;
    out->ny = finest->ny;
    out->memory_bytes = generator_bytes(&surface->grid, mode_x, mode_y, &surface->options) +
                        contact_scene_bytes(study) + contact_tally_bytes(study) + PROCESS_BYTES;
    out->seconds = 1e-4 + surface_seconds(surface);
    for (size_t l = 0; l < study->level_count; l++)
        for (size_t m = 0; m < study->model_count; m++)
            out->seconds += contact_case_is_full(study, m)
                                ? full_seconds(study, m, &study->levels[l].grid)
                                : level_seconds(study, &study->levels[l].grid);
    out->relative_error = area_scatter(surface);
}
