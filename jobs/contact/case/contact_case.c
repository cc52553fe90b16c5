#include "jobs/contact/case/contact_case.h"
#include "core/cost.h"
#include "jobs/contact/companion/block_error.h"
#include <math.h>
#include <stdlib.h>

const struct choice KINEMATICS_CHOICES[] = {{"hencky", KINEMATICS_HENCKY},
                                            {"st_venant_kirchhoff", KINEMATICS_ST_VENANT},
                                            {"small", KINEMATICS_SMALL},
                                            {"neo_hooke", KINEMATICS_NEO_HOOKE},
                                            {0}};

double contact_case_transition(const struct contact_case *one_case, const struct grid *grid) {
    double width = grid_dx(grid);
    if (!(one_case->fine_height > 0))
        return one_case->transition_depth;
    return one_case->fine_height /
           (2 * (grid_is_profile(grid) ? width : fmax(width, grid_dy(grid))));
}

struct full_options contact_case_full_options(const struct contact_case *one_case,
                                              const struct grid *grid) {
    struct full_options options = FULL_DEFAULTS;
    options.kinematics = one_case->kinematics;
    options.transition = contact_case_transition(one_case, grid);
    options.tolerance = one_case->tolerance;
    options.current_areas = one_case->current_areas;
    options.normal_gaps = one_case->normal_gaps;
    return options;
}

struct full_options contact_case_limited_options(const struct contact_case *one_case,
                                                 const struct grid *grid,
                                                 const struct block *block) {
    struct full_options options = contact_case_full_options(one_case, grid);
    if (!(one_case->time_limit > 0))
        return options;
    const struct full_size size = cost_full_size(grid, block, &options, one_case->rms_slope);
    options.limit = cost_full_limit(grid, &size, one_case->time_limit);
    return options;
}

bool contact_case_slides(const struct contact_case *one_case) {
    bool slides = false;
    for (size_t m = 0; m < one_case->model_count; m++)
        slides = slides || one_case->models[m]->slides;
    return slides && one_case->friction > 0;
}

double contact_case_slid(const struct contact_case *one_case, size_t i) {
    const double *at = one_case->slide;
    const size_t steps = one_case->slide_steps;
    double path = 0;
    size_t turn = 0;
    for (; turn + steps < i; turn += steps)
        path += fabs(at[turn + steps] - at[turn]);
    return path + fabs(at[i] - at[turn]);
}

bool contact_case_has_scale(const struct contact_case *one_case) {
    enum spectrum_scale scale = one_case->surface.spectrum.scale;
    return scale == SCALE_RMS_HEIGHT || scale == SCALE_RMS_SLOPE;
}

int contact_case_scale(const struct contact_case *one_case, double *rms_height, double *rms_slope,
                       struct error *err) {
    const struct surface_case *surface = &one_case->surface;
    struct moments moments;
    *rms_height = *rms_slope = NAN;
    if (!contact_case_has_scale(one_case))
        return 0;
    int status = spectrum_moments(&surface->spectrum, &surface->grid, &moments, err);
    if (status != 0)
        return status;
    *rms_height = moments.rms_height;
    *rms_slope = moments.rms_slope;
    return 0;
}

bool contact_case_stretches(const struct contact_case *one_case, size_t model) {
    return one_case->models[model]->stretches && one_case->kinematics != KINEMATICS_SMALL;
}

double contact_case_block_bound(const struct contact_case *one_case, size_t model) {
    return block_bound(&one_case->blocks[model], surface_case_longest(&one_case->surface));
}

double contact_case_wave(const struct contact_case *one_case, const struct grid *grid) {
    static const double USUAL = 4;
    return one_case->band.x > 0 ? (double)grid->nx / (double)one_case->band.x : USUAL;
}

void contact_case_clear(struct contact_case *one_case) {
    surface_case_clear(&one_case->surface);
    free(one_case->loads);
    free(one_case->pdf_loads);
    free(one_case->like_areas);
    free(one_case->like_gaps);
    free(one_case->kept);
    free(one_case->kept_loads);
    free(one_case->slide);
    *one_case = (struct contact_case){0};
}

size_t contact_case_complete(const struct contact_case *one_case) {
    size_t complete = 0;
    for (size_t m = 1; m < one_case->model_count; m++)
        if (one_case->models[m]->rank > one_case->models[complete]->rank)
            complete = m;
    return complete;
}

struct contact_options contact_case_options(const struct contact_case *one_case) {
    struct contact_options options = CONTACT_DEFAULTS;
    options.tolerance = one_case->tolerance;
    if (one_case->hardness > 0)
        options.hardness = one_case->yield;
    options.without_tangent = !one_case->tangent;
    return options;
}

double contact_case_linear_seconds(const struct contact_case *one_case, const struct grid *grid,
                                   bool elements, size_t densities) {
    /* Of the work of an elastic solution: loads that rise, at most, and those that fall again. */
    static const double YIELDING = 1.5, FALLING = 0.5;
    const struct grid *own = &one_case->surface.grid;
    double longer_x = grid->lx / own->lx, longer_y = grid->ly / own->ly;
    double paths = one_case->unloads ? YIELDING + FALLING : YIELDING;
    return (one_case->hardness > 0 ? paths : 1) *
           cost_linear_loads(
               &(struct linear_work){.grid = grid,
                                     .mode_x = (size_t)(longer_x * (double)one_case->band.x),
                                     .mode_y = (size_t)(longer_y * (double)one_case->band.y),
                                     .elements = elements,
                                     .tangent = one_case->stiffness,
                                     .tolerance = one_case->tolerance,
                                     .loads = one_case->load_count,
                                     .densities = densities});
}

double contact_case_least_seconds(const struct contact_case *one_case) {
    const struct surface_case *surface = &one_case->surface;
    double seconds =
        1e-9 * surface_case_nanoseconds(surface, NULL) * (double)grid_points(&surface->grid);
    for (size_t l = 0; l < one_case->level_count; l++)
        for (size_t m = 0; m < one_case->model_count; m++)
            seconds += fmax(1, one_case->models[m]->times_linear) *
                       cost_linear_contact(&one_case->levels[l].grid, one_case->tolerance,
                                           one_case->load_count);
    return seconds;
}
