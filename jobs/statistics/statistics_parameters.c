/* The rows of /statistics/... */
#include "jobs/statistics/statistics_case.h"

static const struct choice STENCILS[] = {{"nine_point", SUMMITS_NINE_POINT},
                                         {"five_point", SUMMITS_FIVE_POINT},
                                         {"refined", SUMMITS_REFINED},
                                         {0}};
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
             "the same surfaces are seen, too: two coarser ones and the surface's own tell the "
             "discretisation error, one a bound of it"},
};
const struct parameter_table STATISTICS_PARAMETERS = {"statistics", ROWS,
                                                      sizeof ROWS / sizeof *ROWS};
