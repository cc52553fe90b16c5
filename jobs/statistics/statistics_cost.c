/* The cost of a statistics case, estimated before anything ran. */
#include "core/cost.h"
#include "core/surface/spectrum.h"
#include "jobs/publishing_cost.h"
#include "jobs/statistics/statistics_case.h"
#include "jobs/statistics/statistics_draws.h"
#include "jobs/statistics/statistics_law.h"
#include "jobs/statistics/statistics_levels.h"
#include "jobs/statistics/statistics_spectra.h"
#include <math.h>

/* Factor for spectra of every second point beside those of all. */
static const double CHANGES_COST = 1.25;
/* Nanoseconds a mode of the half plane (bench_statistics): its phase, and the summits of such
 * waves. */
static const double MODE_NS = 60;

/* Returns the CPU nanoseconds of one realisation that its waves take. */
static double expected_of_waves(const struct surface_case *surface) {
    const struct surface_band band = surface_case_band(surface);
    double all = MODE_NS * (double)(band.x + 1) * (double)(2 * band.y + 1);
    if (surface->options.amplitudes == AMPLITUDES_RANDOM && surface_case_band_limited(surface))
        all += cost_random_amplitudes(&surface->grid, band.x, band.y);
    return all;
}

/* Returns the CPU nanoseconds of the summits and pits of one realisation, on a grid of its
 * points. */
static double expected_of_summits(const struct statistics_case *one_case, const struct grid *grid) {
    const struct surface_band band = surface_case_sampled_band(&one_case->surface);
    size_t most_x = grid->nx / 2, most_y = grid->ny / 2;
    return 2 * cost_summits(one_case->stencil, one_case->curvature, grid,
                            band.x < most_x ? band.x : most_x, band.y < most_y ? band.y : most_y);
}

/* Returns the CPU seconds of one realisation. */
static double expected_seconds(const struct statistics_case *one_case) {
    double points = (double)grid_points(&one_case->surface.grid);
    double nanoseconds = surface_case_nanoseconds(&one_case->surface, &one_case->surface.grid);
    nanoseconds = nanoseconds * points + expected_of_waves(&one_case->surface) +
                  expected_of_summits(one_case, &one_case->surface.grid);
    for (size_t l = 0; l < one_case->level_count; l++) {
        const struct statistics_case level = statistics_level_case(one_case, l);
        nanoseconds += expected_of_summits(&level, &level.surface.grid);
    }
    if (!surface_case_band_limited(&one_case->surface))
        nanoseconds += cost_spectra(&one_case->surface.grid) * CHANGES_COST;
    double caches = surface_is_iterated(&one_case->surface.options) ? cost_caches(points)
                                                                    : cost_field_caches(points);
    return 1e-4 + 1e-9 * nanoseconds * caches + statistics_law_seconds(one_case) +
           like_patch_seconds(&one_case->like);
}

/* CPU seconds of the theories of a bin of summit heights, as in publishing_cost.h. */
static const double PROFILE_BIN_SECONDS = 1.3e-5, SURFACE_BIN_SECONDS = 8.4e-5;
/* CPU seconds of the theory of the grid: for nine-point summits, for others (F8.4). */
static const double NINE_POINT_SECONDS = 0.06, FEW_POINT_SECONDS = 0.015;
enum { CURVES = 9, HEIGHT_CURVES = 5 };

/* Assumes that the joint density has as many cells as ten realisations have summits, and that acf
 * and psd together have a point for each point of the shorter side. */
static double expected_case_seconds(const struct statistics_case *one_case, double summits) {
    const struct grid *grid = &one_case->surface.grid;
    size_t side = grid_is_profile(grid) || grid->nx < grid->ny ? grid->nx : grid->ny;
    size_t heights = one_case->height.count;
    size_t points = HEIGHT_CURVES * heights + one_case->equivalent.count + side;
    double cells = fmin(10 * summits, (double)(heights * one_case->equivalent.count) / 4);
    double theories = (double)heights * (one_case->surface.dimension == 1 ? PROFILE_BIN_SECONDS
                                                                          : SURFACE_BIN_SECONDS);
    if (one_case->surface.options.heights.type == HEIGHTS_GAUSSIAN &&
        one_case->stencil != SUMMITS_REFINED)
        theories += one_case->surface.dimension == 2 && one_case->stencil == SUMMITS_NINE_POINT
                        ? NINE_POINT_SECONDS
                        : FEW_POINT_SECONDS;
    return theories + publishing_cost(CURVES, points + (size_t)cells);
}

void statistics_case_estimate(const struct statistics_case *one_case, struct study_cost *out) {
    const struct surface_case *surface = &one_case->surface;
    const struct grid *grid = &surface->grid;
    const struct surface_band band = surface_case_band(surface);
    const struct surface_band sampled = surface_case_sampled_band(surface);
    bool wanted = statistics_case_wants_gaussian(one_case);
    double alpha;
    double summits =
        fmax(1, spectrum_expected_summits(&surface->spectrum, grid, surface->length_ratio,
                                          (double)band.x, &alpha));
    double spread = sqrt(fmax(0.05, 1 - 0.8968 / fmax(alpha, 1))); /* of summit heights */
    surface_case_estimate(surface, out);
    out->nx = grid->nx;
    out->ny = grid->ny;
    /* a list of summits doubles as it grows */
    out->memory_bytes = surface_case_bytes(surface) + statistics_law_bytes(one_case) +
                        summit_finder_bytes(grid, one_case->stencil, one_case->curvature, sampled.x,
                                            sampled.y, wanted) +
                        (wanted ? (double)grid_points(grid) * sizeof(double) : 0) +
                        statistics_tally_bytes(one_case) + statistics_levels_bytes(one_case) +
                        like_patch_bytes(&one_case->like) + statistics_draws_bytes(one_case) +
                        6 * summits * sizeof(struct summit) + spectra_bytes(one_case) +
                        PROCESS_BYTES;
    out->seconds = expected_seconds(one_case);
    for (uint64_t r = 0; r < STUDY_EARLY; r++)
        out->early_seconds[r] = statistics_law_beyond_seconds(one_case, r);
    out->case_seconds =
        expected_case_seconds(one_case, summits) + LIKE_DRAWS * statistics_draws_seconds(one_case);
    /* sum of the bins' errors over their sum: integral sqrt(p) / sqrt(N w), p near normal */
    double counted = statistics_case_symmetric(one_case) ? 2 * summits : summits; /* with pits */
    out->relative_error = 2.239 * sqrt(spread / (counted * bins_width(&one_case->height)));
}
