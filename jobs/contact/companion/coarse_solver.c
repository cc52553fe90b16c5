#include "jobs/contact/companion/coarse_solver.h"
#include "core/contact/area.h"
#include "core/contact/contact.h"
#include "core/contact/patches.h"
#include "core/cost.h"
#include "jobs/contact/contact_measure.h"
#include "jobs/contact/quantity/quantity.h"
#include <math.h>
#include <stdlib.h>

enum { COARSE_POINTS = 4 };

struct coarse_solver {
    const struct contact_case *one_case;
    struct grid grid;
    double rms_slope, rms_height;
    struct compliance *compliance; /* owned, as all below */
    struct contact *contact;
    struct area_workspace *area;
    struct patch_finder *finder;
    struct contact_quantities quantities;
};

struct contact_level coarse_level(const struct contact_case *one_case) {
    struct contact_level level = one_case->levels[0];
    bool even = level.grid.nx % 2 == 0 && (grid_is_profile(&level.grid) || level.grid.ny % 2 == 0);
    if (level.stride == 0 || !even || level.points < 2 * COARSE_POINTS)
        return level;
    level.points /= 2;
    level.stride *= 2;
    level.grid.nx /= 2;
    if (!grid_is_profile(&level.grid))
        level.grid.ny /= 2;
    return level;
}

/* Returns the half-space or layer that stands for the blocks of a case, with their coating. */
static struct block block_of(const struct contact_case *one_case, double height) {
    const struct block *first = &one_case->blocks[0];
    return (struct block){.model = MODEL_HALFSPACE,
                          .poisson = first->poisson,
                          .height = height,
                          .layer_growth = 1,
                          .coating = first->coating};
}

static struct quantity_scene quantity_scene_of(const struct contact_case *one_case,
                                               const struct grid *grid, double height) {
    return (struct quantity_scene){
        .one_case = one_case, .grid = *grid, .block = block_of(one_case, height), .exact = true};
}

static int solver_fill(struct coarse_solver *solver, double height, struct error *err) {
    const struct block block = block_of(solver->one_case, height);
    struct contact_options options = contact_case_options(solver->one_case);
    if (isfinite(options.hardness)) /* of a surface with a slope of its own */
        options.hardness = solver->one_case->hardness * solver->rms_slope;
    int status = compliance_create(&solver->compliance, &solver->grid, &block, err);
    if (status == 0)
        status = contact_create(&solver->contact, solver->compliance, &options, err);
    if (status == 0)
        status = area_workspace_create(&solver->area, solver->compliance, err);
    if (status == 0)
        status = patch_finder_create(&solver->finder, &solver->grid, err);
    const struct quantity_scene scene = quantity_scene_of(solver->one_case, &solver->grid, height);
    return status != 0 ? status : contact_quantities_create(&solver->quantities, &scene, err);
}

int coarse_solver_create(struct coarse_solver **out, const struct contact_case *one_case,
                         const struct grid *grid, double height, const struct moments *moments,
                         struct error *err) {
    struct coarse_solver *solver = array_create(1, sizeof *solver);
    if (solver == NULL)
        return error_memory(err, sizeof *solver, "a coarse contact solver");
    solver->one_case = one_case;
    solver->grid = *grid;
    solver->rms_slope = moments->rms_slope;
    solver->rms_height = moments->rms_height;
    int status = solver_fill(solver, height, err);
    if (status != 0)
        coarse_solver_destroy(&solver);
    *out = solver;
    return status;
}

void coarse_solver_destroy(struct coarse_solver **solver) {
    struct coarse_solver *gone = *solver;
    if (gone == NULL)
        return;
    contact_quantities_clear(&gone->quantities);
    patch_finder_destroy(&gone->finder);
    area_workspace_destroy(&gone->area);
    contact_destroy(&gone->contact);
    compliance_destroy(&gone->compliance);
    free(gone);
    *solver = NULL;
}

static int press_load(struct coarse_solver *solver, size_t k, const struct contact_stopper *stopper,
                      struct contact_state *out, struct error *err) {
    const struct contact_case *one_case = solver->one_case;
    if (stopper->stop(stopper->context) != 0)
        return error_set(err, ERROR_STOPPED, "stopped at load %zu of %zu", k, one_case->load_count);
    return contact_press(solver->contact, one_case->loads[k] * solver->rms_slope, out, err);
}

/* Without a solution the realisation lacks these values, and nothing else. */
int coarse_solver_press(struct coarse_solver *solver, const double *z, double *series,
                        const struct contact_stopper *stopper, struct error *err) {
    const struct contact_case *one_case = solver->one_case;
    const size_t n = contact_case_slots(one_case);
    const struct measure_context context = {.one_case = one_case,
                                            .area = solver->area,
                                            .finder = solver->finder,
                                            .quantities = &solver->quantities,
                                            .points = (double)grid_points(&solver->grid),
                                            .rms_slope = solver->rms_slope,
                                            .rms_height = solver->rms_height,
                                            .scaled = true,
                                            .stop = stopper->stop,
                                            .stop_context = stopper->context};
    struct error reason = {0};
    contact_set_stop(solver->contact, stopper->stop, stopper->context);
    int status = contact_begin(solver->contact, z, &reason);
    for (size_t k = 0; k < one_case->load_count && status == 0; k++) {
        struct contact_pressed pressed = {.stretch = 1, .open_stretch = 1};
        double values[MEASURE_OWN];
        status = press_load(solver, k, stopper, &pressed.state, &reason);
        if (status != 0)
            break;
        status = contact_measure(&context, &pressed, values, &reason);
        for (size_t a = 0; a < measure_paired(one_case) && status == 0; a++)
            series[a * n + k] = values[a];
    }
    for (size_t k = one_case->load_count - 1; one_case->unloads && k-- > 0 && status == 0;) {
        struct contact_state state;
        status = press_load(solver, k, stopper, &state, &reason);
        if (status == 0)
            contact_quantities_measure_falling(one_case, &context, &state, n, series + k);
    }
    if (status == 0)
        status = contact_quantities_complete(&solver->quantities, &context, z, n, series, &reason);
    for (size_t a = 0; status == ERROR_NUMERIC && a < measure_paired(one_case) * n; a++)
        series[a] = NAN;
    return status == 0 || status == ERROR_NUMERIC
               ? 0
               : error_set(err, status, "probe on a coarse mesh: %s", reason.text);
}

/* Quantities take more under low blocks. */
double coarse_solver_bytes(const struct contact_case *one_case, const struct grid *grid) {
    const struct block block = {.model = MODEL_HALFSPACE, .height = INFINITY};
    const struct quantity_scene scene = quantity_scene_of(one_case, grid, 1);
    const struct contact_options options = contact_case_options(one_case);
    return contact_quantities_bytes(&scene) + contact_bytes(grid, &block, &options) +
           area_workspace_bytes(grid, &block) + compliance_bytes(grid, &block);
}

double coarse_solver_seconds(const struct contact_case *one_case, const struct grid *grid) {
    const struct quantity_scene scene = quantity_scene_of(one_case, grid, INFINITY);
    return contact_case_linear_seconds(one_case, grid, false, 0) +
           contact_quantities_seconds(&scene);
}

double coarse_solver_planned_seconds(const struct contact_case *one_case, const struct grid *grid) {
    struct quantity_scene scene = quantity_scene_of(one_case, grid, INFINITY);
    scene.planned = true;
    return cost_linear_contact(grid, one_case->tolerance, one_case->load_count) +
           contact_quantities_seconds(&scene);
}
