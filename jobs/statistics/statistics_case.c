#include "jobs/statistics/statistics_case.h"
#include "core/cost.h"
#include "core/surface/spectrum_estimate.h"
#include "jobs/case_reader.h"
#include "jobs/statistics/statistics_tally.h"
#include <math.h>
#include <stdlib.h>

enum { BINS_MOST = 10000, JOINT_MOST = 1000000 };

/* The order of choices is that of core's enumerations. */
const struct parameter STATISTICS_PARAMETERS[] = {
#include "jobs/surface_parameters.inc"
    {.path = "/statistics/summits",
     .type = PARAMETER_CHOICE,
     .choices = (const char *const[]){"nine_point", "five_point", "refined", NULL},
     .sweep = true,
     .default_json = "\"nine_point\"",
     .help =
         "what a summit is: higher than 8 or 4 neighbours, or a true maximum between the points"},
    {.path = "/statistics/curvature",
     .type = PARAMETER_CHOICE,
     .choices = (const char *const[]){"finite_difference", "spectral", NULL},
     .sweep = true,
     .default_json = "\"finite_difference\"",
     .help =
         "curvature of a summit: central differences, or exact derivatives (always, if refined)"},
    {.path = "/statistics/bins/height",
     .type = PARAMETER_NUMBERS,
     .minimum = -1e6,
     .maximum = 1e6,
     .items_low = 3,
     .items_high = 3,
     .default_json = "[-4, 8, 240]",
     .help = "[low, high, count] of the histograms of heights z/sqrt(m0)"},
    {.path = "/statistics/bins/curvature",
     .type = PARAMETER_NUMBERS,
     .minimum = -1e6,
     .maximum = 1e6,
     .items_low = 3,
     .items_high = 3,
     .default_json = "[-16, 0, 160]",
     .help = "[low, high, count] of the histogram of t1 = -sqrt(3/m4) kappa_m at summits; in "
             "profiles z''/sqrt(m4)"},
};
_Static_assert(sizeof STATISTICS_PARAMETERS / sizeof *STATISTICS_PARAMETERS ==
                   STATISTICS_PARAMETER_COUNT,
               "the count in statistics_case.h");

static int read_statistics(struct statistics_case *out, const struct case_reader *reader,
                           struct error *err) {
    out->stencil = (enum summit_stencil)case_choice(reader, "/statistics/summits");
    out->curvature = (enum summit_curvature)case_choice(reader, "/statistics/curvature");
    int status = case_bins(reader, "/statistics/bins/height", BINS_MOST, &out->height, err);
    if (status == 0)
        status = case_bins(reader, "/statistics/bins/curvature", BINS_MOST, &out->equivalent, err);
    if (status == 0 && out->height.count * out->equivalent.count > JOINT_MOST)
        fault_add(reader->faults, "/statistics/bins/curvature",
                  "%zu by %zu bins are too many for the joint density: at most %d in all",
                  out->height.count, out->equivalent.count, JOINT_MOST);
    out->fingerprint = case_fingerprint(reader);
    return status;
}

int statistics_case_read(struct statistics_case *out, const cJSON *parameters,
                         struct fault_list *faults, struct error *err) {
    struct fault_list own = {0};
    struct fault_list *list = faults != NULL ? faults : &own;
    const struct case_reader reader = {parameters, STATISTICS_PARAMETERS,
                                       STATISTICS_PARAMETER_COUNT, list};
    *out = (struct statistics_case){0};
    size_t before = list->count;
    int status = surface_case_read(&out->surface, parameters, list, err);
    if (status == 0 || status == ERROR_INPUT) /* all faults at once */
        status = read_statistics(out, &reader, err);
    if (status == 0)
        status = case_status(list, before, err);
    if (status != 0)
        statistics_case_clear(out);
    fault_list_clear(&own);
    return status;
}

void statistics_case_clear(struct statistics_case *study) {
    surface_case_clear(&study->surface);
    *study = (struct statistics_case){0};
}

/* CPU seconds of one realisation. */
static double expected_seconds(const struct statistics_case *study) {
    double points = (double)grid_points(&study->surface.grid);
    double nanoseconds = cost_generation(&study->surface.options);
    nanoseconds += cost_summits(study->stencil, study->curvature);
    if (!surface_case_exact(&study->surface))
        nanoseconds += cost_spectra();
    return 1e-4 + 1e-9 * nanoseconds * points * cost_caches(points);
}

void statistics_case_estimate(const struct statistics_case *study, struct job_estimate *out) {
    const struct surface_case *surface = &study->surface;
    const struct grid *grid = &surface->grid;
    size_t mode_x = surface_case_band(surface);
    size_t mode_y = surface->dimension == 1 ? 0 : mode_x;
    double points = (double)grid_points(grid), alpha;
    double summits =
        fmax(1, spectrum_expected_summits(&surface->spectrum, grid, surface->length_ratio,
                                          (double)mode_x, &alpha));
    double spread = sqrt(fmax(0.05, 1 - 0.8968 / fmax(alpha, 1))); /* of summit heights */
    bool exact = surface_case_exact(surface);
    out->nx = grid->nx;
    out->ny = grid->ny;
    /* a list of summits doubles as it grows; spectra of height maps take a transform of the grid */
    out->memory_bytes =
        generator_bytes(grid, mode_x, mode_y, &surface->options) +
        (exact ? summit_finder_bytes(grid, study->stencil, study->curvature, mode_x, mode_y)
               : summit_finder_bytes(grid, study->stencil, study->curvature, grid->nx / 2,
                                     grid->ny / 2)) +
        statistics_tally_bytes(study) + 2 * summits * sizeof(struct summit) +
        (exact ? 0 : 24 * points) + 6e6;
    out->seconds = expected_seconds(study);
    /* sum of the bins' errors over their sum: integral sqrt(p) / sqrt(N w), p near normal */
    out->relative_error = 2.239 * sqrt(spread / (summits * bins_width(&study->height)));
}
