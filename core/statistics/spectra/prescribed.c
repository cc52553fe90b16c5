#include "core/statistics/spectra/prescribed.h"
#include "core/statistics/heights/roughness.h"
#include "core/surface/spectrum.h"
#include <math.h>
#include <stdlib.h>

/* Powers of the modes of a grid from a density over wave vectors: those of an endless surface. */
static int exponential_density(const struct spectrum *spectrum, const struct modes *modes,
                               double *wave_number, double *density, struct error *err) {
    const struct grid *grid = &modes->grid;
    bool profile = grid_is_profile(grid);
    struct modes endless = {.grid = *grid, .mode_x = modes->mode_x, .mode_y = modes->mode_y};
    size_t count = (modes->mode_x + 1) * (2 * modes->mode_y + 1);
    struct moments moments;
    endless.power = array_create(count, sizeof *endless.power);
    if (endless.power == NULL)
        return error_memory(err, count * sizeof *endless.power, "a spectrum");
    modes_moments(modes, &moments);
    double bx = spectrum->correlation_x, by = spectrum->correlation_y, *power = endless.power;
    double cell = profile ? bx / M_PI * (2 * M_PI / grid->lx)
                          : bx * by / (2 * M_PI) * (4 * M_PI * M_PI / (grid->lx * grid->ly));
    for (size_t mx = 0; mx <= modes->mode_x; mx++)
        for (long my = -(long)modes->mode_y; my <= (long)modes->mode_y; my++) {
            double x = 2 * M_PI * (double)mx / grid->lx * bx;
            double y = profile ? 0 : 2 * M_PI * (double)my / grid->ly * by;
            *power++ = moments.m00 * cell * pow(1 + x * x + y * y, profile ? -1 : -1.5);
        }
    psd_of_modes(&endless, wave_number, density);
    free(endless.power);
    return 0;
}

int psd_prescribed(const struct spectrum *spectrum, const struct modes *modes, bool band,
                   double *wave_number, double *density, struct error *err) {
    const struct grid *grid = &modes->grid;
    if (spectrum->type == SPECTRUM_EXPONENTIAL_ACF)
        return exponential_density(spectrum, modes, wave_number, density, err);
    if (band)
        psd_of_band(modes, wave_number, density);
    else
        psd_of_modes(modes, wave_number, density);
    if (spectrum->anisotropy > 1)
        return 0; /* no density of the wave number alone: means over rings */
    /* Along the longer side waves are denser than rings, and some wave has a ring's own number. */
    bool along_y = !grid_is_profile(grid) && grid->ly < grid->lx;
    size_t most = along_y ? modes->mode_y : modes->mode_x;
    double cell =
        grid_is_profile(grid) ? grid->lx / (2 * M_PI) : grid->lx * grid->ly / (4 * M_PI * M_PI);
    for (size_t r = 0; r < radial_bins(grid); r++) {
        double power = 0;
        if (r <= most)
            power = along_y ? modes_power(modes, 0, (long)r) : modes_power(modes, r, 0);
        density[r] = power * cell;
    }
    return 0;
}

int acf_prescribed(const struct spectrum *spectrum, const struct modes *modes, double *lag,
                   double *correlation, struct error *err) {
    const struct grid *grid = &modes->grid;
    if (spectrum->type != SPECTRUM_EXPONENTIAL_ACF)
        return acf_of_modes(modes, lag, correlation, err);
    double *field = array_create(grid_points(grid), sizeof *field);
    if (field == NULL)
        return error_memory(err, grid_points(grid) * sizeof *field, "an autocorrelation");
    for (size_t j = 0; j < grid->ny; j++)
        for (size_t i = 0; i < grid->nx; i++)
            field[j * grid->nx + i] = exponential_correlation(spectrum, grid, i, j);
    int status = ring_average(grid, field, lag, correlation, err);
    free(field);
    return status;
}
