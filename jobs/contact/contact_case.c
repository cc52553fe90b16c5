#include "jobs/contact/contact_case.h"
#include "jobs/like_parameters.h"
#include "jobs/surface_parameters.h"
#include "jobs/target.h"
#include <math.h>
#include <stdlib.h>

const struct parameter_table *const CONTACT_TABLES[] = {&CONTACT_PARAMETERS, &SURFACE_PARAMETERS,
                                                        &LIKE_PARAMETERS, &TARGET_PARAMETERS, NULL};

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
    static const double SAFETY = 10;
    /* 1 - (cosh 2x - 1)/(sinh 2x + 2x) (compliance.h), without what overflows and cancels. */
    double longest = surface_case_longest(&one_case->surface);
    double x = 2 * M_PI * one_case->blocks[model].height / longest;
    double falling = exp(-2 * x);
    if (!(falling > 0))
        return 0;
    return SAFETY * 2 * falling * (1 + 2 * x - falling) / (1 - falling * falling + 4 * x * falling);
}

void contact_case_clear(struct contact_case *one_case) {
    surface_case_clear(&one_case->surface);
    free(one_case->loads);
    free(one_case->pdf_loads);
    free(one_case->like_areas);
    free(one_case->like_gaps);
    *one_case = (struct contact_case){0};
}

size_t contact_case_control(const struct contact_case *one_case) {
    size_t found = one_case->model_count;
    for (size_t m = 0; m < one_case->model_count; m++)
        if (!one_case->models[m]->may_fail &&
            (found == one_case->model_count ||
             one_case->models[m]->rank < one_case->models[found]->rank))
            found = m;
    return found;
}

size_t contact_case_complete(const struct contact_case *one_case) {
    size_t complete = 0;
    for (size_t m = 1; m < one_case->model_count; m++)
        if (one_case->models[m]->rank > one_case->models[complete]->rank)
            complete = m;
    return complete;
}
