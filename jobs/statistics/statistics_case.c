#include "jobs/statistics/statistics_case.h"
#include "jobs/surface_parameters.h"
#include "jobs/target.h"

enum { BINS_MOST = 10000, JOINT_MOST = 1000000 };

const struct parameter_table *const STATISTICS_TABLES[] = {
    &SURFACE_PARAMETERS, &STATISTICS_PARAMETERS, &TARGET_PARAMETERS, NULL};

static void fill(struct statistics_case *out, struct values *values) {
    out->stencil = (enum summit_stencil)values_choice(values, "/statistics/summits");
    out->curvature = (enum summit_curvature)values_choice(values, "/statistics/curvature");
    values_bins(values, "/statistics/bins/height", BINS_MOST, &out->height);
    values_bins(values, "/statistics/bins/curvature", BINS_MOST, &out->equivalent);
    if (out->height.count * out->equivalent.count > JOINT_MOST)
        values_fault(values, "/statistics/bins/curvature",
                     "%zu by %zu bins are too many for the joint density: at most %d in all",
                     out->height.count, out->equivalent.count, JOINT_MOST);
}

int statistics_case_read(struct statistics_case *out, const cJSON *parameters,
                         struct fault_list *faults, struct error *err) {
    struct values *values = NULL;
    *out = (struct statistics_case){0};
    int status = values_create(&values, parameters, STATISTICS_TABLES, faults, err);
    if (status == 0)
        status = surface_case_fill(&out->surface, values, err);
    if (status == 0) {
        fill(out, values);
        status = values_status(values, err);
    }
    if (status != 0)
        statistics_case_clear(out);
    values_destroy(&values);
    return status;
}

void statistics_case_clear(struct statistics_case *one_case) {
    surface_case_clear(&one_case->surface);
    *one_case = (struct statistics_case){0};
}
