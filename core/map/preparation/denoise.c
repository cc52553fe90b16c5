#include "core/map/preparation/denoise.h"
#include "core/error.h"
#include "core/map/map_law.h"
#include "core/statistics/heights/roughness.h"
#include "core/surface/transform.h"
#include <math.h>
#include <stdlib.h>

/* Returns the relative standard error behind a 95 % interval; 0 where that is open. */
static double error_of(const struct interval *interval) {
    static const double BOTH_SIDES = 2 * 1.960;
    const double error = (interval->high - interval->low) / (BOTH_SIDES * interval->value);
    return isfinite(error) ? error : 0;
}

/* Returns how likely it is that the surface has waves of this number: those before the law's end,
 * which is known to within its error. */
static double share_at(const struct spectrum_fit *fit, double wave_number) {
    static const double GUARD = 1e-9;
    const double beyond = log(wave_number * fit->shortest / (2 * M_PI));
    const double error = error_of(&fit->short_wavelength);
    if (!(error > 0) || !isfinite(beyond))
        return beyond > GUARD ? 0 : 1;
    return erfc(beyond / (error * M_SQRT2)) / 2;
}

/* Returns what a wave number across the lay is multiplied by. Longer waves than the law's have
 * little noise, as its longest. */
static double gain(const struct map_law *law, double wave_number) {
    const struct spectrum_fit *fit = &law->fit;
    const double end = 2 * M_PI / fit->shortest,
                 steep = (fit->profile ? 1 : 2) + 2 * fit->hurst.value;
    const double fall = wave_number > end ? pow(end / wave_number, steep) : 1;
    const double density =
        share_at(fit, wave_number) * map_law_density(law, fmin(wave_number, end)) * fall;
    return density > 0 ? sqrt(density / (density + fit->noise)) : 0;
}

/* The cell that repeats: of an open map with its mirror images. */
static struct grid repeated_cell(const struct grid *grid, bool open) {
    struct grid cell = *grid;
    if (!open)
        return cell;
    cell.nx *= 2;
    cell.lx *= 2;
    if (!grid_is_profile(grid)) {
        cell.ny *= 2;
        cell.ly *= 2;
    }
    return cell;
}

static size_t mirrored(size_t i, size_t n) {
    return i < n ? i : 2 * n - 1 - i;
}

static int filter(const struct map_law *law, const struct grid *grid, double *z, bool open,
                  struct error *err) {
    const struct grid cell = repeated_cell(grid, open);
    const size_t points = grid_points(&cell), modes = (cell.nx / 2 + 1) * cell.ny;
    struct transform *transform = NULL;
    double *field = array_create(points + modes, sizeof *field), *symbol = NULL;
    if (field == NULL)
        return error_memory(err, (points + modes) * sizeof *field, "a map without noise");
    symbol = field + points;
    int status = transform_create(&transform, &cell, cell.nx / 2, cell.ny / 2, err);
    if (status == 0) {
        for (size_t j = 0; j < cell.ny; j++)
            for (size_t i = 0; i < cell.nx; i++)
                field[j * cell.nx + i] =
                    z[mirrored(j, grid->ny) * grid->nx + mirrored(i, grid->nx)];
        map_law_fill(law, &cell, gain, symbol);
        transform_filter(transform, symbol, 1, field, field);
        for (size_t j = 0; j < grid->ny; j++)
            for (size_t i = 0; i < grid->nx; i++)
                z[j * grid->nx + i] = field[j * cell.nx + i];
    }
    transform_destroy(&transform);
    free(field);
    return status;
}

/* Fills what the noise leaves open of slopes and curvatures: of the law its error where there is as
 * much noise, and of the waves at the law's end, behind which all are removed, the error of that.
 */
static void errors_fill(const struct spectrum_fit *fit, struct denoise_result *out) {
    const double k = 2 * M_PI / fit->shortest, end = error_of(&fit->short_wavelength);
    const double dimension = fit->profile ? 1 : 2;
    const double whole = fit->profile ? 2 : 2 * M_PI; /* of all directions, of unit wave number */
    const double density = spectrum_fit_density(fit, k);
    const struct interval *moments[] = {&fit->rms_slope, &fit->rms_curvature};
    double *const errors[] = {&out->slope_error, &out->curvature_error};
    for (int m = 0; m < 2; m++) {
        const double power = dimension + 2 * (m + 1), all = whole * pow(k, power);
        /* the mean square of |k|^2 z is four times that of the mean curvature of a surface */
        const double square = pow(moments[m]->value, 2) * (m == 1 && !fit->profile ? 4 : 1);
        const double noise = fmin(fit->noise * all / power / square, 1);
        *errors[m] = hypot(noise * error_of(moments[m]), density * all / square * end / 2);
    }
}

int map_denoise(const struct grid *grid, double *z, enum boundary boundary,
                struct denoise_result *out, struct error *err) {
    const struct measured_map map = {grid, z, boundary};
    const double whole = 2 * M_PI / grid_dx(grid);
    struct map_law law;
    struct roughness roughness;
    *out = (struct denoise_result){.found = false};
    int status = map_law_fit(&law, &map, err);
    const struct spectrum_fit *fit = &law.fit;
    if (status != 0)
        return status;
    map_law_clear(&law);
    if (!fit->fitted)
        return 0;
    map_roughness_measure(&map, &roughness);
    out->slope_before = out->slope_after = roughness.rms_slope;
    if (!(spectrum_fit_noise_share(fit, grid, roughness.rms_curvature) > NOISE_SHARE_MOST))
        return 0;
    out->found = true;
    out->noise = sqrt(fit->noise * (grid_is_profile(grid) ? whole : whole * whole));
    out->shortest = fit->shortest;
    errors_fill(fit, out);
    status = filter(&law, grid, z, boundary == BOUNDARY_OPEN, err);
    if (status == 0)
        map_roughness_measure(&map, &roughness);
    out->slope_after = roughness.rms_slope;
    return status;
}
