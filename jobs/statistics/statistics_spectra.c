#include "jobs/statistics/statistics_spectra.h"
#include "core/statistics/heights/roughness.h"
#include "core/statistics/spectra/prescribed.h"
#include "core/statistics/uncertainty/richardson.h"
#include "jobs/statistics/statistics_theory.h"
#include <math.h>
#include <stdlib.h>

/* Returns the grid of every second point; *halved: all its sides had even numbers of points. */
static struct grid coarser(const struct grid *grid, bool *halved) {
    struct grid out = *grid;
    *halved = grid->nx % 2 == 0 && (grid_is_profile(grid) || grid->ny % 2 == 0);
    out.nx = grid->nx / 2;
    out.ny = grid_is_profile(grid) ? 1 : grid->ny / 2;
    return out;
}

/* Returns the number of rings whose waves a grid has in all directions. */
static size_t whole_rings(const struct grid *grid) {
    double side = grid_is_profile(grid) ? grid->lx : fmin(grid->lx, grid->ly);
    double most = floor((double)grid->nx / 2) * side / grid->lx;
    if (!grid_is_profile(grid))
        most = fmin(most, floor((double)grid->ny / 2) * side / grid->ly);
    return (size_t)most;
}

/* Changes are measured where surfaces have waves beyond the grid's. */
struct spectra_sizes spectra_sizes(const struct statistics_case *one_case) {
    const struct grid *grid = &one_case->surface.grid;
    struct spectra_sizes out = {0, 0, 0, 0};
    bool halved;
    const struct grid coarse = coarser(grid, &halved);
    if (surface_case_exact(&one_case->surface))
        return out;
    out.densities = radial_bins(grid);
    out.correlations = acf_lags(grid);
    if (halved && !surface_case_band_limited(&one_case->surface)) {
        out.density_changes = whole_rings(&coarse);
        out.correlation_changes = acf_lags(&coarse);
    }
    return out;
}

/* Fills the densities by which measured ones are divided before they are summed, so that sums are
 * exact: radial_bins prescribed densities, their mean where that is 0. */
static void spectra_reference(const struct modes *modes, double *wave_number, double *density) {
    size_t n = radial_bins(&modes->grid), used = 0;
    double sum = 0;
    psd_of_modes(modes, wave_number, density);
    for (size_t a = 0; a < n; a++) {
        sum += density[a];
        used += density[a] > 0;
    }
    for (size_t a = 0; a < n; a++)
        if (!(density[a] > 0))
            density[a] = sum / (double)used;
}

/* Surfaces with waves beyond the band are measured by a transform of all waves of the grid. */
static int whole_create(struct spectra *out, const struct grid *grid, struct error *err) {
    bool halved;
    const struct grid coarse = coarser(grid, &halved);
    bool changes = out->sizes.density_changes > 0;
    int status = whole_band_create(&out->whole, grid, changes ? &coarse : NULL, err);
    if (status == 0 && changes)
        status = spectral_band_create(&out->coarse, &coarse, coarse.nx / 2, coarse.ny / 2, err);
    return status;
}

int spectra_create(struct spectra *out, const struct statistics_case *one_case,
                   const struct modes *modes, struct error *err) {
    *out = (struct spectra){.sizes = spectra_sizes(one_case)};
    const struct grid *grid = &modes->grid;
    size_t densities = out->sizes.densities, correlations = out->sizes.correlations;
    bool limited = surface_case_band_limited(&one_case->surface);
    int status = 0;
    if (densities == 0)
        return 0;
    size_t most = densities > correlations ? densities : correlations;
    out->measured = array_create(most, sizeof(double));
    out->changed = array_create(most, sizeof(double));
    out->reference = array_create(most, sizeof(double));
    if (out->measured == NULL || out->changed == NULL || out->reference == NULL)
        status = error_memory(err, 3 * most * sizeof(double), "spectra");
    if (status == 0)
        status = spectral_band_create(&out->band, grid, limited ? modes->mode_x : grid->nx / 2,
                                      limited ? modes->mode_y : grid->ny / 2, err);
    if (status == 0 && !limited)
        status = whole_create(out, grid, err);
    if (status == 0)
        spectra_reference(modes, out->measured, out->reference);
    else
        spectra_clear(out);
    return status;
}

double spectra_bytes(const struct statistics_case *one_case) {
    const struct grid *grid = &one_case->surface.grid;
    const struct surface_band own = surface_case_own_band(&one_case->surface);
    const struct spectra_sizes sizes = spectra_sizes(one_case);
    bool halved;
    const struct grid coarse = coarser(grid, &halved);
    if (surface_case_exact(&one_case->surface))
        return 0;
    double bytes = spectral_band_bytes(grid, own.x, own.y);
    if (surface_case_band_limited(&one_case->surface))
        return bytes;
    bytes += whole_band_bytes(grid, sizes.density_changes > 0 ? &coarse : NULL);
    if (sizes.density_changes > 0)
        bytes += spectral_band_bytes(&coarse, coarse.nx / 2, coarse.ny / 2);
    return bytes;
}

void spectra_clear(struct spectra *spectra) {
    spectral_band_destroy(&spectra->band);
    spectral_band_destroy(&spectra->coarse);
    whole_band_destroy(&spectra->whole);
    free(spectra->measured);
    free(spectra->changed);
    free(spectra->reference);
    *spectra = (struct spectra){.band = NULL};
}

const struct modes *spectra_modes(struct spectra *spectra, const struct realisation *realisation,
                                  double *mean) {
    *mean = 0;
    if (spectra->whole == NULL)
        return realisation->modes;
    *mean = whole_band_measure(spectra->whole, realisation->z);
    return whole_band_modes(spectra->whole);
}

static void add_density(struct spectra *spectra, const struct modes *modes,
                        const struct modes *coarser, struct statistics_tally *tally) {
    const double *measured = spectra->measured, *reference = spectra->reference;
    spectral_band_density(spectra->band, modes, spectra->measured);
    for (size_t a = 0; a < spectra->sizes.densities; a++)
        tally_sums_add(&tally->density, a, measured[a] / reference[a], 1);
    if (coarser == NULL)
        return;
    spectral_band_density(spectra->coarse, coarser, spectra->changed);
    for (size_t a = 0; a < spectra->sizes.density_changes; a++)
        tally_sums_add(&tally->density_change, a,
                       (measured[a] - spectra->changed[a]) / reference[a], 1);
}

static void add_correlation(struct spectra *spectra, const struct modes *modes,
                            const struct modes *coarser, struct statistics_tally *tally) {
    const double *measured = spectra->measured;
    spectral_band_correlation(spectra->band, modes, spectra->measured);
    for (size_t a = 0; a < spectra->sizes.correlations; a++)
        tally_sums_add(&tally->correlation, a, measured[a], 1);
    if (coarser == NULL)
        return;
    spectral_band_correlation(spectra->coarse, coarser, spectra->changed);
    for (size_t a = 0; a < spectra->sizes.correlation_changes; a++)
        tally_sums_add(&tally->correlation_change, a, measured[2 * a] - spectra->changed[a], 1);
}

void spectra_measure(struct spectra *spectra, const struct modes *modes,
                     struct statistics_tally *tally) {
    const struct modes *coarser = NULL;
    if (spectra->band == NULL)
        return;
    if (spectra->whole != NULL)
        coarser = whole_band_coarser(spectra->whole);
    add_density(spectra, modes, coarser, tally);
    add_correlation(spectra, modes, coarser, tally);
}

/* The curves "psd" and "acf" with their errors, from measured or prescribed spectra. */

enum {
    ACF_GRID = 1024
}; /* points a side that the prescribed autocorrelation is sampled on, at most
    * unless the band needs more: a long case would cost a transform of its grid */

/* Order of the error of means over rings in the width of a ring; bounds by one change do not depend
 * on it. */
static const double CHANGE_ORDER = 2;

/* Columns of a curve, in the result's arena. */
struct spectrum_columns {
    double *x, *y, *standard_error, *theory;
    /* Of an autocorrelation, at every second lag (roughness.h): the change, and its standard
     * error. */
    double *change, *change_error;
};
static int columns_create(struct case_result *result, struct spectrum_columns *out, size_t n,
                          struct error *err) {
    double *x = result_numbers(result, 6 * n);
    if (x == NULL)
        return error_memory(err, n * 6 * sizeof *x, "a curve");
    *out = (struct spectrum_columns){x, x + n, x + 2 * n, x + 3 * n, x + 4 * n, x + 5 * n};
    return 0;
}

/* theory: of the spectrum asked for, which is that of the random part beside grooves; a stratified
 * face has none, as its slopes alone are known. */
static int add_curve(const struct surface_case *surface, struct case_result *result,
                     struct curve *curve, const double *theory, struct error *err) {
    if (surface->plateau == NULL)
        curve->theories[curve->theory_count++] =
            (struct theory){surface->grooves != NULL ? STATISTICS_REST : "prescribed", theory};
    return result_add_curve(result, curve, err);
}

/* --- the error of discretisation --- */

/* Makes the error of a curve of n points, with zeros in the result's arena. */
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

/* Returns a bound from a change by twice the spacing, with its standard error. */
static struct estimate change_bound(struct estimate change) {
    const struct mesh_changes changes = {
        .fine = change.value, .coarse = NAN, .fine_ratio = 2, .coarse_ratio = NAN};
    struct mesh_error mesh = mesh_error(&changes, CHANGE_ORDER);
    return (struct estimate){mesh.bound, mesh.weight * change.standard_error};
}

/* Waves of a band below the grid's own have no error: points of the surface are exact samples,
 * without aliasing. Heights that are mapped point by point have waves beyond the grid's. Their
 * aliasing is bounded by that on every second point, as far as its rings go. The spectrum of an
 * exponential autocorrelation itself goes as far as the grid's. */
static int density_error(const struct statistics_case *one_case,
                         const struct statistics_tally *tally, const double *reference,
                         struct case_result *result, struct curve *curve, struct error *err) {
    bool limited = surface_case_band_limited(&one_case->surface);
    size_t n = curve->n, known = limited || tally == NULL ? 0 : tally->density_change.size;
    double *bound;
    if (limited ? one_case->surface.spectrum.type == SPECTRUM_EXPONENTIAL_ACF : known == 0)
        return 0;
    int status = error_create(result, curve, n, &bound, err);
    if (status != 0 || limited)
        return status;
    double *value = bound - n, *standard_error = bound + n;
    for (size_t a = 0; a < n; a++) {
        struct estimate least = {NAN, NAN};
        if (a + 1 < known) /* ring 0 is not in the curve */
            least = change_bound(
                tally_sums_mean(&tally->density_change, a + 1, tally->points.realisations));
        value[a] = isnan(least.value) ? (double)NAN : 0;
        bound[a] = least.value * reference[a + 1];
        standard_error[a] = least.standard_error * reference[a + 1];
    }
    return 0;
}

/* Returns NaN where either is. */
static double larger(double a, double b) {
    return isnan(a) || a > b ? a : b;
}

/* Returns a bound from the change by rings of twice the width, at every second lag. */
static struct estimate ring_bound(const struct spectrum_columns *columns, size_t n, size_t lag) {
    if (2 * lag >= n)
        return (struct estimate){0, 0};
    return change_bound((struct estimate){columns->change[lag], columns->change_error[lag]});
}

/* Means over rings as wide as the grid's spacing differ from means over circles. The change by
 * rings of twice the width bounds this error at their lags and near them, since the points of a
 * ring may fit one lag and not the next. The origin is a ring of its own. */
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

/* Fills the changes of surfaces with waves beyond the grid's by measured values in place of those
 * of the spectrum; NaN where none was measured. */
static void correlation_changes(const struct statistics_case *one_case,
                                const struct statistics_tally *tally,
                                const struct spectrum_columns *columns, size_t n) {
    if (surface_case_band_limited(&one_case->surface) || tally == NULL)
        return;
    for (size_t a = 0; 2 * a < n; a++) {
        struct estimate mean = {NAN, NAN};
        if (a < tally->correlation_change.size)
            mean = tally_sums_mean(&tally->correlation_change, a, tally->points.realisations);
        columns->change[a] = mean.value;
        columns->change_error[a] = mean.standard_error;
    }
}

/* --- curves --- */

/* Makes the spectrum that is asked for without a translation, and of a translated surface its modes
 * at the RMS height of the surface: the modes of the case are those of the Gaussian field. *asked
 * is NULL for other surfaces. The spectrum borrows what it points to. */
static int asked_create(const struct statistics_case *one_case, const struct modes *modes,
                        struct spectrum *spectrum, struct modes **asked, struct error *err) {
    *spectrum = one_case->surface.spectrum;
    *asked = NULL;
    if (modes->translation == NULL)
        return 0;
    spectrum->translation = NULL;
    spectrum->scale = SCALE_RMS_HEIGHT;
    spectrum->scale_value = modes->height;
    return modes_create(asked, spectrum, &modes->grid, err);
}

/* Computes the prescribed density of the rings, over the same waves as the measured one. */
static int prescribed_density(const struct statistics_case *one_case, const struct modes *modes,
                              struct spectrum_columns *out, struct error *err) {
    struct spectrum spectrum;
    struct modes *asked;
    int status = asked_create(one_case, modes, &spectrum, &asked, err);
    if (status == 0)
        status =
            psd_prescribed(&spectrum, asked != NULL ? asked : modes,
                           surface_case_band_limited(&one_case->surface), out->x, out->theory, err);
    modes_destroy(&asked);
    return status;
}

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
    /* Measured densities are means over all waves of a ring. Those of band-limited surfaces are
     * reported as means over the waves of the band, the only ones that they have. */
    for (size_t a = 0; a < n && surface_case_band_limited(&one_case->surface); a++)
        reference.y[a] = reference.theory[a];
    status = prescribed_density(one_case, modes, &columns, err);
    if (status != 0)
        return status;
    for (size_t a = 0; a < n; a++) {
        struct estimate estimate = {reference.theory[a], 0};
        if (!exact && tally != NULL) {
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
    return add_curve(&one_case->surface, result, &curve, columns.theory + 1, err);
}

static size_t correlation_side(size_t side, size_t band) {
    size_t needed = 2 * band + 2;
    if (side <= ACF_GRID || side <= needed)
        return side;
    return needed > ACF_GRID ? needed : ACF_GRID;
}

/* Coarsens both sides of a rectangle by the same factor, to as many points as a square has in all,
 * and to even numbers, whose halves are needed for an error. */
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

/* Computes the autocorrelation at *n lags: y is that of the discrete spectrum, theory the
 * prescribed one. */
static int prescribed_correlation(const struct statistics_case *one_case, const struct modes *modes,
                                  struct case_result *result, struct spectrum_columns *out,
                                  size_t *n, struct error *err) {
    struct modes *coarse = NULL;
    struct spectrum spectrum;
    struct grid grid = correlation_grid(&one_case->surface);
    int status = asked_create(one_case, modes, &spectrum, &coarse, err);
    *n = acf_lags(&grid);
    if (status == 0 && coarse == NULL && grid.nx != modes->grid.nx)
        status = modes_create(&coarse, &spectrum, &grid, err);
    if (coarse != NULL)
        modes = coarse;
    if (status == 0)
        status = columns_create(result, out, *n, err);
    if (status == 0)
        status = acf_of_modes_changes(modes, out->x, out->y, out->change, err);
    if (status == 0)
        status = acf_prescribed(&spectrum, modes, out->x, out->theory, err);
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
        if (!exact && tally != NULL)
            estimate = tally_sums_mean(&tally->correlation, a, tally->points.realisations);
        columns.y[a] = estimate.value;
        columns.standard_error[a] = estimate.standard_error;
    }
    curve_set_points(&curve, n, columns.x, columns.y, columns.standard_error);
    correlation_changes(one_case, tally, &columns, n);
    status = correlation_error(&columns, n, result, &curve, err);
    if (status != 0)
        return status;
    return add_curve(&one_case->surface, result, &curve, columns.theory, err);
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
    struct modes *asked;
    int status = asked_create(one_case, modes, &exact.surface.spectrum, &asked, err);
    exact.surface.spectrum.translation = NULL;
    exact.surface.plateau = NULL; /* of stratified faces nothing is asked here */
    exact.surface.options.keep = KEEP_SPECTRUM;
    exact.surface.options.amplitudes = AMPLITUDES_FIXED;
    if (status == 0)
        status = spectra_curves(&exact, asked != NULL ? asked : modes, NULL, result, err);
    modes_destroy(&asked);
    for (size_t a = 0; a < result->curve_count && status == 0; a++) /* nothing was measured */
        result->curves[a].errors[ERROR_DISCRETISATION] = (struct curve_error){.applies = false};
    return status;
}
