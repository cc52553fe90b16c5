/* From measured or prescribed spectra to the curves "psd" and "acf" with their errors. */
#include "core/statistics/prescribed.h"
#include "core/statistics/richardson.h"
#include "core/statistics/roughness.h"
#include "jobs/statistics/statistics_spectra.h"
#include <math.h>

enum {
    ACF_GRID = 1024
}; /* points a side that the prescribed autocorrelation is sampled on, at most
    * unless the band needs more: a long case would cost a transform of its grid */

/* Of means over rings in their width; bounds by one change do not depend on it. */
static const double CHANGE_ORDER = 2;

/* Columns of a curve, in the result's arena. */
struct spectrum_columns {
    double *x, *y, *standard_error, *theory;
    /* Of an autocorrelation, at every second lag (roughness.h); and the standard error of that */
    double *change, *chance;
};
static int columns_create(struct case_result *result, struct spectrum_columns *out, size_t n,
                          struct error *err) {
    double *x = result_numbers(result, 6 * n);
    if (x == NULL)
        return error_memory(err, n * 6 * sizeof *x, "a curve");
    *out = (struct spectrum_columns){x, x + n, x + 2 * n, x + 3 * n, x + 4 * n, x + 5 * n};
    return 0;
}

static int add_curve(struct case_result *result, struct curve *curve, const double *theory,
                     struct error *err) {
    curve->theories[curve->theory_count++] = (struct theory){"prescribed", theory};
    return result_add_curve(result, curve, err);
}

/* --- the error of discretisation --- */

/* Rows of the error of a curve of n points, zeros in the result's arena. */
static int error_create(struct case_result *result, struct curve *curve, size_t n, double **bound,
                        struct error *err) {
    double *rows = result_numbers(result, 3 * n);
    if (rows == NULL)
        return error_memory(err, 3 * n * sizeof *rows, "errors of a curve");
    curve->errors[ERROR_DISCRETISATION] = (struct curve_error){.applies = true,
                                                               .value = rows,
                                                               .bound = rows + n,
                                                               .standard_error = rows + 2 * n,
                                                               .order = NAN};
    *bound = rows + n;
    return 0;
}

/* A change by twice as far points as a bound, and the standard error of that. */
static struct estimate change_bound(struct estimate change) {
    const struct mesh_changes changes = {
        .fine = change.value, .coarse = NAN, .fine_ratio = 2, .coarse_ratio = NAN};
    struct mesh_error mesh = mesh_error(&changes, CHANGE_ORDER);
    return (struct estimate){mesh.bound, mesh.weight * change.standard_error};
}

/* Waves of a band below the grid's own are told without error: points of the surface are samples
 * of it, which no wave is folded into. Heights that are placed point by point have waves beyond:
 * what every second point folds in bounds that, as far as its rings go. Of an exponential
 * autocorrelation the spectrum itself goes as far as the grid's. */
static int density_error(const struct statistics_case *one_case,
                         const struct statistics_tally *tally, const double *reference,
                         struct case_result *result, struct curve *curve, struct error *err) {
    bool limited = surface_case_band_limited(&one_case->surface);
    size_t n = curve->n, known = limited ? 0 : tally->density_change.size;
    double *bound;
    if (limited ? one_case->surface.spectrum.type == SPECTRUM_EXPONENTIAL_ACF : known == 0)
        return 0;
    int status = error_create(result, curve, n, &bound, err);
    if (status != 0 || limited)
        return status;
    double *value = bound - n, *standard_error = bound + n;
    for (size_t a = 0; a < n; a++) {
        struct estimate least = {NAN, NAN};
        if (a + 1 < known) /* ring 0 is none of the curve's */
            least = change_bound(
                tally_sums_mean(&tally->density_change, a + 1, tally->points.realisations));
        value[a] = isnan(least.value) ? (double)NAN : 0;
        bound[a] = least.value * reference[a + 1];
        standard_error[a] = least.standard_error * reference[a + 1];
    }
    return 0;
}

/* NaN where either is. */
static double larger(double a, double b) {
    return isnan(a) || a > b ? a : b;
}

/* What twice as wide rings change, as a bound, at every second lag. */
static struct estimate ring_bound(const struct spectrum_columns *columns, size_t n, size_t lag) {
    if (2 * lag >= n)
        return (struct estimate){0, 0};
    return change_bound((struct estimate){columns->change[lag], columns->chance[lag]});
}

/* Means over rings as wide as the grid's spacing are not those over circles. What rings twice as
 * wide change bounds that, at the lags of theirs and near them: where points of a ring lie happens
 * to suit one lag and not the next. The origin is a ring of its own. */
static int correlation_error(const struct spectrum_columns *columns, size_t n,
                             struct case_result *result, struct curve *curve, struct error *err) {
    double *bound;
    if (isnan(columns->change[0]))
        return 0;
    int status = error_create(result, curve, n, &bound, err);
    for (size_t a = 1; a < n && status == 0; a++) {
        size_t below = a / 2;
        for (size_t lag = a % 2 == 0 ? below - 1 : below; lag <= below + 1; lag++) {
            struct estimate near = ring_bound(columns, n, lag);
            bound[a] = larger(bound[a], near.value);
            bound[n + a] = larger(bound[n + a], near.standard_error);
        }
    }
    return status;
}

/* Of surfaces with waves beyond the grid's, what was measured takes the place of what the spectrum
 * tells; NaN where it was not. */
static void correlation_changes(const struct statistics_case *one_case,
                                const struct statistics_tally *tally,
                                const struct spectrum_columns *columns, size_t n) {
    if (surface_case_band_limited(&one_case->surface))
        return;
    for (size_t a = 0; 2 * a < n; a++) {
        struct estimate mean = {NAN, NAN};
        if (a < tally->correlation_change.size)
            mean = tally_sums_mean(&tally->correlation_change, a, tally->points.realisations);
        columns->change[a] = mean.value;
        columns->chance[a] = mean.standard_error;
    }
}

/* --- curves --- */

static int density_curve(const struct statistics_case *one_case, const struct modes *modes,
                         const struct statistics_tally *tally, struct case_result *result,
                         struct error *err) {
    size_t n = radial_bins(&modes->grid), last = n - 1;
    bool exact = surface_case_exact(&one_case->surface);
    struct curve curve = curve_named("psd", "k lambda_s", "power spectral density");
    struct spectrum_columns columns, reference;
    int status = columns_create(result, &columns, n, err);
    if (status == 0)
        status = columns_create(result, &reference, n, err);
    if (status != 0)
        return status;
    spectra_reference(modes, reference.x, reference.y);
    psd_of_band(modes, reference.x, reference.theory);
    /* Measured densities are of all waves of a ring; of surfaces that have none but those of the
     * band they are told over these. */
    for (size_t a = 0; a < n && surface_case_band_limited(&one_case->surface); a++)
        reference.y[a] = reference.theory[a];
    status = psd_prescribed(&one_case->surface.spectrum, modes, columns.x, columns.theory, err);
    if (status != 0)
        return status;
    for (size_t a = 0; a < n; a++) {
        struct estimate estimate = {reference.theory[a], 0};
        if (!exact) {
            estimate = tally_sums_mean(&tally->density, a, tally->points.realisations);
            estimate.value *= reference.y[a];
            estimate.standard_error *= reference.y[a];
        }
        columns.y[a] = estimate.value;
        columns.standard_error[a] = estimate.standard_error;
    }
    while (exact && last > 1 && !(columns.y[last] > 0))
        last--;
    /* ring 0 is the mean height */
    curve_set_points(&curve, last, columns.x + 1, columns.y + 1, columns.standard_error + 1);
    status = density_error(one_case, tally, reference.y, result, &curve, err);
    if (status != 0)
        return status;
    return add_curve(result, &curve, columns.theory + 1, err);
}

static size_t correlation_side(size_t side, size_t band) {
    size_t needed = 2 * band + 2;
    if (side <= ACF_GRID || side <= needed)
        return side;
    return needed > ACF_GRID ? needed : ACF_GRID;
}

/* Both sides of a rectangle are coarsened alike, to as many points as a square has in all, and even
 * numbers, whose halves tell an error. */
static void coarsen_rectangle(struct grid *grid, struct surface_band band) {
    double nx = (double)grid->nx, ny = (double)grid->ny;
    double needed = fmax((2 * (double)band.x + 2) / nx, (2 * (double)band.y + 2) / ny);
    double part = fmax(ACF_GRID / sqrt(nx * ny), needed);
    if (part >= 1)
        return;
    grid->nx = 2 * (size_t)ceil(part * nx / 2);
    grid->ny = 2 * (size_t)ceil(part * ny / 2);
}

/* The grid that the prescribed autocorrelation is sampled on. */
static struct grid correlation_grid(const struct surface_case *surface) {
    const struct surface_band band = surface_case_band(surface);
    struct grid grid = surface->grid;
    bool profile = grid_is_profile(&grid);
    if (!surface_case_exact(surface))
        return grid;
    if (profile || grid.nx == grid.ny) {
        grid.nx = correlation_side(grid.nx, band.x);
        grid.ny = profile ? 1 : grid.nx;
    } else {
        coarsen_rectangle(&grid, band);
    }
    return grid;
}

/* Computes the autocorrelation at *n lags: y is that of the discrete spectrum, theory what it was
 * made from. */
static int prescribed_correlation(const struct statistics_case *one_case, const struct modes *modes,
                                  struct case_result *result, struct spectrum_columns *out,
                                  size_t *n, struct error *err) {
    struct modes *coarse = NULL;
    struct grid grid = correlation_grid(&one_case->surface);
    int status = 0;
    *n = acf_lags(&grid);
    if (grid.nx != modes->grid.nx) {
        status = modes_create(&coarse, &one_case->surface.spectrum, &grid, err);
        modes = coarse;
    }
    if (status == 0)
        status = columns_create(result, out, *n, err);
    if (status == 0)
        status = acf_of_modes_changes(modes, out->x, out->y, out->change, err);
    if (status == 0)
        status = acf_prescribed(&one_case->surface.spectrum, modes, out->x, out->theory, err);
    modes_destroy(&coarse);
    return status;
}

static int correlation_curve(const struct statistics_case *one_case, const struct modes *modes,
                             const struct statistics_tally *tally, struct case_result *result,
                             struct error *err) {
    bool exact = surface_case_exact(&one_case->surface);
    struct curve curve = curve_named("acf", "lag/lambda_s", "autocorrelation");
    struct spectrum_columns columns;
    size_t n;
    int status = prescribed_correlation(one_case, modes, result, &columns, &n, err);
    if (status != 0)
        return status;
    for (size_t a = 0; a < n; a++) {
        struct estimate estimate = {columns.y[a], 0};
        if (!exact)
            estimate = tally_sums_mean(&tally->correlation, a, tally->points.realisations);
        columns.y[a] = estimate.value;
        columns.standard_error[a] = estimate.standard_error;
    }
    curve_set_points(&curve, n, columns.x, columns.y, columns.standard_error);
    correlation_changes(one_case, tally, &columns, n);
    status = correlation_error(&columns, n, result, &curve, err);
    if (status != 0)
        return status;
    return add_curve(result, &curve, columns.theory, err);
}

int spectra_curves(const struct statistics_case *one_case, const struct modes *modes,
                   const struct statistics_tally *tally, struct case_result *result,
                   struct error *err) {
    int status = density_curve(one_case, modes, tally, result, err);
    return status != 0 ? status : correlation_curve(one_case, modes, tally, result, err);
}

int spectra_prescribed(const struct statistics_case *one_case, const struct modes *modes,
                       struct case_result *result, struct error *err) {
    struct statistics_case exact = *one_case; /* borrows what it points to */
    exact.surface.options.keep = KEEP_SPECTRUM;
    exact.surface.options.amplitudes = AMPLITUDES_FIXED;
    int status = spectra_curves(&exact, modes, NULL, result, err);
    for (size_t a = 0; a < result->curve_count && status == 0; a++) /* nothing was measured */
        result->curves[a].errors[ERROR_DISCRETISATION] = (struct curve_error){.applies = false};
    return status;
}
