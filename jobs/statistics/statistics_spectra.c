#include "jobs/statistics/statistics_spectra.h"
#include "core/statistics/roughness.h"
#include "jobs/curve.h"
#include <math.h>
#include <stdlib.h>

enum {
    ACF_GRID = 1024
}; /* points a side that the prescribed autocorrelation is sampled on, at most
    * unless the band needs more: a long case would cost a transform of its grid */

size_t spectra_densities(const struct statistics_case *study) {
    return surface_case_exact(&study->surface) ? 0 : radial_bins(&study->surface.grid);
}

size_t spectra_correlations(const struct statistics_case *study) {
    return surface_case_exact(&study->surface) ? 0 : study->surface.grid.nx / 2 + 1;
}

/* What measured densities are divided by before they are summed, so that the sums are exact. */
static void reference_of(size_t n, double *density) {
    double sum = 0;
    size_t used = 0;
    for (size_t a = 0; a < n; a++) {
        sum += density[a];
        used += density[a] > 0;
    }
    for (size_t a = 0; a < n; a++)
        if (!(density[a] > 0))
            density[a] = sum / (double)used;
}

int spectra_create(struct spectra *out, const struct statistics_case *study,
                   const struct modes *modes, struct error *err) {
    *out = (struct spectra){.densities = spectra_densities(study),
                            .correlations = spectra_correlations(study)};
    if (out->densities == 0)
        return 0;
    size_t most = out->densities > out->correlations ? out->densities : out->correlations;
    out->abscissa = array_create(most, sizeof(double));
    out->measured = array_create(most, sizeof(double));
    out->reference = array_create(most, sizeof(double));
    if (out->abscissa == NULL || out->measured == NULL || out->reference == NULL) {
        spectra_clear(out);
        error_memory(err, 3 * most * sizeof(double), "spectra");
        return ERROR_MEMORY;
    }
    psd_of_modes(modes, out->abscissa, out->reference);
    reference_of(out->densities, out->reference);
    return 0;
}

void spectra_clear(struct spectra *spectra) {
    free(spectra->abscissa);
    free(spectra->measured);
    free(spectra->reference);
    *spectra = (struct spectra){0};
}

int spectra_measure(struct spectra *spectra, const struct grid *grid, const double *z,
                    struct statistics_tally *tally, struct error *err) {
    if (spectra->densities == 0)
        return 0;
    int status = psd_measure(grid, z, spectra->abscissa, spectra->measured, err);
    if (status != 0)
        return status;
    for (size_t a = 0; a < spectra->densities; a++)
        tally_sums_add(&tally->density, a, spectra->measured[a] / spectra->reference[a], 1);
    status = acf_measure(grid, z, spectra->abscissa, spectra->measured, err);
    for (size_t a = 0; a < spectra->correlations && status == 0; a++)
        tally_sums_add(&tally->correlation, a, spectra->measured[a], 1);
    return status;
}

/* Four columns of a curve in one allocation. */
struct series {
    double *x, *y, *standard_error, *theory;
};
static int series_create(struct series *out, size_t n, struct error *err) {
    double *x = array_create(n, 4 * sizeof *x);
    *out = (struct series){0};
    if (x == NULL) {
        error_memory(err, n * 4 * sizeof *x, "a curve");
        return ERROR_MEMORY;
    }
    *out = (struct series){x, x + n, x + 2 * n, x + 3 * n};
    return 0;
}

static int append(cJSON *curves, const struct curve *curve, struct error *err) {
    return curve_append(curves, curve) ? 0 : error_memory(err, curve->n * 64, curve->quantity);
}

static int density_curve(const struct statistics_case *study, const struct modes *modes,
                         const struct statistics_tally *tally, cJSON *curves, struct error *err) {
    size_t n = radial_bins(&modes->grid), last = n - 1;
    bool exact = surface_case_exact(&study->surface);
    struct series series = {0}, reference = {0};
    int status = series_create(&series, n, err);
    if (status != 0)
        return status;
    status = series_create(&reference, n, err);
    if (status != 0) {
        free(series.x);
        return status;
    }
    psd_of_modes(modes, series.x, series.theory);
    psd_of_modes(modes, reference.x, reference.y);
    reference_of(n, reference.y);
    for (size_t a = 0; a < n; a++) {
        struct estimate estimate = {series.theory[a], 0};
        if (!exact) {
            estimate = tally_sums_mean(&tally->density, a, tally->points.realisations);
            estimate.value *= reference.y[a];
            estimate.standard_error *= reference.y[a];
        }
        series.y[a] = estimate.value;
        series.standard_error[a] = estimate.standard_error;
    }
    while (exact && last > 1 && !(series.y[last] > 0))
        last--;
    /* ring 0 is the mean height */
    status = append(curves,
                    &(struct curve){.quantity = "psd",
                                    .x_label = "k lambda_s",
                                    .y_label = "power spectral density",
                                    .n = last,
                                    .x = series.x + 1,
                                    .y = series.y + 1,
                                    .standard_error = series.standard_error + 1,
                                    .theories = {{exact ? NULL : "prescribed", series.theory + 1}}},
                    err);
    free(reference.x);
    free(series.x);
    return status;
}

static size_t correlation_side(const struct statistics_case *study) {
    size_t side = study->surface.grid.nx, needed = 2 * surface_case_band(&study->surface) + 2;
    if (side <= ACF_GRID || side <= needed)
        return side;
    return needed > ACF_GRID ? needed : ACF_GRID;
}

/* The prescribed autocorrelation; *n lags. */
static int prescribed_correlation(const struct statistics_case *study, const struct modes *modes,
                                  struct series *out, size_t *n, struct error *err) {
    struct modes *coarse = NULL;
    struct grid grid = study->surface.grid;
    int status = 0;
    grid.nx = surface_case_exact(&study->surface) ? correlation_side(study) : grid.nx;
    grid.ny = study->surface.dimension == 1 ? 1 : grid.nx;
    *n = grid.nx / 2 + 1;
    if (grid.nx != modes->grid.nx) {
        status = modes_create(&coarse, &study->surface.spectrum, &grid, err);
        modes = coarse;
    }
    if (status == 0)
        status = series_create(out, *n, err);
    if (status == 0) {
        status = acf_of_modes(modes, out->x, out->theory, err);
        if (status != 0)
            free(out->x);
    }
    modes_destroy(&coarse);
    return status;
}

static int correlation_curve(const struct statistics_case *study, const struct modes *modes,
                             const struct statistics_tally *tally, cJSON *curves,
                             struct error *err) {
    bool exact = surface_case_exact(&study->surface);
    struct series series = {0};
    size_t n;
    int status = prescribed_correlation(study, modes, &series, &n, err);
    if (status != 0)
        return status;
    for (size_t a = 0; a < n; a++) {
        struct estimate estimate = {series.theory[a], 0};
        if (!exact)
            estimate = tally_sums_mean(&tally->correlation, a, tally->points.realisations);
        series.y[a] = estimate.value;
        series.standard_error[a] = estimate.standard_error;
    }
    status = append(curves,
                    &(struct curve){.quantity = "acf",
                                    .x_label = "lag/lambda_s",
                                    .y_label = "autocorrelation",
                                    .n = n,
                                    .x = series.x,
                                    .y = series.y,
                                    .standard_error = series.standard_error,
                                    .theories = {{exact ? NULL : "prescribed", series.theory}}},
                    err);
    free(series.x);
    return status;
}

int spectra_curves(const struct statistics_case *study, const struct modes *modes,
                   const struct statistics_tally *tally, cJSON *curves, struct error *err) {
    int status = density_curve(study, modes, tally, curves, err);
    return status != 0 ? status : correlation_curve(study, modes, tally, curves, err);
}
