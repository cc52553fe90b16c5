#include "jobs/contact/contact_coarse.h"
#include "core/contact/contact.h"
#include "core/cost.h"
#include "jobs/contact/contact_measure.h"
#include <math.h>
#include <stdlib.h>

struct contact_coarse {
    const struct contact_case *one_case;
    struct grid grid;
    double rms_slope, rms_height;
    struct compliance *compliance; /* owned, as all below */
    struct contact *solver;
    struct area_workspace *area;
    struct patch_finder *finder;
};

static int coarse_fill(struct contact_coarse *coarse, double height, struct error *err) {
    struct block block = {.model = MODEL_HALFSPACE, .height = height, .layer_growth = 1};
    struct contact_options options = CONTACT_DEFAULTS;
    options.tolerance = coarse->one_case->tolerance;
    options.without_tangent = !coarse->one_case->stiffness;
    int status = compliance_create(&coarse->compliance, &coarse->grid, &block, err);
    if (status == 0)
        status = contact_create(&coarse->solver, coarse->compliance, &options, err);
    if (status == 0)
        status = area_workspace_create(&coarse->area, coarse->compliance, err);
    return status != 0 ? status : patch_finder_create(&coarse->finder, &coarse->grid, err);
}

int contact_coarse_create(struct contact_coarse **out, const struct contact_case *one_case,
                          const struct grid *grid, double height, const struct moments *moments,
                          struct error *err) {
    struct contact_coarse *coarse = array_create(1, sizeof *coarse);
    if (coarse == NULL)
        return error_memory(err, sizeof *coarse, "a coarse contact solver");
    coarse->one_case = one_case;
    coarse->grid = *grid;
    coarse->rms_slope = moments->rms_slope;
    coarse->rms_height = moments->rms_height;
    int status = coarse_fill(coarse, height, err);
    if (status != 0)
        contact_coarse_destroy(&coarse);
    *out = coarse;
    return status;
}

void contact_coarse_destroy(struct contact_coarse **coarse) {
    struct contact_coarse *gone = *coarse;
    if (gone == NULL)
        return;
    patch_finder_destroy(&gone->finder);
    area_workspace_destroy(&gone->area);
    contact_destroy(&gone->solver);
    compliance_destroy(&gone->compliance);
    free(gone);
    *coarse = NULL;
}

static void clear_values(const struct contact_case *one_case, size_t cell,
                         struct contact_tally *tally) {
    for (size_t a = 0; a < MEASURE_PAIRED; a++)
        for (size_t k = 0; k < one_case->load_count; k++)
            contact_tally_values(tally, (enum contact_measure)a)[cell + k] = NAN;
}

/* A probe that finds no answer costs the realisation its values of the probe, and nothing else. */
int contact_coarse_solve(struct contact_coarse *coarse, const double *z, size_t cell,
                         struct contact_tally *tally, const struct contact_stopper *stopper,
                         struct error *err) {
    const struct contact_case *one_case = coarse->one_case;
    const struct contact_meter meter = {.area = coarse->area,
                                        .finder = coarse->finder,
                                        .points = (double)grid_points(&coarse->grid),
                                        .rms_slope = coarse->rms_slope,
                                        .rms_height = coarse->rms_height,
                                        .scaled = true};
    struct error reason = {0};
    contact_set_stop(coarse->solver, stopper->stop, stopper->context);
    int status = contact_begin(coarse->solver, z, &reason);
    for (size_t k = 0; k < one_case->load_count && status == 0; k++) {
        struct contact_pressed pressed = {.stretch = 1, .open_stretch = 1};
        double values[MEASURE_OWN];
        if (stopper->stop(stopper->context) != 0)
            return error_set(err, ERROR_STOPPED, "stopped at load %zu of %zu", k,
                             one_case->load_count);
        status = contact_press(coarse->solver, one_case->loads[k] * coarse->rms_slope,
                               &pressed.state, &reason);
        if (status != 0)
            break;
        contact_measure(&meter, &pressed, values);
        for (size_t a = 0; a < MEASURE_PAIRED; a++)
            contact_tally_values(tally, (enum contact_measure)a)[cell + k] = values[a];
    }
    if (status == ERROR_NUMERIC)
        clear_values(one_case, cell, tally);
    else if (status != 0)
        return error_set(err, status, "probe on a coarse mesh: %s", reason.text);
    return 0;
}

void contact_coarse_copy(const struct contact_case *one_case, size_t from, size_t to,
                         struct contact_tally *tally) {
    for (size_t a = 0; a < MEASURE_PAIRED; a++) {
        double *values = contact_tally_values(tally, (enum contact_measure)a);
        for (size_t k = 0; k < one_case->load_count; k++)
            values[to + k] = values[from + k];
    }
}

double contact_coarse_bytes(const struct grid *grid) {
    const struct block block = {.model = MODEL_HALFSPACE, .height = INFINITY};
    double patches = 16 * (double)grid_points(grid);
    return patches + contact_bytes(grid) + area_workspace_bytes(grid, &block) +
           compliance_bytes(grid, &block);
}

double contact_coarse_seconds(const struct contact_case *one_case, const struct grid *grid) {
    return cost_linear_contact(grid, one_case->tolerance, one_case->load_count);
}
