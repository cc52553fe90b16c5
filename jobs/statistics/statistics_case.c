#include "jobs/statistics/statistics_case.h"
#include "jobs/like_parameters.h"
#include "jobs/surface_parameters.h"
#include "jobs/target.h"
#include <math.h>
#include <stdlib.h>

enum { BINS_MOST = 10000, JOINT_MOST = 1000000 };
static const char LEVELS[] = "/statistics/levels";

const struct parameter_table *const STATISTICS_TABLES[] = {
    &SURFACE_PARAMETERS, &LIKE_PARAMETERS, &STATISTICS_PARAMETERS, &TARGET_PARAMETERS, NULL};

/* Every level takes a whole part of the points of the surface; its own is among them or not. */
static void add_level(struct statistics_case *out, struct values *values, double own,
                      double points) {
    const struct grid *grid = &out->surface.grid;
    double stride = rint(own / points);
    if (!(fabs(stride * points - own) <= 1e-9 * own) || grid->nx % (size_t)stride != 0 ||
        (!grid_is_profile(grid) && grid->ny % (size_t)stride != 0))
        values_fault(values, LEVELS,
                     "%g is no whole part of the surface's points_per_wavelength of %g, with %zu "
                     "points a side: levels are made of its own points",
                     points, own,
                     grid->nx % (size_t)stride != 0 || grid_is_profile(grid) ? grid->nx : grid->ny);
    else if (stride > 1)
        out->strides[out->level_count++] = (size_t)stride;
}

/* Levels are given from coarse to fine, and kept from fine to coarse. */
static int read_levels(struct statistics_case *out, struct values *values, struct error *err) {
    double *points, own = values_number(values, "/surface/points_per_wavelength");
    size_t n;
    int status = values_numbers(values, LEVELS, &points, &n, err);
    if (status == 0 && out->surface.grid.nx > 0) /* else at fault already */
        for (size_t l = n; l > 0; l--) {
            if (l < n && points[l - 1] >= points[l])
                values_fault(values, LEVELS, "%g follows %g; allowed: rising values", points[l],
                             points[l - 1]);
            else if (points[l - 1] <= own && out->level_count < STATISTICS_LEVELS_MOST)
                add_level(out, values, own, points[l - 1]);
            else
                values_fault(values, LEVELS, "%g is finer than the surface, which has %g",
                             points[l - 1], own);
        }
    free(points);
    return status;
}

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
    if (status == 0)
        status = like_case_fill(&out->like, values, &out->surface, err);
    if (status == 0)
        status = read_levels(out, values, err);
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
