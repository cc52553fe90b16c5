#include "jobs/statistics/statistics_spectra.h"
#include "core/statistics/roughness.h"
#include <math.h>
#include <stdlib.h>

/* Every second point of a grid; *halved: its sides have even numbers of them. */
static struct grid coarser(const struct grid *grid, bool *halved) {
    struct grid out = *grid;
    *halved = grid->nx % 2 == 0 && (grid_is_profile(grid) || grid->ny % 2 == 0);
    out.nx = grid->nx / 2;
    out.ny = grid_is_profile(grid) ? 1 : grid->ny / 2;
    return out;
}

/* Rings whose waves a grid has in all directions. */
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

void spectra_reference(const struct modes *modes, double *wave_number, double *density) {
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

static bool scratch_create(struct spectra *out, size_t most) {
    size_t samples = out->sizes.density_changes > 0 ? grid_points(&out->coarse) : 1;
    out->abscissa = array_create(most, sizeof(double));
    out->measured = array_create(most, sizeof(double));
    out->reference = array_create(most, sizeof(double));
    out->changed = array_create(most, sizeof(double));
    out->samples = array_create(samples, sizeof(double));
    return out->abscissa != NULL && out->measured != NULL && out->reference != NULL &&
           out->changed != NULL && out->samples != NULL;
}

int spectra_create(struct spectra *out, const struct statistics_case *one_case,
                   const struct modes *modes, struct error *err) {
    bool halved;
    *out = (struct spectra){.sizes = spectra_sizes(one_case),
                            .coarse = coarser(&one_case->surface.grid, &halved)};
    size_t densities = out->sizes.densities, correlations = out->sizes.correlations;
    if (densities == 0)
        return 0;
    size_t most = densities > correlations ? densities : correlations;
    if (!scratch_create(out, most)) {
        spectra_clear(out);
        return error_memory(err, (4 * most + grid_points(&modes->grid) / 2) * sizeof(double),
                            "spectra");
    }
    spectra_reference(modes, out->abscissa, out->reference);
    return 0;
}

void spectra_clear(struct spectra *spectra) {
    free(spectra->abscissa);
    free(spectra->measured);
    free(spectra->reference);
    free(spectra->samples);
    free(spectra->changed);
    *spectra = (struct spectra){.coarse = {0}};
}

static void sample(const struct grid *grid, const double *z, const struct grid *to, double *out) {
    for (size_t j = 0; j < to->ny; j++)
        for (size_t i = 0; i < to->nx; i++)
            out[j * to->nx + i] = z[2 * j * grid->nx + 2 * i];
}

static int measure_density(struct spectra *spectra, const struct grid *grid, const double *z,
                           struct statistics_tally *tally, struct error *err) {
    const double *measured = spectra->measured, *reference = spectra->reference;
    size_t changes = spectra->sizes.density_changes;
    int status = psd_measure(grid, z, spectra->abscissa, spectra->measured, err);
    for (size_t a = 0; a < spectra->sizes.densities && status == 0; a++)
        tally_sums_add(&tally->density, a, measured[a] / reference[a], 1);
    if (status == 0 && changes > 0)
        status = psd_measure(&spectra->coarse, spectra->samples, spectra->abscissa,
                             spectra->changed, err);
    for (size_t a = 0; a < changes && status == 0; a++)
        tally_sums_add(&tally->density_change, a,
                       (measured[a] - spectra->changed[a]) / reference[a], 1);
    return status;
}

static int measure_correlation(struct spectra *spectra, const struct grid *grid, const double *z,
                               struct statistics_tally *tally, struct error *err) {
    const double *measured = spectra->measured;
    size_t changes = spectra->sizes.correlation_changes;
    int status = acf_measure(grid, z, spectra->abscissa, spectra->measured, err);
    for (size_t a = 0; a < spectra->sizes.correlations && status == 0; a++)
        tally_sums_add(&tally->correlation, a, measured[a], 1);
    if (status == 0 && changes > 0)
        status = acf_measure(&spectra->coarse, spectra->samples, spectra->abscissa,
                             spectra->changed, err);
    for (size_t a = 0; a < changes && status == 0; a++)
        tally_sums_add(&tally->correlation_change, a, measured[2 * a] - spectra->changed[a], 1);
    return status;
}

int spectra_measure(struct spectra *spectra, const struct grid *grid, const double *z,
                    struct statistics_tally *tally, struct error *err) {
    if (spectra->sizes.densities == 0)
        return 0;
    if (spectra->sizes.density_changes > 0)
        sample(grid, z, &spectra->coarse, spectra->samples);
    int status = measure_density(spectra, grid, z, tally, err);
    return status != 0 ? status : measure_correlation(spectra, grid, z, tally, err);
}
