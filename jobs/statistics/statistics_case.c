#include "jobs/statistics/statistics_case.h"
#include "core/surface/translation/translation.h"
#include "jobs/like/like_hold.h"
#include "jobs/like/like_parameters.h"
#include "jobs/surface/surface_parameters.h"
#include "jobs/target.h"
#include <math.h>
#include <stdlib.h>

/* The rows of /statistics/... */

#define STENCIL(type, name, value) {name, SUMMITS_##type},
static const struct choice STENCILS[] = {RUGO_SUMMIT_RULES(STENCIL){0}};
static const struct choice CURVATURES[] = {
    {"finite_difference", CURVATURE_FINITE_DIFFERENCE}, {"spectral", CURVATURE_SPECTRAL}, {0}};

static const struct parameter ROWS[] = {
    {.path = "/statistics/summits",
     .type = PARAMETER_CHOICE,
     .choices = STENCILS,
     .sweep = true,
     .default_json = "\"nine_point\"",
     .example_json = "\"refined\"",
     .help =
         "what a summit is: higher than 8 or 4 neighbours, or a true maximum between the points"},
    {.path = "/statistics/curvature",
     .type = PARAMETER_CHOICE,
     .choices = CURVATURES,
     .sweep = true,
     .default_json = "\"finite_difference\"",
     .example_json = "\"spectral\"",
     .help =
         "curvature of a summit: central differences, or exact derivatives (always, if refined)"},
    {.path = "/statistics/bins/height",
     .type = PARAMETER_NUMBERS,
     .minimum = -1e6,
     .maximum = 1e6,
     .items_low = 3,
     .items_high = 3,
     .default_json = "[-4, 8, 240]",
     .example_json = "[-4, 4, 80]",
     .help = "[low, high, count] of the histograms of heights z/sqrt(m0)"},
    {.path = "/statistics/bins/curvature",
     .type = PARAMETER_NUMBERS,
     .minimum = -1e6,
     .maximum = 1e6,
     .items_low = 3,
     .items_high = 3,
     .default_json = "[-16, 0, 160]",
     .example_json = "[-8, 0, 80]",
     .help = "[low, high, count] of the histogram of t1 = -sqrt(3/m4) kappa_m at summits; in "
             "profiles z''/sqrt(m4)"},
    {.path = "/statistics/levels",
     .type = PARAMETER_NUMBERS,
     .minimum = 2,
     .maximum = 1e4,
     .items_low = 1,
     .items_high = STATISTICS_LEVELS_MOST,
     .later = true,
     .example_json = "[4, 8]",
     .help = "rising values of points_per_wavelength, whole parts of the surface's own, at which "
             "the same surfaces are seen, too: two coarser ones and the surface's own give the "
             "discretisation error, one a bound of it"},
};
const struct parameter_table STATISTICS_PARAMETERS = {"statistics", ROWS,
                                                      sizeof ROWS / sizeof *ROWS};

enum { BINS_MOST = 10000, JOINT_MOST = 1000000 };
static const char LEVELS[] = "/statistics/levels";

const struct parameter_table *const STATISTICS_TABLES[] = {
    &SURFACE_PARAMETERS, &LIKE_PARAMETERS, &STATISTICS_PARAMETERS, &TARGET_PARAMETERS, NULL};

/* Adds a level if it has every n-th point of the surface; the surface's own grid is no level. */
static void add_level(struct statistics_case *out, struct values *values, double own, double points,
                      const struct grid *grid) {
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

/* Reads levels, which are given from coarse to fine, and kept from fine to coarse. surface: NULL
 * where it is at fault; then only the levels themselves are checked. */
static int read_levels(struct statistics_case *out, struct values *values,
                       const struct surface_case *surface, struct error *err) {
    double *points, own = values_number(values, "/surface/points_per_wavelength");
    size_t n;
    int status = values_numbers(values, LEVELS, &points, &n, err);
    for (size_t l = n; l > 0; l--) {
        if (l < n && points[l - 1] >= points[l])
            values_fault(values, LEVELS, "%g follows %g; allowed: rising values", points[l],
                         points[l - 1]);
        else if (points[l - 1] > own)
            values_fault(values, LEVELS, "%g is finer than the surface, which has %g",
                         points[l - 1], own);
        else if (surface != NULL)
            add_level(out, values, own, points[l - 1], &surface->grid);
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
    const struct surface_case *surface;
    *out = (struct statistics_case){0};
    int status = values_create(&values, parameters, STATISTICS_TABLES, faults, err);
    if (status == 0)
        status = surface_case_fill(&out->surface, values, &surface, err);
    if (status == 0)
        status = like_case_fill(&out->like, values, surface, err);
    if (status == 0 && surface != NULL)
        status = like_hold_read(&out->surface, &out->like, values, err);
    if (status == 0)
        status = read_levels(out, values, surface, err);
    if (status == 0) {
        fill(out, values);
        status = values_status(values, err);
    }
    if (status != 0)
        statistics_case_clear(out);
    values_destroy(&values);
    return status;
}

bool statistics_case_wants_gaussian(const struct statistics_case *one_case) {
    return surface_case_translated(&one_case->surface) &&
           summit_needs_band(one_case->stencil, one_case->curvature);
}

int statistics_case_translate(const struct statistics_case *one_case, struct summit_finder *finder,
                              double height, struct error *err) {
    if (!statistics_case_wants_gaussian(one_case))
        return 0;
    return summit_finder_translate(finder, translation_function(one_case->surface.translation),
                                   height, err);
}

void statistics_case_clear(struct statistics_case *one_case) {
    surface_case_clear(&one_case->surface);
    *one_case = (struct statistics_case){0};
}
