#include "jobs/contact/contact_press.h"
#include "core/contact/compliance.h"
#include "core/contact/contact.h"
#include "core/surface/spectrum.h"
#include "jobs/contact/contact_case.h"
#include <math.h>

/* The block of the first linear model; where there is none, a half-space. */
static struct block block_of(const struct contact_case *one_case) {
    for (size_t m = 0; m < one_case->model_count; m++)
        if (one_case->models[m]->write_mesh == NULL)
            return one_case->blocks[m];
    return (struct block){.model = MODEL_HALFSPACE, .height = INFINITY};
}

static void copy(const struct grid *grid, const struct contact_state *state, double slope,
                 double *gap, double *pressure) {
    for (size_t i = 0; i < grid_points(grid); i++) {
        gap[i] = state->gap[i];
        pressure[i] = state->p[i] / slope;
    }
}

int contact_press_once(const struct realisation *realisation, double load, double *gap,
                       double *pressure, struct error *err) {
    const struct contact_case *contact_case = realisation->study;
    const struct grid *grid = &contact_case->surface.grid;
    const struct block block = block_of(contact_case);
    struct contact_options options = CONTACT_DEFAULTS;
    struct compliance *compliance = NULL;
    struct contact *contact = NULL;
    struct contact_state state;
    struct moments moments = {0};
    options.without_tangent = true;
    int status = spectrum_moments(&contact_case->surface.spectrum, grid, &moments, err);
    if (status == 0)
        status = compliance_create(&compliance, grid, &block, err);
    if (status == 0)
        status = contact_create(&contact, compliance, &options, err);
    if (status == 0) {
        contact_set_stop(contact, realisation->stop, realisation->stop_context);
        status = contact_begin(contact, realisation->z, err);
    }
    if (status == 0)
        status = contact_press(contact, load * moments.rms_slope, &state, err);
    if (status == 0)
        copy(grid, &state, moments.rms_slope, gap, pressure);
    contact_destroy(&contact);
    compliance_destroy(&compliance);
    return status;
}
