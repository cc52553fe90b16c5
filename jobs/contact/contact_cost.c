/* What a contact case costs, before anything ran. */
#include "core/cost.h"
#include "jobs/contact/contact_case.h"
#include "jobs/contact/contact_cell.h"
#include "jobs/contact/contact_generation.h"
#include "jobs/contact/contact_like.h"
#include "jobs/contact/contact_probe.h"
#include "jobs/contact/contact_scene.h"
#include "jobs/contact/contact_tally.h"
#include "jobs/publishing_cost.h"
#include <math.h>

/* The program, its libraries and tables that do not grow with the grid take so much. */
static const double PROCESS_BYTES = 2.1e7;

/* A model and level have so many curves: areas by four estimators or five, and eight other
 * quantities. */
enum { LEVEL_CURVES = 13 };

/* So few may take a second already, and a worker that is lost loses no more. */
enum { RUNS_MOST = 20 };

static double case_seconds(const struct contact_case *one_case) {
    size_t solved = one_case->model_count * one_case->level_count;
    size_t densities = one_case->model_count * one_case->pdf_count;
    return publishing_cost(LEVEL_CURVES * solved + densities,
                           LEVEL_CURVES * solved * one_case->load_count +
                               densities * one_case->pressure.count);
}

double contact_case_least_seconds(const struct contact_case *one_case) {
    const struct surface_case *surface = &one_case->surface;
    double seconds =
        1e-9 * cost_generation(&surface->options, NULL) * (double)grid_points(&surface->grid);
    for (size_t l = 0; l < one_case->level_count; l++)
        for (size_t m = 0; m < one_case->model_count; m++)
            seconds += fmax(1, one_case->models[m]->times_linear) *
                       contact_coarse_seconds(one_case, &one_case->levels[l].grid);
    return seconds;
}

void contact_case_estimate(const struct contact_case *one_case, struct study_cost *out) {
    const struct surface_case *surface = &one_case->surface;
    const struct grid *finest = &contact_case_finest(one_case)->grid;
    out->nx = finest->nx;
    out->ny = finest->ny;
    out->memory_bytes = surface_case_bytes(surface) + contact_scene_plain_bytes(one_case) +
                        contact_probe_bytes(one_case) + contact_cell_bytes(one_case) +
                        contact_generation_bytes(one_case) + contact_like_bytes(one_case) +
                        contact_tally_bytes(one_case) + PROCESS_BYTES;
    out->seconds = 1e-4 + 1e-9 * cost_generation(&surface->options, &surface->grid) *
                              (double)grid_points(&surface->grid);
    for (size_t l = 0; l < one_case->level_count; l++)
        for (size_t m = 0; m < one_case->model_count; m++)
            out->seconds += one_case->models[m]->seconds(one_case, m, &one_case->levels[l].grid);
    out->seconds += contact_probe_seconds(one_case) + contact_cell_seconds(one_case) +
                    contact_generation_seconds(one_case) + contact_like_seconds(one_case);
    out->result_bytes = contact_rows_bytes(one_case);
    out->runs_most = RUNS_MOST;
    out->case_seconds = case_seconds(one_case);
    bool affine = surface->spectrum.type == SPECTRUM_SELF_AFFINE;
    out->relative_error = cost_area_scatter(surface->dimension, surface_case_mean_side(surface),
                                            affine ? surface->spectrum.hurst : NAN);
}
